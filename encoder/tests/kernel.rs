//! Separable kernels of diffusion profiles.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::kernel::{KernelMethod, Options, Profile, TwoGaussians, compare, encode};
use subsurf_encoder::metrics::kernel::KernelErrors;
use subsurf_encoder::simulate::burley::NormalisedDiffusion;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::mcml;
use subsurf_encoder::simulate::monte_carlo::profile::{Material, Settings};

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

/// Reads a table with a name of its own.
fn read(text: &str) -> Result<Profile, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("profile.csv");
    std::fs::write(&path, text).unwrap();
    Profile::read(&path).map_err(|error| error.to_string())
}

#[test]
fn tables_are_read_as_people_write_them() {
    let rows = "0.5,0.2,0.1,0.05\n1.5,0.02,0.01,0.005\n";
    let plain = read(rows).unwrap();
    assert_eq!(plain.channels[0].edges_mm(), [0.0, 1.0, 2.0], "middles of equal rings");
    let alike = [
        format!("\u{feff}# a comment\nr_mm;red;green;blue\n{}", rows.replace(',', ";").replace('.', ",")),
        rows.replace(',', "\t"),
        rows.replace(',', "  ").replace('\n', " # here\r\n\r\n"),
        "r_from_mm,r_to_mm,rd_red,rd_green,rd_blue\n0,1,0.2,0.1,0.05\n1,2,0.02,0.01,0.005\n".to_owned(),
        "r,rd,g,b,error\n0.5,0.2,0.1,0.05,9\n1.5,0.02,0.01,0.005,9\n".to_owned(),
        // Decimal commas beside tabs, and a tab before a comment.
        rows.replace(',', "\t").replace('.', ",").replace('\n', "\t# here\n"),
    ];
    for text in alike {
        assert_eq!(read(&text).as_ref(), Ok(&plain), "{text}");
    }
    let grey = read("0.5 0.2\n1.5 -0.1\n").unwrap();
    assert_eq!([grey.channels[0].rd(), grey.channels[2].rd()], [&[0.2, 0.0]; 2], "noise below 0 is 0");
    // Points between which R_d falls exponentially: 2π ∫ e^(−r) r dr.
    let points: String =
        (0..=40).map(|k| format!("{},{}\n", f64::from(k) * 0.25, (-f64::from(k) * 0.25).exp())).collect();
    let energy = read(&points).unwrap().reflectance()[1];
    let exact = TAU * (1.0 - 11.0 * (-10.0_f64).exp());
    assert!((energy / exact - 1.0).abs() < 1e-4, "{energy} {exact}");
}

#[test]
fn tables_that_are_none_are_refused_in_one_line() {
    let wrong = [
        ("", "no row of numbers"),
        ("r,g\n", "no row of numbers"),
        ("0.5,0.2\n", "one row of numbers"),
        ("1\n2\n", "1 columns in line 1"),
        ("0,1,2,3\n1,2\n", "2 columns in line 2; expected as many as in the first row"),
        ("0,1\n1,x\n", "1,x in line 2; expected finite numbers"),
        ("0,1\n1,inf\n", "1,inf in line 2"),
        ("0,1\n1,NaN\n", "1,NaN in line 2"),
        ("0,1\n0,2\n", "r = 0 mm after 0 mm in line 2; expected radii that ascend"),
        ("-1,1\n0,2\n", "a radius of -1 mm in line 1"),
        ("0,0\n1,0\n", "adds up to 0 in red"),
        ("r_from_mm,r_to_mm,rd\n0,1,1\n2,3,1\n", "a ring from 2 mm in line 3"),
        ("r_from_mm,r_to_mm,rd\n1,2,1\n2,3,1\n", "a first ring from 1 mm"),
        ("r_from_mm,r_to_mm,rd\n0,1,1\n1,1,1\n", "a radius of 1 mm in line 3"),
        ("0,1e300\n1e200,1e300\n", "in red; expected some light"),
        ("r_from_mm,r_to_mm,rd\n0,1,0.1\n0.99995,1,0.1\n", "r = 1 mm after 1 mm in line 3; expected radii that ascend"),
        // Fields that are missing would shift columns.
        ("0.5,,0.02,0.01,0.009\n1.5,0.02,0.01,0.005,0.001\n", "an empty field in line 1; expected finite numbers"),
        ("\t0.02\t0.01\n1.5\t0.02\t0.01\n", "an empty field in line 1"),
        ("0.5;0.02;\n1.5;0.02;0.01\n", "an empty field in line 1"),
        (",0.02\n0.5,0.02\n1.5,0.01\n", "an empty field in line 1"),
        // Slips are no titles, and there is one title.
        ("0.O5,9,9,9\n0.5,0.2,0.1,0.05\n1.5,0.02,0.01,0.005\n", "0.O5,9,9,9 in line 1; expected finite numbers"),
        ("0,inf\n0.5,0.2\n1.5,0.02\n", "0,inf in line 1"),
        ("-o,1\n0.5,0.2\n1.5,0.02\n", "-o,1 in line 1"),
        ("NaN,1\n0.5,0.2\n1.5,0.02\n", "NaN,1 in line 1"),
        ("r,rd\nmm,1/mm2\n0.5,0.2\n1.5,0.02\n", "mm,1/mm2 in line 2; expected finite numbers, below one title at most"),
        // A blank is no separator beside a comma.
        ("0,5 0,2\n1,5 0,02\n", "0,5 0,2 in line 1"),
        // Sizes that no file of a kernel has.
        ("0,1e-301\n1e150,1e-301\n", "a radius of 9.995e149 mm in red; expected 1e-6 to 1e6 mm: are radii in mm?"),
        ("0,1e190\n1e-100,1e190\n", "mm in red; expected 1e-6 to 1e6 mm"),
        ("0,1e-15\n1e7,1e-15\n", "a radius of 9.995e6 mm in red"),
        // Light in a ring that is too narrow to have an area.
        ("r_from_mm,r_to_mm,rd\n0,1e-200,1\n1e-200,1,0.1\n", "a radius of 0.000e0 mm in red"),
        ("0,1\n1.2e-6,1\n", "mm² in red; expected 1e-12 to 1e12 mm²: are radii in mm?"),
    ];
    for (text, says) in wrong {
        let error = read(text).unwrap_err();
        assert!(error.contains(says) && !error.contains('\n'), "{text:?}: {error}");
    }
    assert!(Profile::read(Path::new("nowhere.csv")).unwrap_err().to_string().contains("nowhere.csv"), "no file");
}

/// Whatever is read becomes a file, by all methods.
#[test]
fn smallest_and_largest_tables_become_kernels() {
    // The last has a core that is narrower than Gaussians of files are.
    let core = "r_from_mm,r_to_mm,rd\n0,1e-6,1e14\n1e-6,3e-5,2.8e10\n";
    for text in ["0,1\n3e-6,1\n", "0,1\n9.9e5,1\n", core] {
        let profile = read(text).unwrap().with_reflectance([0.5; 3]);
        for method in KernelMethod::ALL {
            let kernel = encode(&profile, &with(method, 1)).unwrap().kernel;
            assert!(kernel.to_bytes().is_ok(), "{text:?}, {method:?}: {:?}", kernel.to_bytes());
        }
    }
}

#[test]
fn mcml_files_are_profiles() {
    let folder = tempfile::tempdir().unwrap();
    let mci = [
        "1.0\n1\na.mco A\n400\n0.01 0.02\n4 5 1\n1\n1.0\n1.4 1 100 0.9 0.1\n1.0\n".to_owned(),
        "mcmli2.0\nair 1 0 0 0\nskin 1.4 1 100 0.9\nend\na.mco A\nair\nskin 0.1\nair\nend\npencil\n0\n0.01 0.02 0.1\n\
         4 5 1 1\nRd_r\n400\n1e-4\n1\nend\n"
            .to_owned(),
    ];
    for text in mci {
        let path = folder.path().join("a.mci");
        std::fs::write(&path, text).unwrap();
        let run = mcml::read(&path).unwrap().remove(0);
        let outcome = run.request.run(&()).unwrap();
        let written = mcml::write(&run, &outcome);
        let path = folder.path().join("a.mco");
        std::fs::write(&path, &written).unwrap();
        let profile = Profile::read(&path).unwrap();
        assert!((profile.channels[1].radius_mm() - 1.0).abs() < 1e-9, "five rings of 0.2 mm");
        // All that leaves is in the rings, what is beyond in the last of them; numbers have five digits.
        let left = outcome.reflected.mean + outcome.ballistic_reflected.mean;
        let [found, entered] = [profile.reflectance()[0], left / (1.0 - outcome.specular)];
        assert!((found / entered - 1.0).abs() < 1e-3, "{found} {entered}");
        // Rd_r has a line for each of its five rings.
        let title = written.find("\nRd_r #").unwrap();
        let last = title + written[title..].match_indices('\n').nth(5).unwrap().0;
        for cut in (0..written.len()).step_by(97).chain([last]) {
            let Some(text) = written.get(..cut) else { continue };
            std::fs::write(&path, text).unwrap();
            match Profile::read(&path) {
                Ok(_) => assert!(cut > last, "cut after {cut} bytes, before the last ring's at {last}"),
                Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
            }
        }
    }
}

/// A device does not say how long it is.
#[cfg(unix)]
#[test]
fn mcml_files_without_an_end_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, says) in [("zero.mco", "more than 256 MiB"), ("zero.mci", "more than 1 MiB")] {
        let path = folder.path().join(name);
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        let result = if name.ends_with("mco") { Profile::read(&path).err() } else { mcml::read(&path).err() };
        let error = result.unwrap().to_string();
        assert!(error.contains(says) && !error.contains('\n'), "{error}");
    }
}

/// Light that the surface mirrors never entered: R_d is of what did.
#[test]
fn simulated_profiles_are_per_flux_that_entered() {
    let material = Material::half_space(Medium::measured("skin2").unwrap(), 1.5);
    let simulated = material.simulate(&Settings { packets: 2_000, ..Settings::default() }, &()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("simulated.csv");
    simulated.write_csv(&path).unwrap();
    let [profile, read] =
        [Profile::simulated(&simulated).unwrap(), Profile::read(&path).unwrap()].map(|p| p.reflectance());
    for (c, channel) in simulated.channels.iter().enumerate() {
        let entered = 1.0 - channel.specular;
        assert!((entered - 0.96).abs() < 1e-12, "((1.5 - 1) / (1.5 + 1))²: {entered}");
        let reflected = channel.reflected.mean / entered;
        assert!((profile[c] / reflected - 1.0).abs() < 1e-9, "{} {reflected}", profile[c]);
        let within = (channel.reflected.mean - channel.beyond) / entered;
        assert!((read[c] / within - 1.0).abs() < 1e-5, "{} {within}", read[c]);
    }
}

#[test]
fn shipped_profiles_are_those_of_the_materials() {
    assert_eq!(shipped::names().count(), 11, "section G has eleven");
    for name in shipped::names() {
        let dipole =
            Profile::dipole(&Medium::measured(name).unwrap(), Medium::measured_eta(name)).unwrap().reflectance();
        let traced = shipped::profile(name).unwrap().reflectance();
        // Closer than the two kinds of chicken are to each other.
        let close = dipole.iter().zip(&traced).all(|(dipole, traced)| (dipole - traced).abs() < 0.018);
        assert!(close, "{name}: dipole {dipole:?}, photons {traced:?}");
    }
    let (again, table) = shipped::simulate("chicken2", 1.3, 100_000, &()).unwrap();
    for (written, simulated) in read(&table).unwrap().reflectance().into_iter().zip(again.reflectance()) {
        assert!((written / simulated - 1.0).abs() < 1e-4, "the table and the profile: {written} {simulated}");
    }
    let known = shipped::profile("chicken2").unwrap().reflectance();
    for (again, known) in again.reflectance().into_iter().zip(known) {
        assert!((again / known - 1.0).abs() < 0.04, "{again} {known}");
    }
    assert!(
        shipped::simulate("spectralon", 1.3, 10, &()).unwrap_err().to_string().contains("does not absorb"),
        "no kernel"
    );
}

/// Jensen et al. 2001 and Burley 2015 beside photons.
#[test]
fn models_in_closed_form_are_as_published() {
    for (name, bound) in [("wholemilk", 0.016), ("marble", 0.013), ("skin2", 0.02)] {
        let (medium, traced) = (Medium::measured(name).unwrap(), shipped::profile(name).unwrap());
        let dipole = Profile::dipole(&medium, Medium::measured_eta(name)).unwrap().reflectance();
        for (dipole, traced) in dipole.into_iter().zip(traced.reflectance()) {
            assert!((dipole / traced - 1.0).abs() < bound, "{name}: dipole {dipole}, photons {traced}");
        }
    }
    let burley = NormalisedDiffusion { albedo: 0.6, mean_free_path_mm: 0.5 };
    // ∫ R_d 2πr dr by midpoints: A in all, T(1) beyond 1 mm.
    let integral = |from: f64| {
        let step = 1e-4;
        (0..400_000)
            .map(|k| from + (f64::from(k) + 0.5) * step)
            .map(|r| burley.rd(r) * 2.0 * PI * r * step)
            .sum::<f64>()
    };
    assert!((integral(0.0) - 0.6).abs() < 1e-6, "{}", integral(0.0));
    assert!((integral(1.0) - burley.tail(1.0)).abs() < 1e-6, "{} {}", integral(1.0), burley.tail(1.0));
    let medium = Medium::measured("skin1").unwrap();
    let profile = Profile::normalised_diffusion([0.4, 0.2, 0.1], &medium).unwrap();
    assert!((profile.reflectance()[0] - 0.4).abs() < 1e-4, "{:?}", profile.reflectance());
    let errors = encode(&profile, &Options::default()).unwrap().errors;
    assert!(errors != KernelErrors::default() && errors.edge < 1e-5, "{errors:?}");
}
