package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test

/** The suite of androidTest on this machine: few repeats, unless `-Drepeats` says otherwise; target/load-times.csv. */
class LoadTimeTest {
    @Test
    fun loadsAreMeasured() {
        val lines = mutableListOf(LoadSuite.HEADER)
        for ((name, technique) in LoadSuite.MATERIALS) {
            lines += LoadSuite(Backend.AUTOMATIC, Integer.getInteger("repeats", 2)).run(name, technique) {
                SubsurfMaterial.open(TestFiles.material("$name.subsurf").path)
            }
        }
        val table = lines.joinToString("\n", postfix = "\n")
        TestFiles.output("load-times.csv").writeText(table)
        println(table)
        val columns = LoadSuite.HEADER.split(',').size
        assertEquals(1 + LoadSuite.MATERIALS.size * 2 * 7, lines.size)
        val quoted = Regex("\"[^\"]*\"")
        assertTrue(lines.all { it.replace(quoted, "").split(',').size == columns })
    }
}
