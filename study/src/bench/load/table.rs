//! Results of loading as a table.

use std::fmt::Write as _;

use serde_json::Value;
use subsurf_viewer::human;

use crate::bench::timing::micros;

/// Ways to store a material, as results name them: capture, per-pixel profiles, 2-BMPP.
pub(super) const NAMES: [&str; 3] = ["capture", "profiles", "bmpp"];

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
    let _ = writeln!(out, "| | capture | per-pixel profiles | 2-BMPP |\n|---|---:|---:|---:|");
    let mut row = |name: &str, path: &str, show: fn(f64) -> String| {
        let values = NAMES.map(|storage| number(format!("/storage/{storage}{path}")));
        // Without a device there is no upload, and elsewhere than on Linux the page cache cannot be dropped.
        if values.iter().all(|value| value.is_none_or(|value| value == 0.0)) {
            return;
        }
        let [capture, profiles, bmpp] = values.map(|value| value.map_or("-".to_owned(), show));
        let _ = writeln!(out, "| {name} | {capture} | {profiles} | {bmpp} |");
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bytes")]
    let bytes = |value: f64| human(value as u64);
    row("file", "/bytes", bytes);
    row("on the device", "/gpu_bytes", bytes);
    row("peak resident memory", "/peak_rss_bytes", bytes);
    row("of it before loading", "/baseline_rss_bytes", bytes);
    for (kind, label) in [("warm_us", "warm"), ("cold_us", "cold")] {
        for step in ["read", "parse", "upload", "first_frame", "total"] {
            row(&format!("{label}: {}", step.replace('_', " ")), &format!("/{kind}/{step}"), micros);
        }
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
