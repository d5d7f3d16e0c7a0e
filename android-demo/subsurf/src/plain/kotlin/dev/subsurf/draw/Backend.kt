package dev.subsurf

/** Graphics API. */
public enum class Backend {
    /** The first that has a device. */
    AUTOMATIC,

    /** Vulkan. */
    VULKAN,

    /** OpenGL ES 3.0. */
    GL,
}

/** Way to draw a material. */
public enum class Technique {
    /** The fastest that the file offers. */
    AUTOMATIC,

    /** Splats: every place that light reaches is spread over what lies around it. For BSSRDFs. */
    SPLAT,

    /** Weighted irradiance maps and shared Gaussians: the fastest. For BSSRDFs with a separable basis. */
    SEPARABLE,

    /** BTF, as it is. */
    BTF,

    /** Separable kernel of a homogeneous material. */
    KERNEL,
}

/**
 * Device that is drawn with.
 *
 * @property backend API that was opened.
 * @property name Name of the device, as its driver says it.
 * @property driver Name and version of the driver.
 * @property isSoftware Whether the CPU stands in for it.
 */
public class DeviceInfo internal constructor(
    public val backend: Backend,
    public val name: String,
    public val driver: String,
    public val isSoftware: Boolean,
)

/**
 * Bytes on the device, as far as this library asked for them; what drivers add is not known.
 *
 * @property materialsBytes Materials.
 * @property meshesBytes Meshes.
 * @property lightViewsBytes What lights see.
 * @property framesBytes Maps of frames.
 * @property othersBytes Pictures, and what is on its way.
 */
public class GpuMemory internal constructor(
    public val materialsBytes: Long,
    public val meshesBytes: Long,
    public val lightViewsBytes: Long,
    public val framesBytes: Long,
    public val othersBytes: Long,
) {
    /** Sum of all. */
    public val bytes: Long get() = materialsBytes + meshesBytes + lightViewsBytes + framesBytes + othersBytes
}
