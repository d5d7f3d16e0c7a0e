package dev.subsurf

/**
 * Bidirectional texture functions of one or several materials, as a file has them; usable until the file is closed.
 *
 * Directions are unit vectors: x along the rows, y down the columns, z the normal. Threads: any number at once, but for [expand].
 *
 * @property materials Materials of the file.
 * @property texelCount Number of texels of all levels of all materials.
 * @property isDisplay Whether values are display values of sRGB, 0 to 1; else they are linear.
 * @property cosLightMin Cosine of the angle between the normal and the lowest light that was measured; lower ones fade to black.
 * @property thetaMax Largest angle of the view from the normal in rad.
 * @property expansionBytes Bytes that [expand] takes; 0 where there is nothing to expand.
 */
@Suppress("LongParameterList")
public class Btf private constructor(
    private val file: SubsurfFile,
    public val materials: List<BtfMaterial>,
    public val texelCount: Int,
    public val isDisplay: Boolean,
    public val cosLightMin: Float,
    public val thetaMax: Float,
    public val expansionBytes: Long,
) {
    /**
     * Expands a factored BTF, which is evaluated only then. A hostile file may ask for gigabytes: look at [expansionBytes] first.
     * Nothing else may use the file meanwhile.
     *
     * @throws SubsurfException.OutOfMemory if there is no memory.
     * @throws IllegalStateException if another thread uses the file.
     */
    @Throws(SubsurfException::class)
    public fun expand(): Unit = expectOk(file.handle.callAlone { Native.btfExpand(it) })

    /**
     * Number of a texel, for the functions that take one.
     *
     * @param material Number of the material, from 0.
     * @param level Mipmap level, from 0.
     * @param x Column, which repeats; likewise [y], the row.
     */
    public fun texel(material: Int, level: Int, x: Int, y: Int): Int {
        val out = IntArray(1)
        expectOk(file.handle.call { Native.btfTexel(it, material, level, x, y, out) })
        return out[0]
    }

    /**
     * Value of a texel under a light: R, G, B, not negative, in [out], which is returned; 0 under lights below the horizon.
     *
     * @throws IllegalStateException if it is factored and was not expanded.
     */
    @JvmOverloads
    public fun eval(texel: Int, light: Vector3, view: Vector3, out: FloatArray = FloatArray(RGB)): FloatArray =
        out.filled(RGB) {
            file.handle.call { Native.btfEval(it, texel, light.x, light.y, light.z, view.x, view.y, view.z, out) }
        }

    /** Linear Rec. 709 of a value that [eval] gave, in [out], which is returned and may be the value itself. */
    @JvmOverloads
    public fun linear(value: FloatArray, out: FloatArray = FloatArray(RGB)): FloatArray =
        out.filled(RGB) { file.handle.call { Native.btfLinear(it, value[0], value[1], value[2], out) } }

    /**
     * Light to look for next, in proportion to the luma of the texel, for two random numbers from 0 to 1.
     *
     * @throws SubsurfException.WrongFamily for factored BTFs.
     */
    @Throws(SubsurfException::class)
    public fun sample(texel: Int, view: Vector3, random0: Float, random1: Float): LightSample {
        val out = FloatArray(RGB + 1)
        expectOk(file.handle.call { Native.btfSample(it, texel, view.x, view.y, view.z, random0, random1, out) })
        return LightSample(Vector3(out[0], out[1], out[2]), out[RGB])
    }

    /**
     * Density with which [sample] draws a light, per steradian; 0 below the horizon.
     *
     * @throws SubsurfException.WrongFamily for factored BTFs.
     */
    @Throws(SubsurfException::class)
    public fun pdf(texel: Int, light: Vector3, view: Vector3): Float {
        val out = FloatArray(1)
        val status =
            file.handle.call { Native.btfPdf(it, texel, light.x, light.y, light.z, view.x, view.y, view.z, out) }
        expectOk(status)
        return out[0]
    }

    /**
     * Albedo of a texel towards the eye, linear Rec. 709, in [out], which is returned; takes some 900 evaluations.
     *
     * @throws SubsurfException.WrongFamily for factored BTFs.
     */
    @JvmOverloads
    @Throws(SubsurfException::class)
    public fun albedo(texel: Int, view: Vector3, out: FloatArray = FloatArray(RGB)): FloatArray =
        out.filled(RGB) { file.handle.call { Native.btfAlbedo(it, texel, view.x, view.y, view.z, out) } }

    internal companion object {
        private const val INTS = 7
        private const val FLOATS = 4

        @Suppress("MagicNumber")
        fun of(file: SubsurfFile): Btf {
            val ints = IntArray(INTS)
            val floats = FloatArray(FLOATS)
            val expansion = LongArray(1)
            expectOk(file.handle.call { Native.btfInfo(it, ints, floats, expansion) })
            return Btf(
                file,
                materials = List(ints[0]) { number -> BtfMaterial.of(file, number) },
                texelCount = ints[1],
                isDisplay = ints[2] != 0,
                cosLightMin = floats[3],
                thetaMax = floats[2],
                expansionBytes = expansion[0],
            )
        }
    }
}

/**
 * Material of a BTF.
 *
 * @property name Name, as the file has it.
 * @property width Texels in x of the finest level.
 * @property height Texels in y of the finest level.
 * @property levels Mipmap levels.
 */
public class BtfMaterial private constructor(
    public val name: String,
    public val width: Int,
    public val height: Int,
    public val levels: Int,
) {
    internal companion object {
        private const val INTS = 4

        @Suppress("MagicNumber")
        fun of(file: SubsurfFile, number: Int): BtfMaterial {
            val ints = IntArray(INTS)
            val name = file.handle.call { Native.btfMaterial(it, number, ints) }
            expectOk(ints[3])
            return BtfMaterial(String(name ?: ByteArray(0), Charsets.UTF_8), ints[0], ints[1], ints[2])
        }
    }
}

/**
 * Light that was drawn.
 *
 * @property light Unit vector towards it, z >= 0.
 * @property pdf Density there, per steradian, above 0.
 */
public class LightSample internal constructor(public val light: Vector3, public val pdf: Float)
