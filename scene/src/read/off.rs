//! Meshes from Object File Format (Geomview), in text.

use glam::{DVec2, DVec3};

use super::raw::{Raw, Result};
use super::text::{Lines, number, numbers, quoted, without_mark, words};

/// Reads the bytes of an .off file.
pub(super) fn read(bytes: &[u8]) -> Result<Raw> {
    let text = without_mark(bytes);
    let mut lines = Lines::new(&text)
        .map(|(number, line)| (number, words(line).collect::<Vec<_>>()))
        .filter(|(_, words)| !words.is_empty());
    let (mut line, mut first) = lines.next().ok_or("an empty file; expected OFF")?;
    // What a vertex has beside its position: texture coordinates, a colour, a normal, a fourth coordinate.
    let key = first[0];
    let at = key.windows(3).position(|letters| letters == b"OFF");
    let flags = at.map_or(&b""[..], |at| &key[..at]);
    if let Some(at) = at {
        // Some write the first count right after it.
        first[0] = &key[at + 3..];
        first.retain(|word| !word.is_empty());
    }
    if first.first() == Some(&&b"BINARY"[..]) {
        return Err("a binary OFF file; expected one in text".to_owned());
    }
    if flags.contains(&b'n') || flags.iter().any(|flag| !b"STCN4".contains(flag)) {
        return Err(format!("line {line}: {}; expected OFF, in three dimensions", quoted(key)));
    }
    if first.is_empty() {
        (line, first) = lines.next().ok_or("no counts; expected a line of the numbers of vertices, faces and edges")?;
    }
    let mut counts = first.iter().map(|word| std::str::from_utf8(word).ok()?.parse::<usize>().ok());
    let (Some(Some(vertices)), Some(Some(faces))) = (counts.next(), counts.next()) else {
        return Err(format!(
            "line {line}: {}; expected OFF, or the numbers of vertices, faces and edges",
            quoted(first[0])
        ));
    };

    let mut out = Raw::default();
    for k in 0..vertices {
        let (line, words) = lines.next().ok_or_else(|| format!("ends after vertex {k} of {vertices}"))?;
        add_vertex(flags, &words, &mut out).map_err(|error| format!("line {line}: {error}"))?;
    }
    let mut small = 0;
    for k in 0..faces {
        let (line, mut words) = lines.next().ok_or_else(|| format!("ends after face {k} of {faces}"))?;
        join(&mut words, &mut lines);
        let corners = corners(&words, vertices).map_err(|error| format!("line {line}: {error}"))?;
        small += usize::from(corners.len() < 3);
        out.add_polygon(&corners).map_err(|error| format!("line {line}: {error}"))?;
    }
    out.leave_out(small, "faces of fewer than three corners");
    Ok(out)
}

fn add_vertex(flags: &[u8], words: &[&[u8]], out: &mut Raw) -> Result<()> {
    let mut rest = words.iter().copied();
    let few = "a vertex of too few numbers";
    let position = DVec3::from(numbers(&mut rest)?.ok_or(few)?);
    let weight = if flags.contains(&b'4') { numbers(&mut rest)?.map(|[weight]| weight).ok_or(few)? } else { 1.0 };
    out.positions.push(if weight == 0.0 { position } else { position / weight });
    if flags.contains(&b'N') {
        out.normals.push(numbers(&mut rest)?.map(DVec3::from).ok_or(few)?.as_vec3());
    }
    if flags.starts_with(b"ST") {
        // After the colour, which has three numbers or four.
        let [.., u, v] = words else {
            return Err(few.to_owned());
        };
        let [u, v] = [u, v].map(|word| number(word).unwrap_or(f64::NAN));
        out.uvs.push(DVec2::new(u, v).as_vec2());
    }
    Ok(())
}

/// Adds the lines that a face goes on in, as some write it; with these it has no more words than its corners take.
fn join<'a>(words: &mut Vec<&'a [u8]>, lines: &mut (impl Iterator<Item = (usize, Vec<&'a [u8]>)> + Clone)) {
    let need = words.first().and_then(|word| index(word)).map_or(0, |count| 1 + count as usize);
    if words.len() >= need {
        return;
    }
    let (mut joined, mut after) = (words.clone(), lines.clone());
    while joined.len() < need
        && let Some((_, more)) = after.next()
    {
        joined.extend(more);
    }
    if joined.len() == need {
        (*words, *lines) = (joined, after);
    }
}

fn index(word: &[u8]) -> Option<u32> {
    std::str::from_utf8(word).ok().and_then(|word| word.parse().ok())
}

/// Corners of a face: their number, their vertices, and what may follow: a colour.
fn corners(words: &[&[u8]], vertices: usize) -> Result<Vec<u32>> {
    let count = words.first().and_then(|word| index(word)).ok_or("a face without a number of corners")?;
    let named = usize::try_from(count).ok().and_then(|count| words.get(1..=count));
    let named = named.ok_or_else(|| format!("a face of {count} corners that names {}", words.len() - 1))?;
    let vertex = |word: &&[u8]| {
        let vertex = index(word).filter(|vertex| (*vertex as usize) < vertices);
        vertex.ok_or_else(|| format!("a face names vertex {}; there are {vertices}, counted from 0", quoted(word)))
    };
    named.iter().map(vertex).collect()
}
