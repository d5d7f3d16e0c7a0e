//! `subsurf-study bench traffic`: what the passes of a separable frame read and write.

mod count;
mod frame;

use std::path::PathBuf;

use serde_json::{Value, json};
use subsurf_cli::info::parse;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_runtime::{Input, RuntimeOptions};
use subsurf_scene::{Mesh, View};
use subsurf_shaders::separable::BasisNumbers;
use subsurf_shaders::uniform::BlurStage;
use subsurf_viewer::{Asset, MappingChoice, RenderRequest, RenderSession, Scattering, choose_mapping, read, stem};

use self::frame::{FrameNumbers, Row};
use super::devices::to_compare;
use super::meshes::named;

/// Count texture reads and bytes written of every pass of a separable frame.
///
/// Reads are counted in the shaders' intermediate representation, with turns of loops from the numbers of the frame, for objects
/// that cover the whole picture once, are mapped by texture coordinates, and of which half faces the light. A sample that
/// filters counts once; bytes are those of one texel for each read, as if nothing were cached. Depth of the passes stays on the chip.
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

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let bytes = read(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let basis = BasisNumbers::of(&material)
        .ok_or_else(|| bad_request("a file without separable basis; `subsurf encode --add-basis FILE` adds one"))?;
    let gpus = to_compare();
    let (_, gpu) =
        gpus.first().ok_or_else(|| bad_request("there is no device; this asks one for the sizes of maps"))?;
    let (mesh_name, mesh) = named(&args.mesh)?;
    let mut all = Vec::new();
    for Size(size) in &args.sizes {
        let request = RenderRequest::usual(*size);
        let scene = request.scene(&mesh);
        let mapping = choose_mapping(&mesh, MappingChoice::Auto, &material)?;
        let asset = Asset::compute(&material, &mesh, mapping, &scene, Scattering::Separable, None)?;
        let uploaded = asset.upload(gpu, &material, &mesh)?;
        let mut session = RenderSession::new(gpu, uploaded, &scene, *size, RuntimeOptions::default())?;
        let plan = *session.frame.plan();
        let view = session.with(&scene, |_, _, input: &Input<'_>, _| Ok::<_, anyhow::Error>(input.view))?;
        let maps = plan.blur_size;
        let pitch_texels = basis.header().pitch_mm * texels_per_mm(&view, &mesh, maps[1]);
        let numbers = FrameNumbers {
            terms: basis.size().terms,
            taps: BlurStage::cascade(&basis).iter().map(|[rows, _]| rows.screen_taps(pitch_texels)).collect(),
            lights: plan.lights,
            light_texels: plan.light_texels,
            maps,
            picture: *size,
            facing: 0.5,
        };
        let rows = numbers.rows()?;
        outln!(
            "{}, {mesh_name}, {}x{} pixels: L = {}, A = {}, taps to each side {:?}, maps {}x{}\n",
            stem(&args.file),
            size[0],
            size[1],
            numbers.terms,
            numbers.taps.len(),
            numbers.taps,
            maps[0],
            maps[1]
        );
        print(&rows, *size);
        all.push(report(&rows, *size));
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
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
    outln!("| pass | texels | runs | reads a texel | read (MB) | written (MB) |");
    outln!("|---|---:|---:|---:|---:|---:|");
    for row in rows {
        let texels = u64::from(row.size[0]) * u64::from(row.size[1]);
        outln!(
            "| `{}` | {} × {} | {} | {:.1} | {:.1} | {:.1} |",
            row.pass,
            row.size[0],
            row.size[1],
            row.invocations / texels,
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

/// Reads, bytes read and bytes written of all passes.
#[allow(clippy::cast_precision_loss, reason = "for people")]
fn sums(rows: &[Row]) -> [f64; 3] {
    let sum = |of: fn(&Row) -> f64| rows.iter().map(of).sum();
    [sum(|row| row.reads * row.invocations as f64), sum(|row| row.bytes_read), sum(|row| row.bytes_written as f64)]
}

fn report(rows: &[Row], picture: [u32; 2]) -> Value {
    let of = |row: &Row| {
        json!({
            "pass": row.pass, "texels": row.size, "invocations": row.invocations, "reads": row.reads,
            "bytes_read": row.bytes_read, "bytes_written": row.bytes_written,
        })
    };
    let [reads, bytes_read, bytes_written] = sums(rows);
    json!({
        "size": picture, "passes": rows.iter().map(of).collect::<Vec<_>>(), "reads": reads, "bytes_read": bytes_read,
        "bytes_written": bytes_written,
    })
}
