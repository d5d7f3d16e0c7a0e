//! Ledger of the bytes on the device: GLES drivers do not tell how many are in use.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Sum of the bytes of all textures and buffers that are alive; copies share one sum.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<AtomicU64>);

impl Ledger {
    /// Bytes in use now: texel size × extent of textures, length of buffers. What drivers add for alignment is not known.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// Enters a resource of so many bytes, which leave the sum when the resource is dropped.
    pub(crate) fn enter<T>(&self, resource: T, bytes: u64) -> Tracked<T> {
        self.0.fetch_add(bytes, Ordering::Relaxed);
        Tracked { resource, bytes, ledger: self.clone() }
    }
}

/// Resource whose bytes are in the ledger as long as it lives.
#[derive(Debug)]
pub(crate) struct Tracked<T> {
    resource: T,
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
        self.ledger.0.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}
