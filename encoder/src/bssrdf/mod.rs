//! Fits diffuse BSSRDFs: per-pixel profiles and K-BMPP.

mod banded;
mod cluster;
mod direct;
mod field;
mod lanes;
mod lsp;
mod memory;
mod normal;
mod options;
mod paper;
mod window;
mod write;

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::capture::Capture;
use crate::error::Result;
use crate::progress::Progress;
use direct::Model;
use field::Field;
pub use memory::fit_bytes;
use normal::Normal;
pub use options::{Method, Options};
pub use write::{mixtures, profiles, write_file};

/// A fitted material.
#[derive(Clone, Debug)]
pub struct Encoded {
    /// The `.subsurf` file.
    pub bytes: Vec<u8>,
    /// Entries of the capture inside the material; three channels make three entries.
    pub entries: u64,
    /// Those of them that were measured.
    pub measured: u64,
    /// ½ Σ φ (P̂_i + P̂_j − 2 ln Rd)² over all of these (Yatagawa et al. 2020, eq. 5), before profiles are rounded to
    /// half floats.
    pub cost: f64,
    /// K of the file; 0 for per-pixel profiles.
    pub per_pixel: usize,
    /// Base materials in the file, those that no pixel has left out; 0 for per-pixel profiles.
    pub base_materials: usize,
    /// S.
    pub samples: usize,
    /// Whether [`Progress::stopped`] cut the fit short.
    pub stopped: bool,
}

/// A capture made ready to be fitted, once or many times.
pub struct Problem<'a> {
    capture: &'a Capture,
    normal: Normal,
    /// Per-pixel profiles, once they are known.
    profiles: Option<Field>,
}

impl<'a> Problem<'a> {
    /// Reads a capture, for profiles of S nodes; `None` takes R + 1.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for S out of range, [`Error::Input`](crate::Error::Input) if nothing was
    /// measured.
    pub fn new(capture: &'a Capture, samples: Option<usize>, progress: &dyn Progress) -> Result<Self> {
        let geometry = options::geometry(capture, samples)?;
        Ok(Self { capture, normal: Normal::of(capture, geometry, progress)?, profiles: None })
    }

    /// Fits. The result depends on capture and options alone, not on the number of threads or on earlier fits.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for options out of range.
    pub fn fit(&mut self, options: &Options, progress: &dyn Progress) -> Result<Encoded> {
        options.check()?;
        let mut header = options.header(self.capture, &self.normal.geometry);
        let (sections, cost) = match options.method {
            Method::Lsp => {
                let profiles = self.profiles.get_or_insert_with(|| lsp::fit(&self.normal, progress));
                (vec![local_profiles(&self.normal, profiles)], self.normal.cost(profiles))
            }
            Method::Paper => {
                let model = paper::fit(&self.normal, options.per_pixel, options.base_materials, options.seed, progress);
                self.of_bases(&mut header, model, options.half_profiles)
            }
            Method::Clusters | Method::Direct => {
                let profiles = self.profiles.get_or_insert_with(|| lsp::fit(&self.normal, progress));
                let clusters = cluster::cluster(&self.normal, profiles, options.base_materials, options.seed, progress);
                let mut model = Model::of_clusters(clusters, self.normal.geometry.nodes);
                if options.method == Method::Direct {
                    direct::refine(&self.normal, &mut model, options.per_pixel, options.coding, progress);
                }
                self.of_bases(&mut header, model, options.half_profiles)
            }
        };
        Ok(Encoded {
            bytes: write_file(&header, &sections),
            entries: self.normal.entries[0],
            measured: self.normal.entries[1],
            cost,
            per_pixel: header.model.into(),
            base_materials: header.base_materials as usize,
            samples: self.normal.geometry.nodes,
            // Per-pixel profiles are solved for to the end in any case.
            stopped: options.method != Method::Lsp && progress.stopped(),
        })
    }

    /// Sections and cost of a model, and in the header the base materials that are left.
    fn of_bases(
        &self,
        header: &mut BssrdfHeader,
        mut model: Model,
        half_profiles: bool,
    ) -> (Vec<(Section, Vec<u8>)>, f64) {
        model.drop_unused();
        header.base_materials = u32::try_from(model.count()).expect("at most 65,536 base materials");
        let mut sections = vec![write::profiles(base_profiles(&self.normal, &model), half_profiles)];
        sections.extend(write::mixtures(header, &model.mixtures));
        (sections, self.normal.cost(&model.field(&self.normal)))
    }
}

/// Bytes of the file of a K-BMPP fit; an upper bound for palettes, and where base materials turn out to be unused.
///
/// # Errors
/// [`Error::Request`](crate::Error::Request) for S or options out of range.
pub fn file_bytes(capture: &Capture, samples: Option<usize>, options: &Options) -> Result<u64> {
    options.check()?;
    let geometry = options::geometry(capture, samples)?;
    Ok(write::file_bytes(&options.header(capture, &geometry), options.half_profiles))
}

/// The largest M with which the file of a K-BMPP fit takes at most `limit` bytes, by [`file_bytes`]; 0 if none does.
///
/// # Errors
/// As [`file_bytes`].
pub fn base_materials_within(
    capture: &Capture,
    samples: Option<usize>,
    options: &Options,
    limit: u64,
) -> Result<usize> {
    // Every base material takes bytes: all up to `fits` do, and none from `too_many` on.
    let (mut fits, mut too_many) = (0, options.most_base_materials() + 1);
    while fits + 1 < too_many {
        let base_materials = fits.midpoint(too_many);
        if file_bytes(capture, samples, &Options { base_materials, ..*options })? <= limit {
            fits = base_materials;
        } else {
            too_many = base_materials;
        }
    }
    Ok(fits)
}

/// Fits a capture once.
///
/// # Errors
/// As [`Problem::new`] and [`Problem::fit`].
pub fn encode(
    capture: &Capture,
    samples: Option<usize>,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Encoded> {
    options.check()?;
    Problem::new(capture, samples, progress)?.fit(options, progress)
}

/// `LSPP`: planes of node and channel.
fn local_profiles(normal: &Normal, profiles: &Field) -> (Section, Vec<u8>) {
    let planes = (0..normal.geometry.nodes).flat_map(|h| (0..3).map(move |c| (h, c)));
    let values = planes.flat_map(|(h, c)| {
        let mean = normal.mean[h][c];
        (0..normal.geometry.pixels()).map(move |pixel| profiles.at(pixel)[h][c] + mean)
    });
    (Section::LocalProfiles, write::logs(values))
}

/// P̂_b^h of all base materials.
fn base_profiles(normal: &Normal, model: &Model) -> impl Iterator<Item = f32> {
    let mean = normal.mean.iter().cycle();
    model.bases.iter().zip(mean).flat_map(|(p, mean)| [0, 1, 2].map(|c| p[c] + mean[c]))
}
