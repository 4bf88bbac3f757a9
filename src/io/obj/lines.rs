//! Lines and words of OBJ text.

use std::borrow::Cow;

/// Lines with their numbers from 1; a backslash at the end joins a line to the next.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut rest = bytes;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let first = number + 1;
        let mut joined: Option<Vec<u8>> = None;
        loop {
            number += 1;
            let (line, after) = match rest.iter().position(|&b| b == b'\n') {
                Some(end) => (&rest[..end], &rest[end + 1..]),
                None => (rest, &rest[rest.len()..]),
            };
            rest = after;
            let line = line.trim_ascii();
            let (line, continues) = match line.strip_suffix(b"\\") {
                Some(line) if !rest.is_empty() && !line.starts_with(b"#") => (line, true),
                _ => (line, false),
            };
            if continues || joined.is_some() {
                let joined = joined.get_or_insert_default();
                joined.extend_from_slice(line);
                joined.push(b' ');
            }
            if !continues {
                return Some((first, joined.map_or(Cow::Borrowed(line), Cow::Owned)));
            }
        }
    })
}

/// The first word of a line, and the rest without a comment.
pub(super) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii();
    let end = line
        .iter()
        .position(u8::is_ascii_whitespace)
        .unwrap_or(line.len());
    (&line[..end], line[end..].trim_ascii())
}

/// The words of a line up to a comment.
pub(super) fn words(rest: &[u8]) -> impl Iterator<Item = &[u8]> {
    let end = rest.iter().position(|&b| b == b'#').unwrap_or(rest.len());
    rest[..end]
        .split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// A number in text.
pub(super) fn float(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
