//! Lights under which patches are compared (Yatagawa et al. 2020, section 4).

/// Irradiance patterns on a patch of W pixels width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// Irradiance 1 everywhere.
    Uniform,
    /// Irradiance 1 in a disc of radius W/6 around the centre.
    Disc,
    /// Irradiance 1 on a vertical line, 4 pixels wide, through the centre.
    Line,
}

impl Light {
    /// All lights, in the order of reports.
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Disc, Self::Line];

    /// Name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Disc => "disc",
            Self::Line => "line",
        }
    }

    /// Irradiance at the centre of pixel (x, y) of a patch of `size`.
    #[must_use]
    pub fn irradiance(self, [x, y]: [usize; 2], size: [usize; 2]) -> f32 {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let from_centre = |k: usize, n: usize| k as f32 + 0.5 - n as f32 / 2.0;
        let (dx, dy) = (from_centre(x, size[0]), from_centre(y, size[1]));
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let lit = match self {
            Self::Uniform => true,
            Self::Disc => dx.hypot(dy) <= size[0] as f32 / 6.0,
            Self::Line => dx.abs() <= 2.0,
        };
        f32::from(u8::from(lit))
    }
}
