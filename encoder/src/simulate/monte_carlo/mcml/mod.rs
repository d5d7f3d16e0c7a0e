//! MCML's own files: `.mci` that say what to simulate, and `.mco` with what was found, of versions 1 and 2.
//!
//! Formats after the manual of MCML 1.2 (Wang and Jacques 1995) and the text that MCML 2.0 writes into its files. Lengths there
//! are in cm; everything here is in mm. Results are always text: what a file asks for as binary is written as text too.

mod input;
mod lines;
mod output;
mod results;
mod scores;

pub use input::read;
pub use output::write;
pub use results::read_rd;

use super::request::Request;

/// Generation of MCML whose files look like this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 1.x: all scores are always counted, ballistic light among the rest.
    V1,
    /// 2.0: media with names, chosen scores, time, ballistic light apart.
    V2,
}

/// One run of an `.mci` file.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Generation of the file.
    pub version: Version,
    /// Name of the file that its results go to, as it stands there.
    pub output: String,
    /// Names of the media above, of each layer, and below; empty in version 1.
    pub media: Vec<String>,
    /// What is simulated.
    pub request: Request,
}

/// Millimetres in a centimetre.
const MM: f64 = 10.0;
