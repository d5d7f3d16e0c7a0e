//! Memory that fits take, foreseen from their largest tables.
//!
//! Bytes are those of arrays that are there at the same time; what does not grow with texels, directions or nodes is left
//! out. Real fits take about as much, never several times less.

use subsurf_decoder::btf::Grid;

use crate::btf::nested::Extent;
use crate::btf::size::{Method, Size};
use crate::btf::truncated_svd::Ranks;
use crate::capture::Images;
use crate::error::Result;
use crate::memory;

/// Texels whose apparent BRDFs [`Method::Havran2010`] has in memory at a time.
const APPARENT_BRDFS: u64 = 1_024;
/// Columns that a thread of it fits together.
const COLUMNS: u64 = 96;
/// Columns of images that the decomposition looks at together.
const BLOCK: u64 = 96;
/// Dimensions of the decomposition beyond its components.
const OVERSAMPLING: u64 = 16;

/// Sizes of a fit.
pub(super) struct Fit {
    method: Method,
    /// Texels of all materials, and of all their mipmaps.
    texels: u64,
    lights: u64,
    views: u64,
    nodes: [u8; 4],
    /// Nodes of lights and of views.
    of_lights: u64,
    of_views: u64,
    /// Components of luma and of chroma.
    ranks: [u64; 2],
    threads: u64,
}

impl Fit {
    pub(super) fn new(method: Method, materials: &[Images], grid: &Grid, ranks: Ranks, has_mipmaps: bool) -> Self {
        let plain: u64 = materials.iter().map(|images| images.texels() as u64).sum();
        let texels = if has_mipmaps { plain + plain.div_ceil(3) } else { plain };
        let [lights, views] = materials
            .first()
            .map_or([0; 2], |images| [images.lights().len(), images.views().len()].map(|count| count as u64));
        let most = |rank: usize, columns: u64| (rank as u64).min(plain).min(columns);
        Self {
            method,
            texels,
            lights,
            views,
            nodes: [grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi],
            of_lights: grid.light_nodes() as u64,
            of_views: grid.view_nodes() as u64,
            ranks: [most(ranks.luma, lights * views), most(ranks.chroma, 2 * lights * views)],
            threads: rayon::current_num_threads() as u64,
        }
    }

    /// Refuses a fit that takes more memory than there is, before it is begun.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) with both numbers.
    pub(super) fn expect(&self, size: &Size) -> Result<()> {
        let before = match self.method {
            Method::Havran2010 => self.resampler(),
            Method::Nested | Method::Factored => {
                self.decomposition().max(self.resampler()).max(self.components()) + self.coefficients()
            }
        };
        memory::expect(before.max(self.of_size(size)), || self.name(size))
    }

    /// The same of one more size of a fit whose components are there.
    ///
    /// # Errors
    /// As [`Self::expect`].
    pub(super) fn expect_size(&self, size: &Size) -> Result<()> {
        let kept = match self.method {
            Method::Havran2010 => 0,
            Method::Nested | Method::Factored => self.kept_components() + self.coefficients(),
        };
        memory::expect(self.of_size(size).saturating_sub(kept), || self.name(size))
    }

    fn name(&self, size: &Size) -> String {
        let nodes = self.nodes.map(|nodes| nodes.to_string()).join(",");
        let more = match size {
            Size::Nested(Extent { p4, .. }) => format!(" and --p4 {p4}"),
            Size::Factored { .. } | Size::Havran2010 { .. } => String::new(),
        };
        format!("a fit of {} texels with --nodes {nodes}{more}", self.texels)
    }

    /// Nodes of the whole grid.
    fn all_nodes(&self) -> u64 {
        self.of_lights * self.of_views
    }

    /// Components of luma, and of both channels of chroma.
    fn tables(&self) -> u64 {
        self.ranks[0] + 2 * self.ranks[1]
    }

    /// The truncated SVD of luma: five copies of its range, in which one is of double precision, and a block of images
    /// and of what it is in rows.
    fn decomposition(&self) -> u64 {
        let (pairs, width) = (self.lights * self.views, self.ranks[0] + OVERSAMPLING);
        4 * (width * (5 * self.texels.max(pairs) + self.texels.min(pairs)) + 2 * BLOCK * self.texels)
    }

    /// Coefficients of all texels: those of the decomposition, those with mipmaps, and what a stage leaves of them.
    fn coefficients(&self) -> u64 {
        4 * 3 * self.texels * (self.ranks[0] + self.ranks[1])
    }

    /// Normal equations in double precision, on every thread those of another azimuth, and what is kept of them.
    fn resampler(&self) -> u64 {
        let azimuths = self.views + u64::from(self.nodes[3]);
        let squares = (1 + 3 * self.threads.min(azimuths)) * self.of_lights.pow(2);
        let kept = azimuths * self.of_lights * self.lights;
        8 * (kept + squares.max(4 * self.of_views.pow(2)) + self.of_views * azimuths)
    }

    /// Components at all nodes, and once more while they are joined.
    fn components(&self) -> u64 {
        self.kept_components() + 4 * self.ranks[0] * self.all_nodes()
    }

    fn kept_components(&self) -> u64 {
        4 * self.tables() * self.all_nodes()
    }

    /// A file of a size, with all that was made before and is still there.
    fn of_size(&self, size: &Size) -> u64 {
        let nodes = self.all_nodes();
        match size {
            // The entries of P4 at all nodes: as they are wanted, as vectors to be clustered, as they are decoded, as the
            // round before left them, and as the stages before did. The same of P3, which has twice as many entries, of
            // one azimuth each.
            Size::Nested(Extent { p4, stages }) => {
                let p4 = (*p4 as u64).min(self.texels);
                let p3 = (2 * p4).min(p4 * u64::from(self.nodes[3]));
                let of_p4 = p4 * nodes * (3 + *stages as u64);
                let of_p3 = 5 * p3 * nodes / u64::from(self.nodes[3].max(1));
                self.kept_components() + self.coefficients() + 4 * (of_p4 + of_p3)
            }
            // All tables as they are fitted and as matrices, products of each with itself or what is decoded of all, twice.
            Size::Factored { .. } => {
                let products = self.of_lights.pow(2).max(self.of_views.pow(2)).max(2 * nodes);
                self.kept_components() + self.coefficients() + 4 * self.tables() * (2 * nodes + products)
            }
            // Apparent BRDFs of three channels, on every thread those that it fits, and what was measured of them.
            Size::Havran2010 { .. } => {
                let count = APPARENT_BRDFS.min(self.texels);
                let fitted = COLUMNS.min(3 * count) * self.threads;
                let rows = self.views + u64::from(self.nodes[3]);
                let tables = 3 * count * nodes + fitted * (self.of_lights * rows + 2 * nodes);
                self.resampler() + 4 * (tables + 3 * count * self.lights * self.views)
            }
        }
    }
}
