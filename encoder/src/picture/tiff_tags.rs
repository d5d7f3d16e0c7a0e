//! TIFF files that the decoder does not refuse by itself, but takes for something else.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// Planar configuration: channels apart.
const PLANAR: u32 = 2;
/// Sample format: floats. Without one, samples are unsigned integers.
const FLOATS: u32 = 3;

/// What a file is that is not read, if it is one of these.
pub(super) fn unread(path: &Path) -> Option<&'static str> {
    let mut file = Decoder::new(BufReader::new(File::open(path).ok()?)).ok()?;
    let mut tag = |tag| file.find_tag_unsigned_vec::<u32>(tag).ok().flatten().unwrap_or_default();
    let is_tiled = !tag(Tag::TileWidth).is_empty();
    if is_tiled && tag(Tag::PlanarConfiguration) == [PLANAR] {
        // Its tiles are smaller than the decoder takes them for.
        return Some("a TIFF file with tiles for each channel apart (planar configuration 2)");
    }
    // Integers that wide are taken for floats.
    let is_wide = tag(Tag::BitsPerSample).iter().any(|bits| *bits >= 32);
    (is_wide && tag(Tag::SampleFormat).iter().all(|format| *format != FLOATS)).then_some("integers of 32 bits or more")
}
