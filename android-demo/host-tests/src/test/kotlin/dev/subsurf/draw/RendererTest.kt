package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertThrows
import org.junit.Assert.assertTrue
import org.junit.Assume.assumeTrue
import org.junit.Test
import java.nio.ByteBuffer
import java.nio.ByteOrder
import java.nio.IntBuffer

/** Pictures by the library itself, on both APIs. */
class RendererTest {
    private val backends = listOf(Backend.VULKAN, Backend.GL)

    /** Opens a device; a machine without one for this API does not count. */
    private fun open(backend: Backend): SubsurfRenderer? =
        try {
            SubsurfRenderer.open(backend)
        } catch (e: SubsurfException.NoDevice) {
            println("$backend is not here: ${e.message}")
            null
        }

    private fun onEach(work: (SubsurfRenderer) -> Unit) {
        val renderers = backends.mapNotNull(::open)
        assumeTrue("no device at all", renderers.isNotEmpty())
        renderers.forEach { it.use(work) }
    }

    private fun scene(material: SubsurfMaterial, shape: Shape = Shape.SPHERE, technique: Technique = Technique.AUTOMATIC) =
        Scene(listOf(SceneObject(SubsurfMesh.of(shape), material, technique)))

    private fun SubsurfMaterial.Companion.named(name: String) = open(TestFiles.material("$name.subsurf").path)

    /** Pixels that are not background. */
    private fun covered(picture: ByteBuffer): Int {
        val corner = picture.getInt(0)
        return (0 until picture.capacity() / 4).count { picture.getInt(4 * it) != corner }
    }

    @Test
    fun everyFamilyIsDrawnAndReported() =
        onEach { renderer ->
            for ((name, technique) in listOf(
                "jade" to Technique.AUTOMATIC,
                "jade" to Technique.SPLAT,
                "jade-splat" to Technique.AUTOMATIC,
                "leather" to Technique.AUTOMATIC,
                "skin" to Technique.AUTOMATIC,
                "skin" to Technique.KERNEL,
            )) {
                SubsurfMaterial.named(name).use { material ->
                    val report = renderer.load(material, technique)
                    println(report.toCsv(name))
                    assertEquals(material.file.byteCount, report.fileBytes)
                    assertTrue(report.uploadNanos > 0 && report.firstFrameNanos > 0 && report.openNanos > 0)
                    assertTrue(report.materialBytes in 1..report.gpuBytes)
                    val fields = report.toCsv("a").replace(Regex("\"[^\"]*\""), "").split(',')
                    assertEquals(LoadReport.CSV_HEADER.split(',').size, fields.size)
                    val picture = renderer.draw(scene(material, technique = technique), 48, 32)
                    val share = covered(picture) / (48f * 32f)
                    assertTrue("$name covers $share", share in 0.1f..0.6f)
                }
            }
        }

    @Test
    fun sphereOfBuffersIsLikeTheShape() =
        onEach { renderer ->
            SubsurfMaterial.named("jade").use { material ->
                val square = SubsurfMesh.of(
                    floatArrayOf(-10f, -10f, 0f, 10f, -10f, 0f, 10f, 10f, 0f, -10f, 10f, 0f),
                    intArrayOf(0, 1, 2, 0, 2, 3),
                )
                val facing = Orbit(0f, 0f)
                val picture = renderer.draw(Scene(listOf(SceneObject(square, material)), camera = facing), 32, 32)
                assertTrue("${covered(picture)}", covered(picture) in 50..500)
                assertThrows(SubsurfException.InvalidMesh::class.java) {
                    val broken = SubsurfMesh.of(FloatArray(9), intArrayOf(0, 1, 7))
                    renderer.draw(Scene(listOf(SceneObject(broken, material))), 8, 8)
                }
            }
        }

    @Test
    fun lightAndEyeMoveThePicture() =
        onEach { renderer ->
            SubsurfMaterial.named("jade").use { material ->
                val shown = listOf(SceneObject(SubsurfMesh.of(Shape.KNOT), material))
                fun draw(light: Vector3, orbit: Orbit) =
                    renderer.draw(Scene(shown, listOf(Light.directional(light)), orbit), 32, 32)
                val first = draw(Vector3(0f, 1f, 0f), Orbit())
                assertEquals(first, draw(Vector3(0f, 1f, 0f), Orbit()))
                assertTrue(first != draw(Vector3(1f, 0f, 0f), Orbit()))
                assertTrue(first != draw(Vector3(0f, 1f, 0f), Orbit(aroundRad = 2f)))
            }
        }

    @Test
    fun trimGivesMemoryUpUntilTheNextFrame() =
        onEach { renderer ->
            SubsurfMaterial.named("jade").use { material ->
                val scene = scene(material)
                val first = renderer.draw(scene, 32, 32)
                val full = renderer.memory
                assertTrue(full.materialsBytes > 0 && full.meshesBytes > 0 && full.framesBytes > 0)
                renderer.trim()
                val trimmed = renderer.memory
                assertEquals(0, trimmed.materialsBytes)
                assertEquals(0, trimmed.meshesBytes)
                assertTrue(trimmed.bytes < full.bytes / 2)
                assertEquals(first, renderer.draw(scene, 32, 32))
                assertEquals(full.bytes, renderer.memory.bytes)
            }
        }

    @Test
    fun whatWasShownBeforeDoesNotPileUp() =
        onEach { renderer ->
            SubsurfMaterial.named("jade").use { renderer.draw(scene(it), 16, 16) }
            val first = renderer.memory
            repeat(5) {
                SubsurfMaterial.named("jade").use { renderer.draw(scene(it), 16, 16) }
                val now = renderer.memory
                assertEquals(first.materialsBytes, now.materialsBytes)
                assertEquals(first.meshesBytes, now.meshesBytes)
            }
        }

    @Test
    fun buffersOfAnotherByteOrderAreRefused() {
        val other = if (ByteOrder.nativeOrder() == ByteOrder.BIG_ENDIAN) ByteOrder.LITTLE_ENDIAN else ByteOrder.BIG_ENDIAN
        fun buffer(order: ByteOrder) = ByteBuffer.allocateDirect(36).order(order)
        val indices = buffer(ByteOrder.nativeOrder()).asIntBuffer().limit(3) as IntBuffer
        SubsurfMesh.of(buffer(ByteOrder.nativeOrder()).asFloatBuffer(), indices)
        val error =
            assertThrows(IllegalArgumentException::class.java) { SubsurfMesh.of(buffer(other).asFloatBuffer(), indices) }
        assertEquals("positions is $other, expected is ${ByteOrder.nativeOrder()}", error.message)
    }

    @Test
    fun scenesDoNotFollowTheListsTheyWereMadeOf() {
        SubsurfMaterial.named("jade").use { material ->
            val matrix = FloatArray(16)
            val one = SceneObject(SubsurfMesh.of(Shape.SPHERE), material, worldFromMesh = matrix)
            val objects = mutableListOf(one)
            val scene = Scene(objects)
            objects.clear()
            matrix[0] = 1f
            assertEquals(listOf(one), scene.objects)
            one.worldFromMesh[0] = 1f
            assertEquals(0f, one.worldFromMesh[0])
        }
    }

    @Test
    fun lostDeviceIsSaid() =
        onEach { renderer ->
            SubsurfMaterial.named("jade").use { material ->
                renderer.draw(scene(material), 16, 16)
                renderer.lose()
                assertThrows(SubsurfException.DeviceLost::class.java) { renderer.draw(scene(material), 16, 16) }
            }
        }

    @Test
    fun closedMaterialsAndRenderersSaySo() =
        onEach { renderer ->
            val material = SubsurfMaterial.named("jade")
            material.close()
            val error = assertThrows(IllegalStateException::class.java) { renderer.draw(scene(material), 8, 8) }
            assertEquals("the file is closed", error.message)
            SubsurfMaterial.named("leather-factored").use {
                assertThrows(Exception::class.java) { renderer.load(it) }
            }
            renderer.close()
            assertThrows(IllegalStateException::class.java) { renderer.memory }
        }

    /** Open, draw, close, many times: neither memory nor handles grow. */
    @Test
    fun cyclesLeaveNothing() =
        onEach { renderer ->
            fun cycle() =
                SubsurfMaterial.named("jade").use { material ->
                    renderer.draw(scene(material), 8, 8)
                    renderer.trim()
                }
            repeat(CYCLES / 10) { cycle() }
            val (bytes, resident) = renderer.memory.bytes to settledResident()
            val handles = handles()
            repeat(CYCLES) { cycle() }
            assertEquals(bytes, renderer.memory.bytes)
            assertEquals(handles, handles())
            val grown = settledResident() - resident
            println("${renderer.device.backend}: $CYCLES cycles, resident memory grew by ${grown / 1024} kB")
            assertTrue("$grown bytes", grown < MOST_GROWTH)
        }

    /** Resident memory after the collector ran. */
    private fun settledResident(): Long {
        System.gc()
        return LoadReport.residentBytes()
    }

    private fun handles(): Int = java.io.File("/proc/self/fd").list()?.size ?: 0

    private companion object {
        val CYCLES: Int = Integer.getInteger("cycles", 100)
        const val MOST_GROWTH = 4L shl 20
    }
}
