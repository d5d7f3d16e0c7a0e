//! What a step of a load does: data, so that a load may go to any thread.

use std::sync::Arc;

use subsurf_shaders::MaterialLayout;

use super::projection::{Projection, levels_pass, sums_pass};
#[cfg(feature = "transfer")]
use crate::asset::TransferMaterial;
use crate::asset::{BssrdfPlanes, PatchLayers, SeparableMaterial, SplatMaterial};
use crate::error::Result;
use crate::gpu::{Fill, Gpu, Surface2d};
use crate::technique::PatchCascade;

/// Kind of work that a step of a load does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadPhase {
    /// Bytes of the file, handed to the device.
    Upload,
    /// Pipelines of the projection, compiled once for each device and layout.
    Pipelines,
    /// Coefficients and albedo over the patch, drawn from the planes of the file; of a transfer, weights between its lights.
    Projection,
}

/// Work of a step.
pub(super) enum Work<'a> {
    /// Writes pieces of textures.
    Write(Vec<Fill<'a>>),
    /// Compiles the pass of so many sums over profiles.
    CompileSums(MaterialLayout, usize),
    /// Compiles the passes of an albedo by a basis of so many terms.
    CompileAlbedo(usize),
    /// Compiles the pass of mipmap levels of so many layers.
    CompileLevels(usize),
    /// Draws coefficients and albedo of a basis.
    ProjectBasis { planes: BssrdfPlanes, table: Surface2d, to: Arc<SeparableMaterial> },
    /// Draws an albedo by sums over profiles.
    ProjectAlbedo { table: Surface2d, to: Arc<SplatMaterial> },
    /// Draws an albedo by a basis, which goes then.
    ProjectAlbedoByBasis { table: Surface2d, basis: Box<SeparableMaterial>, to: Arc<SplatMaterial> },
    /// Solves for weights between the lights.
    #[cfg(feature = "transfer")]
    PrepareTransfer(Arc<TransferMaterial>),
}

impl Work<'_> {
    /// Phase that it is a part of.
    pub(super) fn phase(&self) -> LoadPhase {
        match self {
            Self::Write(_) => LoadPhase::Upload,
            Self::CompileSums(..) | Self::CompileAlbedo(_) | Self::CompileLevels(_) => LoadPhase::Pipelines,
            Self::ProjectBasis { .. } | Self::ProjectAlbedo { .. } | Self::ProjectAlbedoByBasis { .. } => {
                LoadPhase::Projection
            }
            #[cfg(feature = "transfer")]
            Self::PrepareTransfer(_) => LoadPhase::Projection,
        }
    }

    /// Does it.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the device fails; [`Error::Usage`](crate::Error::Usage) if lights of a transfer are
    /// too close to each other.
    pub(super) fn run(self, gpu: &Gpu) -> Result<()> {
        match self {
            Self::Write(fills) => fills.iter().try_for_each(|fill| fill.write(gpu)),
            Self::CompileSums(layout, count) => sums_pass(gpu, layout, count).map(|_| ()),
            Self::CompileAlbedo(terms) => PatchCascade::new(gpu, terms).map(|_| ()),
            Self::CompileLevels(layers) => levels_pass(gpu, layers).map(|_| ()),
            Self::ProjectBasis { planes, table, to } => project(gpu, &to.layers, |projection| {
                projection.basis((&planes, &table), &to, (&to.layers, to.layers.count - 1))
            }),
            Self::ProjectAlbedo { table, to } => {
                project(gpu, &to.albedo, |projection| projection.layers((&to.planes, &table), &to.albedo))
            }
            Self::ProjectAlbedoByBasis { table, basis, to } => {
                project(gpu, &to.albedo, |projection| projection.basis((&to.planes, &table), &basis, (&to.albedo, 0)))
            }
            #[cfg(feature = "transfer")]
            Self::PrepareTransfer(to) => to.prepare(),
        }
    }
}

/// Draws layers and their mipmap levels.
fn project(gpu: &Gpu, layers: &PatchLayers, draw: impl FnOnce(&mut Projection<'_>) -> Result<()>) -> Result<()> {
    let mut projection = Projection::new(gpu);
    draw(&mut projection)?;
    projection.levels(layers)?;
    projection.submit()
}
