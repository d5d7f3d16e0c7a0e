package dev.subsurf

/** What a [RenderThread] drives: a device, and a surface while a window has one. Used by that thread alone. */
internal interface Engine : AutoCloseable {
    /** Makes a surface on a window. */
    fun attach(window: Any, width: Int, height: Int)

    /** Follows the size of the window. */
    fun resize(width: Int, height: Int)

    /** Gives the surface up; afterwards the window is not touched. */
    fun detach()

    /** Draws a scene to the surface; false where nothing can be shown at the moment. */
    fun draw(scene: Scene): Boolean

    /** Gives up what is on the device but for a scene's; all of it where there is none. */
    fun trim(kept: Scene?)
}

/** Where engines come from. */
internal interface EngineSource {
    /** Opens a device. */
    fun open(): Engine

    /** The process outlived a start: called after the first frame, after errors, and when the surface is given up. */
    fun survived()
}

/** What a render thread tells, on that thread. */
internal interface RenderListener {
    /** A frame was drawn, which took so many ns on this thread. */
    fun onFrame(nanos: Long)

    /** Nothing more is drawn until what is shown, the window or the state of the app changes. */
    fun onError(error: Exception)
}

/**
 * Engine of the library.
 *
 * @property surfaceOf Makes the target of a window.
 */
internal class NativeEngine(
    private val renderer: SubsurfRenderer,
    private val draw: (Long, Long, FloatArray, LongArray, LongArray?) -> Int = Native::drawSurface,
    private val resizeSurface: (Handle, Int, Int) -> Int = { surface, width, height ->
        surface.call { Native.surfaceResize(it, width, height) }
    },
    private val surfaceOf: (SubsurfRenderer, Any, Int, Int) -> Handle = SubsurfRenderer::surface,
) : Engine {
    private var surface: Handle? = null
    private var width = 0
    private var height = 0

    override fun attach(window: Any, width: Int, height: Int) {
        surface = surfaceOf(renderer, window, width, height)
        this.width = width
        this.height = height
    }

    override fun resize(width: Int, height: Int) {
        expectOk(resizeSurface(checkNotNull(surface) { "there is no surface" }, width, height))
        this.width = width
        this.height = height
    }

    override fun detach() {
        surface?.close()
        surface = null
    }

    override fun draw(scene: Scene): Boolean =
        renderer.draw(scene, width, height, checkNotNull(surface) { "there is no surface" }, draw)

    override fun trim(kept: Scene?) = renderer.trim(kept)

    override fun close() {
        detach()
        renderer.close()
    }
}
