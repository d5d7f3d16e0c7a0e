package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Test
import java.util.concurrent.CyclicBarrier
import java.util.concurrent.atomic.AtomicBoolean
import java.util.concurrent.atomic.AtomicInteger
import kotlin.concurrent.thread

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

    /** One that has it alone, one that uses it and one that closes it, at once, many times. */
    @Test
    fun threeThreadsReleaseItOnceAndAfterTheLast() {
        val isReleased = AtomicBoolean()
        val releases = AtomicInteger()
        val early = AtomicInteger()
        lateinit var handle: Handle
        val anew = {
            isReleased.set(false)
            handle =
                Handle("the thing", 7) {
                    isReleased.set(true)
                    releases.incrementAndGet()
                }
        }
        anew()
        val begin = CyclicBarrier(3)
        val end = CyclicBarrier(3, anew)
        fun user(use: (Handle) -> Unit) =
            thread {
                repeat(ROUNDS) {
                    begin.await()
                    try {
                        use(handle)
                    } catch (_: IllegalStateException) {
                        // In use, or closed.
                    }
                    end.await()
                }
            }
        val threads =
            listOf(
                user { it.callAlone { } },
                user { it.call { if (isReleased.get()) early.incrementAndGet() } },
                user { it.close() },
            )
        threads.forEach(Thread::join)
        assertEquals("released while in use", 0, early.get())
        assertEquals(ROUNDS, releases.get())
    }

    private companion object {
        const val ROUNDS = 5000
    }
}
