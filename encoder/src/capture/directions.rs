//! Directions in which BTFs are measured, and what their images are called.

use glam::Vec3;

/// A direction above the sample, in whole degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Direction {
    /// From the normal, 0 to 90.
    pub theta_deg: u16,
    /// Around it, from the rows' direction towards the columns', 0 to 359.
    pub phi_deg: u16,
}

impl Direction {
    /// Unit vector: x along the rows, y down the columns, z away from the sample.
    #[must_use]
    pub fn unit(self) -> Vec3 {
        let (sin, cos) = f32::from(self.theta_deg).to_radians().sin_cos();
        let (sin_phi, cos_phi) = f32::from(self.phi_deg).to_radians().sin_cos();
        Vec3::new(sin * cos_phi, sin * sin_phi, cos)
    }
}

/// The 81 directions of light and view of the BTF database of Bonn (Sattler et al. 2003): rings 15° apart, from the normal to 75°.
#[must_use]
pub fn bonn() -> Vec<Direction> {
    const RINGS: [(u16, u16); 6] = [(0, 1), (15, 6), (30, 12), (45, 18), (60, 20), (75, 24)];
    let ring =
        |&(theta_deg, count): &(u16, u16)| (0..count).map(move |k| Direction { theta_deg, phi_deg: 360 * k / count });
    RINGS.iter().flat_map(ring).collect()
}

/// What the image of a pair of directions is called there, without an extension.
pub(crate) fn image_name(light: Direction, view: Direction) -> String {
    format!("tl{:03} pl{:03} tv{:03} pv{:03}", light.theta_deg, light.phi_deg, view.theta_deg, view.phi_deg)
}

/// Light and view that the name of an image tells: numbers behind `tl`, `pl`, `tv` and `pv`, whatever stands between.
pub(crate) fn directions_of(name: &str) -> Option<[Direction; 2]> {
    let number = |tag: &str| {
        let (_, rest) = name.split_once(tag)?;
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        rest[..digits].parse::<u16>().ok()
    };
    let direction = |theta: &str, phi: &str| {
        let direction = Direction { theta_deg: number(theta)?, phi_deg: number(phi)? };
        (direction.theta_deg <= 90 && direction.phi_deg < 360).then_some(direction)
    };
    Some([direction("tl", "pl")?, direction("tv", "pv")?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_the_database() {
        let all = bonn();
        assert_eq!(all.len(), 81);
        assert_eq!(all[0].unit(), Vec3::Z);
        assert_eq!(all[7 + 5], Direction { theta_deg: 30, phi_deg: 150 });
        assert_eq!(all[80], Direction { theta_deg: 75, phi_deg: 345 });
        assert_eq!(image_name(all[0], all[12]), "tl000 pl000 tv030 pv150");
        assert!(all.iter().all(|direction| (direction.unit().length() - 1.0).abs() < 1e-6));
    }

    #[test]
    fn names_tell_directions() {
        let [light, view] = [Direction { theta_deg: 60, phi_deg: 345 }, Direction { theta_deg: 15, phi_deg: 0 }];
        for name in
            [image_name(light, view), "00815 tl060 pl345 tv015 pv000".to_owned(), "tl60_pl345_tv15_pv0.exr".to_owned()]
        {
            assert_eq!(directions_of(&name), Some([light, view]), "{name}");
        }
        for name in ["tl000 pl000 tv000", "tl095 pl000 tv000 pv000", "tl000 pl360 tv000 pv000", "tl pl tv pv", "readme"]
        {
            assert_eq!(directions_of(name), None, "{name}");
        }
    }
}
