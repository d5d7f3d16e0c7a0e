//! What Yatagawa et al. 2020 report of their measured materials: tables 2, 5 and 6.

/// One measured material. Arrays go with [`METHODS`].
pub(super) struct Published {
    /// Its name in their tables.
    pub(super) name: &'static str,
    pub(super) pixels: &'static str,
    pub(super) original_mb: f64,
    /// `None` for LSP clusters: not reported.
    pub(super) bytes: [Option<f64>; 6],
    /// Seconds; not reported for the first two.
    pub(super) seconds: [Option<f64>; 6],
    pub(super) relative_error: [f64; 6],
    pub(super) psnr_db: [f64; 6],
    pub(super) ssim: [f64; 6],
}

/// Their columns of numbers: Song et al., LSP clusters, then K-BMPP. In tables 5 and 6 clusters and K = 1 have as many
/// base materials as the bytes of K = 2 hold; in table 2, K = 1 has 128.
pub(super) const METHODS: [&str; 6] = ["song", "clusters-equal", "k1-equal", "k2", "k3", "k5"];

/// In the order of the names of built-in materials that are meant to be like them.
pub(super) fn published(material: &str) -> Option<&'static Published> {
    let at =
        ["stone", "chessboard", "onyx", "blue-wax", "yellow-wax", "jade"].iter().position(|name| *name == material);
    at.map(|at| &TABLES[at])
}

const MB: f64 = 1e6;
const KB: f64 = 1e3;
const MINUTE: f64 = 60.0;
const HOUR: f64 = 3_600.0;

const fn sizes(song_mb: f64, kb: [f64; 4]) -> [Option<f64>; 6] {
    let [k1, k2, k3, k5] = kb;
    [Some(song_mb * MB), None, Some(k1 * KB), Some(k2 * KB), Some(k3 * KB), Some(k5 * KB)]
}

const fn times(k1: f64, k2: f64, k3: f64, k5: f64) -> [Option<f64>; 6] {
    [None, None, Some(k1), Some(k2), Some(k3), Some(k5)]
}

static TABLES: [Published; 6] = [
    Published {
        name: "Art. stone",
        pixels: "108 × 108",
        original_mb: 163.0,
        bytes: sizes(2.5, [39.0, 98.0, 203.0, 319.0]),
        seconds: times(3.0 * MINUTE + 45.0, 4.0 * MINUTE + 7.0, 5.0 * HOUR + 45.0 * MINUTE, 8.0 * HOUR + 15.0 * MINUTE),
        relative_error: [0.0223, 0.0429, 0.0303, 0.0372, 0.0413, 0.0491],
        psnr_db: [39.7, 25.3, 31.3, 30.7, 26.7, 24.6],
        ssim: [0.998, 0.875, 0.970, 0.937, 0.901, 0.854],
    },
    Published {
        name: "Chessboard",
        pixels: "222 × 222",
        original_mb: 857.0,
        bytes: sizes(10.7, [80.0, 326.0, 770.0, 1263.0]),
        seconds: times(
            23.0 * MINUTE + 10.0,
            24.0 * MINUTE + 4.0,
            33.0 * HOUR + 21.0 * MINUTE,
            46.0 * HOUR + 41.0 * MINUTE,
        ),
        relative_error: [0.0376, 0.0438, 0.0425, 0.0438, 0.0452, 0.0444],
        psnr_db: [28.8, 25.2, 26.4, 26.5, 24.8, 26.8],
        ssim: [0.960, 0.855, 0.940, 0.905, 0.873, 0.901],
    },
    Published {
        name: "Onyx",
        pixels: "229 × 229",
        original_mb: 912.0,
        bytes: sizes(11.4, [83.0, 345.0, 817.0, 1341.0]),
        seconds: times(23.0 * MINUTE + 12.0, 21.0 * MINUTE + 48.0, 35.0 * HOUR + 19.0 * MINUTE, 20.0 * HOUR + MINUTE),
        relative_error: [0.0413, 0.0435, 0.0434, 0.0428, 0.0430, 0.0427],
        psnr_db: [18.8, 18.0, 18.0, 18.6, 18.5, 18.3],
        ssim: [0.888, 0.835, 0.853, 0.870, 0.870, 0.873],
    },
    Published {
        name: "Blue wax",
        pixels: "228 × 88",
        original_mb: 281.0,
        bytes: sizes(4.4, [48.0, 148.0, 329.0, 529.0]),
        seconds: times(
            6.0 * MINUTE + 54.0,
            7.0 * MINUTE + 25.0,
            9.0 * HOUR + 50.0 * MINUTE,
            13.0 * HOUR + 49.0 * MINUTE,
        ),
        relative_error: [0.0237, 0.0402, 0.0441, 0.0276, 0.0273, 0.0345],
        psnr_db: [40.5, 21.3, 20.7, 27.3, 27.1, 25.3],
        ssim: [0.999, 0.949, 0.843, 0.964, 0.974, 0.959],
    },
    Published {
        name: "Yellow wax",
        pixels: "110 × 110",
        original_mb: 210.0,
        bytes: sizes(2.6, [43.0, 103.0, 212.0, 333.0]),
        seconds: times(
            5.0 * MINUTE + 17.0,
            4.0 * MINUTE + 57.0,
            7.0 * HOUR + 14.0 * MINUTE,
            10.0 * HOUR + 21.0 * MINUTE,
        ),
        relative_error: [0.0222, 0.0619, 0.0351, 0.0319, 0.0307, 0.0370],
        psnr_db: [36.8, 21.4, 28.8, 31.9, 32.9, 31.7],
        ssim: [0.995, 0.949, 0.942, 0.962, 0.962, 0.952],
    },
    Published {
        name: "Jade",
        pixels: "260 × 260",
        original_mb: 947.0,
        bytes: sizes(14.6, [95.0, 433.0, 1041.0, 1717.0]),
        seconds: times(
            24.0 * MINUTE + 23.0,
            22.0 * MINUTE + 56.0,
            38.0 * HOUR + 8.0 * MINUTE,
            53.0 * HOUR + 48.0 * MINUTE,
        ),
        relative_error: [0.0610, 0.0807, 0.0728, 0.0753, 0.0789, 0.0773],
        psnr_db: [26.6, 19.6, 20.5, 20.9, 20.4, 20.9],
        ssim: [0.977, 0.852, 0.821, 0.823, 0.793, 0.811],
    },
];
