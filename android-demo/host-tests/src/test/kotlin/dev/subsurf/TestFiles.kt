package dev.subsurf

import java.io.File
import java.nio.ByteBuffer

/** Files that tests read: the vectors of the project, and materials that scripts/android-jvm encodes. */
internal object TestFiles {
    fun vector(name: String): File = File(System.getProperty("vectors"), name)

    fun material(name: String): File = File(System.getProperty("materials"), name)

    fun output(name: String): File = File(System.getProperty("output"), name)

    /** Direct buffer with the bytes of a file, after some others. */
    fun buffer(file: File, before: Int = 0): ByteBuffer {
        val bytes = file.readBytes()
        val buffer = ByteBuffer.allocateDirect(before + bytes.size)
        buffer.position(before)
        buffer.put(bytes).position(before)
        return buffer
    }
}
