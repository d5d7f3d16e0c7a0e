//! What lies beyond the border of the patch.

/// How a pixel coordinate outside the patch is mapped into it (`FORMAT.md`, section 2.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Addressing {
    /// The border pixel goes on for ever.
    #[default]
    Clamp,
    /// The patch repeats: for tileable materials.
    Repeat,
    /// The patch repeats, every other copy reflected.
    Mirror,
}

impl Addressing {
    /// The code in the file.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Clamp => 0,
            Self::Repeat => 1,
            Self::Mirror => 2,
        }
    }

    /// The mode of a code.
    #[must_use]
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Clamp),
            1 => Some(Self::Repeat),
            2 => Some(Self::Mirror),
            _ => None,
        }
    }

    /// Maps coordinate `x` to `0 .. n`; 0 where `n` is 0.
    #[must_use]
    pub fn map(self, x: i32, n: u32) -> u32 {
        let (x, n) = (i64::from(x), i64::from(n));
        let inside = match self {
            Self::Clamp => x.min(n.saturating_sub(1)).max(0),
            Self::Repeat => x.checked_rem_euclid(n).unwrap_or(0),
            Self::Mirror => {
                let m = x.checked_rem_euclid(n.saturating_mul(2)).unwrap_or(0);
                m.min(n.saturating_mul(2).saturating_sub(1).saturating_sub(m)).max(0)
            }
        };
        u32::try_from(inside).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::Addressing;

    #[test]
    fn maps_as_the_format_says() {
        let row = |mode: Addressing| [-5, -2, -1, 0, 2, 3, 4, 7].map(|x| mode.map(x, 3));
        assert_eq!(row(Addressing::Clamp), [0, 0, 0, 0, 2, 2, 2, 2]);
        assert_eq!(row(Addressing::Repeat), [1, 1, 2, 0, 2, 0, 1, 1]);
        assert_eq!(row(Addressing::Mirror), [1, 1, 0, 0, 2, 2, 1, 1]);
        for mode in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
            for x in [i32::MIN, i32::MAX] {
                assert!(mode.map(x, u32::MAX) < u32::MAX, "{mode:?} at {x}");
                assert_eq!(mode.map(x, 1), 0, "{mode:?} of one pixel");
                assert_eq!(mode.map(x, 0), 0, "{mode:?} of no pixel");
            }
        }
    }
}
