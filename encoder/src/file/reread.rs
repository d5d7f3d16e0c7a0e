//! Re-reading of files that were just made, before anybody else has to.

use subsurf_decoder::btf::{Catalog, Model};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{Bssrdf, Btf, Factored, ReadError, Section};

use crate::error::{Error, Result};

/// The same bytes, once the decoder has accepted all of them.
///
/// # Errors
/// [`Error::OwnOutput`] if it refuses them.
pub(crate) fn reread(bytes: Vec<u8>) -> Result<Vec<u8>> {
    parse(&bytes).map_err(|source| Error::OwnOutput { source })?;
    Ok(bytes)
}

fn parse(bytes: &[u8]) -> std::result::Result<(), ReadError> {
    let container = Container::parse(bytes)?;
    if !container.entries().any(|entry| entry.section == Section::BtfHeader) {
        return Bssrdf::parse_with(bytes, Crc::Check).map(drop);
    }
    match Catalog::parse(bytes, Crc::Check)?.header().model {
        Model::Nested => Btf::parse(bytes).map(drop),
        Model::Factored => Factored::parse(bytes).map(drop),
    }
}

#[cfg(test)]
mod tests {
    use subsurf_decoder::bssrdf::Addressing;

    use super::*;
    use crate::synthetic::Shape;

    #[test]
    fn broken_output_is_our_own_fault() {
        let shape = Shape { size: [4, 3], radius: 1, samples: 2, base_materials: 2, addressing: Addressing::Clamp };
        let file = reread(shape.bmpp()).unwrap();
        let error = reread(file[..file.len() - 1].to_vec()).unwrap_err();
        assert!(matches!(error, Error::OwnOutput { .. }) && !error.is_callers(), "{error}");
        assert!(error.to_string().contains("a bug of subsurf"), "{error}");
    }
}
