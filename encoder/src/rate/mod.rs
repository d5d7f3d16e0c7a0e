//! Search along the rate-distortion curve: the smallest file of a quality, or the best of a size.
//!
//! One search for all families: it encodes candidates, reads every file back, judges it by [`crate::metrics`], and keeps
//! the points of an [`RdCurve`]. Families differ in which candidate comes next: the size of a K-BMPP file is known before
//! it is fitted, so that a ladder can be bisected ([`bssrdf`]); that of a BTF is not, so that a ladder is climbed from
//! its small end ([`btf`]); that of a transfer is, but most of its error is that of its number of lights ([`transfer`]).

mod bisect;
pub mod bssrdf;
pub mod btf;
mod climb;
mod curve;
mod search;
pub mod transfer;

pub use curve::{Candidate, Distortion, RdCurve, RdPoint, Target};
