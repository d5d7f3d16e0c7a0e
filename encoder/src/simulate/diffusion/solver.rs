//! Preconditioned conjugate gradients for the diffusion equation on a box, three channels at a time.
//!
//! A cell's equation is (Σ g + s) φ − Σ g φ' = q with conductances g to its six neighbours and losses s. The three
//! channels share the grid and differ in every coefficient; they run side by side as lanes.

/// One number per colour channel.
pub(super) type Rgb = [f64; 3];

/// Weight of the modification of the incomplete factors (Bridson, *Fluid Simulation for Computer Graphics*, 5.2).
const TAU: f64 = 0.97;
/// Below this share of a diagonal entry the modification is left out.
const SAFETY: f64 = 0.25;
/// More iterations than any sane system takes.
const MAX_ITERATIONS: usize = 2_000;

/// A system on a box of cells, and room to solve it in.
///
/// Vectors have `pad` zeros on either side, and the conductance across the last cell of a row is zero, so that
/// neighbours are plain offsets and need no checks.
///
/// With the incomplete factors A ≈ (E⁻¹ − G) E (E⁻¹ − Gᵀ), E diagonal and G the conductances to earlier cells, the
/// iteration runs on L⁻¹ (E^½ A E^½) L⁻ᵀ with L = I − E^½ G E^½ of unit diagonal. Since E^½ A E^½ = L + Lᵀ + (D − 2 I),
/// a product takes two triangular solves and nothing else (Eisenstat 1981).
pub(super) struct System {
    pad: usize,
    cells: usize,
    /// Offset to the next cell along each axis: z, x, y.
    stride: [usize; 3],
    /// Conductance to the next cell along each axis; [`System::solve`] scales it.
    pub(super) g: [Vec<Rgb>; 3],
    /// Loss of each cell: absorption, and escape at the boundary.
    pub(super) loss: Vec<Rgb>,
    /// Source; overwritten by the residual.
    pub(super) q: Vec<Rgb>,
    /// Solution, and the guess it starts from.
    pub(super) phi: Vec<Rgb>,
    /// Scale of every cell, E^½.
    scale: Vec<Rgb>,
    /// Diagonal of the scaled system less that of both triangles, D − 2 I.
    excess: Vec<Rgb>,
    direction: Vec<Rgb>,
    upper: Vec<Rgb>,
    lower: Vec<Rgb>,
}

impl System {
    /// Room for a box of `size` cells in z, x and y; z is the fastest index.
    pub(super) fn new(size: [usize; 3]) -> Self {
        let cells = size[0] * size[1] * size[2];
        let stride = [1, size[0], size[0] * size[1]];
        let pad = stride[2];
        let zeros = || vec![[0.0; 3]; cells + 2 * pad];
        Self {
            pad,
            cells,
            stride,
            g: [zeros(), zeros(), zeros()],
            loss: zeros(),
            q: zeros(),
            phi: zeros(),
            scale: zeros(),
            excess: zeros(),
            direction: zeros(),
            upper: zeros(),
            lower: zeros(),
        }
    }

    /// Index of a cell in the vectors.
    pub(super) fn index(&self, z: usize, x: usize, y: usize) -> usize {
        self.pad + z + x * self.stride[1] + y * self.stride[2]
    }

    /// Solves for `phi`, starting from it, until the residual is `tolerance` times the source, both in the norm that
    /// the preconditioner defines. Uses up `g`, `loss` and `q`. Returns the iterations taken.
    pub(super) fn solve(&mut self, tolerance: f64) -> usize {
        self.factorise();
        let limit = self.scale_system().map(|source| source * tolerance * tolerance);
        // q holds r̂ = L⁻¹ E^½ (q − A φ), phi holds φ̂ = Lᵀ E^−½ φ.
        self.direction.copy_from_slice(&self.q);
        let mut norm = dot(&self.q, &self.q);
        let mut iteration = 0;
        while (0..3).any(|c| norm[c] > limit[c]) && iteration < MAX_ITERATIONS {
            let curvature = self.apply();
            let alpha = [0, 1, 2].map(|c| ratio(norm[c], curvature[c]));
            let mut next = [0.0; 3];
            let solution = self.phi.iter_mut().zip(&self.direction);
            let residual = self.q.iter_mut().zip(self.lower.iter().zip(&self.upper));
            for ((phi, direction), (residual, (w, u))) in solution.zip(residual) {
                for c in 0..3 {
                    phi[c] += alpha[c] * direction[c];
                    residual[c] -= alpha[c] * (w[c] + u[c]);
                    next[c] += residual[c] * residual[c];
                }
            }
            let beta = [0, 1, 2].map(|c| ratio(next[c], norm[c]));
            for (direction, residual) in self.direction.iter_mut().zip(&self.q) {
                for c in 0..3 {
                    direction[c] = residual[c] + beta[c] * direction[c];
                }
            }
            norm = next;
            iteration += 1;
        }
        // φ = E^½ L⁻ᵀ φ̂.
        let unscaled = Triangle { stride: self.stride, g: &self.g };
        for i in (self.pad..self.pad + self.cells).rev() {
            let later = unscaled.later(&self.phi, i);
            for c in 0..3 {
                self.phi[i][c] += later[c];
            }
        }
        for (phi, scale) in self.phi.iter_mut().zip(&self.scale) {
            for c in 0..3 {
                phi[c] *= scale[c];
            }
        }
        iteration
    }

    /// Modified incomplete Cholesky: `scale` = E^½ and `excess` = the diagonal of A.
    fn factorise(&mut self) {
        let [sz, sx, sy] = self.stride;
        let [gz, gx, gy] = &self.g;
        for i in self.pad..self.pad + self.cells {
            let (z, x, y) = (i - sz, i - sx, i - sy);
            for c in 0..3 {
                let (az, ax, ay) = (gz[z][c], gx[x][c], gy[y][c]);
                let diagonal = self.loss[i][c] + gz[i][c] + az + gx[i][c] + ax + gy[i][c] + ay;
                let [ez, ex, ey] = [z, x, y].map(|j| self.scale[j][c] * self.scale[j][c]);
                let squares = az * az * ez + ax * ax * ex + ay * ay * ey;
                let fill =
                    az * (gx[z][c] + gy[z][c]) * ez + ax * (gz[x][c] + gy[x][c]) * ex + ay * (gz[y][c] + gx[y][c]) * ey;
                let pivot = diagonal - squares - TAU * fill;
                let pivot = if pivot < SAFETY * diagonal { diagonal } else { pivot };
                self.scale[i][c] = 1.0 / pivot.sqrt();
                self.excess[i][c] = diagonal;
            }
        }
    }

    /// Brings g, q and phi into scaled form; returns the squared norm of the source.
    fn scale_system(&mut self) -> Rgb {
        let cells = self.pad..self.pad + self.cells;
        for (g, stride) in self.g.iter_mut().zip(self.stride) {
            for i in cells.clone() {
                for c in 0..3 {
                    g[i][c] *= self.scale[i][c] * self.scale[i + stride][c];
                }
            }
        }
        let triangle = Triangle { stride: self.stride, g: &self.g };
        for i in cells.clone() {
            for c in 0..3 {
                let scale = self.scale[i][c];
                self.excess[i][c] = self.excess[i][c] * scale * scale - 2.0;
                self.q[i][c] *= scale;
                self.phi[i][c] /= scale;
            }
        }
        // r = E^½ q − (L + Lᵀ + D − 2 I) E^−½ φ, then L⁻¹ of it and of the source.
        let mut source = [0.0; 3];
        for i in cells.clone() {
            let [earlier, later] = [triangle.earlier(&self.phi, i), triangle.later(&self.phi, i)];
            let lower = triangle.earlier(&self.upper, i);
            for c in 0..3 {
                self.upper[i][c] = self.q[i][c] + lower[c];
                source[c] += self.upper[i][c] * self.upper[i][c];
                let diagonal = self.excess[i][c] + 2.0;
                self.q[i][c] -= diagonal * self.phi[i][c] - earlier[c] - later[c];
            }
        }
        for i in cells.clone() {
            let lower = triangle.earlier(&self.q, i);
            for c in 0..3 {
                self.q[i][c] += lower[c];
            }
        }
        // φ̂ = Lᵀ E^−½ φ: later cells are still unscaled when their turn comes.
        for i in cells {
            let later = triangle.later(&self.phi, i);
            for c in 0..3 {
                self.phi[i][c] -= later[c];
            }
        }
        source
    }

    /// A direction's image, L⁻¹ (L + Lᵀ + D − 2 I) L⁻ᵀ direction = w + u, in its two parts: `upper` = u = L⁻ᵀ direction,
    /// and `lower` = w = L⁻¹ (direction + (D − 2 I) u). Returns direction · image.
    ///
    /// All the time goes here. It runs column by column in z, with the recurrence along the column in registers.
    fn apply(&mut self) -> Rgb {
        let [_, sx, sy] = self.stride;
        let [gz, gx, gy] = &self.g;
        let depth = sx;
        let columns = (self.pad..self.pad + self.cells).step_by(depth);
        // u, from the last cell to the first.
        for start in columns.clone().rev() {
            let (here, behind) = self.upper.split_at_mut(start + depth);
            let here = &mut here[start..];
            let (ux, uy) = (&behind[sx - depth..][..depth], &behind[sy - depth..][..depth]);
            let (gz, gx, gy) = (&gz[start..][..depth], &gx[start..][..depth], &gy[start..][..depth]);
            let direction = &self.direction[start..][..depth];
            let mut u = [0.0; 3];
            for z in (0..depth).rev() {
                for c in 0..3 {
                    let sum = direction[z][c] + gx[z][c] * ux[z][c] + gy[z][c] * uy[z][c];
                    u[c] = sum + gz[z][c] * u[c];
                }
                here[z] = u;
            }
        }
        // w, from the first cell to the last.
        let mut curvature = [0.0; 3];
        for start in columns {
            let (before, here) = self.lower.split_at_mut(start);
            let here = &mut here[..depth];
            let (wx, wy) = (&before[start - sx..][..depth], &before[start - sy..][..depth]);
            let (gx, gy) = (&gx[start - sx..][..depth], &gy[start - sy..][..depth]);
            let gz = &gz[start - 1..][..depth];
            let (direction, excess) = (&self.direction[start..][..depth], &self.excess[start..][..depth]);
            let upper = &self.upper[start..][..depth];
            let mut w = [0.0; 3];
            for z in 0..depth {
                for c in 0..3 {
                    let source = direction[z][c] + excess[z][c] * upper[z][c];
                    let sum = source + gx[z][c] * wx[z][c] + gy[z][c] * wy[z][c];
                    w[c] = sum + gz[z][c] * w[c];
                    curvature[c] += direction[z][c] * (w[c] + upper[z][c]);
                }
                here[z] = w;
            }
        }
        curvature
    }
}

/// G' = E^½ G E^½, the strict triangle of the scaled matrix with its sign turned.
struct Triangle<'a> {
    stride: [usize; 3],
    g: &'a [Vec<Rgb>; 3],
}

impl Triangle<'_> {
    /// Row `i` of G' v: the cells before it.
    #[inline]
    fn earlier(&self, v: &[Rgb], i: usize) -> Rgb {
        let [gz, gx, gy] = self.g;
        let [z, x, y] = self.stride.map(|stride| i - stride);
        [0, 1, 2].map(|c| gz[z][c] * v[z][c] + gx[x][c] * v[x][c] + gy[y][c] * v[y][c])
    }

    /// Row `i` of G'ᵀ v: the cells behind it.
    #[inline]
    fn later(&self, v: &[Rgb], i: usize) -> Rgb {
        let [gz, gx, gy] = self.g;
        let [z, x, y] = self.stride.map(|stride| i + stride);
        [0, 1, 2].map(|c| gz[i][c] * v[z][c] + gx[i][c] * v[x][c] + gy[i][c] * v[y][c])
    }
}

fn dot(a: &[Rgb], b: &[Rgb]) -> Rgb {
    let mut sum = [0.0; 3];
    for (a, b) in a.iter().zip(b) {
        for c in 0..3 {
            sum[c] += a[c] * b[c];
        }
    }
    sum
}

/// a / b, or 0 where a channel has converged to nothing.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}
