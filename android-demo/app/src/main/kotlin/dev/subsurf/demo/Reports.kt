package dev.subsurf.demo

import dev.subsurf.LoadReport
import java.util.Locale

/** What was measured since the app was opened. */
internal class Reports {
    /** Name of the material that is shown. */
    var name = ""

    private val lines = mutableListOf<String>()
    private var last: LoadReport? = null
    private val frames = LongArray(FRAMES)
    private var count = 0

    fun loaded(report: LoadReport) {
        last = report
        lines += report.toCsv(name)
    }

    /** Adds a frame; whether there are enough for another text. */
    fun frame(nanos: Long): Boolean {
        frames[count % FRAMES] = nanos
        count++
        return count % FRAMES == 0
    }

    /** Table of all loads. */
    fun csv(): String = (listOf(LoadReport.CSV_HEADER) + lines).joinToString("\n", postfix = "\n")

    /** Last load and last frames, for the screen. */
    fun text(): String {
        val load = last ?: return ""
        val sorted = frames.take(minOf(count, FRAMES)).sorted()
        val frame = if (sorted.isEmpty()) "" else "\nframes: ${ms(sorted[sorted.size / 2])} median, ${ms(sorted.last())} most"
        return "${load.device.name}, ${load.device.backend}\n" +
            "$name: ${load.fileBytes} bytes\n" +
            "open ${ms(load.openNanos)}, upload ${ms(load.uploadNanos)}, projection ${ms(load.projectionNanos)}, " +
            "pipelines ${ms(load.pipelinesNanos)}, first frame ${ms(load.firstFrameNanos)}\n" +
            "device ${kb(load.gpuBytes)}, of it the material ${kb(load.materialBytes)}; process ${kb(load.residentBytes)}" +
            frame
    }

    private fun ms(nanos: Long) = String.format(Locale.ROOT, "%.2f ms", nanos / 1e6)

    private fun kb(bytes: Long) = "${bytes / 1000} kB"

    private companion object {
        const val FRAMES = 30
    }
}
