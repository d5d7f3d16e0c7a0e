package dev.subsurf

import android.app.Activity
import android.app.Application
import android.content.ComponentCallbacks2
import android.content.Context
import android.content.ContextWrapper
import android.content.res.Configuration
import android.os.Bundle
import android.view.SurfaceHolder

/** State that a view follows: its surface, its activity, and the memory of the system. */
internal class ViewState {
    private var window: Any? = null
    private var width = 0
    private var height = 0
    private var isResumed = false
    private var forgetContext: (() -> Unit)? = null

    /** Thread that is told; it learns what is the case when it is set. */
    var thread: RenderThread? = null
        set(value) {
            field = value
            value?.setWindow(window, width, height)
            if (isResumed) value?.resume()
        }

    fun setWindow(window: Any?, width: Int, height: Int) {
        this.window = window
        this.width = width
        this.height = height
        thread?.setWindow(window, width, height)
    }

    /** Begins to follow the activity of a context; without one, the app counts as in front. */
    fun watch(context: Context, trim: (Int) -> Unit) {
        val activity = activityOf(context)
        val application = context.applicationContext
        val memory = MemoryWatch(trim)
        application.registerComponentCallbacks(memory)
        val watch = ActivityWatch(activity, ::setResumed)
        (application as? Application)?.registerActivityLifecycleCallbacks(watch)
        forgetContext = {
            application.unregisterComponentCallbacks(memory)
            (application as? Application)?.unregisterActivityLifecycleCallbacks(watch)
        }
        // Views are attached to windows of activities that are resumed; if not so, a pause follows.
        setResumed(true)
    }

    fun unwatch() {
        forgetContext?.invoke()
        forgetContext = null
        setResumed(false)
    }

    private fun setResumed(isResumed: Boolean) {
        if (this.isResumed == isResumed) return
        this.isResumed = isResumed
        if (isResumed) thread?.resume() else thread?.pause()
    }

    private tailrec fun activityOf(context: Context): Activity? =
        when (context) {
            is Activity -> context
            is ContextWrapper -> activityOf(context.baseContext)
            else -> null
        }
}

/** Callback of a surface: the window and its size, or none. */
internal class SurfaceWatch(private val onWindow: (Any?, Int, Int) -> Unit) : SurfaceHolder.Callback {
    override fun surfaceCreated(holder: SurfaceHolder) = Unit

    override fun surfaceChanged(holder: SurfaceHolder, format: Int, width: Int, height: Int) =
        onWindow(holder.surface, width, height)

    override fun surfaceDestroyed(holder: SurfaceHolder) = onWindow(null, 0, 0)
}

/** Callback of the memory of the system. */
private class MemoryWatch(private val trim: (Int) -> Unit) : ComponentCallbacks2 {
    override fun onTrimMemory(level: Int) = trim(level)

    @Deprecated("Deprecated in Java")
    override fun onLowMemory() = trim(ComponentCallbacks2.TRIM_MEMORY_BACKGROUND)

    override fun onConfigurationChanged(newConfig: Configuration) = Unit
}

/** Callback of one activity: whether it is in front. */
private class ActivityWatch(
    private val activity: Activity?,
    private val setResumed: (Boolean) -> Unit,
) : Application.ActivityLifecycleCallbacks {
    override fun onActivityResumed(activity: Activity) {
        if (activity === this.activity) setResumed(true)
    }

    override fun onActivityPaused(activity: Activity) {
        if (activity === this.activity) setResumed(false)
    }

    override fun onActivityCreated(activity: Activity, savedInstanceState: Bundle?) = Unit

    override fun onActivityStarted(activity: Activity) = Unit

    override fun onActivityStopped(activity: Activity) = Unit

    override fun onActivitySaveInstanceState(activity: Activity, outState: Bundle) = Unit

    override fun onActivityDestroyed(activity: Activity) = Unit
}
