package dev.subsurf

import androidx.test.ext.junit.runners.AndroidJUnit4
import androidx.test.platform.app.InstrumentationRegistry
import org.junit.Assert.assertTrue
import org.junit.Test
import org.junit.runner.RunWith
import java.io.File

/** Load times on a device: a table in the files of the test app, where the README fetches it. */
@RunWith(AndroidJUnit4::class)
class LoadTimeTest {
    @Test
    fun loadsAreMeasured() {
        val context = InstrumentationRegistry.getInstrumentation().context
        val lines = mutableListOf(LoadSuite.HEADER)
        for (backend in listOf(Backend.VULKAN, Backend.GL)) {
            for ((name, technique) in LoadSuite.MATERIALS) {
                try {
                    lines += LoadSuite(backend, REPEATS).run(name, technique) {
                        SubsurfMaterial.open(context.assets, "$name.subsurf")
                    }
                } catch (e: SubsurfException.NoDevice) {
                    println("$backend: ${e.message}")
                }
            }
        }
        val folder = InstrumentationRegistry.getInstrumentation().targetContext.getExternalFilesDir(null)
        File(folder, "load-times.csv").writeText(lines.joinToString("\n", postfix = "\n"))
        assertTrue("a device for one of both", lines.size > 1)
    }

    private companion object {
        const val REPEATS = 20
    }
}
