//! Meshes as files have them, before they are checked.

use glam::{DVec3, Vec2, Vec3};

/// Result of a reader; the error says what is wrong with the file, and where.
pub(super) type Result<T> = std::result::Result<T, String>;

/// Most vertices or triangles of a mesh: 2 GiB of positions, normals and texture coordinates. Small files can claim more.
pub(super) const MAX: usize = 1 << 26;

/// Vertices and triangles in the file's own unit.
#[derive(Debug, Default)]
pub(super) struct Raw {
    /// Of double precision, since maps and scans may be far from their origin.
    pub(super) positions: Vec<DVec3>,
    /// One for each vertex, [`Vec3::NAN`] where it has none; or none at all.
    pub(super) normals: Vec<Vec3>,
    /// One for each vertex, v upwards, [`Vec2::NAN`] where it has none; or none at all.
    pub(super) uvs: Vec<Vec2>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// What was changed or left out, a line each.
    pub(super) warnings: Vec<String>,
}

impl Raw {
    /// Says what was left out, unless there is none of it.
    pub(super) fn leave_out(&mut self, number: usize, what: &str) {
        if number > 0 {
            self.warnings.push(format!("{number} {what}: left out"));
        }
    }

    /// Adds the triangles of a strip: each vertex from the third on makes one with the two before it, every other turned, so
    /// that all have the same side. Those without area join strips.
    pub(super) fn add_strip(&mut self, strip: &[u32]) {
        for (k, corners) in strip.windows(3).enumerate() {
            let (a, b, c) = (corners[0], corners[1], corners[2]);
            if a != b && b != c && c != a {
                self.triangles.push(if k % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
    }

    /// Checks indices and numbers. Vertices that no triangle has are taken away, since nothing of them is drawn; texture
    /// coordinates as well, unless every vertex has them.
    pub(super) fn check(&mut self) -> Result<()> {
        if self.triangles.is_empty() {
            return Err(["no triangles".to_owned()]
                .into_iter()
                .chain(self.warnings.drain(..))
                .collect::<Vec<_>>()
                .join("; "));
        }
        let count = self.positions.len();
        if let Some(index) = self.triangles.iter().flatten().find(|&&index| index as usize >= count) {
            return Err(format!("a triangle names vertex {index}, counted from 0, but there are {count}"));
        }
        let mut is_used = vec![false; count];
        for &index in self.triangles.iter().flatten() {
            is_used[index as usize] = true;
        }
        let broken = self
            .positions
            .iter()
            .zip(&is_used)
            .position(|(position, is_used)| *is_used && !position.as_vec3().is_finite());
        if let Some(at) = broken {
            let position = self.positions[at].as_vec3();
            return Err(format!("vertex {at}, counted from 0, is at {position}; expected finite numbers"));
        }
        if is_used.contains(&false) {
            self.keep(&is_used);
        }
        let broken = self.normals.iter().filter(|normal| normal.try_normalize().is_none()).count();
        if broken > 0 {
            self.warnings.push(format!(
                "{broken} of {} normals are missing, zero or not finite: made anew from the triangles around",
                self.normals.len()
            ));
        }
        let broken = self.uvs.iter().filter(|uv| !uv.is_finite()).count();
        if broken > 0 {
            self.warnings.push(format!(
                "{broken} of {} vertices have no texture coordinates, or broken ones: none are used",
                self.uvs.len()
            ));
            self.uvs.clear();
        }
        Ok(())
    }

    /// Takes away all other vertices.
    fn keep(&mut self, is_used: &[bool]) {
        let mut number = 0;
        let numbers: Vec<u32> = is_used
            .iter()
            .map(|&is_used| {
                number += u32::from(is_used);
                number.wrapping_sub(1)
            })
            .collect();
        for index in self.triangles.iter_mut().flatten() {
            *index = numbers[*index as usize];
        }
        fn retain<T>(values: &mut Vec<T>, is_used: &[bool]) {
            let mut is_used = is_used.iter();
            values.retain(|_| *is_used.next().unwrap_or(&false));
        }
        retain(&mut self.positions, is_used);
        retain(&mut self.normals, is_used);
        retain(&mut self.uvs, is_used);
    }
}

/// A number of vertices or triangles, as indices count them.
pub(super) fn count(n: usize) -> Result<u32> {
    match u32::try_from(n) {
        Ok(count) if n <= MAX => Ok(count),
        _ => Err(format!("{n} vertices or triangles; a mesh has at most {MAX}")),
    }
}
