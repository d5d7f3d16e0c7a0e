//! `subsurf-study kernels`: separable kernels of measured materials, as one page.

mod curves;
mod meshes;
mod pictures;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::kernel::{KernelMethod, MAX_TERMS, Options, Profile, compare};
use subsurf_encoder::metrics::kernel::KernelErrors;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::profile::PACKETS;
use subsurf_encoder::{Error, Progress, write_bytes};

use self::meshes::Meshes;
use crate::page::{CSS, table};

/// Compare separable kernels of measured materials (Jimenez et al. 2015) with their profiles: curves, kernels in the plane, errors.
///
/// Writes DIR/index.html and DIR/errors.csv, and prints errors as tables. With --mesh, draws materials on meshes by every method, beside the
/// gather, our techniques and LinSSS, and writes DIR/meshes.csv, too.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder to write to
    dir: PathBuf,
    /// Materials
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(shipped::names()))]
    materials: Vec<String>,
    /// Trace the profiles that come with the library anew, and write them to this folder: a quarter of an hour
    #[arg(long, value_name = "DIR")]
    profiles: Option<PathBuf>,
    /// Draw on these meshes, too: files, or names of shapes
    #[arg(long = "mesh", value_name = "FILE|SHAPE")]
    meshes: Vec<PathBuf>,
    /// Longest side of the meshes in mm
    #[arg(long, default_value_t = 60.0, value_name = "MM")]
    extent: f32,
    /// Pixels of the pictures of meshes
    #[arg(long, default_value = "480x400", value_name = "WxH")]
    size: Size,
    /// Frames to time of each technique on meshes; 0 to leave times out
    #[arg(long, default_value_t = 5)]
    frames: usize,
}

/// Values of k of the guide that are compared.
const GUIDES: [f64; 4] = [0.0, 1.55, 2.0, 4.0];

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let all = || shipped::names().map(str::to_owned).collect();
    let names: Vec<String> = if args.materials.is_empty() { all() } else { args.materials.clone() };
    let folders = std::iter::once(&args.dir).chain(&args.profiles);
    for folder in folders {
        std::fs::create_dir_all(folder).map_err(|source| Error::Output { path: folder.clone(), source })?;
    }
    let asked = asked();
    let mut csv = String::from("material,method,terms,k,frobenius,l1,dot,edge\n");
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Separable kernels</title><style>{CSS}</style><body>\
         <h1>Separable kernels of measured materials</h1><p class=\"note\">Profiles R<sub>d</sub>(r) of Jensen et al. 2001, \
         traced by Monte Carlo, and what sums of products a(x) a(y) make of them (Jimenez et al. 2015). Frobenius and L1 are \
         shares of the profile in the plane; dot and edge the largest errors beside a lit disc and a shadow's edge, as shares of \
         the brightest. Means over channels.</p>"
    );
    let mut tables: [Vec<Vec<String>>; 2] = Default::default();
    let on_meshes = Meshes {
        meshes: &args.meshes,
        extent_mm: args.extent,
        size: args.size.0,
        frames: args.frames,
        folder: args.dir.join("meshes"),
    };
    let mut meshes_csv = String::new();
    for name in &names {
        let profile = profile(name, args.profiles.as_deref())?;
        let errors = compare(&profile, &asked)?;
        let _ = write!(page, "<h2>{name}</h2><div class=\"charts\">");
        page.push_str(&curves::charts(name, &profile)?);
        page.push_str("</div><div class=\"wide\">");
        page.push_str(&pictures::panel(&profile)?);
        page.push_str("</div>");
        page.push_str(&table(
            &["method", "terms", "k", "Frobenius", "L1", "dot", "edge"].map(str::to_owned),
            &rows(&asked, &errors),
        ));
        if !args.meshes.is_empty() {
            let (html, rows) = on_meshes.draw(name, &profile, Medium::measured_eta(name))?;
            let _ = write!(page, "<div class=\"wide\">{html}</div>");
            // One line of titles for all.
            let skipped = usize::from(!meshes_csv.is_empty());
            rows.lines().skip(skipped).for_each(|row| meshes_csv.push_str(&format!("{row}\n")));
        }
        for (options, KernelErrors { frobenius, l1, dot, edge }) in asked.iter().zip(&errors) {
            let (method, k) = (options.method.name(), k(options));
            let _ = writeln!(csv, "{name},{method},{},{k},{frobenius:.5},{l1:.5},{dot:.5},{edge:.5}", options.terms);
        }
        for (lines, value) in tables.iter_mut().zip([|e: &KernelErrors| e.frobenius, |e: &KernelErrors| e.dot]) {
            let cells = errors.iter().map(|errors| format!("{:.3}", value(errors)));
            lines.push(std::iter::once(name.clone()).chain(cells).collect());
        }
    }
    page.push_str("</body></html>\n");
    write_bytes(&args.dir.join("index.html"), page.as_bytes())?;
    write_bytes(&args.dir.join("errors.csv"), csv.as_bytes())?;
    if !args.meshes.is_empty() {
        write_bytes(&args.dir.join("meshes.csv"), meshes_csv.as_bytes())?;
    }
    for (title, lines) in ["Frobenius", "dot"].iter().zip(&tables) {
        outln!("\n| {title} | {} |", asked.iter().map(label).collect::<Vec<_>>().join(" | "));
        outln!("|---|{}", "---:|".repeat(asked.len()));
        lines.iter().for_each(|line| outln!("| {} |", line.join(" | ")));
    }
    Ok(())
}

/// The profile that comes with the library, or that is traced anew and written to a folder.
fn profile(name: &str, folder: Option<&Path>) -> anyhow::Result<Profile> {
    let Some(folder) = folder else {
        return Ok(shipped::profile(name).expect("names are those of the list"));
    };
    let progress = Bars::new();
    let (profile, text) = shipped::simulate(name, Medium::measured_eta(name), PACKETS, &progress)?;
    // Half a profile is no profile to come with anything.
    if progress.stopped() {
        return Err(subsurf_cli::program::failure::bad_request(format!("{name}: stopped, and not written")));
    }
    write_bytes(&folder.join(format!("{name}.csv")), text.as_bytes())?;
    Ok(profile)
}

/// All methods: sums of every number of terms, guides near and far.
fn asked() -> Vec<Options> {
    let with = |method, terms, guide| Options { method, terms, guide, ..Options::default() };
    let guide = Options::default().guide;
    let sums = [KernelMethod::Svd, KernelMethod::Gaussians];
    let sums = sums.into_iter().flat_map(|method| (1..=usize::from(MAX_TERMS)).map(move |terms| (method, terms)));
    let mut all: Vec<Options> = sums.map(|(method, terms)| with(method, terms, guide)).collect();
    all.push(Options::default());
    all.extend(GUIDES.map(|k| with(KernelMethod::Guided, 1, k)));
    all.push(with(KernelMethod::TwoGaussians, 1, guide));
    all
}

fn k(options: &Options) -> String {
    if options.method == KernelMethod::Guided { options.guide.to_string() } else { String::new() }
}

/// Name of a method in few letters.
fn label(options: &Options) -> String {
    match options.method {
        KernelMethod::Svd => format!("svd {}", options.terms),
        KernelMethod::Gaussians => format!("gauss {}", options.terms),
        KernelMethod::Guided => format!("k = {}", options.guide),
        method => method.name().to_owned(),
    }
}

fn rows(asked: &[Options], errors: &[KernelErrors]) -> Vec<Vec<String>> {
    let row = |(options, errors): (&Options, &KernelErrors)| {
        let KernelErrors { frobenius, l1, dot, edge } = errors;
        let numbers = [format!("{frobenius:.3}"), format!("{l1:.3}"), percent(*dot), percent(*edge)];
        [options.method.name().to_owned(), options.terms.to_string(), k(options)].into_iter().chain(numbers).collect()
    };
    asked.iter().zip(errors).map(row).collect()
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
