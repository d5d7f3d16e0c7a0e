//! Separable kernels of diffusion profiles.

mod profiles;

use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::kernel::{KernelMethod, Options, Profile, TwoGaussians, compare, encode};
use subsurf_encoder::metrics::kernel::KernelErrors;
use subsurf_encoder::simulate::diffusion::Medium;

fn skin() -> Profile {
    shipped::profile("skin1").unwrap()
}

fn with(method: KernelMethod, terms: usize) -> Options {
    Options { method, terms, ..Options::default() }
}

/// Eq. S.5, pixel by pixel: light that is a sum of a function of x and one of y.
#[test]
fn pre_integrated_is_exact_for_additively_separable_light() {
    const HALF: i32 = 24;
    for radial in skin().channels {
        let radial = radial.cut(radial.radius_of(1e-3));
        let energy = radial.energy();
        let width = radial.radius_mm() / (f64::from(HALF) - 0.5);
        // Integrals from −∞ to the edges of pixels, of a_p and of R_d.
        let along = |x: f64| x.signum() * radial.along_axis_to(x.abs());
        let corner = |x: f64, y: f64| x.signum() * y.signum() * radial.corner(x.abs(), y.abs());
        let edge = |i: i32| (f64::from(i) - 0.5) * width;
        let a = |i: i32| along(edge(i + 1)) - along(edge(i));
        let rd = |i: i32, j: i32| {
            let [x0, x1, y0, y1] = [edge(i), edge(i + 1), edge(j), edge(j + 1)];
            corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
        };
        // Steps and waves along both axes.
        let e = |i: i32, j: i32| f64::from(i > 3) + 0.5 * (0.7 * f64::from(j)).sin() + f64::from(i * i % 7) * 0.1 + 1.0;
        let (mut exact, mut separable) = (0.0, 0.0);
        for (i, j) in (-HALF..=HALF).flat_map(|i| (-HALF..=HALF).map(move |j| (i, j))) {
            exact += rd(i, j) * e(i, j);
            separable += a(i) * a(j) / energy * e(i, j);
        }
        assert!((separable / exact - 1.0).abs() < 1e-5, "{separable}, exact {exact}");
        assert!((a(2) - radial.along_axis(2.0 * width) * width).abs() < 0.1 * a(2), "a density along the axis");
    }
    let errors = encode(&skin(), &Options::default()).unwrap().errors;
    assert!(errors.edge < 1e-5, "{errors:?}");
    assert!(errors.dot > 0.01, "a disc is not additively separable: {errors:?}");
}

/// Weights of all guides beside those that are pre-integrated: the smaller k, the closer. Both the middle and what is far gain by k.
#[test]
fn guides_favour_near_or_far_scattering() {
    let options = Options { taps: 65, ..Options::default() };
    let weights = |options: Options| {
        let kernel = encode(&skin(), &options).unwrap().kernel;
        let taps: Vec<[f64; 3]> = kernel.terms[0].weights.iter().map(|rgb| rgb.map(f64::from)).collect();
        (kernel.offsets, taps)
    };
    let (offsets, pre_integrated) = weights(options);
    let guided =
        [0.0, 1.55, 2.0, 4.0].map(|guide| weights(Options { method: KernelMethod::Guided, guide, ..options }).1);
    for c in 0..3 {
        let total: f64 = pre_integrated.iter().map(|own| own[c]).sum();
        let distance = |guided: &Vec<[f64; 3]>| {
            guided.iter().zip(&pre_integrated).map(|(guided, own)| (guided[c] - own[c]).abs()).sum::<f64>() / total
        };
        let distances = guided.each_ref().map(distance);
        assert!(distances.is_sorted_by(|a, b| a < b), "channel {c}: {distances:?}");
        assert!(distances[1] < 0.15, "channel {c}: {distances:?}");
        let middles = guided.each_ref().map(|taps| taps[0][c] / pre_integrated[0][c]);
        assert!(middles.is_sorted_by(|a, b| a < b), "channel {c}: {middles:?}");
        assert!(middles[0] < 1.0 && middles[3] > 1.0, "channel {c}: {middles:?}");
        let mean = |taps: &Vec<[f64; 3]>| {
            offsets.iter().zip(taps).map(|(offset, rgb)| f64::from(*offset) * rgb[c]).sum::<f64>()
        };
        let means = guided.each_ref().map(mean);
        assert!(means.is_sorted_by(|near, far| near < far), "channel {c}: {means:?}");
    }
}

#[test]
fn more_terms_are_closer() {
    let sums = |method| (1..=6).map(|terms| with(method, terms)).collect::<Vec<_>>();
    for name in shipped::names() {
        let profile = shipped::profile(name).unwrap();
        let [svd, gaussians] =
            [KernelMethod::Svd, KernelMethod::Gaussians].map(|method| compare(&profile, &sums(method)).unwrap());
        for errors in [&svd, &gaussians] {
            assert!(errors.is_sorted_by(|a, b| a.frobenius > b.frobenius), "{name}: {errors:?}");
        }
        // In the Frobenius norm, scaling to the profile's energy costs the more the fewer terms there are.
        let closer = |from: usize, error: fn(&KernelErrors) -> f64| {
            svd[from - 1..].iter().zip(&gaussians[from - 1..]).all(|(svd, gaussians)| error(svd) < error(gaussians))
        };
        assert!(closer(2, |errors| errors.l1), "{name}: {svd:?} {gaussians:?}");
        assert!(closer(5, |errors| errors.frobenius), "{name}: {svd:?} {gaussians:?}");
    }
}

#[test]
fn kernels_keep_the_energy() {
    let profile = skin();
    for method in KernelMethod::ALL {
        let terms = if matches!(method, KernelMethod::Svd | KernelMethod::Gaussians) { 3 } else { 1 };
        for taps in [5, 25, 65] {
            let kernel = encode(&profile, &Options { taps, ..with(method, terms) }).unwrap().kernel;
            assert_eq!(kernel.offsets.len(), taps / 2 + 1, "one side and the middle");
            assert!(kernel.offsets[0] == 0.0 && kernel.offsets.is_sorted_by(|a, b| a < b), "{:?}", kernel.offsets);
            assert!(kernel.offsets[taps / 2] < kernel.radius, "{:?} {}", kernel.offsets, kernel.radius);
            assert!(kernel.tail.is_sorted_by(|a, b| (0..3).all(|c| a[c] >= b[c])), "{:?}", kernel.tail);
            assert_eq!(kernel.tail[63], [0.0; 3], "nothing beyond the radius");
            for (c, total) in profile.reflectance().into_iter().enumerate() {
                let sum = |term: &subsurf_encoder::kernel::Term| {
                    let both = term.weights[1..].iter().map(|rgb| 2.0 * f64::from(rgb[c])).sum::<f64>();
                    f64::from(term.sign[c]) * (both + f64::from(term.weights[0][c])).powi(2)
                };
                let energy: f64 = kernel.terms.iter().map(sum).sum();
                assert!((energy / total - 1.0).abs() < 1e-4, "{method:?}: {energy} of {total}");
                assert!((f64::from(kernel.tail[0][c]) / total - 1.0).abs() < 1e-5, "{:?} {total}", kernel.tail[0]);
            }
            assert!(kernel.to_bytes().is_ok(), "{method:?}: the decoder reads it");
        }
    }
}

#[test]
fn files_do_not_hang_on_the_number_of_threads() {
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let of = |method| encode(&skin(), &with(method, 1)).unwrap().kernel.to_bytes().unwrap();
            KernelMethod::ALL.map(of)
        })
    };
    assert_eq!(bytes(1), bytes(2), "the same bytes");
}

#[test]
fn an_artists_gaussians_come_back() {
    let two = TwoGaussians { weight: [0.4, 0.5, 0.6], tau_near: [0.05, 0.03, 0.02], tau_far: [1.2, 0.5, 0.3] };
    let profile = Profile::of_two_gaussians(&two, [0.5; 3]).unwrap();
    let by_hand = Options { two_gaussians: Some(two), ..with(KernelMethod::TwoGaussians, 1) };
    let kernel = encode(&profile, &by_hand).unwrap().kernel;
    assert_eq!((kernel.two_gaussians, kernel.depth_variance), (Some(two), 1.2), "as they are given");
    let fitted = encode(&profile, &with(KernelMethod::TwoGaussians, 1)).unwrap();
    let found = fitted.kernel.two_gaussians.unwrap();
    for c in 0..3 {
        let pairs = [(found.weight, two.weight), (found.tau_near, two.tau_near), (found.tau_far, two.tau_far)];
        assert!(pairs.iter().all(|(found, given)| (found[c] / given[c] - 1.0).abs() < 0.1), "{found:?}");
    }
    assert!(fitted.errors.edge < 0.01, "{:?}", fitted.errors);
    // In the plane, the artist's profile is a sum of two Gaussians.
    let sum = encode(&profile, &with(KernelMethod::Gaussians, 2)).unwrap().errors;
    // Rings are a twentieth of their radius wide.
    assert!(sum.frobenius < 0.05, "{sum:?}");
    let wrong = TwoGaussians { tau_near: [2.0; 3], ..two };
    let error = Profile::of_two_gaussians(&wrong, [0.5; 3]).unwrap_err().to_string();
    assert!(error.contains("expected the near one to be narrower"), "{error}");
}

#[test]
fn requests_that_make_no_sense_are_refused() {
    let base = Options::default();
    let requests = [
        (Options { taps: 24, ..base }, "24 taps; expected an odd number from 5 to 65"),
        (Options { taps: 67, ..base }, "67 taps"),
        (Options { terms: 0, ..base }, "0 terms; expected 1 to 6"),
        (Options { terms: 2, ..base }, "2 terms of method pre-integrated; expected 1, or the methods svd or gaussians"),
        (with(KernelMethod::Svd, 7), "7 terms; expected 1 to 6"),
        (Options { guide: f64::NAN, ..base }, "a guide of NaN"),
        (Options { eta: 0.5, ..base }, "a refractive index of 0.5; expected 1 to 4"),
    ];
    for (options, says) in requests {
        let error = encode(&skin(), &options).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let error = encode(&skin().with_reflectance([2.0, 0.5, 0.5]), &base).unwrap_err().to_string();
    assert!(error.contains("adds up to 2.0000 in red; expected a reflectance up to 1"), "{error}");
    let more = skin().with_reflectance([1.0, 0.5, 1.00001]);
    assert!(encode(&more, &base).is_err(), "more than rounding");
    let medium = Medium::measured("skin1").unwrap();
    for (sigma_a, sigma_s) in [([0.1, 0.0, 0.1], medium.sigma_s), (medium.sigma_a, [1.0, 0.0, 1.0])] {
        let error = Profile::dipole(&Medium { sigma_a, sigma_s }, 1.3).unwrap_err().to_string();
        assert!(error.contains("in green; expected media that scatter and absorb"), "{error}");
    }
}

/// Sums of rings are rounded: none may be refused by that.
#[test]
fn all_light_may_come_back() {
    for name in shipped::names() {
        for factor in [1.0 - 1e-9, 1.0, 1.0 + 1e-9] {
            let kernel = encode(&shipped::profile(name).unwrap().with_reflectance([factor; 3]), &Options::default());
            let kernel = kernel.unwrap().kernel;
            assert!(
                kernel.reflectance.iter().all(|share| (0.999_999..=1.0).contains(share)),
                "{:?}",
                kernel.reflectance
            );
            assert!(kernel.to_bytes().is_ok(), "{name}: the decoder reads it");
        }
    }
}
