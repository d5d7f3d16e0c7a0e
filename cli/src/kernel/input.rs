//! Profiles, and the refractive indices that come with them, from wherever they are asked for.

use std::path::Path;

use subsurf_decoder::{Content, File};
use subsurf_encoder::kernel::profile::{of_base, shipped};
use subsurf_encoder::kernel::{Options, Profile, TwoGaussians};
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::profile::PACKETS;
use subsurf_encoder::{Error, Progress as _};
use subsurf_viewer::read;

use super::{Args, channels};
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;

/// Models of homogeneous half-spaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Model {
    /// Traced photon by photon
    MonteCarlo,
    /// A source and its image (Jensen et al. 2001)
    Dipole,
    /// Normalised diffusion (Burley 2015), with the albedo that photons give
    Burley,
}

/// The profile that a kernel is made of, and η.
pub(super) fn profile(args: &Args, two: Option<&TwoGaussians>) -> anyhow::Result<(Profile, f32)> {
    let reflectance = args.reflectance.as_ref().map(|text| channels("--reflectance", text)).transpose()?;
    if let Some(wrong) = reflectance.iter().flatten().find(|share| !(**share > 0.0 && **share <= 1.0)) {
        return Err(bad_request(format!("--reflectance is {wrong}; expected more than 0, up to 1")));
    }
    if let Some(two) = two {
        let profile = Profile::of_two_gaussians(two, reflectance.unwrap_or([1.0; 3]))?;
        return Ok((profile, Options::default().eta));
    }
    let (profile, eta) = match &args.material {
        Some(name) => material(name, args)?,
        None => files(args)?,
    };
    let scaled = reflectance.map(|shares| profile.with_reflectance(shares.map(f64::from)));
    Ok((scaled.unwrap_or(profile), eta))
}

fn material(name: &str, args: &Args) -> anyhow::Result<(Profile, f32)> {
    let medium = Medium::measured(name).ok_or_else(|| bad_request(format!("no material is called {name}")))?;
    let eta = args.eta.map_or(Medium::measured_eta(name), f64::from);
    #[allow(clippy::cast_possible_truncation, reason = "an index of few digits")]
    let is_its_own = args.eta.is_none_or(|eta| eta == Medium::measured_eta(name) as f32);
    let traced = || match (args.photons, shipped::profile(name)) {
        (None, Some(profile)) if is_its_own => Ok(profile),
        (photons, _) => {
            let (_graceful, bars) = (Graceful::new(), Bars::new());
            let (profile, _) = shipped::simulate(name, eta, photons.unwrap_or(PACKETS), &bars)?;
            if bars.stopped() {
                return Err(bad_request(format!("{name}: stopped, and no kernel is made of a part of the photons")));
            }
            Ok(profile)
        }
    };
    let profile = match args.model.unwrap_or(Model::MonteCarlo) {
        Model::MonteCarlo => traced()?,
        Model::Dipole => Profile::dipole(&medium, eta)?,
        Model::Burley => Profile::normalised_diffusion(traced()?.reflectance(), &medium)?,
    };
    #[allow(clippy::cast_possible_truncation, reason = "an index of few digits")]
    let eta = eta as f32;
    Ok((profile, eta))
}

fn files(args: &Args) -> anyhow::Result<(Profile, f32)> {
    let eta = Options::default().eta;
    let of = |path: &Path, extension: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
    match args.input.iter().map(AsRef::as_ref).collect::<Vec<&Path>>()[..] {
        [one] if of(one, "subsurf") => base(one, args.base),
        [_, _, ..] if args.input.iter().any(|path| of(path, "subsurf")) => {
            Err(bad_request("several files; a .subsurf file has all channels, and stands alone"))
        }
        [_, ..] if args.base.is_some() => Err(bad_request("--base is for a .subsurf file of base materials")),
        [one] => Ok((Profile::read(one)?, eta)),
        [r, g, b] => Ok((Profile::read_channels([r, g, b])?, eta)),
        _ => Err(bad_request("two files; expected one, or three of red, green and blue")),
    }
}

fn base(path: &Path, number: Option<u16>) -> anyhow::Result<(Profile, f32)> {
    let bytes = read(path)?;
    let file = File::parse(&bytes).map_err(|source| Error::Read { path: path.into(), source })?;
    let Content::Bssrdf(material) = file.content() else {
        let found = file.content().family();
        return Err(bad_request(format!("{}: a {found}; expected a BSSRDF with base materials", path.display())));
    };
    let Some(number) = number else {
        let count = material.header().base_materials;
        return Err(bad_request(format!("{}: say which of its {count} base materials with --base", path.display())));
    };
    let profile = of_base(&material, number);
    let profile = profile.map_err(|error| bad_request(format!("{}: {error}", path.display())))?;
    Ok((profile, material.header().eta))
}
