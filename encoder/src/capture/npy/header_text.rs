//! The text of a `.npy` header, before a parser sees it.

/// The longest header that is read. NumPy pads short ones to a multiple of 64.
pub(super) const MAX_HEADER: usize = 4_096;
/// Brackets within brackets: a dictionary, and in it the shape.
const MAX_NESTING: usize = 2;
/// Digits of the largest shape there can be, (65535, 65535, 2047, 2047, 3): products of fewer fit in 64 bits.
const MAX_DIGITS: usize = 19;

/// Refuses headers that would keep the parser busy for ever or overflow its arithmetic.
pub(super) fn check_header_text(file: &[u8]) -> Result<(), String> {
    // Magic and version; then the length of the text as u16, or from version 2 on as u32.
    let start = if file.get(6) == Some(&1) { 10 } else { 12 };
    let text = file.get(start..).unwrap_or_default();
    let text = &text[..text.iter().position(|byte| *byte == b'\n').unwrap_or(text.len())];
    if text.len() > MAX_HEADER {
        return Err(format!("a .npy header of more than {MAX_HEADER} bytes"));
    }
    let mut depth = 0_usize;
    for byte in text {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_NESTING {
            return Err("a nested type or shape".to_owned());
        }
    }
    let after = |byte: u8| text.iter().position(|b| *b == byte).unwrap_or(text.len());
    let shape = text.get(after(b'(')..after(b')')).unwrap_or_default();
    if shape.iter().filter(|byte| byte.is_ascii_digit()).count() > MAX_DIGITS {
        return Err(format!("shape {}", String::from_utf8_lossy(shape).trim_start_matches('(')));
    }
    Ok(())
}
