//! What is drawn without heterogeneity: one profile for the whole patch.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_scene::MeanProfile;

use crate::rgb::Rgb;

/// Factors that give back the light that softened distances √(r² + s²) take from what a mean profile spreads over a plane, for s = k / 2
/// pixels of `header`; shape `[k]`. Only what is near is softened, with weights that fall from 1 to 0 between the distances `fade_mm`:
/// ∫ w(r) R(r) r dr, divided by ∫ w(r) R(√(r² + s²)) r dr, which is taken to be at least a tenth of it.
#[must_use]
pub fn softening_gain(profile: &MeanProfile, header: &BssrdfHeader, fade_mm: [f32; 2]) -> [Rgb; 8] {
    const STEPS: u16 = 256;
    let step = header.r_max_mm.min(fade_mm[1]) / f32::from(STEPS);
    let light = |k: u8| {
        let softening_mm = 0.5 * f32::from(k) * header.pitch_mm;
        let radii = (0..STEPS).map(|n| (f32::from(n) + 0.5) * step);
        // In f64: sums over the brightest profiles overflow f32.
        radii.fold([0.0_f64; 3], |sum, r_mm| {
            let width = (fade_mm[1] - fade_mm[0]).max(f32::MIN_POSITIVE);
            let faded = ((r_mm - fade_mm[0]) / width).clamp(0.0, 1.0);
            let share = f64::from((1.0 - faded * faded * (3.0 - 2.0 * faded)) * r_mm);
            let ring = profile.at(r_mm.hypot(softening_mm));
            [0, 1, 2].map(|c| sum[c] + f64::from(ring[c]) * share)
        })
    };
    let lights = [0, 1, 2, 3, 4, 5, 6, 7].map(light);
    let [all, ..] = lights;
    lights.map(|left| {
        #[allow(clippy::cast_possible_truncation, reason = "0 to 10")]
        [0, 1, 2].map(|c| (all[c] / left[c].max(0.1 * all[c]).max(1e-300)) as f32)
    })
}

/// Weights at 0, 1, 2 ... pixels to either side of a kernel whose product along both axes carries the light of the mean
/// profile: a(x) = Σ_y R(√(x² + y²)) pitch², divided by √Σ R pitch² (Jimenez et al. 2015, eq. 10).
#[must_use]
pub fn mean_kernel(material: &Bssrdf<'_>) -> Vec<Rgb> {
    let header = material.header();
    let radius = i32::from(header.window_radius);
    let profile = MeanProfile::of(material);
    let area = f64::from(header.pitch_mm).powi(2);
    let line = |x: i32| {
        // In f64: sums over the brightest profiles overflow f32.
        (-radius..=radius).fold([0.0_f64; 3], |sum, y| {
            #[allow(clippy::cast_precision_loss, reason = "pixels of a window")]
            let reflectance = profile.at(((x * x + y * y) as f32).sqrt() * header.pitch_mm);
            [0, 1, 2].map(|c| sum[c] + f64::from(reflectance[c]) * area)
        })
    };
    let lines: Vec<[f64; 3]> = (0..=radius).map(line).collect();
    let albedo = [0, 1, 2].map(|c| lines[0][c] + 2.0 * lines[1..].iter().map(|line| line[c]).sum::<f64>());
    #[allow(clippy::cast_possible_truncation, reason = "a root of what a profile holds")]
    lines.iter().map(|line| [0, 1, 2].map(|c| (line[c] / albedo[c].max(1e-300).sqrt()) as f32)).collect()
}
