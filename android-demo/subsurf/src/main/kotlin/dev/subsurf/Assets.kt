@file:JvmName("SubsurfAssets")

package dev.subsurf

import android.content.res.AssetFileDescriptor
import android.content.res.AssetManager
import java.io.IOException

/**
 * Opens an asset of the app, mapped where it lies in the APK: it must be stored without compression, as
 * `androidResources { noCompress += "subsurf" }` has it.
 *
 * @throws IOException if there is no such asset, or it is compressed.
 * @throws SubsurfException.InvalidFile if it is not sound.
 */
@JvmName("open")
@Throws(IOException::class)
public fun SubsurfMaterial.Companion.open(assets: AssetManager, name: String): SubsurfMaterial =
    SubsurfMaterial(SubsurfFile.open(assets, name))

/** Opens an asset on a thread for input and output, otherwise as [open]. */
@JvmName("load")
public suspend fun SubsurfMaterial.Companion.load(assets: AssetManager, name: String): SubsurfMaterial =
    owned { open(assets, name) }

/** Opens an asset of the app as a file, otherwise as a material. */
@JvmName("openFile")
@Throws(IOException::class)
public fun SubsurfFile.Companion.open(assets: AssetManager, name: String): SubsurfFile =
    assets.openFd(name).use { open(it) }

/** Opens the part of a file that a descriptor of Android stands for, which stays the caller's. */
@JvmName("openFile")
@Throws(SubsurfException::class)
public fun SubsurfFile.Companion.open(descriptor: AssetFileDescriptor): SubsurfFile {
    val length = descriptor.declaredLength
    val isWhole = length == AssetFileDescriptor.UNKNOWN_LENGTH
    return open(descriptor.parcelFileDescriptor.fd, descriptor.startOffset, if (isWhole) SubsurfFile.TO_END else length)
}
