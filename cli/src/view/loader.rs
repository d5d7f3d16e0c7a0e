//! Computes what a path wants to know of material and mesh, on a thread of its own: the window goes on.

use std::sync::Arc;

use glam::Vec3;
use subsurf_runtime::scene::{Mesh, Scene, SkyShare};
use winit::event_loop::EventLoopProxy;

use super::Notice;
use super::subject::MaterialFile;
use crate::render::{Ingredients, MappingArg, PathArg, choose_mapping};

/// What a picture is of, and how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) material: usize,
    pub(super) mesh: u32,
    pub(super) path: PathArg,
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
    pub(super) scene: Scene,
}

impl Order {
    fn compute(&self, sky: Option<Arc<Vec<SkyShare>>>) -> anyhow::Result<Ingredients> {
        let material = self.material.read()?;
        let mapping = choose_mapping(&self.mesh, self.mapping, &material)?;
        Ingredients::compute(&material, &self.mesh, mapping, &self.scene, self.key.path, sky)
    }
}

/// What came of an order.
pub(super) struct Answer {
    key: Key,
    result: anyhow::Result<Ingredients>,
}

/// Computes one order at a time, and keeps what was wanted last.
pub(super) struct Loader {
    proxy: EventLoopProxy<Notice>,
    pending: Option<Key>,
    kept: Vec<(Key, Arc<Ingredients>)>,
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
    pub(super) fn find(&self, key: &Key) -> Option<Arc<Ingredients>> {
        self.kept.iter().find(|(kept, _)| kept == key).map(|(_, ingredients)| ingredients.clone())
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
        let ingredients = answer.result.map_err(|error| (answer.key, error))?;
        // Other meshes never come back. Points under another light hardly ever do, and are large.
        let is_gather = |key: &Key| key.path == PathArg::Gather;
        let replaces = |key: &Key| is_gather(&answer.key) && is_gather(key);
        self.kept.retain(|(key, _)| key.mesh == answer.key.mesh && !replaces(key));
        if self.kept.len() == KEPT {
            self.kept.remove(0);
        }
        self.kept.push((answer.key, Arc::new(ingredients)));
        Ok(())
    }
}
