//! From the arrays of a file to a BRDF: whether they are all there, of sizes that fit, and make sense.

use std::path::Path;

use super::Rgl;
use super::tensor::Tensors;
use super::warp::Density;
use crate::error::{Error, Result};

/// How far a table may vary with azimuth, as a share of its largest value.
const SAME: f32 = 1e-4;

pub(super) fn parse(path: &Path, file: &[u8]) -> Result<Rgl> {
    let tensors = Tensors::parse(path, file)?;
    let wrong = |found: &str, expected: &str| Error::input(path, found, expected);
    if !tensors.has("rgb") && tensors.has("spectra") {
        return Err(wrong("a spectral BRDF", "one in RGB, which the database has of every material"));
    }
    let ([azimuths], _) = tensors.floats("phi_i")?;
    if azimuths != 1 {
        return Err(wrong(&format!("{azimuths} azimuths of incidence"), "1: an isotropic BRDF"));
    }
    let ([slices], theta_i) = tensors.floats("theta_i")?;
    let is_above = |theta: &f32| (0.0..=1.571).contains(theta);
    if slices < 2 || !theta_i.is_sorted_by(|a, b| a < b) || !theta_i.iter().all(is_above) {
        let (first, last) = (theta_i.first().unwrap_or(&0.0), theta_i.last().unwrap_or(&0.0));
        let found = format!("{slices} angles of incidence from {first} to {last} rad");
        return Err(wrong(&found, "two or more that grow from 0 to π/2"));
    }
    let ([azimuths, of_density, rows, columns], densities) = tensors.floats("vndf")?;
    let ([of_azimuths, of_rgb, channels, height, width], rgb) = tensors.floats("rgb")?;
    for (name, shape) in
        [("vndf", [azimuths, of_density, 3, rows, columns]), ("rgb", [of_azimuths, of_rgb, channels, height, width])]
    {
        let [azimuths, found, channels, y, x] = shape;
        if (azimuths, found, channels) != (1, slices, 3) || y < 2 || x < 2 {
            let found = format!("\"{name}\" of {azimuths} × {found} slices, {channels} channels, {y} × {x} nodes");
            return Err(wrong(&found, &format!("1 × {slices} slices, 3 channels, at least 2 × 2 nodes")));
        }
    }
    if densities.iter().any(|density| *density < 0.0) {
        return Err(wrong("a density below 0 in \"vndf\"", "none"));
    }
    let densities = densities.chunks_exact(rows * columns);
    Ok(Rgl {
        path: path.to_owned(),
        file_bytes: file.len() as u64,
        theta_i: theta_i.iter().map(|theta| f64::from(*theta)).collect(),
        microfacets: over_theta(path, &tensors, "ndf")?,
        area: over_theta(path, &tensors, "sigma")?,
        densities: densities.map(|density| Density::new([columns, rows], density)).collect(),
        size: [width, height],
        rgb,
        has_jacobian: tensors.byte("jacobian")? != 0,
    })
}

/// One row of a table over azimuth and θ, whose rows are all the same.
fn over_theta(path: &Path, tensors: &Tensors<'_>, name: &str) -> Result<Vec<f64>> {
    let ([rows, nodes], values) = tensors.floats(name)?;
    let largest = values.iter().copied().fold(0.0, f32::max);
    if rows == 0 || nodes < 2 || largest <= 0.0 || values.iter().any(|value| *value < 0.0) {
        let found = format!("\"{name}\" of {rows} × {nodes} values up to {largest}");
        return Err(Error::input(path, found, "two or more to a row, none below 0"));
    }
    let (first, others) = values.split_at(nodes);
    let is_same = |(value, first): (&f32, &f32)| (value - first).abs() <= SAME * largest;
    if !others.iter().zip(first.iter().cycle()).all(is_same) {
        return Err(Error::input(path, format!("\"{name}\" that varies with azimuth"), "an isotropic BRDF"));
    }
    Ok(first.iter().map(|value| f64::from(*value)).collect())
}
