package dev.subsurf

import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking
import org.junit.Assert.assertArrayEquals
import org.junit.Assert.assertEquals
import org.junit.Assert.assertFalse
import org.junit.Assert.assertThrows
import org.junit.Assert.assertTrue
import org.junit.Test
import java.io.File
import java.io.FileDescriptor
import java.io.RandomAccessFile
import java.nio.ByteBuffer
import java.nio.ByteOrder
import java.util.concurrent.CountDownLatch
import kotlin.concurrent.thread

class SubsurfFileTest {
    private val example = TestFiles.vector("format_example.subsurf")

    /** Number of a descriptor, which Java hides. */
    private fun number(descriptor: FileDescriptor): Int =
        FileDescriptor::class.java.getDeclaredField("fd").apply { isAccessible = true }.getInt(descriptor)

    private fun described(file: SubsurfFile) =
        file.use { "${it.family} ${it.byteCount} ${it.bssrdf.width} ${it.bssrdf.height} ${it.bssrdf.pitchMm}" }

    @Test
    fun allWaysToOpenAgree() {
        val expected = described(SubsurfFile.open(example.path))
        assertTrue(expected, expected.startsWith("BSSRDF 216 "))
        assertEquals(expected, described(SubsurfFile.open(TestFiles.buffer(example, before = 3))))
        val padded = File.createTempFile("padded", ".bin")
        padded.writeBytes(ByteArray(7) + example.readBytes() + ByteArray(9))
        RandomAccessFile(padded, "r").use {
            assertEquals(expected, described(SubsurfFile.open(number(it.fd), 7, example.length())))
            assertEquals(expected, described(SubsurfFile.open(number(it.fd), 7)))
        }
        assertTrue(padded.delete())
    }

    @Test
    fun fileOutlivesItsDescriptor() {
        val file = RandomAccessFile(example, "r").use { SubsurfFile.open(number(it.fd)) }
        file.use { assertEquals(216, it.byteCount) }
    }

    @Test
    fun pathsMayHaveAnyCharacters() {
        val named = File(System.getProperty("java.io.tmpdir"), "π-\uD83C\uDF44.subsurf")
        example.copyTo(named, overwrite = true)
        SubsurfFile.open(named.path).use { assertEquals(Family.BSSRDF, it.family) }
        assertTrue(named.delete())
        val error = assertThrows(SubsurfException.Io::class.java) { SubsurfFile.open(named.path) }
        assertTrue(error.message, error.message!!.startsWith(named.path))
        assertThrows(IllegalArgumentException::class.java) { SubsurfFile.open("a\u0000b") }
    }

    @Test
    fun errorsAreTheDecoders() {
        val cut = assertThrows(SubsurfException.InvalidFile::class.java) {
            SubsurfFile.open(TestFiles.vector("x_cut.subsurf").path)
        }
        assertTrue(cut.message, cut.message!!.contains("x_cut.subsurf: "))
        assertEquals(3, cut.status)
        val hostile = TestFiles.vector(".").listFiles { file -> file.name.startsWith("x_") }!!
        assertTrue("there are such files", hostile.size > 10)
        for (file in hostile) {
            assertThrows(file.name, SubsurfException.InvalidFile::class.java) { SubsurfFile.open(TestFiles.buffer(file)) }
        }
    }

    @Test
    fun onlyDirectBuffersAreOpened() {
        assertThrows(IllegalArgumentException::class.java) { SubsurfFile.open(ByteBuffer.wrap(example.readBytes())) }
        assertThrows(SubsurfException.InvalidFile::class.java) { SubsurfFile.open(ByteBuffer.allocateDirect(0)) }
        assertThrows(IllegalArgumentException::class.java) { SubsurfFile.open(0, -1) }
        assertThrows(IllegalArgumentException::class.java) { SubsurfFile.open(0, 0, -2) }
    }

    @Test
    fun closedFilesSaySo() {
        val file = SubsurfFile.open(example.path)
        val bssrdf = file.bssrdf
        file.close()
        file.close()
        val error = assertThrows(IllegalStateException::class.java) { bssrdf.albedo(0, 0) }
        assertEquals("the file is closed", error.message)
        assertThrows(IllegalStateException::class.java) { bssrdf.planes[0].use { it.get() } }
    }

    @Test
    fun closingWaitsForCallsUnderWay() {
        val file = SubsurfFile.open(example.path)
        val plane = file.bssrdf.planes[0]
        val (isIn, mayGo) = CountDownLatch(1) to CountDownLatch(1)
        var sum = 0
        val user =
            thread {
                plane.use {
                    isIn.countDown()
                    mayGo.await()
                    while (it.hasRemaining()) sum += it.get()
                }
            }
        isIn.await()
        file.close()
        assertThrows(IllegalStateException::class.java) { plane.use { } }
        mayGo.countDown()
        user.join()
        assertTrue("the bytes were there", sum != 0)
    }

    @Test
    fun suspendingFormsOpenTheSame() =
        runBlocking {
            SubsurfMaterial.load(example.path).use { assertEquals(216, it.file.byteCount) }
            SubsurfMaterial.load(TestFiles.buffer(example)).use { assertEquals(216, it.file.byteCount) }
            RandomAccessFile(example, "r").use { of ->
                SubsurfMaterial.load(number(of.fd)).use { assertEquals(216, it.file.byteCount) }
            }
        }

    @Test
    fun whatIsOpenedForNobodyIsClosed() {
        class Opened : AutoCloseable {
            var isClosed = false

            override fun close() {
                isClosed = true
            }
        }
        val opened = Opened()
        val (isIn, mayGo) = CountDownLatch(1) to CountDownLatch(1)
        runBlocking {
            val job =
                launch(Dispatchers.Default, CoroutineStart.UNDISPATCHED) {
                    owned {
                        isIn.countDown()
                        mayGo.await()
                        opened
                    }
                }
            isIn.await()
            job.cancel()
            assertFalse(opened.isClosed)
            mayGo.countDown()
            job.join()
        }
        assertTrue(opened.isClosed)
    }

    @Test
    fun bssrdfHasWhatTheFileHas() {
        SubsurfFile.open(TestFiles.vector("palette.subsurf").path).use { file ->
            val bssrdf = file.bssrdf
            assertEquals(Coding.PALETTE, bssrdf.coding)
            assertEquals(2, bssrdf.basesPerPixel)
            assertEquals(16, bssrdf.bitsPerPixel)
            assertEquals(
                listOf(PlaneKind.BASE_PROFILES, PlaneKind.PAIRS, PlaneKind.CODES),
                bssrdf.planes.map { it.kind },
            )
            for (plane in bssrdf.planes) {
                assertEquals(plane.layerBytes * plane.layers, plane.byteCount.toLong())
                assertEquals(plane.layerBytes, plane.rowBytes.toLong() * plane.height)
                plane.use {
                    assertTrue(it.isDirect && it.isReadOnly)
                    assertEquals(ByteOrder.LITTLE_ENDIAN, it.order())
                    assertEquals(plane.byteCount, it.remaining())
                }
            }
            assertThrows(SubsurfException.WrongFamily::class.java) { file.btf }
        }
    }

    @Test
    fun planesAreBytesOfTheFile() {
        val bytes = example.readBytes()
        SubsurfFile.open(example.path).use { file ->
            for (plane in file.bssrdf.planes) {
                val found = plane.use { ByteArray(it.remaining()).also(it::get) }
                val at = (0..bytes.size - found.size).any { bytes.copyOfRange(it, it + found.size).contentEquals(found) }
                assertTrue("${plane.kind}", at)
            }
        }
    }

    @Test
    fun rdIsReciprocalAndBounded() {
        SubsurfFile.open(TestFiles.vector("bmpp_clamp.subsurf").path).use { file ->
            val bssrdf = file.bssrdf
            val there = bssrdf.rd(0, 0, 1, 0)
            assertTrue(there.all { it > 0 })
            val far = bssrdf.windowRadius + 1
            assertArrayEquals(FloatArray(3), bssrdf.rd(0, 0, far, 0), 0f)
            val room = FloatArray(5) { -1f }
            assertTrue(room === bssrdf.rd(0, 0, 1, 0, room))
            assertArrayEquals(floatArrayOf(there[0], there[1], there[2], -1f, -1f), room, 0f)
            assertThrows(IllegalArgumentException::class.java) { bssrdf.albedo(0, 0, FloatArray(2)) }
            assertTrue(bssrdf.albedo(0, 0).all { it > 0 && it <= 1 })
        }
    }
}
