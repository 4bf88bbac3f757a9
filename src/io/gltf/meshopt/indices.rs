//! Triangle lists (mode 1) and index sequences (mode 2).
//!
//! | triangle list | bytes | index sequence | bytes |
//! |---|---|---|---|
//! | `0xe1` | 1 | `0xd1` | 1 |
//! | a code for every triangle | `count / 3` | a number for every index | 1 to 5 each |
//! | numbers and bytes that codes ask for | | | |
//! | a table of 16 pairs of nibbles | 16 | reserved | 4 |
//!
//! Numbers are unsigned LEB128 of at most 5 bytes; all arithmetic wraps at 32 bits. An index of 16 bits keeps the low
//! half of what was decoded.

use crate::encode::byte_cursor::ByteCursor;

/// Decodes `count` indices of a triangle list, a multiple of 3, into `stride` bytes each, 2 or 4.
pub(super) fn triangles(count: usize, stride: usize, stream: &[u8]) -> Result<Vec<u8>, String> {
    let codes = count / 3;
    let parts = super::parts(stream, [0xe1], |_| TABLE, |_| codes, count)?;
    check_table(parts.tail, parts.payload_end)?;
    let mut indices = super::room(count, stride)?;
    let mut state = Triangles {
        data: ByteCursor::new(&stream[..parts.payload_end], 1 + codes),
        table: parts.tail,
        next: 0,
        last: 0,
        edges: Queue::default(),
        vertices: Queue::default(),
    };
    for (at, &code) in (1..).zip(&stream[1..=codes]) {
        let triangle = state
            .triangle(code)
            .map_err(|missing| state.explain(missing, at, code, codes))?;
        for index in triangle {
            push(&mut indices, index, stride);
        }
    }
    super::all_taken(state.data.offset(), parts.payload_end)?;
    Ok(indices)
}

/// Decodes `count` indices of a sequence into `stride` bytes each, 2 or 4.
pub(super) fn sequence(count: usize, stride: usize, stream: &[u8]) -> Result<Vec<u8>, String> {
    let parts = super::parts(stream, [0xd1], |_| 4, |_| count, count)?;
    let mut indices = super::room(count, stride)?;
    let mut cursor = ByteCursor::new(&stream[..parts.payload_end], 1);
    let mut last = [0_u32; 2];
    for i in 0..count {
        let at = cursor.offset();
        let value = number(&mut cursor).ok_or_else(|| {
            format!("byte {at}: index {i} of {count} has no end; expected a number of 1 to 5 bytes before the tail")
        })?;
        let baseline = &mut last[(value & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(value >> 1));
        push(&mut indices, *baseline, stride);
    }
    super::all_taken(cursor.offset(), parts.payload_end)?;
    Ok(indices)
}

fn push(indices: &mut Vec<u8>, index: u32, stride: usize) {
    indices.extend_from_slice(&index.to_le_bytes()[..stride]);
}

/// A number of 1 to 5 bytes, of which the last has no high bit; bits beyond the 32nd are dropped.
fn number(cursor: &mut ByteCursor<'_>) -> Option<u32> {
    let mut value = 0;
    for shift in [0, 7, 14, 21, 28] {
        let [byte] = cursor.array()?;
        value |= u32::from(byte & 127) << shift;
        if byte < 128 {
            return Some(value);
        }
    }
    None
}

/// The difference behind a zigzag code: 0, -1, 1, -2, ...
fn unzigzag(code: u32) -> u32 {
    (code >> 1) ^ 0_u32.wrapping_sub(code & 1)
}

/// Bytes of the table behind the numbers of a triangle list.
const TABLE: usize = 16;

/// Codes 0xf0 to 0xfd name entries of the table; an entry cannot ask for a number, and those of 0xfe and 0xff are zero.
fn check_table(table: &[u8], at: usize) -> Result<(), String> {
    for (i, &entry) in table.iter().enumerate() {
        let expected = if i >= 14 && entry != 0 {
            "zero"
        } else if entry >> 4 == 15 || entry & 15 == 15 {
            "halves below 0xf"
        } else {
            continue;
        };
        return Err(format!(
            "byte {}: entry {i} of the table is {entry:#04x}; expected {expected}",
            at + i
        ));
    }
    Ok(())
}

/// The last 16 of what was pushed.
#[derive(Default)]
struct Queue<T> {
    entries: [T; 16],
    pushed: usize,
}

impl<T: Copy> Queue<T> {
    fn push(&mut self, entry: T) {
        self.entries[self.pushed % 16] = entry;
        self.pushed += 1;
    }

    /// The entry before `back` (below 16) later ones.
    fn get(&self, back: u8) -> Option<T> {
        let at = self.pushed.checked_sub(1 + usize::from(back))?;
        Some(self.entries[at % 16])
    }
}

/// Data that a code asks for and the stream does not have.
enum Missing {
    /// An entry of the queue of edges.
    Edge(u8),
    /// An entry of the queue of vertices.
    Vertex(u8),
    /// A byte, or a number of at most 5 bytes.
    Number,
}

/// A triangle list while it is decoded.
struct Triangles<'a> {
    /// Numbers and bytes that codes ask for.
    data: ByteCursor<'a>,
    table: &'a [u8],
    /// The least index that was not seen.
    next: u32,
    /// The index that the last number gave.
    last: u32,
    edges: Queue<[u32; 2]>,
    vertices: Queue<u32>,
}

impl Triangles<'_> {
    fn triangle(&mut self, code: u8) -> Result<[u32; 3], Missing> {
        let (high, low) = (code >> 4, code & 15);
        match (high, low) {
            (15, 14..) => {
                let [halves] = self.data.array().ok_or(Missing::Number)?;
                if halves == 0 {
                    self.next = 0;
                }
                self.three(if low == 14 { 0 } else { 15 }, halves)
            }
            (15, _) => self.three(0, self.table[usize::from(low)]),
            _ => self.at_edge(high, low),
        }
    }

    /// A triangle at an edge of an earlier one.
    fn at_edge(&mut self, edge: u8, third: u8) -> Result<[u32; 3], Missing> {
        let [a, b] = self.edges.get(edge).ok_or(Missing::Edge(edge))?;
        let c = match third {
            0 => self.unseen(),
            1..=12 => self.vertices.get(third).ok_or(Missing::Vertex(third))?,
            13 => self.moved(u32::MAX),
            14 => self.moved(1),
            _ => self.numbered()?,
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if !(1..=12).contains(&third) {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    /// A triangle whose first corner is `first`, 0 or 15, and whose others are the high and the low half of `halves`, as
    /// [`corner`](Self::corner) takes them.
    fn three(&mut self, first: u8, halves: u8) -> Result<[u32; 3], Missing> {
        let corners = [first, halves >> 4, halves & 15];
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            *index = self.corner(corner)?;
        }
        let [a, b, c] = triangle;
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        for (index, corner) in triangle.into_iter().zip(corners) {
            if corner == 0 || corner == 15 {
                self.vertices.push(index);
            }
        }
        Ok(triangle)
    }

    /// The next index not seen (0), a number (15), or one from the queue, whose latest entry is 1.
    fn corner(&mut self, corner: u8) -> Result<u32, Missing> {
        match corner {
            0 => Ok(self.unseen()),
            15 => self.numbered(),
            _ => self
                .vertices
                .get(corner - 1)
                .ok_or(Missing::Vertex(corner - 1)),
        }
    }

    fn unseen(&mut self) -> u32 {
        let index = self.next;
        self.next = index.wrapping_add(1);
        index
    }

    fn numbered(&mut self) -> Result<u32, Missing> {
        let code = number(&mut self.data).ok_or(Missing::Number)?;
        Ok(self.moved(unzigzag(code)))
    }

    fn moved(&mut self, by: u32) -> u32 {
        self.last = self.last.wrapping_add(by);
        self.last
    }

    fn explain(&self, missing: Missing, at: usize, code: u8, codes: usize) -> String {
        let place = format!(
            "byte {at}: code {code:#04x} of triangle {} of {codes}",
            at - 1
        );
        match missing {
            Missing::Edge(back) => format!(
                "{place} names the edge before {back} later ones; expected one of the {} so far",
                self.edges.pushed
            ),
            Missing::Vertex(back) => format!(
                "{place} names the vertex before {back} later ones; expected one of the {} so far",
                self.vertices.pushed
            ),
            Missing::Number => format!(
                "{place} asks for more than there is before byte {}; expected a byte or a number of 1 to 5 bytes",
                self.data.offset()
            ),
        }
    }
}
