//! What `check.c` has to print of a file, by the decoder itself.

use std::fmt::Write;

use subsurf_decoder::bssrdf::{BssrdfModel, Mixtures, Profiles};
use subsurf_decoder::btf::{Catalog, ColourEncoding, Evaluate};
use subsurf_decoder::{Bssrdf, Content, File, NestedBtf};

const LIGHT: [f32; 3] = [0.48, -0.6, 0.64];
const VIEW: [f32; 3] = [0.36, 0.48, 0.8];
const RANDOM: [f32; 2] = [0.3, 0.7];

/// Lines of text that are added one by one.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn add(&mut self, line: impl std::fmt::Display) {
        writeln!(self.0, "{line}").expect("strings grow");
    }

    fn numbers(&mut self, name: &str, numbers: &[f32]) {
        let bits: Vec<String> = numbers.iter().map(|number| format!(" {:08x}", number.to_bits())).collect();
        self.add(format_args!("{name}{}", bits.concat()));
    }

    fn plane(&mut self, kind: u32, texel: usize, [width, height, layers]: [usize; 3], bytes: &[u8]) {
        assert_eq!(bytes.len(), texel * width * height * layers, "a plane of kind {kind}");
        let sum = bytes.iter().fold(0_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add((*byte).into()));
        self.add(format_args!("plane {kind} {} {width}x{height}x{layers} {sum:08x}", width * texel));
    }
}

/// Everything that `check.c` prints of a file.
pub(crate) fn of(bytes: &[u8]) -> String {
    let mut lines = Lines::default();
    let content = File::parse(bytes).expect("a file of our own").content();
    let length = bytes.len();
    match content {
        Content::Bssrdf(material) => {
            lines.add(format_args!("file 1 {length}"));
            bssrdf(&mut lines, &material);
        }
        Content::NestedBtf(btf) => {
            lines.add(format_args!("file 2 {length}"));
            catalog(&mut lines, btf.catalog(), 0);
            values(&mut lines, &btf, Some(&btf));
        }
        Content::FactoredBtf(btf) => {
            lines.add(format_args!("file 3 {length}"));
            catalog(&mut lines, btf.catalog(), btf.table_len() + 2 * btf.words_len() + 4 * btf.scratch_len());
            let (mut table, mut words) = (vec![0; btf.table_len()], vec![0; btf.words_len()]);
            let mut scratch = vec![0.0; btf.scratch_len()];
            let buffers = subsurf_decoder::btf::factored::ExpansionBuffers {
                table: &mut table,
                words: &mut words,
                scratch: &mut scratch,
            };
            values(&mut lines, &btf.expand(buffers).expect("buffers of that length"), None);
        }
        other => panic!("a {}", other.family()),
    }
    lines.0
}

fn bssrdf(lines: &mut Lines, material: &Bssrdf<'_>) {
    let header = material.header();
    let [width, height] = [header.width, header.height].map(|side| side as usize);
    let bits = match (header.model, header.coding.code()) {
        (0, _) => 96 * u32::from(header.samples),
        (1, _) => 8 * u32::try_from(header.index_bytes()).expect("1 or 2"),
        (2, coding) => [48, 24, 16][usize::from(coding)],
        (k, _) => 40 * u32::from(k),
    };
    lines.add(format_args!(
        "patch {} {} {} {width} {height} {} {} {} {bits}",
        header.model,
        header.coding.code(),
        header.addressing.code(),
        header.window_radius,
        header.samples,
        header.base_materials
    ));
    lines.numbers("lengths", &[header.pitch_mm, header.r_max_mm, header.eta]);
    match material.model() {
        BssrdfModel::PerPixel(planes) => {
            let layers = 3 * usize::from(header.samples);
            lines.plane(1, 4, [width, height, layers], planes.profiles.as_bytes());
        }
        BssrdfModel::BaseMaterials(planes) => {
            let size = [header.samples.into(), header.base_materials as usize, 1];
            match planes.profiles {
                Profiles::F32(values) => lines.plane(0, 12, size, values.as_bytes()),
                Profiles::F16(values) => lines.plane(0, 6, size, values.as_bytes()),
            }
            let size = [width, height, 1];
            match planes.mixtures {
                Mixtures::One(indices) => lines.plane(3, 1, size, indices),
                Mixtures::OneOfMany(indices) => lines.plane(3, 2, size, indices.as_bytes()),
                Mixtures::Two { ratios, indices } => {
                    lines.plane(2, 4, size, ratios.as_bytes());
                    lines.plane(3, 2, size, indices.as_flattened());
                }
                Mixtures::TwoSmall { ratios, indices } => {
                    lines.plane(2, 1, size, ratios);
                    lines.plane(3, 2, size, indices.as_flattened());
                }
                Mixtures::Palette { pairs, codes } => {
                    lines.plane(4, 2, [pairs.len(), 1, 1], pairs.as_flattened());
                    lines.plane(5, 2, size, codes.as_bytes());
                }
                Mixtures::Several { ratios, indices, count } => {
                    lines.plane(2, 4, [width, height, count], ratios.as_bytes());
                    lines.plane(3, 1, [width, height, count], indices);
                }
            }
        }
    }
    for x in -1..=2 {
        lines.numbers("rd", &material.rd([x, 0], [1, 1]));
        lines.numbers("albedo", &material.albedo([x, 1]));
    }
}

fn catalog(lines: &mut Lines, catalog: &Catalog<'_>, expansion_bytes: usize) {
    let (header, grid) = (catalog.header(), catalog.grid());
    let is_display = u8::from(matches!(header.encoding, ColourEncoding::Display { .. }));
    lines.add(format_args!(
        "btf {} {} {is_display} {} {} {} {} {expansion_bytes}",
        header.materials,
        catalog.texels(),
        grid.n_alpha,
        grid.n_beta,
        grid.n_theta,
        grid.n_phi
    ));
    for material in catalog.materials() {
        let [width, height] = material.size(0);
        lines.add(format_args!("material {} {width} {height} {}", material.name(), material.levels));
    }
}

fn values(lines: &mut Lines, btf: &impl Evaluate, nested: Option<&NestedBtf<'_>>) {
    for x in -1..=2 {
        let texel = btf.catalog().texel(0, 0, [x, 1]).expect("coordinates repeat");
        let value = btf.eval(texel, LIGHT, VIEW);
        lines.numbers("value", &value);
        lines.numbers("linear", &btf.catalog().header().encoding.linear(value));
        if let Some(btf) = nested {
            let sample = btf.sample(texel, VIEW, RANDOM);
            lines.numbers("light", &sample.light);
            lines.numbers("density", &[sample.pdf]);
            lines.numbers("pdf", &[btf.pdf(texel, LIGHT, VIEW)]);
            lines.numbers("albedo", &btf.albedo(texel, VIEW));
        }
    }
}
