//! Load size and latency of a BTF: its file beside its images, uncompressed in one array.

use std::io::Write as _;
use std::path::Path;

use serde_json::json;
use subsurf_decoder::Btf;
use subsurf_encoder::Progress as _;
use subsurf_encoder::Unfinished;
use subsurf_encoder::btf::{Folder, Images};
use subsurf_runtime::{
    BtfImages, BtfLayout, BtfMaterial, Drawable, Gpu, GpuMesh, Renderer, RuntimeOptions, Technique, VertexData,
};
use subsurf_scene::{Mesh, Placement, Scene, relief};

use super::load::{self, load_one, micros};
use super::load_one::Clock;
use super::timing::{Steps, Storage};
use crate::failure::bad_request;
use crate::info::parse_btf;
use crate::memory::human;
use crate::progress::Bars;
use crate::render::{Shot, in_bytes, read_images};
use crate::say::say;

/// Pixels to a side of the first frame.
const FRAME: [u32; 2] = [64; 2];
/// Copies of the material on the mesh of the first frame.
const COPIES: [f32; 2] = [4.0; 2];

/// Loads a file and its images, each in a process of its own.
pub(super) fn run(args: &load::Args, file: &Path, images: &Path) -> anyhow::Result<()> {
    let folder = args.folder()?;
    let _goes_when_interrupted = Unfinished::new(folder.path());
    let array = folder.path().join("images.raw");
    let loaded = read_images(images)?;
    write_array(&array, &loaded)?;
    let (size, pairs) = (loaded.size(), loaded.pairs());
    drop(loaded);
    let bars = Bars::new();
    bars.begin("loading", 2);
    let one = |path: &Path| {
        let found = load_one(path, Some(images), args.runs, args.backend);
        bars.advance(1);
        found
    };
    let (compressed, raw) = (one(file)?, one(&array)?);
    let load = |steps: &Option<Steps>| steps.map(|steps| steps.load());
    #[allow(clippy::cast_precision_loss, reason = "ratios for people")]
    let bytes = raw.bytes as f64 / compressed.bytes as f64;
    let warm = raw.warm_us.load() / compressed.warm_us.load();
    let cold = load(&raw.cold_us).zip(load(&compressed.cold_us)).map(|(raw, compressed)| raw / compressed);
    if args.json {
        let value = json!({
            "runs": args.runs, "device": load::device(args.backend)?, "width": size[0], "height": size[1], "pairs": pairs,
            "layout": { "images": raw, "file": compressed },
            "images_over_file": { "bytes": bytes, "load_warm": warm, "load_cold": cold },
        });
        say!("{value:#}");
        return Ok(());
    }
    say!("{} × {} texels, {pairs} pairs of directions\n\n| | images | file |\n|---|---:|---:|", size[0], size[1]);
    let row = |name: &str, of: &dyn Fn(&Storage) -> Option<f64>, show: fn(f64) -> String| {
        if let (Some(raw), Some(compressed)) = (of(&raw), of(&compressed)) {
            say!("| {name} | {} | {} |", show(raw), show(compressed));
        }
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bytes")]
    let size_of = |value: f64| human(value as u64);
    #[allow(clippy::cast_precision_loss, reason = "bytes for people")]
    let bytes_of = |bytes: u64| Some(bytes as f64);
    row("file", &|layout| bytes_of(layout.bytes), size_of);
    row("on the device", &|layout| bytes_of(layout.gpu_bytes), size_of);
    row("peak resident memory", &|layout| bytes_of(layout.peak_rss_bytes), size_of);
    row("of it before loading", &|layout| bytes_of(layout.baseline_rss_bytes), size_of);
    type Step = (&'static str, fn(&Steps) -> f64);
    let steps: [Step; 5] = [
        ("read", |steps| steps.read),
        ("parse", |steps| steps.parse),
        ("upload", |steps| steps.upload),
        ("first frame", |steps| steps.first_frame),
        ("total", |steps| steps.total),
    ];
    for (name, of) in steps {
        row(&format!("warm: {name}"), &|layout| Some(of(&layout.warm_us)), micros);
    }
    for (name, of) in steps {
        row(&format!("cold: {name}"), &|layout| layout.cold_us.as_ref().map(of), micros);
    }
    let cold = cold.map_or("-".to_owned(), |ratio| format!("{ratio:.0}"));
    say!(
        "\nimages over file: {bytes:.0} × the bytes; read, parse and upload take {warm:.0} × as long warm, {cold} × cold"
    );
    Ok(())
}

/// All pixels, `[light][view][pixel][rgb]`, in bytes.
fn write_array(path: &Path, images: &Images) -> anyhow::Result<()> {
    let bars = Bars::new();
    bars.begin("writing the images as an array", images.pairs() as u64);
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    for pair in 0..images.pairs() {
        file.write_all(in_bytes(images, pair).as_flattened())?;
        bars.advance(1);
    }
    file.flush()?;
    Ok(())
}

/// What an application has before it loads its first BTF.
pub(super) struct Bench<'a> {
    gpu: Option<&'a Gpu>,
    path: &'a Path,
    layout: BtfLayout,
    size: [u32; 2],
    lights: Vec<glam::Vec3>,
    views: Vec<glam::Vec3>,
    scene: Scene,
    drawn: Option<(Renderer, GpuMesh)>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path, images: &Path) -> anyhow::Result<Self> {
        let folder = Folder::open(images)?;
        let is_array = path.extension().is_some_and(|extension| extension == "raw");
        let layout = if is_array { BtfLayout::Images } else { BtfLayout::Nested };
        let mesh: Mesh = relief(20.0, 8, 22);
        let draw = |gpu: &Gpu| -> anyhow::Result<_> {
            let renderer = Renderer::new(gpu, Technique::Btf(layout), RuntimeOptions::default())?;
            let tangents = mesh.tangents()?;
            Ok((
                renderer,
                GpuMesh::upload(gpu, &mesh, &Placement::of_btf(&mesh, COPIES), VertexData::Tangents(&tangents))?,
            ))
        };
        Ok(Self {
            gpu,
            path,
            layout,
            size: folder.size(),
            lights: folder.lights().iter().map(|light| light.unit()).collect(),
            views: folder.views().iter().map(|view| view.unit()).collect(),
            scene: Shot::usual(FRAME).scene(&mesh),
            drawn: gpu.map(draw).transpose()?,
        })
    }

    /// File to picture, once; and the material's bytes on the device.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        // There is nothing to check in an array but its length.
        let btf = match self.layout {
            BtfLayout::Nested => Some(parse_btf(self.path, &bytes)?),
            BtfLayout::Images if bytes.len() == self.lights.len() * self.views.len() * self.image_len() => None,
            BtfLayout::Images => return Err(bad_request("the array has not the length of its images")),
        };
        let parse = clock.lap();
        let (upload, first_frame, gpu_bytes) = match (self.gpu, &self.drawn) {
            (Some(gpu), Some((renderer, mesh))) => {
                let material = self.upload(gpu, btf.as_ref(), &bytes)?;
                gpu.finish()?;
                let upload = clock.lap();
                let model = Drawable::Btf { mesh, material: &material, number: 0 };
                let target = gpu.target(FRAME, RuntimeOptions::default().format)?;
                let mut frame = renderer.prepare(gpu, &model, &self.scene, FRAME)?;
                renderer.draw(gpu, &mut frame, &model, &self.scene, target.view())?;
                gpu.finish()?;
                (upload, clock.lap(), material.gpu_bytes())
            }
            _ => {
                std::hint::black_box(self.picture(btf.as_ref(), &bytes));
                (0.0, clock.lap(), 0)
            }
        };
        Ok((Steps { read, parse, upload, first_frame, total: read + parse + upload + first_frame }, gpu_bytes))
    }

    fn image_len(&self) -> usize {
        3 * self.size.iter().map(|side| *side as usize).product::<usize>()
    }

    /// The bytes of an image.
    fn image<'b>(&self, bytes: &'b [u8], light: usize, view: usize) -> &'b [[u8; 3]] {
        let len = self.image_len();
        let first = (light * self.views.len() + view) * len;
        bytes.get(first..first + len).unwrap_or(&[]).as_chunks().0
    }

    fn upload(&self, gpu: &Gpu, btf: Option<&Btf<'_>>, bytes: &[u8]) -> anyhow::Result<BtfMaterial> {
        Ok(if let Some(btf) = btf {
            BtfMaterial::upload(gpu, btf)?
        } else {
            let images = BtfImages { size: self.size, lights: &self.lights, views: &self.views, white: 1.0 };
            BtfMaterial::upload_images(gpu, &images, |light, view| self.image(bytes, light, view).to_vec())?
        })
    }

    /// Texels under the last light, seen from the last view.
    fn picture(&self, btf: Option<&Btf<'_>>, bytes: &[u8]) -> Vec<[f32; 3]> {
        let (light, view) = (self.lights.len() - 1, self.views.len() - 1);
        let texels = (0..FRAME[0] * FRAME[1]).map(|k| [(k % FRAME[0]).cast_signed(), (k / FRAME[0]).cast_signed()]);
        match btf {
            Some(btf) => {
                let (light, view) = (self.lights[light].to_array(), btf.grid().view(self.views[view].to_array()));
                let value = |at| btf.texel(0, 0, at).map_or([0.0; 3], |texel| btf.eval_for(texel, light, &view));
                texels.map(value).collect()
            }
            None => {
                let image = self.image(bytes, light, view);
                let value = |[x, y]: [i32; 2]| {
                    let at = y.rem_euclid(self.size[1].cast_signed()) * self.size[0].cast_signed()
                        + x.rem_euclid(self.size[0].cast_signed());
                    let pixel = usize::try_from(at).ok().and_then(|at| image.get(at)).copied().unwrap_or_default();
                    pixel.map(|byte| f32::from(byte) / 255.0)
                };
                texels.map(value).collect()
            }
        }
    }
}
