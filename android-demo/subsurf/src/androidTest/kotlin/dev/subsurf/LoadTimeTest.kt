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
        output("load-times.csv").writeText(lines.joinToString("\n", postfix = "\n"))
        assertTrue("a device for one of both", lines.size > 1)
    }

    /** By the program that is in the test app as a library, so that the system unpacks it and lets it run. */
    @Test
    fun capturesAndImagesAreMeasuredBesideTheirFiles() {
        val context = InstrumentationRegistry.getInstrumentation().context
        val folder = InstrumentationRegistry.getInstrumentation().targetContext.cacheDir
        val files = LoadProgram.MATERIALS.map { name ->
            File(folder, "$name.subsurf").also { to ->
                context.assets.open(to.name).use { from -> to.outputStream().use(from::copyTo) }
            }
        }
        val program = File(context.applicationInfo.nativeLibraryDir, "libload_test.so")
        val tables = listOf(Backend.VULKAN, Backend.GL).map { LoadProgram(program, folder, REPEATS).run(it, files).trim().lines() }
        val lines = tables.first().take(1) + tables.flatMap { it.drop(1) }.filter { ",decoder," !in it }
        output("load-times-uncompressed.csv").writeText(lines.joinToString("\n", postfix = "\n"))
        assertTrue("a device for one of both", lines.size > 1)
    }

    private fun output(name: String) =
        File(InstrumentationRegistry.getInstrumentation().targetContext.getExternalFilesDir(null), name)

    private companion object {
        const val REPEATS = 20
    }
}
