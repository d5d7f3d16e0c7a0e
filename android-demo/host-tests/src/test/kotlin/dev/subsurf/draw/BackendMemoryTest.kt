package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Rule
import org.junit.Test
import org.junit.rules.TemporaryFolder

class BackendMemoryTest {
    @get:Rule val folder = TemporaryFolder()

    private var process = 0

    /** Memory of a process that does not run: there are fewer than that. */
    private fun memory(system: String = "Android 15") = BackendMemory(folder.root, system, "99999999-${process++}")

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
        memory().run {
            starting(Backend.VULKAN)
            survived(Backend.VULKAN)
        }
        assertEquals(Backend.VULKAN, memory().choose(Backend.VULKAN))
    }

    @Test
    fun startOfAnotherViewIsNoCrash() {
        val running = List(2) { BackendMemory(folder.root, "Android 15") }
        running.forEach { it.starting(Backend.VULKAN) }
        assertEquals("in this process", Backend.VULKAN, running[1].choose(Backend.VULKAN))
        assertEquals("in another, while this one runs", Backend.VULKAN, memory().choose(Backend.VULKAN))
        running[1].survived(Backend.VULKAN)
        assertEquals("the other start goes on", 1, folder.root.list()!!.size)
        running[0].survived(Backend.VULKAN)
        assertEquals(0, folder.root.list()!!.size)
    }

    @Test
    fun folderThatCannotBeWrittenToIsNoError() {
        val memory = BackendMemory(folder.newFile(), "Android 15")
        memory.starting(Backend.VULKAN)
        assertEquals(Backend.VULKAN, memory.choose(Backend.VULKAN))
        memory.survived(Backend.VULKAN)
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
