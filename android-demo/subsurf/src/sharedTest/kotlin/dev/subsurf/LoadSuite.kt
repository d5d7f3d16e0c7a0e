package dev.subsurf

import java.util.Locale

/**
 * Loads of materials, many times: warm, on one device, and cold, on a device that was just opened and has no pipelines yet.
 *
 * @property repeats Loads of each kind.
 */
internal class LoadSuite(private val backend: Backend, private val repeats: Int) {
    /** Phase of a load, and how it is measured. */
    private val phases: List<Pair<String, (LoadReport) -> Long>> =
        listOf(
            "open" to LoadReport::openNanos,
            "upload" to LoadReport::uploadNanos,
            "pipelines" to LoadReport::pipelinesNanos,
            "recording" to LoadReport::recordingNanos,
            "projection" to LoadReport::projectionNanos,
            "drawable" to LoadReport::drawableNanos,
            "first_frame" to LoadReport::firstFrameNanos,
        )

    /** Lines of a table under [HEADER]: medians and 95th percentiles of each phase. */
    fun run(name: String, technique: Technique, open: () -> SubsurfMaterial): List<String> {
        fun load(renderer: SubsurfRenderer) = open().use { renderer.load(it, technique) }
        val warm =
            SubsurfRenderer.open(backend).use { renderer ->
                load(renderer)
                List(repeats) { load(renderer) }
            }
        val cold = List(repeats) { SubsurfRenderer.open(backend).use(::load) }
        return listOf("warm" to warm, "cold" to cold).flatMap { (state, reports) -> lines("$name,$state", reports) }
    }

    private fun lines(name: String, reports: List<LoadReport>): List<String> {
        val first = reports.first()
        val device = with(first.device) { listOf(backend.name, this.name, driver).joinToString(",", transform = LoadReport::quoted) }
        val bytes = "${first.fileBytes},${first.materialBytes},${reports.maxOf { it.gpuBytes }}"
        return phases.map { (phase, of) ->
            val sorted = reports.map(of).sorted()
            val (median, high) = sorted.percentile(50) to sorted.percentile(95)
            String.format(Locale.ROOT, "%s,%s,%s,%s,%d,%.3f,%.3f", name, device, first.technique, "$bytes,$phase", repeats, median, high)
        }
    }

    /** Nearest rank, in ms. */
    private fun List<Long>.percentile(percent: Int): Double = this[(size * percent + 99) / 100 - 1] / 1e6

    companion object {
        /** Names of the columns. */
        const val HEADER =
            "name,state,api,device,driver,technique,file_bytes,material_bytes,gpu_bytes,phase,repeats,median_ms,p95_ms"

        /** Materials that scripts make, and the technique that each is loaded for. */
        val MATERIALS =
            listOf(
                "jade" to Technique.AUTOMATIC,
                "jade" to Technique.SPLAT,
                "jade-24" to Technique.AUTOMATIC,
                "jade-16" to Technique.AUTOMATIC,
                "jade-profiles" to Technique.SPLAT,
                "leather" to Technique.AUTOMATIC,
            )
    }
}
