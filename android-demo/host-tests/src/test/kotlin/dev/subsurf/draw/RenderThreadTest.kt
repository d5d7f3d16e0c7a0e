package dev.subsurf

import org.junit.After
import org.junit.Assert.assertEquals
import org.junit.Assert.assertFalse
import org.junit.Assert.assertTrue
import org.junit.Test
import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit
import kotlin.concurrent.thread as begin

class RenderThreadTest {
    private val source = FakeSource()
    private val news = News()
    private val thread = RenderThread(source, news)
    private val scene = source.scene("a")

    @After
    fun close() = thread.close()

    /** A window, in front, with a first frame. */
    private fun begin() {
        thread.setWindow("window", 30, 20)
        thread.resume()
        thread.show(scene)
        news.awaitFrame()
        source.calls.clear()
        news.forget()
    }

    @Test
    fun drawsOnceWindowFrontAndSceneAreThere() {
        thread.show(scene)
        thread.setWindow("window", 30, 20)
        assertTrue("not in front", news.isQuiet())
        assertEquals(emptyList<String>(), source.actions())
        thread.resume()
        news.awaitFrame()
        assertEquals(listOf("open", "attach window 30x20 to 1", "draw a"), source.actions())
        assertTrue("nothing changed", news.isQuiet())
    }

    @Test
    fun pauseGivesTheSurfaceUpAndKeepsTheDevice() {
        begin()
        thread.pause()
        assertEquals(listOf("detach from 1"), source.actions())
        thread.show(source.scene("b"))
        assertTrue("paused", news.isQuiet())
        thread.resume()
        news.awaitFrame()
        assertEquals(listOf("detach from 1", "attach window 30x20 to 1", "draw b"), source.actions())
    }

    @Test
    fun destroyedSurfaceIsNotTouchedAnyMore() {
        begin()
        thread.setContinuous(true)
        news.awaitFrame()
        thread.setWindow(null, 0, 0)
        val after = source.calls.size
        assertEquals("detach from 1", source.actions().last())
        news.forget()
        assertTrue("no window", news.isQuiet())
        assertEquals(after, source.calls.size)
        thread.setWindow("another", 30, 20)
        news.awaitFrame()
        assertTrue("attach another 30x20 to 1" in source.actions())
    }

    @Test
    fun anotherWindowReplacesTheFirst() {
        begin()
        thread.setWindow("another", 30, 20)
        news.awaitFrame()
        assertEquals(listOf("detach from 1", "attach another 30x20 to 1", "draw a"), source.actions())
    }

    @Test
    fun sizeIsFollowed() {
        begin()
        thread.setWindow("window", 20, 30)
        news.awaitFrame()
        assertEquals(listOf("resize 20x30", "draw a"), source.actions())
    }

    @Test
    fun lostDeviceIsOpenedAgain() {
        begin()
        source.failures += "draw" to SubsurfException.DeviceLost(11, "lost")
        thread.show(source.scene("b"))
        news.awaitFrame()
        assertEquals(listOf("draw b", "close 1", "open", "attach window 30x20 to 2", "draw b"), source.actions())
        assertTrue("a loss is no crash", source.calls.indexOf("survived") < source.calls.indexOf("open"))
    }

    @Test
    fun lostSurfaceIsMadeAgain() {
        begin()
        source.failures += "draw" to SubsurfException.SurfaceLost(13, "lost")
        thread.show(source.scene("b"))
        news.awaitFrame()
        assertEquals(listOf("draw b", "detach from 1", "attach window 30x20 to 1", "draw b"), source.actions())
    }

    @Test
    fun deviceThatIsLostAgainAndAgainIsAnError() {
        begin()
        repeat(4) { source.failures += "draw" to SubsurfException.DeviceLost(11, "lost") }
        thread.show(scene)
        assertTrue(news.awaitError() is SubsurfException.DeviceLost)
        assertTrue("stopped", news.isQuiet())
        thread.pause()
        thread.resume()
        news.awaitFrame()
    }

    @Test
    fun errorsStopUntilSomethingChanges() {
        begin()
        thread.setContinuous(true)
        source.failures += "draw" to SubsurfException.OverBudget(7, "too much")
        assertEquals("too much", news.awaitError().message)
        news.forget()
        assertTrue("stopped", news.isQuiet())
        assertTrue("the process is still there", "survived" in source.calls)
        thread.show(scene)
        news.awaitFrame()
    }

    @Test
    fun deviceThatDoesNotOpenIsTriedAgainOnResume() {
        source.failures += "open" to SubsurfException.NoDevice(9, "none")
        thread.setWindow("window", 30, 20)
        thread.show(scene)
        thread.resume()
        assertTrue(news.awaitError() is SubsurfException.NoDevice)
        thread.pause()
        thread.resume()
        news.awaitFrame()
    }

    @Test
    fun memoryIsGivenUpByLevels() {
        begin()
        thread.trim(RenderThread.Trim.UNUSED)
        news.awaitFrame()
        assertEquals(listOf("trim to a", "draw a"), source.actions())
        thread.pause()
        source.calls.clear()
        thread.trim(RenderThread.Trim.COPIES)
        thread.resume()
        news.awaitFrame()
        assertEquals(listOf("trim to null", "attach window 30x20 to 1", "draw a"), source.actions())
        thread.pause()
        source.calls.clear()
        thread.trim(RenderThread.Trim.DEVICE)
        thread.resume()
        news.awaitFrame()
        assertEquals(listOf("close 1", "open", "attach window 30x20 to 2", "draw a"), source.actions())
    }

    @Test
    fun skippedFramesAreTriedAgainNowAndThen() {
        begin()
        source.isSkipping = true
        thread.setContinuous(true)
        thread.show(scene)
        news.forget()
        assertTrue("nothing to draw to", news.isQuiet())
        val tries = source.actions().size
        assertTrue("$tries tries", tries in 2..100)
        thread.setContinuous(false)
        source.isSkipping = false
        news.awaitFrame()
    }

    @Test
    fun windowThatGoesWhileASurfaceIsMadeIsWaitedFor() {
        val attach = source.hold("attach")
        thread.show(scene)
        thread.setWindow("window", 30, 20)
        thread.resume()
        attach.awaitReached()
        val gone = begin { thread.setWindow(null, 0, 0) }
        gone.join(SHORT_MS)
        assertTrue("returns once the window is not touched any more", gone.isAlive)
        attach.goOn()
        gone.join()
        assertEquals(listOf("open", "attach window 30x20 to 1", "detach from 1"), source.actions())
        // Views hand the same object out again, with another surface behind it.
        source.calls.clear()
        thread.setWindow("window", 30, 20)
        news.awaitFrame()
        assertEquals(listOf("attach window 30x20 to 1", "draw a"), source.actions())
    }

    @Test
    fun windowThatGoesWhileADeviceIsOpenedIsNotTouched() {
        val open = source.hold("open")
        thread.show(scene)
        thread.setWindow("window", 30, 20)
        thread.resume()
        open.awaitReached()
        thread.setWindow(null, 0, 0)
        open.goOn()
        assertTrue("no window", news.isQuiet())
        assertEquals(listOf("open"), source.actions())
        assertTrue("the process is still there", "survived" in source.calls)
    }

    @Test
    fun errorOfWhatIsNotShownAnyMoreStopsNothing() {
        begin()
        source.failures += "draw" to IllegalStateException("the file is closed")
        val draw = source.hold("draw")
        thread.show(scene)
        draw.awaitReached()
        thread.show(source.scene("b"))
        draw.goOn()
        news.awaitFrame()
        assertEquals(listOf("draw a", "draw b"), source.actions())
        assertFalse("of no interest", news.hasErrors())
    }

    @Test
    fun errorOfTheVirtualMachineLeavesNobodyWaiting() {
        begin()
        val usual = Thread.getDefaultUncaughtExceptionHandler()
        val uncaught = LinkedBlockingQueue<Throwable>()
        Thread.setDefaultUncaughtExceptionHandler { _, error -> uncaught += error }
        try {
            source.failures += "draw" to OutOfMemoryError("of a test")
            val draw = source.hold("draw")
            thread.show(scene)
            draw.awaitReached()
            val paused = begin { thread.pause() }
            draw.goOn()
            assertEquals("of a test", uncaught.poll(LONG_S, TimeUnit.SECONDS)?.message)
            paused.join(TimeUnit.SECONDS.toMillis(LONG_S))
            assertFalse("nobody detaches any more", paused.isAlive)
            assertEquals("the window is not touched any more", listOf("draw a", "close 1"), source.actions())
            thread.setWindow(null, 0, 0)
        } finally {
            Thread.setDefaultUncaughtExceptionHandler(usual)
        }
    }

    @Test
    fun noDeviceIsOpenedBeforeThereIsAScene() {
        thread.setWindow("window", 30, 20)
        thread.resume()
        assertTrue("no scene", news.isQuiet())
        assertEquals(emptyList<String>(), source.actions())
    }

    @Test
    fun closingGivesAllUp() {
        begin()
        thread.close()
        assertEquals(listOf("detach from 1", "close 1"), source.actions())
    }

    private companion object {
        const val SHORT_MS = 100L
        const val LONG_S = 30L
    }
}
