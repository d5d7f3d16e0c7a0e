//! `subsurf-study bench render`: every technique against the reference gather.

mod page;
mod reference;

use std::path::PathBuf;

use image::RgbImage;
use subsurf_cli::info::parse;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::picture::{image, montage, write_picture};
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::{psnr_db, ssim};
use subsurf_runtime::{BACKGROUND, Backend, Gpu, RuntimeOptions};
use subsurf_scene::{Mesh, Scene};
use subsurf_viewer::{Asset, MappingChoice, RenderRequest, RenderSession, Scattering, choose_mapping, read, stem};

use self::page::{Page, Row};
use self::reference::{Reference, case_of, reference};
use super::case::{self, BenchCase};
use super::devices::to_compare;
use super::meshes::{EXTENT_MM, named};
use super::timing::{median, quantile};

/// Compare all paths with the reference gather: PSNR, SSIM, difference pictures, frame times and memory.
///
/// The reference gathers between points of the surface, by their distances in space. PSNR is of display values, over the
/// pixels that the mesh covers in either picture. Writes index.html, the pictures and render.json; pictures of the reference
/// that are in the folder, of the same material, mesh and size, are not drawn again.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// .subsurf files, one for each material
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Meshes: files, or names of shapes
    #[arg(long = "mesh", value_name = "FILE|SHAPE", default_values = ["knot", "bowl", "drapery", "relief"])]
    meshes: Vec<PathBuf>,
    /// Longest side of the meshes in mm
    #[arg(long, default_value_t = EXTENT_MM, value_name = "MM")]
    extent: f32,
    /// Folder for the page
    #[arg(long, short, value_name = "DIR")]
    output: PathBuf,
    /// Pixels of the pictures
    #[arg(long, default_value = "1280x720", value_name = "WxH")]
    size: Size,
    /// Frames to time of each path, the reference excepted, which is timed once; 0 to leave times out
    #[arg(long, default_value_t = 5)]
    frames: usize,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    std::fs::create_dir_all(&args.output)?;
    let gpus = to_compare();
    if gpus.is_empty() {
        return Err(bad_request("there is no device; this compares what devices draw"));
    }
    let meshes = args.meshes.iter().map(|path| named(path, args.extent)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut page = Page { folder: &args.output, rows: Vec::new(), pictures: Vec::new() };
    for file in &args.files {
        let bytes = read(file)?;
        let material = parse(file, &bytes)?;
        for (mesh_name, mesh) in &meshes {
            let case = case_of(&bytes, mesh, args.size.0);
            compare(args, &gpus, (&stem(file), &material), (mesh_name, mesh), case, &mut page)?;
        }
    }
    page.write(&gpus, args.size.0)?;
    Ok(())
}

/// All paths and devices on one mesh in one material.
fn compare(
    args: &Args,
    gpus: &[(Backend, Gpu)],
    (material_name, material): (&str, &Bssrdf<'_>),
    (mesh_name, mesh): (&str, &Mesh),
    case: u64,
    page: &mut Page<'_>,
) -> anyhow::Result<()> {
    let size = args.size.0;
    let mapping = choose_mapping(mesh, MappingChoice::Auto, material)?;
    let mut scene = RenderRequest::usual(size).scene(mesh);
    let lit = scene.clone();
    let compute = |technique, sky| Asset::compute(material, mesh, mapping, &lit, technique, sky);
    let splat = compute(Scattering::Splat, None)?;
    let separable = compute(Scattering::Separable, splat.sky().cloned())?;
    let homogeneous = compute(Scattering::Homogeneous, splat.sky().cloned())?;
    let paths = [("splat", &splat), ("separable", &separable), ("homogeneous", &homogeneous)];
    let (first, gpu) = &gpus[0];
    let session = |gpu, asset: &Asset, scene: &Scene| {
        RenderSession::new(gpu, asset.upload(gpu, material, mesh)?, scene, size, RuntimeOptions::default())
    };
    let name = format!("{material_name}-{mesh_name}");
    let Reference { exposure, pixels: reference } = reference(&args.output, &name, case, size[0], || {
        let mut scene = lit.clone();
        let exposure = session(gpu, &separable, &scene)?.exposure(gpu, &scene)?;
        scene.camera.exposure = exposure;
        let gather = compute(Scattering::Gather, None)?;
        Ok(Reference { exposure, pixels: session(gpu, &gather, &scene)?.picture(gpu, &scene)? })
    })?;
    scene.camera.exposure = exposure;
    let mut shown = vec![image(&reference, size[0])];
    for (backend, gpu) in gpus {
        let case = |asset: &Asset| BenchCase::new(gpu, || asset.upload(gpu, material, mesh), mesh, size);
        let gather_ms = match args.frames {
            0 => None,
            _ => {
                let gather = compute(Scattering::Gather, None)?;
                let mut cases = [case(&gather)?];
                case::run(gpu, &mut cases, mesh, size, 0)?;
                Some(median(&cases[0].times.frames))
            }
        };
        let mut cases = paths.iter().map(|(_, path)| case(path)).collect::<anyhow::Result<Vec<_>>>()?;
        if args.frames > 0 {
            case::run(gpu, &mut cases, mesh, size, args.frames)?;
        }
        for ((path, _), mut case) in paths.into_iter().zip(cases) {
            let found = case.picture(gpu, &scene)?;
            let times = case.times;
            let [material_bytes, buffer_bytes] = times.bytes_of_material_and_buffers();
            let (psnr_db, ssim) = similarity(&reference, &found, size[0]);
            let row = Row {
                material: material_name.to_owned(),
                mesh: mesh_name.to_owned(),
                path,
                backend: *backend,
                psnr_db,
                ssim,
                frame_ms: (args.frames > 0).then(|| [0.5, 0.95].map(|share| quantile(&times.frames, share))),
                gather_ms,
                material_bytes,
                buffer_bytes,
            };
            outln!("{}", row.line());
            page.rows.push(row);
            if backend == first {
                shown.push(image(&found, size[0]));
                shown.push(image(&differences(&reference, &found), size[0]));
            }
        }
    }
    let file = format!("{name}.png");
    let half = |picture: &RgbImage| {
        let (width, height) = picture.dimensions();
        image::imageops::resize(picture, width / 2, height / 2, image::imageops::FilterType::Triangle)
    };
    let small: Vec<RgbImage> = shown.iter().map(half).collect();
    let blank = RgbImage::from_pixel(small[0].width(), small[0].height(), image::Rgb([0; 3]));
    let pictures: Vec<RgbImage> =
        std::iter::once(small[0].clone()).chain(small[1..].iter().step_by(2).cloned()).collect();
    let errors = std::iter::once(blank).chain(small[1..].iter().skip(1).step_by(2).cloned()).collect();
    write_picture(&args.output.join(&file), &montage(&[pictures, errors]))?;
    page.pictures.push((format!("{material_name}, {mesh_name}"), file));
    Ok(())
}

/// PSNR over covered pixels, and SSIM of the whole picture, of display values.
fn similarity(reference: &[[u8; 3]], found: &[[u8; 3]], width: u32) -> (f64, f64) {
    let values = |pixels: &[[u8; 3]]| -> Vec<[f64; 3]> {
        pixels.iter().map(|pixel| pixel.map(|value| f64::from(value) / 255.0)).collect()
    };
    let (a, b) = (values(reference), values(found));
    let is_covered = |k: &usize| reference[*k] != [BACKGROUND; 3] || found[*k] != [BACKGROUND; 3];
    let covered: Vec<usize> = (0..a.len()).filter(is_covered).collect();
    let of = |pixels: &[[f64; 3]]| -> Vec<[f64; 3]> { covered.iter().map(|&k| pixels[k]).collect() };
    (psnr_db(&of(&a), &of(&b)), ssim(&a, &b, width as usize).unwrap_or(0.0))
}

/// Ten times the difference of two pictures.
fn differences(reference: &[[u8; 3]], found: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let pairs = reference.iter().zip(found);
    pairs.map(|(a, b)| [0, 1, 2].map(|c| a[c].abs_diff(b[c]).saturating_mul(10))).collect()
}
