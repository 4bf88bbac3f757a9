//! Accessors: typed elements in buffer views.

use super::{
    buffers::Views,
    document::{Accessor, Document, named},
    wrong,
};
use crate::Result;

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// The type that a number of the specification stands for.
    pub(super) fn of(number: u32) -> Option<Self> {
        Some(match number {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Bytes of a component.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The largest value of an integer type, which stands for 1 where it is normalized.
    pub(super) fn one(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 => 4_294_967_295.0,
            Self::F32 => 1.0,
        }
    }

    /// The number in the first bytes; 0 where there are too few.
    fn number(self, bytes: &[u8]) -> f64 {
        let two = bytes.first_chunk().copied().unwrap_or_default();
        let four = bytes.first_chunk().copied().unwrap_or_default();
        match self {
            Self::I8 => bytes.first().map_or(0.0, |&b| f64::from(b as i8)),
            Self::U8 => bytes.first().map_or(0.0, |&b| f64::from(b)),
            Self::I16 => f64::from(i16::from_le_bytes(two)),
            Self::U16 => f64::from(u16::from_le_bytes(two)),
            Self::U32 => f64::from(u32::from_le_bytes(four)),
            Self::F32 => f64::from(f32::from_le_bytes(four)),
        }
    }
}

/// The layout of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Columns of a matrix; 1 for scalars and vectors.
    columns: usize,
    /// Components of a column.
    rows: usize,
}

impl Shape {
    /// The layout that a name of the specification stands for.
    pub(super) fn of(name: &str) -> Option<Self> {
        let (columns, rows) = match name {
            "SCALAR" => (1, 1),
            "VEC2" => (1, 2),
            "VEC3" => (1, 3),
            "VEC4" => (1, 4),
            "MAT2" => (2, 2),
            "MAT3" => (3, 3),
            "MAT4" => (4, 4),
            _ => return None,
        };
        Some(Self { columns, rows })
    }

    /// Components of an element.
    pub(super) fn width(self) -> usize {
        self.columns * self.rows
    }
}

/// The elements of an accessor, checked against the bytes behind them.
pub(super) struct Elements<'a> {
    /// Number of elements.
    pub count: usize,
    pub component: Component,
    pub shape: Shape,
    /// Whether integers stand for numbers in [0, 1] or [-1, 1].
    pub normalized: bool,
    /// Bytes from the first element on, and from one element to the next; without them every element is 0.
    base: Option<(&'a [u8], usize)>,
    /// Elements that have other values, in increasing order, and these.
    sparse: Vec<u32>,
    values: &'a [u8],
}

impl<'a> Elements<'a> {
    /// Opens an accessor. O(elements that are sparse).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) where it goes beyond its view, or its sparse elements are out of order.
    pub(super) fn open(document: &Document, views: &'a Views<'_>, index: usize) -> Result<Self> {
        let accessor = named(&document.accessors, index, "accessors", || {
            "the document".into()
        })?;
        let here = |message: String| wrong(format!("accessors[{index}]: {message}"));
        let component = Component::of(accessor.component_type).ok_or_else(|| {
            here(format!(
                "unknown component type {}",
                accessor.component_type
            ))
        })?;
        let shape = Shape::of(&accessor.shape)
            .ok_or_else(|| here(format!("unknown type `{}`", accessor.shape)))?;
        if accessor.count > u32::MAX as usize {
            return Err(here(format!("{} elements are too many", accessor.count)));
        }
        let mut elements = Self {
            count: accessor.count,
            component,
            shape,
            normalized: accessor.normalized && component != Component::F32,
            base: None,
            sparse: Vec::new(),
            values: &[],
        };
        let size = elements.size();
        if let Some(view) = accessor.buffer_view {
            let stride = document
                .views
                .get(view)
                .and_then(|v| v.byte_stride)
                .unwrap_or(size);
            if stride < size {
                return Err(here(format!(
                    "elements of {size} bytes stand {stride} bytes apart; expected no overlap"
                )));
            }
            let bytes = views.bytes(view)?;
            let bytes = within(bytes, accessor.byte_offset, accessor.count, stride, size)
                .map_err(|message| here(format!("bufferViews[{view}]: {message}")))?;
            elements.base = Some((bytes, stride));
        }
        elements.add_sparse(accessor, views, &here)?;
        Ok(elements)
    }

    fn add_sparse(
        &mut self,
        accessor: &Accessor,
        views: &'a Views<'_>,
        here: &dyn Fn(String) -> crate::Error,
    ) -> Result<()> {
        let Some(sparse) = &accessor.sparse else {
            return Ok(());
        };
        let component = match Component::of(sparse.indices.component_type) {
            Some(component @ (Component::U8 | Component::U16 | Component::U32)) => component,
            _ => {
                return Err(here(format!(
                    "sparse indices of component type {}; expected 5121, 5123 or 5125",
                    sparse.indices.component_type
                )));
            }
        };
        let (count, size, step) = (sparse.count, self.size(), component.size());
        views.spend(count)?;
        let (of_indices, of_values) = (&sparse.indices, &sparse.values);
        let indices = within(
            views.bytes(of_indices.buffer_view)?,
            of_indices.byte_offset,
            count,
            step,
            step,
        )
        .map_err(|message| here(format!("sparse indices: {message}")))?;
        self.values = within(
            views.bytes(of_values.buffer_view)?,
            of_values.byte_offset,
            count,
            size,
            size,
        )
        .map_err(|message| here(format!("sparse values: {message}")))?;
        let numbers = indices.chunks_exact(step).take(count);
        self.sparse = numbers
            .map(|bytes| component.number(bytes) as u32)
            .collect();
        if let Some(at) = self.sparse.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(here(format!(
                "sparse index {} is {} after {}; expected increasing ones",
                at + 1,
                self.sparse[at + 1],
                self.sparse[at]
            )));
        }
        match self.sparse.last() {
            Some(&last) if last as usize >= self.count => Err(here(format!(
                "a sparse index is {last}, but there are {} elements",
                self.count
            ))),
            _ => Ok(()),
        }
    }

    /// Components of an element.
    pub(super) fn width(&self) -> usize {
        self.shape.width()
    }

    /// Bytes of an element; columns of matrices begin at multiples of 4.
    pub(super) fn size(&self) -> usize {
        self.shape.columns * self.column()
    }

    fn column(&self) -> usize {
        let bytes = self.shape.rows * self.component.size();
        if self.shape.columns == 1 {
            bytes
        } else {
            bytes.next_multiple_of(4)
        }
    }

    /// The stored bytes of an element, if it has any; without them all its components are 0.
    ///
    /// # Panics
    /// Where there is no such element.
    pub(super) fn bytes(&self, element: usize) -> Option<&'a [u8]> {
        if let Ok(at) = self.sparse.binary_search(&(element as u32)) {
            return Some(&self.values[at * self.size()..][..self.size()]);
        }
        let (bytes, stride) = self.base?;
        Some(&bytes[element * stride..][..self.size()])
    }

    /// Writes the components of an element into the first places of `into`, normalized ones divided.
    ///
    /// # Panics
    /// Where there is no such element, or fewer places than components.
    pub(super) fn read(&self, element: usize, into: &mut [f64]) {
        let Some(bytes) = self.bytes(element) else {
            return into[..self.width()].fill(0.0);
        };
        let columns = bytes.chunks_exact(self.column());
        for (column, into) in columns.zip(into.chunks_mut(self.shape.rows)) {
            let components = column.chunks_exact(self.component.size());
            for (component, x) in components.zip(into) {
                *x = self.component.number(component);
                if self.normalized {
                    *x = (*x / self.component.one()).max(-1.0);
                }
            }
        }
    }
}

/// The bytes of `count` elements of `size` bytes, `stride` bytes apart.
fn within(
    bytes: &[u8],
    offset: usize,
    count: usize,
    stride: usize,
    size: usize,
) -> Result<&[u8], String> {
    let length = match count.checked_sub(1) {
        None => Some(0),
        Some(steps) => steps
            .checked_mul(stride)
            .and_then(|start| start.checked_add(size)),
    };
    let found = length.and_then(|length| bytes.get(offset..offset.checked_add(length)?));
    found.ok_or_else(|| {
        format!(
            "{count} elements of {size} bytes, {stride} bytes apart, from byte {offset} on go beyond the {} bytes of the \
             view",
            bytes.len()
        )
    })
}

/// The numbers of an accessor of indices.
///
/// # Errors
/// As [`Elements::open`]; [`Error::Input`](crate::Error::Input) where it does not hold indices.
pub(super) fn indices(document: &Document, views: &Views<'_>, index: usize) -> Result<Vec<u32>> {
    let elements = Elements::open(document, views, index)?;
    let is_index = matches!(
        elements.component,
        Component::U8 | Component::U16 | Component::U32
    );
    if !is_index || elements.width() != 1 || elements.normalized {
        return Err(wrong(format!(
            "accessors[{index}] cannot be indices; expected unsigned integers of type SCALAR"
        )));
    }
    views.spend(elements.count)?;
    let mut found = Vec::with_capacity(elements.count);
    for element in 0..elements.count {
        let mut number = [0.0];
        elements.read(element, &mut number);
        found.push(number[0] as u32);
    }
    Ok(found)
}
