//! `subsurf-study bench btf`: frames per second of BTFs, set up as Table 1 of Havran, Filip and Myszkowski 2010.

use std::path::PathBuf;
use std::time::Instant;

use glam::{Quat, Vec3};
use serde_json::{Value, json};
use subsurf_cli::images::FolderImages;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_decoder::NestedBtf;
use subsurf_encoder::Progress as _;
use subsurf_runtime::{BACKGROUND, Backend, BtfFiltering, BtfLayout, BtfMaterial, BtfOptions, Gpu, RuntimeOptions};
use subsurf_scene::{Light, LightShape, MAX_LIGHTS, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow, relief, sphere};
use subsurf_shaders::{cpu, uniform};
use subsurf_viewer::{
    GpuAsset, RenderRequest, RenderSession, TexturedMesh, human, material_number, parse_btf, read, upload_images,
};

use super::devices::to_compare;
use super::meshes::EXTENT_MM;
use super::timing::{median, quantile};

/// Time frames of meshes of 2, 7 and 115 thousand triangles made of a BTF, and of its images.
///
/// As in Table 1 of Havran, Filip and Myszkowski 2010: the material covers a texture of 1024 × 1024 texels, one point light
/// shines, and no environment. It goes around a little from frame to frame. Frames include what the light sees, for shadows,
/// which the paper does not have. Times are wall-clock milliseconds until the device is through; compare those of one run.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The .subsurf file of a BTF
    file: PathBuf,
    /// Which material of a file that has several: its name, or its number from 0
    #[arg(long, value_name = "NAME|N")]
    material: Option<String>,
    /// The folder of images that it was made from: timed uncompressed beside it
    #[arg(long, value_name = "FOLDER")]
    images: Option<PathBuf>,
    /// Pixels of the picture
    #[arg(long, default_value = "800x600", value_name = "WxH")]
    size: Size,
    /// Frames of each, after one that does not count
    #[arg(long, default_value_t = 5)]
    frames: usize,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Texels to a side of the texture that copies of the material cover.
const TEXTURE: f32 = 1_024.0;

/// A mesh of ours for each of the paper's, and the paper's frames per second: one core of 2 GHz (Intel C2D), ATI Mobility
/// Radeon X1600, NVIDIA GeForce 8800 GT.
struct TestMesh {
    name: &'static str,
    stands_for: &'static str,
    mesh: Mesh,
    published_fps: [f64; 3],
}

fn test_meshes() -> anyhow::Result<Vec<TestMesh>> {
    // A grid of 2 n × n quads.
    let all = [
        ("relief", "bunny, 2k faces", relief(20.0, 8, 22), [2.0, 18.0, 92.0]),
        ("sphere", "sphere, 7k faces", sphere(20.0, 42), [1.2, 10.0, 170.0]),
        ("relief", "dragon, 115k faces", relief(20.0, 8, 170), [1.1, 8.0, 10.0]),
    ];
    let test_mesh = |(name, stands_for, mesh, published_fps): (_, _, Mesh, _)| {
        Ok(TestMesh { name, stands_for, mesh: mesh.fitted(EXTENT_MM)?, published_fps })
    };
    all.into_iter().map(test_mesh).collect()
}

/// Row of the table: times of one mesh, device and layout.
struct Row {
    device: String,
    layout: BtfLayout,
    filtering: BtfFiltering,
    /// Times of frames in ms.
    times: Vec<f64>,
    material_bytes: u64,
}

impl Row {
    fn fps(&self) -> f64 {
        1e3 / median(&self.times)
    }

    fn line(&self) -> String {
        let what = match self.layout {
            BtfLayout::Nested => "codebooks",
            BtfLayout::Images => "images",
        };
        format!(
            "  {:<10} {:<9} {:<9} {:>8.2} frames/s, {:>7.1} ms (p95 {:.1}), material {}",
            self.device,
            what,
            format!("{:?}", self.filtering).to_lowercase(),
            self.fps(),
            median(&self.times),
            quantile(&self.times, 0.95),
            human(self.material_bytes),
        )
    }

    fn json(&self, test_mesh: &TestMesh) -> Value {
        json!({
            "mesh": test_mesh.name, "triangles": test_mesh.mesh.triangles.len(), "device": self.device,
            "storage": format!("{:?}", self.layout).to_lowercase(), "filtering": format!("{:?}", self.filtering).to_lowercase(),
            "frames_per_second": self.fps(), "frame_median_ms": median(&self.times),
            "frame_p95_ms": quantile(&self.times, 0.95), "material_bytes": self.material_bytes,
            "published": { "mesh": test_mesh.stands_for, "cpu_fps": test_mesh.published_fps[0],
                "radeon_x1600_fps": test_mesh.published_fps[1], "geforce_8800_gt_fps": test_mesh.published_fps[2] },
        })
    }
}

/// One point light, over the eye's shoulder.
fn scene(mesh: &Mesh, size: [u32; 2]) -> Scene {
    let position_mm = Vec3::new(0.9, 1.1, 0.9) * EXTENT_MM;
    let light = Light { shape: LightShape::Point { position_mm }, irradiance: [3.0, 2.9, 2.7], shadow: Shadow::Drawn };
    Scene { lights: vec![light], ..RenderRequest::usual(size).scene(mesh) }
}

/// Lets the light go around by a fifth of a degree.
fn turn(scene: &mut Scene) {
    for light in &mut scene.lights {
        if let LightShape::Point { position_mm } = &mut light.shape {
            *position_mm = Quat::from_axis_angle(Vec3::Y, 0.2_f32.to_radians()) * *position_mm;
        }
    }
}

/// Times `frames` calls after one that does not count.
fn timed(frames: usize, bars: &Bars, mut draw: impl FnMut() -> anyhow::Result<()>) -> anyhow::Result<Vec<f64>> {
    let mut times = Vec::with_capacity(frames);
    for number in 0..=frames {
        let begin = Instant::now();
        draw()?;
        // Drivers compile at the first frame.
        if number > 0 {
            times.push(1e3 * begin.elapsed().as_secs_f64());
        }
        bars.advance(1);
    }
    Ok(times)
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.frames == 0 {
        return Err(bad_request("--frames is 0; at least one is needed for a time"));
    }
    let bytes = read(&args.file)?;
    let btf = parse_btf(&args.file, &bytes)?;
    let number = number(args, &btf)?;
    let texels = btf.materials().nth(number).map_or([1; 2], |material| material.size(0));
    let images = args.images.as_ref().map(|folder| FolderImages::read(folder)).transpose()?;
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let copies = texels.map(|side| TEXTURE / side as f32);
    let test_meshes = test_meshes()?;
    let gpus = to_compare();
    let layouts = 1 + usize::from(images.is_some());
    let rows = test_meshes.len() * (2 * layouts * gpus.len() + 1);
    let (bars, mut report) = (Bars::new(), Vec::new());
    bars.begin("frames", (rows * (args.frames + 1)) as u64);
    for test_mesh in &test_meshes {
        let scene = scene(&test_mesh.mesh, args.size.0);
        let mut lines = vec![on_cpu(&btf, number, copies, test_mesh, &scene, args, &bars)?];
        for (backend, gpu) in &gpus {
            let once = Setting { backend: *backend, gpu, copies, test_mesh, scene: &scene, args, bars: &bars };
            lines.extend(once.both(|| Ok((BtfMaterial::upload(gpu, &btf)?, number)))?);
            if let Some(images) = &images {
                lines.extend(once.images(images)?);
            }
        }
        if !args.json {
            let [cpu, radeon, geforce] = test_mesh.published_fps;
            outln!(
                "{}, {} triangles (the paper's {}: CPU {cpu}, Radeon X1600 {radeon}, GeForce 8800 GT {geforce} frames/s)",
                test_mesh.name,
                test_mesh.mesh.triangles.len(),
                test_mesh.stands_for
            );
            lines.iter().for_each(|row| outln!("{}", row.line()));
        }
        report.extend(lines.iter().map(|row| row.json(test_mesh)));
    }
    if args.json {
        outln!("{:#}", Value::Array(report));
    }
    Ok(())
}

/// Number of the material that is asked for; 0 if none is.
fn number(args: &Args, btf: &NestedBtf<'_>) -> anyhow::Result<usize> {
    let Some(asked) = &args.material else {
        return Ok(0);
    };
    let names: Vec<String> = btf.materials().map(|material| material.name().to_owned()).collect();
    material_number(&names, asked)
        .ok_or_else(|| bad_request(format!("--material {asked}: the file has {}", names.join(", "))))
}

/// Setting of a measurement: a mesh on a device.
struct Setting<'a> {
    backend: Backend,
    gpu: &'a Gpu,
    copies: [f32; 2],
    test_mesh: &'a TestMesh,
    scene: &'a Scene,
    args: &'a Args,
    bars: &'a Bars,
}

impl Setting<'_> {
    /// With the nearest texel, and with four.
    fn both(&self, material: impl Fn() -> anyhow::Result<(BtfMaterial, usize)>) -> anyhow::Result<Vec<Row>> {
        let filterings = [BtfFiltering::Nearest, BtfFiltering::Bilinear];
        filterings.into_iter().map(|filtering| self.time(filtering, material()?)).collect()
    }

    fn images(&self, images: &FolderImages) -> anyhow::Result<Vec<Row>> {
        self.both(|| Ok((upload_images(self.gpu, images)?, 0)))
    }

    fn time(&self, filtering: BtfFiltering, (material, number): (BtfMaterial, usize)) -> anyhow::Result<Row> {
        let (gpu, size) = (self.gpu, self.args.size.0);
        let (layout, material_bytes) = (material.layout(), material.gpu_bytes());
        let options = RuntimeOptions { btf: BtfOptions { filtering, samples: 0 }, ..RuntimeOptions::default() };
        let asset = GpuAsset::btf(gpu, &self.test_mesh.mesh, self.copies, material, number)?;
        let mut scene = self.scene.clone();
        let mut session = RenderSession::new(gpu, asset, &scene, size, options)?;
        let times = timed(self.args.frames, self.bars, || {
            turn(&mut scene);
            session.with(&scene, |renderer, frame, input, picture| {
                renderer.draw_now(gpu, frame, input, &picture.target())
            })?;
            Ok(gpu.finish()?)
        })?;
        Ok(Row { device: self.backend.to_string(), layout, filtering, times, material_bytes })
    }
}

/// The twin of the shaders on one core, with four texels and without shadows.
fn on_cpu(
    btf: &NestedBtf<'_>,
    material: usize,
    copies: [f32; 2],
    test_mesh: &TestMesh,
    scene: &Scene,
    args: &Args,
    bars: &Bars,
) -> anyhow::Result<Row> {
    let mesh = &test_mesh.mesh;
    let filtering = BtfFiltering::Bilinear;
    let surface = cpu::BtfSurface { btf, material, filtering, samples: 0 };
    let lit = vec![[1.0; MAX_LIGHTS]; mesh.positions.len()];
    let textured = TexturedMesh::new(mesh, copies)?;
    let triangles = textured.triangles(mesh, &lit);
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    let placement = Placement::of_btf(mesh, copies);
    let mut scene = scene.clone();
    let times = timed(args.frames, bars, || {
        turn(&mut scene);
        let block = uniform::Blocks::new(&scene, &placement, args.size.0, RuntimeOptions::default().light_texels);
        let picture = cpu::shade_btf(&triangles, &surface, &block.scene, &reflections, args.size.0, [BACKGROUND; 3]);
        std::hint::black_box(picture);
        Ok(())
    })?;
    let layout = BtfLayout::Nested;
    Ok(Row { device: "CPU, 1 core".to_owned(), layout, filtering, times, material_bytes: btf.file().len() as u64 })
}
