//! k-means: codewords and the choices of vectors among them, improved in turn (Lloyd 1982).
//!
//! One loop for all encoders. What differs is behind [`KMeans`]: what a distance is, what a codeword is, and what
//! becomes of codewords that no vector chose. Where codewords begin is for the caller: each encoder has a seeding of its
//! own, and its files depend on it.

pub(crate) mod euclidean;
pub(crate) mod shape_gain;
pub(crate) mod weighted;

/// Vectors that can be clustered.
pub(crate) trait KMeans {
    /// Set of codewords.
    type Codebook;
    /// For every vector its codeword, and what comes with it: a gain or a distance.
    type Assignment;

    /// The nearest codeword of every vector; of equals the first.
    fn assign(&self, codebook: &Self::Codebook) -> Self::Assignment;

    /// Moves codewords to where they suit the vectors best that chose them, and decides about those that none chose.
    fn update(&self, assignment: &Self::Assignment, codebook: &mut Self::Codebook);

    /// The codebook after at most `rounds` rounds of both steps. `goes_on` is shown every round's assignment, and says
    /// whether another round follows.
    fn lloyd(
        &self,
        mut codebook: Self::Codebook,
        rounds: usize,
        mut goes_on: impl FnMut(Self::Assignment) -> bool,
    ) -> Self::Codebook {
        for _ in 0..rounds {
            let assignment = self.assign(&codebook);
            self.update(&assignment, &mut codebook);
            if !goes_on(assignment) {
                break;
            }
        }
        codebook
    }
}
