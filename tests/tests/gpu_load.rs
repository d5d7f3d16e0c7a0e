//! Load size and latency of every storage and technique, from bytes to the first frame, against the uncompressed baseline; and
//! loads in steps, beside frames.
//!
//! Bytes are asserted as they are, latencies at a tenth of what they were measured by: loading that begins to do work fails,
//! a busy machine does not.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use glam::Vec3;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::btf::Evaluate;
use subsurf_decoder::btf::factored::ExpansionMemory;
use subsurf_decoder::{Bssrdf, FactoredBtf, File};
use subsurf_encoder::btf::{Goal, Method, Options, encode};
use subsurf_encoder::capture::{Images, Source};
use subsurf_encoder::picture::PixelFormat;
use subsurf_encoder::synthetic::{NestedShape, capture_row};
use subsurf_runtime::{
    Backend, BtfLayout, Error, Gpu, Load, LoadPhase, LoadTimer, LoadTimes, Material, RawImages, RuntimeOptions, Stored,
    Technique, layout_of, wgpu,
};
use subsurf_scene::{Mapping, torus};
use subsurf_tests::frames::{Loaded, RenderMode, device, scene};
use subsurf_tests::{drawable, shape};

/// Runs of each, in turns, after one that does not count. Of OpenGL ES, whose driver gathers slowly, one is enough to fail by.
fn runs(gpu: &Gpu) -> usize {
    if gpu.info().backend == wgpu::Backend::Vulkan { 3 } else { 1 }
}

/// Loads bytes, once.
type Once<'a> = Box<dyn Fn(&[u8]) -> LoadTimes + 'a>;

/// Way to store a material, and how it is loaded.
struct Case<'a> {
    name: &'static str,
    bytes: &'a [u8],
    load: Once<'a>,
    /// Pipelines of frames.
    compiled: Duration,
}

impl<'a> Case<'a> {
    fn new(gpu: &'a Gpu, name: &'static str, bytes: &'a [u8], stored: Stored) -> Self {
        let timer = LoadTimer::new(gpu, stored).unwrap();
        Self { name, bytes, compiled: timer.compiled(), load: Box::new(move |bytes| timer.load(bytes).unwrap()) }
    }
}

/// Medians of a case in µs: until it can be drawn, and what the CPU does of that.
struct Latency {
    drawable: f64,
    cpu: f64,
}

/// Median of one of the phases, or of several, in µs.
fn median_us(runs: &[LoadTimes], phase: impl Fn(&LoadTimes) -> Duration) -> f64 {
    let mut times: Vec<f64> = runs.iter().map(|run| 1e6 * phase(run).as_secs_f64()).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn measured<const N: usize>(gpu: &Gpu, cases: &[Case<'_>; N]) -> [Latency; N] {
    // The first load compiles, and warms up caches and drivers.
    let compiled = cases.each_ref().map(|case| case.compiled + (case.load)(case.bytes).pipelines);
    let mut runs = cases.each_ref().map(|_| Vec::new());
    for _ in 0..self::runs(gpu) {
        for (case, runs) in cases.iter().zip(&mut runs) {
            runs.push((case.load)(case.bytes));
        }
    }
    println!("{}, µs", gpu.info().name);
    println!(
        "| storage | bytes | on the device | parse | upload | projection | of it recording | first frame | pipelines, once |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    std::array::from_fn(|k| {
        let (case, runs, compiled) = (&cases[k], &runs[k], compiled[k].as_micros());
        let phases: [fn(&LoadTimes) -> Duration; 5] =
            [|run| run.parse, |run| run.upload, |run| run.projection, |run| run.recording, |run| run.first_frame];
        let phases = phases.map(|phase| format!("{:.0}", median_us(runs, phase))).join(" | ");
        println!("| {} | {} | {} | {phases} | {compiled} |", case.name, case.bytes.len(), runs[0].gpu_bytes);
        Latency { drawable: median_us(runs, LoadTimes::drawable), cpu: median_us(runs, LoadTimes::cpu) }
    })
}

/// Asserts that `baseline` takes at least `least` times as long as `ours`, until it can be drawn.
fn assert_faster(what: &str, baseline: &Latency, ours: &Latency, least: f64) {
    let ratio = baseline.drawable / ours.drawable;
    println!("{what}: {ratio:.2} × until it can be drawn");
    assert!(ratio >= least, "{what}: {ratio}");
}

/// The same of the work that the CPU does: a software driver's passes are none of it.
fn assert_less_work(what: &str, baseline: &Latency, ours: &Latency, least: f64) {
    let ratio = baseline.cpu / ours.cpu;
    println!("{what}: {ratio:.2} × the work of the CPU");
    assert!(ratio >= least, "{what}: {ratio}");
}

fn translucent(gpu: &Gpu) {
    let shape = shape([64, 64], 12, Addressing::Clamp);
    let (bmpp, profiles) = (shape.bmpp(), shape.per_pixel());
    let with_basis = drawable([64, 64], 12, Addressing::Clamp);
    let [material, per_pixel] = [&bmpp, &profiles].map(|bytes| Bssrdf::parse(bytes).unwrap());
    let rows = (0..64).flat_map(|y| capture_row(&material, y));
    let capture: Vec<u8> = rows.flat_map(f32::to_le_bytes).collect();
    let terms = Bssrdf::parse(&with_basis).unwrap().basis().map_or(0, |basis| basis.size().terms);
    let [of_planes, of_profiles] = [&material, &per_pixel].map(layout_of);
    let cases = [
        Case::new(gpu, "capture, gather", &capture, Stored::Capture(*material.header())),
        Case::new(gpu, "profiles, gather", &profiles, Stored::Planes(of_profiles)),
        Case::new(gpu, "profiles, splat", &profiles, Stored::File(Technique::Splat(of_profiles))),
        Case::new(gpu, "2-BMPP, gather", &bmpp, Stored::Planes(of_planes)),
        Case::new(gpu, "2-BMPP, splat", &bmpp, Stored::File(Technique::Splat(of_planes))),
        Case::new(gpu, "2-BMPP, separable", &with_basis, Stored::File(Technique::Separable(terms))),
    ];
    let bytes = cases.each_ref().map(|case| case.bytes.len());
    assert_eq!(bytes, [30_720_000, 688_236, 688_236, 25_908, 25_908, 26_432], "bytes");
    let [capture, profiles, profiles_splat, planes, splat, separable] = measured(gpu, &cases);
    println!("separable: {:.2} × the CPU work of plain planes", separable.cpu / planes.cpu);
    assert_faster("capture by 2-BMPP", &capture, &planes, 5.8);
    assert_faster("profiles by 2-BMPP", &profiles, &planes, 0.4);
    assert_faster("profiles by 2-BMPP, splat", &profiles_splat, &splat, 0.09);
    assert_less_work("capture by separable", &capture, &separable, 0.6);
}

/// Images of `side` × `side` pixels from a formula.
struct Bumps {
    side: u16,
    directions: Vec<Vec3>,
}

impl Source for Bumps {
    fn label(&self) -> String {
        "bumps".to_owned()
    }

    fn lights(&self) -> Vec<Vec3> {
        self.directions.clone()
    }

    fn views(&self) -> Vec<Vec3> {
        self.directions.clone()
    }

    fn size(&self) -> [u32; 2] {
        [self.side.into(); 2]
    }

    fn format(&self) -> PixelFormat {
        PixelFormat::Display8
    }

    fn read(&self, light: usize, view: usize) -> subsurf_encoder::Result<Vec<[f32; 3]>> {
        let (light, view) = (self.directions[light], self.directions[view]);
        let pixel = |k: u16| {
            let slope = 0.3 * Vec3::new(f32::from(k % 7) - 3.0, f32::from(k % 5) - 2.0, 4.0).normalize();
            [0.2, 0.3, 0.1].map(|tint| tint + 0.5 * (slope.dot(light).max(0.0) + 0.1 * view.z))
        };
        Ok((0..self.side * self.side).map(pixel).collect())
    }
}

/// A factored file, which the CPU expands and evaluates: 64 × 64 texels for the first frame.
fn factored_times(bytes: &[u8]) -> LoadTimes {
    let begin = Instant::now();
    let file = FactoredBtf::parse(bytes).unwrap();
    let parse = begin.elapsed();
    let mut memory = ExpansionMemory::default();
    let btf = file.expand_in(&mut memory).unwrap();
    let upload = begin.elapsed() - parse;
    let (light, view) = ([0.6, 0.0, 0.8], btf.catalog().grid().view([0.0, 0.6, 0.8]));
    let texels = (0..64 * 64).map(|k| btf.catalog().texel(0, 0, [k % 64, k / 64]).unwrap());
    let sum: f32 = texels.flat_map(|texel| btf.eval_for(texel, light, &view)).sum();
    assert!(sum > 0.0, "light comes back");
    LoadTimes { parse, upload, first_frame: begin.elapsed() - parse - upload, ..Default::default() }
}

/// Directions on rings around the normal.
fn directions() -> Vec<Vec3> {
    let ring = |theta: f32, count: u16| {
        (0..count).map(move |k| {
            let phi = f32::from(k) / f32::from(count) * std::f32::consts::TAU;
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        })
    };
    ring(0.0, 1).chain(ring(0.5, 12)).chain(ring(1.1, 24)).collect()
}

/// Factored file of 16 × 16 texels, a quarter of the images,, encoded once.
static FACTORED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let bumps = Images::load(&Bumps { side: 16, directions: directions() }, &()).unwrap();
    let options =
        Options { method: Method::Factored, nodes: Some([5, 5, 3, 4]), goal: Goal::Usual, ..Default::default() };
    encode(&[bumps], &["bumps".to_owned()], &options, &(), &mut |_| ()).unwrap().bytes
});

fn textured(gpu: &Gpu) {
    let shape = NestedShape { materials: vec![(32, 32, 1)], ..NestedShape::typical() };
    let nested = shape.database(1).to_bytes();
    let images: Vec<u8> =
        (0..37 * 37 * 32 * 32 * 3_u32).map(|k| k.wrapping_mul(2_654_435_761).to_le_bytes()[3]).collect();
    let raw = RawImages { size: [32; 2], lights: directions(), views: directions() };
    let cases = [
        Case::new(gpu, "images", &images, Stored::Images(raw)),
        Case::new(gpu, "nested codebooks", &nested, Stored::File(Technique::Btf(BtfLayout::Nested))),
        Case {
            name: "factored, a quarter, by the CPU",
            bytes: &FACTORED,
            load: Box::new(factored_times),
            compiled: Duration::ZERO,
        },
    ];
    assert_eq!(cases.each_ref().map(|case| case.bytes.len()), [4_205_568, 197_676, 12_856], "bytes");
    let [images, nested, factored] = measured(gpu, &cases);
    assert_faster("images by nested codebooks", &images, &nested, 4.9);
    assert_faster("images by factors", &images, &factored, 0.1);
}

#[test]
fn loading_on_vulkan() {
    let gpu = device(Backend::Vulkan);
    translucent(&gpu);
    textured(&gpu);
}

#[test]
fn loading_on_gles_3_0() {
    let gpu = device(Backend::Gl);
    translucent(&gpu);
    textured(&gpu);
}

fn assert_send<T: Send>(it: T) -> T {
    it
}

/// Another thread loads, step by step, while this one draws: both give what they give alone.
#[test]
fn another_thread_loads_while_frames_are_drawn() {
    let shown = drawable([31, 31], 6, Addressing::Mirror);
    // Large enough for several steps.
    let coming = drawable([640, 500], 6, Addressing::Repeat);
    let file = File::parse(&coming).unwrap();
    let mesh = torus(9.0, 4.0, 32);
    let scene = scene(&mesh);
    let size = [64, 48];
    for backend in Backend::ALL {
        let gpu = device(backend);
        let first = Loaded::new(&gpu, RenderMode::Separable, &shown, &mesh);
        let renderer = first.renderer(&gpu, RuntimeOptions::default()).unwrap();
        let mut frame = first.prepare(&gpu, &renderer, &scene, size).unwrap();
        let alone = first.drawn(&gpu, &renderer, &mut frame, &scene, size);

        let (loaded, shares, drawn) = std::thread::scope(|threads| {
            let (gpu, file) = (&gpu, &file);
            let loading = threads.spawn(move || {
                let mut load = assert_send(Load::new(gpu, file).unwrap());
                let mut shares = vec![(load.phase(), load.share())];
                while load.step().unwrap() < 1.0 {
                    shares.push((load.phase(), load.share()));
                }
                (assert_send(load.finish().unwrap()), shares)
            });
            let mut drawn = 0;
            while drawn == 0 || !loading.is_finished() {
                assert!(first.drawn(gpu, &renderer, &mut frame, &scene, size) == alone, "{backend}: frame {drawn}");
                drawn += 1;
            }
            let (loaded, shares) = loading.join().unwrap();
            (loaded, shares, drawn)
        });
        println!("{backend}: {drawn} frames while a material was loaded in {} steps", shares.len());
        assert!(shares.windows(2).all(|pair| pair[0].1 < pair[1].1), "{backend}: {shares:?}");
        assert_eq!(shares[0], (Some(LoadPhase::Upload), 0.0), "{backend}");
        assert_eq!(shares.last().unwrap().0, Some(LoadPhase::Projection), "{backend}");

        let again = Material::load(&gpu, &file).unwrap();
        let [there, here] = [loaded, again].map(|material| {
            Loaded {
                mesh: Loaded::new(&gpu, RenderMode::Separable, &shown, &mesh).mesh,
                material,
                mapping: Mapping::Box,
            }
            .picture(&gpu, &scene, size)
        });
        assert!(there == here && there != alone, "{backend}: a material is the same whichever thread loaded it");

        // A load that is stopped leaves nothing behind; one whose device is lost says so, once and for all.
        let before = gpu.ledger().bytes();
        let mut load = Load::new(&gpu, &file).unwrap();
        load.step().unwrap();
        assert!(gpu.ledger().bytes() > before, "{backend}");
        drop(load);
        assert_eq!(gpu.ledger().bytes(), before, "{backend}");
        let mut load = Load::new(&gpu, &file).unwrap();
        gpu.device().destroy();
        assert!(matches!(load.step(), Err(Error::Device(_))), "{backend}");
        assert!(matches!(load.finish(), Err(Error::Usage(_))), "{backend}");
        assert!(matches!(Material::load(&gpu, &file), Err(Error::Device(_))), "{backend}");
    }
}
