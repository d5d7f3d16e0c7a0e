package dev.subsurf

import android.content.Context
import android.os.Build
import java.io.File

/** Oldest Android whose Vulkan drivers are trusted, 10: conformance tests of Vulkan 1.1 came with it. */
private const val TRUSTED_VULKAN = Build.VERSION_CODES.Q

/** Boards of emulators, whose software Vulkan ends the process at some shaders. */
private val EMULATORS = setOf("goldfish", "ranchu")

/** Backend that [Backend.AUTOMATIC] stands for on this system: Vulkan where it can be trusted. */
internal fun preferredBackend(sdk: Int = Build.VERSION.SDK_INT, hardware: String = Build.HARDWARE): Backend =
    if (sdk >= TRUSTED_VULKAN && hardware !in EMULATORS) Backend.VULKAN else Backend.GL

/** Memory of crashes of an app, which an update of the system or of the app clears. */
internal fun backendMemory(context: Context): BackendMemory {
    @Suppress("DEPRECATION")
    val app = context.packageManager.getPackageInfo(context.packageName, 0)
    return BackendMemory(File(context.noBackupFilesDir, "subsurf"), "${Build.FINGERPRINT} ${app.lastUpdateTime}")
}

/** Engines of the library for a view. */
internal fun androidSource(view: SubsurfView): EngineSource {
    val preferred = view.backend.takeIf { it != Backend.AUTOMATIC } ?: preferredBackend()
    return RememberingSource(backendMemory(view.context), preferred) { backend ->
        val renderer = SubsurfRenderer.open(backend, SubsurfRenderer.Companion.Windows.ANDROID, SAMPLES)
        renderer.onLoaded = { material, report -> view.tell { it.onLoaded(material, report) } }
        NativeEngine(renderer)
    }
}

/** Samples to a pixel: edges of meshes are smooth. */
private const val SAMPLES = 4
