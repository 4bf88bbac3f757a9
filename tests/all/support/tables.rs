//! Tables of numbers.

/// The rows of a table: one a line, their numbers apart by blanks.
pub(crate) fn rows<const N: usize>(table: &str) -> Vec<[f64; N]> {
    let row = |line: &str| {
        let numbers = line.split_whitespace().map(|x| x.parse().expect(x));
        let numbers: Vec<f64> = numbers.collect();
        numbers.try_into().expect("a number for every column")
    };
    let lines = table.lines().filter(|line| !line.trim().is_empty());
    lines.map(row).collect()
}
