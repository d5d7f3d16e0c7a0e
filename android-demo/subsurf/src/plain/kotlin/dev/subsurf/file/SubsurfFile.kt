package dev.subsurf

import java.nio.ByteBuffer

/**
 * Checked `.subsurf` file of any family, mapped or in memory: nothing of it is copied.
 *
 * Threads: any number at once, but for [Btf.expand]. Ownership: who opens it closes it; a call that is under way ends first.
 *
 * @property family What the file holds.
 * @property byteCount Bytes of the file.
 * @property openNanos Time that opening took in ns: mapping it, and reading and checking all of it.
 */
public class SubsurfFile private constructor(
    internal val handle: Handle,
    public val family: Family,
    public val byteCount: Long,
    public val openNanos: Long,
) : AutoCloseable {
    /**
     * The file as a BSSRDF.
     *
     * @throws SubsurfException.WrongFamily if it is none.
     */
    @get:Throws(SubsurfException::class)
    public val bssrdf: Bssrdf by lazy { Bssrdf.of(this) }

    /**
     * The file as a BTF of either model.
     *
     * @throws SubsurfException.WrongFamily if it is none.
     */
    @get:Throws(SubsurfException::class)
    public val btf: Btf by lazy { Btf.of(this) }

    /** Closes the file, once calls that use it have ended. Planes of it are gone then. */
    override fun close(): Unit = handle.close()

    /** Openers. */
    public companion object {
        /** Length that stands for all bytes from an offset to the end of the file. */
        public const val TO_END: Long = -1

        /**
         * Opens a file by its path: maps it and checks all of it.
         *
         * @throws SubsurfException.Io if it cannot be opened.
         * @throws SubsurfException.InvalidFile if it is not sound.
         */
        @JvmStatic
        @Throws(SubsurfException::class)
        public fun open(path: String): SubsurfFile {
            require('\u0000' !in path) { "the path has a zero in it" }
            val text = (path + '\u0000').toByteArray(Charsets.UTF_8)
            return opened(null) { out -> Native.fileOpenPath(text, out) }
        }

        /**
         * Opens a part of a file by its descriptor, such as an asset inside an APK that is stored without compression: maps it and
         * checks all of it. The descriptor stays the caller's, who may close it at once.
         *
         * @param offset First byte, of any alignment.
         * @param length Bytes, or [TO_END].
         * @throws SubsurfException.Io if it is no regular file or has fewer bytes.
         * @throws SubsurfException.InvalidFile if it is not sound.
         */
        @JvmStatic
        @JvmOverloads
        @Throws(SubsurfException::class)
        public fun open(fd: Int, offset: Long = 0, length: Long = TO_END): SubsurfFile {
            require(offset >= 0) { "offset is $offset, expected is 0 at least" }
            require(length >= TO_END) { "length is $length, expected is 0 at least, or TO_END" }
            return opened(null) { out -> Native.fileOpenFd(fd, offset, length, out) }
        }

        /**
         * Opens the bytes of a direct buffer, from its position to its limit, which stay as they are until the file is closed.
         *
         * @throws SubsurfException.InvalidFile if they are not sound.
         * @throws IllegalArgumentException if the buffer is not direct.
         */
        @JvmStatic
        @Throws(SubsurfException::class)
        public fun open(buffer: ByteBuffer): SubsurfFile {
            require(buffer.isDirect) { "the buffer is not direct: ByteBuffer.allocateDirect and FileChannel.map make such" }
            return opened(buffer) { out -> Native.fileOpenMemory(buffer, buffer.position(), buffer.remaining(), out) }
        }

        private inline fun opened(kept: Any?, open: (LongArray) -> Int): SubsurfFile {
            val out = LongArray(2)
            val begin = System.nanoTime()
            expectOk(open(out))
            val nanos = System.nanoTime() - begin
            val pointer = out[0]
            val status = Native.fileInfo(pointer, out)
            if (status != Status.OK) Native.fileClose(pointer)
            expectOk(status)
            val handle = Handle("the file", pointer, kept, Native::fileClose)
            return SubsurfFile(handle, Family.entries.getOrElse(out[0].toInt()) { Family.OTHER }, out[1], nanos)
        }
    }
}
