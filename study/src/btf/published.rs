//! What Havran et al. 2010 report of their measured materials, with their digits: tables 2 and 3.

/// Measured material, with the numbers that the paper prints for it.
pub(super) struct Published {
    pub(super) name: &'static str,
    /// Compression ratio with indices of as few bits as possible and scales of eight, and bytes.
    pub(super) ratio: &'static str,
    pub(super) bytes: &'static str,
    /// Time of compression in hours.
    pub(super) time: &'static str,
    /// MSSIM in YCrCb of theirs, PCA and local PCA.
    pub(super) mssim: [&'static str; 3],
    /// Ratios of their P1, P2, C, I1, I2, M, P3 and P4.
    pub(super) books: [&'static str; 8],
}

/// The measured material that a simulated one is meant to be like.
pub(super) fn published(material: &str) -> Option<&'static Published> {
    let at = ["foil", "leather", "corduroy", "knit", "wood"].iter().position(|name| *name == material);
    at.map(|at| &TABLES[at])
}

static TABLES: [Published; 5] = [
    Published {
        name: "foil1",
        ratio: "1:2040",
        bytes: "632,352",
        time: "19.5",
        mssim: ["0.859", "0.924", "0.923"],
        books: ["23,000", "910", "1.3·10⁸", "7.7·10⁵", "2.2·10⁵", "910", "120", "83"],
    },
    Published {
        name: "leather",
        ratio: "1:1244",
        bytes: "1,036,352",
        time: "17.2",
        mssim: ["0.802", "0.994", "0.994"],
        books: ["13,000", "450", "1.3·10⁸", "1.4·10⁵", "24,000", "430", "83", "83"],
    },
    Published {
        name: "corduroy",
        ratio: "1:418",
        bytes: "3,084,692",
        time: "19.2",
        mssim: ["0.748", "0.921", "0.916"],
        books: ["7,100", "170", "3.1·10⁷", "2,700", "200", "150", "830", "77"],
    },
    Published {
        name: "pulli",
        ratio: "1:264",
        bytes: "4,873,008",
        time: "27.1",
        mssim: ["0.699", "0.964", "0.955"],
        books: ["2,400", "71", "1.0·10⁸", "26,000", "1,500", "71", "50", "50"],
    },
    Published {
        name: "wood1",
        ratio: "1:352",
        bytes: "3,664,060",
        time: "22.3",
        mssim: ["0.866", "0.827", "0.811"],
        books: ["13,000", "210", "1.6·10⁷", "770", "160", "150", "83", "83"],
    },
];
