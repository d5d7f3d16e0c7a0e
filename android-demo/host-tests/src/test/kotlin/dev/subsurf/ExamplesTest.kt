package dev.subsurf

import kotlinx.coroutines.runBlocking
import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test
import java.io.File

/** The examples of the README. */
class ExamplesTest {
    @Test
    fun thumbnailIsAPicture() {
        val thumbnail = Class.forName("ThumbnailKt").methods.single { it.name == "thumbnail" }
        val picture =
            runBlocking {
                kotlin.coroutines.intrinsics.suspendCoroutineUninterceptedOrReturn<Any?> {
                    thumbnail.invoke(null, TestFiles.material("jade.subsurf").path, 24, it)
                }
            } as java.nio.ByteBuffer
        assertEquals(24 * 24 * 4, picture.capacity())
        assertTrue((0 until 24 * 24).any { picture.getInt(4 * it) != picture.getInt(0) })
    }

    @Test
    fun descriptionSaysWhatIsThere() {
        val describe = Class.forName("Describe").getDeclaredMethod("describe", String::class.java)
        describe.isAccessible = true
        val text = describe.invoke(null, TestFiles.material("jade.subsurf").path) as String
        assertTrue(text, text.startsWith("24 x 24 pixels of ") && "BASE_PROFILES: " in text)
    }

    @Test
    fun examplesAreShort() {
        for (file in File("../examples").listFiles()!!) assertTrue(file.name, file.readLines().size <= 40)
    }
}
