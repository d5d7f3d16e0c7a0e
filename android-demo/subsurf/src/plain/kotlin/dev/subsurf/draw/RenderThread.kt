package dev.subsurf

import java.util.concurrent.locks.ReentrantLock
import kotlin.concurrent.thread
import kotlin.concurrent.withLock

/**
 * Thread that draws a scene to a window for as long as there is one: it opens a device when it first needs it, makes a surface when
 * there is a window and the app is in front, gives it up when either ends, and opens all anew when the device is lost.
 *
 * Threads: any may call it. [setWindow] with null, [pause] and [close] return once the window is not touched any more.
 */
internal class RenderThread(
    private val source: EngineSource,
    private val listener: RenderListener,
) : AutoCloseable {
    private val lock = ReentrantLock()
    private val changed = lock.newCondition()

    // What is wanted.
    private var window: Any? = null
    private var width = 0
    private var height = 0
    private var isResumed = false
    private var scene: Scene? = null
    private var isDirty = false
    private var isContinuous = false
    private var trim = Trim.NOTHING
    private var isClosed = false

    /** Changes so far: an error of work that is older than the last of them stops nothing. */
    private var changes = 0L

    // What is.
    private var attached: Attached? = null

    /** Where a surface is being made at this moment. */
    private var attaching: Attached? = null

    /** Time of the virtual machine, in ns, before which no frame is tried again. */
    private var notBefore = System.nanoTime()

    /** Whether an error has stopped it until something changes. */
    private var isStopped = false

    /** Whether the thread is done, and touches nothing any more. */
    private var hasEnded = false

    // Used by the thread alone.
    private var engine: Engine? = null
    private var losses = 0
    private var skips = 0

    /** What memory to give up, the more the later. */
    enum class Trim {
        /** None. */
        NOTHING,

        /** What the scene does not need. */
        UNUSED,

        /** All copies on the device. */
        COPIES,

        /** The device too, unless it is drawn to. */
        DEVICE,
    }

    private data class Attached(val window: Any, val width: Int, val height: Int)

    private val thread = thread(name = "subsurf-render") { run() }

    /** Window to draw to, and its size; null once it is gone: returns when it is not used any more. */
    fun setWindow(window: Any?, width: Int, height: Int) =
        change {
            this.window = window
            this.width = width
            this.height = height
            isDirty = true
            if (window == null) awaitDetached()
        }

    /** The app is in front. */
    fun resume() =
        change {
            isResumed = true
            isDirty = true
        }

    /** The app is not in front: returns when the window is not used any more. Device and copies stay. */
    fun pause() =
        change {
            isResumed = false
            awaitDetached()
        }

    /** What is drawn next. */
    fun show(scene: Scene?) =
        change {
            this.scene = scene
            isDirty = true
        }

    /** Whether frames follow each other without end, or are drawn when something changes. */
    fun setContinuous(isContinuous: Boolean) = change { this.isContinuous = isContinuous }

    /** Gives memory up. */
    fun trim(level: Trim) =
        change {
            trim = maxOf(trim, level)
            if (attached != null) isDirty = true
        }

    /** Ends the thread, and closes the device. */
    override fun close() {
        change { isClosed = true }
        if (Thread.currentThread() !== thread) thread.join()
    }

    private inline fun change(work: () -> Unit) =
        lock.withLock {
            isStopped = false
            changes++
            changed.signalAll()
            work()
        }

    private fun awaitDetached() {
        if (Thread.currentThread() === thread) return
        while ((attached != null || attaching != null) && !hasEnded) changed.await()
    }

    private fun wanted(): Attached? =
        window?.takeIf { isResumed && !isClosed && width > 0 && height > 0 }?.let { Attached(it, width, height) }

    /** Work of the thread, one piece at a time, so that what changes in between is seen. */
    private sealed class Work {
        data object Detach : Work()

        class Attach(val to: Attached) : Work()

        class Resize(val to: Attached) : Work()

        class GiveUp(val level: Trim, val kept: Scene?) : Work()

        class Draw(val scene: Scene) : Work()

        data object End : Work()
    }

    /** Next piece of work; waits until there is one. The lock is held. */
    private fun next(): Work {
        while (true) {
            val (found, to) = attached to wanted()
            val shown = scene
            val rest = notBefore - System.nanoTime()
            when {
                found != null && found.window !== to?.window -> return Work.Detach
                isClosed -> return Work.End
                trim != Trim.NOTHING ->
                    return Work.GiveUp(trim, shown?.takeIf { trim == Trim.UNUSED }).also { trim = Trim.NOTHING }
                isStopped -> Unit
                to == null || shown == null -> Unit
                found == null -> return Work.Attach(to)
                found != to -> return Work.Resize(to)
                rest <= 0 && (isDirty || isContinuous) -> {
                    isDirty = false
                    return Work.Draw(shown)
                }
            }
            if (rest > 0) changed.awaitNanos(rest) else changed.await()
        }
    }

    private fun run() {
        try {
            loop()
        } finally {
            end()
        }
    }

    /** Gives all up, also where an error of the virtual machine ends the thread, so that nobody waits for it. */
    private fun end() {
        try {
            engine?.close()
            engine = null
            source.survived()
        } finally {
            lock.withLock {
                hasEnded = true
                changed.signalAll()
            }
        }
    }

    private fun loop() {
        while (true) {
            val (work, seen) = lock.withLock { next() to changes }
            if (work == Work.End) break
            try {
                perform(work)
            } catch (_: SubsurfException.DeviceLost) {
                lost(seen)
            } catch (_: SubsurfException.SurfaceLost) {
                surfaceLost(seen)
            } catch (
                @Suppress("TooGenericExceptionCaught") e: Exception,
            ) {
                source.survived()
                stop(e, seen)
            }
        }
    }

    private fun perform(work: Work) {
        when (work) {
            Work.Detach -> detach()
            is Work.Attach -> attach(work.to)
            is Work.Resize -> {
                engine?.resize(work.to.width, work.to.height)
                isNow(work.to)
            }
            is Work.GiveUp -> giveUp(work)
            is Work.Draw -> draw(work.scene)
            Work.End -> Unit
        }
    }

    private fun attach(to: Attached) {
        val opened = engine ?: source.open().also { engine = it }
        // Opening takes long: the window may be gone since, and nobody waits for the thread before it touches one.
        val isWanted = lock.withLock { (wanted() == to).also { if (it) attaching = to } }
        if (!isWanted) return source.survived()
        try {
            opened.attach(to.window, to.width, to.height)
            isNow(to)
        } finally {
            lock.withLock {
                attaching = null
                changed.signalAll()
            }
        }
    }

    private fun draw(scene: Scene) {
        val begin = System.nanoTime()
        val isDrawn = engine?.draw(scene) ?: false
        if (!isDrawn) return skipped()
        skips = 0
        losses = 0
        source.survived()
        listener.onFrame(System.nanoTime() - begin)
    }

    /** The frame is tried again: after the time of one of a display, and longer each time. */
    private fun skipped() {
        val wait = FIRST_WAIT_NS shl minOf(skips++, MOST_DOUBLINGS)
        lock.withLock {
            isDirty = true
            notBefore = System.nanoTime() + wait
        }
    }

    private fun giveUp(work: Work.GiveUp) {
        val isDrawnTo = lock.withLock { attached != null }
        if (work.level == Trim.DEVICE && !isDrawnTo) {
            engine?.close()
            engine = null
        } else {
            engine?.trim(work.kept)
        }
    }

    private fun detach() {
        try {
            engine?.detach()
        } finally {
            source.survived()
            isNow(null)
        }
    }

    private fun isNow(state: Attached?) =
        lock.withLock {
            attached = state
            if (state != null) isDirty = true
            notBefore = System.nanoTime()
            changed.signalAll()
        }

    /** Opens all anew, unless that was of no use several times. */
    private fun lost(seen: Long) {
        engine?.close()
        engine = null
        source.survived()
        isNow(null)
        if (isTooOften()) stop(SubsurfException.DeviceLost(Status.DEVICE_LOST, "the device is lost again and again"), seen)
    }

    private fun surfaceLost(seen: Long) {
        detach()
        if (isTooOften()) stop(SubsurfException.SurfaceLost(Status.SURFACE_LOST, "the surface is lost again and again"), seen)
    }

    private fun isTooOften(): Boolean = ++losses > MOST_LOSSES

    /** Stops until something changes; if it has since the work began, that is tried instead, and the error is of no interest. */
    private fun stop(error: Exception, seen: Long) {
        losses = 0
        val isOld =
            lock.withLock {
                isStopped = changes == seen
                if (!isStopped) isDirty = true
                !isStopped
            }
        if (!isOld) listener.onError(error)
    }

    private companion object {
        const val FIRST_WAIT_NS = 16_000_000L
        const val MOST_DOUBLINGS = 4
        const val MOST_LOSSES = 3
    }
}
