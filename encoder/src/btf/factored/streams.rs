//! Sections of numbers as streams of the range coder, by the decoder's own models of them.

use nalgebra::DMatrix;
use subsurf_decoder::btf::factored::model::{IntegerModel, code_core, code_words};

use super::coder::Encoder;

/// Section `CORE` of columns `[view axis][light axis]`.
pub(crate) fn core(columns: &[Vec<i32>], light_axes: usize) -> Vec<u8> {
    let (mut coder, mut numbers) = (Encoder::new(), IntegerModel::default());
    let mut usual = vec![0.0; columns.first().map_or(0, Vec::len)];
    for column in columns {
        let mut column: Vec<f32> = column.iter().map(|number| *number as f32).collect();
        code_core(&mut coder, &mut numbers, light_axes, &mut column, &mut usual);
    }
    coder.finish()
}

/// Section of the codewords of all stages, `[coefficient × codeword]`.
pub(crate) fn codewords(stages: &[DMatrix<f32>]) -> Vec<u8> {
    let mut coder = Encoder::new();
    for words in stages {
        #[allow(clippy::cast_possible_truncation, reason = "whole, at most 32,767")]
        let mut numbers: Vec<i16> = words.iter().map(|number| *number as i16).collect();
        code_words(&mut coder, words.nrows(), &mut numbers);
    }
    coder.finish()
}
