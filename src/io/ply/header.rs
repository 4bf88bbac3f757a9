//! The header of a PLY file: its elements, their properties, and where the body begins.

/// Storage of the numbers of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    const fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// One number, or a count and that many numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub shape: Shape,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Fewest bytes an item takes: in text a digit and a separator per number.
    pub(super) fn smallest_size(&self, storage: Storage) -> u64 {
        self.properties
            .iter()
            .map(|p| match (storage, p.shape) {
                (Storage::Ascii, _) => 2,
                (_, Shape::Scalar(kind) | Shape::List { count: kind, .. }) => kind.size() as u64,
            })
            .sum()
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub storage: Storage,
    pub elements: Vec<Element>,
    /// Offset of the first byte of the body.
    pub body: usize,
    /// Number of the line on which the body begins, from 1.
    pub body_line: usize,
}

/// Most elements and most properties of an element: more are a sign of damage, and would cost more than they hold.
const MOST: usize = 1000;

/// Reads the header, or says on which line it is wrong.
pub(super) fn parse(bytes: &[u8]) -> Result<Header, String> {
    // With CR alone at the end of the first line, a byte 10 after `end_header` belongs to the body.
    let old_mac = bytes.starts_with(b"ply\r") && !bytes.starts_with(b"ply\r\n");
    let (mut at, mut line) = (0, 0);
    let mut declared = Declared::default();
    loop {
        let Some((text, next)) = header_line(bytes, at, old_mac) else {
            return Err(format!(
                "line {}: the header does not end; expected a line `end_header`",
                line + 1
            ));
        };
        at = next;
        line += 1;
        let ended = declared.line(line, text).map_err(|expected| {
            let shown: String = String::from_utf8_lossy(text).chars().take(60).collect();
            format!("line {line}: found `{shown}`; expected {expected}")
        })?;
        if let Some(storage) = ended {
            return Ok(Header {
                storage,
                elements: declared.elements,
                body: at,
                body_line: line + 1,
            });
        }
    }
}

/// The declarations of the lines so far.
#[derive(Default)]
struct Declared {
    storage: Option<Storage>,
    elements: Vec<Element>,
}

impl Declared {
    /// Takes in a line; the last one answers how numbers are stored, a wrong one what was expected.
    fn line(&mut self, number: usize, text: &[u8]) -> Result<Option<Storage>, &'static str> {
        let text = match std::str::from_utf8(text) {
            Ok(text) => text.trim(),
            Err(_) if text.starts_with(b"comment") || text.starts_with(b"obj_info") => {
                return Ok(None);
            }
            Err(_) => return Err("a header line in ASCII"),
        };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err("`ply`, the mark of a PLY file"),
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, version] => self.format(name, version)?,
            ["element", name, count] => self.element(name, count)?,
            ["property", ref rest @ ..] => self.property(rest)?,
            ["end_header"] => {
                let storage = self.storage;
                return storage
                    .map(Some)
                    .ok_or("a `format` line before the end of the header");
            }
            _ => return Err("format, element, property, comment, obj_info or end_header"),
        }
        Ok(None)
    }

    fn format(&mut self, name: &str, version: &str) -> Result<(), &'static str> {
        let found = match name {
            "ascii" => Storage::Ascii,
            "binary_little_endian" => Storage::LittleEndian,
            "binary_big_endian" => Storage::BigEndian,
            _ => return Err("the format ascii, binary_little_endian or binary_big_endian"),
        };
        if version != "1.0" {
            return Err("version 1.0, the only one");
        }
        if self.storage.replace(found).is_some() {
            return Err("one `format` line only");
        }
        Ok(())
    }

    fn element(&mut self, name: &str, count: &str) -> Result<(), &'static str> {
        let count = count
            .parse()
            .map_err(|_| "`element NAME COUNT` with a whole number that is not negative")?;
        if self.elements.iter().any(|e| e.name == name) {
            return Err("every element once");
        }
        if self.elements.len() == MOST {
            return Err("at most 1000 elements");
        }
        self.elements.push(Element {
            name: name.into(),
            count,
            properties: Vec::new(),
        });
        Ok(())
    }

    fn property(&mut self, words: &[&str]) -> Result<(), &'static str> {
        let property = property(words).ok_or(
            "`property TYPE NAME` or `property list INTEGER-TYPE TYPE NAME`, with a type such as uchar, int, float or \
             double",
        )?;
        match self.elements.last_mut() {
            Some(element) if element.properties.len() == MOST => {
                Err("at most 1000 properties of an element")
            }
            Some(element) => {
                element.properties.push(property);
                Ok(())
            }
            None => Err("an `element` line before its properties"),
        }
    }
}

/// The line that begins at `at` without its end, and where the next one begins. Lines end in LF, CR LF or CR.
fn header_line(bytes: &[u8], at: usize, old_mac: bool) -> Option<(&[u8], usize)> {
    let rest = &bytes[at..];
    let end = rest.iter().position(|&b| b == b'\n' || b == b'\r')?;
    let skip = if !old_mac && rest[end..].starts_with(b"\r\n") {
        2
    } else {
        1
    };
    Some((&rest[..end], at + end + skip))
}

fn property(words: &[&str]) -> Option<Property> {
    let (shape, name) = match *words {
        ["list", count, item, name] => {
            let (count, item) = (Scalar::parse(count)?, Scalar::parse(item)?);
            if !count.is_integer() {
                return None;
            }
            (Shape::List { count, item }, name)
        }
        [kind, name] => (Shape::Scalar(Scalar::parse(kind)?), name),
        _ => return None,
    };
    Some(Property {
        name: name.into(),
        shape,
    })
}
