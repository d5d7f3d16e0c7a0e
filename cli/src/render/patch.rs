//! A flat patch, each of its pixels a block.

use serde_json::{Map, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::bssrdf::Light;
use subsurf_runtime::{BssrdfPlanes, Gpu, Load, PatchLight, PatchRenderer, Region, SeparableRenderer, layout_of};
use subsurf_shaders::{Rgb, cpu};
use subsurf_viewer::{Scattering, basis, numbers};

use super::Drawing;
use super::exposure::exposure_for;
use crate::picture::image;
use crate::program::failure::bad_request;

/// Irradiance of a pattern on every pixel of a patch, as it is after it has entered.
pub(crate) fn patch_irradiance(material: &Bssrdf<'_>, light: Light) -> Vec<Rgb> {
    let size = [material.header().width as usize, material.header().height as usize];
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    pixels.map(|pixel| [light.irradiance(pixel, size); 3]).collect()
}

/// Draws the whole patch, each of its pixels a block.
pub(crate) fn draw_patch(
    gpu: Option<&Gpu>,
    material: &Bssrdf<'_>,
    technique: Scattering,
    light: Light,
    size: [u32; 2],
    exposure: Option<f32>,
) -> anyhow::Result<Drawing> {
    let header = material.header();
    let whole = Region { origin: [0, 0], size: [header.width, header.height] };
    // The patch keeps its shape.
    let scale = (0..2).map(|k| f64::from(size[k]) / f64::from(whole.size[k])).fold(f64::INFINITY, f64::min);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "no larger than `size`")]
    let size = whole.size.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    let irradiance = patch_irradiance(material, light);
    let mut facts = Map::new();
    facts.insert("light".to_owned(), json!(light.name()));
    facts.insert("size".to_owned(), json!(size));
    let (pixels, exposure) = match gpu {
        Some(gpu) => {
            let renderer = PatchRenderer::new(gpu, layout_of(material))?;
            let light = PatchLight::upload(gpu, whole.size, &irradiance)?;
            let (exitance, gpu_bytes) = match technique {
                Scattering::Splat => return Err(no_splats()),
                Scattering::Gather => {
                    let uploaded = BssrdfPlanes::upload(gpu, material)?;
                    (renderer.gather(gpu, &uploaded, &light, whole)?, uploaded.gpu_bytes())
                }
                Scattering::Separable | Scattering::Homogeneous | Scattering::Opaque => {
                    let uploaded = Load::separable(gpu, material, &numbers(material, technique)?)?.finish()?;
                    let renderer = SeparableRenderer::new(gpu, uploaded.terms())?;
                    let patch = renderer.prepare(gpu, &uploaded, &light)?;
                    renderer.draw(gpu, &patch)?;
                    (patch.into_exitance(), uploaded.gpu_bytes())
                }
            };
            let exposure = match exposure {
                Some(exposure) => exposure,
                None => exposure_for(exitance.read(gpu)?.iter()),
            };
            facts.insert("gpu_bytes".to_owned(), json!(gpu_bytes));
            (renderer.picture(gpu, &exitance, size, exposure)?, exposure)
        }
        None => {
            let exitance = match technique {
                Scattering::Splat => return Err(no_splats()),
                Scattering::Gather => cpu::gather(material, &irradiance, whole.origin, whole.size),
                Scattering::Separable | Scattering::Homogeneous | Scattering::Opaque => {
                    basis(material, technique)?.exitance(&irradiance)
                }
            };
            let exposure = exposure.unwrap_or_else(|| exposure_for(exitance.iter()));
            (cpu::present(&exitance, whole.size, size, exposure), exposure)
        }
    };
    Ok(Drawing { picture: image(&pixels, size[0]), exposure, facts })
}

fn no_splats() -> anyhow::Error {
    bad_request("--technique splat is for meshes; a flat patch is drawn by gather or separable")
}
