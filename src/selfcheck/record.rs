//! The file of goldens: a line `NAME VALUE` for each, sorted by name; lines that begin with `#` say what this is.

use std::{collections::BTreeMap, fmt, path::Path};

use serde::Serialize;

use super::{Group, Item};
use crate::{Error, Result};

const HEADER: &str = "\
# What lodmark computes, to the last bit: `lodmark golden check` compares, `lodmark golden bless` rewrites.
# A line changes only together with the reason why the result should change.
";

/// Names with their values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Record {
    values: BTreeMap<String, String>,
}

/// A golden that does not hold.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mismatch {
    /// The golden's name.
    pub name: String,
    /// The recorded value; `None` where there is none.
    pub expected: Option<String>,
    /// The value that was computed; `None` where no case has this name.
    pub actual: Option<String>,
    /// Findings of a comparison of pixels, where there is a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels: Option<String>,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.expected, &self.actual) {
            (Some(expected), Some(actual)) => {
                write!(f, "{}: expected {expected}, found {actual}", self.name)?;
            }
            (None, Some(actual)) => write!(
                f,
                "{}: no golden, found {actual}; `lodmark golden bless` records it",
                self.name
            )?,
            (expected, None) => write!(
                f,
                "{}: no case has this name, expected {}; `lodmark golden bless` forgets it",
                self.name,
                expected.as_deref().unwrap_or("nothing")
            )?,
        }
        match &self.pixels {
            Some(pixels) => write!(f, " ({pixels})"),
            None => Ok(()),
        }
    }
}

impl Record {
    /// The record of the items.
    pub fn of(items: &[Item]) -> Self {
        let pair = |i: &Item| (i.name.clone(), i.value.clone());
        Self {
            values: items.iter().map(pair).collect(),
        }
    }

    /// The record that this program was built with.
    ///
    /// # Errors
    /// [`Error::Internal`]: the program was built from a damaged file.
    pub fn embedded() -> Result<Self> {
        Self::parse(include_str!("../../golden/golden.txt"), "golden.txt").map_err(Error::internal)
    }

    /// Reads the text of a record; `path` is for messages.
    ///
    /// # Errors
    /// [`Error::Input`] that names the line that is no `NAME VALUE`, or repeats a name.
    pub fn parse(text: &str, path: impl AsRef<Path>) -> Result<Self> {
        let wrong = |message: String| Error::input(path.as_ref(), message);
        let mut values = BTreeMap::new();
        for (i, line) in text.lines().enumerate() {
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let number = i + 1;
            let Some((name, value)) = line.split_once(' ') else {
                return Err(wrong(format!(
                    "line {number} is `{line}`; expected NAME VALUE"
                )));
            };
            if values.insert(name.to_string(), value.to_string()).is_some() {
                return Err(wrong(format!("line {number} repeats `{name}`")));
            }
        }
        Ok(Self { values })
    }

    /// The text of the record: equal records give equal bytes.
    pub fn to_text(&self) -> String {
        let mut text = HEADER.to_string();
        for (name, value) in &self.values {
            text.extend([name, " ", value, "\n"]);
        }
        text
    }

    /// Number of goldens.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// True without any.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Names and values, sorted.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.values.iter().map(|(n, v)| (n.as_str(), v.as_str()))
    }

    /// The goldens whose names begin with `group/`.
    pub fn group(&self, group: &str) -> Self {
        let mut values = self.values.clone();
        let first = |name: &str| name.split_once('/').map(|(first, _)| first.to_string());
        values.retain(|name, _| first(name).as_deref() == Some(group));
        Self { values }
    }

    /// The goldens of some groups.
    pub fn of_groups(&self, groups: &[&Group]) -> Self {
        let mut values = BTreeMap::new();
        for group in groups {
            values.extend(self.group(group.name).values);
        }
        Self { values }
    }

    /// Every golden that the items do not reproduce, every item without a golden, and every golden without an item;
    /// sorted by name.
    pub fn compare(&self, items: &[Item]) -> Vec<Mismatch> {
        let found = Self::of(items).values;
        let names: std::collections::BTreeSet<&String> =
            self.values.keys().chain(found.keys()).collect();
        names
            .into_iter()
            .map(|name| (name, self.values.get(name), found.get(name)))
            .filter(|(_, expected, actual)| expected != actual)
            .map(|(name, expected, actual)| Mismatch {
                name: name.clone(),
                expected: expected.cloned(),
                actual: actual.cloned(),
                pixels: None,
            })
            .collect()
    }
}
