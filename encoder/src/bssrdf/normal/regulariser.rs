//! Regulariser of profiles: what keeps them smooth, and what keeps unmeasured nodes in place.

use crate::math::banded::Banded;

/// Weight of the C² regulariser, λ_reg (Yatagawa et al. 2020, section 3.3).
pub(crate) const SMOOTHNESS: f32 = 1e-3;
/// Weight of squared values, which keeps nodes that no measured pair touches at the mean profile.
const RIDGE: f32 = 1e-5;

/// Matrix of the regulariser for profiles of `nodes` nodes.
pub(crate) fn regulariser(nodes: usize) -> Banded {
    let mut matrix = Banded::new(nodes);
    regularise(&mut matrix);
    matrix
}

/// Adds the regulariser to a matrix.
pub(super) fn regularise(matrix: &mut Banded) {
    matrix.add_smoothness(SMOOTHNESS);
    matrix.add_ridge(RIDGE);
}
