package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Assert.assertTrue
import org.junit.Test
import kotlin.concurrent.thread
import kotlin.math.abs

class BtfTest {
    private val up = Vector3(0f, 0f, 1f)
    private val aside = Vector3(0.6f, 0f, 0.8f)

    @Test
    fun nestedBtfsAreEvaluated() {
        SubsurfFile.open(TestFiles.material("leather.subsurf").path).use { file ->
            assertEquals(Family.NESTED_BTF, file.family)
            val btf = file.btf
            val material = btf.materials.single()
            assertEquals("leather", material.name)
            assertEquals(16, material.width)
            assertEquals(0, btf.expansionBytes)
            assertTrue(btf.isDisplay)
            val texel = btf.texel(0, 0, 3, 5)
            assertEquals(5 * material.width + 3, texel)
            val value = btf.eval(texel, up, aside)
            assertTrue(value.all { it > 0 })
            val linear = btf.linear(value)
            assertTrue(linear.zip(value).all { (light, shown) -> light < shown })
            val dark = btf.eval(texel, Vector3(0f, 0.6f, -0.8f), aside)
            assertTrue(dark.all { it == 0f })
            assertTrue(btf.albedo(texel, aside).all { it >= 0 })
            val sample = btf.sample(texel, aside, 0.3f, 0.7f)
            val pdf = btf.pdf(texel, sample.light, aside)
            assertTrue("$pdf ${sample.pdf}", abs(pdf - sample.pdf) < 1e-3f * sample.pdf)
            assertTrue(abs(sample.light.length - 1) < 1e-4f && sample.light.z >= 0)
            assertThrows(IllegalArgumentException::class.java) { btf.eval(btf.texelCount, up, up) }
            assertThrows(IllegalArgumentException::class.java) { btf.texel(1, 0, 0, 0) }
            assertThrows(IllegalArgumentException::class.java) { btf.texel(0, -1, 0, 0) }
            assertThrows(SubsurfException.WrongFamily::class.java) { file.bssrdf }
        }
    }

    @Test
    fun factoredBtfsAreExpandedFirst() {
        SubsurfFile.open(TestFiles.material("leather-factored.subsurf").path).use { file ->
            val btf = file.btf
            assertEquals(Family.FACTORED_BTF, file.family)
            assertTrue(btf.expansionBytes > 0)
            assertThrows(IllegalStateException::class.java) { btf.eval(0, up, aside) }
            btf.expand()
            btf.expand()
            assertTrue(btf.eval(0, up, aside).all { it > 0 })
            assertThrows(SubsurfException.WrongFamily::class.java) { btf.sample(0, up, 0.5f, 0.5f) }
        }
    }

    @Test
    fun manyThreadsEvaluateAtOnce() {
        SubsurfFile.open(TestFiles.material("leather.subsurf").path).use { file ->
            val btf = file.btf
            val expected = List(btf.texelCount) { btf.eval(it, up, aside).toList() }
            val wrong = IntArray(4)
            val threads =
                List(wrong.size) { k ->
                    thread {
                        repeat(5) { wrong[k] += expected.indices.count { btf.eval(it, up, aside).toList() != expected[it] } }
                    }
                }
            threads.forEach(Thread::join)
            assertEquals(0, wrong.sum())
        }
    }
}
