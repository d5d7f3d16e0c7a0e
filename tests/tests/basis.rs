//! Separable bases: as close to the gather as they should be, of every kind of file, the same on any number of threads.

use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{Bssrdf, Section};
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis, fit_basis, with_basis};
use subsurf_encoder::bssrdf::{profiles, write_file};
use subsurf_encoder::metrics::bssrdf::Light;
use subsurf_encoder::metrics::psnr_db;
use subsurf_encoder::synthetic::Shape;
use subsurf_shaders::cpu;
use subsurf_shaders::separable::ProjectedBasis;
use subsurf_tests::frames::material_of;
use subsurf_tests::{format_basis, format_example, shape};

fn of_size(terms: usize, gaussians: usize, steps: usize) -> BasisOptions {
    BasisOptions { choice: BasisChoice::Size(BasisSize { terms, gaussians }), steps }
}

/// PSNR in dB of the basis of a file against its gather, under uniform, disc and line light.
fn from_gather_db(file: &[u8]) -> [f64; 3] {
    let material = Bssrdf::parse(file).unwrap();
    let basis = ProjectedBasis::of(&material).expect("a basis");
    let size = [material.header().width, material.header().height];
    Light::ALL.map(|light| {
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x as usize, y as usize]));
        let irradiance: Vec<[f32; 3]> =
            pixels.map(|pixel| [light.irradiance(pixel, size.map(|side| side as usize)); 3]).collect();
        let expected = cpu::gather(&material, &irradiance, [0, 0], size);
        let largest = expected.iter().flatten().copied().fold(1e-37, f32::max);
        let normalised = |image: &[[f32; 3]]| -> Vec<[f64; 3]> {
            image.iter().map(|rgb| rgb.map(|value| f64::from(value / largest))).collect()
        };
        psnr_db(&normalised(&expected), &normalised(&basis.exitance(&irradiance)))
    })
}

#[test]
fn the_joint_fit_is_closer_than_its_start() {
    for name in ["jade", "chessboard"] {
        let file = material_of(name);
        let [start, joint] = [0, 6].map(|steps| from_gather_db(&add_basis(&file, &of_size(2, 4, steps), &()).unwrap()));
        println!("{name}: {start:.1?} dB to begin with, {joint:.1?} dB");
        let least = [56.0, 52.0, 50.0];
        for k in 0..3 {
            assert!(joint[k] >= least[k], "{name}, {:?}: {} dB", Light::ALL[k], joint[k]);
            assert!(joint[k] > start[k], "{name}, {:?}: {} dB, {} dB before", Light::ALL[k], joint[k], start[k]);
        }
    }
}

#[test]
fn the_cheapest_size_that_is_close_enough_is_taken() {
    let file = material_of("jade");
    let sizes: Vec<BasisSize> = [20.0, 45.0, 200.0]
        .into_iter()
        .map(|least| {
            let options = BasisOptions { choice: BasisChoice::Psnr(least), steps: 3 };
            let file = add_basis(&file, &options, &()).unwrap();
            let reached = from_gather_db(&file).into_iter().fold(f64::INFINITY, f64::min);
            assert!(reached > least.min(50.0) - 1.0, "{least} dB were asked for: {reached} dB");
            Bssrdf::parse(&file).unwrap().basis().unwrap().size()
        })
        .collect();
    assert_eq!(sizes[0], BasisSize { terms: 1, gaussians: 2 }, "the cheapest");
    assert_eq!(sizes[2], BasisSize { terms: 2, gaussians: 4 }, "the closest");
    assert!(sizes[1].terms <= sizes[2].terms, "{sizes:?}");
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let file = material_of("chessboard");
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| add_basis(&file, &of_size(2, 3, 2), &()).unwrap())
    };
    let one = with(1);
    assert!(one == with(2) && one == with(7), "the same file");
}

/// Of every model and coding, on patches that are not square, tiny, or smaller than the window.
#[test]
fn every_kind_of_file_takes_a_basis() {
    let odd = shape([9, 6], 3, Addressing::Mirror);
    let tiny = Shape { size: [1, 1], radius: 0, samples: 2, base_materials: 1, addressing: Addressing::Clamp };
    let files = [
        ("K = 1", odd.k_bmpp(1, Coding::Exact, false)),
        ("K = 2", odd.bmpp()),
        ("24 bits", odd.k_bmpp(2, Coding::SmallRatios, false)),
        ("16 bits", odd.k_bmpp(2, Coding::Palette, true)),
        ("K = 3", odd.k_bmpp(3, Coding::Exact, false)),
        ("K = 5", odd.k_bmpp(5, Coding::Exact, true)),
        ("per pixel", odd.per_pixel()),
        ("one pixel", tiny.bmpp()),
        ("a row", Shape { size: [17, 1], radius: 6, samples: 9, ..odd }.bmpp()),
        ("40 nodes", Shape { samples: 40, addressing: Addressing::Repeat, ..odd }.bmpp()),
        ("one material", Shape { base_materials: 1, ..odd }.bmpp()),
        ("the example", format_example()),
    ];
    for (name, file) in files {
        let reached = from_gather_db(&add_basis(&file, &of_size(2, 3, 3), &()).unwrap());
        println!("{name}: {reached:.1?} dB");
        assert!(reached.iter().all(|db| *db > 30.0), "{name}: {reached:?} dB");
    }
}

/// Materials that give back nothing, next to nothing, or far too much.
#[test]
fn black_and_brilliant_materials_are_drawn_or_refused() {
    // 5 × 4 pixels of 0.5 mm, R = 2, one base material with one value a channel at all of its three nodes.
    let of_channels = |logs: [f32; 3]| {
        let shape = Shape { size: [5, 4], radius: 2, samples: 3, base_materials: 1, addressing: Addressing::Clamp };
        let header = BssrdfHeader { model: 1, ..shape.header() };
        let sections = [profiles(logs.into_iter().cycle().take(9), false), (Section::BaseIndices, vec![0; 20])];
        write_file(&header, &sections)
    };
    let filled = |log: f32| of_channels([log; 3]);
    // So dark that nothing is left in single precision, in all channels or in one.
    for logs in [[-1000.0; 3], [-2.0, -2.5, -1000.0], [-1000.0, -3.0, -1000.0]] {
        let file = of_channels(logs);
        let fit = fit_basis(&Bssrdf::parse(&file).unwrap(), &of_size(2, 2, 2), &()).unwrap();
        assert!(fit.psnr_db > 10.0, "{logs:?}: {} dB", fit.psnr_db);
        let file = with_basis(&file, &fit).unwrap();
        let basis = ProjectedBasis::of(&Bssrdf::parse(&file).unwrap()).unwrap();
        for (found, log) in basis.albedo().iter().flat_map(|albedo| albedo.iter().zip(logs)) {
            let expected = 25.0 * f64::from(log).exp() * 0.25;
            assert!((f64::from(*found) - expected).abs() < 0.02 * expected + 1e-30, "{logs:?}: {found}");
        }
    }
    for log in [-87.0, -40.0, -12.0, 0.0] {
        let file = add_basis(&filled(log), &of_size(2, 2, 2), &()).unwrap();
        let basis = ProjectedBasis::of(&Bssrdf::parse(&file).unwrap()).unwrap();
        let albedo = basis.albedo();
        let expected = 25.0 * f64::from(log).exp() * 0.25;
        assert!(
            albedo.iter().flatten().all(|found| (f64::from(*found) - expected).abs() < 0.02 * expected + 1e-30),
            "{log}"
        );
    }
    let error = add_basis(&filled(40.0), &of_size(1, 2, 1), &()).unwrap_err();
    assert!(error.is_callers() && error.to_string().contains("more light than it takes"), "{error}");
}

#[test]
fn everything_else_in_the_file_stays() {
    let file = material_of("jade");
    let kept = |file: &[u8]| -> Vec<(Section, Vec<u8>)> {
        let container = Container::parse(file).unwrap();
        let others = container.entries().filter(|entry| entry.section != Section::SeparableBasis);
        others.map(|entry| (entry.section, container.section(entry.section, Crc::Check).unwrap().1.to_vec())).collect()
    };
    let options = of_size(1, 2, 1);
    let once = add_basis(&file, &options, &()).unwrap();
    assert_eq!(kept(&once), kept(&file));
    assert!(once == add_basis(&once, &options, &()).unwrap(), "in place of the one that was there");
    let error = add_basis(b"no file", &options, &()).unwrap_err();
    assert!(error.is_callers(), "{error}");
    let error = with_basis(&once, &format_basis()).unwrap_err();
    assert!(error.to_string().contains("sepb"), "another S: {error}");
}
