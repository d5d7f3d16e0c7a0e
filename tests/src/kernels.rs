//! Kernels of known profiles, and the example of `decoder/FORMAT.md`, section 6.3.

use subsurf_encoder::kernel::{Kernel as KernelModel, KernelMethod, Term, TwoGaussians};

/// The example of the specification.
#[must_use]
pub fn format_kernel() -> KernelModel {
    let weights = vec![[0.5; 3], [0.125, 0.0625, 0.0], [0.0625, 0.0, 0.0]];
    KernelModel {
        method: KernelMethod::PreIntegrated,
        radius: 2.0,
        reflectance: [0.765_625, 0.390_625, 0.25],
        depth_variance: 1.0,
        eta: 1.5,
        offsets: vec![0.0, 0.5, 1.0],
        terms: vec![Term { sign: [1; 3], weights }],
        tail: vec![[0.765_625, 0.390_625, 0.25], [0.25, 0.125, 0.0625], [0.0; 3]],
        two_gaussians: None,
    }
}

/// Skin-like light within a few millimetres: two Gaussians, wide ones in red, of reflectance (0.8, 0.6, 0.5).
pub const SKIN: TwoGaussians =
    TwoGaussians { weight: [0.4, 0.6, 0.7], tau_near: [0.04, 0.03, 0.02], tau_far: [1.2, 0.4, 0.2] };

/// Kernel of two Gaussians in one dimension, of `taps` taps up to 3 σ of the widest; weights are integrals, scaled to the reflectance.
///
/// # Panics
/// If `taps` is even.
#[must_use]
pub fn two_gaussians(of: TwoGaussians, reflectance: [f32; 3], taps: u16) -> KernelModel {
    const NODES: u16 = 64;
    assert!(taps % 2 == 1, "a centre and two sides");
    let far = of.tau_far.into_iter().fold(0.0, f32::max);
    let radius = 3.0 * far.sqrt();
    let side = taps / 2;
    // Taps lie closer at the centre.
    let offsets: Vec<f32> = (0..=side).map(|i| 0.98 * radius * (f32::from(i) / f32::from(side)).powi(2)).collect();
    let ends: Vec<f32> = offsets.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).chain([radius]).collect();
    let weights = (0..offsets.len()).map(|i| {
        [0, 1, 2].map(|c| {
            let scale = reflectance[c].sqrt() / (2.0 * within(&of, radius, c));
            let inner = if i == 0 { -within(&of, ends[0], c) } else { within(&of, ends[i - 1], c) };
            scale * (within(&of, ends[i], c) - inner)
        })
    });
    let tail = (0..NODES).map(|k| {
        let share = share_through(of, radius, radius * (f32::from(k) / f32::from(NODES - 1)).powi(2));
        [0, 1, 2].map(|c| reflectance[c] * share[c])
    });
    KernelModel {
        method: KernelMethod::TwoGaussians,
        radius,
        reflectance,
        depth_variance: far,
        eta: 1.4,
        terms: vec![Term { sign: [1; 3], weights: weights.collect() }],
        offsets,
        tail: tail.collect(),
        two_gaussians: Some(of),
    }
}

/// Share of a profile within `radius` that lies beyond a line `d` away from the middle, both in mm.
#[must_use]
pub fn share_beyond(of: TwoGaussians, radius: f32, d: f32) -> [f32; 3] {
    [0, 1, 2].map(|c| 0.5 - 0.5 * within(&of, d.min(radius), c) / within(&of, radius, c))
}

/// Share of a profile within `radius` that lies farther than `d` from its middle, both in mm: what comes through a plate of that thickness.
#[must_use]
pub fn share_through(of: TwoGaussians, radius: f32, d: f32) -> [f32; 3] {
    [0, 1, 2].map(|c| {
        let beyond = |d: f32| {
            let gaussian = |tau: f32| (-0.5 * d * d / tau).exp();
            of.weight[c] * gaussian(of.tau_near[c]) + (1.0 - of.weight[c]) * gaussian(of.tau_far[c])
        };
        (beyond(d.min(radius)) - beyond(radius)) / (1.0 - beyond(radius))
    })
}

/// Integral of a profile in one dimension from 0 to x in mm, of one channel.
fn within(of: &TwoGaussians, x: f32, c: usize) -> f32 {
    let gaussian = |tau: f32| 0.5 * libm::erff(x / (2.0 * tau).sqrt());
    of.weight[c] * gaussian(of.tau_near[c]) + (1.0 - of.weight[c]) * gaussian(of.tau_far[c])
}

/// [`two_gaussians`] of [`SKIN`].
#[must_use]
pub fn skin(taps: u16) -> KernelModel {
    two_gaussians(SKIN, [0.8, 0.6, 0.5], taps)
}

/// Profile of [`difference`], but for its reflectance: the wide Gaussians of [`SKIN`].
pub const WIDE: TwoGaussians = TwoGaussians { weight: [0.0; 3], ..SKIN };

/// Two terms, the second taken away: of red and green what three tenths of the light would do, of blue nothing.
#[must_use]
pub fn difference(taps: u16) -> KernelModel {
    let narrow = TwoGaussians { weight: [1.0; 3], tau_far: SKIN.tau_far, ..SKIN };
    let first = two_gaussians(WIDE, [0.9, 0.7, 0.5], taps);
    let mut second = two_gaussians(narrow, [0.3, 0.3, 0.0], taps).terms.remove(0);
    second.sign = [-1, -1, 1];
    let reflectance = [0.6, 0.4, 0.5];
    let scale = |tail: &[f32; 3]| [0, 1, 2].map(|c| tail[c] * reflectance[c] / first.reflectance[c]);
    let tail = first.tail.iter().map(scale).collect();
    let terms = vec![first.terms[0].clone(), second];
    KernelModel { method: KernelMethod::Svd, reflectance, terms, tail, two_gaussians: None, ..first }
}
