//! Vertices made of corners: one for each combination of what the corners of faces name.

use std::collections::HashMap;
use std::hash::Hash;

use super::raw::{Result, count};

/// Numbers of vertices, in the order in which their corners came first.
pub(super) struct Corners<K> {
    numbers: HashMap<K, u32>,
    count: usize,
}

impl<K: Eq + Hash + Copy> Corners<K> {
    pub(super) fn new() -> Self {
        Self { numbers: HashMap::new(), count: 0 }
    }

    /// Number of the vertex of a corner; `add` is called if it is a new one.
    pub(super) fn number(&mut self, corner: K, add: impl FnOnce()) -> Result<u32> {
        if let Some(number) = self.numbers.get(&corner) {
            return Ok(*number);
        }
        let number = count(self.count)?;
        self.numbers.insert(corner, number);
        self.count += 1;
        add();
        Ok(number)
    }

    /// From now on, all corners make new vertices.
    pub(super) fn forget(&mut self) {
        self.numbers.clear();
    }
}
