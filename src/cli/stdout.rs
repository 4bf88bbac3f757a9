//! Results on stdout, which may be full or gone: `println!` would panic.

use std::{
    fmt,
    io::{self, Write},
    sync::Mutex,
};

use crate::{Error, Result};

/// The system's error when a line could not be written for the first time.
static FAILURE: Mutex<Option<io::Error>> = Mutex::new(None);

/// Writes a line; see the macro `answer`.
pub(super) fn line(text: fmt::Arguments<'_>) {
    let Ok(mut failure) = FAILURE.lock() else {
        return;
    };
    if failure.is_none() {
        *failure = writeln!(io::stdout(), "{text}").err();
    }
}

/// Reports whether every line was written. A reader that left early (`| head`) has seen what it wanted.
///
/// # Errors
/// [`Error::Io`] for every other reason.
pub(super) fn outcome() -> Result<()> {
    let failure = FAILURE.lock().ok().and_then(|mut failure| failure.take());
    match failure.or_else(|| io::stdout().flush().err()) {
        Some(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::io("write", "standard output", e))
        }
        _ => Ok(()),
    }
}
