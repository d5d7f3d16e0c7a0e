//! Positions in tables that are stored row by row.

/// Position of an element of a row-major table: row · columns + column.
///
/// Sizes of a checked file keep positions within its bytes. Other positions wrap, and lead to no value or to another one.
#[inline]
pub(crate) fn row_major(row: usize, columns: usize, column: usize) -> usize {
    row.wrapping_mul(columns).wrapping_add(column)
}
