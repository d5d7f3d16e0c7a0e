//! Ledger of the bytes on the device: GLES drivers do not tell how many are in use.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What bytes on the device are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Tables and blocks of materials.
    Material,
    /// Vertices, triangles, and points of a surface for the gather.
    Mesh,
    /// What lights see.
    LightView,
    /// Maps and blocks of frames and of flat patches, and what they reflect.
    Frame,
    /// Pictures that are drawn to, and what is on its way to or from the device.
    Other,
}

impl Purpose {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Material, Self::Mesh, Self::LightView, Self::Frame, Self::Other];
}

impl fmt::Display for Purpose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Material => "material",
            Self::Mesh => "mesh",
            Self::LightView => "light view",
            Self::Frame => "frame",
            Self::Other => "other",
        })
    }
}

/// Sums of the bytes of all textures and buffers that are alive, by their purpose; copies share the sums.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<[AtomicU64; Purpose::ALL.len()]>);

impl Ledger {
    /// Bytes in use now: texel size × extent of textures, length of buffers. What drivers add for alignment is not known.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        Purpose::ALL.iter().map(|purpose| self.bytes_of(*purpose)).sum()
    }

    /// Bytes in use now for a purpose.
    #[must_use]
    pub fn bytes_of(&self, purpose: Purpose) -> u64 {
        self.0[purpose as usize].load(Ordering::Relaxed)
    }

    /// Enters a resource of so many bytes, which leave the sum when the resource is dropped.
    pub(crate) fn enter<T>(&self, purpose: Purpose, resource: T, bytes: u64) -> Tracked<T> {
        self.0[purpose as usize].fetch_add(bytes, Ordering::Relaxed);
        Tracked { resource, purpose, bytes, ledger: self.clone() }
    }
}

/// Resource whose bytes are in the ledger as long as it lives.
#[derive(Debug)]
pub(crate) struct Tracked<T> {
    resource: T,
    purpose: Purpose,
    bytes: u64,
    ledger: Ledger,
}

impl<T> Tracked<T> {
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl<T> Deref for Tracked<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.resource
    }
}

impl<T> Drop for Tracked<T> {
    fn drop(&mut self) {
        self.ledger.0[self.purpose as usize].fetch_sub(self.bytes, Ordering::Relaxed);
    }
}
