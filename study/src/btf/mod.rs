//! `subsurf-study btf`: the BTF paper's tables on simulated materials.

mod codec;
mod page;
mod published;
mod record;
mod shared;
mod svd;

use std::path::PathBuf;
use std::time::Instant;

use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_cli::simulate::btf::SampleArg;
use subsurf_encoder::capture::{Images, Pixels, load_btf};
use subsurf_encoder::simulate::relief::{Request, Sample};
use subsurf_encoder::write_bytes;

use self::codec::Codec;
use self::page::Results;
use self::record::{CodecCase, Record};
use self::shared::{Member, Set, Shared};
use self::svd::SEED;
use crate::page::duration;

/// Repeat tables 2 and 3 of Havran, Filip and Myszkowski 2010 on simulated materials, beside their own encoder, one-level
/// vector quantisation, PCA and local PCA at equal bytes.
///
/// Writes DIR/btf.html, a page with tables and pictures that needs nothing beside it, and DIR/btf.csv. Images, files and
/// judgements are kept in DIR: a study that was interrupted goes on where it was. Several pieces of each material, and all
/// materials, are also put into one file. At 128 × 128 texels a material takes about a quarter of an hour on two cores,
/// and 1.3 GB on disk.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder
    dir: PathBuf,
    /// Materials to simulate
    #[arg(long, value_enum, value_delimiter = ',', default_values = ["foil", "leather", "corduroy", "knit", "wood"])]
    materials: Vec<SampleArg>,
    /// Pixels of the images in x and in y
    #[arg(long, default_value_t = 128, value_name = "PIXELS")]
    size: u32,
    /// Pieces of each material that share a file; 1 leaves it out
    #[arg(long, default_value_t = 4, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=16))]
    pieces: u64,
    /// Judge by every so many pairs of directions; 1 is all 6,561
    #[arg(long, default_value_t = 1, value_name = "N")]
    every: usize,
    /// Leave the paper's own method out
    #[arg(long)]
    no_paper: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if !(16..=1_024).contains(&args.size) || args.every == 0 {
        return Err(bad_request("--size may be 16 to 1024, and --every 1 or more"));
    }
    for folder in ["images", "files", "pictures"].map(|name| args.dir.join(name)) {
        std::fs::create_dir_all(&folder)
            .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", folder.display())))?;
    }
    let start = Instant::now();
    let mut records: Vec<Record> = Vec::new();
    let mut samples: Vec<Sample> = Vec::new();
    for SampleArg(sample) in &args.materials {
        if !samples.contains(sample) {
            samples.push(*sample);
        }
    }
    for (number, sample) in samples.iter().enumerate() {
        outln!("{} ({} of {})", sample.name(), number + 1, samples.len());
        let mut case = CodecCase {
            name: sample.name(),
            side: args.size,
            folder: &args.dir,
            every: args.every,
            images: Vec::new(),
            svd: None,
        };
        let of_paper = |codec: &Codec| [Codec::Havran2010, Codec::NestedAsHavran2010].contains(codec);
        for codec in Codec::ALL.into_iter().filter(|codec| !(args.no_paper && of_paper(codec))) {
            if let Some(record) = case.record(codec, || images(args, Member { sample: *sample, seed: SEED }))? {
                outln!("  {}", record.line());
                records.push(record);
            }
        }
    }
    let mut sets = Vec::new();
    if args.pieces > 1 {
        sets.extend(samples.iter().map(|sample| Set::family(*sample, args.pieces)));
    }
    if samples.len() > 1 {
        sets.push(Set::all(&samples));
    }
    let shared = sets.iter().map(|set| shared::shared(&args.dir, set, args.size, |member| images(args, member)));
    let shared: Vec<Shared> = shared.collect::<anyhow::Result<_>>()?;
    let names: Vec<&str> = samples.iter().map(|sample| sample.name()).collect();
    let results = Results {
        folder: &args.dir,
        materials: &names,
        records: &records,
        shared: &shared,
        side: args.size,
        every: args.every,
    };
    write_bytes(&args.dir.join("btf.html"), results.html().as_bytes())?;
    write_bytes(&args.dir.join("btf.csv"), results.csv().as_bytes())?;
    let page = std::path::absolute(args.dir.join("btf.html"))?;
    outln!("{} after {}; numbers in btf.csv beside it", page.display(), duration(start.elapsed().as_secs_f64()));
    Ok(())
}

/// The images of a material, simulated unless they are there already.
fn images(args: &Args, member: Member) -> anyhow::Result<Images> {
    let Member { sample, seed } = member;
    let output = args.dir.join("images").join(format!("{}-{}", member.name(), args.size));
    let request = Request { sample, size: args.size, pixels: Pixels::Display { exposure: 1.0 }, seed };
    if !request.is_there(&output) {
        outln!("simulating {}", member.name());
        request.write(&output, &Bars::new())?;
    }
    Ok(load_btf(&output, &Bars::new())?)
}
