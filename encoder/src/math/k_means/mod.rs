//! k-means with the distances that the encoders need.

pub(crate) mod euclidean;
pub(crate) mod shape_gain;
pub(crate) mod weighted;
