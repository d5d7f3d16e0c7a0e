//! What kernel files say of themselves.

use serde_json::{Value, json};
use subsurf_decoder::kernel::TwoGaussians;
use subsurf_decoder::{File, Kernel};
use subsurf_viewer::human;

use super::{Args, print_json, print_rest};
use crate::outln;

pub(super) fn info(args: &Args, bytes: &[u8], file: &File<'_>, kernel: &Kernel<'_>) {
    let header = kernel.header();
    let signs: Vec<[f32; 3]> = (0..header.terms.into()).map(|term| kernel.sign(term)).collect();
    if args.json {
        let value = json!({
            "model": "kernel", "method": header.method.name(), "terms": header.terms, "signs": signs, "taps": header.taps,
            "radius_mm": header.radius_mm, "reflectance": kernel.reflectance(), "depth_variance_mm2": header.depth_variance,
            "eta": header.eta, "offsets_mm": kernel.offsets().iter().collect::<Vec<_>>(),
            "two_gaussians": kernel.two_gaussians().map(two_gaussians_to_json), "bytes": bytes.len(),
        });
        return print_json(value, file.container());
    }
    outln!("{}: separable kernel, {}, {}", args.file.display(), header.method.name(), human(bytes.len() as u64));
    let minus = signs.iter().flatten().any(|sign| *sign < 0.0);
    outln!("  terms: {}{}, of {} taps", header.terms, if minus { ", some taken away" } else { "" }, header.taps);
    let [red, green, blue] = kernel.reflectance();
    outln!("  radius {:.3} mm, reflectance {red:.3}, {green:.3}, {blue:.3}", header.radius_mm);
    outln!("  depth variance {:.4} mm², refractive index {}, linear Rec. 709", header.depth_variance, header.eta);
    if let Some(TwoGaussians { weight, tau_near, tau_far }) = kernel.two_gaussians() {
        outln!("  two Gaussians: w {weight:?}, τ near {tau_near:?}, far {tau_far:?} mm²");
    }
    print_rest(file.container());
}

fn two_gaussians_to_json(of: &TwoGaussians) -> Value {
    json!({ "w": of.weight, "tau_near_mm2": of.tau_near, "tau_far_mm2": of.tau_far })
}
