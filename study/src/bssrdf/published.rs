//! What Yatagawa et al. 2020 report of their measured materials, with their digits: tables 2, 5 and 6.

/// Measured material, with the numbers that the paper prints for it.
pub(super) struct Published {
    /// Name in the paper's tables.
    pub(super) name: &'static str,
    pub(super) pixels: &'static str,
    pub(super) original: &'static str,
    /// Bytes by the rows of [`SIZED`].
    pub(super) bytes: [&'static str; 5],
    /// Times by the rows of [`SIZED`], the first left out.
    pub(super) times: [&'static str; 4],
    /// Relative errors by the rows of [`COMPARED`].
    pub(super) relative_error: [&'static str; 6],
    pub(super) psnr_db: [&'static str; 6],
    pub(super) ssim: [&'static str; 6],
}

/// Rows of table 2, all with M = 128.
pub(super) const SIZED: [&str; 5] = ["Song et al.", "1-BMPP", "2-BMPP", "3-BMPP", "5-BMPP"];
/// Rows of tables 5 and 6. Clusters and 1-BMPP have as many base materials as the bytes of 2-BMPP hold.
pub(super) const COMPARED: [&str; 6] =
    ["Song et al.", "LSP clusters, equal bytes", "1-BMPP, equal bytes", "2-BMPP", "3-BMPP", "5-BMPP"];

/// The measured material that a built-in one is meant to be like.
pub(super) fn published(material: &str) -> Option<&'static Published> {
    let at =
        ["stone", "chessboard", "onyx", "blue-wax", "yellow-wax", "jade"].iter().position(|name| *name == material);
    at.map(|at| &TABLES[at])
}

static TABLES: [Published; 6] = [
    Published {
        name: "Art. stone",
        pixels: "108 × 108",
        original: "163 MB",
        bytes: ["2.5 MB", "39 kB", "98 kB", "203 kB", "319 kB"],
        times: ["3 m 45 s", "4 m 07 s", "5 h 45 m", "8 h 15 m"],
        relative_error: ["0.0223", "0.0429", "0.0303", "0.0372", "0.0413", "0.0491"],
        psnr_db: ["39.7", "25.3", "31.3", "30.7", "26.7", "24.6"],
        ssim: ["0.998", "0.875", "0.970", "0.937", "0.901", "0.854"],
    },
    Published {
        name: "Chessboard",
        pixels: "222 × 222",
        original: "857 MB",
        bytes: ["10.7 MB", "80 kB", "326 kB", "770 kB", "1263 kB"],
        times: ["23 m 10 s", "24 m 04 s", "33 h 21 m", "46 h 41 m"],
        relative_error: ["0.0376", "0.0438", "0.0425", "0.0438", "0.0452", "0.0444"],
        psnr_db: ["28.8", "25.2", "26.4", "26.5", "24.8", "26.8"],
        ssim: ["0.960", "0.855", "0.940", "0.905", "0.873", "0.901"],
    },
    Published {
        name: "Onyx",
        pixels: "229 × 229",
        original: "912 MB",
        bytes: ["11.4 MB", "83 kB", "345 kB", "817 kB", "1341 kB"],
        times: ["23 m 12 s", "21 m 48 s", "35 h 19 m", "20 h 01 m"],
        relative_error: ["0.0413", "0.0435", "0.0434", "0.0428", "0.0430", "0.0427"],
        psnr_db: ["18.8", "18.0", "18.0", "18.6", "18.5", "18.3"],
        ssim: ["0.888", "0.835", "0.853", "0.870", "0.870", "0.873"],
    },
    Published {
        name: "Blue wax",
        pixels: "228 × 88",
        original: "281 MB",
        bytes: ["4.4 MB", "48 kB", "148 kB", "329 kB", "529 kB"],
        times: ["6 m 54 s", "7 m 25 s", "9 h 50 m", "13 h 49 m"],
        relative_error: ["0.0237", "0.0402", "0.0441", "0.0276", "0.0273", "0.0345"],
        psnr_db: ["40.5", "21.3", "20.7", "27.3", "27.1", "25.3"],
        ssim: ["0.999", "0.949", "0.843", "0.964", "0.974", "0.959"],
    },
    Published {
        name: "Yellow wax",
        pixels: "110 × 110",
        original: "210 MB",
        bytes: ["2.6 MB", "43 kB", "103 kB", "212 kB", "333 kB"],
        times: ["5 m 17 s", "4 m 57 s", "7 h 14 m", "10 h 21 m"],
        relative_error: ["0.0222", "0.0619", "0.0351", "0.0319", "0.0307", "0.0370"],
        psnr_db: ["36.8", "21.4", "28.8", "31.9", "32.9", "31.7"],
        ssim: ["0.995", "0.949", "0.942", "0.962", "0.962", "0.952"],
    },
    Published {
        name: "Jade",
        pixels: "260 × 260",
        original: "947 MB",
        bytes: ["14.6 MB", "95 kB", "433 kB", "1041 kB", "1717 kB"],
        times: ["24 m 23 s", "22 m 56 s", "38 h 08 m", "53 h 48 m"],
        relative_error: ["0.0610", "0.0807", "0.0728", "0.0753", "0.0789", "0.0773"],
        psnr_db: ["26.6", "19.6", "20.5", "20.9", "20.4", "20.9"],
        ssim: ["0.977", "0.852", "0.821", "0.823", "0.793", "0.811"],
    },
];
