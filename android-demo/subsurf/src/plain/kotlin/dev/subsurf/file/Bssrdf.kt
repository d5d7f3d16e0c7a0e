package dev.subsurf

/**
 * Diffuse BSSRDF of a patch, as a file has it; usable until the file is closed.
 *
 * Threads: any number at once.
 *
 * @property basesPerPixel K, the number of base materials of a pixel: 1, 2, 3 or 5; 0 where each pixel has a profile of its own.
 * @property coding Encoding of mixtures; [Coding.EXACT] but for K = 2.
 * @property addressing What lies beyond the border.
 * @property width Pixels in x.
 * @property height Pixels in y.
 * @property windowRadius R in pixels: Rd is 0 between pixels further apart in x or in y.
 * @property samples S, the nodes of a profile; node h is at r = h * rMaxMm / (S - 1).
 * @property baseMaterials M, the number of base materials; 0 where each pixel has a profile of its own.
 * @property bitsPerPixel Bits that a pixel takes.
 * @property pitchMm Distance of neighbouring pixels in mm.
 * @property rMaxMm Radius of the last node in mm; Rd is 0 beyond it.
 * @property eta Refractive index of the material against air, 1 to 4.
 */
@Suppress("LongParameterList")
public class Bssrdf private constructor(
    private val file: SubsurfFile,
    public val basesPerPixel: Int,
    public val coding: Coding,
    public val addressing: Addressing,
    public val width: Int,
    public val height: Int,
    public val windowRadius: Int,
    public val samples: Int,
    public val baseMaterials: Int,
    public val bitsPerPixel: Int,
    planeCount: Int,
    public val pitchMm: Float,
    public val rMaxMm: Float,
    public val eta: Float,
) {
    /** Planes of the patch, in the order of the file format. */
    public val planes: List<Plane> = List(planeCount) { number -> Plane.of(file, number) }

    /**
     * Diffuse reflectance Rd in mm^-2 between two pixels: linear Rec. 709 in [out], which is returned.
     *
     * @param xI Column where light enters, of any size: [addressing] says what lies there; likewise [yI], and [xO] and [yO], where it
     *   leaves.
     */
    @JvmOverloads
    public fun rd(xI: Int, yI: Int, xO: Int, yO: Int, out: FloatArray = FloatArray(RGB)): FloatArray =
        out.filled(RGB) { file.handle.call { Native.bssrdfRd(it, xI, yI, xO, yO, out) } }

    /** Albedo of a pixel under uniform light: linear Rec. 709 in [out], which is returned. */
    @JvmOverloads
    public fun albedo(x: Int, y: Int, out: FloatArray = FloatArray(RGB)): FloatArray =
        out.filled(RGB) { file.handle.call { Native.bssrdfAlbedo(it, x, y, out) } }

    internal companion object {
        private const val INTS = 10
        private const val FLOATS = 3

        @Suppress("MagicNumber")
        fun of(file: SubsurfFile): Bssrdf {
            val ints = IntArray(INTS)
            val floats = FloatArray(FLOATS)
            expectOk(file.handle.call { Native.bssrdfInfo(it, ints, floats) })
            return Bssrdf(
                file,
                basesPerPixel = ints[0],
                coding = Coding.entries[ints[1]],
                addressing = Addressing.entries[ints[2]],
                width = ints[3],
                height = ints[4],
                windowRadius = ints[5],
                samples = ints[6],
                baseMaterials = ints[7],
                bitsPerPixel = ints[8],
                planeCount = ints[9],
                pitchMm = floats[0],
                rMaxMm = floats[1],
                eta = floats[2],
            )
        }
    }
}

/** Numbers of a colour, and of a direction. */
internal const val RGB: Int = 3

/** The array itself, once a call has filled its first numbers. */
internal inline fun FloatArray.filled(count: Int, call: () -> Int): FloatArray {
    require(size >= count) { "the array has room for $size numbers, expected is $count" }
    expectOk(call())
    return this
}
