//! JSON that is edited entry by entry: whatever is not set or removed stays as it is written.

use std::fmt;

use serde::{Deserialize, Deserializer, de};
use serde_json::value::RawValue;

use crate::{Error, Result};

/// The members of an object in their order, with the text of their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Members(Vec<(String, String)>);

impl Members {
    /// The members of the object that `text` is.
    pub(super) fn parse(text: &str) -> Result<Self> {
        serde_json::from_str(text).map_err(|e| Error::content(format!("{e} in {text:.40}")))
    }

    pub(super) fn get(&self, name: &str) -> Option<&str> {
        let found = self.0.iter().find(|(n, _)| n == name);
        found.map(|(_, text)| text.as_str())
    }

    /// Gives a member another value, in its place; a new one comes last.
    pub(super) fn set(&mut self, name: &str, text: impl Into<String>) {
        match self.0.iter_mut().find(|(n, _)| n == name) {
            Some((_, value)) => *value = text.into(),
            None => self.0.push((name.into(), text.into())),
        }
    }

    pub(super) fn remove(&mut self, names: &[&str]) {
        self.0.retain(|(n, _)| !names.contains(&n.as_str()));
    }

    /// Names and texts in their order.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes a member out of the object in the member `outer`, and that too where nothing else is in it.
    pub(super) fn remove_within(&mut self, outer: &str, names: &[&str]) -> Result<()> {
        let Some(text) = self.get(outer) else {
            return Ok(());
        };
        let mut inner = Self::parse(text)?;
        inner.remove(names);
        if inner.is_empty() {
            self.remove(&[outer]);
        } else {
            self.set(outer, inner.to_string());
        }
        Ok(())
    }
}

impl From<Vec<(String, String)>> for Members {
    fn from(members: Vec<(String, String)>) -> Self {
        Self(members)
    }
}

impl fmt::Display for Members {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (name, text)) in self.0.iter().enumerate() {
            f.write_str(if i == 0 { "{" } else { "," })?;
            write!(f, "{}:{text}", quoted(name))?;
        }
        f.write_str(if self.0.is_empty() { "{}" } else { "}" })
    }
}

impl<'de> Deserialize<'de> for Members {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> de::Visitor<'de> for Visitor {
            type Value = Members;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: de::MapAccess<'de>>(self, mut map: A) -> Result<Members, A::Error> {
                let mut members = Vec::new();
                while let Some((name, value)) = map.next_entry::<String, Box<RawValue>>()? {
                    members.push((name, value.get().into()));
                }
                Ok(Members(members))
            }
        }
        deserializer.deserialize_map(Visitor)
    }
}

/// The text of every entry of the array that `text` is.
pub(super) fn entries(text: &str) -> Result<Vec<String>> {
    let entries: Vec<Box<RawValue>> =
        serde_json::from_str(text).map_err(|e| Error::content(format!("{e} in {text:.40}")))?;
    Ok(entries.into_iter().map(|e| e.get().into()).collect())
}

/// An array of entries.
pub(super) fn array(entries: &[impl AsRef<str>]) -> String {
    let entries: Vec<&str> = entries.iter().map(AsRef::as_ref).collect();
    format!("[{}]", entries.join(","))
}

/// A string with its quotes.
pub(super) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_edited_stays_as_it_is_written() {
        let mut members = Members::parse(r#"{"a": 1.50, "b":{ "x" : [1, 2] },"c":null}"#).unwrap();
        members.set("c", "7");
        members.remove(&["a"]);
        assert_eq!(members.to_string(), r#"{"b":{ "x" : [1, 2] },"c":7}"#);
        members.remove_within("b", &["x"]).unwrap();
        assert_eq!(members.to_string(), r#"{"c":7}"#);
        assert_eq!(entries("[1.0, {} ]").unwrap(), ["1.0", "{}"]);
    }
}
