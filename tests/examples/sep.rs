//! Scratch.
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::Light;
use subsurf_shaders::cpu;
use subsurf_shaders::separable::{Detail, Factors};
fn main() {
    for path in std::env::args().skip(1) {
        let bytes = std::fs::read(&path).unwrap();
        let material = Bssrdf::parse(&bytes).unwrap();
        let h = *material.header();
        let size = [h.width as usize, h.height as usize];
        for (terms, gaussians) in [(1, 5), (2, 3), (2, 4), (2, 5)] {
            let t = std::time::Instant::now();
            let f = Factors::of(&material, Detail { terms, gaussians });
            let ms = t.elapsed().as_secs_f64() * 1e3;
            let mut line = format!(
                "{} L={terms} A={gaussians} {ms:.0} ms sigmas {:.2?}:",
                path.rsplit('/').next().unwrap(),
                f.sigmas
            );
            for light in Light::ALL {
                let e: Vec<[f32; 3]> =
                    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [light.irradiance([x, y], size); 3])).collect();
                let want = cpu::gather(&material, &e, [0, 0], [h.width, h.height]);
                let got = cpu::separable(&f, &e);
                let peak = want.iter().flatten().fold(0.0f32, |a, &b| a.max(b)) as f64;
                let mse: f64 = want
                    .iter()
                    .flatten()
                    .zip(got.iter().flatten())
                    .map(|(a, b)| (f64::from(a - b) / peak).powi(2))
                    .sum::<f64>()
                    / (3 * want.len()) as f64;
                line += &format!(" {:.1}", -10.0 * mse.log10());
            }
            println!("{line}");
        }
    }
}
