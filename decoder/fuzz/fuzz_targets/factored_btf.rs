//! Factored BTFs: expansion, and values of texels, of any file that is accepted.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::btf::Texel;
use subsurf_decoder::btf::factored::{ExpandedBtf, ExpansionBuffers, ExpansionMemory};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Evaluate, FactoredBtf, Section};
use subsurf_fuzz::{Arguments, check_error, mutate};

/// Most bytes and numbers that are expanded.
const MOST: usize = 4096;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BtfHeader)
});

fuzz_target!(|input: &[u8]| {
    match FactoredBtf::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(btf) if btf.table_len() <= MOST && btf.words_len() <= MOST => {
            expand(&btf, &mut Arguments::behind_file(input));
        }
        Ok(_) => {}
    }
});

fn expand(btf: &FactoredBtf<'_>, arguments: &mut Arguments<'_>) {
    let mut table = vec![-128; btf.table_len()];
    let mut words = vec![i16::MIN; btf.words_len()];
    let mut scratch = vec![f32::NAN; btf.scratch_len()];
    let buffers = ExpansionBuffers { table: &mut table, words: &mut words, scratch: &mut scratch };
    look_at(&btf.expand(buffers).expect("room for all"), arguments);
    assert!(table.iter().all(|step| *step > -128), "steps are −127 to 127");
    assert!(words.iter().all(|number| *number > i16::MIN), "numbers are −32,767 to 32,767");

    if arguments.below(8) == 1 {
        let mut memory = ExpansionMemory::default();
        let again = btf.expand_in(&mut memory).expect("memory");
        assert_eq!(again.table(), table, "expanded a second time");
        // One number less in one of the buffers.
        let lack = arguments.below(3);
        let end = |length: usize, buffer: usize| length - usize::from(buffer == lack);
        let (table_end, words_end, scratch_end) = (end(table.len(), 0), end(words.len(), 1), end(scratch.len(), 2));
        let buffers = ExpansionBuffers {
            table: &mut table[..table_end],
            words: &mut words[..words_end],
            scratch: &mut scratch[..scratch_end],
        };
        assert!(btf.expand(buffers).is_none(), "no room");
    }
}

/// Values of texels that are next to each other.
fn look_at(btf: &ExpandedBtf<'_>, arguments: &mut Arguments<'_>) {
    let catalog = btf.catalog();
    let texel = Texel::from_number(arguments.below(catalog.texels() as usize + 2) as u32);
    let (light, view) = (arguments.direction(), arguments.direction());
    let coord = catalog.grid().coord(light, view);
    let mut values = [[f32::NAN; 3]; 2];
    btf.eval_texels(texel, &coord, &mut values);
    assert_eq!(values[0], btf.eval_at(texel, &coord), "the first of several");
    for value in values.into_iter().chain([catalog.header().encoding.linear(values[0])]) {
        assert!(value.iter().all(|value| value.is_finite() && *value >= 0.0), "{light:?} {view:?}: {value:?}");
    }
    let channels = btf.channels(texel, &coord);
    assert!(channels.iter().all(|channel| channel.is_finite()), "{light:?} {view:?}: {channels:?}");
}
