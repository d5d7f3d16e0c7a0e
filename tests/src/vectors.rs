//! Queries that a file can be asked, and what the decoder answers: the lines of `vectors/*.csv`.

use std::fmt::Write as _;

use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::btf::factored::ExpansionBuffers;
use subsurf_decoder::{Bssrdf, Content, Evaluate, File, Kernel, ReadError, Transfer};
use subsurf_encoder::metrics::transfer::decode;

use crate::nested::{angles, single};

/// First line of a table of queries.
pub const HEADER: &str = "query,arguments,values,tolerance";

/// What is asked: a word, and numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    /// `rd`, `albedo`, `profile`, `coefficient`, `weight`, `blurred`, `eval`, `tail`, `energy`, `gaussians` or `exitance`.
    pub word: String,
    /// Its arguments.
    pub arguments: Vec<f32>,
}

/// A line of a table: a query and what answers must be within `tolerance` of.
#[derive(Clone, Debug)]
pub struct Line {
    /// What is asked.
    pub query: Query,
    /// The values.
    pub values: Vec<f32>,
    /// Largest distance of any of them.
    pub tolerance: f32,
}

impl Line {
    /// Reads a line.
    ///
    /// # Panics
    /// If it is none.
    #[must_use]
    pub fn read(line: &str) -> Self {
        let fields: Vec<&str> = line.split(',').collect();
        let [word, arguments, values, tolerance] = fields[..] else { panic!("four fields: {line}") };
        let numbers = |text: &str| text.split(' ').filter(|number| !number.is_empty()).map(parse).collect();
        let query = Query { word: word.to_owned(), arguments: numbers(arguments) };
        Self { query, values: numbers(values), tolerance: parse(tolerance) }
    }
}

fn parse(number: &str) -> f32 {
    number.parse().unwrap_or_else(|_| panic!("a number: {number}"))
}

/// The table of a file.
///
/// # Errors
/// If the file is refused.
///
/// # Panics
/// Never.
pub fn table(file: &[u8]) -> Result<String, ReadError> {
    let content = File::parse(file)?.content();
    let mut text = format!("{HEADER}\n");
    for query in queries(&content) {
        let values = answer(&content, &query);
        let largest = values.iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
        let tolerance = tolerance(&content, &query, largest);
        let list = |numbers: &[f32]| numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" ");
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{},{},{},{tolerance:.1e}", query.word, list(&query.arguments), list(&values));
    }
    Ok(text)
}

/// How far an answer in f32 may be off.
fn tolerance(content: &Content<'_>, query: &Query, largest: f32) -> f32 {
    match (content, &query.word[..]) {
        // Sums of numbers of both signs, and a quadrature of another kind.
        (Content::Bssrdf(_), "coefficient" | "blurred") => 1e-5 * largest.max(1.0),
        (Content::Transfer(file), _) => 1e-5 * largest.max(file.header().scale[0]),
        (Content::NestedBtf(_) | Content::FactoredBtf(_), "albedo") => 0.01 * largest,
        (Content::NestedBtf(_) | Content::FactoredBtf(_), _) => 1e-4 * largest,
        _ => 1e-5 * largest,
    }
}

/// What a file is asked.
fn queries(content: &Content<'_>) -> Vec<Query> {
    match content {
        Content::Bssrdf(material) => of_bssrdf(material),
        Content::NestedBtf(_) | Content::FactoredBtf(_) => of_btf(content),
        Content::Kernel(kernel) => of_kernel(kernel),
        Content::Transfer(file) => of_transfer(file),
        _ => Vec::new(),
    }
}

#[allow(clippy::cast_precision_loss, reason = "small files")]
fn query<const N: usize>(word: &str, arguments: [i32; N]) -> Query {
    Query { word: word.to_owned(), arguments: arguments.map(|number| number as f32).to_vec() }
}

fn number(index: usize) -> i32 {
    i32::try_from(index).expect("a few")
}

fn of_bssrdf(material: &Bssrdf<'_>) -> Vec<Query> {
    let header = material.header();
    let [width, height] = [header.width, header.height].map(u32::cast_signed);
    let mut all = Vec::new();
    // A few pixels of each file: the corners and some in between.
    let pixels = [[0, 0], [width - 1, 0], [width / 2, height / 2], [width / 3, height - 1], [width - 1, height - 1]];
    let radius = i32::from(header.window_radius);
    for [x, y] in pixels {
        all.push(query("albedo", [x, y]));
        let steps =
            [[0, 0], [1, 0], [0, -1], [-2, 1], [radius, 0], [radius, radius], [-radius, 1], [radius + 1, 0], [-9, 4]];
        all.extend(steps.map(|[dx, dy]| query("rd", [x + dx, y + dy, x, y])));
        if material.basis().is_some() {
            all.push(query("blurred", [x, y]));
        }
        all.push(query("profile", [x, y, 0]));
        all.push(query("profile", [x, y, i32::from(header.samples) - 1]));
        let terms = material.basis().map_or(0, |basis| basis.size().terms);
        all.extend((0..terms).map(|l| query("coefficient", [number(l), x, y])));
    }
    if let Some(basis) = material.basis() {
        let BasisSize { terms, gaussians } = basis.size();
        for (l, m) in (0..terms).flat_map(|l| (0..terms).map(move |m| (l, m))) {
            all.extend((0..gaussians).map(|a| query("weight", [l, m, a].map(number))));
        }
    }
    all.dedup();
    all
}

/// Angles of light and view in degrees: above, aside, in and beside the plane of view, low, and below the horizon.
const DIRECTIONS: [[f64; 4]; 9] = [
    [0.0, 0.0, 0.0, 0.0],
    [30.0, 10.0, 0.0, 0.0],
    [0.0, 0.0, 40.0, 200.0],
    [45.0, 180.0, 45.0, 0.0],
    [50.0, 77.0, 20.0, 111.0],
    [60.0, 300.0, 65.0, 359.0],
    [80.0, 35.0, 30.0, 45.0],
    [88.0, 250.0, 75.0, 91.0],
    [95.0, 0.0, 10.0, 0.0],
];

fn of_btf(content: &Content<'_>) -> Vec<Query> {
    let catalog = content.catalog().expect("a BTF");
    let mut all = Vec::new();
    let mut count = 0_usize;
    for (material, of) in (0_u8..).zip(catalog.materials()) {
        for level in 0..of.levels {
            let [width, height] = of.size(level);
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                // Every texel in some of the directions, in another order each.
                for step in 0..3 {
                    let [tl, pl, tv, pv] = DIRECTIONS[(count * 5 + step * 2) % DIRECTIONS.len()];
                    let place = [material.into(), level.into(), x as f32, y as f32];
                    let arguments = [&place[..], &single(angles(tl, pl)), &single(angles(tv, pv))].concat();
                    all.push(Query { word: "eval".to_owned(), arguments });
                }
                count += 1;
            }
        }
    }
    if matches!(content, Content::NestedBtf(_)) {
        let arguments = [&[0.0; 4][..], &single(angles(35.0, 20.0))].concat();
        all.push(Query { word: "albedo".to_owned(), arguments });
    }
    all
}

fn of_kernel(kernel: &Kernel<'_>) -> Vec<Query> {
    let header = kernel.header();
    let mut all = vec![query("energy", [])];
    for term in 0..i32::from(header.terms) {
        all.extend([0, 1, i32::from(header.taps) / 2].map(|tap| query("weight", [term, tap])));
    }
    if kernel.two_gaussians().is_some() {
        all.extend((0..3).map(|channel| query("gaussians", [channel])));
    }
    for step in 0..9_u8 {
        // In the middle between two nodes, and one beyond the radius: profiles have steps at the nodes.
        let intervals = f32::from(header.tail_nodes - 1);
        let node = (intervals * f32::from(step) / 8.0).floor() + 0.5;
        let d = header.radius_mm * (node / intervals) * (node / intervals);
        all.extend(["tail", "rd"].map(|word| Query { word: word.to_owned(), arguments: vec![d] }));
    }
    all.dedup();
    all
}

fn of_transfer(file: &Transfer<'_>) -> Vec<Query> {
    let lights = i32::from(file.header().lights);
    let vertices = file.header().vertices.cast_signed();
    (0..lights).flat_map(|light| (0..vertices).map(move |vertex| query("exitance", [light, vertex]))).collect()
}

/// What the decoder answers.
///
/// # Panics
/// For a query that the file cannot be asked.
#[must_use]
pub fn answer(content: &Content<'_>, query: &Query) -> Vec<f32> {
    let numbers = &query.arguments[..];
    match (content, &query.word[..], numbers) {
        (Content::Bssrdf(material), "rd", &[xi, yi, xo, yo]) => material.rd(pixel(xi, yi), pixel(xo, yo)).to_vec(),
        (Content::Bssrdf(material), "albedo", &[x, y]) => material.albedo(pixel(x, y)).to_vec(),
        (Content::Bssrdf(material), "profile", &[x, y, h]) => material.profile(pixel(x, y)).node(whole(h)).to_vec(),
        (Content::Bssrdf(material), "coefficient", &[l, x, y]) => {
            let basis = material.basis().expect("a basis");
            basis.coefficient(whole(l), &material.profile(pixel(x, y))).to_vec()
        }
        (Content::Bssrdf(material), "blurred", &[x, y]) => blurred(material, pixel(x, y)).to_vec(),
        (Content::Bssrdf(material), "weight", &[l, m, a]) => {
            material.basis().expect("a basis").weight(whole(l), whole(m), whole(a)).to_vec()
        }
        (Content::NestedBtf(btf), "albedo", &[material, level, x, y, vx, vy, vz]) => {
            let texel = btf.texel(whole(material), small(level), pixel(x, y)).expect("a texel");
            btf.albedo(texel, [vx, vy, vz]).to_vec()
        }
        (Content::NestedBtf(btf), "eval", _) => eval(btf, numbers),
        (Content::FactoredBtf(btf), "eval", _) => {
            let (mut table, mut words) = (vec![0; btf.table_len()], vec![0; btf.words_len()]);
            let mut scratch = vec![0.0; btf.scratch_len()];
            let buffers = ExpansionBuffers { table: &mut table, words: &mut words, scratch: &mut scratch };
            eval(&btf.expand(buffers).expect("room for all"), numbers)
        }
        (Content::Kernel(kernel), "energy", []) => kernel.energy().to_vec(),
        (Content::Kernel(kernel), "weight", &[term, tap]) => kernel.weight(whole(term), whole(tap)).to_vec(),
        (Content::Kernel(kernel), "gaussians", &[channel]) => {
            let two = kernel.two_gaussians().expect("two Gaussians");
            [two.weight, two.tau_near, two.tau_far].map(|rgb| rgb[whole(channel)]).to_vec()
        }
        (Content::Kernel(kernel), "tail", &[d]) => kernel.tail_at(d).to_vec(),
        (Content::Kernel(kernel), "rd", &[r]) => kernel.rd(r).to_vec(),
        (Content::Transfer(file), "exitance", &[light, vertex]) => {
            let mut weights = vec![0.0; file.header().lights.into()];
            weights[whole(light)] = 1.0;
            let channels = usize::from(file.header().channels);
            decode(file, &weights)[whole(vertex) * channels..][..channels].to_vec()
        }
        _ => panic!("no query of a {}: {query:?}", content.family()),
    }
}

/// Exitance of a pixel under even light by the separable basis.
fn blurred(material: &Bssrdf<'_>, [x, y]: [i32; 2]) -> [f32; 3] {
    let (header, basis) = (material.header(), material.basis().expect("a basis"));
    let size = [header.width, header.height];
    let [width, height] = size.map(u32::cast_signed);
    let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let at = pixels().position(|other| other == [x, y]).expect("within the patch");
    let maps: Vec<Vec<[f32; 3]>> = (0..basis.size().terms)
        .map(|l| pixels().map(|pixel| basis.coefficient(l, &material.profile(pixel))).collect())
        .collect();
    [0, 1, 2].map(|c| {
        let mut sum = 0.0;
        for (l, map) in maps.iter().enumerate() {
            let mut plane: Vec<f32> = map.iter().map(|rgb| rgb[c]).collect();
            let mut between = plane.clone();
            for (a, stage) in basis.cascade().stages().iter().enumerate() {
                stage.blur(&mut plane, &mut between, size, header.addressing);
                sum += maps.iter().enumerate().map(|(m, map)| map[at][c] * basis.weight(l, m, a)[c]).sum::<f32>()
                    * plane[at];
            }
        }
        sum
    })
}

fn eval(btf: &impl Evaluate, numbers: &[f32]) -> Vec<f32> {
    let &[material, level, x, y, lx, ly, lz, vx, vy, vz] = numbers else { panic!("ten numbers: {numbers:?}") };
    let texel = btf.catalog().texel(whole(material), small(level), pixel(x, y)).expect("a texel");
    btf.eval(texel, [lx, ly, lz], [vx, vy, vz]).to_vec()
}

#[allow(clippy::cast_possible_truncation, reason = "whole numbers")]
fn pixel(x: f32, y: f32) -> [i32; 2] {
    [x as i32, y as i32]
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers")]
fn whole(number: f32) -> usize {
    number as usize
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers")]
fn small(number: f32) -> u8 {
    number as u8
}
