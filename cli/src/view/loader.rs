//! Computes what is to be known of material and mesh, on a thread of its own: the window goes on.

use std::sync::Arc;

use glam::Vec3;
use subsurf_encoder::capture::Images;
use subsurf_runtime::scene::{Mesh, Scene, SkyShare};
use subsurf_runtime::{BtfMaterial, Gpu};
use winit::event_loop::EventLoopProxy;

use super::Notice;
use super::subject::MaterialFile;
use crate::info::Parsed;
use crate::render::{
    BtfArgs, Ingredients, MappingArg, PathArg, Prepared, choose_mapping, expect_uvs, prepare_btf, read_images,
    upload_images,
};

/// How a material is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// A translucent one, by one of the paths.
    Path(PathArg),
    /// A BTF.
    Btf,
    /// The images that it was made from.
    Images,
}

/// What a picture is of, and how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) material: usize,
    pub(super) mesh: u32,
    pub(super) way: Way,
    /// The light from which vertices are shaded, where a path knows it beforehand.
    pub(super) light: Option<Vec3>,
}

impl Key {
    /// Whether light from all around is the same for both.
    fn shares_sky(&self, other: &Self) -> bool {
        (self.material, self.mesh) == (other.material, other.mesh)
    }
}

/// What is to be computed.
pub(super) struct Order {
    pub(super) key: Key,
    pub(super) material: Arc<MaterialFile>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) mapping: MappingArg,
    pub(super) btf: Arc<BtfArgs>,
    pub(super) scene: Scene,
}

/// What takes long and needs no device.
pub(super) enum Computed {
    Scattering(Ingredients),
    Btf { copies: [f32; 2] },
    Images { copies: [f32; 2], images: Images },
}

impl Computed {
    /// Brings everything to a device.
    pub(super) fn upload(&self, gpu: &Gpu, file: &MaterialFile, mesh: &Mesh) -> anyhow::Result<Prepared> {
        match (self, file.read()?) {
            (Self::Scattering(ingredients), Parsed::Bssrdf(material)) => ingredients.upload(gpu, &material, mesh),
            (Self::Btf { copies }, Parsed::Btf(btf)) => {
                prepare_btf(gpu, mesh, *copies, BtfMaterial::upload(gpu, &btf)?, file.number())
            }
            (Self::Images { copies, images }, _) => prepare_btf(gpu, mesh, *copies, upload_images(gpu, images)?, 0),
            _ => Err(anyhow::anyhow!("{}: the file is of another kind than it was", file.name())),
        }
    }

    /// Light from all around, where it was computed.
    fn sky(&self) -> Option<&Arc<Vec<SkyShare>>> {
        match self {
            Self::Scattering(ingredients) => ingredients.sky(),
            Self::Btf { .. } | Self::Images { .. } => None,
        }
    }
}

impl Order {
    fn compute(&self, sky: Option<Arc<Vec<SkyShare>>>) -> anyhow::Result<Computed> {
        match (self.material.read()?, self.key.way) {
            (Parsed::Bssrdf(material), Way::Path(path)) => {
                let mapping = choose_mapping(&self.mesh, self.mapping, &material)?;
                let ingredients = Ingredients::compute(&material, &self.mesh, mapping, &self.scene, path, sky)?;
                Ok(Computed::Scattering(ingredients))
            }
            (Parsed::Btf(btf), way) => {
                expect_uvs(&self.mesh)?;
                let size = btf.materials().nth(self.material.number()).map_or([1; 2], |material| material.size(0));
                let copies = self.btf.copies(&self.mesh, size);
                match (&self.btf.images, way) {
                    (Some(folder), Way::Images) => Ok(Computed::Images { copies, images: read_images(folder)? }),
                    _ => Ok(Computed::Btf { copies }),
                }
            }
            (Parsed::Bssrdf(_), Way::Btf | Way::Images) => Err(anyhow::anyhow!("{} is no BTF", self.material.name())),
        }
    }
}

/// What came of an order.
pub(super) struct Answer {
    key: Key,
    result: anyhow::Result<Computed>,
}

/// Computes one order at a time, and keeps what was wanted last.
pub(super) struct Loader {
    proxy: EventLoopProxy<Notice>,
    pending: Option<Key>,
    kept: Vec<(Key, Arc<Computed>)>,
}

/// So many answers are kept: all paths of two materials.
const KEPT: usize = 8;

impl Loader {
    pub(super) fn new(proxy: EventLoopProxy<Notice>) -> Self {
        Self { proxy, pending: None, kept: Vec::new() }
    }

    /// What is being computed.
    pub(super) fn pending(&self) -> Option<&Key> {
        self.pending.as_ref()
    }

    /// What was computed already.
    pub(super) fn find(&self, key: &Key) -> Option<Arc<Computed>> {
        self.kept.iter().find(|(kept, _)| kept == key).map(|(_, computed)| computed.clone())
    }

    /// Starts to compute, unless there is something to wait for; a [`Notice::Computed`] will come.
    pub(super) fn start(&mut self, order: Order) {
        if self.pending.is_some() {
            return;
        }
        self.pending = Some(order.key);
        let sky = self.kept.iter().filter(|(key, _)| key.shares_sky(&order.key)).find_map(|(_, kept)| kept.sky());
        let (sky, proxy) = (sky.cloned(), self.proxy.clone());
        std::thread::spawn(move || {
            let answer = Answer { key: order.key, result: order.compute(sky) };
            // Where the window is closed by now, nobody wants it.
            let _ = proxy.send_event(Notice::Computed(answer));
        });
    }

    /// Takes an answer in; fails with the key where there is none.
    pub(super) fn receive(&mut self, answer: Answer) -> Result<(), (Key, anyhow::Error)> {
        self.pending = None;
        let computed = answer.result.map_err(|error| (answer.key, error))?;
        // Other meshes never come back. Points under another light hardly ever do, and are large.
        let is_gather = |key: &Key| key.way == Way::Path(PathArg::Gather);
        let replaces = |key: &Key| is_gather(&answer.key) && is_gather(key);
        self.kept.retain(|(key, _)| key.mesh == answer.key.mesh && !replaces(key));
        if self.kept.len() == KEPT {
            self.kept.remove(0);
        }
        self.kept.push((answer.key, Arc::new(computed)));
        Ok(())
    }
}
