package dev.subsurf.android

import android.app.Activity
import android.app.Application
import android.content.ComponentCallbacks2
import android.graphics.SurfaceTexture
import android.os.Bundle
import android.os.Looper
import android.view.MotionEvent
import android.view.Surface
import android.view.SurfaceHolder
import android.view.ViewGroup
import dev.subsurf.Backend
import dev.subsurf.FakeSource
import dev.subsurf.Orbit
import dev.subsurf.SubsurfException
import dev.subsurf.SubsurfMaterial
import dev.subsurf.SubsurfView
import dev.subsurf.Vector3
import dev.subsurf.preferredBackend
import org.junit.After
import org.junit.Assert.assertEquals
import org.junit.Assert.assertFalse
import org.junit.Assert.assertNotEquals
import org.junit.Assert.assertTrue
import org.junit.Before
import org.junit.Test
import org.junit.experimental.categories.Category
import org.junit.runner.RunWith
import org.robolectric.Robolectric
import org.robolectric.RobolectricTestRunner
import org.robolectric.RuntimeEnvironment
import org.robolectric.Shadows.shadowOf
import org.robolectric.android.controller.ActivityController
import org.robolectric.annotation.Config
import org.robolectric.util.ReflectionHelpers
import java.io.File
import java.lang.reflect.Proxy
import java.util.concurrent.TimeUnit

/** Activity with one view, as an app has it. */
class ViewActivity : Activity() {
    lateinit var view: SubsurfView

    override fun onCreate(savedInstanceState: Bundle?) {
        super.onCreate(savedInstanceState)
        view = SubsurfView(this)
        view.id = 7
        view.source = { source }
        view.material = material
        setContentView(view)
    }

    companion object {
        internal var source = FakeSource()
        var material: SubsurfMaterial? = null
    }
}

/** Lifecycle of a view against the classes of the framework, and engines that write down what is asked of them. */
@RunWith(RobolectricTestRunner::class)
@Category(OnAndroid::class)
@Config(sdk = [35], manifest = Config.NONE)
class SubsurfViewTest {
    private val source = FakeSource()
    private lateinit var controller: ActivityController<ViewActivity>
    private val view get() = controller.get().view

    @Before
    fun begin() {
        ViewActivity.source = source
        ViewActivity.material = SubsurfMaterial.open(File(System.getProperty("vectors"), "separable_basis.subsurf").path)
        controller = Robolectric.buildActivity(ViewActivity::class.java).setup()
        changeSurface(30, 20)
        await("draw")
        source.calls.clear()
    }

    @After
    fun end() {
        surface.release()
        controller.close()
        ViewActivity.material?.close()
    }

    private fun callbacks(): Collection<SurfaceHolder.Callback> =
        shadowOf(view).fakeSurfaceHolder.callbacks

    private val surface = Surface(SurfaceTexture(0))

    /** Holder of a surface; those of Robolectric have none. */
    private val holder =
        Proxy.newProxyInstance(javaClass.classLoader, arrayOf(SurfaceHolder::class.java)) { _, method, _ ->
            if (method.name == "getSurface") surface else null
        } as SurfaceHolder

    private fun changeSurface(width: Int, height: Int) =
        callbacks().forEach { it.surfaceChanged(holder, 0, width, height) }

    private fun destroySurface() = callbacks().forEach { it.surfaceDestroyed(holder) }

    /** Waits until a call that begins like this was made; the main thread goes on meanwhile. */
    private fun await(call: String) {
        val end = System.nanoTime() + TimeUnit.SECONDS.toNanos(5)
        while (source.calls.none { it.startsWith(call) }) {
            check(System.nanoTime() < end) { "no $call: ${source.calls}" }
            shadowOf(Looper.getMainLooper()).idle()
            Thread.sleep(1)
        }
    }

    private fun has(call: String) = source.calls.any { it.startsWith(call) }

    @Test
    fun pauseGivesTheSurfaceUpAndResumeTakesItAgain() {
        controller.pause()
        assertTrue("before pause returns", has("detach"))
        assertFalse(has("close"))
        source.calls.clear()
        controller.resume()
        await("draw")
        assertTrue(has("attach"))
        assertFalse("the same device", has("open"))
    }

    @Test
    fun destroyedSurfaceIsGivenUpAtOnceAndTheNextIsDrawnTo() {
        destroySurface()
        assertTrue("before surfaceDestroyed returns", has("detach"))
        source.calls.clear()
        changeSurface(30, 20)
        await("draw")
        assertFalse("the same device", has("open"))
    }

    @Test
    fun sizeOfTheSurfaceIsFollowed() {
        changeSurface(20, 30)
        await("resize 20x30")
        await("draw")
    }

    @Test
    fun rotationKeepsEyeAndLight() {
        view.orbit = Orbit(1f, 0.5f, 3f)
        view.light = Vector3(0f, 0f, 1f)
        val before = view
        controller.recreate()
        assertNotEquals("another view", before, view)
        assertEquals(Orbit(1f, 0.5f, 3f), view.orbit)
        assertEquals(Vector3(0f, 0f, 1f), view.light)
        assertTrue("the first view's device is closed", has("close 1"))
        shadowOf(Looper.getMainLooper()).idle()
        assertTrue("the second is in a window", view.isAttachedToWindow)
        changeSurface(20, 30)
        await("attach")
    }

    @Test
    fun lowMemoryGivesUpCopiesThenTheDevice() {
        val application = RuntimeEnvironment.getApplication()
        application.onTrimMemory(ComponentCallbacks2.TRIM_MEMORY_BACKGROUND - 1)
        await("trim to null")
        controller.pause()
        application.onTrimMemory(ComponentCallbacks2.TRIM_MEMORY_BACKGROUND)
        await("close")
        controller.resume()
        await("open")
        source.calls.clear()
        @Suppress("DEPRECATION")
        application.onTrimMemory(ComponentCallbacks2.TRIM_MEMORY_RUNNING_LOW)
        await("trim to a scene")
        assertFalse("what is shown stays", has("trim to null"))
        application.onLowMemory()
        await("trim to null")
    }

    @Test
    fun lostDeviceIsOpenedAgain() {
        source.failures += "draw" to SubsurfException.DeviceLost(11, "lost")
        view.requestFrame()
        await("close 1")
        await("open")
        await("attach")
    }

    @Test
    fun errorsReachTheListenerOnTheMainThread() {
        var found: Exception? = null
        var thread: Thread? = null
        view.listener =
            object : SubsurfView.Listener {
                override fun onError(error: Exception) {
                    found = error
                    thread = Thread.currentThread()
                }
            }
        source.failures += "draw" to SubsurfException.OverBudget(7, "too much")
        view.requestFrame()
        val end = System.nanoTime() + TimeUnit.SECONDS.toNanos(5)
        while (found == null && System.nanoTime() < end) shadowOf(Looper.getMainLooper()).idle()
        assertEquals("too much", found?.message)
        assertEquals(Looper.getMainLooper().thread, thread)
    }

    @Test
    fun destroyedActivityClosesTheDevice() {
        controller.pause().stop().destroy()
        await("close 1")
    }

    @Test
    fun viewThatLeavesItsWindowGivesAllUpAndFollowsNothing() {
        val application = RuntimeEnvironment.getApplication()
        val parent = view.parent as ViewGroup
        parent.removeView(view)
        assertEquals("before the view is gone", listOf("detach from 1", "close 1"), source.actions())
        assertEquals("callbacks", Watches(0, 0), Watches.of(application))
        source.calls.clear()
        application.onTrimMemory(ComponentCallbacks2.TRIM_MEMORY_BACKGROUND)
        controller.pause()
        controller.resume()
        shadowOf(Looper.getMainLooper()).idle()
        assertEquals(emptyList<String>(), source.actions())
        parent.addView(view)
        changeSurface(30, 20)
        await("draw")
        assertEquals(Watches(1, 1), Watches.of(application))
        assertTrue("another device", has("open"))
    }

    /** Callbacks of views that an application has: of activities, and of its memory. */
    private data class Watches(val ofActivities: Int, val ofMemory: Int) {
        companion object {
            fun of(application: Application): Watches {
                val activities: List<*> = ReflectionHelpers.getField(application, "mActivityLifecycleCallbacks")
                val controller: Any = ReflectionHelpers.getField(application, "mCallbacksController")
                val memory: List<*> = ReflectionHelpers.getField<List<*>?>(controller, "mComponentCallbacks").orEmpty()
                fun ours(of: List<*>) = of.count { it!!.javaClass.name.startsWith("dev.subsurf.") }
                return Watches(ours(activities), ours(memory))
            }
        }
    }

    @Test
    fun anotherBackendIsAnotherDevice() {
        view.backend = Backend.GL
        await("close 1")
        await("draw")
        source.calls.clear()
        view.backend = Backend.GL
        assertFalse(has("close"))
    }

    private fun touch(action: Int, vararg places: Float) {
        val count = places.size / 2
        val properties = Array(count) { k -> MotionEvent.PointerProperties().apply { id = k } }
        val coordinates =
            Array(count) { k ->
                MotionEvent.PointerCoords().apply {
                    x = places[2 * k]
                    y = places[2 * k + 1]
                }
            }
        val event = MotionEvent.obtain(0, 500, action, count, properties, coordinates, 0, 0, 1f, 1f, 0, 0, 0, 0)
        view.dispatchTouchEvent(event)
        event.recycle()
    }

    @Test
    fun fingersMoveEyeLightAndDistance() {
        val (orbit, light) = view.orbit to view.light
        touch(MotionEvent.ACTION_DOWN, 10f, 10f)
        touch(MotionEvent.ACTION_MOVE, 60f, 10f)
        assertNotEquals(orbit.aroundRad, view.orbit.aroundRad)
        assertEquals(light, view.light)
        touch(MotionEvent.ACTION_POINTER_DOWN, 60f, 10f, 90f, 10f)
        touch(MotionEvent.ACTION_MOVE, 60f, 10f, 90f, 10f)
        touch(MotionEvent.ACTION_MOVE, 60f, 30f, 120f, 30f)
        assertNotEquals(light, view.light)
        assertNotEquals(orbit.distance, view.orbit.distance)
        touch(MotionEvent.ACTION_POINTER_UP, 60f, 30f, 120f, 30f)
        touch(MotionEvent.ACTION_UP, 60f, 30f)
        view.hasGestures = false
        val still = view.orbit
        touch(MotionEvent.ACTION_DOWN, 10f, 10f)
        touch(MotionEvent.ACTION_MOVE, 60f, 10f)
        assertEquals(still, view.orbit)
    }

    @Test
    fun automaticBackendIsOneThatCanBeTrusted() {
        assertEquals(Backend.VULKAN, preferredBackend(35, "tensor"))
        assertEquals(Backend.GL, preferredBackend(28, "tensor"))
        assertEquals(Backend.GL, preferredBackend(35, "ranchu"))
    }
}
