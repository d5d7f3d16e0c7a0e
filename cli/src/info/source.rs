//! What BTFs and BRDFs say of themselves that others made: folders of images, `.btf`, `.binary` and `.bsdf` files.

use serde_json::{Value, json};
use subsurf_encoder::capture::{Folder, Source, check_images, open_btf};
use subsurf_viewer::human;

use super::Args;
use crate::outln;
use crate::program::progress::Bars;

pub(super) fn info(args: &Args) -> anyhow::Result<()> {
    if args.file.is_dir() {
        let folder = Folder::open(&args.file)?;
        let simulated = folder.facts().and_then(|facts| facts.get("simulated")).cloned();
        let raw_bytes = folder.raw_bytes();
        return print(args, "images of a BTF", &folder, raw_bytes, simulated);
    }
    let extension = args.file.extension().unwrap_or_default().to_ascii_lowercase();
    let source = open_btf(&args.file)?;
    let kind = match extension.to_str() {
        Some("binary") => "isotropic BRDF of MERL",
        Some("bsdf") => "isotropic BRDF of RGL",
        _ => "compressed BTF of UBO2014",
    };
    let raw_bytes = std::fs::metadata(&args.file)?.len();
    print(args, kind, source.as_ref(), raw_bytes, None)
}

fn print(args: &Args, kind: &str, source: &dyn Source, raw_bytes: u64, simulated: Option<Value>) -> anyhow::Result<()> {
    check_images(source, &Bars::new())?;
    let ([width, height], is_linear) = (source.size(), source.white().is_none());
    let (lights, views) = (source.lights(), source.views());
    if args.json {
        let value = json!({
            "lights": lights.len(), "views": views.len(), "width": width, "height": height,
            "linear": is_linear, "raw_bytes": raw_bytes, "simulated": simulated,
        });
        outln!("{value:#}");
        return Ok(());
    }
    let pixels = match (is_linear, source.is_deep()) {
        (true, _) => "linear floats",
        (false, true) => "16-bit sRGB",
        (false, false) => "8-bit sRGB",
    };
    let (lights, views, raw) = (lights.len(), views.len(), human(raw_bytes));
    let path = args.file.display();
    if args.file.is_dir() {
        outln!(
            "{path}: {kind}, {lights} lights × {views} views, {width} × {height} pixels, {pixels}, {raw} uncompressed"
        );
    } else {
        outln!("{path}: {kind}, {lights} lights × {views} views, {width} × {height} pixels, {pixels}, {raw}");
    }
    if let Some(facts) = simulated {
        outln!("  synthetic: {facts}");
    }
    Ok(())
}
