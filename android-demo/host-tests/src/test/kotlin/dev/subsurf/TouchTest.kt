package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test
import kotlin.math.abs

class TouchTest {
    private val told = mutableListOf<String>()
    private val touch = Touch { 100 }
    private val listener =
        object : Touch.Listener {
            override fun onTurn(x: Float, y: Float) {
                told += "turn $x $y"
            }

            override fun onDrag(x: Float, y: Float) {
                told += "drag $x $y"
            }

            override fun onZoom(factor: Float) {
                told += "zoom $factor"
            }
        }

    private fun at(vararg places: Float) =
        touch.at(
            places.filterIndexed { k, _ -> k % 2 == 0 }.toFloatArray(),
            places.filterIndexed { k, _ -> k % 2 == 1 }.toFloatArray(),
            listener,
        )

    @Test
    fun oneFingerTurnsAndTwoDragAndZoom() {
        at(10f, 10f)
        at(60f, 20f)
        assertEquals(listOf("turn 0.5 0.1"), told)
        told.clear()
        at(60f, 20f, 80f, 20f)
        assertTrue("a second finger is no move", told.isEmpty())
        at(60f, 70f, 100f, 70f)
        assertEquals(listOf("drag 0.1 0.5", "zoom 2.0"), told)
        told.clear()
        touch.reset()
        at(0f, 0f, 1f, 1f)
        assertTrue(told.isEmpty())
    }

    @Test
    fun orbitKeepsItsDistanceAndStaysOffThePoles() {
        var orbit = Orbit(distance = 3f)
        val bounds = Bounds(Vector3(1f, 2f, 3f), 10f)
        for ((x, y) in listOf(0.3f to 5f, -2f to -9f, 0.1f to 0.2f)) {
            orbit = orbit.turned(x, y)
            val from = orbit.lookAt(bounds).eyeMm - bounds.centreMm
            assertEquals(30f, from.length, 1e-3f)
            assertTrue(from.x * from.x + from.z * from.z > 1f)
        }
        assertEquals(1.2f, orbit.zoomed(1000f).distance, 0f)
        assertEquals(16f, orbit.zoomed(0.001f).distance, 0f)
    }

    @Test
    fun lightAtTheEyeFollowsTheFinger() {
        val orbit = Orbit(0f, 0f)
        val eye = Vector3(0f, 0f, 1f)
        val right = orbit.dragged(eye, 0.1f, 0f)
        assertTrue("$right", right.x > 0.1f && abs(right.y) < 1e-5f)
        val down = orbit.dragged(eye, 0f, 0.1f)
        assertTrue("$down", down.y < -0.1f && abs(down.x) < 1e-5f)
    }

    @Test
    fun boundsHoldWhatTheyUnite() {
        val (small, large) = Bounds(Vector3(1f, 0f, 0f), 1f) to Bounds(Vector3(0f, 0f, 0f), 5f)
        assertEquals(large, small.union(large))
        assertEquals(large, large.union(small))
        val far = small.union(Bounds(Vector3(9f, 0f, 0f), 1f))
        assertEquals(Bounds(Vector3(5f, 0f, 0f), 5f), far)
        val twice = FloatArray(16).also { for (k in 0..2) it[5 * k] = 2f }.also { it[15] = 1f }.also { it[13] = 7f }
        assertEquals(Bounds(Vector3(2f, 7f, 0f), 2f), small.transformed(twice))
    }
}
