//! Files of the RGL database, made here: against values by integrals, not by tables.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use subsurf_encoder::capture::{Rgl, check_images};

/// A density (a + b x) (c + d y) on the unit square.
type Density = [f64; 4];

/// A file of two slices, all of whose functions are linear between its nodes.
pub(super) struct Bsdf {
    pub(super) theta_i: [f32; 2],
    pub(super) densities: [Density; 2],
    pub(super) jacobian: u8,
}

pub(super) const BSDF: Bsdf =
    Bsdf { theta_i: [0.2, 1.4], densities: [[1.0, 2.0, 3.0, -1.0], [2.0, -1.5, 0.5, 2.0]], jacobian: 1 };

/// Nodes of the density in x and y, and of what was measured.
const OF_DENSITY: [usize; 2] = [9, 5];
const OF_RGB: [usize; 2] = [4, 3];

/// Channels at places of the unit square: bilinear.
fn rgb(slice: usize, channel: usize, [x, y]: [f64; 2]) -> f64 {
    let k = (1 + slice + 2 * channel) as f64;
    0.3 * k + 0.2 * x - 0.1 * k * y + 0.25 * x * y
}

/// Microfacets, and their projected area, at u.
fn microfacets(u: f64) -> f64 {
    2.0 - 1.5 * u
}

fn area(u: f64) -> f64 {
    1.0 - 0.6 * u
}

/// An array: name, type, shape and bytes.
type Array = (&'static str, u8, Vec<usize>, Vec<u8>);

fn floats(name: &'static str, shape: &[usize], values: impl Iterator<Item = f64>) -> Array {
    #[allow(clippy::cast_possible_truncation, reason = "files have floats")]
    let bytes = values.flat_map(|value| (value as f32).to_le_bytes()).collect();
    (name, 10, shape.to_vec(), bytes)
}

/// Places of nodes, row by row.
fn nodes([columns, rows]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> + Clone {
    let at = |k: usize, count: usize| k as f64 / (count - 1) as f64;
    (0..rows).flat_map(move |y| (0..columns).map(move |x| [at(x, columns), at(y, rows)]))
}

/// The container around arrays.
fn container(arrays: &[Array]) -> Vec<u8> {
    let short = |count: usize| u16::try_from(count).expect("few").to_le_bytes();
    let header: usize = arrays.iter().map(|(name, _, shape, _)| 2 + name.len() + 2 + 1 + 8 + 8 * shape.len()).sum();
    let mut offset = 18 + header;
    let mut file = b"tensor_file\0\x01\x00".to_vec();
    file.extend(u32::try_from(arrays.len()).expect("few").to_le_bytes());
    for (name, kind, shape, bytes) in arrays {
        file.extend(short(name.len()));
        file.extend(name.as_bytes());
        file.extend(short(shape.len()));
        file.push(*kind);
        file.extend((offset as u64).to_le_bytes());
        shape.iter().for_each(|count| file.extend((*count as u64).to_le_bytes()));
        offset += bytes.len();
    }
    arrays.iter().for_each(|(.., bytes)| file.extend(bytes));
    file
}

impl Bsdf {
    fn arrays(&self) -> Vec<Array> {
        let table = |name, of: fn(f64) -> f64| floats(name, &[2, 7], (0..14).map(move |k| of((k % 7) as f64 / 6.0)));
        let density = self
            .densities
            .iter()
            .flat_map(|[a, b, c, d]| nodes(OF_DENSITY).map(move |[x, y]| (a + b * x) * (c + d * y)));
        let slices = (0..2).flat_map(|slice| (0..3).map(move |channel| (slice, channel)));
        let measured = slices.flat_map(|(slice, channel)| nodes(OF_RGB).map(move |place| rgb(slice, channel, place)));
        vec![
            ("description", 1, vec![4], b"made".to_vec()),
            floats("phi_i", &[1], [0.0].into_iter()),
            floats("theta_i", &[2], self.theta_i.iter().map(|theta| f64::from(*theta))),
            table("ndf", microfacets),
            table("sigma", area),
            floats("vndf", &[1, 2, OF_DENSITY[1], OF_DENSITY[0]], density),
            floats("rgb", &[1, 2, 3, OF_RGB[1], OF_RGB[0]], measured),
            ("jacobian", 1, vec![1], vec![self.jacobian]),
        ]
    }

    pub(super) fn file(&self) -> Vec<u8> {
        container(&self.arrays())
    }

    /// The file with everything that was measured below zero.
    pub(super) fn negative(&self) -> Vec<u8> {
        let mut arrays = self.arrays();
        let (.., measured) = arrays.iter_mut().find(|array| array.0 == "rgb").expect("there is one");
        measured.as_chunks_mut::<4>().0.iter_mut().for_each(|value| value[3] ^= 0x80);
        container(&arrays)
    }

    /// f_r by the model's definition: places in the square by integrals of the mixed density.
    fn expected(&self, light: DVec3, view: DVec3) -> [f64; 3] {
        let half = (light + view).normalize();
        let theta = |w: DVec3| w.z.acos();
        let u = |w: DVec3| (2.0 * theta(w) / PI).sqrt();
        let phi = |w: DVec3| w.y.atan2(w.x);
        let turns = (phi(half) - phi(light)) / (2.0 * PI) + 0.5;
        let (x, y) = (u(half), turns.rem_euclid(1.0));
        let [low, high] = self.theta_i.map(f64::from);
        let share = ((theta(light) - low) / (high - low)).clamp(0.0, 1.0);
        // Σ w p(x) q(y) / Z over both, with Z the mass of each.
        let mut sums = [0.0; 4];
        for ([a, b, c, d], weight) in self.densities.iter().zip([1.0 - share, share]) {
            let (p, q) = (|x: f64| a * x + 0.5 * b * x * x, |y: f64| c * y + 0.5 * d * y * y);
            let weight = weight / (p(1.0) * q(1.0));
            let row = c + d * y;
            let of = [p(x) * row, p(1.0) * row, p(1.0) * q(y), p(1.0) * q(1.0)];
            sums.iter_mut().zip(of).for_each(|(sum, value)| *sum += weight * value);
        }
        let place = [sums[0] / sums[1], sums[2] / sums[3]];
        let jacobian = if self.jacobian == 0 { 1.0 } else { microfacets(u(half)) / (4.0 * area(u(light))) };
        [0, 1, 2].map(|c| {
            let measured = (1.0 - share) * rgb(0, c, place) + share * rgb(1, c, place);
            measured.max(0.0) * jacobian / view.z
        })
    }
}

fn direction(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let ((sin, cos), (sin_phi, cos_phi)) = (theta_deg.to_radians().sin_cos(), phi_deg.to_radians().sin_cos());
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}

#[test]
fn brdfs_are_what_integrals_say() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("made.bsdf");
    for jacobian in [0, 1] {
        let bsdf = Bsdf { jacobian, ..BSDF };
        std::fs::write(&path, bsdf.file()).unwrap();
        let rgl = Rgl::open(&path).unwrap();
        for k in 0..400_u32 {
            let angle = |n: u32, most: f64| f64::from(k * (2 * n + 1) * 37 % 397) / 397.0 * most;
            let (light, view) =
                (direction(2.0 + angle(0, 86.0), angle(1, 360.0)), direction(angle(2, 86.0), angle(3, 360.0)));
            let (found, expected) = (rgl.eval(light.as_vec3(), view.as_vec3()), bsdf.expected(light, view));
            for c in 0..3 {
                let error = (f64::from(found[c]) / expected[c] - 1.0).abs();
                assert!(error < 1e-4, "{light} {view}: {} for {}", found[c], expected[c]);
            }
        }
        assert_eq!(rgl.eval(Vec3::NEG_Z, Vec3::Z), [0.0; 3]);
        assert_eq!(rgl.eval(Vec3::Z, Vec3::X), [0.0; 3]);
        check_images(&rgl, &()).unwrap();
    }
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("wrong.bsdf");
    let changed = |name: &str, change: &dyn Fn(&mut Array)| {
        let mut arrays = BSDF.arrays();
        let array = arrays.iter_mut().find(|array| array.0 == name).expect("there is one");
        change(array);
        container(&arrays)
    };
    let nan = |(.., bytes): &mut Array| bytes[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut cut = BSDF.file();
    cut.truncate(cut.len() - 5);
    let mut version = BSDF.file();
    version[12] = 2;
    for (file, expected) in [
        (b"PNG".to_vec(), "no signature"),
        (version, "version 2.0; expected 1.0"),
        (cut, "arrays that lie in the file"),
        (BSDF.file()[..40].to_vec(), "the file is cut"),
        (changed("rgb", &nan), "NaN as value 0 of \"rgb\""),
        (changed("rgb", &|array| array.0 = "spectra"), "a spectral BRDF"),
        (changed("rgb", &|array| array.0 = "colour"), "no array \"rgb\""),
        (changed("rgb", &|array| array.2 = vec![1, 2, 36]), "expected \"rgb\" in f32 with 5 dimensions"),
        (changed("rgb", &|array| array.2 = vec![1, 2, 1, 9, 4]), "3 channels"),
        (changed("vndf", &|array| array.2 = vec![1, 2, 45, 1]), "at least 2 × 2 nodes"),
        (changed("vndf", &|array| array.2 = vec![1, 1, 90, 1]), "1 × 2 slices"),
        (changed("vndf", &|array| array.2 = vec![usize::MAX, 2, 45, 1]), "arrays that lie in the file"),
        (changed("vndf", &|array| array.1 = 11), "arrays that lie in the file"),
        (changed("vndf", &|array| array.1 = 12), "expected type 1 to 11"),
        (changed("vndf", &|(.., bytes)| bytes[..4].copy_from_slice(&(-1.0_f32).to_le_bytes())), "a density below 0"),
        (changed("theta_i", &|(.., bytes)| bytes.reverse()), "two or more that grow"),
        (changed("ndf", &|(.., bytes)| bytes[..4].copy_from_slice(&9.0_f32.to_le_bytes())), "varies with azimuth"),
        (changed("ndf", &|(.., bytes)| bytes.fill(0)), "values up to 0"),
        (changed("phi_i", &|(_, _, shape, bytes)| (*shape, *bytes) = (vec![8], vec![0; 32])), "8 azimuths"),
        (changed("jacobian", &|array| array.2 = vec![0]), "expected one value"),
    ] {
        std::fs::write(&path, file).unwrap();
        let message = Rgl::open(&path).unwrap_err().to_string();
        assert!(message.contains(expected) && message.lines().count() == 1, "{message}\nshould say: {expected}");
    }
}
