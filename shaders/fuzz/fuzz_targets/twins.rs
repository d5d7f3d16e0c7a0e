//! Twins of the passes: what is made of any file that is accepted when it is loaded, and small pictures of it.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Content, File, Section};
use subsurf_fuzz::mutate;
use subsurf_twins_fuzz::{bssrdf, kernel, nested_btf, transfer};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BssrdfHeader)
});

fuzz_target!(|input: &[u8]| {
    let Ok(file) = File::parse_with(input, Crc::Skip) else { return };
    match file.content() {
        Content::Bssrdf(material) => bssrdf(&material),
        Content::NestedBtf(btf) => nested_btf(&btf),
        Content::Kernel(of) => kernel(&of),
        Content::Transfer(of) => transfer(&of),
        // Expanded to images, by the decoder alone.
        Content::FactoredBtf(_) => {}
        other => panic!("nothing draws {:?}", other.family()),
    }
});
