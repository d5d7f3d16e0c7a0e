//! BTFs and BRDFs, as folders and as files of others.

mod broken;
mod bsdf;
mod clamped;
mod flat;
mod folders;

use crate::warnings::Warnings;
