//! Arguments of the calls that a target makes: bytes behind the file.

use subsurf_decoder::container::Container;

/// Numbers from the bytes behind a file; zeros where there are no more.
pub struct Arguments<'a>(&'a [u8]);

impl<'a> Arguments<'a> {
    /// What follows the file in an input whose container is sound.
    ///
    /// # Panics
    /// If it is not.
    #[must_use]
    pub fn behind_file(input: &'a [u8]) -> Self {
        let file = Container::parse(input).expect("a file that was read").file();
        Self(&input[file.len()..])
    }

    fn bytes(&mut self) -> [u8; 4] {
        let (first, rest) = self.0.split_at(self.0.len().min(4));
        self.0 = rest;
        let mut bytes = [0; 4];
        bytes[..first.len()].copy_from_slice(first);
        bytes
    }

    /// Any integer.
    pub fn integer(&mut self) -> i32 {
        i32::from_le_bytes(self.bytes())
    }

    /// Number from 0 to below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.integer().cast_unsigned() as usize % end.max(1)
    }

    /// Any number, NaN and infinities too.
    pub fn number(&mut self) -> f32 {
        f32::from_le_bytes(self.bytes())
    }

    /// Any three numbers.
    pub fn vector(&mut self) -> [f32; 3] {
        [self.number(), self.number(), self.number()]
    }

    /// Unit vector, or three numbers that are none where they have no direction.
    pub fn direction(&mut self) -> [f32; 3] {
        let [x, y, z] = self.vector();
        let length = (x * x + y * y + z * z).sqrt();
        if length > 1e-15 && length.is_finite() { [x / length, y / length, z / length] } else { [x, y, z] }
    }
}
