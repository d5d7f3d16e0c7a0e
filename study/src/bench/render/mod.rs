//! `subsurf-study bench render`: every technique against the reference gather.

mod page;
mod reference;
mod rivals;

use std::path::PathBuf;

use image::RgbImage;
use subsurf_cli::info::parse;
use subsurf_cli::options::Size;
use subsurf_cli::picture::{image, montage, write_picture};
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::{psnr_db, ssim};
use subsurf_runtime::{BACKGROUND, Backend, Gpu, RuntimeOptions};
use subsurf_scene::{Mesh, Scene};
use subsurf_viewer::{Asset, MappingChoice, RenderRequest, RenderSession, Scattering, choose_mapping, read, stem};

use self::page::{Page, Row};
use self::reference::{Reference, case_of, reference};
use self::rivals::Rival;
use super::case::{self, BenchCase, Times};
use super::devices::to_compare;
use super::meshes::{EXTENT_MM, named};
use super::timing::{median, quantile};

/// Compare all paths with the reference gather: PSNR, SSIM, difference pictures, frame times and memory.
///
/// The reference gathers between points of the surface, by their distances in space. PSNR is of display values, over the
/// pixels that the mesh covers in either picture. Writes index.html, the pictures, render.json and render.csv; pictures of the reference
/// that are in the folder, of the same material, mesh and size, are not drawn again.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// .subsurf files, one for each material
    #[arg(required = true)]
    pub(crate) files: Vec<PathBuf>,
    /// Meshes: files, or names of shapes
    #[arg(long = "mesh", value_name = "FILE|SHAPE", default_values = ["knot", "bowl", "drapery", "relief"])]
    pub(crate) meshes: Vec<PathBuf>,
    /// Longest side of the meshes in mm
    #[arg(long, default_value_t = EXTENT_MM, value_name = "MM")]
    pub(crate) extent: f32,
    /// Folder for the page
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Draw LinSSS, too, from the fits that `subsurf-study linsss` left in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) linsss: Option<PathBuf>,
    /// Draw these kernels, too, of a material that is the same everywhere: of `subsurf kernel FILE --base N`, or a profile's of one's own
    #[arg(long = "kernel", value_name = "FILE")]
    pub(crate) kernels: Vec<PathBuf>,
    /// Pixels of the pictures
    #[arg(long, default_value = "1280x720", value_name = "WxH")]
    pub(crate) size: Size,
    /// Frames to time of each path, the reference excepted, which is timed once; 0 to leave times out
    #[arg(long, default_value_t = 5)]
    pub(crate) frames: usize,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let gpus = to_compare();
    compared(args, &gpus)?.write(&gpus, args.size.0)
}

/// Compares all paths for a page that is about more: what it says of them as HTML, and all rows as CSV. The pictures stay in the folder.
pub(crate) fn section(args: &Args) -> anyhow::Result<(String, String)> {
    let page = compared(args, &to_compare())?;
    Ok((page.body()?, page.csv()))
}

/// All materials on all meshes.
fn compared<'a>(args: &'a Args, gpus: &[(Backend, Gpu)]) -> anyhow::Result<Page<'a>> {
    std::fs::create_dir_all(&args.output)?;
    if gpus.is_empty() {
        return Err(bad_request("there is no device; this compares what devices draw"));
    }
    let kernels = args.kernels.iter().map(|path| Rival::kernel(path)).collect::<anyhow::Result<Vec<_>>>()?;
    let meshes = args.meshes.iter().map(|path| named(path, args.extent)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut page = Page { folder: &args.output, rows: Vec::new(), pictures: Vec::new() };
    for file in &args.files {
        let bytes = read(file)?;
        let material = parse(file, &bytes)?;
        for (mesh_name, mesh) in &meshes {
            let case = case_of(&bytes, mesh, args.size.0);
            let of_file = (stem(file), bytes.len() as u64, &material);
            compare(args, gpus, &of_file, (mesh_name, mesh), (case, &kernels), &mut page)?;
        }
    }
    Ok(page)
}

/// All paths and devices on one mesh in one material.
fn compare(
    args: &Args,
    gpus: &[(Backend, Gpu)],
    (material_name, file_bytes, material): &(String, u64, &Bssrdf<'_>),
    (mesh_name, mesh): (&str, &Mesh),
    (case, kernels): (u64, &[Rival]),
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
    let rivals = match &args.linsss {
        Some(folder) => Rival::linsss(folder, material_name, material)?,
        None => Vec::new(),
    };
    let rivals: Vec<&Rival> = rivals.iter().chain(kernels).collect();
    let sky = splat.sky().map(|sky| sky.as_slice());
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
        let row = |path: String, similarity, times: &Times, gather_ms, file_bytes| {
            let [material_bytes, buffer_bytes] = times.bytes_of_material_and_buffers();
            Row {
                material: material_name.clone(),
                mesh: mesh_name.to_owned(),
                path,
                backend: *backend,
                similarity,
                frame_ms: (args.frames > 0).then(|| [0.5, 0.95].map(|share| quantile(&times.frames, share))),
                gather_ms,
                file_bytes,
                material_bytes,
                buffer_bytes,
            }
        };
        let gather_ms = match args.frames {
            0 => None,
            _ => {
                let gather = compute(Scattering::Gather, None)?;
                let mut cases = [case(&gather)?];
                case::run(gpu, &mut cases, mesh, size, 0)?;
                let times = &cases[0].times;
                let gather_ms = Some(median(&times.frames));
                page.add(row("gather".to_owned(), None, times, gather_ms, *file_bytes));
                gather_ms
            }
        };
        let of_rivals =
            rivals.iter().map(|rival| BenchCase::new(gpu, || rival.upload(gpu, mesh, mapping, sky), mesh, size));
        let mut cases =
            paths.iter().map(|(_, path)| case(path)).chain(of_rivals).collect::<anyhow::Result<Vec<_>>>()?;
        let names = paths.iter().map(|(name, _)| ((*name).to_owned(), *file_bytes));
        let names = names.chain(rivals.iter().map(|rival| (rival.name.clone(), rival.file_bytes)));
        if args.frames > 0 {
            case::run(gpu, &mut cases, mesh, size, args.frames)?;
        }
        for ((path, file_bytes), mut case) in names.zip(cases) {
            let found = case.picture(gpu, &scene)?;
            let similarity = Some(similarity(&reference, &found, size[0]));
            page.add(row(path, similarity, &case.times, gather_ms, file_bytes));
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
    let of_rivals = rivals.iter().map(|rival| rival.name.clone());
    let shown = paths.iter().map(|(name, _)| (*name).to_owned()).chain(of_rivals).collect::<Vec<_>>().join(", ");
    page.pictures.push((format!("{material_name}, {mesh_name}: reference, {shown}"), file));
    Ok(())
}

/// PSNR over covered pixels, and SSIM of the whole picture, of display values.
fn similarity(reference: &[[u8; 3]], found: &[[u8; 3]], width: u32) -> [f64; 2] {
    let values = |pixels: &[[u8; 3]]| -> Vec<[f64; 3]> {
        pixels.iter().map(|pixel| pixel.map(|value| f64::from(value) / 255.0)).collect()
    };
    let (a, b) = (values(reference), values(found));
    let is_covered = |k: &usize| reference[*k] != [BACKGROUND; 3] || found[*k] != [BACKGROUND; 3];
    let covered: Vec<usize> = (0..a.len()).filter(is_covered).collect();
    let of = |pixels: &[[f64; 3]]| -> Vec<[f64; 3]> { covered.iter().map(|&k| pixels[k]).collect() };
    [psnr_db(&of(&a), &of(&b)), ssim(&a, &b, width as usize).unwrap_or(0.0)]
}

/// Ten times the difference of two pictures.
fn differences(reference: &[[u8; 3]], found: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let pairs = reference.iter().zip(found);
    pairs.map(|(a, b)| [0, 1, 2].map(|c| a[c].abs_diff(b[c]).saturating_mul(10))).collect()
}
