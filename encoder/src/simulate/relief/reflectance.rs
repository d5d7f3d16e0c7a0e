//! Reflectance of smooth pieces of materials.

use glam::Vec3;

/// Reflectance of a texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finish {
    /// Albedo of what is reflected to all sides alike.
    pub(super) diffuse: Vec3,
    /// Fresnel reflectance at normal incidence of the microfacets.
    pub(super) specular: Vec3,
    /// GGX roughness along the fibre and across it.
    pub(super) roughness: [f32; 2],
    /// Unit vector along the fibre.
    pub(super) fibre: Vec3,
    /// Colour of the lobe of fibres below a clear coat.
    pub(super) fibre_colour: Vec3,
    /// Width of that lobe in radians.
    pub(super) fibre_width_rad: f32,
}

/// Unit vectors at a texel.
pub(super) struct Shading {
    pub(super) normal: Vec3,
    pub(super) light: Vec3,
    pub(super) eye: Vec3,
}

/// Refractive index of what covers fibres.
const ETA: f32 = 1.5;

impl Finish {
    /// Diffuse finish of some albedo.
    pub(super) fn matte(diffuse: Vec3) -> Self {
        Self {
            diffuse,
            specular: Vec3::ZERO,
            roughness: [0.5; 2],
            fibre: Vec3::X,
            fibre_colour: Vec3::ZERO,
            fibre_width_rad: 1.0,
        }
    }

    /// BRDF f_r in sr⁻¹, linear Rec. 709.
    pub(super) fn reflect(&self, shading: &Shading) -> Vec3 {
        let (cos_light, cos_eye) = (shading.normal.dot(shading.light), shading.normal.dot(shading.eye));
        if cos_light <= 0.0 || cos_eye <= 0.0 {
            return Vec3::ZERO;
        }
        self.diffuse / std::f32::consts::PI + self.microfacets(shading) + self.fibres(shading)
    }

    /// Anisotropic GGX with height-correlated masking (Heitz 2014) and Schlick's Fresnel term.
    fn microfacets(&self, shading: &Shading) -> Vec3 {
        if self.specular == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let n = shading.normal;
        let t = (self.fibre - n * n.dot(self.fibre)).normalize_or(n.any_orthonormal_vector());
        let b = n.cross(t);
        let [along, across] = self.roughness.map(|roughness| roughness * roughness);
        let local = |v: Vec3| Vec3::new(v.dot(t), v.dot(b), v.dot(n));
        let (l, v) = (local(shading.light), local(shading.eye));
        let h = (l + v).normalize_or(Vec3::Z);
        let stretched = (h.x / along).powi(2) + (h.y / across).powi(2) + h.z * h.z;
        let d = 1.0 / (std::f32::consts::PI * along * across * stretched * stretched);
        let length = |w: Vec3| ((along * w.x).powi(2) + (across * w.y).powi(2) + w.z * w.z).sqrt();
        let g_over_4 = 0.5 / (l.z * length(v) + v.z * length(l)).max(1e-6);
        let away = (1.0 - l.dot(h).clamp(0.0, 1.0)).powi(5);
        (self.specular + (Vec3::ONE - self.specular) * away) * (d * g_over_4)
    }

    /// Fibres under a clear coat: a cone around their direction (Marschner et al. 2005, *Measuring and modeling the appearance of
    /// finished wood*, eq. 5).
    fn fibres(&self, shading: &Shading) -> Vec3 {
        if self.fibre_colour == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let n = shading.normal;
        // Into the coat.
        let refracted = |w: Vec3| {
            let across = (w - n * n.dot(w)) / ETA;
            across + n * (1.0 - across.length_squared()).max(0.0).sqrt()
        };
        let (l, v) = (refracted(shading.light), refracted(shading.eye));
        let angle = |w: Vec3| self.fibre.dot(w).clamp(-1.0, 1.0).asin();
        let (psi_l, psi_v) = (angle(l), angle(v));
        let (psi_h, psi_d) = (psi_l + psi_v, psi_l - psi_v);
        let gaussian = (-0.5 * (psi_h / self.fibre_width_rad).powi(2)).exp()
            / (self.fibre_width_rad * (2.0 * std::f32::consts::PI).sqrt());
        let transmitted = |w: Vec3| 1.0 - (0.04 + 0.96 * (1.0 - n.dot(w).clamp(0.0, 1.0)).powi(5));
        let through = transmitted(shading.light) * transmitted(shading.eye) / (ETA * ETA);
        self.fibre_colour * (gaussian * through / (0.5 * psi_d).cos().powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No finish gives back more light than it gets, and all are the same when light and eye change places.
    #[test]
    fn finishes_are_reciprocal_and_lose_light() {
        let finishes = [
            Finish::matte(Vec3::splat(0.8)),
            Finish { specular: Vec3::new(1.0, 0.8, 0.4), roughness: [0.3, 0.7], ..Finish::matte(Vec3::ZERO) },
            Finish { fibre_colour: Vec3::splat(0.15), fibre_width_rad: 0.3, ..Finish::matte(Vec3::splat(0.2)) },
        ];
        let direction = |u: f32, v: f32| {
            let phi = std::f32::consts::TAU * v;
            Vec3::new(u.sqrt() * phi.cos(), u.sqrt() * phi.sin(), (1.0 - u).sqrt())
        };
        for finish in finishes {
            for eye in [direction(0.0, 0.0), direction(0.5, 0.2), direction(0.9, 0.7)] {
                let mut albedo = 0.0;
                const N: u16 = 64;
                for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
                    let light = direction((f32::from(i) + 0.5) / f32::from(N), (f32::from(j) + 0.5) / f32::from(N));
                    let value = finish.reflect(&Shading { normal: Vec3::Z, light, eye });
                    let back = finish.reflect(&Shading { normal: Vec3::Z, light: eye, eye: light });
                    assert!((value - back).abs().max_element() <= 1e-4 * value.max_element().max(1.0), "{finish:?}");
                    // Cosine-distributed: π f_r on average.
                    albedo += value.max_element() * std::f32::consts::PI / (f32::from(N) * f32::from(N));
                }
                assert!(albedo > 0.05 && albedo <= 1.02, "{finish:?}: {albedo}");
            }
        }
    }
}
