//! `subsurf-study meshes`: scattering precomputed for meshes, in our files and in the paper's schemes, as one page.

mod figures;
mod measure;
mod page;
mod published;
mod record;

use std::path::PathBuf;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use subsurf_cli::options::MeshArgs;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::transfer::RdTable;
use subsurf_encoder::write_bytes;
use subsurf_scene::SHAPES;
use subsurf_viewer::stem;

use self::measure::{MeshCase, sizes};
use self::page::Page;
use self::record::{Key, Kind, Record};
use crate::cache;
use crate::page::duration;

/// Compare transfer files with what Hao and Varshney 2004 store, on meshes: errors in images, bytes per vertex, lights.
///
/// Writes DIR/meshes.html, DIR/meshes.csv and DIR/lights.csv, and prints tables. Scattering is of one channel, the mean of the material's
/// colours. What was measured is kept in DIR: a study that was interrupted goes on where it was. The built-in shapes take ten minutes
/// on two cores.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Meshes: files (.obj, .ply, .stl, .off, .glb, .gltf), or names of shapes
    #[arg(value_name = "MESH", default_values = SHAPES)]
    meshes: Vec<PathBuf>,
    #[command(flatten)]
    size: MeshArgs,
    /// A measured material (Jensen et al. 2001), by the profile that comes with the command
    #[arg(long, default_value = "marble", value_parser = PossibleValuesParser::new(shipped::names()))]
    material: String,
    /// Directions of light of all schemes, 16 to 512; light between them is compared for half and for twice as many, too
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u16).range(16..=512))]
    lights: u16,
    /// Folder for the page
    #[arg(long, short, default_value = "out", value_name = "DIR")]
    output: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  subsurf-study meshes -o out                               all built-in shapes
  subsurf-study meshes knot bunny.ply kitten.ply -o out     these alone, 60 mm long
  subsurf-study meshes dragon.obj --material skin1 --extent 100 -o out";

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let folder = args.output.join("records");
    std::fs::create_dir_all(&folder)
        .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", folder.display())))?;
    let profile = shipped::profile(&args.material).expect("names are those of the list");
    let table = RdTable::of(&profile)?;
    #[allow(clippy::cast_possible_truncation, reason = "an index of few digits")]
    let eta = Medium::measured_eta(&args.material) as f32;
    let start = Instant::now();
    let mut records: Vec<(String, Record)> = Vec::new();
    for (number, path) in (1..).zip(&args.meshes) {
        let (name, mesh) = (stem(path), args.size.load(path)?);
        outln!("{name}, {} vertices ({number} of {})", mesh.positions.len(), args.meshes.len());
        if records.iter().any(|(other, _)| *other == name) {
            return Err(bad_request(format!("two meshes are called {name}; name one of the files otherwise")));
        }
        let key = Key {
            material: args.material.clone(),
            lights: args.lights.into(),
            geometry_crc: mesh.geometry_crc(),
            sizes: sizes(mesh.positions.len()).into_iter().map(Kind::of_size).collect(),
        };
        let kept = folder.join(format!("{name}.json"));
        let record = match cache::read::<Record>(&kept) {
            Some(record) if record.key == key => record,
            _ => {
                let record = MeshCase { mesh: &mesh, table: &table, eta }.measure(key, &Bars::new())?;
                cache::write(&kept, &record)?;
                record
            }
        };
        records.push((name, record));
        let page = Page { records: &records, material: &args.material, extent_mm: args.size.extent };
        write_bytes(&args.output.join("meshes.html"), page.html()?.as_bytes())?;
        write_bytes(&args.output.join("meshes.csv"), page.csv().as_bytes())?;
        write_bytes(&args.output.join("lights.csv"), page.lights_csv().as_bytes())?;
    }
    Page { records: &records, material: &args.material, extent_mm: args.size.extent }.print();
    let page = std::path::absolute(args.output.join("meshes.html"))?;
    outln!(
        "\n{} after {}; numbers in meshes.csv and lights.csv beside it",
        page.display(),
        duration(start.elapsed().as_secs_f64())
    );
    Ok(())
}
