package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Test
import java.lang.reflect.Modifier

class NativeTest {
    @Test
    fun versionIsThatOfTheHeader() {
        assertEquals(1, Native.abiVersion() shr 16)
    }

    /** Cost of a call that does nothing; printed, since machines differ. `-Xcheck:jni` adds its checks to it. */
    @Test
    fun callsAreCheap() {
        var sum = 0L
        repeat(3) {
            val begin = System.nanoTime()
            repeat(CALLS) { sum += Native.abiVersion() }
            println("JNI: %.1f ns for a call that does nothing".format((System.nanoTime() - begin) / CALLS.toDouble()))
        }
        assertEquals(3L * CALLS * Native.abiVersion(), sum)
    }

    @Test
    fun everyEntryPointIsInTheLibrary() {
        val names = Native::class.java.declaredMethods.filter { Modifier.isNative(it.modifiers) }.map { "Java_dev_subsurf_Native_${it.name}" }
        val library = java.io.File(System.getProperty("java.library.path"), System.mapLibraryName("subsurf"))
        val process = ProcessBuilder("nm", "-D", "--defined-only", library.path).start()
        val exported = process.inputStream.bufferedReader().readLines().map { it.substringAfterLast(' ') }
        assertEquals(names.sorted(), exported.filter { it.startsWith("Java_") }.sorted())
    }

    private companion object {
        const val CALLS = 2_000_000
    }
}
