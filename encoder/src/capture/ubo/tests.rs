use std::f32::consts::PI;

use half::f16;

use super::*;

/// θ and φ in degrees.
const LIGHTS: [[f32; 2]; 3] = [[0.0, 0.0], [30.0, 90.0], [75.0, -135.0]];
const VIEWS: [[f32; 2]; 2] = [[11.0, 15.0], [60.0, 180.0]];
const SIZE: [u32; 2] = [4, 2];
const PAIRS: usize = LIGHTS.len() * VIEWS.len();
const TEXELS: usize = 8;

/// Files, field by field in the order of the table above.
struct Writer {
    signature: &'static [u8],
    version: u32,
    cosine: u32,
    channels: u32,
    rotations: u32,
    /// Of DFMF: model; of FMF: whether values are logarithms.
    colour: u32,
    scalar_bytes: u8,
    /// Whether U has the rows of texels.
    swapped: bool,
}

const DFMF: Writer = Writer {
    signature: b"!DFMF08FCR",
    version: 4,
    cosine: 1,
    channels: 3,
    rotations: 0,
    colour: 0,
    scalar_bytes: 4,
    swapped: false,
};
const FMF: Writer = Writer { signature: b"!FMF12FCER", ..DFMF };

impl Writer {
    fn is_full(&self) -> bool {
        self.signature.starts_with(b"!FMF")
    }

    /// Components of a channel.
    fn components(&self, channel: usize) -> usize {
        if self.is_full() { 2 } else { 3 - channel }
    }

    /// Component `k` of a channel in the row of a texel or else of a pair; binary16 holds it.
    fn component(&self, of_texel: bool, channel: usize, row: usize, k: usize) -> f32 {
        // S V of FMF knows no channels.
        let channel = if self.is_full() && of_texel != self.swapped { 0 } else { channel };
        let value = if of_texel { 3 * channel + row + 4 * k } else { 8 + channel + 2 * row + k };
        f32::from(u8::try_from(value).unwrap()) / 16.0 - 0.5
    }

    /// What the matrices make of a texel.
    fn product(&self, pair: usize, texel: usize) -> [f32; 3] {
        std::array::from_fn(|c| {
            let product = |k| self.component(false, c, pair, k) * self.component(true, c, texel, k);
            (0..self.components(c)).map(product).sum()
        })
    }

    fn header(&self) -> Vec<u8> {
        let mut facts = self.version.to_le_bytes().to_vec();
        facts.extend([b'x'; 240]);
        facts.extend([2.0_f32, 1.0, 1.0, 1.0].iter().flat_map(|value| value.to_le_bytes()));
        if self.version > 1 {
            facts.extend(self.cosine.to_le_bytes());
        }
        if self.version > 2 {
            facts.extend(5_u32.to_le_bytes());
            facts.extend(b"<a />");
        }
        if self.version > 3 {
            facts.extend(self.channels.to_le_bytes());
            for name in ["R", "G", "B"] {
                facts.extend(1_u32.to_le_bytes());
                facts.extend(name.as_bytes());
            }
        }
        let mut file = self.signature.to_vec();
        file.extend((u32::try_from(facts.len()).unwrap() + 4).to_le_bytes());
        file.extend(facts);
        file
    }

    fn directions(file: &mut Vec<u8>) {
        let radians = |angles: &[f32; 2]| angles.map(|angle| angle.to_radians().to_le_bytes()).into_iter().flatten();
        file.extend(u32::try_from(VIEWS.len()).unwrap().to_le_bytes());
        for view in &VIEWS {
            file.extend(radians(view));
            file.extend(u32::try_from(LIGHTS.len()).unwrap().to_le_bytes());
            file.extend(LIGHTS.iter().flat_map(radians));
        }
    }

    fn number(&self, file: &mut Vec<u8>, value: f32) {
        match self.scalar_bytes {
            2 => file.extend(f16::from_f32(value).to_le_bytes()),
            4 => file.extend(value.to_le_bytes()),
            _ => file.extend(f64::from(value).to_le_bytes()),
        }
    }

    /// U and S V of some channels, with the numbers before them.
    fn matrices(&self, file: &mut Vec<u8>, channels: &[usize]) {
        let components = self.components(channels[0]);
        let (items, others) = if self.swapped { (TEXELS, PAIRS) } else { (PAIRS, TEXELS) };
        file.push(self.scalar_bytes);
        for number in [components, channels.len() * items, others] {
            file.extend(u32::try_from(number).unwrap().to_le_bytes());
        }
        (0..components).for_each(|_| self.number(file, 1.0));
        for row in 0..items {
            for &channel in channels {
                (0..components).for_each(|k| self.number(file, self.component(self.swapped, channel, row, k)));
            }
        }
        for row in 0..others {
            (0..components).for_each(|k| self.number(file, self.component(!self.swapped, channels[0], row, k)));
        }
    }

    fn file(&self) -> Vec<u8> {
        let mut file = self.header();
        Self::directions(&mut file);
        file.extend(SIZE.iter().flat_map(|pixels| pixels.to_le_bytes()));
        if self.signature.ends_with(b"R") {
            file.extend(self.rotations.to_le_bytes());
        }
        if self.is_full() {
            if self.signature.ends_with(b"ER") {
                // Version, logarithms, and a height map of 2 × 1.
                file.push(2);
                file.extend([self.colour, 2, 1].iter().flat_map(|value| value.to_le_bytes()));
                file.extend([0; 4]);
            }
            file.extend(2_u32.to_le_bytes());
            self.matrices(&mut file, &[0, 1, 2]);
        } else {
            file.extend([3, self.colour].iter().flat_map(|value: &u32| value.to_le_bytes()));
            file.extend([0.0_f32; 12].iter().flat_map(|value| value.to_le_bytes()));
            (0..3).for_each(|channel| self.matrices(&mut file, &[channel]));
        }
        file
    }
}

fn parse(file: &[u8]) -> Result<Layout> {
    Layout::parse(Path::new("some.btf"), file)
}

fn refusal(file: &[u8]) -> String {
    parse(file).unwrap_err().to_string()
}

/// Compares all images of a file with the products of its matrices.
fn check(writer: &Writer) {
    let (name, file) = (String::from_utf8_lossy(writer.signature), writer.file());
    let layout = parse(&file).unwrap();
    for (light, view) in (0..LIGHTS.len()).flat_map(|light| (0..VIEWS.len()).map(move |view| (light, view))) {
        let image = layout.read(Path::new("some.btf"), &file, light, view).unwrap();
        assert_eq!(image.len(), TEXELS);
        for (texel, found) in image.iter().enumerate() {
            let product = writer.product(view * LIGHTS.len() + light, texel);
            let expected = layout.colour.decode(product);
            let error = (Vec3::from_array(*found) - expected).abs().max_element();
            assert!(
                error <= 1e-5 * expected.abs().max_element().max(1.0),
                "{name}: {found:?} for {expected} at {texel}"
            );
        }
    }
}

#[test]
fn files_are_read_as_they_were_written() {
    for scalar_bytes in [2, 4, 8] {
        for swapped in [false, true] {
            check(&Writer { scalar_bytes, swapped, ..DFMF });
            check(&Writer { scalar_bytes, swapped, ..FMF });
        }
    }
    for version in 1..=4 {
        check(&Writer { version, ..DFMF });
    }
    check(&Writer { colour: 11, ..DFMF });
    check(&Writer { colour: 1, ..FMF });
    check(&Writer { signature: b"!FMF06FCR", ..DFMF });
    check(&Writer { signature: b"!FMF06FC", ..DFMF });
    assert_eq!(parse(&Writer { colour: 11, ..DFMF }.file()).unwrap().colour, Colour::LogLumaRatios);
    assert_eq!(parse(&Writer { colour: 1, ..FMF }.file()).unwrap().colour, Colour::LogRgb);
}

#[test]
fn directions_go_down_the_columns() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("some.btf");
    std::fs::write(&path, DFMF.file()).unwrap();
    let btf = Ubo::open(&path).unwrap();
    assert_eq!((btf.size(), btf.has_cosine(), btf.path()), (SIZE, true, path.as_path()));
    assert_eq!((btf.lights().len(), btf.views().len()), (3, 2));
    assert_eq!(btf.lights()[0], Vec3::Z);
    // An azimuth of 90° is up the image.
    let up = Vec3::new(0.0, -0.5, (PI / 6.0).cos());
    assert!(btf.lights()[1].distance(up) < 1e-6, "{}", btf.lights()[1]);
    assert!(btf.lights()[2].x < 0.0 && btf.lights()[2].y > 0.0, "{}", btf.lights()[2]);
    assert!(btf.lights().iter().chain(btf.views()).all(|towards| (towards.length() - 1.0).abs() < 1e-6));
    assert_eq!(btf.read(2, 1).unwrap().len(), TEXELS);
    for (light, view) in [(3, 0), (0, 2), (usize::MAX, usize::MAX)] {
        assert!(matches!(btf.read(light, view), Err(Error::Request(_))), "light {light}, view {view}");
    }
    assert!(Ubo::open(&place.path().join("nothing.btf")).is_err());
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let changed = |at: usize, value: u32| {
        let mut file = DFMF.file();
        file[at..at + 4].copy_from_slice(&value.to_le_bytes());
        refusal(&file)
    };
    // Offsets of a DFMF file of version 4.
    let header = 10;
    let views = DFMF.header().len();
    let size = views + 4 + VIEWS.len() * 12 + PAIRS * 8;
    let model = size + 8 + 4 + 4;
    let matrix = model + 4 + 48;
    for (message, expected) in [
        (refusal(b"PNG"), "some.btf: no signature of a BTF; expected a .btf file that begins with !DFMF08FCR"),
        (refusal(b"!PVF06FCR"), "factorised per view (PVF)"),
        (refusal(b"!BDIF06R2!"), "not compressed (BDI)"),
        (changed(header, 300), "a header of 300 bytes; expected 296 bytes"),
        (changed(header + 4, 5), "header version 5; expected 1 to 4"),
        (refusal(&Writer { channels: 7, ..DFMF }.file()), "7 channels; expected 3"),
        (changed(views, 0), "0 views, and no light"),
        (changed(views + 4, 2.0_f32.to_bits()), "a view at 2 rad from the normal"),
        (changed(views + 8, f32::NAN.to_bits()), "azimuth NaN rad; expected a direction above the sample"),
        (changed(views + 12 + 12 + 24, 4), "4 lights with view 1; expected 3"),
        (changed(views + 12 + 12 + 24 + 4 + 8, 0), "light 1 has another direction with view 1 than with the first"),
        (changed(size, 0), "0 × 2 pixels"),
        (refusal(&Writer { rotations: 6, ..DFMF }.file()), "6 rotated frames"),
        (changed(model, 2), "colour model 2, CIE Lab"),
        (changed(model, 13), "colour model 13, not a known one; expected 0, 1, 3, 4 or 9 to 12"),
        (refusal(&Writer { scalar_bytes: 3, ..DFMF }.file()), "numbers of 3 bytes; expected 2, 4 or 8"),
        (changed(matrix + 1, 0), "no component"),
        (changed(matrix + 5, 7), "matrices of 7 and 8 rows; expected 6 pairs of directions, 8 pixels and 1 channels"),
        (changed(matrix + 1, u32::MAX), "the file is cut"),
        (refusal(&[DFMF.file(), vec![0; 3]].concat()), "3 bytes after the last matrix"),
    ] {
        assert!(message.contains(expected), "{message}\nshould say: {expected}");
    }
}

#[test]
fn cut_and_broken_files_are_refused_or_bounded() {
    for writer in [&DFMF, &FMF, &Writer { colour: 11, scalar_bytes: 2, ..DFMF }] {
        let whole = writer.file();
        for len in 0..whole.len() {
            let message = refusal(&whole[..len]);
            let reason = if len < writer.signature.len() { "no signature" } else { "the file is cut" };
            assert!(message.contains(reason), "{len} bytes: {message}");
        }
        for (at, bits) in (0..whole.len()).flat_map(|at| [0x01, 0x80, 0xFF].map(|bits| (at, bits))) {
            let mut file = whole.clone();
            file[at] ^= bits;
            let Ok(layout) = parse(&file) else {
                continue;
            };
            for pair in 0..PAIRS {
                let image = layout.read(Path::new("some.btf"), &file, pair % LIGHTS.len(), pair / LIGHTS.len());
                // What is below zero is counted and clamped by those who keep images.
                let is_finite = |image: Vec<[f32; 3]>| image.iter().flatten().all(|value| value.is_finite());
                assert!(image.is_err() || is_finite(image.unwrap()), "byte {at} with {bits:#x}");
            }
        }
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut file = DFMF.file();
    let len = file.len();
    // The last texel's, of the third channel.
    file[len - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
    let layout = parse(&file).unwrap();
    let message = layout.read(Path::new("some.btf"), &file, 1, 1).unwrap_err().to_string();
    assert!(message.contains("light 1, view 1") && message.contains("NaN] at texel 7"), "{message}");
}
