package dev.subsurf

import java.io.File
import java.io.FileOutputStream
import java.io.IOException
import java.util.concurrent.locks.ReentrantLock
import kotlin.concurrent.withLock

/**
 * Memory of the backends that ended the process when they were started: drivers may crash where nothing can be caught. Each process
 * has a mark, with the starts that it has not outlived yet; the mark of a process that is gone stands for a crash.
 *
 * A folder that cannot be written to is no error: nothing is remembered then. Threads: any number at once.
 *
 * @property folder Folder of the app's own, which stays between starts.
 * @property system What the memory is about, such as the version of the system: another forgets all.
 * @property process Name of this process, as [processName] makes it.
 */
internal class BackendMemory(
    private val folder: File,
    private val system: String,
    private val process: String = OWN,
) {
    private val mark = File(folder, MARK + process)
    private val avoided = File(folder, "subsurf-avoid")

    /** The backend that was preferred, or the other one if it has crashed before; if both have, GL. */
    fun choose(preferred: Backend): Backend {
        val crashed = attempt { crashed() }.orEmpty()
        return listOf(preferred, Backend.GL, Backend.VULKAN).firstOrNull { it.name !in crashed } ?: Backend.GL
    }

    /** A start begins: the mark is on the disk when this returns. */
    fun starting(backend: Backend) {
        attempt {
            folder.mkdirs()
            write(starts(mark) + backend.name)
        }
    }

    /** The process outlived one start of a backend. */
    fun survived(backend: Backend) {
        attempt {
            val left = starts(mark) - backend.name
            if (left.isEmpty()) mark.delete() else write(left)
        }
    }

    /** Forgets what has crashed. */
    fun forget() {
        avoided.delete()
    }

    /** Backends that crashed on this system, those of the marks that are found among them. */
    private fun crashed(): Set<String> {
        val lines = starts(avoided)
        val before = if (lines.firstOrNull() == system) lines.drop(1).toSet() else emptySet()
        val marks = folder.listFiles { file -> file.name.startsWith(MARK) }.orEmpty()
        val dead = marks.filter { it != mark && !isAlive(it.name.removePrefix(MARK)) }
        if (dead.isEmpty()) return before
        val all = before + dead.flatMap(::starts)
        avoided.writeText((listOf(system) + all).joinToString("\n"))
        dead.forEach(File::delete)
        return all
    }

    private fun starts(file: File): List<String> = if (file.isFile) file.readLines() else emptyList()

    private fun write(starts: List<String>) =
        FileOutputStream(mark).use {
            it.write(starts.joinToString("\n").toByteArray())
            it.fd.sync()
        }

    private fun <T> attempt(work: () -> T): T? =
        lock.withLock {
            try {
                work()
            } catch (_: IOException) {
                null
            }
        }

    internal companion object {
        private const val MARK = "subsurf-start-"
        private const val START_TIME = 19

        /** Guards the files against other views of the process. */
        private val lock = ReentrantLock()

        /** Number of a process and the time of its start, which no later process of that number has; see proc(5). */
        fun processName(number: String): String? =
            try {
                // The second field, in parentheses, may have spaces in it.
                val text = File("/proc/$number/stat").readText()
                val fields = text.substringAfterLast(") ").split(' ')
                "${text.substringBefore(' ')}-${fields[START_TIME]}"
            } catch (_: IOException) {
                null
            }

        private val OWN = processName("self") ?: "0-0"

        private fun isAlive(process: String) = processName(process.substringBefore('-')) == process
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
    /** Start that the process has not outlived yet. */
    private var starting: Backend? = null

    override fun open(): Engine {
        val first = memory.choose(preferred)
        return try {
            started(first)
        } catch (_: SubsurfException.NoDevice) {
            survived()
            started(if (first == Backend.GL) Backend.VULKAN else Backend.GL)
        }
    }

    private fun started(backend: Backend): Engine {
        memory.starting(backend)
        starting = backend
        return open(backend)
    }

    override fun survived() {
        starting?.let(memory::survived)
        starting = null
    }
}
