//! Values of vertices under a light.

use super::layout::{MAX_AXES, MAX_COMPONENTS};
use super::reader::Transfer;
use crate::container::bits::mask;
use crate::container::index::row_major;

impl Transfer<'_> {
    /// Table of a light from the weights of the stored lights: for every cluster and channel a constant, and a factor for each
    /// code of a coefficient, `[cluster][channel][1 + K]`. Once per light; vertices then take a multiplication for each component.
    ///
    /// `table` has [`TransferHeader::table_len`](super::TransferHeader::table_len) numbers; what it has beyond them stays as it is, weights that are missing count as 0.
    pub fn light_table(&self, weights: &[f32], table: &mut [f32]) {
        let header = self.header();
        let (components, channels) = (header.components(), usize::from(header.channels.max(1)));
        let rows = components.wrapping_add(1).max(1);
        let mut along = [0.0; MAX_AXES as usize];
        let along = along.get_mut(..header.axes.into()).unwrap_or(&mut []);
        for (channel, scale) in (0..channels).zip(header.scale) {
            self.project(channel, weights, along);
            let (along, total) = (&*along, along.iter().sum::<f32>());
            let tables = table.chunks_exact_mut(rows).skip(channel).step_by(channels);
            for (cluster, table) in tables.take(header.clusters.into()).enumerate() {
                let range = |row: usize| {
                    let at = row_major(row_major(cluster, rows, row), 2, 0);
                    [at, at.wrapping_add(1)].map(|at| self.ranges.get(at).unwrap_or(0.0))
                };
                let Some((constant, factors)) = table.split_first_mut() else { continue };
                let mean = self.means.iter_from(row_major(cluster, along.len(), 0)).zip(along);
                let [offset, step] = range(0);
                *constant = offset * total + step * mean.map(|(mean, along)| f32::from(mean) * along).sum::<f32>();
                for (component, factor) in factors.iter_mut().enumerate() {
                    let first = row_major(row_major(cluster, components, component), along.len(), 0);
                    let basis = self.bases.get(first..).unwrap_or(&[]).iter().zip(along);
                    let basis: f32 = basis.map(|(value, along)| f32::from(value.cast_signed()) * along).sum();
                    let [offset, step] = range(component.wrapping_add(1));
                    *constant += offset * basis;
                    *factor = scale * step * basis;
                }
                *constant *= scale;
            }
        }
    }

    /// What a channel of a light has along each axis: Σ_j w_j x_cjr.
    fn project(&self, channel: usize, weights: &[f32], along: &mut [f32]) {
        let lights = usize::from(self.header().lights);
        let first = row_major(row_major(channel, lights, 0), along.len(), 0);
        let axes = self.axes.get(first..).unwrap_or(&[]).chunks_exact(along.len().max(1));
        along.fill(0.0);
        for (weight, axes) in weights.iter().take(lights).zip(axes) {
            for (along, axis) in along.iter_mut().zip(axes) {
                *along += weight * f32::from(axis.cast_signed());
            }
        }
    }

    /// Radiant exitance of vertices from number `first` on under the light of a table, `[vertex][channel]`; as many as `exitance` has
    /// room for. Of irradiance 1 on a plane across the light; without the boundary on the way out. May be below 0, which is drawn as 0. Zeros where there are no more.
    pub fn exitance(&self, table: &[f32], first: usize, exitance: &mut [f32]) {
        let header = self.header();
        let (channels, record_bytes) = (usize::from(header.channels.max(1)), header.record_bytes());
        let (components, bits) = (header.components(), header.bits);
        let rows = components.wrapping_add(1).max(1);
        let begin = first.saturating_mul(record_bytes);
        let mut records = self.codes.get(begin..).unwrap_or(&[]);
        exitance.fill(0.0);
        for out in exitance.chunks_exact_mut(channels) {
            let Some((_, after)) = records.split_at_checked(record_bytes) else { return };
            let (cluster, codes) = unpack(records, &bits, components);
            records = after;
            let table = table.get(cluster.wrapping_mul(rows.wrapping_mul(channels))..).unwrap_or(&[]);
            for (out, row) in out.iter_mut().zip(table.chunks_exact(rows)) {
                let Some((constant, factors)) = row.split_first() else { continue };
                *out = factors.iter().zip(codes).fold(*constant, |sum, (factor, code)| sum + factor * code);
            }
        }
    }
}

/// Cluster and codes of the record that `bytes` begin with; what is beyond the bytes is 0.
#[inline]
fn unpack(bytes: &[u8], bits: &[u8; MAX_COMPONENTS], components: usize) -> (usize, [f32; MAX_COMPONENTS]) {
    let bytes = bytes.first_chunk().copied().unwrap_or_else(|| {
        let mut record = [0; 16];
        record.iter_mut().zip(bytes).for_each(|(byte, from)| *byte = *from);
        record
    });
    let all = u128::from_le_bytes(bytes);
    #[allow(clippy::cast_possible_truncation, reason = "halves")]
    let [mut low, mut high] = [all as u64, all.wrapping_shr(u64::BITS) as u64];
    let cluster = low & 0xFF;
    let mut drop = |count: u32| {
        // Both halves move down; no count is 0 or as many as a half has.
        low = low.wrapping_shr(count) | high.wrapping_shl(u64::BITS.wrapping_sub(count));
        high = high.wrapping_shr(count);
        low
    };
    let mut next = drop(u8::BITS);
    let mut codes = [0.0; MAX_COMPONENTS];
    for (code, bits) in codes.iter_mut().zip(bits).take(components) {
        let bits = u32::from(*bits);
        #[allow(clippy::cast_possible_truncation, reason = "a code has at most 12 bits")]
        let own = next as u32 & mask(bits);
        #[allow(clippy::cast_precision_loss, reason = "a code has at most 12 bits")]
        let own = own as f32;
        *code = own;
        next = drop(bits);
    }
    #[allow(clippy::cast_possible_truncation, reason = "a byte")]
    let cluster = cluster as usize;
    (cluster, codes)
}
