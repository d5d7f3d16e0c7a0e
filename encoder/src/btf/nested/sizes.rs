//! Sizes of nested codebooks.

use subsurf_decoder::btf::nested::layout::MAX_STAGES;

use crate::error::{Error, Result};
use crate::rate::Candidate;

/// Refuses numbers of stages that no file has.
pub(crate) fn check_stages(stages: usize) -> Result<()> {
    match stages {
        1..=MAX_STAGES => Ok(()),
        _ => Err(Error::Request(format!("{stages} stages of codebooks; 1 to {MAX_STAGES} are possible"))),
    }
}

/// Most entries of the codebooks of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Entries of P4: whole apparent BRDFs, 4-D.
    pub p4: usize,
    /// Entries of P3: slices at an azimuth of the view, 3-D.
    pub p3: usize,
    /// Entries of P2: slices at a view, 2-D.
    pub p2: usize,
    /// Entries of P1: slices along β, 1-D.
    pub p1: usize,
}

/// Codebooks of all stages by two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// Entries of P4, at least 1.
    pub p4: usize,
    /// Stages, 1 to 4.
    pub stages: usize,
}

impl Extent {
    /// Extent where nothing is asked for.
    pub const USUAL: Self = Self::of(512, 1);
    /// By the bytes they take. What gains more, larger codebooks or a second stage, depends on the material: smooth ones
    /// take to stages.
    pub const LADDER: [Self; 12] = [
        Self::of(64, 1),
        Self::of(128, 1),
        Self::of(128, 2),
        Self::of(256, 1),
        Self::of(256, 2),
        Self::of(512, 1),
        Self::of(512, 2),
        Self::of(1024, 1),
        Self::of(1024, 2),
        Self::of(2048, 1),
        Self::of(2048, 2),
        Self::of(4096, 1),
    ];

    const fn of(p4: usize, stages: usize) -> Self {
        Self { p4, stages }
    }

    /// Entries of the codebooks of every stage.
    #[must_use]
    pub fn sizes(self) -> Vec<Sizes> {
        let p4 = self.p4;
        vec![Sizes { p4, p3: 2 * p4, p2: 2 * p4, p1: (2 * p4).min(512) }; self.stages]
    }
}

impl Candidate for Extent {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "thousands, not negative"
    )]
    fn between(&self, next: &Self, part: f64) -> Option<Self> {
        let p4 = (self.p4 as f64 + part * (next.p4 as f64 - self.p4 as f64)) as usize;
        let is_new = self.stages == next.stages && p4 > self.p4 && p4 < next.p4;
        is_new.then_some(Self { p4, ..*self })
    }
}
