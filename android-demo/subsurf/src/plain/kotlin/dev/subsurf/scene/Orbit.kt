package dev.subsurf

import kotlin.math.PI
import kotlin.math.cos
import kotlin.math.sin

/**
 * Eye that looks at the middle of a scene from all around.
 *
 * @property aroundRad Angle around the up axis in rad, from z towards x.
 * @property upRad Angle above the horizon in rad, within 1.52 of it: at the poles left and right would swap.
 * @property distance Distance in radii of the scene, 1.2 to 16.
 */
public data class Orbit
    @JvmOverloads
    constructor(
        public val aroundRad: Float = AROUND,
        public val upRad: Float = UP,
        public val distance: Float = DISTANCE,
    ) : Camera {
        /** Orbit after the scene was turned with a finger: shares of the height of the view, y down. */
        public fun turned(x: Float, y: Float): Orbit =
            copy(aroundRad = aroundRad - x * TURN, upRad = (upRad + y * TURN).coerceIn(-HIGHEST, HIGHEST))

        /** Orbit after two fingers came so many times further apart. */
        public fun zoomed(factor: Float): Orbit = copy(distance = (distance / factor).coerceIn(NEAREST, FURTHEST))

        /** The eye, for a scene within a sphere. */
        override fun lookAt(bounds: Bounds): LookAt {
            val towards = Vector3(cos(upRad) * sin(aroundRad), sin(upRad), cos(upRad) * cos(aroundRad))
            return LookAt(bounds.centreMm + towards * (distance * bounds.radiusMm), bounds.centreMm, FOV)
        }

        /** Direction of a light of length 1 after it was dragged: shares of the height of the view, y down. */
        public fun dragged(light: Vector3, x: Float, y: Float): Vector3 {
            val back = lookAt(Bounds(Vector3(0f, 0f, 0f), 1f)).eyeMm.normalized
            val right = (Vector3(0f, 1f, 0f) cross back).normalized
            val up = back cross right
            return light.rotated(up, x * TURN).rotated(right, y * TURN).normalized
        }

        private companion object {
            const val AROUND = 0.5f
            const val UP = 0.33f
            const val DISTANCE = 4.2f
            const val FOV = 0.5f
            const val TURN = PI.toFloat()
            const val HIGHEST = 1.52f
            const val NEAREST = 1.2f
            const val FURTHEST = 16f
        }
    }

/** Vector after a turn about an axis of length 1 (Rodrigues' formula). */
private fun Vector3.rotated(axis: Vector3, angle: Float): Vector3 =
    this * cos(angle) + (axis cross this) * sin(angle) + axis * ((axis dot this) * (1 - cos(angle)))
