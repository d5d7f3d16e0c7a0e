//! Bytes on the device, by our own count: GLES drivers do not tell.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts the bytes of all textures and buffers that are alive.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<AtomicU64>);

impl Ledger {
    /// Bytes that are in use now: format × extent of textures, length of buffers; alignment of the driver not included.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// Enters a resource; it leaves the ledger when it is dropped.
    pub(crate) fn enter<T>(&self, resource: T, bytes: u64) -> Tracked<T> {
        self.0.fetch_add(bytes, Ordering::Relaxed);
        Tracked { resource, bytes, ledger: self.clone() }
    }
}

/// A resource that the ledger knows.
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
