//! Integers of factored BTFs as bits (`FORMAT.md`, section 5.4): what a writer writes is what a reader reads.

use subsurf_decoder::btf::factored::coder::{BitCoder, BitModel};
use subsurf_decoder::btf::factored::model::{IntegerModel, code_core, code_words};

/// Writer of digits: bits that have a model are `0` and `1`, even ones `-` and `+`.
#[derive(Default)]
struct Digits(String);

impl BitCoder for Digits {
    fn bit(&mut self, _: &mut BitModel, bit: bool) -> bool {
        self.0.push(if bit { '1' } else { '0' });
        bit
    }

    fn even(&mut self, bit: bool) -> bool {
        self.0.push(if bit { '+' } else { '-' });
        bit
    }
}

/// Reader of digits, which knows nothing of the numbers.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn next(&mut self, of: [u8; 2]) -> bool {
        let (digit, rest) = self.0.split_first().expect("a digit");
        assert!(of.contains(digit), "a bit of the other kind");
        self.0 = rest;
        *digit == of[1]
    }
}

impl BitCoder for Reader<'_> {
    fn bit(&mut self, _: &mut BitModel, _: bool) -> bool {
        self.next(*b"01")
    }

    fn even(&mut self, _: bool) -> bool {
        self.next(*b"-+")
    }
}

/// Twenty ones, after which a unary part has no zero.
const TWENTY: &str = "11111111111111111111";

#[test]
fn numbers_are_the_digits_that_the_format_says() {
    let cases = [
        // Not zero, sign, magnitude − 1 in unary.
        (0.0, 0, "0".to_owned()),
        (0.0, 1, "1-0".to_owned()),
        (0.0, -1, "1+0".to_owned()),
        (0.0, 3, "1-110".to_owned()),
        (2.8, -3, "1+110".to_owned()),
        // From 4 on there are binary digits, the first with a model: one, two from 8, five from 64 on.
        (4.0, 2, "1-01".to_owned()),
        (4.0, 5, "1-1100".to_owned()),
        (8.0, -12, "1+1101+".to_owned()),
        (8.0, 14, "1-11100+".to_owned()),
        (64.0, 1 + 0b1_10110, "1-101-++-".to_owned()),
        (1e9, 1 + 0b10_01001, "1-1100+--+".to_owned()),
        // From 20 on, how many more as an exponential Golomb code.
        (0.0, 20, format!("1-{}0", &TWENTY[1..])),
        (0.0, 21, format!("1-{TWENTY}-")),
        (0.0, 22, format!("1-{TWENTY}+--")),
        (0.0, 23, format!("1-{TWENTY}+-+")),
        (0.0, -27, format!("1+{TWENTY}++-++")),
        // 32,766 − 20 + 1 has 14 digits after its first.
        (0.0, 32_767, format!("1-{TWENTY}++++++++++++++-+++++++++-+-++")),
    ];
    for (expected, number, digits) in cases {
        let mut writer = Digits::default();
        assert_eq!(IntegerModel::default().code(&mut writer, expected, number), number);
        assert_eq!(writer.0, digits, "{number}, expected {expected}");
        let mut reader = Reader(digits.as_bytes());
        assert_eq!(IntegerModel::default().code(&mut reader, expected, 0), number, "{digits}, expected {expected}");
        assert!(reader.0.is_empty(), "all of {digits}");
    }
}

#[test]
fn larger_magnitudes_count_as_the_largest() {
    // After fifteen ones there is no zero: 2¹⁶ − 2 + 20 + 1, and five binary digits more.
    let digits = format!("1+{TWENTY}{}{}1++++", "+".repeat(15), "+".repeat(15));
    let mut reader = Reader(digits.as_bytes());
    assert_eq!(IntegerModel::default().code(&mut reader, 1e9, 0), -32_767);
    assert!(reader.0.is_empty(), "all of them");
}

#[test]
fn cores_and_codewords_come_back() {
    let (mut core, mut words) = ([0.0_f32; 12], [0_i16; 10]);
    for (k, number) in (0_i16..).zip(&mut core) {
        *number = f32::from((k * 37 + 11) % 23 - 9);
    }
    for (k, word) in (0_i16..).zip(&mut words) {
        *word = (k * 3_203 + 1) * if k % 3 == 1 { -1 } else { 1 };
    }
    let (written_core, written_words) = (core, words);
    let mut writer = Digits::default();
    code_core(&mut writer, &mut IntegerModel::default(), 4, &mut core, &mut [1.0; 12]);
    code_words(&mut writer, 5, &mut words);
    assert_eq!((core, words), (written_core, written_words), "a writer leaves them as they are");

    let (mut core, mut words) = ([0.0_f32; 12], [0_i16; 10]);
    let mut reader = Reader(writer.0.as_bytes());
    code_core(&mut reader, &mut IntegerModel::default(), 4, &mut core, &mut [1.0; 12]);
    code_words(&mut reader, 5, &mut words);
    assert!(reader.0.is_empty(), "all digits");
    assert_eq!((core, words), (written_core, written_words));
}
