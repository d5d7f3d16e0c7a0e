package dev.subsurf

import java.util.concurrent.CopyOnWriteArrayList
import java.util.concurrent.CountDownLatch
import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.TimeUnit

/** Engines that write down what is asked of them, and fail when told to. */
internal class FakeSource : EngineSource {
    val calls = CopyOnWriteArrayList<String>()
    val failures = LinkedBlockingQueue<Pair<String, Throwable>>()
    private var count = 0

    @Volatile var isSkipping = false

    /** Call at which the thread stops until it is told to go on. */
    @Volatile private var held: Held? = null

    /** Place where the thread stops. */
    class Held(val call: String) {
        private val reached = CountDownLatch(1)
        private val goesOn = CountDownLatch(1)

        fun stop() {
            reached.countDown()
            check(goesOn.await(SECONDS, TimeUnit.SECONDS)) { "nobody lets $call go on" }
        }

        fun awaitReached() = check(reached.await(SECONDS, TimeUnit.SECONDS)) { "there was no $call" }

        fun goOn() = goesOn.countDown()
    }

    /** Stops the thread at the next call that begins like this. */
    fun hold(call: String): Held = Held(call).also { held = it }

    override fun open(): Engine {
        call("open")
        return FakeEngine(++count)
    }

    override fun survived() {
        calls += "survived"
    }

    /** Calls but for those that came after every frame. */
    fun actions(): List<String> = calls.filter { it != "survived" }

    private fun call(name: String) {
        calls += name
        held?.takeIf { name.startsWith(it.call) }?.let {
            held = null
            it.stop()
        }
        val failure = failures.peek() ?: return
        if (name.startsWith(failure.first)) throw failures.remove().second
    }

    private inner class FakeEngine(private val number: Int) : Engine {
        override fun attach(window: Any, width: Int, height: Int) = call("attach $window ${width}x$height to $number")

        override fun resize(width: Int, height: Int) = call("resize ${width}x$height")

        override fun detach() = call("detach from $number")

        override fun draw(scene: Scene): Boolean {
            call("draw ${name(scene)}")
            return !isSkipping
        }

        override fun trim(kept: Scene?) = call("trim to ${kept?.let(::name)}")

        override fun close() = call("close $number")
    }

    private val names = HashMap<Scene, String>()

    private fun name(scene: Scene) = names[scene] ?: "a scene"

    fun scene(name: String): Scene = Scene(emptyList()).also { names[it] = name }

    private companion object {
        const val SECONDS = 60L
    }
}

/** Listener whose news can be waited for. */
internal class News : RenderListener {
    private val frames = LinkedBlockingQueue<Long>()
    private val errors = LinkedBlockingQueue<Exception>()

    override fun onFrame(nanos: Long) {
        frames += nanos
    }

    override fun onError(error: Exception) {
        errors += error
    }

    fun awaitFrame(): Long = checkNotNull(frames.poll(SECONDS, TimeUnit.SECONDS)) { "no frame was drawn" }

    fun awaitError(): Exception = checkNotNull(errors.poll(SECONDS, TimeUnit.SECONDS)) { "there was no error" }

    /** Whether no frame is drawn for a while. */
    fun isQuiet(): Boolean = frames.poll(QUIET_MS, TimeUnit.MILLISECONDS) == null

    fun hasErrors(): Boolean = errors.isNotEmpty()

    fun forget() = frames.clear()

    private companion object {
        const val SECONDS = 60L
        const val QUIET_MS = 100L
    }
}
