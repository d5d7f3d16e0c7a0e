package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Test

class HandleTest {
    private val released = mutableListOf<Long>()
    private val handle = Handle("the thing", 7, null) { released += it }

    @Test
    fun releasedOnceAfterTheLastUser() {
        handle.call {
            handle.close()
            assertEquals(emptyList<Long>(), released)
            assertThrows(IllegalStateException::class.java) { handle.call { } }
        }
        assertEquals(listOf(7L), released)
        handle.close()
        assertEquals(listOf(7L), released)
    }

    @Test
    fun aloneMeansAlone() {
        handle.callAlone { assertThrows(IllegalStateException::class.java) { handle.call { } } }
        handle.call { assertThrows(IllegalStateException::class.java) { handle.callAlone { } } }
        handle.callAlone { handle.close() }
        assertEquals(listOf(7L), released)
        assertThrows(IllegalStateException::class.java) { handle.callAlone { } }
    }
}
