package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test
import java.io.File

/** The suite of androidTest on this machine: few repeats, unless `-Drepeats` says otherwise; target/load-times.csv. */
class LoadTimeTest {
    @Test
    fun loadsAreMeasured() {
        val lines = mutableListOf(LoadSuite.HEADER)
        for ((name, technique) in LoadSuite.MATERIALS) {
            lines += LoadSuite(Backend.AUTOMATIC, REPEATS).run(name, technique) {
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

    @Test
    fun capturesAndImagesAreMeasuredBesideTheirFiles() {
        val program = LoadProgram(File(System.getProperty("load.test")), TestFiles.output(".").normalize(), REPEATS)
        val table = program.run(Backend.VULKAN, LoadProgram.MATERIALS.map { TestFiles.material("$it.subsurf") })
        TestFiles.output("load-times-uncompressed.csv").writeText(table)
        println(table)
        val bytes = table.lines().drop(1).filter { ",median," in it }.map { it.split(',') }.groupBy({ it[2] }, { it[1].toLong() })
        assertEquals("no device", null, bytes["decoder"])
        assertEquals("${24 * 24} pixels with windows of 11 x 11", listOf(24L * 24 * 11 * 11 * 12).let { it + it }, bytes["capture"])
        assertEquals("81 x 81 images of 16 x 16", listOf(81L * 81 * 16 * 16 * 3), bytes["images"])
        assertEquals("planes, gathered", 2, bytes["gather"]?.size)
        assertEquals("the BTF", 1, bytes["btf"]?.size)
    }

    private companion object {
        val REPEATS: Int = Integer.getInteger("repeats", 2)
    }
}
