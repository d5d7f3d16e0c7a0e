package dev.subsurf

import java.nio.ByteBuffer
import java.nio.ByteOrder

/**
 * Plane of a BSSRDF: its bytes as they stand in the file, and the texture that they are. Rows follow each other without gaps, and so
 * do layers.
 *
 * @property kind What the numbers are.
 * @property format Format of a texel.
 * @property width Texels in x.
 * @property height Texels in y.
 * @property layers Layers of an array; 1 where it is a single picture.
 * @property rowBytes Bytes of a row.
 * @property layerBytes Bytes of a layer.
 * @property glInternalFormat Internal format for `glTexStorage2D`.
 * @property glFormat Format for `glTexSubImage2D`.
 * @property glType Type for `glTexSubImage2D`.
 * @property vkFormat Number of the VkFormat.
 */
@Suppress("LongParameterList")
public class Plane private constructor(
    private val file: SubsurfFile,
    private val bytes: ByteBuffer,
    public val kind: PlaneKind,
    public val format: PlaneFormat,
    public val width: Int,
    public val height: Int,
    public val layers: Int,
    public val rowBytes: Int,
    public val layerBytes: Long,
    public val glInternalFormat: Int,
    public val glFormat: Int,
    public val glType: Int,
    public val vkFormat: Int,
) {
    /** Bytes of all layers. */
    public val byteCount: Int get() = bytes.capacity()

    /**
     * Calls with the bytes, read-only and little-endian, ready for `glTexSubImage2D` (with GL_UNPACK_ALIGNMENT 1). The file stays open for the call; the
     * buffer is of no use after it, and reading it then may end the process.
     *
     * @throws IllegalStateException if the file is closed.
     */
    public fun <T> use(work: (ByteBuffer) -> T): T = file.handle.call { work(bytes.asReadOnlyBuffer().order(ByteOrder.LITTLE_ENDIAN)) }

    internal companion object {
        private const val LONGS = 12

        @Suppress("MagicNumber")
        fun of(file: SubsurfFile, number: Int): Plane {
            val longs = LongArray(LONGS)
            val bytes = file.handle.call { Native.bssrdfPlane(it, number, longs) }
            expectOk(longs[11].toInt())
            fun int(index: Int) = longs[index].toInt()
            val byteCount = longs[10] * longs[4]
            if (byteCount > Int.MAX_VALUE) {
                val text = "plane $number has $byteCount bytes, expected are ${Int.MAX_VALUE} at most: buffers hold no more"
                throw exceptionOf(Status.UNSUPPORTED, text)
            }
            return Plane(
                file,
                checkNotNull(bytes) { "this virtual machine has no direct buffers over memory of others" },
                kind = PlaneKind.entries[int(0)],
                format = PlaneFormat.entries[int(1)],
                width = int(2),
                height = int(3),
                layers = int(4),
                rowBytes = int(5),
                layerBytes = longs[10],
                glInternalFormat = int(6),
                glFormat = int(7),
                glType = int(8),
                vkFormat = int(9),
            )
        }
    }
}
