//! The quantiser of a byte for each value (section 4; Lloyd 1982).

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
        assert!(even.values().zip(&values).all(|(a, b)| (a - b).abs() < 0.51 * step), "even steps");
    }
}
