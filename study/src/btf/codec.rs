//! Codecs that are compared, and at how many bytes.

use subsurf_cli::program::progress::Bars;
use subsurf_encoder::Error;
use subsurf_encoder::baseline::whole_brdf::{
    Baseline, local_pca, local_pca_bytes, one_level, one_level_bytes, pca, pca_bytes,
};
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::{Method, Options, Setup, TruncatedSvd, presets};
use subsurf_encoder::capture::Images;
use subsurf_encoder::rate::Target;
use subsurf_encoder::rate::btf::search;

use super::svd::{SEED, shared_svd};

/// Codec: a way to compress. Baselines may take as many bytes as another codec takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    Nested,
    Havran2010,
    /// Nested codebooks with half the bytes of the paper's encoder.
    NestedAsHavran2010,
    Factored,
    /// One-level vector quantisation with the bytes of nested codebooks.
    OneLevelAsNested,
    OneLevelAsFactored,
    Pca,
    LocalPca,
}

/// Outcome of a codec.
pub(super) enum Made {
    File(Vec<u8>),
    Baseline(Baseline),
}

impl Made {
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::File(bytes) => bytes.len() as u64,
            Self::Baseline(baseline) => baseline.bytes,
        }
    }
}

/// Clusters that local PCA is tried with.
const CLUSTERS: [usize; 4] = [2, 3, 4, 6];

/// Options of the encoders of one file.
pub(super) fn setup(method: Method, names: &[String], images: &[Images]) -> subsurf_encoder::Result<Setup> {
    Setup::new(images, names, &Options { method, seed: SEED, ..Options::default() })
}

impl Codec {
    pub(super) const ALL: [Self; 8] = [
        Self::Nested,
        Self::Havran2010,
        Self::NestedAsHavran2010,
        Self::Factored,
        Self::OneLevelAsNested,
        Self::OneLevelAsFactored,
        Self::Pca,
        Self::LocalPca,
    ];

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Nested => "nested",
            Self::Havran2010 => "paper",
            Self::NestedAsHavran2010 => "nested-as-paper",
            Self::Factored => "factored",
            Self::OneLevelAsNested => "one-level-as-nested",
            Self::OneLevelAsFactored => "one-level",
            Self::Pca => "pca",
            Self::LocalPca => "local-pca",
        }
    }

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Nested => "nested",
            Self::Havran2010 => "the paper's encoder",
            Self::NestedAsHavran2010 => "nested, half the paper's bytes",
            Self::Factored => "factored",
            Self::OneLevelAsNested => "one-level VQ, bytes of nested",
            Self::OneLevelAsFactored => "one-level VQ, bytes of factored",
            Self::Pca => "PCA, bytes of factored",
            Self::LocalPca => "local PCA, bytes of factored",
        }
    }

    /// Codec whose bytes a baseline may take.
    pub(super) fn budget_of(self) -> Option<Self> {
        match self {
            Self::Nested | Self::Havran2010 | Self::Factored => None,
            Self::NestedAsHavran2010 => Some(Self::Havran2010),
            Self::OneLevelAsNested => Some(Self::Nested),
            Self::OneLevelAsFactored | Self::Pca | Self::LocalPca => Some(Self::Factored),
        }
    }

    /// Compresses; baselines to at most `budget` bytes, if they can be that small. Several local PCAs are handed back.
    pub(super) fn make(
        self,
        name: &str,
        images: &[Images],
        svd: &mut Option<TruncatedSvd>,
        budget: u64,
    ) -> anyhow::Result<Vec<Made>> {
        let setup = |method| setup(method, &[name.to_owned()], images);
        if self == Self::Havran2010 {
            return Ok(vec![Made::File(setup(Method::Havran2010)?.havran2010(images, 1.0, &Bars::new())?)]);
        }
        let svd = shared_svd(images, svd)?;
        let (texels, pairs) = (svd.texels(), images[0].pairs());
        let most = |bytes: &dyn Fn(usize) -> u64, range: std::ops::Range<usize>| {
            range.rev().find(|count| bytes(*count) <= budget)
        };
        Ok(match self {
            Self::Nested => {
                let prepared = setup(Method::Nested)?.nested(images, svd);
                vec![Made::File(prepared.encode(&Extent::USUAL.sizes(), &Bars::new())?.to_bytes())]
            }
            Self::NestedAsHavran2010 => {
                let prepared = setup(Method::Nested)?.nested(images, svd);
                let encode = |extent: &Extent| Ok(prepared.encode(&extent.sizes(), &Bars::new())?.to_bytes());
                let target = Target::Bytes(budget / 2);
                match search(images, &Extent::LADDER, target, &Bars::new(), encode, &mut |_| ()) {
                    Ok(curve) => vec![Made::File(curve.chosen().file.clone())],
                    // No codebooks are that small.
                    Err(Error::Request(_)) => Vec::new(),
                    Err(error) => return Err(error.into()),
                }
            }
            Self::Factored => {
                let prepared = setup(Method::Factored)?.factored(images, svd)?;
                let bytes = usize::try_from(presets::factored_bytes(svd.raw_bytes))?;
                vec![Made::File(prepared.encode_to(bytes, &Bars::new())?.0)]
            }
            Self::OneLevelAsNested | Self::OneLevelAsFactored => {
                let grid = setup(Method::Nested)?.grid;
                let words = most(&|words| one_level_bytes(words, texels, &grid), 2..257);
                words.map(|words| Made::Baseline(one_level(&images[0], svd, &grid, words, SEED))).into_iter().collect()
            }
            Self::Pca => {
                let components = most(&|count| pca_bytes(count, texels, pairs), 1..65);
                components.map(|components| Made::Baseline(pca(svd, components))).into_iter().collect()
            }
            Self::LocalPca => {
                let of = |clusters: usize| {
                    let components = most(&|count| local_pca_bytes(clusters, count, texels, pairs), 1..65)?;
                    Some(Made::Baseline(local_pca(svd, clusters, components, SEED)))
                };
                CLUSTERS.into_iter().filter_map(of).collect()
            }
            Self::Havran2010 => Vec::new(),
        })
    }
}
