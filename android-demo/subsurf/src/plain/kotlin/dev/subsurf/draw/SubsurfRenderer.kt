package dev.subsurf

import java.nio.ByteBuffer

/**
 * Renderer without a window: a device, and what the scene that it drew last needs of it. [SubsurfView] has one of its own.
 *
 * Threads: one at a time. Ownership: who opens it closes it.
 *
 * @property device Device that it draws with.
 */
public class SubsurfRenderer internal constructor(
    private val gpu: Handle,
    private val renderer: Handle,
    public val device: DeviceInfo,
) : AutoCloseable {
    private val resources = Resources(gpu)
    private var last: Scene? = null

    /** Called with the report of a material, once its first frame is drawn. */
    internal var onLoaded: (SubsurfMaterial, LoadReport) -> Unit = { _, _ -> }

    /** Bytes that are on the device now. */
    public val memory: GpuMemory
        get() {
            val bytes = LongArray(MEMORY)
            expectOk(gpu.call { Native.gpuMemory(it, bytes) })
            return GpuMemory(bytes[0], bytes[1], bytes[2], bytes[3], bytes[MEMORY - 1])
        }

    /**
     * Draws a picture: 4 bytes a pixel, red, green, blue and alpha, rows from the top, in a direct buffer.
     *
     * @throws SubsurfException.DeviceLost if the device is gone: close the renderer and open another.
     */
    @Throws(SubsurfException::class)
    public fun draw(scene: Scene, width: Int, height: Int): ByteBuffer {
        val pixels = ByteBuffer.allocateDirect(Math.multiplyExact(Math.multiplyExact(width, height), RGBA))
        picture(width, height).use { picture ->
            draw(scene, width, height, picture, Native::drawPicture)
            expectOk(picture.call { Native.pictureRead(it, pixels, pixels.capacity()) })
        }
        return pixels
    }

    /**
     * Loads a material and draws its first frame, a picture of 64 x 64 pixels, on a mesh. What was loaded before is loaded again.
     *
     * @return Times and bytes of it.
     */
    @JvmOverloads
    @Throws(SubsurfException::class)
    public fun load(
        material: SubsurfMaterial,
        technique: Technique = Technique.AUTOMATIC,
        mesh: SubsurfMesh = FIRST_MESH,
    ): LoadReport {
        resources.drop(material, technique)
        resources.mesh(mesh)
        val scene = Scene(listOf(SceneObject(mesh, material, technique, mapping = Mapping.UV)))
        var report: LoadReport? = null
        val before = onLoaded
        onLoaded = { _, made -> report = made }
        try {
            picture(FIRST, FIRST).use { draw(scene, FIRST, FIRST, it, Native::drawPicture) }
        } finally {
            onLoaded = before
        }
        return checkNotNull(report) { "the first frame of a material makes a report" }
    }

    /** Gives up maps of frames, and copies of meshes and materials, until they are drawn again. */
    @Throws(SubsurfException::class)
    public fun trim(): Unit = trim(null)

    /** Gives up what a scene does not need, and maps of frames; what it needs stays. */
    internal fun trim(kept: Scene?) {
        resources.keepOnly(kept)
        expectOk(renderer.call { Native.rendererTrim(it) })
    }

    /** Closes the renderer and its device. */
    override fun close() {
        resources.close()
        renderer.close()
        gpu.close()
    }

    /** Loses the device, as a driver may at any time. */
    internal fun lose(): Unit = expectOk(gpu.call { Native.gpuLose(it) })

    /** Handle of a picture to draw to. */
    internal fun picture(width: Int, height: Int): Handle =
        Resources.handle("the picture", Native::pictureClose) { out ->
            gpu.call { Native.pictureCreate(it, width, height, out) }
        }

    /** Handle of a surface on a window of Android. */
    internal fun surface(window: Any, width: Int, height: Int): Handle {
        val out = LongArray(2)
        expectOk(gpu.call { Native.surfaceOpen(it, window, width, height, out) })
        return Handle("the surface", out[0], null) { Native.surfaceClose(it, out[1]) }
    }

    /**
     * Draws a frame to a target; the first of a material waits for the device, and is reported.
     *
     * @return Whether it was drawn: a surface may have nothing to draw to at the moment.
     */
    internal inline fun draw(
        scene: Scene,
        width: Int,
        height: Int,
        target: Handle,
        draw: (Long, Long, FloatArray, LongArray, LongArray?) -> Int,
    ): Boolean {
        val shown = scene.objects.map { resources.mesh(it.mesh) to resources.material(it.material, it.technique) }
        val bounds =
            scene.objects.zip(shown) { of, (mesh, _) -> mesh.bounds.transformed(of.matrix) }
                .reduceOrNull(Bounds::union) ?: EMPTY
        val numbers = scene.numbers(bounds, width.toFloat() / height)
        val environment = resources.environment(scene.environment)
        val handles = LongArray(1 + 2 * shown.size)
        val report = if (shown.all { (_, material) -> material.isReported }) null else LongArray(FRAME_REPORT)
        val used = listOf(environment) + shown.flatMap { (mesh, material) -> listOf(mesh.handle, material.handle) }
        used.forEachIndexed { place, handle -> handles[place] = handle.call { it } }
        val status = target.call { to -> renderer.call { draw(it, to, numbers, handles, report) } }
        if (status == Status.SKIPPED) return false
        expectOk(status)
        // Materials that were shown before do not pile up.
        if (scene !== last) resources.keepOnly(scene)
        last = scene
        report?.let { reported(scene, it) }
        return true
    }

    /** Reports the materials of a frame that were not reported yet. */
    private fun reported(scene: Scene, frame: LongArray) {
        for (shown in scene.objects) {
            val material = resources.material(shown.material, shown.technique)
            if (material.isReported) continue
            material.isReported = true
            val load = material.report
            val (fileBytes, materialBytes, upload, pipelines, recording) = load
            val framePipelines = frame.first()
            val report =
                LoadReport(
                    device = this.device,
                    technique = shown.technique,
                    fileBytes = fileBytes,
                    openNanos = shown.material.file.openNanos,
                    uploadNanos = upload,
                    pipelinesNanos = pipelines + framePipelines,
                    recordingNanos = recording,
                    projectionNanos = load.last(),
                    firstFrameNanos = frame.last() - framePipelines,
                    materialBytes = materialBytes,
                    gpuBytes = memory.bytes,
                    residentBytes = LoadReport.residentBytes(),
                )
            onLoaded(shown.material, report)
        }
    }

    /** Openers. */
    public companion object {
        private const val RGBA = 4
        private const val FIRST = 64
        private const val MEMORY = 5
        private const val FRAME_REPORT = 4
        private const val INFO = 5
        private val FIRST_MESH = SubsurfMesh.of(Shape.RELIEF)
        private val EMPTY = Bounds(Vector3(0f, 0f, 0f), 1f)

        /** Windows that a device has to draw to. */
        internal enum class Windows { NONE, ANDROID }

        /**
         * Opens a device without a window.
         *
         * @throws SubsurfException.NoDevice if the API has none here.
         */
        @JvmStatic
        @JvmOverloads
        @Throws(SubsurfException::class)
        public fun open(backend: Backend = Backend.AUTOMATIC): SubsurfRenderer = open(backend, Windows.NONE, 1)

        internal fun open(backend: Backend, windows: Windows, samples: Int): SubsurfRenderer {
            val gpu =
                Resources.handle("the device", Native::gpuClose) { Native.gpuOpen(backend.ordinal, windows.ordinal, it) }
            try {
                val info = info(gpu)
                val renderer =
                    Resources.handle("the renderer", Native::rendererClose) { out ->
                        gpu.call { Native.rendererCreate(it, samples, 0, out) }
                    }
                return SubsurfRenderer(gpu, renderer, info)
            } catch (
                @Suppress("TooGenericExceptionCaught") e: Throwable,
            ) {
                gpu.close()
                throw e
            }
        }

        private fun info(gpu: Handle): DeviceInfo {
            val ints = IntArray(INFO)
            val names = gpu.call { Native.gpuInfo(it, ints) }
            expectOk(ints.last())
            val (name, driver) = String(names ?: ByteArray(1), Charsets.UTF_8).split('\u0000', limit = 2)
            val backend = Backend.entries.getOrElse(ints[0]) { Backend.AUTOMATIC }
            return DeviceInfo(backend, name, driver, ints[1] != 0)
        }
    }
}
