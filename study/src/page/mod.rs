//! What all pages are made of: style, tables, charts, panels of pictures.

pub(crate) mod colour;
pub(crate) mod panel;
pub(crate) mod plots;

use std::fmt::Write as _;

/// Style of all pages.
pub(crate) const CSS: &str = include_str!("page.css");

/// Number or name from a paper, in HTML.
pub(crate) fn other(text: &str) -> String {
    format!("<span class=\"other\">{text}</span>")
}

/// Table in HTML: rows of cells under titles; cells that begin with a tick or a cross are coloured.
pub(crate) fn table(titles: &[String], rows: &[Vec<String>]) -> String {
    let mut out = String::from("<table><thead><tr>");
    for title in titles {
        let _ = write!(out, "<th>{title}</th>");
    }
    out.push_str("</tr></thead><tbody>");
    for row in rows {
        out.push_str("<tr>");
        for content in row {
            let class = match content.chars().next() {
                Some('✓') => " class=\"yes\"",
                Some('✗') => " class=\"no\"",
                _ => "",
            };
            let _ = write!(out, "<td{class}>{content}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table>");
    out
}

/// What holds after a tick, what does not after a cross.
pub(crate) fn mark(holds: bool, what: &str) -> String {
    format!("{} {what}", if holds { '✓' } else { '✗' })
}

/// Time for people, from seconds.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 3_600.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3_600.0),
    }
}
