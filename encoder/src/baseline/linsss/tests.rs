//! What the authors claim, on materials of which the answer is known.

use super::convolve::gaussian;
use super::*;
use crate::capture::{CaptureWriter, Overrides, Scalar, Sidecar};
use crate::metrics::bssrdf::Light;
use crate::metrics::psnr_db;

const SIZE: [usize; 2] = [24, 20];
const RADIUS: usize = 6;
const SIGMAS: [f64; 2] = [0.8, 2.0];

/// Irradiance and exitance under each light.
type Lit = Vec<(Vec<f32>, Vec<[f64; 3]>)>;

/// Fit of so many Gaussians to the capture of a material that is a sum of two, with weights by pixel, and the capture under each light.
fn fitted(weights: impl Fn(usize, [usize; 2]) -> f64, gaussians: usize) -> (LinSss, Lit) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sum.npy");
    let kernels = SIGMAS.map(|sigma| gaussian(sigma, RADIUS));
    let rd = |from: [usize; 2], to: [usize; 2]| -> f64 {
        let [dx, dy] = [0, 1].map(|axis| from[axis].abs_diff(to[axis]));
        let of = |h: usize| 0.5 * (weights(h, from) + weights(h, to)) * kernels[h][dx] * kernels[h][dy];
        (0..2).map(of).sum()
    };
    let pixels: Vec<[usize; 2]> = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])).collect();
    let reach = i64::try_from(RADIUS).unwrap();
    let window = |from: [usize; 2]| -> Vec<f32> {
        let steps = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| [dx, dy]));
        let value = |step: [i64; 2]| {
            let to = [0, 1].map(|axis| usize::try_from(i64::try_from(from[axis]).unwrap() + step[axis]).ok());
            match to {
                [Some(x), Some(y)] if x < SIZE[0] && y < SIZE[1] => rd(from, [x, y]),
                _ => 0.0,
            }
        };
        #[allow(clippy::cast_possible_truncation, reason = "captures of single precision")]
        let rgb = |step| [1.0, 0.7, 0.4].map(|colour| (colour * value(step)) as f32);
        steps.flat_map(rgb).collect()
    };
    let sidecar = Sidecar { pitch_mm: 1.0, addressing: Addressing::Clamp, eta: 1.4, simulated: None };
    let writer = CaptureWriter { path: &path, size: SIZE, radius: RADIUS, scalar: Scalar::F32, sidecar: &sidecar };
    writer.write(|sink| pixels.iter().try_for_each(|from| sink(&window(*from)))).unwrap();
    let capture = Capture::open(&path, &Overrides::default()).unwrap();
    let lit = |light: Light| {
        let irradiance: Vec<f32> = pixels.iter().map(|pixel| light.irradiance(*pixel, SIZE)).collect();
        let mut exitance = vec![[0.0; 3]; pixels.len()];
        for (from, e) in pixels.iter().zip(&irradiance) {
            for (to, sum) in pixels.iter().zip(&mut exitance) {
                if [0, 1].iter().all(|axis| from[*axis].abs_diff(to[*axis]) <= RADIUS) {
                    let value = rd(*from, *to) * f64::from(*e);
                    [1.0, 0.7, 0.4].iter().zip(sum).for_each(|(colour, sum)| *sum += colour * value);
                }
            }
        }
        (irradiance, exitance)
    };
    (fit(&capture, gaussians, &()).unwrap(), Light::ALL.map(lit).to_vec())
}

/// Least PSNR in dB under all lights, by exact convolutions and by the pyramid.
fn least_db(model: &LinSss, lit: &[(Vec<f32>, Vec<[f64; 3]>)]) -> [f64; 2] {
    let db = |draw: &dyn Fn(&[f32]) -> Vec<[f64; 3]>| {
        let of = |(irradiance, expected): &(Vec<f32>, Vec<[f64; 3]>)| {
            let peak = expected.iter().flatten().copied().fold(0.0, f64::max);
            let scaled = |image: Vec<[f64; 3]>| image.iter().map(|rgb| rgb.map(|v| v / peak)).collect::<Vec<_>>();
            psnr_db(&scaled(expected.clone()), &scaled(draw(irradiance)))
        };
        lit.iter().map(of).fold(f64::INFINITY, f64::min)
    };
    [db(&|light| model.exitance(light)), db(&|light| model.exitance_by_pyramid(light))]
}

#[test]
fn a_homogeneous_sum_of_gaussians_is_found_again() {
    let (model, lit) = fitted(|h, _| [0.3, 0.5][h], 2);
    for (h, sigma) in SIGMAS.into_iter().enumerate() {
        for found in model.sigmas[h] {
            assert!((f64::from(found) / sigma - 1.0).abs() < 0.05, "{found} for {sigma}");
        }
    }
    let [exact, pyramid] = least_db(&model, &lit);
    println!("homogeneous: {exact:.1} dB by convolutions, {pyramid:.1} dB by the pyramid");
    assert!(exact > 60.0, "{exact} dB");
    // Where nothing changes from pixel to pixel, the product of convolutions is the convolution: what is left is the pyramid's own.
    assert!(pyramid > 32.0, "{pyramid} dB");
}

#[test]
fn two_colours_are_found_again_and_the_shortcut_costs_some_of_it() {
    let checks = |h: usize, [x, y]: [usize; 2]| if (x / 4 + y / 4) % 2 == 0 { [0.6, 0.1][h] } else { [0.1, 0.6][h] };
    let (model, lit) = fitted(checks, 2);
    let [exact, pyramid] = least_db(&model, &lit);
    println!("two colours: {exact:.1} dB by convolutions, {pyramid:.1} dB by the pyramid");
    assert!(exact > 50.0, "{exact} dB");
    assert!(pyramid > 28.0 && pyramid < exact, "{pyramid} dB");
    let bytes = model.to_bytes();
    assert_eq!(bytes.len(), 16 + 2 * 24 * (24 * 20 + 1), "double precision");
    let read = LinSss::parse(&bytes, 1.0).expect("what was written");
    assert_eq!((read.size, read.radius, &read.weights), (SIZE, RADIUS, &model.weights), "what was written");
    for (read, sigma) in read.sigmas.iter().flatten().zip(model.sigmas.iter().flatten()) {
        assert!((read / sigma - 1.0).abs() < 1e-5, "{read} for {sigma}");
    }
    assert!(LinSss::parse(&bytes[..bytes.len() - 1], 1.0).is_none(), "cut");
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hole.npy");
    let sidecar = Sidecar { pitch_mm: 1.0, addressing: Addressing::Clamp, eta: 1.4, simulated: None };
    let writer = CaptureWriter { path: &path, size: [3, 2], radius: 1, scalar: Scalar::F32, sidecar: &sidecar };
    writer.write(|sink| (0..6).try_for_each(|pixel| sink(&[if pixel == 4 { 0.0 } else { 1.0 }; 27]))).unwrap();
    let capture = Capture::open(&path, &Overrides::default()).unwrap();
    for (gaussians, reason) in [(2, "(1, 1) was not measured"), (9, "1 to 8"), (0, "1 to 8")] {
        let error = fit(&capture, gaussians, &()).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}
