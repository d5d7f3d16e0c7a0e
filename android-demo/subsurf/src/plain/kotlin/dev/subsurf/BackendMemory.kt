package dev.subsurf

import java.io.File
import java.io.FileOutputStream

/**
 * Memory of the backends that ended the process when they were started: drivers may crash where nothing can be caught. A start
 * leaves a mark, which is taken away once the process has outlived it; a mark that is found stands for a crash.
 *
 * @property folder Folder of the app's own, which stays between starts.
 * @property system What the memory is about, such as the version of the system: another forgets all.
 */
internal class BackendMemory(private val folder: File, private val system: String) {
    private val mark = File(folder, "subsurf-start")
    private val avoided = File(folder, "subsurf-avoid")

    /** The backend that was preferred, or the other one if it has crashed before; if both have, GL. */
    fun choose(preferred: Backend): Backend {
        if (mark.isFile) {
            val crashed = read() + mark.readText()
            avoided.writeText((listOf(system) + crashed).joinToString("\n"))
            mark.delete()
        }
        val crashed = read()
        return listOf(preferred, Backend.GL, Backend.VULKAN).firstOrNull { it.name !in crashed } ?: Backend.GL
    }

    /** A start begins: the mark is on the disk when this returns. */
    fun starting(backend: Backend) {
        folder.mkdirs()
        FileOutputStream(mark).use {
            it.write(backend.name.toByteArray())
            it.fd.sync()
        }
    }

    /** The process outlived the start. */
    fun survived() {
        mark.delete()
    }

    /** Forgets what has crashed. */
    fun forget() {
        avoided.delete()
    }

    /** Backends that crashed on this system. */
    private fun read(): Set<String> {
        val lines = if (avoided.isFile) avoided.readLines() else emptyList()
        return if (lines.firstOrNull() == system) lines.drop(1).toSet() else emptySet()
    }
}

/**
 * Source of engines that remembers crashes, and takes the other backend where one has no device.
 *
 * @property preferred Backend to begin with.
 */
internal class RememberingSource(
    private val memory: BackendMemory,
    private val preferred: Backend,
    private val open: (Backend) -> Engine,
) : EngineSource {
    private var isStarting = false

    override fun open(): Engine {
        val first = memory.choose(preferred)
        return try {
            started(first)
        } catch (_: SubsurfException.NoDevice) {
            started(if (first == Backend.GL) Backend.VULKAN else Backend.GL)
        }
    }

    private fun started(backend: Backend): Engine {
        memory.starting(backend)
        isStarting = true
        return open(backend)
    }

    override fun survived() {
        if (isStarting) memory.survived()
        isStarting = false
    }
}
