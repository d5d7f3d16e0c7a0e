//! Sampling and albedo of BTF files, as statistics. All random numbers are fixed.

use std::f64::consts::{FRAC_PI_2, PI};

use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{ColourEncoding, Grid, Texel};
use subsurf_encoder::btf::nested::{Database, slice_mean};
use subsurf_encoder::synthetic::{NestedShape, unit};
use subsurf_tests::nested::{angles, channels, direction, single};

/// Views from all sides, straight from above too.
const VIEWS_DEG: [[f64; 2]; 4] = [[0.0, 0.0], [33.0, 20.0], [60.0, 190.0], [88.0, 300.0]];

/// Files with and without room beyond the outermost nodes.
fn databases() -> Vec<Database> {
    let narrow = Grid {
        n_alpha: 8,
        n_beta: 5,
        alpha_max: 1.3,
        sin_beta_max: 0.9,
        theta_max: 1.2,
        cos_light_min: 0.2,
        ..NestedShape::small().grid
    };
    let bright = ColourEncoding::LogLuv { toe: 0.01, peak: 9.0 };
    let shapes = [
        NestedShape::small(),
        NestedShape { grid: narrow, tone: bright, scale_bits: 10, ..NestedShape::small() },
        NestedShape { materials: vec![(4, 4, 1)], ..NestedShape::typical() },
    ];
    (7..).zip(shapes).map(|(seed, shape)| shape.database(seed)).collect()
}

/// Runs a check for texels and views of all files.
fn for_all(check: impl Fn(&Database, &NestedBtf<'_>, usize, Texel, [f64; 3])) {
    for database in databases() {
        let file = database.to_bytes();
        let btf = NestedBtf::parse(&file).unwrap();
        for (number, x) in [(0, 0), (2, 2)] {
            let texel = btf.texel(0, 0, [x, 0]).unwrap();
            for [theta, phi] in VIEWS_DEG {
                check(&database, &btf, number, texel, angles(theta, phi));
            }
        }
    }
}

/// Cosine and sine of the azimuth of a view.
fn azimuth(view: [f64; 3]) -> [f64; 2] {
    let length = view[0].hypot(view[1]);
    if length > 1e-6 { [view[0] / length, view[1] / length] } else { [1.0, 0.0] }
}

/// The light at α and sin β.
fn light(alpha: f64, sin_beta: f64, view: [f64; 3]) -> [f64; 3] {
    let [cos, sin] = azimuth(view);
    let cos_beta = (1.0 - sin_beta * sin_beta).max(0.0).sqrt();
    let forward = cos_beta * alpha.sin();
    [forward * cos - sin_beta * sin, forward * sin + sin_beta * cos, cos_beta * alpha.cos()]
}

/// α and sin β of a light.
fn place(light: [f32; 3], view: [f64; 3]) -> [f64; 2] {
    let ([x, y, z], [cos, sin]) = (light.map(f64::from), azimuth(view));
    [(x * cos + y * sin).atan2(z), y * cos - x * sin]
}

/// Middles of `count` equal parts of −half to half.
fn middles(count: u32, half: f64) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |k| half * (2.0 * (f64::from(k) + 0.5) / f64::from(count) - 1.0))
}

#[test]
fn densities_integrate_to_one() {
    for_all(|_, btf, _, texel, view| {
        let sampler = btf.sampler(texel, &btf.grid().view(single(view)));
        const SIDE: u32 = 240;
        let sum: f64 = middles(SIDE, FRAC_PI_2)
            .flat_map(|alpha| middles(SIDE, 1.0).map(move |sin_beta| (alpha, sin_beta)))
            .map(|(alpha, sin_beta)| f64::from(sampler.pdf(single(light(alpha, sin_beta, view)))))
            .sum();
        let integral = sum * 2.0 * PI / f64::from(SIDE * SIDE);
        assert!((integral - 1.0).abs() < 1e-3, "{integral} for the view {view:?}");
        assert_eq!(sampler.pdf([0.6, 0.0, -0.8]).to_bits(), 0, "below the horizon");
    });
}

#[test]
fn lights_are_distributed_as_the_density_says() {
    const DRAWS: u32 = 40_000;
    const BINS: u32 = 12;
    for_all(|_, btf, _, texel, view| {
        let sampler = btf.sampler(texel, &btf.grid().view(single(view)));
        let side = BINS as usize;
        let mut found = vec![0.0; side * side];
        for n in 0..DRAWS {
            let sample = sampler.sample([unit(2 * n), unit(2 * n + 1)]);
            let [alpha, sin_beta] = place(sample.light, view);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 12")]
            let bin = |t: f64| ((t * f64::from(BINS)) as usize).min(side - 1);
            found[bin(alpha / PI + 0.5) * side + bin(sin_beta / 2.0 + 0.5)] += 1.0;
        }
        // Densities are nearly linear inside a bin: 6 × 6 points of it.
        let fine = |half: f64| middles(6, half / f64::from(BINS));
        let expected =
            middles(BINS, FRAC_PI_2).flat_map(|alpha| middles(BINS, 1.0).map(move |sin_beta| (alpha, sin_beta)));
        let expected = expected.map(|(alpha, sin_beta)| {
            let points = fine(FRAC_PI_2).flat_map(|da| fine(1.0).map(move |ds| (alpha + da, sin_beta + ds)));
            let mean = points.map(|(a, s)| f64::from(sampler.pdf(single(light(a, s, view))))).sum::<f64>() / 36.0;
            f64::from(DRAWS) * mean * 2.0 * PI / f64::from(BINS * BINS)
        });
        // Bins that few lights fall into are one.
        let (mut chi2, mut bins, mut rest) = (0.0, -1.0, [0.0; 2]);
        for (found, expected) in found.into_iter().zip(expected) {
            if expected < 10.0 {
                rest = [rest[0] + found, rest[1] + expected];
            } else {
                chi2 += (found - expected) * (found - expected) / expected;
                bins += 1.0;
            }
        }
        if rest[1] > 0.0 {
            chi2 += (rest[0] - rest[1]) * (rest[0] - rest[1]) / rest[1].max(1.0);
            bins += 1.0;
        }
        // χ² has a mean of `bins` and a deviation of √(2 bins): five of these.
        let limit = bins + 5.0 * f64::sqrt(2.0 * bins);
        assert!(chi2 < limit && bins > 40.0, "χ² = {chi2} of {bins} for the view {view:?}");
    });
}

#[test]
fn draws_know_their_density() {
    for_all(|_, btf, _, texel, view| {
        for n in 0..500 {
            let random = [unit(3 * n), unit(3 * n + 1)];
            let sample = btf.sample(texel, single(view), random);
            let [x, y, z] = sample.light.map(f64::from);
            assert!((x * x + y * y + z * z - 1.0).abs() < 1e-5 && z >= 0.0, "a unit vector: {sample:?}");
            let found = btf.pdf(texel, sample.light, single(view));
            // Near the poles, where all α meet, rounding a light moves it to another slice.
            let [_, sin_beta] = place(sample.light, view);
            let limit = if sin_beta.abs() < 0.999 { 2e-3 } else { 0.1 };
            assert!((found / sample.pdf - 1.0).abs() < limit, "{found} {sample:?} for {random:?}");
        }
    });
}

#[test]
fn lights_move_on_without_jumps() {
    const STEPS: u32 = 1 << 12;
    for_all(|_, btf, _, texel, view| {
        let sampler = btf.sampler(texel, &btf.grid().view(single(view)));
        for (axis, other) in [0, 1].into_iter().flat_map(|axis| [0.0, 0.13, 0.5, 0.9].map(|other| (axis, other))) {
            let at = |t: f32| place(sampler.sample(if axis == 0 { [t, other] } else { [other, t] }).light, view);
            let step = |from: f32, to: f32| {
                let (from, to) = (at(from), at(to));
                assert!(to[axis] - from[axis] > -1e-4, "goes back on axis {axis} from {from:?} to {to:?}");
                // Near the poles, where all α meet, α is rounding.
                let is_pole = from[1].abs().max(to[1].abs()) > 0.999;
                (to[1] - from[1]).abs().max(if is_pole { 0.0 } else { (to[0] - from[0]).abs() })
            };
            #[allow(clippy::cast_precision_loss, reason = "at most 2^12")]
            let parts = (0..STEPS).map(|k| [k, k + 1].map(|k| k as f32 / STEPS as f32));
            let longest = parts.max_by(|a, b| step(a[0], a[1]).total_cmp(&step(b[0], b[1])));
            // Where it is steepest, halves have shorter steps, but a jump stays as large as it is.
            let [mut from, mut to] = longest.unwrap();
            let whole = step(from, to);
            for _ in 0..9 {
                let middle = 0.5 * (from + to);
                [from, to] = if step(from, middle) > step(middle, to) { [from, middle] } else { [middle, to] };
            }
            let part = step(from, to);
            assert!(part < whole / 16.0 + 2e-3, "on axis {axis}, {whole} does not become less than {part}");
        }
        let ends =
            [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0]].map(|random| place(sampler.sample(random).light, view));
        let found = [ends[0][0], ends[1][0], ends[2][1], ends[3][1]];
        for (found, expected) in found.into_iter().zip([-FRAC_PI_2, FRAC_PI_2, -1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-3, "not all of the hemisphere: {ends:?}");
        }
    });
}

#[test]
fn densities_follow_luma() {
    for_all(|database, btf, number, texel, view| {
        // Lights drawn in proportion to luma all weigh the same.
        let deviation = |weights: Vec<f64>| {
            #[allow(clippy::cast_precision_loss, reason = "4,000")]
            let count = weights.len() as f64;
            let mean = weights.iter().sum::<f64>() / count;
            (weights.iter().map(|weight| (weight / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt()
        };
        let random = |n: u32| [unit(5 * n), unit(5 * n + 1)];
        let luma = |light: [f64; 3]| channels(database, number, light, view)[0];
        let drawn = (0..4_000).map(|n| {
            let sample = btf.sample(texel, single(view), random(n));
            luma(sample.light.map(f64::from)) / f64::from(sample.pdf)
        });
        let (drawn, even) =
            (deviation(drawn.collect()), deviation((0..4_000).map(|n| luma(direction(random(n)))).collect()));
        // What falls anywhere, powers of two that are up to 6 % off, heights of slices in steps of the scales.
        assert!(drawn < 0.15, "{drawn} instead of {even}");
        assert!(even > 2.0 * drawn, "nothing to be gained: {even}");
    });
}

#[test]
fn later_stages_do_not_change_the_density() {
    let database = NestedShape { stages: 3, ..NestedShape::small() }.database(9);
    let first = Database { stages: database.stages[..1].to_vec(), ..database.clone() };
    let files = [first, database].map(|database| database.to_bytes());
    let [one, three] = files.each_ref().map(|file| NestedBtf::parse(file).unwrap());
    let texel = one.texel(0, 0, [1, 0]).unwrap();
    let (light, view) = (single(angles(40.0, 80.0)), single(angles(50.0, 10.0)));
    assert_eq!(one.pdf(texel, light, view).to_bits(), three.pdf(texel, light, view).to_bits());
    assert_ne!(one.eval(texel, light, view), three.eval(texel, light, view));
}

/// Mean of linear values over even points of the hemisphere, times 2.
fn dense_albedo(btf: &NestedBtf<'_>, texel: Texel, view: [f64; 3], side: u32) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (alpha, sin_beta) in middles(side, FRAC_PI_2).flat_map(|a| middles(side, 1.0).map(move |s| (a, s))) {
        let value = btf.eval(texel, single(light(alpha, sin_beta, view)), single(view));
        for (sum, value) in sum.iter_mut().zip(btf.header().encoding.linear(value)) {
            *sum += f64::from(value);
        }
    }
    sum.map(|sum| 2.0 * sum / f64::from(side * side))
}

#[test]
fn albedo_is_the_mean_of_sampled_light() {
    for_all(|_, btf, _, texel, view| {
        let albedo = btf.albedo(texel, single(view)).map(f64::from);
        let dense = dense_albedo(btf, texel, view, 300);
        const DRAWS: u32 = 100_000;
        let sampler = btf.sampler(texel, &btf.grid().view(single(view)));
        let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
        for n in 0..DRAWS {
            let sample = sampler.sample([unit(2 * n), unit(2 * n + 1)]);
            let value = btf.header().encoding.linear(btf.eval(texel, sample.light, single(view)));
            for (channel, value) in value.into_iter().enumerate() {
                let weight = f64::from(value) / f64::from(sample.pdf) / PI;
                sum[channel] += weight;
                squares[channel] += weight * weight;
            }
        }
        for channel in 0..3 {
            assert!((albedo[channel] / dense[channel] - 1.0).abs() < 0.005, "{albedo:?} {dense:?}");
            let mean = sum[channel] / f64::from(DRAWS);
            let error = ((squares[channel] / f64::from(DRAWS) - mean * mean) / f64::from(DRAWS)).sqrt();
            // Five deviations of the mean, and what the quadrature may be off.
            assert!((mean - albedo[channel]).abs() < 5.0 * error + 0.005 * mean, "{mean} ± {error}, {albedo:?}");
            assert!(error < 0.01 * mean, "{error} of {mean} is no comparison");
        }
    });
}

#[test]
fn a_constant_function_has_an_albedo_of_twice_itself() {
    let mut database = NestedShape::small().database(1);
    let chain = &mut database.stages[0];
    let n_beta = usize::from(database.header.grid.n_beta);
    for row in chain.p1.chunks_exact_mut(n_beta + 1) {
        row[..n_beta].fill(255);
        row[n_beta] = slice_mean(&row[..n_beta]);
    }
    for items in [&mut chain.texels, &mut chain.p4, &mut chain.p3, &mut chain.p2] {
        items.iter_mut().for_each(|item| item.code = 0);
    }
    // 1/2 of the display's white.
    chain.scales = [Scales { bits: 0, step: 0, offset: -16 }; 4];
    (database.chroma.first, database.chroma.step) = ([0.0; 2], [0.0; 2]);
    let file = database.to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let texel = btf.texel(0, 0, [0, 0]).unwrap();
    for [theta, phi] in VIEWS_DEG {
        let view = single(angles(theta, phi));
        for albedo in btf.albedo(texel, view) {
            // (1/π) · 2π · linear(1/2), IEC 61966-2-1.
            assert!((albedo - 2.0 * 0.214_041).abs() < 1e-4, "{albedo}");
        }
        for light in [angles(10.0, 0.0), angles(80.0, 120.0)] {
            let pdf = f64::from(btf.pdf(texel, single(light), view));
            assert!((pdf * 2.0 * PI - 1.0).abs() < 1e-4, "even: {pdf}");
        }
    }
}
