//! Arrays of two to four elements, mapped without what `array::map` compiles for every closure: 290 lines of LLVM each.

/// An array that is mapped element by element.
pub(crate) trait Each: Sized {
    /// The type of an element.
    type Item;
    /// The array of the results.
    type Mapped<U>;

    /// Returns `f(element)` for every element, asked for in order.
    fn each<U>(self, f: impl FnMut(Self::Item) -> U) -> Self::Mapped<U>;
}

impl<T> Each for [T; 2] {
    type Item = T;
    type Mapped<U> = [U; 2];

    #[inline]
    fn each<U>(self, mut f: impl FnMut(T) -> U) -> [U; 2] {
        let [a, b] = self;
        [f(a), f(b)]
    }
}

impl<T> Each for [T; 3] {
    type Item = T;
    type Mapped<U> = [U; 3];

    #[inline]
    fn each<U>(self, mut f: impl FnMut(T) -> U) -> [U; 3] {
        let [a, b, c] = self;
        [f(a), f(b), f(c)]
    }
}

impl<T> Each for [T; 4] {
    type Item = T;
    type Mapped<U> = [U; 4];

    #[inline]
    fn each<U>(self, mut f: impl FnMut(T) -> U) -> [U; 4] {
        let [a, b, c, d] = self;
        [f(a), f(b), f(c), f(d)]
    }
}
