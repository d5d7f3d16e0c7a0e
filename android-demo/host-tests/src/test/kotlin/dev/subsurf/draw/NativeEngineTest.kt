package dev.subsurf

import org.junit.Assert.assertEquals
import org.junit.Assert.assertTrue
import org.junit.Test
import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit

/** The thread that draws with the library, to pictures in place of windows. */
class NativeEngineTest {
    private val reports = LinkedBlockingQueue<LoadReport>()
    private val renderers = LinkedBlockingQueue<SubsurfRenderer>()
    private val news = News()

    private val source =
        object : EngineSource {
            override fun open(): Engine {
                val renderer = SubsurfRenderer.open()
                renderer.onLoaded = { _, report -> reports += report }
                renderers += renderer
                return NativeEngine(renderer, ::draw, { _, _, _ -> Status.OK }) { of, _, width, height ->
                    of.picture(width, height)
                }
            }

            override fun survived() = Unit
        }

    /** Frames that are skipped from now on. */
    @Volatile private var skips = 0

    private fun draw(of: Long, to: Long, numbers: FloatArray, handles: LongArray, report: LongArray?): Int =
        if (skips-- > 0) Status.SKIPPED else Native.drawPicture(of, to, numbers, handles, report)

    private fun scene(material: SubsurfMaterial, orbit: Orbit = Orbit()) =
        Scene(listOf(SceneObject(SubsurfMesh.of(Shape.SPHERE), material)), camera = orbit)

    @Test
    fun surfacesComeAndGoWithoutGrowth() =
        SubsurfMaterial.open(TestFiles.material("jade.subsurf").path).use { material ->
            RenderThread(source, news).use { thread ->
                thread.show(scene(material))
                thread.resume()
                var bytes = 0L
                repeat(SURFACES) { number ->
                    thread.setWindow("window $number", 16, 16)
                    news.awaitFrame()
                    if (number == 0) bytes = renderers.peek().memory.bytes
                    thread.setWindow(null, 0, 0)
                }
                assertEquals("one load", 1, reports.size)
                thread.setWindow("last", 16, 16)
                news.awaitFrame()
                assertEquals(bytes, renderers.single().memory.bytes)
            }
        }

    @Test
    fun lostDeviceComesBackWithItsMaterial() =
        SubsurfMaterial.open(TestFiles.material("jade.subsurf").path).use { material ->
            RenderThread(source, news).use { thread ->
                thread.show(scene(material))
                thread.setWindow("window", 16, 16)
                thread.resume()
                news.awaitFrame()
                renderers.peek().lose()
                thread.show(scene(material, Orbit(1f)))
                news.awaitFrame()
                assertEquals("loaded on both", 2, reports.size)
                assertEquals(2, renderers.size)
            }
        }

    @Test
    fun copiesThatWereGivenUpAreLoadedAgain() =
        SubsurfMaterial.open(TestFiles.material("jade.subsurf").path).use { material ->
            RenderThread(source, news).use { thread ->
                thread.show(scene(material))
                thread.setWindow("window", 16, 16)
                thread.resume()
                assertTrue(reports.poll(60, TimeUnit.SECONDS)!!.firstFrameNanos > 0)
                news.awaitFrame()
                thread.pause()
                thread.trim(RenderThread.Trim.COPIES)
                thread.resume()
                news.awaitFrame()
                assertEquals("once more", 1, reports.size)
            }
        }

    @Test
    fun materialThatWasLoadedInASkippedFrameIsReported() =
        SubsurfMaterial.open(TestFiles.material("jade.subsurf").path).use { material ->
            RenderThread(source, news).use { thread ->
                skips = 2
                thread.show(scene(material))
                thread.setWindow("window", 16, 16)
                thread.resume()
                news.awaitFrame()
                assertTrue(reports.single().firstFrameNanos > 0)
            }
        }

    private companion object {
        const val SURFACES = 100
    }
}
