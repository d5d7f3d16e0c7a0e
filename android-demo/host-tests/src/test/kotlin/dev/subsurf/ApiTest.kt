package dev.subsurf

import org.jetbrains.kotlin.abi.tools.AbiFilters
import org.jetbrains.kotlin.abi.tools.AbiToolsFactory
import org.junit.Assert.assertEquals
import org.junit.Test
import java.io.File
import java.util.ServiceLoader

/** The API of the library, as other code is compiled against it. */
class ApiTest {
    /** A difference is either a mistake or a new version: `-Dwrite.api=true` writes the file. */
    @Test
    fun apiIsWhatTheFileSays() {
        val resources = Regex("""R(\$.*)?""")
        val compiled = File("target/classes/dev/subsurf").listFiles { file -> file.extension == "class" }!!
        val classes = compiled.filterNot { resources.matches(it.nameWithoutExtension) }
        val dump = StringBuilder()
        val all = AbiFilters(emptySet(), emptySet(), emptySet(), emptySet())
        ServiceLoader.load(AbiToolsFactory::class.java).first().get().printJvmDump(dump, classes.sorted(), all)
        val expected = File("../subsurf/api/subsurf.api")
        if (System.getProperty("write.api") == "true") expected.writeText(dump.toString())
        assertEquals(expected.readText(), dump.toString())
    }
}
