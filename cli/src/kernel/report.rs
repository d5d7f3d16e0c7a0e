//! What was made, and how far off it is.

use std::path::Path;

use subsurf_encoder::kernel::{Encoded, KernelMethod, Options};
use subsurf_encoder::metrics::kernel::KernelErrors;
use subsurf_viewer::human;

use crate::outln;

/// The kernel that was written to a file.
pub(super) fn kernel(path: &Path, encoded: &Encoded, bytes: usize) {
    let kernel = &encoded.kernel;
    let [r, g, b] = kernel.reflectance;
    let passes = 2 * kernel.terms.len();
    outln!(
        "{}: {}, {passes} convolutions of {} taps within {:.2} mm, {}",
        path.display(),
        kernel.method.name(),
        2 * kernel.offsets.len() - 1,
        kernel.radius,
        human(bytes as u64)
    );
    outln!("  reflectance {r:.4} {g:.4} {b:.4}, refractive index {}", kernel.eta);
    if let Some(two) = &kernel.two_gaussians {
        // As the command takes them, to the last bit.
        let text = |values: [f32; 3]| values.map(|value| value.to_string()).join("/");
        let [near, far, weight] = [two.tau_near, two.tau_far, two.weight].map(text);
        let reflectance = text(kernel.reflectance);
        outln!("  --near {near} --far {far} --weight {weight} --reflectance {reflectance} --eta {}", kernel.eta);
    }
    outln!("  errors: {}", words(&encoded.errors));
}

fn words(errors: &KernelErrors) -> String {
    let KernelErrors { frobenius, l1, dot, edge } = errors;
    format!("Frobenius {frobenius:.3}, L1 {l1:.3}, dot {:.1} %, edge {:.1} %", 100.0 * dot, 100.0 * edge)
}

/// Errors of several methods, a line each.
pub(super) fn comparison(options: &[Options], errors: &[KernelErrors]) {
    outln!("method          terms  Frobenius     L1    dot   edge");
    for (options, errors) in options.iter().zip(errors) {
        let KernelErrors { frobenius, l1, dot, edge } = errors;
        let guide =
            if options.method == KernelMethod::Guided { format!("   k = {}", options.guide) } else { String::new() };
        outln!(
            "{:<15} {:>5}  {frobenius:>9.3}  {l1:>5.3}  {:>4.1} %  {:>4.1} %{guide}",
            options.method.name(),
            options.terms,
            100.0 * dot,
            100.0 * edge
        );
    }
}
