//! What a window shows to begin with.

use std::path::PathBuf;
use std::sync::Arc;

use subsurf_runtime::{Backend, BtfOptions, RuntimeOptions};
use subsurf_scene::{Environment, UpAxis};

use super::artist::MakeKernel;
use crate::asset::{BtfImageSet, MappingChoice, Scattering};
use crate::error::Result;
use crate::set::Set;

/// Reads the images that BTFs were made from. It is called on another thread, when they are to be shown.
pub type LoadImages = dyn Fn() -> Result<Box<dyn BtfImageSet>> + Send + Sync;

/// What a window shows to begin with, and how it draws.
pub struct Config {
    /// Material files; all materials of a BTF file are shown.
    pub files: Vec<PathBuf>,
    /// The one material of BTF files that is shown instead: its name, or its number from 0.
    pub material: Option<String>,
    /// Mesh: a file, or one of [`SHAPES`](subsurf_scene::SHAPES).
    pub mesh: PathBuf,
    /// Longest side of the mesh in mm.
    pub extent_mm: f32,
    /// Which way is up in mesh files.
    pub up: UpAxis,
    /// What stands around the mesh; where it has ground, files of meshes get it too.
    pub set: Set,
    /// Where translucent materials lie on the mesh.
    pub mapping: MappingChoice,
    /// How translucent materials are drawn.
    pub technique: Scattering,
    /// Whether ten times the difference to the reference is shown: the gather, or the images of a BTF.
    pub shows_error: bool,
    /// Copies of a BTF along u and v; so many that a copy is a fifth of the mesh if `None`.
    pub repeats: Option<[f32; 2]>,
    /// Images that BTFs are compared with.
    pub images: Option<Arc<LoadImages>>,
    /// What makes kernels of the numbers that the panel changes; without it there is nothing to change.
    pub make_kernel: Option<Arc<MakeKernel>>,
    /// Light from all around.
    pub environment: Environment,
    /// Width and height of the window in pixels.
    pub size: [u32; 2],
    /// Graphics APIs, of which the first that works draws.
    pub backends: Vec<Backend>,
    /// Choices of the renderer; the budget of bytes is shown in the panel.
    pub options: RuntimeOptions,
    /// Whether the window only opens for [`Host::capture`](crate::Host::capture): once it shows all that it should.
    pub captures: bool,
}

/// Choices of the renderer that suit a window: smooth edges, and few enough samples of the environment to turn a BTF.
#[must_use]
pub fn options() -> RuntimeOptions {
    const SAMPLES: u32 = 4;
    const BTF_SAMPLES: u32 = 4;
    let btf = BtfOptions { samples: BTF_SAMPLES, ..BtfOptions::default() };
    RuntimeOptions { samples: SAMPLES, btf, ..RuntimeOptions::default() }
}
