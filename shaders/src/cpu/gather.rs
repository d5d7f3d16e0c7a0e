//! Twin of `gather.wgsl`.

use rayon::prelude::*;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::rgb::Rgb;

/// Rd of a patch from the pixel x_i to the pixel x_o, in mm⁻²; x_i may lie beyond the border.
pub trait Reflectance: Sync {
    /// Size, pitch, window and addressing.
    fn header(&self) -> &BssrdfHeader;
    /// Rd(x_i, x_o), 0 outside the window.
    fn rd(&self, x_i: [i32; 2], x_o: [i32; 2]) -> Rgb;
}

impl Reflectance for Bssrdf<'_> {
    fn header(&self) -> &BssrdfHeader {
        self.header()
    }

    fn rd(&self, x_i: [i32; 2], x_o: [i32; 2]) -> Rgb {
        self.rd(x_i, x_o)
    }
}

/// Exitance Σ Rd(x_i, x_o) E(x_i) pitch² of the `size` pixels from `origin` on, row by row.
///
/// `irradiance` covers the whole patch, row by row; beyond the border it is addressed like the material.
///
/// # Panics
/// If `irradiance` is shorter than the patch.
#[must_use]
pub fn gather(material: &dyn Reflectance, irradiance: &[Rgb], origin: [u32; 2], size: [u32; 2]) -> Vec<Rgb> {
    let header = material.header();
    let radius = i32::from(header.window_radius);
    let area = header.pitch_mm * header.pitch_mm;
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    let texels: Vec<[u32; 2]> = texels.collect();
    let exitance = |[x, y]: [u32; 2]| {
        let x_o = [x + origin[0], y + origin[1]].map(u32::cast_signed);
        let mut sum = [0.0; 3];
        for dy in -radius..=radius {
            for dx in -radius..=radius {
                let x_i = [x_o[0] + dx, x_o[1] + dy];
                let column = header.addressing.map(x_i[0], header.width) as usize;
                let row = header.addressing.map(x_i[1], header.height) as usize;
                let e = irradiance[row * header.width as usize + column];
                let rd = material.rd(x_i, x_o);
                for c in 0..3 {
                    sum[c] += rd[c] * e[c];
                }
            }
        }
        sum.map(|sum| sum * area)
    };
    texels.into_par_iter().map(exitance).collect()
}
