//! Options of a fit, and whether a file can hold what they ask for.

use subsurf_decoder::bssrdf::layout::{
    LENGTHS_MM, MAX_BASE_MATERIALS, MAX_SAMPLES, MAX_SINGLE_BASE_MATERIALS, MODELS_BMPP,
};
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};

use crate::bssrdf::window::Geometry;
use crate::capture::Capture;
use crate::error::{Error, Result};

/// Method of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A profile for every pixel (Song et al. 2009): large, and the lowest cost of eq. 5 that there is.
    Song2009,
    /// k-means clusters of the per-pixel profiles, one per pixel: a baseline for K-BMPP.
    Clusters,
    /// K base materials per pixel by alternation of exact steps.
    Direct,
    /// K base materials per pixel as Yatagawa et al. 2020 fit them: a baseline.
    Yatagawa2020,
}

/// Options of a fit.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Method.
    pub method: Method,
    /// Base materials per pixel, K: 1, 2, 3 or 5; clusters have 1 in any case.
    pub per_pixel: usize,
    /// Base materials, M: 1 to 256; to 65,536 where K = 1.
    pub base_materials: usize,
    /// Seed of the first cluster centres.
    pub seed: u64,
    /// Coding of mixtures: [`Coding::Exact`] but for K = 2.
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
            seed: 1,
            coding: Coding::Exact,
            half_profiles: false,
        }
    }
}

impl Options {
    /// K of the file; 0 for per-pixel profiles.
    pub(crate) fn model(&self) -> usize {
        match self.method {
            Method::Song2009 => 0,
            Method::Clusters => 1,
            Method::Direct | Method::Yatagawa2020 => self.per_pixel,
        }
    }

    /// The largest M that a file of this K holds.
    pub(crate) fn most_base_materials(&self) -> usize {
        if self.model() == 1 { MAX_SINGLE_BASE_MATERIALS as usize } else { MAX_BASE_MATERIALS as usize }
    }

    /// Whether a file can hold what is asked for.
    pub(crate) fn check(&self) -> Result<()> {
        let model = self.model();
        let refuse = |message: String| Err(Error::Request(message));
        if matches!(self.method, Method::Direct | Method::Yatagawa2020)
            && !MODELS_BMPP.map(usize::from).contains(&model)
        {
            return refuse(format!("{model} base materials per pixel; there can be 1, 2, 3 or 5"));
        }
        if self.coding != Coding::Exact && (model != 2 || self.method != Method::Direct) {
            let message =
                "smaller ratios and palettes are for two base materials per pixel, fitted by the direct method";
            return refuse(message.to_owned());
        }
        if self.half_profiles && model == 0 {
            return refuse("profiles of every pixel are stored in single precision only".to_owned());
        }
        let limit = self.most_base_materials();
        if !(1..=limit).contains(&self.base_materials) {
            return refuse(format!("{} base materials; a file holds 1 to {limit}", self.base_materials));
        }
        Ok(())
    }

    /// The header of the file, base materials as asked for.
    pub(crate) fn header(&self, capture: &Capture, geometry: &Geometry) -> BssrdfHeader {
        let model = self.model();
        let bases = if model == 0 { 0 } else { self.base_materials };
        let small = |n: usize| u32::try_from(n).expect("checked when the capture was opened");
        let smaller = |n: usize| u16::try_from(n).expect("checked when the capture was opened");
        #[allow(clippy::cast_possible_truncation, reason = "a radius in pixels")]
        let r_max_px = geometry.r_max_px as f32;
        BssrdfHeader {
            model: u8::try_from(model).expect("at most 5"),
            coding: self.coding,
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
}

/// The radius of the last node lies a hair beyond the window's corner, so that rounding does not cut the corner off.
const BEYOND_CORNER: f64 = 1.0 + 1e-6;

/// Pixels and nodes of a capture, with S = R + 1 nodes if `samples` does not say otherwise.
pub(crate) fn geometry(capture: &Capture, samples: Option<usize>) -> Result<Geometry> {
    let nodes = samples.unwrap_or((capture.radius() + 1).max(2));
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
