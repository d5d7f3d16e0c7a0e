//! Results of loading as a table.

use std::fmt::Write as _;

use serde_json::Value;
use subsurf_viewer::human;

use super::bssrdf::STORAGES;
use crate::bench::timing::micros;

/// Pixels of the paper's onyx.
const ONYX: f64 = 229.0 * 229.0;
/// What the paper published of its onyx, per-pixel profiles and 2-BMPP: sizes, and how long they loaded on an HTC Nexus 9
/// (Yatagawa et al. 2020, section 4.2).
const PUBLISHED: [(&str, &str); 2] = [("profiles", "11.4 MB in 6.60 s"), ("bmpp", "335 kB in 0.28 s")];

/// Result of [`measure`](super::bssrdf::measure) as a table in Markdown.
pub(super) fn markdown(result: &Value) -> String {
    let mut out = String::new();
    let text = |path: &str| result.pointer(path).map(ToString::to_string).unwrap_or_default();
    let number = |path: String| result.pointer(&path).and_then(Value::as_f64);
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "{} × {} pixels, window {}, M = {}, S = {} ({})\n",
        text("/width"),
        text("/height"),
        text("/window"),
        text("/base_materials"),
        text("/samples"),
        text("/source").trim_matches('"'),
    );
    let _ = writeln!(
        out,
        "| | capture, gather | per-pixel profiles, gather | the same, splat | 2-BMPP, gather | the same, splat | with a basis, \
         separable |\n|---|---:|---:|---:|---:|---:|---:|"
    );
    let mut row = |name: &str, path: &str, show: fn(f64) -> String| {
        let values = STORAGES.map(|(storage, ..)| number(format!("/storage/{storage}{path}")));
        // Without a device there is no upload, and elsewhere than on Linux the page cache cannot be dropped.
        if values.iter().all(|value| value.is_none_or(|value| value == 0.0)) {
            return;
        }
        let shown = values.map(|value| value.filter(|value| *value > 0.0).map_or("-".to_owned(), show));
        let _ = writeln!(out, "| {name} | {} |", shown.join(" | "));
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bytes")]
    let bytes = |value: f64| human(value as u64);
    row("file", "/bytes", bytes);
    row("on the device", "/gpu_bytes", bytes);
    row("peak resident memory", "/peak_rss_bytes", bytes);
    row("of it before loading", "/baseline_rss_bytes", bytes);
    row("pipelines, once", "/pipelines_us", micros);
    for (kind, label) in [("warm_us", "warm"), ("cold_us", "cold")] {
        for step in ["read", "parse", "upload", "projection", "recording", "first_frame", "total"] {
            let name = if step == "recording" { "of it recording" } else { step };
            row(&format!("{label}: {}", name.replace('_', " ")), &format!("/{kind}/{step}"), micros);
        }
    }
    if number("/pixels".to_owned()) == Some(ONYX) {
        let published =
            STORAGES.map(|(storage, ..)| PUBLISHED.iter().find(|(of, _)| *of == storage).map_or("-", |of| of.1));
        let _ = writeln!(
            out,
            "| published: loading on an HTC Nexus 9 (Yatagawa et al. 2020) | {} |",
            published.join(" | ")
        );
    }
    if let Some(ratio) = number("/separable_cpu_over_bmpp".to_owned()) {
        let _ = writeln!(
            out,
            "\nwork of the CPU besides pipelines (parse, upload, recording), separable over plain planes: {ratio:.1} ×"
        );
    }
    for (name, path) in [("capture", "capture_over_bmpp"), ("per-pixel profiles", "profiles_over_bmpp")] {
        let ratio = |key: &str| number(format!("/ratios/{path}/{key}")).map_or("-".to_owned(), |r| format!("{r:.0}"));
        let _ = writeln!(
            out,
            "\n{name} over 2-BMPP: {} × the bytes; read, parse and upload take {} × as long warm, {} × cold",
            ratio("bytes"),
            ratio("load_warm"),
            ratio("load_cold"),
        );
    }
    let part = |name: &str| number(format!("/storage/bmpp/{name}")).map_or("-".to_owned(), micros);
    let _ = writeln!(
        out,
        "\n2-BMPP parse: structure and values {}, CRC-32 {}; a memcpy of the file {}",
        part("checks_us"),
        part("crc_us"),
        part("memcpy_us"),
    );
    out
}
