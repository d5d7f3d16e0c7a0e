//! Re-reading of files that were just made, before anybody else has to.

use subsurf_decoder::File;

use crate::error::{Error, Result};

/// The same bytes, once the decoder has accepted all of them.
///
/// # Errors
/// [`Error::OwnOutput`] if it refuses them.
pub(crate) fn reread(bytes: Vec<u8>) -> Result<Vec<u8>> {
    File::parse(&bytes).map_err(|source| Error::OwnOutput { source })?;
    Ok(bytes)
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
