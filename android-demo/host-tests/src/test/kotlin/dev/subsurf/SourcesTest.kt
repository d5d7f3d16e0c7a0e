package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test
import java.io.File

/** What is said of the sources of the library. */
class SourcesTest {
    private val module = File("../subsurf/src")

    private fun sources(root: String) =
        File(module, "$root/kotlin").walk().filter { it.extension == "kt" }.toList().also { assertTrue(it.isNotEmpty()) }

    @Test
    fun plainSourcesKnowNoAndroid() {
        val found = sources("plain").filter { file -> file.readLines().any { it.startsWith("import android") } }
        assertEquals(emptyList<File>(), found)
    }

    /** Declarations that apps see, but for those in the header of a class, whose comment names them. */
    @Test
    fun everyPublicNameIsDocumented() {
        val declaration = Regex("""^\s*(@get:\S+ )?public (?!override|constructor).*\b(class|interface|object|fun|val|var|typealias)\b.*""")
        val missing = mutableListOf<String>()
        for (file in sources("plain") + sources("main")) {
            val lines = file.readLines()
            lines.forEachIndexed { number, line ->
                if (!declaration.matches(line)) return@forEachIndexed
                var before = number - 1
                while (before >= 0 && lines[before].trim().let { it.startsWith("@") || it == "constructor(" }) before--
                val property = Regex("""public va[lr] (\w+)""").find(line)?.groupValues?.get(1)
                val isDocumented =
                    lines[before].trim().endsWith("*/") || lines.any { it.contains("* @property $property ") }
                if (!isDocumented) missing += "${file.name}:${number + 1}: $line"
            }
        }
        assertEquals(emptyList<String>(), missing)
    }
}
