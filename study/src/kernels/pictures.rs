//! Kernels in the plane, as pictures.

use std::io::Cursor;

use image::ImageFormat;
use subsurf_cli::picture::linear;
use subsurf_encoder::kernel::{KernelMethod, Options, Profile, encode};

use crate::page::panel::{Row, panel as pictures};

/// Pixels of a picture's side, odd.
const SIDE: u32 = 65;
/// Share of the light beyond the pictures, of the channel that goes farthest.
const BEYOND: f64 = 0.1;
/// Decades from white to black.
const DECADES: f64 = 3.0;

/// The profile and its kernels, with a logarithmic scale: white is the profile at a twentieth of the picture.
pub(super) fn panel(profile: &Profile) -> anyhow::Result<String> {
    let half = profile.channels.iter().map(|radial| radial.radius_of(BEYOND)).fold(0.0, f64::max);
    let white: [f64; 3] = std::array::from_fn(|c| profile.channels[c].at(0.1 * half));
    let picture = |rd: &dyn Fn(usize, f64, f64) -> f64| -> anyhow::Result<Vec<u8>> {
        let middle = f64::from(SIDE / 2);
        let place = |k: u32| (f64::from(k) - middle) / middle * half;
        let shade = |c: usize, x: f64, y: f64| {
            let value = (rd(c, x, y) / white[c]).max(1e-30);
            // Linear from black to white in what is shown, which is encoded.
            (1.0 + value.log10() / DECADES).clamp(0.0, 1.0).powf(2.2)
        };
        let pixels: Vec<[f64; 3]> = (0..SIDE * SIDE)
            .map(|pixel| std::array::from_fn(|c| shade(c, place(pixel % SIDE), place(pixel / SIDE))))
            .collect();
        let mut png = Cursor::new(Vec::new());
        linear(&pixels, SIDE, 1).write_to(&mut png, ImageFormat::Png)?;
        Ok(png.into_inner())
    };
    let with = |method, terms, guide| Options { method, terms, guide, ..Options::default() };
    let asked = [
        ("pre-integrated", Options::default()),
        ("guided, k = 0", with(KernelMethod::Guided, 1, 0.0)),
        ("guided, k = 1.55", with(KernelMethod::Guided, 1, 1.55)),
        ("guided, k = 4", with(KernelMethod::Guided, 1, 4.0)),
        ("two Gaussians", with(KernelMethod::TwoGaussians, 1, 1.55)),
        ("svd, 1", with(KernelMethod::Svd, 1, 1.55)),
        ("svd, 3", with(KernelMethod::Svd, 3, 1.55)),
        ("svd, 6", with(KernelMethod::Svd, 6, 1.55)),
        ("1 Gaussian", with(KernelMethod::Gaussians, 1, 1.55)),
        ("3 Gaussians", with(KernelMethod::Gaussians, 3, 1.55)),
        ("6 Gaussians", with(KernelMethod::Gaussians, 6, 1.55)),
    ];
    let mut columns = vec!["exact".to_owned()];
    let mut all = vec![Some(picture(&|c, x, y| profile.channels[c].at(x.hypot(y)))?)];
    for (title, options) in asked {
        let encoded = encode(profile, &options)?;
        columns.push(title.to_owned());
        all.push(Some(picture(&|c, x, y| encoded.separable[c].at(x, y))?));
    }
    Ok(pictures(&columns, &[Row { title: String::new(), pictures: all }], [2.0 * half; 2], None))
}
