//! WGSL files of the crate.

/// One WGSL file of those under `wgsl/`.
#[derive(Clone, Copy, Debug)]
pub struct File {
    /// Path under `wgsl/`, without the extension.
    pub path: &'static str,
    /// The text, without comments and indentation.
    pub text: &'static str,
}

impl File {
    /// Name of the file, by which the first lines of passes call it; no two files share one.
    #[must_use]
    pub fn stem(&self) -> &'static str {
        self.path.rsplit('/').next().unwrap_or(self.path)
    }
}

/// The [`File`] of a path under `wgsl/`.
macro_rules! wgsl {
    ($path:literal) => {
        $crate::passes::File { path: $path, text: include_str!(concat!(env!("OUT_DIR"), "/wgsl/", $path, ".wgsl")) }
    };
}
pub(super) use wgsl;
