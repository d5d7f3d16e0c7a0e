//! Nested codebooks evaluated as the paper writes it (Havran et al. 2010, eq. 4 and fig. 6), in f64 and one node at a time,
//! from what a file was made of: nothing here knows the decoder's tables.

use std::f64::consts::{PI, TAU};

use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{ColourEncoding, Grid};
use subsurf_encoder::btf::nested::Database;

/// Few nodes, each axis with another number of them, that reach less far than hemispheres.
pub const ODD_GRID: Grid = Grid {
    n_alpha: 7,
    n_beta: 9,
    n_theta: 2,
    n_phi: 1,
    alpha_max: 1.3,
    sin_beta_max: 0.9,
    theta_max: 1.2,
    cos_light_min: 0.2,
};

/// Node and weight of the two nodes around a place.
type Nodes = [(usize, f64); 2];

/// `t` in nodes from the first of `count`.
fn on_line(t: f64, count: u8) -> Nodes {
    let t = t.clamp(0.0, f64::from(count - 1));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 62")]
    let first = (t as usize).min(usize::from(count) - 2);
    #[allow(clippy::cast_precision_loss, reason = "0 to 62")]
    let weight = t - first as f64;
    [(first, 1.0 - weight), (first + 1, weight)]
}

/// The nodes around a pair of directions: φ_v, θ_v, α and sin β.
fn place(grid: &Grid, light: [f64; 3], view: [f64; 3]) -> [Nodes; 4] {
    let azimuth = if view[0].hypot(view[1]) > 1e-6 { view[1].atan2(view[0]) } else { 0.0 };
    let turns = azimuth.rem_euclid(TAU) / TAU * f64::from(grid.n_phi);
    let ring = usize::from(grid.n_phi);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 64")]
    let (phi, fraction) = (turns as usize, turns.fract());
    let theta = view[0].hypot(view[1]).atan2(view[2]) / f64::from(grid.theta_max) * f64::from(grid.n_theta - 1);
    let forward = light[0] * azimuth.cos() + light[1] * azimuth.sin();
    let sin_beta = light[1] * azimuth.cos() - light[0] * azimuth.sin();
    let alpha = forward.atan2(light[2].max(0.0));
    let middle = |value: f64, max: f32, count: u8| (value / f64::from(max) + 1.0) / 2.0 * f64::from(count - 1);
    [
        [(phi % ring, 1.0 - fraction), ((phi + 1) % ring, fraction)],
        on_line(theta, grid.n_theta),
        on_line(middle(alpha, grid.alpha_max, grid.n_alpha), grid.n_alpha),
        on_line(middle(sin_beta, grid.sin_beta_max, grid.n_beta), grid.n_beta),
    ]
}

fn scale(scales: Scales, code: u32, is_signed: bool) -> f64 {
    let top = u32::from(scales.bits) - u32::from(is_signed);
    let size = f64::from(scales.offset) + f64::from((code & ((1 << top) - 1)) << scales.step);
    let sign = if is_signed && code >> top == 1 { -1.0 } else { 1.0 };
    sign * (size / 64.0).exp2()
}

/// Luma of one stage at nodes φ_v, θ_v, α and sin β, and the row of I2 there.
fn at_node(database: &Database, stage: usize, texel: usize, [phi, theta, alpha, beta]: [usize; 4]) -> (f64, usize) {
    let (grid, chain) = (&database.header.grid, &database.stages[stage]);
    let [n_phi, n_theta, n_alpha, n_beta] = [grid.n_phi, grid.n_theta, grid.n_alpha, grid.n_beta].map(usize::from);
    let p6 = chain.texels[texel];
    let p4 = chain.p4[p6.index as usize * n_phi + phi];
    let p3 = chain.p3[p4.index as usize * n_theta + theta];
    let [p2, i2] = if stage == 0 { database.chroma.merged[p3.index as usize] } else { [p3.index, 0] };
    let p2 = chain.p2[p2 as usize * n_alpha + alpha];
    let p1 = chain.p1[p2.index as usize * (n_beta + 1) + beta];
    let value = if chain.is_signed { f64::from(p1.cast_signed()) / 127.0 } else { f64::from(p1) / 255.0 };
    let scales = [p6, p4, p3, p2].into_iter().zip(chain.scales);
    let product: f64 = scales.map(|(item, scales)| scale(scales, item.code, chain.is_signed)).product();
    (product * value, i2 as usize)
}

/// Luma and two channels of chroma of a texel, numbered as in the file.
#[must_use]
pub fn channels(database: &Database, texel: usize, light: [f64; 3], view: [f64; 3]) -> [f64; 3] {
    let (grid, chroma) = (&database.header.grid, &database.chroma);
    let [n_alpha, n_beta] = [grid.n_alpha, grid.n_beta].map(usize::from);
    let [phis, thetas, alphas, betas] = place(grid, light, view);
    let (mut luma, mut first_luma, mut hues) = (0.0, 0.0, [0.0; 2]);
    for (phi, theta, alpha, beta) in phis
        .iter()
        .flat_map(|phi| thetas.iter().map(move |theta| (phi, theta)))
        .flat_map(|(phi, theta)| alphas.iter().map(move |alpha| (phi, theta, alpha)))
        .flat_map(|(phi, theta, alpha)| betas.iter().map(move |beta| (phi, theta, alpha, beta)))
    {
        let weight = phi.1 * theta.1 * alpha.1 * beta.1;
        let node = [phi.0, theta.0, alpha.0, beta.0];
        let (value, i2) = at_node(database, 0, texel, node);
        let i1 = chroma.i2[i2 * n_alpha + alpha.0] as usize;
        let colour = chroma.colours[chroma.i1[i1 * n_beta + beta.0] as usize];
        // Ratios count as much as the luma they belong to.
        let share = if chroma.is_relative { weight * value } else { weight };
        for (channel, hue) in hues.iter_mut().enumerate() {
            *hue += share
                * (f64::from(chroma.first[channel]) + f64::from(chroma.step[channel]) * f64::from(colour[channel]));
        }
        first_luma += weight * value;
        luma += (0..database.stages.len()).map(|stage| weight * at_node(database, stage, texel, node).0).sum::<f64>();
    }
    let tint = chroma.texel_tints.get(texel).map_or([128; 2], |tint| chroma.tints[*tint as usize]);
    let tint = [0, 1].map(|channel| f64::from(chroma.step[channel]) * (f64::from(tint[channel]) - 128.0));
    let hue = |channel: usize| match chroma.is_relative {
        true => (hues[channel] / first_luma + tint[channel]) * luma,
        false => hues[channel] + tint[channel],
    };
    [luma, hue(0), hue(1)]
}

/// The pixel as images have it.
#[must_use]
pub fn value(database: &Database, texel: usize, light: [f64; 3], view: [f64; 3]) -> [f64; 3] {
    let [y, a, b] = channels(database, texel, light, view);
    let rgb = match database.header.encoding {
        ColourEncoding::Display { .. } => {
            let (r, b) = (y + a / 0.713, y + b / 0.564);
            [r, (y - 0.299 * r - 0.114 * b) / 0.587, b].map(|value| value.clamp(0.0, 1.0))
        }
        ColourEncoding::LogLuv { toe, peak } => {
            let (toe, peak) = (f64::from(toe), f64::from(peak));
            let luminance = toe * ((y.clamp(0.0, 2.0) * (1.0 + peak / toe).log2()).exp2() - 1.0);
            // CIE 1976: u' = 4 X / (X + 15 Y + 3 Z), v' = 9 Y / (X + 15 Y + 3 Z).
            let (u, v) = (a.clamp(0.0, 1.0), b.clamp(0.01, 1.0));
            let sum = 9.0 * luminance / v;
            let x = u * sum / 4.0;
            let z = (sum - x - 15.0 * luminance) / 3.0;
            [
                3.240_97 * x - 1.537_383 * luminance - 0.498_611 * z,
                -0.969_244 * x + 1.875_968 * luminance + 0.041_555 * z,
                0.055_63 * x - 0.203_977 * luminance + 1.056_972 * z,
            ]
            .map(|value| value.max(0.0))
        }
    };
    let lowest = f64::from(database.header.grid.cos_light_min);
    let fade = if light[2] <= 0.0 { 0.0 } else { (light[2] / lowest.max(1e-9)).min(1.0) };
    rgb.map(|value| value * fade)
}

/// A direction from two numbers, 0 to 1, evenly over the hemisphere.
#[must_use]
pub fn direction([u, v]: [f32; 2]) -> [f64; 3] {
    let (z, phi) = (f64::from(u), TAU * f64::from(v));
    let sin = (1.0 - z * z).sqrt();
    [sin * phi.cos(), sin * phi.sin(), z]
}

/// A direction from angles in degrees.
#[must_use]
pub fn angles(theta_deg: f64, phi_deg: f64) -> [f64; 3] {
    let (theta, phi) = (theta_deg * PI / 180.0, phi_deg * PI / 180.0);
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// In f32, as the decoder takes it.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "less precise on purpose")]
pub fn single(direction: [f64; 3]) -> [f32; 3] {
    direction.map(|x| x as f32)
}
