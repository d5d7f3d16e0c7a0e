//! A translucent material: simulated, encoded, decoded and judged.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::bssrdf::{Options, encode};
use subsurf_encoder::capture::{Capture, Overrides, Scalar};
use subsurf_encoder::metrics::bssrdf::judge;
use subsurf_encoder::simulate::diffusion::{BuiltinMaterial, Finish, Method, Request};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("jade.npy");

    // 24 × 24 pixels of 0.5 mm; light is measured within 7 × 7 pixels around each.
    let map = BuiltinMaterial::Jade.map([24, 24], Addressing::Clamp, 1);
    let request = Request {
        method: Method::default(),
        map: &map,
        source: "jade".into(),
        addressing: Addressing::Clamp,
        pitch_mm: 0.5,
        window: 7,
        thickness_mm: 5.0,
        eta: 1.5,
        refine: 0.5,
        finish: Finish::default(),
        seed: 1,
        scalar: Scalar::F32,
    };
    request.write(&path, &())?;

    // Two of sixteen base materials per pixel.
    let capture = Capture::open(&path, &Overrides::default())?;
    let options = Options { base_materials: 16, ..Options::default() };
    let encoded = encode(&capture, None, &options, &())?;

    // Reflectance from one pixel to another, and how far all of it is from the capture.
    let material = Bssrdf::parse(&encoded.bytes)?;
    println!("Rd from (3, 4) to (5, 4): {:?} mm⁻²", material.rd([3, 4], [5, 4]));
    let judgement = judge(&capture, &material, encoded.bytes.len() as u64, &())?;
    let psnr_db = judgement.psnr_db[0].ok_or("nothing is lit")?;
    println!("{} bytes of {}: {psnr_db:.1} dB under uniform light", judgement.bytes, judgement.capture_bytes);
    Ok(())
}
