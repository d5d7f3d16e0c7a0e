//! Colours.

/// Linear red, green and blue; Rec. 709 unless said otherwise.
pub type Rgb = [f32; 3];
