//! Layers that light travels through, and where it starts.

use crate::error::{Error, Result};

/// A homogeneous layer between two planes of equal z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Refractive index η, 1 to 4.
    pub eta: f64,
    /// Absorption coefficient σ_a in mm⁻¹.
    pub sigma_a: f64,
    /// Scattering coefficient σ_s in mm⁻¹, not reduced.
    pub sigma_s: f64,
    /// Mean cosine of scattering g, −1 to 1, both excluded.
    pub g: f64,
    /// Thickness in mm; infinite for a half-space.
    pub thickness_mm: f64,
}

impl Layer {
    /// Extinction coefficient σ_t = σ_a + σ_s in mm⁻¹.
    #[must_use]
    pub fn sigma_t(&self) -> f64 {
        self.sigma_a + self.sigma_s
    }
}

/// Layers one below the other, the first at z = 0, z growing downwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    /// Refractive index above the first layer.
    pub eta_above: f64,
    /// Layers from the top.
    pub layers: Vec<Layer>,
    /// Refractive index below the last layer.
    pub eta_below: f64,
}

/// Where packets start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A ray of no width straight downwards that starts at depth `z_mm`; from above the first layer at 0.
    Pencil {
        /// Depth in mm.
        z_mm: f64,
    },
    /// A point at depth `z_mm` that shines in all directions alike.
    Isotropic {
        /// Depth in mm.
        z_mm: f64,
    },
}

impl Source {
    /// Depth at which packets start, in mm.
    pub(super) fn z_mm(self) -> f64 {
        match self {
            Self::Pencil { z_mm } | Self::Isotropic { z_mm } => z_mm,
        }
    }
}

impl Stack {
    /// A half-space of one medium under air: what profiles of materials are simulated in.
    #[must_use]
    pub fn half_space(eta: f64, sigma_a: f64, sigma_s: f64, g: f64) -> Self {
        let layer = Layer { eta, sigma_a, sigma_s, g, thickness_mm: f64::INFINITY };
        Self { eta_above: 1.0, layers: vec![layer], eta_below: eta }
    }

    /// Depths of the planes between layers in mm: that of layer k's top at k, that of the last one's bottom at the end.
    #[must_use]
    pub fn planes_mm(&self) -> Vec<f64> {
        let mut planes = vec![0.0];
        for layer in &self.layers {
            planes.push(planes[planes.len() - 1] + layer.thickness_mm);
        }
        planes
    }

    /// Share of a pencil from above that is reflected before it enters. Where the first of several layers is clear (glass), that
    /// is what comes back from both of its sides, after any number of reflections.
    #[must_use]
    pub fn specular(&self) -> f64 {
        let mirror = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
        let first = self.layers[0];
        let outer = mirror(self.eta_above, first.eta);
        let Some(second) = self.layers.get(1).filter(|_| first.sigma_t() == 0.0) else { return outer };
        let inner = mirror(first.eta, second.eta);
        outer + (1.0 - outer).powi(2) * inner / (1.0 - outer * inner)
    }

    /// Whether all of it can be simulated.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] that names the layer, the value and what is allowed.
    pub fn check(&self) -> Result<()> {
        let refuse = |what: String| Err(Error::Request(what));
        let index = |eta: f64| (1.0..=4.0).contains(&eta);
        if self.layers.is_empty() {
            return refuse("a stack has at least one layer".into());
        }
        for (place, eta) in [("above", self.eta_above), ("below", self.eta_below)] {
            if !index(eta) {
                return refuse(format!("refractive index {place} the layers: {eta}, allowed is 1 to 4"));
            }
        }
        for (k, layer) in self.layers.iter().enumerate() {
            let (number, last) = (k + 1, k + 1 == self.layers.len());
            let coefficient = |value: f64| (0.0..=1e9).contains(&value);
            let bad = [
                (!index(layer.eta), "refractive index", layer.eta, "1 to 4"),
                (!coefficient(layer.sigma_a), "absorption in mm⁻¹", layer.sigma_a, "0 to 1e9"),
                (!coefficient(layer.sigma_s), "scattering in mm⁻¹", layer.sigma_s, "0 to 1e9"),
                (layer.g.is_nan() || layer.g.abs() >= 1.0, "mean cosine g", layer.g, "−1 to 1, both excluded"),
                (
                    layer.thickness_mm.is_nan() || layer.thickness_mm <= 0.0,
                    "thickness in mm",
                    layer.thickness_mm,
                    "above 0",
                ),
                (
                    layer.thickness_mm.is_infinite() && !last,
                    "thickness in mm",
                    layer.thickness_mm,
                    "finite above other layers",
                ),
                (
                    layer.thickness_mm.is_infinite() && layer.sigma_a == 0.0 && layer.sigma_s == 0.0,
                    "extinction in mm⁻¹ of a half-space",
                    0.0,
                    "above 0: light would never end",
                ),
            ];
            if let Some((_, what, value, allowed)) = bad.into_iter().find(|(wrong, ..)| *wrong) {
                return refuse(format!("layer {number}: {what} is {value}, allowed is {allowed}"));
            }
        }
        Ok(())
    }
}
