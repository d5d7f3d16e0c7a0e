//! What the tests of several crates share: synthetic materials and captures made without a simulation.

use std::path::{Path, PathBuf};

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::layout::{MODEL_2BMPP, MODEL_PER_PIXEL};
use subsurf_decoder::bssrdf::{Addressing, Header};
use subsurf_encoder::bssrdf::write_file;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};

/// A number in 0 .. 1 that looks random and depends on `n` alone (a Weyl sequence).
#[must_use]
pub fn unit(n: u32) -> f32 {
    let bits = n.wrapping_mul(0x9E37_79B9) ^ (n.wrapping_mul(0x85EB_CA6B) >> 13);
    let bits = bits.wrapping_mul(0xC2B2_AE35) >> 8;
    #[allow(clippy::cast_precision_loss, reason = "24 bits fit")]
    let unit = bits as f32 / (1 << 24) as f32;
    unit
}

/// Header of a synthetic material: 0.5 mm pitch, nodes up to the window's corner.
#[must_use]
pub fn header(model: u8, size: [u32; 2], radius: u16, addressing: Addressing) -> Header {
    let pitch_mm = 0.5;
    Header {
        model,
        addressing,
        width: size[0],
        height: size[1],
        window_radius: radius,
        samples: radius + 2,
        base_materials: if model == MODEL_2BMPP { 7 } else { 0 },
        pitch_mm,
        r_max_mm: f32::from(radius.max(1)) * std::f32::consts::SQRT_2 * pitch_mm * 1.000_01,
        eta: 1.4,
    }
}

/// Log-scale profile number `k` at node h: falls like light in a medium, no two alike.
fn log_profile(k: u32, h: u16, c: u32, header: &Header) -> f32 {
    let r_mm = f32::from(h) * header.r_max_mm / f32::from(header.samples - 1);
    let brightness = -1.5 + 0.8 * unit(3 * k + c);
    let decay = 0.6 + 0.8 * unit(1_000 + 3 * k + c);
    brightness - decay * r_mm - (1.0 + r_mm * r_mm).ln()
}

/// A synthetic 2-BMPP file whose pixels blend its seven base materials at random.
#[must_use]
pub fn bmpp(size: [u32; 2], radius: u16, addressing: Addressing) -> Vec<u8> {
    let header = header(MODEL_2BMPP, size, radius, addressing);
    let bases = 0..header.base_materials;
    let profiles = bases.flat_map(|b| (0..header.samples).flat_map(move |h| (0..3).map(move |c| (b, h, c))));
    let profiles = profiles.flat_map(|(b, h, c)| log_profile(b, h, c, &header).to_le_bytes()).collect();
    let pixels = || 0..size[0] * size[1];
    let ratios = pixels().flat_map(|pixel| unit(50_000 + pixel).to_le_bytes()).collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 6")]
    let base = |n: u32| (unit(n) * 6.99) as u8;
    let indices = pixels().flat_map(|pixel| [base(100_000 + pixel), base(200_000 + pixel)]).collect();
    let sections =
        [(Section::BaseProfiles, profiles), (Section::MixtureRatios, ratios), (Section::BaseIndices, indices)];
    write_file(&header, &sections)
}

/// A synthetic file of per-pixel profiles.
#[must_use]
pub fn per_pixel(size: [u32; 2], radius: u16, addressing: Addressing) -> Vec<u8> {
    let header = header(MODEL_PER_PIXEL, size, radius, addressing);
    let planes = (0..header.samples).flat_map(|h| (0..3).map(move |c| (h, c)));
    let values = planes.flat_map(|(h, c)| (0..size[0] * size[1]).map(move |pixel| (pixel, h, c)));
    let values = values.flat_map(|(pixel, h, c)| log_profile(pixel, h, c, &header).to_le_bytes()).collect();
    write_file(&header, &[(Section::LocalProfiles, values)])
}

/// Writes a capture whose entries come from `rd` (pixel, window place, channel), in mm⁻².
///
/// # Panics
/// If it cannot be written.
pub fn write_capture(
    folder: &Path,
    name: &str,
    size: [usize; 2],
    radius: usize,
    addressing: Addressing,
    rd: impl Fn(usize, usize, usize) -> f32,
) -> PathBuf {
    let path = folder.join(name);
    let sidecar = Sidecar { pitch_mm: 0.5, addressing, eta: 1.4, simulated: None };
    let writer = CaptureWriter { path: &path, size, radius, scalar: Scalar::F32, sidecar: &sidecar };
    let places = (2 * radius + 1).pow(2);
    let result = writer.write(|sink| {
        for pixel in 0..size[0] * size[1] {
            let window: Vec<f32> = (0..places * 3).map(|k| rd(pixel, k / 3, k % 3)).collect();
            sink(&window)?;
        }
        Ok(())
    });
    result.expect("a temporary folder can be written to");
    path
}

/// Opens a capture with what its sidecar says.
///
/// # Panics
/// If it is refused.
#[must_use]
pub fn open(path: &Path) -> Capture {
    Capture::open(path, &Overrides::default()).expect("a capture of our own")
}
