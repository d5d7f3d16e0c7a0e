//! A rough surface: images from a formula, encoded, decoded and judged.

use glam::Vec3;
use subsurf_decoder::NestedBtf;
use subsurf_encoder::Result;
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::{Goal, Options, Size, encode};
use subsurf_encoder::capture::{Direction, Images, Source, bonn};
use subsurf_encoder::metrics::btf::judge;
use subsurf_encoder::picture::PixelFormat;

/// Waves of 16 × 16 pixels, seen and lit from up to 45° off the normal.
struct Waves(Vec<Vec3>);

impl Source for Waves {
    fn label(&self) -> String {
        "waves".to_owned()
    }

    fn lights(&self) -> Vec<Vec3> {
        self.0.clone()
    }

    fn views(&self) -> Vec<Vec3> {
        self.0.clone()
    }

    fn size(&self) -> [u32; 2] {
        [16, 16]
    }

    fn format(&self) -> PixelFormat {
        PixelFormat::Display8
    }

    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        let (light, view) = (self.0[light], self.0[view]);
        let half = (light + view).normalize();
        let pixel = |k: u8| {
            let (x, y) = (f32::from(k % 16), f32::from(k / 16));
            let normal = Vec3::new(0.4 * (0.8 * x).sin(), 0.3 * (0.6 * y).cos(), 1.0).normalize();
            let gloss = 0.3 * normal.dot(half).max(0.0).powi(20);
            [0.6, 0.4, 0.2].map(|albedo| albedo * normal.dot(light).max(0.0) + gloss)
        };
        Ok((0..=255).map(pixel).collect())
    }
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let directions = bonn().into_iter().filter(|direction| direction.theta_deg <= 45).map(Direction::unit);
    let images = [Images::load(&Waves(directions.collect()), &())?];

    // Nested codebooks of 64 apparent BRDFs, over fewer directions than usual.
    let goal = Goal::Size(Size::Nested(Extent { p4: 64, stages: 1 }));
    let options = Options { nodes: Some([7, 7, 3, 8]), goal, ..Options::default() };
    let encoded = encode(&images, &["waves".to_owned()], &options, &(), &mut |_| ())?;

    // Value of a texel under light from the normal, and how far all images are from those that were measured.
    let btf = NestedBtf::parse(&encoded.bytes)?;
    let texel = btf.texel(0, 0, [3, 4]).ok_or("no such texel")?;
    println!("linear RGB of texel (3, 4): {:?}", btf.eval(texel, [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]));
    let error = judge(&images, &encoded.bytes, &())?;
    println!("{} bytes of {}: {:.1} dB", encoded.bytes.len(), images[0].bytes(), error.psnr_db);
    Ok(())
}
