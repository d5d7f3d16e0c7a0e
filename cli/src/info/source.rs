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
        return print(args, &folder, folder.raw_bytes(), simulated);
    }
    let source = open_btf(&args.file)?;
    print(args, source.as_ref(), std::fs::metadata(&args.file)?.len(), None)
}

fn print(args: &Args, source: &dyn Source, raw_bytes: u64, simulated: Option<Value>) -> anyhow::Result<()> {
    check_images(source, &Bars::new())?;
    let ([width, height], format) = (source.size(), source.format());
    let (lights, views) = (source.lights(), source.views());
    if args.json {
        let value = json!({
            "lights": lights.len(), "views": views.len(), "width": width, "height": height,
            "linear": format.is_linear(), "raw_bytes": raw_bytes, "simulated": simulated,
        });
        outln!("{value:#}");
        return Ok(());
    }
    let (path, kind, lights, views, raw) =
        (args.file.display(), source.kind(), lights.len(), views.len(), human(raw_bytes));
    let state = if args.file.is_dir() { " uncompressed" } else { "" };
    outln!("{path}: {kind}, {lights} lights × {views} views, {width} × {height} pixels, {format}, {raw}{state}");
    if let Some(facts) = simulated {
        outln!("  synthetic: {facts}");
    }
    Ok(())
}
