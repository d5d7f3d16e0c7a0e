package dev.subsurf

/** What a file holds. */
public enum class Family {
    /** Of a kind that this version does not know. */
    OTHER,

    /** Diffuse BSSRDF of a patch: [SubsurfFile.bssrdf]. */
    BSSRDF,

    /** Bidirectional texture functions in nested codebooks: [SubsurfFile.btf]. */
    NESTED_BTF,

    /** Bidirectional texture functions as factors: [SubsurfFile.btf], after [Btf.expand]. */
    FACTORED_BTF,

    /** Separable kernel of a homogeneous material. */
    KERNEL,
}

/** Encoding of the mixtures of a patch. */
public enum class Coding {
    /** Single-precision ratios, and an index for each base material of a pixel. */
    EXACT,

    /** Two base materials, the ratio in 8 bits: 24 bits per pixel. */
    SMALL_RATIOS,

    /** Two base materials by a palette of pairs, the ratio in 5 bits: 16 bits per pixel. */
    PALETTE,
}

/** What lies beyond the border of a patch. */
public enum class Addressing {
    /** The border pixel goes on. */
    CLAMP,

    /** The patch repeats. */
    REPEAT,

    /** The patch repeats, every other copy reflected. */
    MIRROR,
}

/** What the numbers of a plane are. */
public enum class PlaneKind {
    /** Log-scale base scattering profiles: a row for each base material, a column for each node; natural log of mm^-2 in R, G, B. */
    BASE_PROFILES,

    /** Log-scale local scattering profiles: layer 3 h + c has node h of channel c for each pixel; natural log of mm^-2. */
    LOCAL_PROFILES,

    /** Mixture ratios t, 0 to 1. For K = 2, t of the first base material; for K = 3 and 5, layer k has t_k. */
    MIXTURE_RATIOS,

    /** Base-material indices. For K = 2 both in R and G; for K = 1, 3 and 5, layer k has b_k. */
    BASE_INDICES,

    /** Palette of pairs: the two base materials in R and G, a column for each pair. */
    PAIRS,

    /** Palette codes: the number of the pair in the lower 11 bits, 31 t of its first base material in the upper 5. */
    CODES,
}

/** Format of the texels of a plane. Numbers are little-endian. */
public enum class PlaneFormat {
    /** GL_R32F. */
    R32_FLOAT,

    /** GL_RGB32F. */
    RGB32_FLOAT,

    /** GL_RGB16F. */
    RGB16_FLOAT,

    /** GL_R8. */
    R8_UNORM,

    /** GL_R8UI. */
    R8_UINT,

    /** GL_RG8UI. */
    RG8_UINT,

    /** GL_R16UI. */
    R16_UINT,
}
