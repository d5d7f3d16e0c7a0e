//! The quantiser of a byte for each value (section 4; Lloyd 1982).

use crate::transfer::Scheme;

/// Rounds after which the quantiser hardly moves.
pub const LLOYD_ROUNDS: usize = 20;

/// Values in a byte each, with a table of what the bytes stand for.
#[derive(Clone, Debug)]
pub struct Lloyd {
    /// 256 values, ascending.
    pub table: Vec<f32>,
    /// Bytes of the values.
    pub codes: Vec<u8>,
}

impl Lloyd {
    /// Table and codes after `rounds` of Lloyd's iteration that begin with even steps. Quantiles would be a worse start: few values of
    /// shadows' edges get few codes then, and never more.
    #[must_use]
    pub fn new(values: &[f32], rounds: usize) -> Self {
        let [low, high] = values
            .iter()
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)]);
        let mut table: Vec<f32> = (0..=u8::MAX).map(|k| low + (high - low) * (f32::from(k) + 0.5) / 256.0).collect();
        let mut sorted = values.to_vec();
        sorted.sort_by(f32::total_cmp);
        for _ in 0..rounds {
            let mut from = 0;
            for code in 0..table.len() {
                let end = match table.get(code + 1) {
                    Some(next) => sorted.partition_point(|value| *value < 0.5 * (table[code] + next)),
                    None => sorted.len(),
                };
                let own = sorted.get(from..end).unwrap_or(&[]);
                if !own.is_empty() {
                    let sum: f64 = own.iter().map(|value| f64::from(*value)).sum();
                    #[allow(clippy::cast_possible_truncation, reason = "a mean of single precision")]
                    let mean = (sum / own.len() as f64) as f32;
                    table[code] = mean;
                }
                from = from.max(end);
            }
        }
        let nearest = |value: &f32| {
            let above = table.partition_point(|entry| entry < value).min(table.len() - 1);
            let below = above.saturating_sub(1);
            let is_below = value - table[below] < table[above] - value;
            u8::try_from(if is_below { below } else { above }).unwrap_or(u8::MAX)
        };
        Self { codes: values.iter().map(nearest).collect(), table }
    }

    /// The values that the codes stand for.
    pub fn values(&self) -> impl Iterator<Item = f32> {
        self.codes.iter().map(|code| self.table[usize::from(*code)])
    }

    /// Bytes of codes and table.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.codes.len() + size_of_val(&self.table[..])) as u64
    }

    /// Signal-to-noise ratio in dB: squares of the values that it was made from by squares of the errors.
    #[must_use]
    pub fn snr_db(&self, values: &[f32]) -> f64 {
        let sum = |of: &mut dyn Iterator<Item = f32>| of.map(|value| f64::from(value).powi(2)).sum::<f64>();
        let noise = sum(&mut self.values().zip(values).map(|(a, b)| a - b));
        10.0 * (sum(&mut values.iter().copied()) / noise).log10()
    }
}

/// A byte for each light and vertex, those of a vertex after each other.
impl Scheme for Lloyd {
    fn exitance(&self, weights: &[f32]) -> Vec<f32> {
        let of_vertex =
            |codes: &[u8]| codes.iter().zip(weights).map(|(code, w)| w * self.table[usize::from(*code)]).sum();
        self.codes.chunks(weights.len()).map(of_vertex).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_better_than_even_steps() {
        // Many small values, few large ones, as in q.
        let values: Vec<f32> = (0..20_000_u16).map(|k| (f32::from(k) / 2e4).powi(4)).collect();
        let error = |of: &Lloyd| of.values().zip(&values).map(|(a, b)| (a - b) * (a - b)).sum::<f32>();
        let (even, lloyd) = (Lloyd::new(&values, 0), Lloyd::new(&values, 30));
        assert!(lloyd.table.is_sorted(), "the table ascends");
        // No quantiser of 256 values gets below (∫ p^⅓)³ = 0.59 of even steps here (Panter and Dite 1951); Lloyd's nears it slowly.
        assert!((0.59..0.7).contains(&(error(&lloyd) / error(&even))), "{} of {}", error(&lloyd), error(&even));
        let step = 1.0 / 256.0;
        let difference =
            even.snr_db(&values) - lloyd.snr_db(&values) - 10.0 * f64::from(error(&lloyd) / error(&even)).log10();
        assert!(difference.abs() < 0.01 && lloyd.snr_db(&values) > 45.0, "{} dB", lloyd.snr_db(&values));
        assert!(even.values().zip(&values).all(|(a, b)| (a - b).abs() < 0.51 * step), "even steps");
    }
}
