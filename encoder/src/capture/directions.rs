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

/// Light and view that a name tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Named {
    pub(crate) directions: [Direction; 2],
    /// Whether an azimuth is not from 0 to 359, and was brought there: 360 is 0, and −90 is 270.
    pub(crate) is_wrapped: bool,
}

/// Light and view that names tell: numbers behind `tl`, `pl`, `tv` and `pv`, whatever stands between. Each is looked for in
/// the first name, then in the next: that of an image, and those of the folders that it is in.
///
/// `None` if one of them is nowhere; an error says why the numbers are no directions above the sample.
pub(crate) fn directions_of(names: &[&str]) -> Option<Result<Named, &'static str>> {
    let number = |tag: &str| names.iter().find_map(|name| number_behind(tag, name));
    let numbers = [number("tl")?, number("pl")?, number("tv")?, number("pv")?];
    Some(named(numbers))
}

fn named(numbers: [Option<i32>; 4]) -> Result<Named, &'static str> {
    let [Some(theta_l), Some(phi_l), Some(theta_v), Some(phi_v)] = numbers else {
        return Err("their angles are not whole degrees");
    };
    let direction = |theta: i32, phi: i32| {
        let theta_deg = u16::try_from(theta).ok().filter(|theta| *theta <= 90)?;
        Some(Direction { theta_deg, phi_deg: u16::try_from(phi.rem_euclid(360)).ok()? })
    };
    let (light, view) = direction(theta_l, phi_l).zip(direction(theta_v, phi_v)).ok_or("θ is not from 0° to 90°")?;
    let is_wrapped = [phi_l, phi_v].iter().any(|phi| !(0..360).contains(phi));
    Ok(Named { directions: [light, view], is_wrapped })
}

/// The number behind a tag, which may have a sign; a `None` inside if it is not a whole one.
fn number_behind(tag: &str, name: &str) -> Option<Option<i32>> {
    let of = |(at, _): (usize, &str)| {
        let rest = &name[at + tag.len()..];
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let sign = usize::from(rest.starts_with('-'));
        let end = sign + digits(&rest[sign..]);
        if end == sign {
            return None;
        }
        // Nothing but zeros behind a point.
        let part = rest[end..].strip_prefix('.').map_or("", |part| &part[..digits(part)]);
        let is_whole = part.bytes().all(|digit| digit == b'0');
        Some(rest[..end].parse().ok().filter(|_| is_whole))
    };
    name.match_indices(tag).find_map(of)
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
        let told = |is_wrapped| Some(Ok(Named { directions: [light, view], is_wrapped }));
        for names in [
            &[&*image_name(light, view)][..],
            &["00815 tl060 pl345 tv015 pv000"],
            &["tl60_pl345_tv15_pv0.exr"],
            &["tl60.0_pl345_tv15.00_pv0"],
            &["00000 tl060 pl345", "tv015_pv000"],
            // The image's own name counts.
            &["tl060 pl345 tv015 pv000", "tv030_pv090"],
            &["bottle tl060 pl345 tv015 pv000 title"],
        ] {
            assert_eq!(directions_of(names), told(false), "{names:?}");
        }
        for name in ["tl060 pl345 tv015 pv360", "tl060 pl-15 tv015 pv000", "tl60 pl705 tv15 pv-720"] {
            assert_eq!(directions_of(&[name]), told(true), "{name}");
        }
        for name in ["tl000 pl000 tv000", "tl pl tv pv", "readme", "tl- pl000 tv000 pv000"] {
            assert_eq!(directions_of(&[name]), None, "{name}");
        }
        for (name, reason) in [
            ("tl095 pl000 tv000 pv000", "θ is not"),
            ("tl000 pl000 tv-15 pv000", "θ is not"),
            ("tl000 pl000 tv000 pv12.5", "whole degrees"),
            ("tl000 pl99999999999 tv000 pv000", "whole degrees"),
        ] {
            let found = directions_of(&[name]).and_then(Result::err).unwrap_or_default();
            assert!(found.contains(reason), "{name}: {found}");
        }
    }
}
