package dev.subsurf

import java.io.IOException

/**
 * Failure of a file or a device. [message] is one line: what was found, where, and what is expected.
 *
 * Mistakes of a program are not among them: these are [IllegalArgumentException] and [IllegalStateException].
 *
 * @property status Number of the `SubsurfStatus` of `subsurf.h`.
 */
public open class SubsurfException internal constructor(
    public val status: Int,
    message: String,
) : IOException(message) {
    /** File that the operating system did not open or map. */
    public class Io internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Bytes that are no sound `.subsurf` file, or one of a later format; the message is the decoder's. */
    public class InvalidFile internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** File of another family or model than what was asked of it. */
    public class WrongFamily internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Memory that was not to be had. */
    public class OutOfMemory internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** More bytes on the device than the budget of the renderer; nothing was allocated. */
    public class OverBudget internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Size or feature that the device does not have. */
    public class Unsupported internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Graphics API without a device on this machine: try another [Backend]. */
    public class NoDevice internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Device or driver that failed. */
    public class DeviceFailed internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Device that is gone with all that was on it: open another. */
    public class DeviceLost internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Mesh that is broken, or that a technique cannot draw. */
    public class InvalidMesh internal constructor(status: Int, message: String) : SubsurfException(status, message)

    /** Surface that is gone: open it again. */
    public class SurfaceLost internal constructor(status: Int, message: String) : SubsurfException(status, message)
}

/** Statuses of `subsurf.h` that Kotlin tells apart. */
internal object Status {
    const val OK: Int = 0
    const val INVALID_ARGUMENT: Int = 1
    const val NOT_EXPANDED: Int = 6
    const val UNSUPPORTED: Int = 8
    const val DEVICE_LOST: Int = 11
    const val SURFACE_LOST: Int = 13
    const val SKIPPED: Int = 14
}

/** Throws what a status stands for, unless it is 0. The text is that of the calling thread's last call. */
internal fun expectOk(status: Int) {
    if (status != Status.OK) throw exceptionOf(status, String(Native.lastError(), Charsets.UTF_8))
}

/** Exception of a status that is not 0. */
internal fun exceptionOf(status: Int, text: String): Exception =
    when (status) {
        Status.INVALID_ARGUMENT -> IllegalArgumentException(text)
        2 -> SubsurfException.Io(status, text)
        3 -> SubsurfException.InvalidFile(status, text)
        4 -> SubsurfException.WrongFamily(status, text)
        5 -> SubsurfException.OutOfMemory(status, text)
        Status.NOT_EXPANDED -> IllegalStateException(text)
        7 -> SubsurfException.OverBudget(status, text)
        Status.UNSUPPORTED -> SubsurfException.Unsupported(status, text)
        9 -> SubsurfException.NoDevice(status, text)
        10 -> SubsurfException.DeviceFailed(status, text)
        Status.DEVICE_LOST -> SubsurfException.DeviceLost(status, text)
        12 -> SubsurfException.InvalidMesh(status, text)
        Status.SURFACE_LOST -> SubsurfException.SurfaceLost(status, text)
        else -> SubsurfException(status, text)
    }
