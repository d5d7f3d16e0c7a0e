//! Codecs that are compared, and at how many bytes.

use subsurf_cli::encode::btf::{Common, MethodArg, grid, usual_bytes, usual_nodes};
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::Error;
use subsurf_encoder::btf::baseline::{
    Baseline, local_pca, local_pca_bytes, one_level, one_level_bytes, pca, pca_bytes,
};
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::rate::{self, Target};
use subsurf_encoder::btf::{Images, Survey};

use super::survey::{SEED, surveyed};

/// Codec: a way to compress. Baselines may take as many bytes as another codec takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    Nested,
    Paper,
    /// Nested codebooks with half the bytes of the paper's encoder.
    NestedAsPaper,
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
pub(super) fn common(method: MethodArg, names: &[String], images: &[Images]) -> anyhow::Result<Common> {
    let grid = grid(&images[0], &usual_nodes(method, &images[0]))?;
    Ok(Common { grid, names: names.to_vec(), has_mipmaps: false, seed: SEED })
}

impl Codec {
    pub(super) const ALL: [Self; 8] = [
        Self::Nested,
        Self::Paper,
        Self::NestedAsPaper,
        Self::Factored,
        Self::OneLevelAsNested,
        Self::OneLevelAsFactored,
        Self::Pca,
        Self::LocalPca,
    ];

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Nested => "nested",
            Self::Paper => "paper",
            Self::NestedAsPaper => "nested-as-paper",
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
            Self::Paper => "the paper's encoder",
            Self::NestedAsPaper => "nested, half the paper's bytes",
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
            Self::Nested | Self::Paper | Self::Factored => None,
            Self::NestedAsPaper => Some(Self::Paper),
            Self::OneLevelAsNested => Some(Self::Nested),
            Self::OneLevelAsFactored | Self::Pca | Self::LocalPca => Some(Self::Factored),
        }
    }

    /// Compresses; baselines to at most `budget` bytes, if they can be that small. Several local PCAs are handed back.
    pub(super) fn make(
        self,
        name: &str,
        images: &[Images],
        survey: &mut Option<Survey>,
        budget: u64,
    ) -> anyhow::Result<Vec<Made>> {
        let common = |method| common(method, &[name.to_owned()], images);
        if self == Self::Paper {
            return Ok(vec![Made::File(common(MethodArg::Paper)?.paper(images, 1.0)?)]);
        }
        let survey = surveyed(images, survey)?;
        let (texels, pairs) = (survey.texels(), images[0].pairs());
        let most = |bytes: &dyn Fn(usize) -> u64, range: std::ops::Range<usize>| {
            range.rev().find(|count| bytes(*count) <= budget)
        };
        Ok(match self {
            Self::Nested => {
                let prepared = common(MethodArg::Nested)?.nested(images, survey);
                vec![Made::File(prepared.encode(&Extent::USUAL.sizes(), &Bars::new())?.to_bytes())]
            }
            Self::NestedAsPaper => {
                let prepared = common(MethodArg::Nested)?.nested(images, survey);
                let encode = |extent: &Extent| Ok(prepared.encode(&extent.sizes(), &Bars::new())?.to_bytes());
                match rate::walk(images, &Extent::LADDER, Target::Bytes(budget / 2), &Bars::new(), encode, |_| ()) {
                    Ok(walked) => vec![Made::File(walked.points[walked.best].bytes.clone())],
                    // No codebooks are that small.
                    Err(Error::Request(_)) => Vec::new(),
                    Err(error) => return Err(error.into()),
                }
            }
            Self::Factored => {
                let prepared = common(MethodArg::Factored)?.factored(images, survey)?;
                let bytes = usize::try_from(usual_bytes(survey))?;
                vec![Made::File(prepared.encode_to(bytes, &Bars::new())?.0)]
            }
            Self::OneLevelAsNested | Self::OneLevelAsFactored => {
                let grid = common(MethodArg::Nested)?.grid;
                let words = most(&|words| one_level_bytes(words, texels, &grid), 2..257);
                words
                    .map(|words| Made::Baseline(one_level(&images[0], survey, &grid, words, SEED)))
                    .into_iter()
                    .collect()
            }
            Self::Pca => {
                let components = most(&|count| pca_bytes(count, texels, pairs), 1..65);
                components.map(|components| Made::Baseline(pca(survey, components))).into_iter().collect()
            }
            Self::LocalPca => {
                let of = |clusters: usize| {
                    let components = most(&|count| local_pca_bytes(clusters, count, texels, pairs), 1..65)?;
                    Some(Made::Baseline(local_pca(survey, clusters, components, SEED)))
                };
                CLUSTERS.into_iter().filter_map(of).collect()
            }
            Self::Paper => Vec::new(),
        })
    }
}
