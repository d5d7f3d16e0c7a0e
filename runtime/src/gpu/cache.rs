//! Pipelines that were compiled and are kept.

use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{BindGroupLayout, RenderPipeline, TextureFormat};

use crate::error::Result;

/// Render pipeline, and the layouts of its bind groups.
#[derive(Debug)]
pub(crate) struct Pipeline {
    /// Name of the pass.
    pub(crate) name: &'static str,
    pub(super) pipeline: RenderPipeline,
    pub(super) groups: Vec<BindGroupLayout>,
}

/// Pipelines of full-screen passes by name and targets, kept as long as their device: loads share them.
#[derive(Debug, Default)]
pub(super) struct PipelineCache(Mutex<Vec<Compiled>>);

/// Name and targets of a pass, and its pipeline.
type Compiled = (String, Vec<TextureFormat>, Arc<Pipeline>);

impl PipelineCache {
    /// Pipeline of a pass, compiled at the first call.
    ///
    /// # Errors
    /// As `compile`.
    pub(super) fn get_or(
        &self,
        name: String,
        targets: &[TextureFormat],
        compile: impl FnOnce() -> Result<Pipeline>,
    ) -> Result<Arc<Pipeline>> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found =
            lock().iter().find(|(of, to, _)| *of == name && to == targets).map(|(.., pipeline)| pipeline.clone());
        if let Some(pipeline) = found {
            return Ok(pipeline);
        }
        // Not while others wait for the list: the thread that draws may be one of them.
        let pipeline = Arc::new(compile()?);
        lock().push((name, targets.to_vec(), pipeline.clone()));
        Ok(pipeline)
    }
}
