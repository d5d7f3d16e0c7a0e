//! Pictures in rows and columns, with axes in millimetres and a colour bar, as SVG.

use std::fmt::Write as _;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::Rgb;

/// Width of a picture on the page, in its pixels.
const SIDE: usize = 130;
const GAP: usize = 10;
const LEFT: usize = 74;
const TOP: usize = 24;
const BOTTOM: usize = 34;
const BAR: usize = 92;

/// Row of a panel: its title and its pictures, PNG; `None` leaves a hole.
pub(crate) struct Row {
    pub(crate) title: String,
    pub(crate) pictures: Vec<Option<Vec<u8>>>,
}

/// Colour bar beside a panel.
pub(crate) struct Bar {
    pub(crate) title: &'static str,
    /// What stands beside the bar, with its place from 0, the lower end, to 1.
    pub(crate) ticks: Vec<(String, f64)>,
    pub(crate) colour: fn(f64) -> Rgb<u8>,
}

/// A panel of PNG pictures, each `mm` wide and high.
pub(crate) fn panel(columns: &[String], rows: &[Row], mm: [f64; 2], bar: Option<&Bar>) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels on a page")]
    let height = (SIDE as f64 * mm[1] / mm[0]).round().max(1.0) as usize;
    let step = [SIDE + GAP, height + GAP];
    let size =
        [LEFT + columns.len() * step[0] + if bar.is_some() { BAR } else { 0 }, TOP + rows.len() * step[1] + BOTTOM];
    let mut out = format!("<svg class=\"panel\" viewBox=\"0 0 {} {}\" width=\"{}\">", size[0], size[1], size[0]);
    for (column, title) in columns.iter().enumerate() {
        let x = LEFT + column * step[0] + SIDE / 2;
        text(&mut out, [x as f64, TOP as f64 - 8.0], "middle", title);
    }
    for (line, row) in rows.iter().enumerate() {
        let y = TOP + line * step[1];
        let middle = y as f64 + height as f64 / 2.0;
        let _ = write!(
            out,
            "<text x=\"12\" y=\"{middle}\" text-anchor=\"middle\" transform=\"rotate(-90 12 {middle})\">{}</text>",
            row.title
        );
        for (column, picture) in row.pictures.iter().enumerate() {
            let x = LEFT + column * step[0];
            if let Some(png) = picture {
                let _ = write!(
                    out,
                    "<image x=\"{x}\" y=\"{y}\" width=\"{SIDE}\" height=\"{height}\" preserveAspectRatio=\"none\" \
                     href=\"data:image/png;base64,{}\"/>",
                    STANDARD.encode(png)
                );
            }
            let _ = write!(out, "<rect x=\"{x}\" y=\"{y}\" width=\"{SIDE}\" height=\"{height}\" class=\"frame\"/>");
        }
        // The vertical axis of the row.
        for part in [0.0, 0.5, 1.0] {
            // Inside the row's height, so that rows do not run into each other.
            let at = [LEFT as f64 - 5.0, y as f64 + 9.0 + part * (height as f64 - 10.0)];
            text(&mut out, at, "end", &length(part * mm[1]));
        }
        text(&mut out, [LEFT as f64 - 34.0, middle + 4.0], "middle", "mm");
    }
    let foot = (TOP + rows.len() * step[1]) as f64;
    for column in 0..columns.len() {
        let x = (LEFT + column * step[0]) as f64;
        for (part, anchor) in [(0.0, "start"), (0.5, "middle"), (1.0, "end")] {
            let label = if part == 0.5 { format!("{} mm", length(part * mm[0])) } else { length(part * mm[0]) };
            text(&mut out, [x + part * SIDE as f64, foot + 6.0], anchor, &label);
        }
    }
    if let Some(bar) = bar {
        let x = LEFT + columns.len() * step[0] + 8;
        colour_bar(&mut out, bar, [x as f64, foot - (GAP + height) as f64], height as f64);
    }
    out.push_str("</svg>");
    out
}

fn colour_bar(out: &mut String, bar: &Bar, [x, y]: [f64; 2], height: f64) {
    const STEPS: u32 = 64;
    for step in 0..STEPS {
        let place = (f64::from(step) + 0.5) / f64::from(STEPS);
        let Rgb([r, g, b]) = (bar.colour)(place);
        let part = height / f64::from(STEPS);
        let top = y + height - f64::from(step + 1) * part;
        let _ = write!(
            out,
            "<rect x=\"{x}\" y=\"{top:.2}\" width=\"14\" height=\"{:.2}\" fill=\"rgb({r},{g},{b})\"/>",
            part + 0.3
        );
    }
    for (label, place) in &bar.ticks {
        text(out, [x + 18.0, y + 4.0 + (1.0 - place) * height], "start", label);
    }
    let at = [x + 66.0, y + height / 2.0];
    let _ = write!(
        out,
        "<text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\" transform=\"rotate(-90 {0} {1})\">{2}</text>",
        at[0], at[1], bar.title
    );
}

fn text(out: &mut String, [x, y]: [f64; 2], anchor: &str, content: &str) {
    // Writing to a string cannot fail.
    let _ = write!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{content}</text>");
}

/// Millimetres without needless digits.
fn length(mm: f64) -> String {
    format!("{}", (mm * 10.0).round() / 10.0)
}
