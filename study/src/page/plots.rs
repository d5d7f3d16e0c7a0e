//! Charts of curves and points, as SVG.

use plotters::prelude::*;

/// Points of one kind, x and y, joined if `joined`.
pub(crate) struct Series {
    pub(crate) title: String,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) joined: bool,
}

/// An axis from `range.start` to `range.end`.
pub(crate) struct Axis {
    pub(crate) title: &'static str,
    pub(crate) range: std::ops::Range<f64>,
    pub(crate) scale: Scale,
}

/// Scale of an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    /// Equal factors are equally far apart.
    Logarithmic,
    /// Labels stand at whole numbers only.
    Whole,
}

impl Axis {
    /// Place of a value along the axis.
    fn place(&self, value: f64) -> f64 {
        if self.scale == Scale::Logarithmic { value.log10() } else { value }
    }

    fn places(&self) -> std::ops::Range<f64> {
        self.place(self.range.start)..self.place(self.range.end)
    }

    /// What stands beside a place: the value to two digits, or whole.
    fn label(&self, place: f64) -> String {
        if self.scale == Scale::Whole && place.fract() != 0.0 {
            return String::new();
        }
        let value = if self.scale == Scale::Logarithmic { 10_f64.powf(place) } else { place };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few digits")]
        let digits = (1.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

/// Range of positive values, a little wider.
pub(crate) fn widened(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values
        .filter(|value| *value > 0.0 && value.is_finite())
        .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if low > high { 1.0..10.0 } else { low / 1.5..high * 1.5 }
}

const COLOURS: [RGBColor; 8] = [
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0xd6, 0x27, 0x28),
    RGBColor(0x2c, 0xa0, 0x2c),
    RGBColor(0xff, 0x7f, 0x0e),
    RGBColor(0x94, 0x67, 0xbd),
    RGBColor(0x8c, 0x56, 0x4b),
    RGBColor(0xe3, 0x77, 0xc2),
    RGBColor(0x55, 0x55, 0x55),
];
/// Points of a joined series that are still marked, at most.
const MARKED: usize = 24;
const SIZE: (u32, u32) = (560, 400);

/// A chart with a legend in one of its corners.
pub(crate) fn chart(
    title: &str,
    x: &Axis,
    y: &Axis,
    series: &[Series],
    legend: &SeriesLabelPosition,
) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let mut builder = ChartBuilder::on(&area);
        builder.caption(title, ("sans-serif", 16)).margin(10).x_label_area_size(40).y_label_area_size(56);
        let mut chart = builder.build_cartesian_2d(x.places(), y.places())?;
        chart
            .configure_mesh()
            .x_desc(x.title)
            .y_desc(y.title)
            .x_label_formatter(&|place| x.label(*place))
            .y_label_formatter(&|place| y.label(*place))
            .max_light_lines(1)
            .light_line_style(WHITE)
            .draw()?;
        for (number, series) in series.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            let points = series.points.iter().map(|point| (x.place(point.0), y.place(point.1)));
            if series.joined {
                chart.draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?;
            }
            // Points of a curve are too many to be marked.
            let marked = if series.joined && series.points.len() > MARKED { 0 } else { usize::MAX };
            chart
                .draw_series(points.take(marked).map(|point| Circle::new(point, 4, colour.filled())))?
                .label(&series.title)
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        }
        chart
            .configure_series_labels()
            .position(legend.clone())
            .background_style(WHITE.mix(0.8))
            .border_style(RGBColor(200, 200, 200))
            .draw()?;
        area.present()?;
    }
    // Inside a page, SVG needs no name of its own.
    Ok(svg.replace(" xmlns=\"http://www.w3.org/2000/svg\"", ""))
}
