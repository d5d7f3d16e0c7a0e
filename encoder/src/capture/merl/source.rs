//! Isotropic BRDFs as BTFs of one texel.

use std::f32::consts::PI;
use std::path::Path;
use std::sync::LazyLock;

use glam::Vec3;

use super::{FILE_BYTES, Merl};
use crate::capture::isotropic::{Directions, IsotropicBrdf};

/// Angle from the normal of the lowest lights and views, in degrees.
const REACH_DEG: f32 = 85.0;

static DIRECTIONS: LazyLock<Directions> = LazyLock::new(|| Directions::up_to(REACH_DEG));

impl IsotropicBrdf for Merl {
    const KIND: &str = "isotropic BRDF of MERL";

    fn path(&self) -> &Path {
        self.path()
    }

    fn file_bytes(&self) -> u64 {
        FILE_BYTES as u64
    }

    fn directions(&self) -> &Directions {
        &DIRECTIONS
    }

    fn exitance(&self, light: Vec3, view: Vec3) -> [f32; 3] {
        self.eval(light, view).map(|value| PI * value * light.z)
    }

    fn warnings(&self) -> Vec<String> {
        let nothing = || {
            let path = self.path().display();
            format!("{path}: no sample was measured, all are below 0 or no numbers; it is black")
        };
        self.is_empty().then(nothing).into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{pairs, plastic};
    use super::*;
    use subsurf_decoder::NestedBtf;
    use subsurf_decoder::btf::Grid;

    use crate::btf::nested::{ChromaSizes, Options, Prepared, Sizes};
    use crate::btf::{Ranks, TruncatedSvd};
    use crate::capture::Images;

    #[test]
    fn brdfs_are_materials_of_one_texel() {
        let place = tempfile::tempdir().unwrap();
        let swapped = |light, view| {
            let [r, g, b] = plastic(light, view);
            [b, g, r]
        };
        let [red, blue] = ["red", "blue"].map(|name| place.path().join(name).with_extension("binary"));
        Merl::write(&red, plastic).unwrap();
        Merl::write(&blue, swapped).unwrap();
        let materials = [red, blue].map(|path| Images::load(&Merl::open(&path).unwrap(), &()).unwrap());
        assert_eq!(materials[0].bytes(), 34_992_012, "what was measured");
        let svd = TruncatedSvd::new(&materials, Ranks { luma: 2, chroma: 2 }, 1, &()).unwrap();
        let reach = REACH_DEG.to_radians();
        let grid = Grid {
            n_alpha: 33,
            n_beta: 33,
            n_theta: 18,
            n_phi: 1,
            alpha_max: reach,
            sin_beta_max: reach.sin(),
            theta_max: reach,
            cos_light_min: reach.cos(),
        };
        let options = Options {
            grid,
            chroma: ChromaSizes { i2: 16, i1: 64, colours: 64, tints: 1 },
            names: vec!["red".to_owned(), "blue".to_owned()],
            has_mipmaps: false,
            seed: 1,
        };
        let stages = [Sizes { p4: 2, p3: 2, p2: 36, p1: 1024 }];
        let bytes = Prepared::new(&materials, &svd, options).encode(&stages, &()).unwrap().to_bytes();
        let file = NestedBtf::parse(&bytes).unwrap();
        for (number, brdf) in [plastic as fn(Vec3, Vec3) -> [f32; 3], swapped].into_iter().enumerate() {
            let texel = file.texel(number, 0, [0, 0]).unwrap();
            let (mut error, mut sum) = ([0.0_f32; 3], [0.0_f32; 3]);
            for (light, view) in pairs(4_000) {
                let found = file.eval(texel, light.to_array(), view.to_array());
                let expected = brdf(light, view).map(|value| PI * value * light.z);
                for c in 0..3 {
                    error[c] += (found[c] - expected[c]).abs();
                    sum[c] += expected[c];
                }
            }
            for c in 0..3 {
                assert!(error[c] < 0.05 * sum[c], "material {number}: mean error {:.3} of the mean", error[c] / sum[c]);
            }
        }
    }
}
