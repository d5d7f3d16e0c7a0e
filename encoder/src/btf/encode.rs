//! From images of materials to a file, with the presets that the command has.

use subsurf_decoder::bssrdf::layout::LENGTHS_MM;
use subsurf_decoder::btf::{BtfHeader, Grid};
use subsurf_decoder::{File, Section};

use crate::baseline::havran2010;
use crate::btf::memory::Fit;
use crate::btf::size::{Method, Size};
use crate::btf::truncated_svd::TruncatedSvd;
use crate::btf::{factored, nested, presets};
use crate::capture::Images;
use crate::error::{Error, Result};
use crate::file::container;
use crate::file::reread::reread;
use crate::progress::Progress;
use crate::rate;
use crate::rate::Target;

/// How large a file is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The usual size of the method, see [`presets::size`].
    Usual,
    /// A size of the method's own.
    Size(Size),
    /// The smallest file of a quality, or the best of a number of bytes.
    Target(Target),
}

/// What a BTF file is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Method that makes it.
    pub method: Method,
    /// Nodes of α, sin β, θ_v and φ_v; [`presets::nodes`] if not given.
    pub nodes: Option<[u8; 4]>,
    /// Whether to make mipmaps, which take a third more of what is stored for texels.
    pub has_mipmaps: bool,
    /// Seed of the first codewords.
    pub seed: u64,
    /// How large it is to be.
    pub goal: Goal,
    /// Distance of neighbouring texels of the materials in mm, 10⁻⁶ to 10⁶, where it is known.
    pub texel_mm: Option<f32>,
}

impl Default for Options {
    fn default() -> Self {
        Self { method: Method::Nested, nodes: None, has_mipmaps: false, seed: 1, goal: Goal::Usual, texel_mm: None }
    }
}

/// A BTF file, and how it came about.
#[derive(Clone, Debug)]
pub struct Encoded {
    /// The `.subsurf` file.
    pub bytes: Vec<u8>,
    /// Its size in the method's own terms.
    pub size: Size,
    /// Files that were tried, if the goal was a target.
    pub curve: Option<rate::btf::Curve<Size>>,
}

/// The file of some materials, each with a name. Every file that a search tries is shown to `found` as it comes.
///
/// # Errors
/// [`Error::Request`] for options out of range, for materials that do not go into one file, for fits that take more memory
/// than there is, and for targets that no file meets; [`Error::OwnOutput`] if the decoder refuses a file.
pub fn encode(
    materials: &[Images],
    names: &[String],
    options: &Options,
    progress: &dyn Progress,
    found: &mut dyn FnMut(&rate::btf::Point<Size>),
) -> Result<Encoded> {
    let [shortest, longest] = LENGTHS_MM;
    if let Some(texel_mm) = options.texel_mm.filter(|texel_mm| !(shortest..=longest).contains(texel_mm)) {
        return Err(Error::Request(format!("texels of {texel_mm} mm; a file holds {shortest} to {longest}")));
    }
    let setup = Setup::new(materials, names, options)?;
    let ranks = presets::ranks(materials.len());
    let fit = Fit::new(options.method, materials, &setup.grid, ranks, options.has_mipmaps);
    let wanted = Wanted::new(options, materials)?;
    fit.expect(wanted.first())?;
    let svd = || TruncatedSvd::new(materials, ranks, options.seed, progress);
    let mut choose = |encode: &dyn Fn(&Size) -> Result<Vec<u8>>| {
        let encode = |size: &Size| fit.expect_size(size).and_then(|()| encode(size));
        wanted.choose(materials, progress, encode, found)
    };
    let encoded = match options.method {
        Method::Havran2010 => choose(&|size| match size {
            Size::Havran2010 { looseness } => setup.havran2010(materials, *looseness, progress),
            other => Err(mismatch(options.method, other)),
        }),
        Method::Factored => {
            let svd = svd()?;
            let prepared = setup.factored(materials, &svd)?;
            choose(&|size| match size {
                Size::Factored { most_bytes } => {
                    let (bytes, _) =
                        prepared.encode_to(usize::try_from(*most_bytes).unwrap_or(usize::MAX), progress)?;
                    reread(bytes)
                }
                other => Err(mismatch(options.method, other)),
            })
        }
        Method::Nested => {
            let svd = svd()?;
            let prepared = setup.nested(materials, &svd);
            choose(&|size| match size {
                Size::Nested(extent) => reread(prepared.encode(&extent.sizes(), progress)?.to_bytes()),
                other => Err(mismatch(options.method, other)),
            })
        }
    }?;
    match options.texel_mm {
        Some(texel_mm) => Ok(Encoded { bytes: with_texel_size(&encoded.bytes, texel_mm)?, ..encoded }),
        None => Ok(encoded),
    }
}

/// The same file with the size of its texels in its header.
fn with_texel_size(file: &[u8], texel_mm: f32) -> Result<Vec<u8>> {
    let content = File::parse(file).map_err(|source| Error::OwnOutput { source })?.content();
    let header = *content.catalog().expect("encoders of BTFs make BTFs").header();
    let header = BtfHeader { texel_mm: Some(texel_mm), ..header };
    container::with_section(file, Section::BtfHeader, Some(&header.to_bytes()))
}

fn mismatch(method: Method, size: &Size) -> Error {
    Error::Request(format!("{size:?} is no size of the method {method:?}"))
}

/// Sizes that are asked for.
enum Wanted {
    One(Size),
    /// From small to large.
    Ladder(Vec<Size>, Target),
}

impl Wanted {
    fn new(options: &Options, materials: &[Images]) -> Result<Self> {
        let raw_bytes = materials.iter().map(Images::bytes).sum();
        Ok(match options.goal {
            Goal::Usual => Self::One(presets::size(options.method, raw_bytes)),
            Goal::Size(size) => {
                size.check()?;
                Self::One(size)
            }
            Goal::Target(target) => Self::Ladder(presets::ladder(options.method, target, raw_bytes), target),
        })
    }

    /// The size that is tried first.
    fn first(&self) -> &Size {
        match self {
            Self::One(size) => size,
            Self::Ladder(sizes, _) => sizes.first().expect("ladders have steps"),
        }
    }

    /// The file of the size that is asked for, or the best of those that a search tries.
    fn choose(
        &self,
        materials: &[Images],
        progress: &dyn Progress,
        encode: impl Fn(&Size) -> Result<Vec<u8>>,
        found: &mut dyn FnMut(&rate::btf::Point<Size>),
    ) -> Result<Encoded> {
        match self {
            Self::One(size) => Ok(Encoded { bytes: encode(size)?, size: *size, curve: None }),
            Self::Ladder(sizes, target) => {
                let curve = rate::btf::search(materials, sizes, *target, progress, encode, found)?;
                let chosen = curve.chosen();
                Ok(Encoded { bytes: chosen.file.clone(), size: chosen.candidate, curve: Some(curve) })
            }
        }
    }
}

/// What all methods want to know of a file, with presets for the rest: for callers who encode the same materials many
/// times.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Nodes of directions.
    pub grid: Grid,
    /// Names of the materials.
    pub names: Vec<String>,
    /// Whether to make mipmaps.
    pub has_mipmaps: bool,
    /// Seed of the first codewords.
    pub seed: u64,
}

impl Setup {
    /// Setup for some materials, which were measured in the same directions.
    ///
    /// # Errors
    /// [`Error::Request`] if there is no material, or for nodes out of range.
    pub fn new(materials: &[Images], names: &[String], options: &Options) -> Result<Self> {
        let first = materials.first().ok_or_else(|| Error::Request("no material".to_owned()))?;
        let nodes = options.nodes.unwrap_or_else(|| presets::nodes(options.method, first));
        let grid = presets::grid(first, nodes)?;
        Ok(Self { grid, names: names.to_vec(), has_mipmaps: options.has_mipmaps, seed: options.seed })
    }

    /// Materials on the nodes of the grid, for nested codebooks of all sizes.
    #[must_use]
    pub fn nested<'a>(&self, materials: &[Images], svd: &'a TruncatedSvd) -> nested::Prepared<'a> {
        let Self { grid, names, has_mipmaps, seed } = self.clone();
        let chroma = presets::chroma_sizes(materials.len());
        nested::Prepared::new(materials, svd, nested::Options { grid, chroma, names, has_mipmaps, seed })
    }

    /// Materials on the nodes of the grid, for factors of all sizes.
    ///
    /// # Errors
    /// As [`factored::Prepared::new`].
    pub fn factored<'a>(&self, materials: &[Images], svd: &'a TruncatedSvd) -> Result<factored::Prepared<'a>> {
        let Self { grid, names, has_mipmaps, seed } = self.clone();
        let chroma_weight = presets::CHROMA_WEIGHT;
        factored::Prepared::new(materials, svd, factored::Options { grid, chroma_weight, names, has_mipmaps, seed })
    }

    /// A file by the encoder of Havran et al. 2010, with its usual thresholds times `looseness`.
    ///
    /// # Errors
    /// As [`havran2010::encode`]; [`Error::OwnOutput`] if the decoder refuses the file.
    pub fn havran2010(&self, materials: &[Images], looseness: f32, progress: &dyn Progress) -> Result<Vec<u8>> {
        let Self { grid, names, has_mipmaps, seed } = self.clone();
        let usual = havran2010::Options::default();
        let similarity = usual.similarity.times(looseness);
        let options = havran2010::Options { grid, similarity, names, has_mipmaps, seed, ..usual };
        reread(havran2010::encode(materials, &options, progress)?.to_bytes())
    }
}
