//! From a capture to a file.

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::baseline::{song2009, yatagawa2020};
use crate::bssrdf::field::Field;
use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::bssrdf::options::{self, Method, Options};
use crate::bssrdf::write::{self, write_file};
use crate::bssrdf::{clusters, direct, profiles};
use crate::capture::Capture;
use crate::error::Result;
use crate::file::reread::reread;
use crate::progress::Progress;

/// A fitted material as a file, with figures of the fit.
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
    /// Base materials per pixel, K; 0 for per-pixel profiles.
    pub per_pixel: usize,
    /// Base materials in the file, those that no pixel has left out; 0 for per-pixel profiles.
    pub base_materials: usize,
    /// Nodes of a profile, S.
    pub samples: usize,
    /// Whether [`Progress::stopped`] cut the fit short.
    pub stopped: bool,
}

/// The file's bytes.
impl AsRef<[u8]> for Encoded {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

/// A capture made ready to be fitted, once or many times.
pub struct Problem<'a> {
    capture: &'a Capture,
    normal: Normal,
    /// Per-pixel profiles, once they are known.
    profiles: Option<Field>,
}

impl<'a> Problem<'a> {
    /// A capture, read for profiles of `samples` nodes, S; `None` takes R + 1.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for S out of range, [`Error::Input`](crate::Error::Input) if nothing was
    /// measured.
    pub fn new(capture: &'a Capture, samples: Option<usize>, progress: &dyn Progress) -> Result<Self> {
        let geometry = options::geometry(capture, samples)?;
        Ok(Self { capture, normal: Normal::of(capture, geometry, progress)?, profiles: None })
    }

    /// A fit. It depends on capture and options alone, not on the number of threads or on earlier fits.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for options out of range; [`Error::OwnOutput`](crate::Error::OwnOutput)
    /// if the decoder refuses the file.
    pub fn fit(&mut self, options: &Options, progress: &dyn Progress) -> Result<Encoded> {
        options.check()?;
        let mut header = options.header(self.capture, &self.normal.geometry);
        let (sections, cost) = match options.method {
            Method::Song2009 => {
                let profiles = self.profiles.get_or_insert_with(|| profiles::fit(&self.normal, progress));
                (vec![song2009::section(&self.normal, profiles)], self.normal.cost(profiles))
            }
            Method::Yatagawa2020 => {
                let model =
                    yatagawa2020::fit(&self.normal, options.per_pixel, options.base_materials, options.seed, progress);
                self.of_bases(&mut header, model, options.half_profiles)
            }
            Method::Clusters | Method::Direct => {
                let profiles = self.profiles.get_or_insert_with(|| profiles::fit(&self.normal, progress));
                let clusters =
                    clusters::cluster(&self.normal, profiles, options.base_materials, options.seed, progress);
                let mut model = Model::of_clusters(clusters, self.normal.geometry.nodes);
                if options.method == Method::Direct {
                    direct::refine(&self.normal, &mut model, options.per_pixel, options.coding, progress);
                }
                self.of_bases(&mut header, model, options.half_profiles)
            }
        };
        Ok(Encoded {
            bytes: reread(write_file(&header, &sections))?,
            entries: self.normal.entries[0],
            measured: self.normal.entries[1],
            cost,
            per_pixel: header.model.into(),
            base_materials: header.base_materials as usize,
            samples: self.normal.geometry.nodes,
            // Per-pixel profiles are solved for to the end in any case.
            stopped: options.method != Method::Song2009 && progress.stopped(),
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

/// A fit of a capture, once.
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

/// P̂_b^h of all base materials.
fn base_profiles(normal: &Normal, model: &Model) -> impl Iterator<Item = f32> {
    let mean = normal.mean.iter().cycle();
    model.bases.iter().zip(mean).flat_map(|(p, mean)| [0, 1, 2].map(|c| p[c] + mean[c]))
}
