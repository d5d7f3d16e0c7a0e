//! `subsurf-study bench traffic`: what the passes of a frame read and write.

mod btf;
mod count;
mod kernel;
mod row;
mod separable;
mod splat;

use std::path::PathBuf;

use serde_json::{Value, json};
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::{Bssrdf, Kernel, NestedBtf};
use subsurf_runtime::{Gpu, Input, Plan, RuntimeOptions, SplatLevels};
use subsurf_scene::{AmbientTransfer, Mesh, View};
use subsurf_shaders::separable::BasisNumbers;
use subsurf_shaders::uniform::{BlurStage, BtfCodebooks};
use subsurf_viewer::{
    Asset, DrawnMaterial, GpuAsset, MappingChoice, RenderRequest, RenderSession, Scattering, choose_mapping, parse,
    read, stem,
};

use self::btf::BtfFrame;
use self::kernel::KernelFrame;
use self::row::{Common, Row};
use self::separable::SeparableFrame;
use self::splat::{Planes, SplatFrame};
use super::devices::to_compare;
use super::meshes::{EXTENT_MM, named};

/// Share of the pixels that face the light.
const FACING: f64 = 0.5;

/// Count texture reads and bytes written of every pass of a frame: separable where the file has a basis, splats, a BTF, or a kernel.
///
/// Reads are counted in the shaders' intermediate representation, with turns of loops from the numbers of the frame, for objects
/// that cover the whole picture once, are mapped by texture coordinates, and of which half faces the light. A sample that
/// filters counts once; bytes are those of one texel for each read, as if nothing were cached. Depth of the passes stays on the
/// chip, and so do the sums of splats. Of splats, light and eye look straight at a surface; of BTFs, every node of view has a chroma
/// of its own.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The .subsurf file
    file: PathBuf,
    /// Mesh whose usual view says how large the material is on the screen: a file, or a name of a shape
    #[arg(long, default_value = "sphere", value_name = "FILE|SHAPE")]
    mesh: PathBuf,
    /// Pixels of the pictures
    #[arg(long = "size", default_values = ["1280x720", "1920x1080"], value_name = "WxH")]
    sizes: Vec<Size>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Passes of one technique, with the numbers that they were counted by.
struct Counts {
    technique: &'static str,
    numbers: String,
    rows: Vec<Row>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let bytes = read(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let (mesh_name, mesh) = named(&args.mesh, EXTENT_MM)?;
    let mut all = Vec::new();
    for Size(size) in &args.sizes {
        let counts = match &material {
            DrawnMaterial::Bssrdf(material) => scattering(material, &mesh, *size)?,
            DrawnMaterial::Btf(btf) => vec![textured(btf, *size)?],
            DrawnMaterial::Kernel(kernel) => vec![homogeneous(kernel, &mesh, *size)?],
            DrawnMaterial::Transfer(_) => {
                return Err(bad_request("a transfer, which has no passes but the picture: `bench frames` times it"));
            }
        };
        for Counts { technique, numbers, rows } in counts {
            let name = stem(&args.file);
            outln!("{name}, {mesh_name}, {}x{} pixels, {technique}: {numbers}\n", size[0], size[1]);
            print(&rows, *size);
            all.push(report(&rows, technique, *size));
        }
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
}

/// Separable blurs, if the file has a basis for them, and splats.
fn scattering(material: &Bssrdf<'_>, mesh: &Mesh, size: [u32; 2]) -> anyhow::Result<Vec<Counts>> {
    let gpu = &first_device()?;
    let mut counts = Vec::new();
    if let Some(basis) = BasisNumbers::of(material) {
        let (plan, view) = planned(gpu, material, mesh, size, Scattering::Separable)?;
        let maps = plan.blur_size;
        let pitch_texels = basis.header().pitch_mm * texels_per_mm(&view, mesh, maps[1]);
        let frame = SeparableFrame {
            common: common(&plan),
            terms: basis.size().terms,
            taps: BlurStage::cascade(&basis).iter().map(|[rows, _]| rows.screen_taps(pitch_texels)).collect(),
            maps,
        };
        let SeparableFrame { terms, taps, .. } = &frame;
        let numbers =
            format!("L = {terms}, A = {}, taps to each side {taps:?}, maps {}x{}", taps.len(), maps[0], maps[1]);
        counts.push(Counts { technique: "separable", numbers, rows: frame.rows()? });
    }
    let (plan, _) = planned(gpu, material, mesh, size, Scattering::Splat)?;
    let radius_mm = mesh.bounding_sphere().radius_mm;
    let levels = SplatLevels::new(material.header(), radius_mm, plan.light_texels);
    #[allow(clippy::cast_precision_loss, reason = "a thousand")]
    let sample_mm = 2.0 * radius_mm / plan.light_texels as f32 * (1_u32 << levels.first) as f32;
    let frame = SplatFrame {
        common: common(&plan),
        material: Planes::of(material),
        maps: plan.map_size(),
        levels,
        reach: f64::from(material.header().r_max_mm / sample_mm),
    };
    let SplatLevels { first, rings } = levels;
    let numbers = format!("{rings} rings from level {first} on, maps {}x{}", frame.maps[0], frame.maps[1]);
    counts.push(Counts { technique: "splat", numbers, rows: frame.rows()? });
    Ok(counts)
}

/// A separable kernel.
fn homogeneous(kernel: &Kernel<'_>, mesh: &Mesh, size: [u32; 2]) -> anyhow::Result<Counts> {
    let gpu = first_device()?;
    let asset = GpuAsset::kernel(&gpu, mesh, kernel, &AmbientTransfer::of_kernel(mesh, kernel)?)?;
    let options = RuntimeOptions::default();
    let session = RenderSession::new(&gpu, asset, &RenderRequest::usual(size).scene(mesh), size, options)?;
    let plan = *session.frame.plan();
    let header = kernel.header();
    let frame = KernelFrame {
        common: common(&plan),
        terms: header.terms.into(),
        side: u32::from(header.taps / 2 + 1),
        is_jittered: options.jittered_taps,
        maps: plan.blur_size,
    };
    let [width, height] = frame.maps;
    let numbers = format!("{} terms, {} taps, maps {width}x{height}", header.terms, header.taps);
    Ok(Counts { technique: "kernel", numbers, rows: frame.rows()? })
}

/// Nested codebooks under one light and the environment.
fn textured(btf: &NestedBtf<'_>, picture: [u32; 2]) -> anyhow::Result<Counts> {
    let codebooks = BtfCodebooks::of(btf).ok_or_else(|| bad_request("the file is too large for a device"))?;
    let texels = RuntimeOptions::default().light_texels;
    let frame = BtfFrame::new(Common { lights: 1, light_size: [texels; 2], picture, facing: FACING }, &codebooks);
    let numbers = format!(
        "{} stages, {:?}, {} samples of light from all around",
        frame.stages, frame.options.filtering, frame.options.samples
    );
    Ok(Counts { technique: "BTF", numbers, rows: frame.rows()? })
}

/// The first device there is.
fn first_device() -> anyhow::Result<Gpu> {
    let first = to_compare().into_iter().next();
    let (_, gpu) = first.ok_or_else(|| bad_request("there is no device; this asks one for the sizes of maps"))?;
    Ok(gpu)
}

/// Sizes of a frame of a mesh in its usual view, and the view.
fn planned(
    gpu: &Gpu,
    material: &Bssrdf<'_>,
    mesh: &Mesh,
    size: [u32; 2],
    scattering: Scattering,
) -> anyhow::Result<(Plan, View)> {
    let scene = RenderRequest::usual(size).scene(mesh);
    let mapping = choose_mapping(mesh, MappingChoice::Auto, material)?;
    let asset = Asset::compute(material, mesh, mapping, &scene, scattering, None)?;
    let uploaded = asset.upload(gpu, material, mesh)?;
    let mut session = RenderSession::new(gpu, uploaded, &scene, size, RuntimeOptions::default())?;
    let plan = *session.frame.plan();
    let view = session.with(&scene, |_, _, input: &Input<'_>, _| Ok::<_, anyhow::Error>(input.view))?;
    Ok((plan, view))
}

fn common(plan: &Plan) -> Common {
    Common { lights: plan.lights, light_size: plan.light_size(), picture: plan.size, facing: FACING }
}

/// Texels of maps of so many rows that a mm covers in the middle of a mesh.
fn texels_per_mm(view: &View, mesh: &Mesh, rows: u32) -> f32 {
    let middle_mm = (mesh.bounding_sphere().centre_mm - view.eye_mm()).dot(view.forward());
    #[allow(clippy::cast_precision_loss, reason = "rows of a picture")]
    let rows = rows as f32;
    0.5 * rows * view.focal().y / middle_mm
}

#[allow(clippy::cast_precision_loss, reason = "for people")]
fn print(rows: &[Row], picture: [u32; 2]) {
    outln!("| pass | texels | runs | reads of one | read (MB) | written (MB) |");
    outln!("|---|---:|---:|---:|---:|---:|");
    for row in rows {
        let texels = u64::from(row.size[0]) * u64::from(row.size[1]);
        outln!(
            "| `{}` | {} × {} | {} | {:.1} | {:.1} | {:.1} |",
            row.entry,
            row.size[0],
            row.size[1],
            runs(row.invocations / texels as f64),
            row.reads,
            1e-6 * row.bytes_read,
            1e-6 * row.bytes_written as f64,
        );
    }
    let pixels = f64::from(picture[0]) * f64::from(picture[1]);
    let [reads, bytes_read, bytes_written] = sums(rows);
    outln!(
        "| all, for each pixel of the picture | | | {:.1} | {:.0} bytes | {:.0} bytes |",
        reads / pixels,
        bytes_read / pixels,
        bytes_written / pixels,
    );
    outln!("| all | | | | {:.1} | {:.1} |\n", 1e-6 * bytes_read, 1e-6 * bytes_written);
}

/// Number of runs: whole, but for squares of splats, of which a mean number reaches a texel.
fn runs(for_each: f64) -> String {
    if (for_each - for_each.round()).abs() < 1e-9 { format!("{for_each:.0}") } else { format!("{for_each:.1}") }
}

/// Reads, bytes read and bytes written of all passes.
#[allow(clippy::cast_precision_loss, reason = "for people")]
fn sums(rows: &[Row]) -> [f64; 3] {
    let sum = |of: fn(&Row) -> f64| rows.iter().map(of).sum();
    [sum(|row| row.reads * row.invocations), sum(|row| row.bytes_read), sum(|row| row.bytes_written as f64)]
}

fn report(rows: &[Row], technique: &str, picture: [u32; 2]) -> Value {
    let of = |row: &Row| {
        json!({
            "pass": row.entry, "texels": row.size, "invocations": row.invocations, "reads": row.reads,
            "bytes_read": row.bytes_read, "bytes_written": row.bytes_written,
        })
    };
    let [reads, bytes_read, bytes_written] = sums(rows);
    json!({
        "technique": technique, "size": picture, "passes": rows.iter().map(of).collect::<Vec<_>>(), "reads": reads,
        "bytes_read": bytes_read, "bytes_written": bytes_written,
    })
}
