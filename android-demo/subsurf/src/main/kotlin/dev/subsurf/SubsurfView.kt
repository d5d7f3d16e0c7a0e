package dev.subsurf

import android.annotation.SuppressLint
import android.content.ComponentCallbacks2
import android.content.Context
import android.os.Bundle
import android.os.Handler
import android.os.Looper
import android.os.Parcelable
import android.util.AttributeSet
import android.view.MotionEvent
import android.view.SurfaceView

/**
 * View that shows a material on a mesh. Fingers turn it: one the mesh, two the light, apart they zoom.
 *
 * It follows the activity that it is in without further calls: on pause and when its surface goes, it stops touching the surface, and
 * draws again when both are back; on rotation the eye and the light stay, if the view has an id; when memory is low it gives up
 * copies on the device; a lost device is opened again, with all that was on it. Drawing has a thread of its own; the view is used
 * from the main thread, where its listener is called.
 *
 * Attributes in XML: `subsurfAsset`, `subsurfShape`, `subsurfTechnique`, `subsurfBackend`, `subsurfGestures`.
 */
public class SubsurfView
    @JvmOverloads
    constructor(
        context: Context,
        attrs: AttributeSet? = null,
        defStyleAttr: Int = 0,
    ) : SurfaceView(context, attrs, defStyleAttr) {
        /** What a view tells, on the main thread. */
        public interface Listener {
            /** A material was loaded, and its first frame drawn. */
            public fun onLoaded(material: SubsurfMaterial, report: LoadReport) {}

            /** A frame took so many ns of its thread. */
            public fun onFrame(nanos: Long) {}

            /** Nothing more is drawn until what is shown changes, or the app comes back to the front. */
            public fun onError(error: Exception) {}
        }

        /** Listener, if any. */
        public var listener: Listener? = null

        /** Material that is shown; the caller's, who closes it once the view shows another or is gone. */
        public var material: SubsurfMaterial? = null
            set(value) {
                field = value
                update()
            }

        /** Mesh that wears it. */
        public var mesh: SubsurfMesh = SubsurfMesh.of(Shape.KNOT)
            set(value) {
                field = value
                update()
            }

        /** Way to draw it. */
        public var technique: Technique = Technique.AUTOMATIC
            set(value) {
                field = value
                update()
            }

        /** Rule by which the material lies on the mesh; null stands for the usual one of its family. */
        public var mapping: Mapping? = null
            set(value) {
                field = value
                update()
            }

        /** Eye, which fingers move. */
        public var orbit: Orbit = Orbit()
            set(value) {
                field = value
                update()
            }

        /** Direction towards the light, of length 1, which fingers move. */
        public var light: Vector3 = Scene.DEFAULT_LIGHT
            set(value) {
                field = value.normalized
                update()
            }

        /** Light from all around. */
        public var environment: Environment = Environment.STUDIO
            set(value) {
                field = value
                update()
            }

        /** Factor on radiance. */
        public var exposure: Float = 1f
            set(value) {
                field = value
                update()
            }

        /** Whether fingers turn the mesh and move the light. */
        public var hasGestures: Boolean = true

        /** Whether frames follow each other without end, as for measuring; else one is drawn when something changes. */
        public var isContinuous: Boolean = false
            set(value) {
                field = value
                thread?.setContinuous(value)
            }

        /** Graphics API that the next device is opened for. A backend whose start ended the process is avoided afterwards. */
        public var backend: Backend = Backend.AUTOMATIC
            set(value) {
                if (field == value) return
                field = value
                restart()
            }

        private val main = Handler(Looper.getMainLooper())
        private val touch = Touch { height }
        private val state = ViewState()
        private var asset: String? = null
        private var ownMaterial: SubsurfMaterial? = null
        private var thread: RenderThread? = null

        /** Engines that threads of this view use; tests have others. */
        internal var source: (SubsurfView) -> EngineSource = ::androidSource

        init {
            val given = context.obtainStyledAttributes(attrs, R.styleable.SubsurfView, defStyleAttr, 0)
            try {
                asset = given.getString(R.styleable.SubsurfView_subsurfAsset)
                mesh = SubsurfMesh.of(Shape.entries[given.getInt(R.styleable.SubsurfView_subsurfShape, Shape.KNOT.ordinal)])
                technique = Technique.entries[given.getInt(R.styleable.SubsurfView_subsurfTechnique, 0)]
                backend = Backend.entries[given.getInt(R.styleable.SubsurfView_subsurfBackend, 0)]
                hasGestures = given.getBoolean(R.styleable.SubsurfView_subsurfGestures, true)
            } finally {
                given.recycle()
            }
            holder.addCallback(SurfaceWatch { window, width, height -> state.setWindow(window, width, height) })
            isFocusable = true
        }

        /** Forgets which backends have ended the process. */
        public fun forgetCrashes(): Unit = backendMemory(context).forget()

        /** Draws another frame. */
        public fun requestFrame(): Unit = update()

        override fun onAttachedToWindow() {
            super.onAttachedToWindow()
            openAsset()
            start()
            state.watch(context, ::trim)
        }

        override fun onDetachedFromWindow() {
            state.unwatch()
            stop()
            ownMaterial?.close()
            if (material === ownMaterial) material = null
            ownMaterial = null
            super.onDetachedFromWindow()
        }

        @SuppressLint("ClickableViewAccessibility")
        override fun onTouchEvent(event: MotionEvent): Boolean {
            if (!hasGestures) return super.onTouchEvent(event)
            when (event.actionMasked) {
                MotionEvent.ACTION_MOVE -> {
                    val count = event.pointerCount
                    touch.at(FloatArray(count, event::getX), FloatArray(count, event::getY), gestures)
                }
                MotionEvent.ACTION_UP -> {
                    touch.reset()
                    if (event.eventTime - event.downTime < CLICK_MS) performClick()
                }
                MotionEvent.ACTION_DOWN -> {
                    touch.reset()
                    parent?.requestDisallowInterceptTouchEvent(true)
                    touch.at(floatArrayOf(event.x), floatArrayOf(event.y), gestures)
                }
                else -> touch.reset()
            }
            return true
        }

        override fun performClick(): Boolean {
            super.performClick()
            return true
        }

        override fun onSaveInstanceState(): Parcelable =
            Bundle().apply {
                putParcelable(SUPER, super.onSaveInstanceState())
                putFloatArray(POSE, floatArrayOf(orbit.aroundRad, orbit.upRad, orbit.distance, light.x, light.y, light.z))
            }

        @Suppress("DEPRECATION", "MagicNumber")
        override fun onRestoreInstanceState(state: Parcelable?) {
            val bundle = state as? Bundle
            super.onRestoreInstanceState(bundle?.getParcelable(SUPER))
            val pose = bundle?.getFloatArray(POSE) ?: return
            orbit = Orbit(pose[0], pose[1], pose[2])
            light = Vector3(pose[3], pose[4], pose[5])
        }

        private val gestures =
            object : Touch.Listener {
                override fun onTurn(x: Float, y: Float) {
                    orbit = orbit.turned(x, y)
                }

                override fun onDrag(x: Float, y: Float) {
                    light = orbit.dragged(light, x, y)
                }

                override fun onZoom(factor: Float) {
                    orbit = orbit.zoomed(factor)
                }
            }

        private fun start() {
            if (thread != null) return
            val started =
                RenderThread(
                    source(this),
                    object : RenderListener {
                        override fun onFrame(nanos: Long) = tell { it.onFrame(nanos) }

                        override fun onError(error: Exception) = tell { it.onError(error) }
                    },
                )
            thread = started
            started.setContinuous(isContinuous)
            state.thread = started
            update()
        }

        private fun stop() {
            state.thread = null
            thread?.close()
            thread = null
        }

        private fun restart() {
            if (thread == null) return
            stop()
            start()
        }

        private fun update() {
            thread?.show(material?.let(::scene))
        }

        private fun scene(material: SubsurfMaterial) =
            Scene(
                listOf(SceneObject(mesh, material, technique, mapping = mapping)),
                listOf(Light.directional(light)),
                orbit,
                environment,
                exposure,
            )

        private fun openAsset() {
            val name = asset
            if (name == null || material != null) return
            try {
                ownMaterial = SubsurfMaterial.open(context.assets, name)
                material = ownMaterial
            } catch (e: java.io.IOException) {
                tell { it.onError(e) }
            }
        }

        private fun trim(level: Int) {
            val give =
                when {
                    level >= ComponentCallbacks2.TRIM_MEMORY_BACKGROUND -> RenderThread.Trim.DEVICE
                    level >= ComponentCallbacks2.TRIM_MEMORY_UI_HIDDEN -> RenderThread.Trim.COPIES
                    else -> RenderThread.Trim.UNUSED
                }
            thread?.trim(give)
        }

        internal fun tell(what: (Listener) -> Unit) {
            main.post { listener?.let(what) }
        }

        private companion object {
            const val SUPER = "super"
            const val POSE = "pose"
            const val CLICK_MS = 200L
        }
    }
