//! What a step of a load does: data, so that a load may go to any thread.

use std::sync::Arc;

use subsurf_shaders::MaterialLayout;

use super::projection::{Projection, levels_pass, sums_pass};
#[cfg(feature = "transfer")]
use crate::asset::TransferMaterial;
use crate::asset::{BssrdfPlanes, SeparableMaterial, SplatMaterial};
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
            Self::ProjectBasis { planes, table, to } => {
                let mut projection = Projection::new(gpu);
                projection.basis((&planes, &table), &to, (&to.layers, to.layers.count - 1))?;
                projection.levels(&to.layers)?;
                projection.submit()
            }
            Self::ProjectAlbedo { table, to } => {
                let mut projection = Projection::new(gpu);
                projection.layers((&to.planes, &table), &to.albedo)?;
                projection.levels(&to.albedo)?;
                projection.submit()
            }
            Self::ProjectAlbedoByBasis { table, basis, to } => {
                let mut projection = Projection::new(gpu);
                projection.basis((&to.planes, &table), &basis, (&to.albedo, 0))?;
                projection.levels(&to.albedo)?;
                projection.submit()
            }
            #[cfg(feature = "transfer")]
            Self::PrepareTransfer(to) => to.prepare(),
        }
    }
}
