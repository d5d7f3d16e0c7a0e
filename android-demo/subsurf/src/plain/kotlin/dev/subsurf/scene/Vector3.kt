package dev.subsurf

/** Three numbers: a direction, of length 1 where a function asks for that, or a place in mm. */
public data class Vector3(
    /** First number. */
    public val x: Float,
    /** Second number. */
    public val y: Float,
    /** Third number. */
    public val z: Float,
)
