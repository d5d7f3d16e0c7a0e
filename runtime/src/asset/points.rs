//! Points of a mesh on the device, between which light scatters.

use std::sync::Mutex;

use subsurf_scene::SurfacePoints;
use subsurf_shaders::uniform::{self, ROW};
use wgpu::{Buffer, TextureFormat};

use super::mesh::GpuMesh;
use crate::error::{Error, Result};
use crate::gpu::{Gpu, Purpose, Surface2d, TextureSpec, Tracked, array_size};

/// Points of a mesh on the device, and irradiance and exitance at them.
#[derive(Debug)]
pub struct GpuPoints {
    pub(crate) grid: Tracked<Buffer>,
    pub(crate) positions: Surface2d,
    pub(crate) normals: Surface2d,
    pub(crate) visibilities: Surface2d,
    pub(crate) pixels: Surface2d,
    pub(crate) cell_starts: Surface2d,
    pub(crate) irradiance: Surface2d,
    pub(crate) exitance: Surface2d,
    pub(crate) count: usize,
    /// What the exitance is of; none before the first gather.
    pub(crate) lit_by: Mutex<Option<LitBy>>,
}

/// Lights and environment, and transform of the mesh.
pub(crate) type LitBy = (uniform::Scene, glam::Mat4);

impl GpuPoints {
    /// Uploads the points of a surface; visibilities are kept to 1/255.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no textures of that size.
    pub fn upload(gpu: &Gpu, surface: &SurfacePoints) -> Result<Self> {
        let purpose = Purpose::Mesh;
        let table = |label, len, format, bytes: &[u8]| {
            gpu.filled(&TextureSpec { purpose, ..TextureSpec::array(label, len, format) }, bytes)
        };
        let target = |label, size| {
            gpu.texture(&TextureSpec { purpose, ..TextureSpec::target(label, size, gpu.target_texture_format()) })
        };
        let count = surface.len();
        let float = TextureFormat::Rgba32Float;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let byte = |share: &f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        // Two to a channel, the lower byte first.
        let visibilities: Vec<u8> = surface.visibilities.iter().flatten().map(byte).collect();
        Ok(Self {
            grid: gpu.uniform(purpose, "grid", &uniform::PointGrid::new(surface)),
            positions: table("positions", count, float, bytemuck::cast_slice(&surface.positions))?,
            normals: table("normals", count, float, bytemuck::cast_slice(&surface.normals))?,
            visibilities: table("visibilities", count, TextureFormat::Rgba16Uint, &visibilities)?,
            pixels: table("pixels", count, TextureFormat::Rg16Uint, bytemuck::cast_slice(&surface.pixels))?,
            cell_starts: table(
                "cell starts",
                surface.cell_starts.len(),
                TextureFormat::R32Uint,
                bytemuck::cast_slice(&surface.cell_starts),
            )?,
            irradiance: target("irradiance", array_size(count))?,
            exitance: target("exitance", tiled_size(count))?,
            count,
            lit_by: Mutex::new(None),
        })
    }

    /// Refuses points that are fewer than a mesh names.
    pub(crate) fn expect(&self, mesh: &GpuMesh) -> Result<()> {
        if (1..=self.count).contains(&mesh.points) {
            return Ok(());
        }
        let (have, want) = (self.count, mesh.points);
        Err(Error::Usage(format!("{have} points for a mesh that names {want}: they are of another surface")))
    }

    /// Exitance of every point as it was last gathered, linear Rec. 709, relative to irradiance in the scene's unit.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        let texels = gpu.read_rgb(&self.exitance.texture)?;
        let width = tiled_size(self.count)[0] as usize;
        let at = |point: usize| {
            let [x, y] = tiled_texel(point);
            texels[y * width + x]
        };
        Ok((0..self.count).map(at).collect())
    }
}

/// Texels to a side of the tiles in which the gather has points that follow each other.
const TILE: u32 = 8;

/// Width and height in texels of points in tiles; a row of tiles is as wide as a row of an array.
pub(crate) fn tiled_size(len: usize) -> [u32; 2] {
    let tiles = u32::try_from(len).unwrap_or(u32::MAX).div_ceil(TILE * TILE).max(1);
    let in_row = ROW / TILE;
    [tiles.min(in_row) * TILE, tiles.div_ceil(in_row) * TILE]
}

/// Column and row of a point in tiles: `point_at` of `surface_gather.wgsl` and `point_exitance` of `exitance_vertex.wgsl` are the same.
fn tiled_texel(point: usize) -> [usize; 2] {
    let (side, tiles) = (TILE as usize, (ROW / TILE) as usize);
    let (tile, within) = (point / (side * side), point % (side * side));
    [tile % tiles * side + within % side, tile / tiles * side + within / side]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_has_a_texel_of_its_own() {
        for count in [1, 64, 65, 16_384, 16_385, 40_000] {
            let [width, height] = tiled_size(count).map(|side| side as usize);
            let texels: std::collections::HashSet<[usize; 2]> = (0..count).map(tiled_texel).collect();
            assert_eq!(texels.len(), count, "no two are one");
            assert!(texels.iter().all(|[x, y]| *x < width && *y < height), "{count} points: {width} × {height}");
        }
    }
}
