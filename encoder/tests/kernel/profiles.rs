//! Profiles: tables of people and of MCML, those that come with the library, models in closed form.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use subsurf_decoder::Bssrdf;
use subsurf_encoder::bssrdf::{HomogeneousPatch, homogeneous};
use subsurf_encoder::kernel::profile::{of_base, shipped};
use subsurf_encoder::kernel::{KernelMethod, Options, Profile, TwoGaussians, encode};
use subsurf_encoder::metrics::kernel::KernelErrors;
use subsurf_encoder::simulate::burley::NormalisedDiffusion;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::mcml;
use subsurf_encoder::simulate::monte_carlo::profile::{Material, Settings};

use super::with;

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
        "\"r_from_mm\",\"r_to_mm\", \"rd_red\"\n\"0\",1,0.2,0.1,0.05\n1,2,0.02,0.01,0.005\n".to_owned(),
        "\"r_from_mm\";\"r_to_mm\"\n0;\"1\";0,2;0,1;0,05\n1;2;0,02;0,01;0,005\n".to_owned(),
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
        ("\"r, mm\",rd\n\"0,1\n1,1\n", "\"0,1 in line 2"),
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

/// Files of one profile everywhere have its light, and its values beyond the first pixels.
#[test]
fn homogeneous_files_have_the_profile() {
    let two = TwoGaussians { weight: [0.4, 0.6, 0.7], tau_near: [0.04, 0.03, 0.02], tau_far: [1.2, 0.4, 0.2] };
    let profile = Profile::of_two_gaussians(&two, [0.8, 0.6, 0.5]).unwrap();
    let patch = HomogeneousPatch { side: 3, radius: 9, pitch_mm: 0.4, eta: 1.4 };
    let file = homogeneous(&profile, &patch).unwrap();
    let material = Bssrdf::parse(&file).unwrap();
    for (c, albedo) in material.albedo([1, 2]).into_iter().enumerate() {
        assert!((f64::from(albedo) - profile.reflectance()[c]).abs() < 1e-5, "{albedo}");
        // The mean over a pixel four to the right.
        let at = |k: u32| 0.4 * ((f64::from(k) + 0.5) / 16.0 - 0.5);
        let places = (0..256).map(|k| (1.6 + at(k % 16)).hypot(at(k / 16)));
        let mean = places.map(|r| profile.channels[c].at(r)).sum::<f64>() / 256.0;
        let far = f64::from(material.rd([0, 0], [4, 0])[c]);
        assert!((far / mean - 1.0).abs() < 0.05, "{far} {mean}");
    }
    let seen = of_base(&material, 0).unwrap();
    assert!((seen.reflectance()[0] / 0.8 - 1.0).abs() < 0.05, "{:?}", seen.reflectance());
    for wrong in [
        HomogeneousPatch { side: 0, ..patch },
        HomogeneousPatch { radius: 0, ..patch },
        HomogeneousPatch { pitch_mm: 0.0, ..patch },
    ] {
        assert!(homogeneous(&profile, &wrong).unwrap_err().to_string().contains("expected pixels"), "{wrong:?}");
    }
}
