//! From images to a file and back.

use glam::Vec3;
use subsurf_decoder::btf::factored::ExpansionMemory;
use subsurf_decoder::btf::{Evaluate, FactoredBtf, Grid};

use crate::btf::factored::{CoreSize, Options, Prepared, Sizes, StageSize};
use crate::btf::{Ranks, TruncatedSvd};
use crate::capture::{Images, Source};
use crate::error::{Error, Result};
use crate::metrics::btf::{BtfError, compare};
use crate::picture::PixelFormat;

/// Two colours in stripes on waves, 12 × 12 pixels.
struct Waves {
    directions: Vec<Vec3>,
    white: Option<f32>,
}

const REACH_RAD: f32 = std::f32::consts::FRAC_PI_3;

impl Waves {
    fn new(white: Option<f32>) -> Self {
        let ring = |theta: f32, count: usize| {
            let unit = move |k: usize| {
                let phi = std::f32::consts::TAU * k as f32 / count as f32;
                Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
            };
            (0..count).map(unit)
        };
        let directions = ring(0.0, 1).chain(ring(0.5 * REACH_RAD, 6)).chain(ring(REACH_RAD, 12)).collect();
        Self { directions, white }
    }
}

impl Source for Waves {
    fn label(&self) -> String {
        "waves".to_owned()
    }

    fn lights(&self) -> Vec<Vec3> {
        self.directions.clone()
    }

    fn views(&self) -> Vec<Vec3> {
        self.directions.clone()
    }

    fn size(&self) -> [u32; 2] {
        [12, 12]
    }

    fn format(&self) -> PixelFormat {
        if self.white.is_some() { PixelFormat::Display8 } else { PixelFormat::Linear }
    }

    fn white(&self) -> f32 {
        self.white.unwrap_or(1.0)
    }

    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        let (light, view) = (self.directions[light], self.directions[view]);
        let half = (light + view).normalize();
        let pixel = |k: usize| {
            let (x, y) = ((k % 12) as f32, (k / 12) as f32);
            let normal = Vec3::new(0.4 * (0.9 * x).sin(), 0.3 * (0.6 * y).cos(), 1.0).normalize();
            let (diffuse, gloss) = (normal.dot(light).max(0.0), normal.dot(half).max(0.0).powi(6));
            let colour = if k / 12 % 4 < 2 { [0.7, 0.4, 0.2] } else { [0.2, 0.3, 0.6] };
            colour.map(|of: f32| of * diffuse + 0.2 * gloss * light.z)
        };
        Ok((0..144).map(pixel).collect())
    }
}

fn options(materials: usize) -> Options {
    Options {
        grid: Grid {
            n_alpha: 7,
            n_beta: 7,
            n_theta: 3,
            n_phi: 12,
            alpha_max: REACH_RAD,
            sin_beta_max: REACH_RAD.sin(),
            theta_max: REACH_RAD,
            cos_light_min: REACH_RAD.cos(),
        },
        chroma_weight: 1.5,
        names: (0..materials).map(|k| format!("waves {k}")).collect(),
        has_mipmaps: false,
        seed: 7,
    }
}

fn sizes() -> Sizes {
    let stage = |words: usize, count: usize| StageSize { words, count };
    Sizes {
        luma: 12,
        chroma: 3,
        stages: vec![stage(32, 17), stage(32, 17), stage(16, 9)],
        axes: [24, 24],
        core: CoreSize::Step(0.002),
        word_step: 0.02,
    }
}

fn waves(white: Option<f32>) -> (Vec<Images>, TruncatedSvd) {
    let images = vec![Images::load(&Waves::new(white), &()).unwrap()];
    let svd = TruncatedSvd::new(&images, RANKS, 1, &()).unwrap();
    (images, svd)
}

const RANKS: Ranks = Ranks { luma: 24, chroma: 8 };

fn mean(error: &BtfError) -> f64 {
    error.mean_mssim().unwrap()
}

fn quality(images: &Images, bytes: &[u8], material: usize) -> BtfError {
    let file = FactoredBtf::parse(bytes).unwrap();
    let mut memory = ExpansionMemory::default();
    let pairs: Vec<usize> = (0..images.pairs()).step_by(5).collect();
    compare(images, &file.expand_in(&mut memory).unwrap(), material, &pairs, &())
}

#[test]
fn images_come_back() {
    for white in [Some(1.0), None] {
        let (images, svd) = waves(white);
        let prepared = Prepared::new(&images, &svd, options(1)).unwrap();
        let error = quality(&images[0], &prepared.encode(&sizes(), &()).unwrap(), 0);
        assert!(mean(&error) > 0.95, "white {white:?}: {error:?}");
        let coarse = Sizes { luma: 2, chroma: 0, stages: vec![StageSize { words: 4, count: 4 }], ..sizes() };
        let worse = quality(&images[0], &prepared.encode(&coarse, &()).unwrap(), 0);
        assert!(mean(&worse) < mean(&error) - 0.02, "four codewords are not enough: {worse:?} {error:?}");
    }
}

#[test]
fn cores_take_no_more_bytes_than_they_may() {
    let (images, svd) = waves(Some(1.0));
    let prepared = Prepared::new(&images, &svd, options(1)).unwrap();
    let mut last = 0.0;
    for most in [60, 150, 500] {
        let bytes = prepared.encode(&Sizes { core: CoreSize::Bytes(most), ..sizes() }, &()).unwrap();
        let container = subsurf_decoder::container::Container::parse(&bytes).unwrap();
        let core = container.entries().find(|entry| entry.section == subsurf_decoder::Section::Core).unwrap();
        let length = usize::try_from(core.length).unwrap();
        assert!(length <= most && length * 10 > most * 8, "{length} bytes of {most}");
        let psnr_db = quality(&images[0], &bytes, 0).psnr_db;
        assert!(psnr_db > last + 0.5, "more bytes, {psnr_db} dB after {last} dB");
        last = psnr_db;
    }
}

#[test]
fn files_are_as_large_as_they_may_be() {
    let (images, svd) = waves(Some(1.0));
    let prepared = Prepared::new(&images, &svd, options(1)).unwrap();
    let mut last = 0.0;
    for most in [1_600, 9_000] {
        let (bytes, sizes) = prepared.encode_to(most, &()).unwrap();
        assert!(bytes.len() <= most, "{} bytes: {sizes:?}", bytes.len());
        let mssim = mean(&quality(&images[0], &bytes, 0));
        assert!(mssim > last + 0.002, "more bytes, {mssim} after {last}");
        last = mssim;
    }
    let error = prepared.encode_to(500, &()).unwrap_err();
    assert!(matches!(error, Error::Request(_)), "{error:?}");
}

#[test]
fn stages_that_add_nothing_are_left_out() {
    let (images, svd) = waves(Some(1.0));
    let prepared = Prepared::new(&images, &svd, options(1)).unwrap();
    let stage = StageSize { words: 256, count: 17 };
    let of = |count: usize| prepared.encode(&Sizes { stages: vec![stage; count], ..sizes() }, &()).unwrap();
    // 144 texels have a codeword each in the first stage; the others round to nothing.
    let (one, many) = (of(1), of(12));
    let stages = FactoredBtf::parse(&many).unwrap().shape().count;
    assert!(stages < 4, "{stages} of 12 stages");
    assert!(many.len() < one.len() + 3 * 144 + 200, "{} bytes, {} of one stage", many.len(), one.len());
    let [many, one] = [&many, &one].map(|bytes| quality(&images[0], bytes, 0));
    assert!(mean(&many) >= mean(&one), "nothing is lost: {many:?}, of one stage {one:?}");
}

#[test]
fn materials_share_a_file_and_have_mipmaps() {
    let images = [None, None].map(|_: Option<()>| Images::load(&Waves::new(Some(1.0)), &()).unwrap());
    let svd = TruncatedSvd::new(&images, RANKS, 1, &()).unwrap();
    let options = Options { has_mipmaps: true, ..options(2) };
    let bytes = Prepared::new(&images, &svd, options).unwrap().encode(&sizes(), &()).unwrap();
    let file = FactoredBtf::parse(&bytes).unwrap();
    let materials: Vec<_> = file.catalog().materials().collect();
    assert_eq!(materials.iter().map(|material| material.name()).collect::<Vec<_>>(), ["waves 0", "waves 1"]);
    for (number, images) in images.iter().enumerate() {
        let error = quality(images, &bytes, number);
        assert!(mean(&error) > 0.9, "{number}: {error:?}");
    }
    // The coarsest level is near the mean of the finest.
    let mut memory = ExpansionMemory::default();
    let file = file.expand_in(&mut memory).unwrap();
    let (light, view) = ([0.3, 0.1, 0.9_f32.sqrt()], [-0.3, 0.1, 0.9_f32.sqrt()]);
    let value = |level: u8, k: i32| file.eval(file.catalog().texel(1, level, [k % 12, k / 12]).unwrap(), light, view);
    let mean = (0..144).map(|k| value(0, k)[1]).sum::<f32>() / 144.0;
    let coarsest = value(3, 0)[1];
    assert!((coarsest - mean).abs() < 0.05 * mean, "{coarsest} {mean}");
}

#[test]
fn files_do_not_depend_on_threads() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (images, svd) = waves(Some(1.0));
            Prepared::new(&images, &svd, options(1)).unwrap().encode(&sizes(), &()).unwrap()
        })
    };
    assert!(with(1) == with(3), "one thread and three");
}

#[test]
fn what_cannot_be_written_is_refused() {
    let (images, svd) = waves(Some(1.0));
    let prepared = Prepared::new(&images, &svd, options(1)).unwrap();
    for bad in [
        Sizes { luma: 0, ..sizes() },
        Sizes { luma: 129, ..sizes() },
        Sizes { chroma: 33, ..sizes() },
        Sizes { stages: vec![], ..sizes() },
        Sizes { axes: [0, 5], ..sizes() },
        Sizes { core: CoreSize::Step(0.0), ..sizes() },
        Sizes { word_step: f32::NAN, ..sizes() },
    ] {
        let error = prepared.encode(&bad, &()).unwrap_err();
        assert!(matches!(error, Error::Request(_)), "{bad:?}: {error:?}");
    }
    let weightless = Options { chroma_weight: 0.0, ..options(1) };
    assert!(Prepared::new(&images, &svd, weightless).is_err(), "chroma has to count");
}
