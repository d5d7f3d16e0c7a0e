package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Rule
import org.junit.Test
import org.junit.rules.TemporaryFolder

class BackendMemoryTest {
    @get:Rule val folder = TemporaryFolder()

    private fun memory(system: String = "Android 15") = BackendMemory(folder.root, system)

    @Test
    fun crashIsRememberedAndForgotten() {
        assertEquals(Backend.VULKAN, memory().choose(Backend.VULKAN))
        memory().starting(Backend.VULKAN)
        // The process ends here; the next one finds the mark.
        assertEquals(Backend.GL, memory().choose(Backend.VULKAN))
        assertEquals("for good", Backend.GL, memory().choose(Backend.VULKAN))
        assertEquals("of another system", Backend.VULKAN, memory("Android 16").choose(Backend.VULKAN))
        memory().forget()
        assertEquals(Backend.VULKAN, memory().choose(Backend.VULKAN))
    }

    @Test
    fun outlivedStartIsNone() {
        memory().starting(Backend.VULKAN)
        memory().survived()
        assertEquals(Backend.VULKAN, memory().choose(Backend.VULKAN))
    }

    @Test
    fun whenBothHaveCrashedGlIsTried() {
        for (backend in listOf(Backend.GL, Backend.VULKAN)) {
            memory().starting(backend)
            memory().choose(Backend.VULKAN)
        }
        assertEquals(Backend.GL, memory().choose(Backend.VULKAN))
    }

    @Test
    fun backendWithoutADeviceIsReplaced() {
        val opened = mutableListOf<Backend>()
        val source =
            RememberingSource(memory(), Backend.VULKAN) { backend ->
                opened += backend
                if (backend == Backend.VULKAN) throw SubsurfException.NoDevice(9, "none")
                FakeSource().open()
            }
        source.open()
        assertEquals(listOf(Backend.VULKAN, Backend.GL), opened)
        source.survived()
        assertEquals(Backend.VULKAN, memory().choose(Backend.VULKAN))
    }

    @Test
    fun crashWithinAStartIsOfTheBackendThatWasStarted() {
        val source = RememberingSource(memory(), Backend.GL) { error("a crash") }
        assertThrows(IllegalStateException::class.java) { source.open() }
        assertEquals(Backend.VULKAN, memory().choose(Backend.GL))
    }
}
