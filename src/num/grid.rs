//! [`Grid`]: a rectangle of values, as all images of this crate are.

/// `width * height` values, row by row from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid<T> {
    width: u32,
    height: u32,
    values: Vec<T>,
}

impl<T: Copy> Grid<T> {
    /// A grid filled with one value.
    #[must_use]
    pub fn filled(width: u32, height: u32, value: T) -> Self {
        Self {
            width,
            height,
            values: vec![value; width as usize * height as usize],
        }
    }

    /// A grid of the given values, row by row; `None` where their number is not `width * height`.
    #[must_use]
    pub fn new(width: u32, height: u32, values: Vec<T>) -> Option<Self> {
        (values.len() == width as usize * height as usize).then_some(Self {
            width,
            height,
            values,
        })
    }

    /// Values in a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Values in a column.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All values, row by row.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, row by row.
    #[must_use]
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The value at column `x` of row `y`.
    ///
    /// # Panics
    /// Outside the grid.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> T {
        assert!(
            x < self.width && y < self.height,
            "({x}, {y}) in {} x {}",
            self.width,
            self.height
        );
        self.values[y as usize * self.width as usize + x as usize]
    }

    /// A grid of the same size with `f` of every value.
    #[must_use]
    pub fn map<U>(&self, f: impl FnMut(T) -> U) -> Grid<U> {
        Grid {
            width: self.width,
            height: self.height,
            values: self.values.iter().copied().map(f).collect(),
        }
    }
}
