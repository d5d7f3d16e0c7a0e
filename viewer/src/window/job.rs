//! Jobs: what is to be known of material and mesh is computed on a thread of its own, and the window goes on.

use std::sync::Arc;

use glam::Vec3;
use subsurf_decoder::Kernel;
use subsurf_runtime::{BtfMaterial, Gpu};
use subsurf_scene::{AmbientTransfer, Mesh, Scene};

use super::artist::{Artist, MakeKernel};
use super::assets::MaterialFile;
use super::config::LoadImages;
use crate::asset::{
    Asset, BtfImageSet, GpuAsset, MappingChoice, Scattering, choose_mapping, expect_uvs, repeats, upload_images,
};
use crate::error::{Error, Result};
use crate::file::DrawnMaterial;

/// Way in which a material is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RenderMode {
    /// By a technique, if it is translucent.
    Scattering(Scattering),
    /// From its file, if it is a BTF.
    Btf,
    /// From the images that the BTF was made from.
    Images,
    /// By its separable kernel, or by one that is made of the panel's numbers.
    Kernel(Option<Artist>),
    /// From what is precomputed for the mesh.
    Transfer,
}

/// Identity of a picture: what it is of, and how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) material: usize,
    pub(super) mesh: u32,
    pub(super) mode: RenderMode,
    /// The light from which vertices are shaded, where a path knows it beforehand.
    pub(super) light: Option<Vec3>,
}

impl Key {
    /// Whether light from all around is the same for both.
    fn shares_sky(&self, other: &Self) -> bool {
        (self.material, self.mesh) == (other.material, other.mesh)
    }

    /// Whether both are kernels of the same material that are made of the panel's numbers.
    fn are_edits(&self, other: &Self) -> bool {
        let is_edit = |key: &Self| matches!(key.mode, RenderMode::Kernel(Some(_)));
        self.shares_sky(other) && is_edit(self) && is_edit(other)
    }
}

/// Work to do before a picture can be drawn.
pub(super) struct Job {
    pub(super) key: Key,
    pub(super) material: Arc<MaterialFile>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) mapping: MappingChoice,
    /// Copies of a BTF along u and v, if they were asked for.
    pub(super) repeats: Option<[f32; 2]>,
    pub(super) images: Option<Arc<LoadImages>>,
    pub(super) make_kernel: Option<Arc<MakeKernel>>,
    pub(super) scene: Scene,
}

/// What a job computes: all that takes long and needs no device.
pub(super) enum Computed {
    Scattering(Box<Asset>),
    Btf {
        repeats: [f32; 2],
    },
    /// File of the kernel, if it is not that of the material.
    Kernel {
        made: Option<Vec<u8>>,
        sky: Vec<AmbientTransfer>,
    },
    Transfer,
    Images {
        repeats: [f32; 2],
        images: Box<dyn BtfImageSet>,
    },
}

impl Computed {
    /// Brings everything to a device.
    pub(super) fn upload(&self, gpu: &Gpu, file: &MaterialFile, mesh: &Mesh) -> Result<GpuAsset> {
        match (self, file.read()?) {
            (Self::Scattering(asset), DrawnMaterial::Bssrdf(material)) => asset.upload(gpu, &material, mesh),
            (Self::Btf { repeats }, DrawnMaterial::Btf(btf)) => {
                GpuAsset::btf(gpu, mesh, *repeats, BtfMaterial::upload(gpu, &btf)?, file.number())
            }
            (Self::Kernel { made: Some(made), sky }, _) => GpuAsset::kernel(gpu, mesh, &parse_kernel(made)?, sky),
            (Self::Kernel { made: None, sky }, DrawnMaterial::Kernel(kernel)) => {
                GpuAsset::kernel(gpu, mesh, &kernel, sky)
            }
            (Self::Transfer, DrawnMaterial::Transfer(transfer)) => GpuAsset::transfer(gpu, mesh, &transfer),
            (Self::Images { repeats, images }, _) => {
                GpuAsset::btf(gpu, mesh, *repeats, upload_images(gpu, images.as_ref())?, 0)
            }
            _ => Err(Error::Request(format!("{}: the file is of another kind than it was", file.name()))),
        }
    }

    /// Light from all around, where it was computed.
    fn sky(&self) -> Option<&Arc<Vec<AmbientTransfer>>> {
        match self {
            Self::Scattering(asset) => asset.sky(),
            Self::Btf { .. } | Self::Images { .. } | Self::Kernel { .. } | Self::Transfer => None,
        }
    }
}

impl Job {
    fn compute(&self, sky: Option<Arc<Vec<AmbientTransfer>>>) -> Result<Computed> {
        match (self.material.read()?, self.key.mode) {
            (DrawnMaterial::Bssrdf(material), RenderMode::Scattering(technique)) => {
                let mapping = choose_mapping(&self.mesh, self.mapping, &material)?;
                let asset = Asset::compute(&material, &self.mesh, mapping, &self.scene, technique, sky)?;
                Ok(Computed::Scattering(Box::new(asset)))
            }
            (DrawnMaterial::Btf(btf), mode) => {
                expect_uvs(&self.mesh)?;
                let size = btf.materials().nth(self.material.number()).map_or([1; 2], |material| material.size(0));
                let repeats = self.repeats.unwrap_or_else(|| repeats(&self.mesh, size));
                match (&self.images, mode) {
                    (Some(load), RenderMode::Images) => Ok(Computed::Images { repeats, images: load()? }),
                    _ => Ok(Computed::Btf { repeats }),
                }
            }
            (DrawnMaterial::Kernel(kernel), RenderMode::Kernel(artist)) => {
                let made = match (artist, &self.make_kernel) {
                    (Some(artist), Some(make)) => Some(make(&artist)?),
                    _ => None,
                };
                let kernel = made.as_deref().map_or(Ok(kernel), parse_kernel)?;
                let sky = AmbientTransfer::of_kernel(&self.mesh, &kernel)?;
                Ok(Computed::Kernel { made, sky })
            }
            (DrawnMaterial::Transfer(_), RenderMode::Transfer) => Ok(Computed::Transfer),
            (DrawnMaterial::Bssrdf(_) | DrawnMaterial::Kernel(_) | DrawnMaterial::Transfer(_), mode) => {
                Err(Error::Request(format!("{} is not drawn in the way {mode:?}", self.material.name())))
            }
        }
    }
}

fn parse_kernel(file: &[u8]) -> Result<Kernel<'_>> {
    Ok(Kernel::parse(file).map_err(subsurf_runtime::Error::from)?)
}

/// Outcome of a job.
pub(super) struct JobResult {
    key: Key,
    result: Result<Computed>,
}

/// Queue of one: does a job at a time, and caches what was wanted last.
pub(super) struct JobQueue {
    /// Hands a result to the window's thread.
    send: Arc<dyn Fn(JobResult) + Send + Sync>,
    pending: Option<Key>,
    cache: Vec<(Key, Arc<Computed>)>,
}

/// Results in the cache at most: all techniques of two materials.
const CACHED: usize = 8;

impl JobQueue {
    /// `send` is called on another thread.
    pub(super) fn new(send: Arc<dyn Fn(JobResult) + Send + Sync>) -> Self {
        Self { send, pending: None, cache: Vec::new() }
    }

    /// Key of the job that is being done.
    pub(super) fn pending(&self) -> Option<&Key> {
        self.pending.as_ref()
    }

    /// Result in the cache.
    pub(super) fn find(&self, key: &Key) -> Option<Arc<Computed>> {
        self.cache.iter().find(|(cached, _)| cached == key).map(|(_, computed)| computed.clone())
    }

    /// Kernel that was made of other numbers for the same material, where `key` is of one: to be shown until that is there.
    pub(super) fn find_edit(&self, key: &Key) -> Option<(Key, Arc<Computed>)> {
        self.cache
            .iter()
            .find(|(cached, _)| cached.are_edits(key))
            .map(|(cached, computed)| (*cached, computed.clone()))
    }

    /// Starts a job, unless there is one to wait for.
    pub(super) fn start(&mut self, job: Job) {
        if self.pending.is_some() {
            return;
        }
        self.pending = Some(job.key);
        let alike = self.cache.iter().filter(|(key, _)| key.shares_sky(&job.key));
        let sky = alike.map(|(_, computed)| computed.sky()).find_map(|sky| sky.cloned());
        let send = self.send.clone();
        std::thread::spawn(move || send(JobResult { key: job.key, result: job.compute(sky) }));
    }

    /// Takes a result in; fails with the key of a job that failed.
    pub(super) fn receive(&mut self, of: JobResult) -> std::result::Result<(), Box<(Key, Error)>> {
        self.pending = None;
        let computed = of.result.map_err(|error| Box::new((of.key, error)))?;
        // Other meshes never come back. Points under another light hardly ever do, and are large; nor do numbers of a kernel.
        let is_gather = |key: &Key| key.mode == RenderMode::Scattering(Scattering::Gather);
        let replaces = |key: &Key| (is_gather(&of.key) && is_gather(key)) || of.key.are_edits(key);
        self.cache.retain(|(key, _)| key.mesh == of.key.mesh && !replaces(key));
        if self.cache.len() == CACHED {
            self.cache.remove(0);
        }
        self.cache.push((of.key, Arc::new(computed)));
        Ok(())
    }
}
