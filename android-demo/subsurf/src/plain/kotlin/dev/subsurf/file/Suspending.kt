@file:JvmName("Suspending")

package dev.subsurf

import kotlinx.coroutines.CancellationException
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.withContext
import java.nio.ByteBuffer

/** Opens a file by its path on a thread for input and output, as [SubsurfMaterial.open]. */
public suspend fun SubsurfMaterial.Companion.load(path: String): SubsurfMaterial = owned { open(path) }

/** Opens a part of a file by its descriptor on a thread for input and output, as [SubsurfMaterial.open]. */
public suspend fun SubsurfMaterial.Companion.load(
    fd: Int,
    offset: Long = 0,
    length: Long = SubsurfFile.TO_END,
): SubsurfMaterial = owned { open(fd, offset, length) }

/** Opens the bytes of a direct buffer on a thread for input and output, as [SubsurfMaterial.open]. */
public suspend fun SubsurfMaterial.Companion.load(buffer: ByteBuffer): SubsurfMaterial = owned { open(buffer) }

/** What is opened on a thread for input and output; closed again if nobody waits for it any more. */
internal suspend fun <T : AutoCloseable> owned(open: () -> T): T {
    var opened: T? = null
    try {
        return withContext(Dispatchers.IO) { open().also { opened = it } }
    } catch (e: CancellationException) {
        opened?.close()
        throw e
    }
}
