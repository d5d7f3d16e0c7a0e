//! Load size and latency of a BTF: its file beside its images, uncompressed in one array.

use std::io::Write as _;
use std::path::Path;

use serde_json::json;
use subsurf_cli::images::FolderImages;
use subsurf_cli::outln;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::Progress as _;
use subsurf_encoder::Unfinished;
use subsurf_viewer::{BtfImageSet as _, human};

use super::options::{LoadOptions, load_one};
use super::results::{Steps, Storage};
use crate::bench::timing::micros;

/// Loads a file and its images, each in a process of its own.
pub(super) fn run(options: &LoadOptions, file: &Path, images: &Path) -> anyhow::Result<()> {
    let folder = options.folder()?;
    let _goes_when_interrupted = Unfinished::new(folder.path());
    let array = folder.path().join("images.raw");
    let loaded = FolderImages::read(images)?;
    write_array(&array, &loaded)?;
    let (size, pairs) = (loaded.size(), loaded.pairs());
    drop(loaded);
    let bars = Bars::new();
    bars.begin("loading", 2);
    let one = |path: &Path| {
        let found = load_one(path, &["--images".as_ref(), images.as_os_str()], options);
        bars.advance(1);
        found
    };
    let (compressed, raw) = (one(file)?, one(&array)?);
    let load = |steps: &Option<Steps>| steps.map(|steps| steps.load());
    #[allow(clippy::cast_precision_loss, reason = "ratios for people")]
    let bytes = raw.bytes as f64 / compressed.bytes as f64;
    let warm = raw.warm_us.load() / compressed.warm_us.load();
    let cold = load(&raw.cold_us).zip(load(&compressed.cold_us)).map(|(raw, compressed)| raw / compressed);
    if options.json {
        let value = json!({
            "runs": options.runs, "device": options.device()?, "width": size[0], "height": size[1], "pairs": pairs,
            "storage": { "images": raw, "file": compressed },
            "images_over_file": { "bytes": bytes, "load_warm": warm, "load_cold": cold },
        });
        outln!("{value:#}");
        return Ok(());
    }
    outln!("{} × {} texels, {pairs} pairs of directions\n\n| | images | file |\n|---|---:|---:|", size[0], size[1]);
    let row = |name: &str, of: &dyn Fn(&Storage) -> Option<f64>, show: fn(f64) -> String| {
        if let (Some(raw), Some(compressed)) = (of(&raw), of(&compressed)) {
            outln!("| {name} | {} | {} |", show(raw), show(compressed));
        }
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bytes")]
    let size_of = |value: f64| human(value as u64);
    #[allow(clippy::cast_precision_loss, reason = "bytes for people")]
    let bytes_of = |bytes: u64| Some(bytes as f64);
    row("file", &|storage| bytes_of(storage.bytes), size_of);
    row("on the device", &|storage| bytes_of(storage.gpu_bytes), size_of);
    row("peak resident memory", &|storage| bytes_of(storage.peak_rss_bytes), size_of);
    row("of it before loading", &|storage| bytes_of(storage.baseline_rss_bytes), size_of);
    row("pipelines, once", &|storage| Some(storage.pipelines_us), micros);
    for (name, of) in Steps::UNPROJECTED {
        row(&format!("warm: {name}"), &|storage| Some(of(&storage.warm_us)), micros);
    }
    for (name, of) in Steps::UNPROJECTED {
        row(&format!("cold: {name}"), &|storage| storage.cold_us.as_ref().map(of), micros);
    }
    let cold = cold.map_or("-".to_owned(), |ratio| format!("{ratio:.0}"));
    outln!(
        "\nimages over file: {bytes:.0} × the bytes; read, parse and upload take {warm:.0} × as long warm, {cold} × cold"
    );
    Ok(())
}

/// All pixels, `[light][view][pixel][rgb]`, in bytes.
fn write_array(path: &Path, images: &FolderImages) -> anyhow::Result<()> {
    let bars = Bars::new();
    bars.begin("writing the images as an array", images.pairs() as u64);
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    for light in 0..images.lights().len() {
        for view in 0..images.views().len() {
            file.write_all(images.image(light, view).as_flattened())?;
            bars.advance(1);
        }
    }
    file.flush()?;
    Ok(())
}
