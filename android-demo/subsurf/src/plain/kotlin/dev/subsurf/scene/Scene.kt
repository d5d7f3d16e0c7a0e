package dev.subsurf

/**
 * Everything that a frame shows. A scene never changes: change what a view shows by giving it another.
 *
 * @property objects Objects, 16 at most; those of one material scatter light between each other.
 * @property lights Lights, 8 at most.
 * @property camera View.
 * @property environment Light from all around.
 * @property exposure Factor on radiance, before tone mapping.
 * @property background Display values of red, green and blue behind the objects, 0 to 1.
 */
public class Scene
    @JvmOverloads
    constructor(
        objects: List<SceneObject>,
        lights: List<Light> = listOf(Light.directional(DEFAULT_LIGHT)),
        public val camera: Camera = Orbit(),
        public val environment: Environment = SKY,
        public val exposure: Float = 1f,
        public val background: Vector3 = GREY,
    ) {
        public val objects: List<SceneObject> = objects.toList()
        public val lights: List<Light> = lights.toList()

        /**
         * Numbers of a frame, in the order that the library unpacks.
         *
         * @param bounds Sphere that holds all objects.
         * @param aspect Width of the picture to its height.
         */
        internal fun numbers(bounds: Bounds, aspect: Float): FloatArray {
            val out = Packer(FRAME + LIGHT * lights.size + OBJECT * objects.size)
            out.put(*camera.lookAt(bounds).matrices(bounds, aspect)).put(exposure).put(bounds.centreMm)
            out.put(background).put(1f)
            for (light in lights) {
                out.put(light.kind.ordinal.toFloat()).put(if (light.hasShadow) 1f else 0f).put(light.place)
                out.put(light.targetMm).put(light.halfAngleRad).put(light.irradiance)
            }
            for (shown in objects) {
                out.put(*shown.matrix).put(shown.number.toFloat(), shown.mappingOrUsual.ordinal.toFloat())
                out.put(shown.copiesU, shown.copiesV).put(shown.roughness)
            }
            return out.numbers
        }

        /** Numbers, one after the other. */
        private class Packer(size: Int) {
            val numbers = FloatArray(size)
            private var next = 0

            fun put(vararg values: Float): Packer {
                values.copyInto(numbers, next)
                next += values.size
                return this
            }

            fun put(vector: Vector3): Packer = put(vector.x, vector.y, vector.z)
        }

        internal companion object {
            const val FRAME = 40
            const val LIGHT = 12
            const val OBJECT = 21
            val DEFAULT_LIGHT = Vector3(0.61f, 0.75f, 0.24f)
            private val SKY = Environment.uniform(Vector3(0.35f, 0.4f, 0.5f))
            private val GREY = Vector3(0.18f, 0.18f, 0.18f)
        }
    }

/** Rule by which a material lies on a mesh. */
public enum class Mapping {
    /** Texture coordinates. */
    UV,

    /** In its own size, from the side of a box that each normal faces most. */
    BOX,
}

/**
 * Mesh, what it is made of, and where it is.
 *
 * @property mesh Mesh.
 * @property material Material, open as long as it is drawn.
 * @property technique Way to draw it.
 * @property number Number of the material of a BTF, from 0.
 * @property mapping Rule by which the material lies on the mesh; null stands for [Mapping.UV] of BTFs, [Mapping.BOX] of others.
 * @property copiesU Copies of the patch within the unit square of texture coordinates, in u.
 * @property copiesV Likewise in v.
 * @property roughness GGX roughness of the smooth coat over the material, 0 to 1.
 * @property worldFromMesh Rotation, uniform scale and translation, 16 numbers column by column.
 */
@Suppress("LongParameterList")
public class SceneObject
    @JvmOverloads
    constructor(
        public val mesh: SubsurfMesh,
        public val material: SubsurfMaterial,
        public val technique: Technique = Technique.AUTOMATIC,
        public val number: Int = 0,
        public val mapping: Mapping? = null,
        public val copiesU: Float = 4f,
        public val copiesV: Float = 4f,
        public val roughness: Float = 0.25f,
        worldFromMesh: FloatArray = IDENTITY,
    ) {
        internal val matrix: FloatArray = worldFromMesh.copyOf()

        /** A copy. */
        public val worldFromMesh: FloatArray get() = matrix.copyOf()

        init {
            require(matrix.size == MATRIX) { "worldFromMesh has ${matrix.size} numbers, expected are 16" }
        }

        internal val mappingOrUsual: Mapping
            get() =
                mapping ?: when (material.file.family) {
                    Family.BSSRDF, Family.KERNEL -> Mapping.BOX
                    Family.NESTED_BTF, Family.FACTORED_BTF, Family.OTHER -> Mapping.UV
                }

        private companion object {
            const val MATRIX = 16
            val IDENTITY = FloatArray(MATRIX) { if (it % 5 == 0) 1f else 0f }
        }
    }

/** Light. Irradiance is that of a surface that faces it: linear Rec. 709; of a point or spot light where the scene's middle is. */
public class Light private constructor(
    internal val kind: Kind,
    internal val place: Vector3,
    internal val irradiance: Vector3,
    internal val hasShadow: Boolean,
    internal val targetMm: Vector3 = Vector3(0f, 0f, 0f),
    internal val halfAngleRad: Float = 0f,
) {
    /** Kinds, in the order of `SubsurfLightKind`. */
    internal enum class Kind { DIRECTIONAL, POINT, SPOT }

    /** Makers. */
    public companion object {
        private val SUN = Vector3(3f, 2.9f, 2.7f)

        /** Light from far away; [towards] is the direction towards it. */
        @JvmStatic
        @JvmOverloads
        public fun directional(towards: Vector3, irradiance: Vector3 = SUN, hasShadow: Boolean = true): Light =
            Light(Kind.DIRECTIONAL, towards.normalized, irradiance, hasShadow)

        /** Light at a place, to all sides. */
        @JvmStatic
        @JvmOverloads
        public fun point(positionMm: Vector3, irradiance: Vector3 = SUN, hasShadow: Boolean = true): Light =
            Light(Kind.POINT, positionMm, irradiance, hasShadow)

        /** Light at a place, within an angle of its axis towards [targetMm]. */
        @JvmStatic
        @JvmOverloads
        public fun spot(
            positionMm: Vector3,
            targetMm: Vector3,
            halfAngleRad: Float,
            irradiance: Vector3 = SUN,
            hasShadow: Boolean = true,
        ): Light = Light(Kind.SPOT, positionMm, irradiance, hasShadow, targetMm, halfAngleRad)
    }
}

/** Light from all around. */
public class Environment private constructor(
    /** Irradiance of a uniform one; the studio has none. */
    internal val irradiance: Vector3?,
) {
    /** Makers. */
    public companion object {
        /** Studio: a large soft light above, and dim walls. */
        @JvmField
        public val STUDIO: Environment = Environment(null)

        /** The same light from all sides; its irradiance, linear Rec. 709. */
        @JvmStatic
        public fun uniform(irradiance: Vector3): Environment = Environment(irradiance)
    }
}
