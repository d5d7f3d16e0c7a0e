package dev.subsurf

import java.nio.ByteBuffer

/**
 * Material to be drawn: an open file. Renderers make copies of it on their devices when they first draw it, and make them again after
 * a loss, a trim or frames without it, so that the material outlives devices.
 *
 * Threads: any number at once. Ownership: who opens it closes it, once nothing draws it any more.
 *
 * @property file File of the material, closed with it.
 */
public class SubsurfMaterial(
    public val file: SubsurfFile,
) : AutoCloseable {
    /** Closes the file. */
    override fun close(): Unit = file.close()

    /** Openers, as those of [SubsurfFile]. */
    public companion object {
        /** Opens a file by its path. */
        @JvmStatic
        @Throws(SubsurfException::class)
        public fun open(path: String): SubsurfMaterial = SubsurfMaterial(SubsurfFile.open(path))

        /** Opens a part of a file by its descriptor, which stays the caller's. */
        @JvmStatic
        @JvmOverloads
        @Throws(SubsurfException::class)
        public fun open(fd: Int, offset: Long = 0, length: Long = SubsurfFile.TO_END): SubsurfMaterial =
            SubsurfMaterial(SubsurfFile.open(fd, offset, length))

        /** Opens the bytes of a direct buffer, which stay as they are until the material is closed. */
        @JvmStatic
        @Throws(SubsurfException::class)
        public fun open(buffer: ByteBuffer): SubsurfMaterial = SubsurfMaterial(SubsurfFile.open(buffer))
    }
}
