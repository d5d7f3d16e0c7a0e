package dev.subsurf

import java.nio.ByteBuffer
import java.nio.FloatBuffer
import java.nio.IntBuffer

/**
 * Entry points of `libsubsurf`, one for each function of `subsurf.h`, with its name but for the prefix. They return a status of the
 * header, 0 for success; what they find goes to the arrays whose names end in `Out`, or to `ints`, `longs` and `floats` in the
 * order of the fields of the C struct.
 *
 * Nothing is checked here: handles are open and arrays long enough.
 */
@Suppress("LongParameterList", "TooManyFunctions")
internal object Native {
    init {
        System.loadLibrary("subsurf")
    }

    @JvmStatic external fun abiVersion(): Int

    /** Text of the last call of this thread that failed, in UTF-8. */
    @JvmStatic external fun lastError(): ByteArray

    /** `path` ends with a zero. */
    @JvmStatic external fun fileOpenPath(path: ByteArray, fileOut: LongArray): Int

    @JvmStatic external fun fileOpenFd(fd: Int, offset: Long, length: Long, fileOut: LongArray): Int

    /** `buffer` is direct, and stays until the file is closed. */
    @JvmStatic external fun fileOpenMemory(buffer: ByteBuffer, offset: Int, length: Int, fileOut: LongArray): Int

    @JvmStatic external fun fileClose(file: Long)

    @JvmStatic external fun fileInfo(file: Long, longs: LongArray): Int

    @JvmStatic external fun bssrdfInfo(file: Long, ints: IntArray, floats: FloatArray): Int

    /** `longs`: ten numbers, the bytes of a layer, and the status. */
    @JvmStatic external fun bssrdfPlane(file: Long, number: Int, longs: LongArray): ByteBuffer?

    @JvmStatic external fun bssrdfRd(file: Long, xI: Int, yI: Int, xO: Int, yO: Int, rdOut: FloatArray): Int

    @JvmStatic external fun bssrdfAlbedo(file: Long, x: Int, y: Int, albedoOut: FloatArray): Int

    @JvmStatic external fun btfInfo(file: Long, ints: IntArray, floats: FloatArray, expansionOut: LongArray): Int

    /** `ints`: width, height, levels, and the status. */
    @JvmStatic external fun btfMaterial(file: Long, number: Int, ints: IntArray): ByteArray?

    @JvmStatic external fun btfExpand(file: Long): Int

    @JvmStatic external fun btfTexel(file: Long, material: Int, level: Int, x: Int, y: Int, texelOut: IntArray): Int

    @JvmStatic
    external fun btfEval(
        file: Long,
        texel: Int,
        lightX: Float,
        lightY: Float,
        lightZ: Float,
        viewX: Float,
        viewY: Float,
        viewZ: Float,
        valueOut: FloatArray,
    ): Int

    @JvmStatic external fun btfLinear(file: Long, red: Float, green: Float, blue: Float, rgbOut: FloatArray): Int

    @JvmStatic
    external fun btfSample(
        file: Long,
        texel: Int,
        viewX: Float,
        viewY: Float,
        viewZ: Float,
        random0: Float,
        random1: Float,
        lightAndPdfOut: FloatArray,
    ): Int

    @JvmStatic
    external fun btfPdf(
        file: Long,
        texel: Int,
        lightX: Float,
        lightY: Float,
        lightZ: Float,
        viewX: Float,
        viewY: Float,
        viewZ: Float,
        pdfOut: FloatArray,
    ): Int

    @JvmStatic
    external fun btfAlbedo(
        file: Long,
        texel: Int,
        viewX: Float,
        viewY: Float,
        viewZ: Float,
        albedoOut: FloatArray,
    ): Int

    @JvmStatic external fun gpuOpen(backend: Int, windowSystem: Int, gpuOut: LongArray): Int

    /** Device and driver, with a zero between them; `ints`: four numbers, and the status. */
    @JvmStatic external fun gpuInfo(gpu: Long, ints: IntArray): ByteArray?

    @JvmStatic external fun gpuMemory(gpu: Long, longs: LongArray): Int

    @JvmStatic external fun gpuFinish(gpu: Long): Int

    /** Loses the device, for tests of what follows. */
    @JvmStatic external fun gpuLose(gpu: Long): Int

    @JvmStatic external fun gpuClose(gpu: Long)

    @JvmStatic external fun environmentUniform(red: Float, green: Float, blue: Float, environmentOut: LongArray): Int

    @JvmStatic external fun environmentStudio(environmentOut: LongArray): Int

    @JvmStatic external fun environmentClose(environment: Long)

    /** `reportOut`: bytes of the file and on the device; ns of upload, pipelines, recording, projection. */
    @JvmStatic
    external fun materialLoad(
        gpu: Long,
        file: Long,
        technique: Int,
        reportOut: LongArray,
        materialOut: LongArray,
    ): Int

    @JvmStatic external fun materialInfo(material: Long, longs: LongArray): Int

    @JvmStatic external fun materialClose(material: Long)

    @JvmStatic
    external fun meshUpload(
        gpu: Long,
        vertices: Int,
        triangles: Int,
        positions: FloatBuffer,
        normals: FloatBuffer?,
        uvs: FloatBuffer?,
        indices: IntBuffer,
        meshOut: LongArray,
    ): Int

    @JvmStatic external fun meshShape(gpu: Long, shape: Int, extentMm: Float, meshOut: LongArray): Int

    /** `floats`: centre and radius. */
    @JvmStatic external fun meshInfo(mesh: Long, ints: IntArray, floats: FloatArray, bytesOut: LongArray): Int

    @JvmStatic external fun meshClose(mesh: Long)

    @JvmStatic external fun rendererCreate(gpu: Long, samples: Int, budgetBytes: Long, rendererOut: LongArray): Int

    /** `numbers` and `handles` are those of [Scene.numbers]; `reportOut`, if there is one: ns of pipelines, preparation, recording, all. */
    @JvmStatic
    external fun drawPicture(
        renderer: Long,
        picture: Long,
        numbers: FloatArray,
        handles: LongArray,
        reportOut: LongArray?,
    ): Int

    @JvmStatic
    external fun drawSurface(
        renderer: Long,
        surface: Long,
        numbers: FloatArray,
        handles: LongArray,
        reportOut: LongArray?,
    ): Int

    @JvmStatic external fun rendererTrim(renderer: Long): Int

    @JvmStatic external fun rendererClose(renderer: Long)

    @JvmStatic external fun pictureCreate(gpu: Long, width: Int, height: Int, pictureOut: LongArray): Int

    /** `pixels` is direct; RGBA8, rows from the top. */
    @JvmStatic external fun pictureRead(picture: Long, pixels: ByteBuffer, length: Int): Int

    @JvmStatic external fun pictureClose(picture: Long)

    @JvmStatic external fun frameLookAt(numbers: FloatArray, matricesOut: FloatArray): Int

    /** `window` is a `Surface`. */
    @JvmStatic
    external fun surfaceOpen(gpu: Long, window: Any, width: Int, height: Int, surfaceAndWindowOut: LongArray): Int

    @JvmStatic external fun surfaceResize(surface: Long, width: Int, height: Int): Int

    @JvmStatic external fun surfaceClose(surface: Long, window: Long)
}
