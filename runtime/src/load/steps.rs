//! Loading in steps: from a file to what is on the device, with the share that is done after each.

use std::collections::VecDeque;

use super::work::{LoadPhase, Work};
use crate::asset::Material;
use crate::error::{Error, Result};
use crate::gpu::{Fill, Gpu, PIECE_BYTES};

/// Load of a material in steps, each of which takes about as long as a part of a frame and never waits for the device; on any
/// thread.
///
/// A host calls [`Load::step`] until it gives 1, shows the share in between, or drops the load to stop it; [`Load::finish`] does
/// what is left. What it has uploaded and computed until then goes with it.
///
/// ```no_run
/// # fn load(gpu: &subsurf_runtime::Gpu, bytes: &[u8]) -> subsurf_runtime::Result<subsurf_runtime::Material> {
/// let file = subsurf_decoder::File::parse(bytes)?;
/// let mut load = subsurf_runtime::Load::new(gpu, &file)?;
/// while load.step()? < 1.0 {
///     // Show the share, or leave.
/// }
/// load.finish()
/// # }
/// ```
pub struct Load<'a, M = Material> {
    gpu: &'a Gpu,
    /// The material, whole once there are no steps left; none after a step that failed.
    made: Option<M>,
    steps: VecDeque<Work<'a>>,
    /// Number of steps from the beginning on.
    all: usize,
}

impl<'a, M> Load<'a, M> {
    /// Load of what is made already but for its contents.
    pub(super) fn of(gpu: &'a Gpu, made: M) -> Self {
        Self { gpu, made: Some(made), steps: VecDeque::new(), all: 0 }
    }

    /// Adds a step.
    pub(super) fn then(mut self, work: Work<'a>) -> Self {
        self.steps.push_back(work);
        self.all += 1;
        self
    }

    /// Adds pieces to upload; small ones go together.
    pub(super) fn filled(self, fills: impl IntoIterator<Item = Fill<'a>>) -> Self {
        let mut steps: Vec<(usize, Vec<Fill<'a>>)> = Vec::new();
        for fill in fills {
            match steps.last_mut() {
                Some((bytes, together)) if *bytes + fill.bytes() <= PIECE_BYTES => {
                    *bytes += fill.bytes();
                    together.push(fill);
                }
                _ => steps.push((fill.bytes(), vec![fill])),
            }
        }
        steps.into_iter().fold(self, |load, (_, together)| load.then(Work::Write(together)))
    }

    /// Load of what `make` makes of the material.
    pub fn map<N>(self, make: impl FnOnce(M) -> N) -> Load<'a, N> {
        Load { gpu: self.gpu, made: self.made.map(make), steps: self.steps, all: self.all }
    }

    /// Device that it loads onto.
    pub(super) fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// What the next step does; none if there is none.
    #[must_use]
    pub fn phase(&self) -> Option<LoadPhase> {
        self.steps.front().map(Work::phase)
    }

    /// Share of the steps that are done, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        #[allow(clippy::cast_precision_loss, reason = "a share for people")]
        let left = self.steps.len() as f32 / self.all.max(1) as f32;
        1.0 - left
    }

    /// Does the next step, and gives the share that is done then: 1 after the last.
    ///
    /// # Errors
    /// [`Error::Device`] if the device fails or is lost; the load is over then.
    pub fn step(&mut self) -> Result<f32> {
        if let Some(work) = self.steps.pop_front() {
            work.run(self.gpu).and_then(|()| self.gpu.expect_alive()).inspect_err(|_| {
                self.made = None;
                self.steps.clear();
            })?;
        }
        Ok(self.share())
    }

    /// Does what is left, and gives the material. The device may still be at work on it; what is drawn with it waits.
    ///
    /// # Errors
    /// As [`Load::step`]; [`Error::Usage`] after a step that failed.
    pub fn finish(mut self) -> Result<M> {
        while !self.steps.is_empty() {
            self.step()?;
        }
        self.made.ok_or_else(|| Error::Usage("a step of this load has failed: begin another one".to_owned()))
    }
}
