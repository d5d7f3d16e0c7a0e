package dev.subsurf

import kotlin.math.hypot

/**
 * Fingers on a view: one turns the scene, two move the light together and zoom apart.
 *
 * @property heightOf Height of the view in pixels.
 */
internal class Touch(private val heightOf: () -> Int) {
    /** What fingers did. */
    interface Listener {
        /** One finger moved: shares of the height, y down. */
        fun onTurn(x: Float, y: Float)

        /** Two fingers moved together: shares of the height, y down. */
        fun onDrag(x: Float, y: Float)

        /** Two fingers came so many times further apart. */
        fun onZoom(factor: Float)
    }

    private var last: Fingers? = null

    private data class Fingers(val count: Int, val x: Float, val y: Float, val apart: Float)

    /** Fingers at these places in pixels: their middle is followed as long as their number stays. */
    fun at(xs: FloatArray, ys: FloatArray, listener: Listener) {
        val apart = if (xs.size == 2) hypot(xs[1] - xs[0], ys[1] - ys[0]) else 0f
        val now = Fingers(xs.size, xs.average().toFloat(), ys.average().toFloat(), apart)
        val before = last
        last = now
        if (before?.count != now.count) return
        val height = heightOf().coerceAtLeast(1)
        val x = (now.x - before.x) / height
        val y = (now.y - before.y) / height
        when (now.count) {
            1 -> listener.onTurn(x, y)
            2 -> {
                listener.onDrag(x, y)
                if (before.apart > 0 && now.apart > 0) listener.onZoom(now.apart / before.apart)
            }
        }
    }

    /** Fingers left, or came. */
    fun reset() {
        last = null
    }
}
