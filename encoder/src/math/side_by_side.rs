//! Rows of a codebook side by side, so that a vector is compared with several at once.

/// Rows that are compared at once: two vector registers of every processor.
pub(crate) const WIDTH: usize = 8;

/// Rows `[block][dimension][row of the block]`. The last block is filled up with rows of zeros.
pub(crate) struct SideBySide {
    dimensions: usize,
    values: Vec<[f32; WIDTH]>,
}

impl SideBySide {
    /// Of rows `[row][dimension]`.
    pub(crate) fn new(rows: &[f32], dimensions: usize) -> Self {
        let block = |rows: &[f32]| {
            let value = |d: usize| std::array::from_fn(|row| rows.get(row * dimensions + d).copied().unwrap_or(0.0));
            (0..dimensions).map(value).collect::<Vec<_>>()
        };
        Self { dimensions, values: rows.chunks(WIDTH * dimensions).flat_map(block).collect() }
    }

    /// Blocks `[dimension][row of the block]`, each with the number of its first row.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, &[[f32; WIDTH]])> {
        (0..).step_by(WIDTH).zip(self.values.chunks_exact(self.dimensions))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_numbers() {
        let (rows, dimensions) = (WIDTH + 3, 5);
        let values: Vec<f32> = (0..rows * dimensions).map(|k| 1.0 + k as f32).collect();
        let side_by_side = SideBySide::new(&values, dimensions);
        let mut seen = 0;
        for (first, block) in side_by_side.blocks() {
            for (lane, d) in (0..WIDTH).flat_map(|lane| (0..dimensions).map(move |d| (lane, d))) {
                let expected = values.get((first + lane) * dimensions + d).copied().unwrap_or(0.0);
                assert_eq!(block[d][lane], expected, "row {}, dimension {d}", first + lane);
                seen += 1;
            }
        }
        assert_eq!(seen, 2 * WIDTH * dimensions, "two blocks");
    }
}
