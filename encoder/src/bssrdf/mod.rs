//! Fits diffuse BSSRDFs: per-pixel profiles and 2-BMPP.

mod banded;
mod cluster;
mod direct;
mod field;
mod lanes;
mod lsp;
mod normal;
mod window;
mod write;

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::Header;
use subsurf_decoder::bssrdf::layout::{LENGTHS_MM, MAX_BASE_MATERIALS, MAX_SAMPLES, MODEL_2BMPP, MODEL_PER_PIXEL};

use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::progress::Progress;
use direct::Model;
use field::Field;
use normal::Normal;
use window::Geometry;
pub use write::write_file;

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A profile for every pixel (Song et al. 2009): large, and the best that any of the others can do.
    Lsp,
    /// k-means clusters of the per-pixel profiles, one per pixel: a baseline of 2-BMPP's size.
    Clusters,
    /// Two base materials per pixel by exact alternation.
    Direct,
}

/// What to fit.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// How.
    pub method: Method,
    /// M, 1 to 256.
    pub base_materials: usize,
    /// S, the nodes of a profile; `None` takes R + 1.
    pub samples: Option<usize>,
    /// Seed of the first cluster centres.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { method: Method::Direct, base_materials: 128, samples: None, seed: 1 }
    }
}

/// A fitted material.
#[derive(Clone, Debug)]
pub struct Encoded {
    /// The `.subsurf` file.
    pub bytes: Vec<u8>,
    /// Entries of the capture inside the material; three channels make three entries.
    pub entries: u64,
    /// Those of them that were measured.
    pub measured: u64,
    /// ½ Σ φ (P̂_i + P̂_j − 2 ln Rd)² over all of these (Yatagawa et al. 2020, eq. 5).
    pub cost: f64,
    /// Base materials in the file; 0 for per-pixel profiles.
    pub base_materials: usize,
    /// S.
    pub samples: usize,
}

/// The radius of the last node lies a hair beyond the window's corner, so that rounding does not cut the corner off.
const BEYOND_CORNER: f64 = 1.0 + 1e-6;

/// Fits a capture. The result depends on the capture and the options alone, not on the number of threads.
///
/// # Errors
/// [`Error::Request`] for options out of range, [`Error::Input`] if nothing was measured.
pub fn encode(capture: &Capture, options: &Options, progress: &dyn Progress) -> Result<Encoded> {
    let geometry = geometry(capture, options)?;
    let normal = Normal::of(capture, geometry, progress)?;
    let profiles = lsp::fit(&normal, progress);
    let (sections, cost, bases) = match options.method {
        Method::Lsp => (vec![per_pixel(&normal, &profiles)], normal.cost(&profiles), 0),
        Method::Clusters | Method::Direct => {
            let clusters = cluster::cluster(&normal, &profiles, options.base_materials, options.seed, progress);
            drop(profiles);
            let mut model = Model::of_clusters(clusters, geometry.nodes);
            if options.method == Method::Direct {
                direct::refine(&normal, &mut model, progress);
            }
            model.pad(options.base_materials);
            let cost = normal.cost(&model.field(&normal));
            (base_materials(&normal, &model), cost, options.base_materials)
        }
    };
    let header = header(capture, &geometry, bases);
    Ok(Encoded {
        bytes: write_file(&header, &sections),
        entries: normal.entries[0],
        measured: normal.entries[1],
        cost,
        base_materials: bases,
        samples: geometry.nodes,
    })
}

fn geometry(capture: &Capture, options: &Options) -> Result<Geometry> {
    let limit = MAX_BASE_MATERIALS as usize;
    if !(1..=limit).contains(&options.base_materials) {
        let message = format!("{} base materials; a file holds 1 to {limit}", options.base_materials);
        return Err(Error::Request(message));
    }
    let nodes = options.samples.unwrap_or((capture.radius() + 1).max(2));
    if !(2..=MAX_SAMPLES.into()).contains(&nodes) {
        return Err(Error::Request(format!("{nodes} samples; a profile holds 2 to {MAX_SAMPLES}")));
    }
    #[allow(clippy::cast_precision_loss, reason = "R < 1,024")]
    let corner = (capture.radius().max(1) as f64) * std::f64::consts::SQRT_2;
    let corner_mm = corner * f64::from(capture.pitch_mm());
    if corner_mm >= f64::from(LENGTHS_MM[1]) {
        return Err(Error::Request(format!("a window that reaches {corner_mm} mm; a file holds {}", LENGTHS_MM[1])));
    }
    Ok(Geometry {
        size: [capture.width(), capture.height()],
        radius: capture.radius(),
        nodes,
        r_max_px: corner * BEYOND_CORNER,
        addressing: capture.addressing(),
    })
}

fn header(capture: &Capture, geometry: &Geometry, bases: usize) -> Header {
    let small = |n: usize| u32::try_from(n).expect("checked when the capture was opened");
    let smaller = |n: usize| u16::try_from(n).expect("checked when the capture was opened");
    #[allow(clippy::cast_possible_truncation, reason = "a radius in pixels")]
    let r_max_px = geometry.r_max_px as f32;
    Header {
        model: if bases == 0 { MODEL_PER_PIXEL } else { MODEL_2BMPP },
        addressing: geometry.addressing,
        width: small(geometry.size[0]),
        height: small(geometry.size[1]),
        window_radius: smaller(geometry.radius),
        samples: smaller(geometry.nodes),
        base_materials: small(bases),
        pitch_mm: capture.pitch_mm(),
        r_max_mm: r_max_px * capture.pitch_mm(),
        eta: capture.eta(),
    }
}

/// `LSPP`: planes of node and channel.
fn per_pixel(normal: &Normal, profiles: &Field) -> (Section, Vec<u8>) {
    let planes = (0..normal.geometry.nodes).flat_map(|h| (0..3).map(move |c| (h, c)));
    let values = planes.flat_map(|(h, c)| {
        let mean = normal.mean[h][c];
        (0..normal.geometry.pixels()).map(move |pixel| profiles.at(pixel)[h][c] + mean)
    });
    (Section::LocalProfiles, write::logs(values))
}

/// `PROF`, `MIXR`, `BIDX`.
fn base_materials(normal: &Normal, model: &Model) -> Vec<(Section, Vec<u8>)> {
    let mean = normal.mean.iter().cycle();
    let values = model.bases.iter().zip(mean).flat_map(|(p, mean)| [0, 1, 2].map(|c| p[c] + mean[c]));
    let byte = |base: usize| u8::try_from(base).expect("at most 256 base materials");
    vec![
        (Section::BaseProfiles, write::logs(values)),
        (Section::MixtureRatios, model.mixtures.iter().flat_map(|mixture| mixture.t.to_le_bytes()).collect()),
        (Section::BaseIndices, model.mixtures.iter().flat_map(|mixture| mixture.base.map(byte)).collect()),
    ]
}
