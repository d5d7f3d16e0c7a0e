package dev.subsurf

import java.io.File
import java.util.concurrent.TimeUnit

/**
 * The program `load_test`, which measures loads without this API: of files, and of the captures and images that they stand for,
 * uncompressed.
 *
 * @property folder Where those are written, and deleted.
 */
internal class LoadProgram(
    private val program: File,
    private val folder: File,
    private val repeats: Int,
) {
    /** Its table in CSV; in it no technique but "decoder" where the API has no device. */
    fun run(backend: Backend, files: List<File>): String {
        val options = listOf("--${backend.name.lowercase()}", "--repeats", repeats.toString(), "--raw", folder.path)
        val errors = File(folder, "load_test.err")
        val process = ProcessBuilder(listOf(program.path) + options + files.map { it.path }).redirectError(errors).start()
        val table = process.inputStream.bufferedReader().use { it.readText() }
        check(process.waitFor(1, TimeUnit.MINUTES) && process.exitValue() == 0) { errors.readText() }
        return table
    }

    companion object {
        /** Materials whose captures and images are measured, by their files' names. */
        val MATERIALS = listOf("jade", "jade-profiles", "leather")
    }
}
