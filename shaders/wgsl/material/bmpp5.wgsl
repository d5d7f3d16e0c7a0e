// Five base materials per pixel, K = 5. A constant, for arrays in functions have no size by override.

const PER_PIXEL: u32 = 5u;
