package dev.subsurf

import java.io.File
import java.io.IOException
import java.util.Locale

/**
 * Load of a material, from its file to its first frame: how long each phase took in ns, and what memory it took in bytes.
 *
 * @property device Device that it was loaded to.
 * @property technique Way to draw it that was asked for.
 * @property fileBytes Bytes of the file.
 * @property openNanos Opening of the file: mapping it, and reading and checking all of it, wherever its pages were.
 * @property uploadNanos Its bytes onto the device.
 * @property pipelinesNanos Pipelines that load and first frame compiled; 0 where an earlier one has left them.
 * @property recordingNanos What the CPU does of the projection.
 * @property projectionNanos Coefficients and albedo over the patch, drawn on the device, recording included.
 * @property firstFrameNanos First frame, without pipelines, until the device has done it.
 * @property materialBytes Bytes of the material on the device.
 * @property gpuBytes Bytes of everything on the device.
 * @property residentBytes Memory of the process that is resident, shared pages included; 0 where the system does not tell.
 */
@Suppress("LongParameterList")
public class LoadReport internal constructor(
    public val device: DeviceInfo,
    public val technique: Technique,
    public val fileBytes: Long,
    public val openNanos: Long,
    public val uploadNanos: Long,
    public val pipelinesNanos: Long,
    public val recordingNanos: Long,
    public val projectionNanos: Long,
    public val firstFrameNanos: Long,
    public val materialBytes: Long,
    public val gpuBytes: Long,
    public val residentBytes: Long,
) {
    /** Time until the material can be drawn in ns, without pipelines, which are compiled once. */
    public val drawableNanos: Long get() = openNanos + uploadNanos + projectionNanos

    /** Line of a table under [CSV_HEADER], without the end of the line: times in ms, bytes as they are. */
    public fun toCsv(name: String): String {
        val times = listOf(openNanos, uploadNanos, pipelinesNanos, recordingNanos, projectionNanos, firstFrameNanos)
        val texts = listOf(name, device.backend.name, device.name, device.driver, technique.name).map(::quoted)
        val milliseconds = times.map { String.format(Locale.ROOT, "%.3f", it / NANOS_OF_MS) }
        return (texts + fileBytes + milliseconds + materialBytes + gpuBytes + residentBytes).joinToString(",")
    }

    /** Head of the table. */
    public companion object {
        private const val NANOS_OF_MS = 1e6

        /** Names of the columns of [toCsv]. */
        public const val CSV_HEADER: String =
            "name,api,device,driver,technique,file_bytes,open_ms,upload_ms,pipelines_ms,recording_ms,projection_ms," +
                "first_frame_ms,material_bytes,gpu_bytes,resident_bytes"

        /** Text as a field of a table (RFC 4180). */
        internal fun quoted(text: String): String =
            if (text.any { it in ",\"\r\n" }) "\"" + text.replace("\"", "\"\"") + "\"" else text

        /** Resident memory of this process, as Linux tells it. */
        internal fun residentBytes(status: File = File("/proc/self/status")): Long =
            try {
                status.useLines { lines ->
                    val line = lines.firstOrNull { it.startsWith("VmRSS:") } ?: return 0
                    line.filter(Char::isDigit).toLong() * KIB
                }
            } catch (_: IOException) {
                0
            }

        private const val KIB = 1024L
    }
}
