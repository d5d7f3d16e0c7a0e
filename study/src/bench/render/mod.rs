//! `subsurf bench render`: how close every path comes to the reference, and what it costs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use image::RgbImage;
use serde_json::{Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::{psnr_db, ssim};
use subsurf_encoder::write_bytes;
use subsurf_runtime::scene::{Mesh, Scene};
use subsurf_runtime::{BACKGROUND, Backend, Gpu, RuntimeOptions};

use super::course::{self, Course};
use super::frames::named;
use super::timing::{median, quantile};
use crate::devices::to_compare;
use crate::failure::bad_request;
use crate::info::{parse, read_file};
use crate::memory::human;
use crate::mesh::stem;
use crate::options::Size;
use crate::picture::{image, montage, write_png};
use crate::render::{Ingredients, MappingArg, PathArg, Ready, Shot, choose_mapping};
use crate::say::say;

/// Compare all paths with the reference gather: PSNR, SSIM, difference pictures, frame times and memory.
///
/// The reference gathers between points of the surface, by their distances in space. PSNR is of display values, over the
/// pixels that the mesh covers in either picture. Writes index.html, the pictures and render.json.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// .subsurf files, one for each material
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Meshes: files, or names of shapes
    #[arg(long = "mesh", value_name = "FILE|SHAPE", default_values = ["knot", "bowl", "drapery", "relief"])]
    meshes: Vec<PathBuf>,
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

/// One path, one material, one mesh, one device.
struct Row {
    material: String,
    mesh: String,
    path: &'static str,
    backend: Backend,
    psnr_db: f64,
    ssim: f64,
    /// Median and 95th percentile of frames in ms.
    frame_ms: Option<[f64; 2]>,
    /// Of the reference, in the same run.
    gather_ms: Option<f64>,
    material_bytes: u64,
    buffer_bytes: u64,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    std::fs::create_dir_all(&args.output)?;
    let gpus = to_compare();
    if gpus.is_empty() {
        return Err(bad_request("there is no device; this compares what devices draw"));
    }
    let meshes = args.meshes.iter().map(|path| named(path)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut page = Page { folder: &args.output, rows: Vec::new(), pictures: Vec::new() };
    for file in &args.files {
        let bytes = read_file(file)?;
        let material = parse(file, &bytes)?;
        for (mesh_name, mesh) in &meshes {
            compare(args, &gpus, (&stem(file), &material), (mesh_name, mesh), &mut page)?;
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
    page: &mut Page<'_>,
) -> anyhow::Result<()> {
    let size = args.size.0;
    let mapping = choose_mapping(mesh, MappingArg::Auto, material)?;
    let mut scene = Shot::usual(size).scene(mesh);
    let compute = |path, sky| Ingredients::compute(material, mesh, mapping, &scene, path, sky);
    let gather = compute(PathArg::Gather, None)?;
    let splat = compute(PathArg::Splat, None)?;
    let separable = compute(PathArg::Separable, splat.sky().cloned())?;
    let homogeneous = compute(PathArg::Homogeneous, splat.sky().cloned())?;
    let paths = [("splat", &splat), ("separable", &separable), ("homogeneous", &homogeneous)];
    let (first, gpu) = &gpus[0];
    let ready = |gpu, ingredients: &Ingredients, scene: &Scene| {
        Ready::new(gpu, ingredients.upload(gpu, material, mesh)?, scene, size, RuntimeOptions::default())
    };
    let exposure = ready(gpu, &separable, &scene)?.exposure(gpu, &scene)?;
    scene.view.exposure = exposure;
    let reference = ready(gpu, &gather, &scene)?.picture(gpu, &scene)?;
    let mut shown = vec![image(&reference, size[0])];
    for (backend, gpu) in gpus {
        let course = |ingredients| Course::new(gpu, ingredients, material, mesh, size);
        let gather_ms = match args.frames {
            0 => None,
            _ => {
                let mut courses = [course(&gather)?];
                course::run(gpu, &mut courses, mesh, size, 0)?;
                Some(median(&courses[0].times.frames))
            }
        };
        let mut courses = paths.iter().map(|(_, path)| course(path)).collect::<anyhow::Result<Vec<_>>>()?;
        if args.frames > 0 {
            course::run(gpu, &mut courses, mesh, size, args.frames)?;
        }
        for ((path, _), mut course) in paths.into_iter().zip(courses) {
            let found = course.picture(gpu, &scene)?;
            let times = course.times;
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
                material_bytes: times.material_bytes,
                buffer_bytes: times.buffer_bytes,
            };
            say!("{}", row.line());
            page.rows.push(row);
            if backend == first {
                shown.push(image(&found, size[0]));
                shown.push(image(&differences(&reference, &found), size[0]));
            }
        }
    }
    let file = format!("{material_name}-{mesh_name}.png");
    let half = |picture: &RgbImage| {
        let (width, height) = picture.dimensions();
        image::imageops::resize(picture, width / 2, height / 2, image::imageops::FilterType::Triangle)
    };
    let small: Vec<RgbImage> = shown.iter().map(half).collect();
    let blank = RgbImage::from_pixel(small[0].width(), small[0].height(), image::Rgb([0; 3]));
    let pictures: Vec<RgbImage> =
        std::iter::once(small[0].clone()).chain(small[1..].iter().step_by(2).cloned()).collect();
    let errors = std::iter::once(blank).chain(small[1..].iter().skip(1).step_by(2).cloned()).collect();
    write_png(&args.output.join(&file), &montage(&[pictures, errors]))?;
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

/// Ten times the difference.
fn differences(reference: &[[u8; 3]], found: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let pairs = reference.iter().zip(found);
    pairs.map(|(a, b)| [0, 1, 2].map(|c| a[c].abs_diff(b[c]).saturating_mul(10))).collect()
}

impl Row {
    fn line(&self) -> String {
        let time = self.frame_ms.map_or(String::new(), |[median, p95]| format!(", {median:.1} ms (p95 {p95:.1})"));
        let ratio = match (self.frame_ms, self.gather_ms) {
            (Some([median, _]), Some(gather)) => format!(", gather {gather:.0} ms = {:.1} ×", gather / median),
            _ => String::new(),
        };
        format!(
            "{}, {}, {}: {:<11} {:.1} dB, SSIM {:.3}{time}{ratio}; material {}, buffers {}",
            self.material,
            self.mesh,
            self.backend,
            self.path,
            self.psnr_db,
            self.ssim,
            human(self.material_bytes),
            human(self.buffer_bytes),
        )
    }

    fn json(&self) -> Value {
        json!({
            "material": self.material, "mesh": self.mesh, "path": self.path, "backend": self.backend.to_string(),
            "psnr_db": self.psnr_db, "ssim": self.ssim, "frame_median_ms": self.frame_ms.map(|times| times[0]),
            "frame_p95_ms": self.frame_ms.map(|times| times[1]), "gather_ms": self.gather_ms,
            "material_bytes": self.material_bytes, "buffer_bytes": self.buffer_bytes,
        })
    }

    fn cells(&self) -> String {
        let time = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.1}"));
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1}</td><td>{:.3}</td><td>{}</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{}</td></tr>",
            self.material,
            self.mesh,
            self.path,
            self.backend,
            self.psnr_db,
            self.ssim,
            time(self.frame_ms.map(|times| times[0])),
            time(self.frame_ms.map(|times| times[1])),
            time(self.gather_ms),
            human(self.material_bytes),
            human(self.buffer_bytes),
        )
    }
}

struct Page<'a> {
    folder: &'a Path,
    rows: Vec<Row>,
    /// Title and file.
    pictures: Vec<(String, String)>,
}

impl Page<'_> {
    fn write(&self, gpus: &[(Backend, Gpu)], [width, height]: [u32; 2]) -> anyhow::Result<()> {
        let rows: Vec<Value> = self.rows.iter().map(Row::json).collect();
        write_bytes(&self.folder.join("render.json"), format!("{:#}\n", Value::Array(rows)).as_bytes())?;
        let mut out = String::from("<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>paths</title>");
        let _ = write!(out, "<style>{}</style><body>", include_str!("../study/page.css"));
        let devices: Vec<String> =
            gpus.iter().map(|(backend, gpu)| format!("{backend}: {}", gpu.info().name)).collect();
        let _ = write!(
            out,
            "<h1>Paths against the reference</h1><p class=\"note\">Every path draws the same scene at {width} × {height} \
             pixels: one directional light with shadow, a dim studio around, a coat of roughness 0.25. The reference gathers light \
             between points of the surface by their distances in space. PSNR is of display values over the pixels that the \
             mesh covers in either picture; SSIM is of the whole picture. Times are medians of whole frames until the device \
             is through, the light turning from frame to frame; those of one device come from one run and compare with each \
             other only. {}.</p>",
            devices.join("; ")
        );
        out.push_str(
            "<table><thead><tr><th>material</th><th>mesh</th><th>path</th><th>device</th><th>PSNR, dB</th><th>SSIM</th>\
             <th>frame, ms</th><th>p95</th><th>gather, ms</th><th>material</th><th>buffers</th></tr></thead>",
        );
        self.rows.iter().for_each(|row| out.push_str(&row.cells()));
        out.push_str(
            "</table><p class=\"note\">Pictures: reference, splat, separable, homogeneous; below each its difference from \
             the reference, ten times.</p>",
        );
        for (title, file) in &self.pictures {
            let bytes = std::fs::read(self.folder.join(file))?;
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            let _ = write!(out, "<h3>{title}</h3><img style=\"max-width:100%\" src=\"data:image/png;base64,{data}\">");
        }
        out.push_str("</body></html>\n");
        write_bytes(&self.folder.join("index.html"), out.as_bytes())?;
        say!("\n{}", self.folder.join("index.html").display());
        Ok(())
    }
}
