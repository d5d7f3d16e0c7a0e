//! Fits diffuse BSSRDFs: per-pixel profiles and K-BMPP.

mod banded;
mod cluster;
mod direct;
mod field;
mod lanes;
mod lsp;
mod normal;
mod paper;
mod window;
mod write;

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::layout::{
    LENGTHS_MM, MAX_BASE_MATERIALS, MAX_SAMPLES, MAX_SINGLE_BASE_MATERIALS, MODELS_BMPP,
};
use subsurf_decoder::bssrdf::{Coding, Header};

use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::progress::Progress;
use direct::Model;
use field::Field;
use normal::Normal;
use window::Geometry;
pub use write::{mixtures, profiles, write_file};

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A profile for every pixel (Song et al. 2009): large, and the best that any of the others can do.
    Lsp,
    /// k-means clusters of the per-pixel profiles, one per pixel: a baseline for K-BMPP.
    Clusters,
    /// K base materials per pixel by alternation of exact steps.
    Direct,
    /// K base materials per pixel as Yatagawa et al. 2020 fit them: a baseline.
    Paper,
}

/// What to fit.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// How.
    pub method: Method,
    /// K, 1, 2, 3 or 5; clusters have 1 in any case.
    pub per_pixel: usize,
    /// M, 1 to 256; to 65,536 where K = 1.
    pub base_materials: usize,
    /// S, the nodes of a profile; `None` takes R + 1.
    pub samples: Option<usize>,
    /// Seed of the first cluster centres.
    pub seed: u64,
    /// How mixtures are stored: [`Coding::Exact`] but for K = 2.
    pub coding: Coding,
    /// Whether base profiles are stored as half floats.
    pub half_profiles: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Direct,
            per_pixel: 2,
            base_materials: 128,
            samples: None,
            seed: 1,
            coding: Coding::Exact,
            half_profiles: false,
        }
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
    /// ½ Σ φ (P̂_i + P̂_j − 2 ln Rd)² over all of these (Yatagawa et al. 2020, eq. 5), before profiles are rounded to
    /// half floats.
    pub cost: f64,
    /// K of the file; 0 for per-pixel profiles.
    pub per_pixel: usize,
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
    let header = header(capture, &geometry, options);
    let (sections, cost) = match options.method {
        Method::Lsp => {
            let profiles = lsp::fit(&normal, progress);
            (vec![local_profiles(&normal, &profiles)], normal.cost(&profiles))
        }
        Method::Paper => {
            let model = paper::fit(&normal, options.per_pixel, options.base_materials, options.seed, progress);
            of_bases(&header, &normal, &model, options.half_profiles)
        }
        Method::Clusters | Method::Direct => {
            let profiles = lsp::fit(&normal, progress);
            let clusters = cluster::cluster(&normal, &profiles, options.base_materials, options.seed, progress);
            drop(profiles);
            let mut model = Model::of_clusters(clusters, geometry.nodes);
            if options.method == Method::Direct {
                direct::refine(&normal, &mut model, options.per_pixel, options.coding, progress);
            }
            model.pad(options.base_materials);
            of_bases(&header, &normal, &model, options.half_profiles)
        }
    };
    Ok(Encoded {
        bytes: write_file(&header, &sections),
        entries: normal.entries[0],
        measured: normal.entries[1],
        cost,
        per_pixel: header.model.into(),
        base_materials: header.base_materials as usize,
        samples: geometry.nodes,
    })
}

/// Sections and cost of a model.
fn of_bases(header: &Header, normal: &Normal, model: &Model, half_profiles: bool) -> (Vec<(Section, Vec<u8>)>, f64) {
    let mut sections = vec![write::profiles(base_profiles(normal, model), half_profiles)];
    sections.extend(write::mixtures(header, &model.mixtures));
    (sections, normal.cost(&model.field(normal)))
}

/// K of the file; 0 for per-pixel profiles.
fn per_pixel(options: &Options) -> usize {
    match options.method {
        Method::Lsp => 0,
        Method::Clusters => 1,
        Method::Direct | Method::Paper => options.per_pixel,
    }
}

fn geometry(capture: &Capture, options: &Options) -> Result<Geometry> {
    let per_pixel = per_pixel(options);
    if matches!(options.method, Method::Direct | Method::Paper) && !MODELS_BMPP.map(usize::from).contains(&per_pixel) {
        return Err(Error::Request(format!("{per_pixel} base materials per pixel; there can be 1, 2, 3 or 5")));
    }
    if options.coding != Coding::Exact && (per_pixel != 2 || options.method != Method::Direct) {
        let message = "smaller ratios and palettes are for two base materials per pixel, fitted by the direct method";
        return Err(Error::Request(message.to_owned()));
    }
    if options.half_profiles && per_pixel == 0 {
        return Err(Error::Request("profiles of every pixel are stored in single precision only".to_owned()));
    }
    let limit = if per_pixel == 1 { MAX_SINGLE_BASE_MATERIALS } else { MAX_BASE_MATERIALS } as usize;
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

fn header(capture: &Capture, geometry: &Geometry, options: &Options) -> Header {
    let per_pixel = per_pixel(options);
    let bases = if per_pixel == 0 { 0 } else { options.base_materials };
    let small = |n: usize| u32::try_from(n).expect("checked when the capture was opened");
    let smaller = |n: usize| u16::try_from(n).expect("checked when the capture was opened");
    #[allow(clippy::cast_possible_truncation, reason = "a radius in pixels")]
    let r_max_px = geometry.r_max_px as f32;
    Header {
        model: u8::try_from(per_pixel).expect("at most 5"),
        coding: options.coding,
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
fn local_profiles(normal: &Normal, profiles: &Field) -> (Section, Vec<u8>) {
    let planes = (0..normal.geometry.nodes).flat_map(|h| (0..3).map(move |c| (h, c)));
    let values = planes.flat_map(|(h, c)| {
        let mean = normal.mean[h][c];
        (0..normal.geometry.pixels()).map(move |pixel| profiles.at(pixel)[h][c] + mean)
    });
    (Section::LocalProfiles, write::logs(values))
}

/// P̂_b^h of all base materials.
fn base_profiles(normal: &Normal, model: &Model) -> impl Iterator<Item = f32> {
    let mean = normal.mean.iter().cycle();
    model.bases.iter().zip(mean).flat_map(|(p, mean)| [0, 1, 2].map(|c| p[c] + mean[c]))
}
