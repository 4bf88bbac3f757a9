//! Options of a recorded run that its levels need, too.

use serde::de::DeserializeOwned;

use crate::{Error, Result, collapse::History};

/// The option `name` of a recorded run; `None` where it was left to the way of runs before there was a choice.
///
/// # Errors
/// [`Error::Input`] for a value that this version does not know.
pub(super) fn recorded<T: DeserializeOwned>(history: &History, name: &str) -> Result<Option<T>> {
    let options = &history.header().options;
    let Ok(serde_json::Value::Object(options)) = serde_json::from_str(options) else {
        return Ok(None);
    };
    let Some(value) = options.get(name) else {
        return Ok(None);
    };
    serde_json::from_value(value.clone()).map(Some).map_err(|_| {
        Error::input(
            "-",
            format!("the history was recorded with the {name} {value}, which this version does not know"),
        )
    })
}
