//! Modes 1 and 2: triangles and indices, as differences to what came before.

use super::{Reader, unzigzag};
use crate::read::raw::Result;

/// The last sixteen of what was pushed, the newest first.
struct Fifo<T> {
    items: [Option<T>; 16],
    next: usize,
}

impl<T: Copy> Fifo<T> {
    fn new() -> Self {
        Self { items: [None; 16], next: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.next] = Some(item);
        self.next = (self.next + 1) % 16;
    }

    fn get(&self, age: u8) -> Result<T> {
        let item = self.items[(self.next + 31 - usize::from(age & 15)) % 16];
        item.ok_or_else(|| "meshopt: names what has not come yet".to_owned())
    }
}

/// Triangles so far.
struct Decoder<'r, 'a> {
    data: &'r mut Reader<'a>,
    next: u32,
    last: u32,
    edges: Fifo<[u32; 2]>,
    vertices: Fifo<u32>,
}

/// Mode 1: `count` indices of triangles, by edges and vertices that came before.
pub(super) fn triangles(bytes: &mut Reader<'_>, count: usize) -> Result<Vec<u32>> {
    expect(bytes, 0xe1)?;
    let table = bytes.tail(16)?;
    let codes = bytes.take(count / 3)?;
    let mut decoder = Decoder { data: bytes, next: 0, last: 0, edges: Fifo::new(), vertices: Fifo::new() };
    let mut out = Vec::with_capacity(count);
    for &code in codes {
        out.extend(decoder.triangle(code, table)?);
    }
    decoder.data.end()?;
    Ok(out)
}

impl Decoder<'_, '_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3]> {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            // A triangle on an edge.
            let [a, b] = self.edges.get(high)?;
            let c = match low {
                0 => self.fresh(),
                13 => self.beside(u32::MAX),
                14 => self.beside(1),
                15 => self.explicit()?,
                age => self.vertices.get(age)?,
            };
            self.edges.push([c, b]);
            self.edges.push([a, c]);
            if !(1..13).contains(&low) {
                self.vertices.push(c);
            }
            return Ok([a, b, c]);
        }
        let pair = if low < 14 { table[usize::from(low)] } else { self.data.byte()? };
        if low >= 14 && pair == 0 {
            self.next = 0;
        }
        let a = if low == 15 { self.explicit()? } else { self.fresh() };
        let b = self.corner(pair >> 4)?;
        let c = self.corner(pair & 15)?;
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        self.vertices.push(a);
        for (corner, code) in [(b, pair >> 4), (c, pair & 15)] {
            if matches!(code, 0 | 15) {
                self.vertices.push(corner);
            }
        }
        Ok([a, b, c])
    }

    fn corner(&mut self, code: u8) -> Result<u32> {
        match code {
            0 => Ok(self.fresh()),
            15 => self.explicit(),
            age => self.vertices.get(age - 1),
        }
    }

    fn fresh(&mut self) -> u32 {
        let index = self.next;
        self.next = self.next.wrapping_add(1);
        index
    }

    fn beside(&mut self, step: u32) -> u32 {
        self.last = self.last.wrapping_add(step);
        self.last
    }

    fn explicit(&mut self) -> Result<u32> {
        let step = unzigzag(self.data.varint()?);
        Ok(self.beside(step))
    }
}

/// Mode 2: `count` indices, each a difference to one of two that came before.
pub(super) fn sequence(bytes: &mut Reader<'_>, count: usize) -> Result<Vec<u32>> {
    expect(bytes, 0xd1)?;
    bytes.tail(4)?;
    let mut last = [0_u32; 2];
    let mut out = Vec::new();
    for _ in 0..count {
        let value = bytes.varint()?;
        let baseline = &mut last[usize::from(value & 1 == 1)];
        *baseline = baseline.wrapping_add(unzigzag(value >> 1));
        out.push(*baseline);
    }
    bytes.end()?;
    Ok(out)
}

fn expect(bytes: &mut Reader<'_>, header: u8) -> Result<()> {
    match bytes.byte()? {
        byte if byte == header => Ok(()),
        byte => Err(format!("meshopt: indices of header {byte:#04x}; expected {header:#04x}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_by_edges_and_vertices_that_came_before() {
        // (0 1 2) all new; (2 1 3) on the edge (c, b) with a new vertex; (2 3 0) with vertex 0, the fourth newest; an
        // explicit triangle (7 8 6).
        let mut bytes = vec![0xe1, 0xf0, 0x10, 0x03, 0xff];
        bytes.extend([0xff, 14, 2, 3]);
        bytes.extend([0; 16]);
        let out = triangles(&mut Reader { bytes: &bytes }, 12).unwrap();
        assert_eq!(out, [0, 1, 2, 2, 1, 3, 2, 3, 0, 7, 8, 6]);
        bytes[1] = 0x00;
        assert!(triangles(&mut Reader { bytes: &bytes }, 12).is_err(), "no edge yet");
    }

    #[test]
    fn indices_by_two_baselines() {
        let mut bytes = vec![0xd1, 0x04, 0x81, 0x02, 0x04, 0x02 | 1];
        bytes.extend([0; 4]);
        assert_eq!(sequence(&mut Reader { bytes: &bytes }, 4).unwrap(), [1, 64, 2, 63]);
        assert!(sequence(&mut Reader { bytes: &bytes }, 5).is_err(), "too few");
        assert!(sequence(&mut Reader { bytes: &bytes }, 3).is_err(), "too many");
    }
}
