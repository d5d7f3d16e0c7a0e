package dev.subsurf

import kotlin.math.sqrt

/** View of a scene, which may depend on how large the scene is. */
public fun interface Camera {
    /** Eye for a scene within a sphere. */
    public fun lookAt(bounds: Bounds): LookAt
}

/**
 * Sphere that holds a scene.
 *
 * @property centreMm Middle in mm.
 * @property radiusMm Radius in mm.
 */
public data class Bounds(public val centreMm: Vector3, public val radiusMm: Float) {
    /** Sphere that holds both. */
    internal fun union(other: Bounds): Bounds {
        val between = (other.centreMm - centreMm).length
        return when {
            between + other.radiusMm <= radiusMm -> this
            between + radiusMm <= other.radiusMm -> other
            else -> {
                val radius = (between + radiusMm + other.radiusMm) / 2
                Bounds(centreMm + (other.centreMm - centreMm) * ((radius - radiusMm) / between), radius)
            }
        }
    }

    /** Sphere after a rotation, a uniform scale and a translation, 16 numbers column by column. */
    @Suppress("MagicNumber")
    internal fun transformed(matrix: FloatArray): Bounds {
        val (x, y, z) = centreMm
        fun row(i: Int) = matrix[i] * x + matrix[4 + i] * y + matrix[8 + i] * z + matrix[12 + i]
        val scale = Vector3(matrix[0], matrix[1], matrix[2]).length
        return Bounds(Vector3(row(0), row(1), row(2)), radiusMm * scale)
    }
}

/**
 * Eye at a place.
 *
 * @property eyeMm Place of the eye in mm.
 * @property targetMm Place that it looks at in mm.
 * @property fovYRad Angle of the view from bottom to top in rad.
 */
public data class LookAt(
    public val eyeMm: Vector3,
    public val targetMm: Vector3,
    public val fovYRad: Float,
) : Camera {
    /** The eye itself. */
    override fun lookAt(bounds: Bounds): LookAt = this

    /** Both matrices for a picture of an aspect, width to height: 32 numbers. The depth range holds what the sphere does. */
    internal fun matrices(bounds: Bounds, aspect: Float): FloatArray {
        val distance = (bounds.centreMm - eyeMm).length
        val far = distance + bounds.radiusMm
        val near = maxOf(distance - bounds.radiusMm, far * NEAREST)
        val (eyeX, eyeY, eyeZ) = eyeMm
        val (x, y, z) = targetMm
        val out = FloatArray(MATRICES)
        expectOk(Native.frameLookAt(floatArrayOf(eyeX, eyeY, eyeZ, x, y, z, fovYRad, aspect, near, far), out))
        return out
    }

    private companion object {
        const val NEAREST = 1e-3f
        const val MATRICES = 32
    }
}

internal operator fun Vector3.plus(other: Vector3) = Vector3(x + other.x, y + other.y, z + other.z)

internal operator fun Vector3.minus(other: Vector3) = Vector3(x - other.x, y - other.y, z - other.z)

internal operator fun Vector3.times(factor: Float) = Vector3(x * factor, y * factor, z * factor)

internal infix fun Vector3.cross(other: Vector3) =
    Vector3(y * other.z - z * other.y, z * other.x - x * other.z, x * other.y - y * other.x)

internal infix fun Vector3.dot(other: Vector3) = x * other.x + y * other.y + z * other.z

internal val Vector3.length: Float get() = sqrt(this dot this)

internal val Vector3.normalized: Vector3 get() = this * (1 / length)
