//! Words of a text file, with the line of each for messages.

/// Reads words that white space parts, from front to back.
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// Words from the byte `at` on, which lies on line `line`.
    pub(super) fn new(bytes: &'a [u8], at: usize, line: usize) -> Self {
        Self { bytes, at, line }
    }

    /// Number of the line on which the last word lies.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The last `length` bytes that were taken.
    pub(super) fn behind(&self, length: usize) -> &'a [u8] {
        &self.bytes[self.at - length..self.at]
    }

    /// Bytes that are left.
    pub(super) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Goes to the next word or the end.
    pub(super) fn skip_space(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if !b.is_ascii_whitespace() {
                break;
            }
            self.line += usize::from(b == b'\n');
            self.at += 1;
        }
    }

    /// The next word, which stays the next one.
    pub(super) fn peek(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let end = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        (end > 0).then(|| &rest[..end])
    }

    /// The next word.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        self.peek().inspect(|word| self.at += word.len())
    }

    /// Takes the next word and says whether it is this one, in any case of letters.
    pub(super) fn next_is(&mut self, word: &str) -> bool {
        self.next()
            .is_some_and(|found| found.eq_ignore_ascii_case(word.as_bytes()))
    }

    /// Goes to the end of the line: names may hold anything.
    pub(super) fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
    }
}

/// The first forty characters of a word, as a message shows it.
pub(super) fn shown(word: &[u8]) -> String {
    String::from_utf8_lossy(word).chars().take(40).collect()
}
