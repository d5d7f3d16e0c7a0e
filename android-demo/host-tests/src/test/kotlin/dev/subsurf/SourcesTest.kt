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

    /** Numbers of the C API are places in Kotlin's enums. */
    @Test
    fun enumsAreThoseOfTheHeader() {
        val header = File("../../bindings/include/subsurf.h").readText()
        val constant = Regex("""SUBSURF_(\w+) = (\d+),""")

        fun same(
            name: String,
            entries: List<Enum<*>>,
            elsewhere: List<String> = emptyList(),
        ) {
            val prefix = name.replace(Regex("(?<=[a-z])(?=[A-Z])"), "_").uppercase() + "_"
            val body = Regex("""\nenum Subsurf$name\n.*?\n};""", RegexOption.DOT_MATCHES_ALL).find(header)!!.value
            val found = constant.findAll(body).map { it.groupValues[1].removePrefix(prefix) to it.groupValues[2].toInt() }.toList()
            assertEquals(name, found.filterNot { it.first in elsewhere }, entries.map { it.name to it.ordinal })
        }
        same("Family", Family.entries)
        same("Coding", Coding.entries)
        same("Addressing", Addressing.entries)
        same("PlaneKind", PlaneKind.entries)
        same("Format", PlaneFormat.entries)
        same("Backend", Backend.entries, listOf("METAL", "DX12"))
        same("Technique", Technique.entries)
        same("WindowSystem", SubsurfRenderer.Companion.Windows.entries, listOf("X11", "WAYLAND"))
        same("Shape", Shape.entries)
        same("LightKind", Light.Kind.entries)
        same("Mapping", Mapping.entries)
    }

    /** Attributes in XML have a name for each entry, and its place. */
    @Test
    fun attributesAreTheEnums() {
        val xml = File(module, "main/res/values/attrs.xml").readText()
        val constant = Regex("""<enum name="(\w+)" value="(\d+)" />""")

        fun same(
            name: String,
            entries: List<Enum<*>>,
        ) {
            val body = xml.substringAfter("<attr name=\"$name\"").substringBefore("</attr>")
            val found = constant.findAll(body).map { it.groupValues[1] to it.groupValues[2].toInt() }.toList()
            assertEquals(name, found, entries.map { it.name.lowercase() to it.ordinal })
        }
        same("subsurfShape", Shape.entries)
        same("subsurfTechnique", Technique.entries)
        same("subsurfBackend", Backend.entries)
    }
}
