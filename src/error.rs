//! The one error type, and the exit code each kind of error ends the command with.

use std::path::{Path, PathBuf};

/// What went wrong. Every message is one sentence that says what, where, what was expected and what to try.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The request itself makes no sense: an option out of range, two options that exclude each other.
    #[error("{0}")]
    Usage(String),
    /// A file's content is damaged, hostile or inconsistent.
    #[error("{}: {message}", path.display())]
    Input {
        /// The file, or `-` where the bytes came from memory.
        path: PathBuf,
        /// What is wrong, where in the file, and what was expected.
        message: String,
    },
    /// The request is sensible but this version cannot do it.
    #[error("{0}")]
    Unsupported(String),
    /// The operating system refused to read or write.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// "read", "write", "create", ...
        action: &'static str,
        /// The file or folder concerned.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// The result is valid but short of the target, and the caller asked for strictness.
    #[error("{0}")]
    TargetNotReached(String),
    /// A promise this crate makes to itself is broken: a bug.
    #[error("internal error: {0}; please report it with the input and the command line")]
    Internal(String),
    /// The user asked to stop.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

/// `Result` with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// Exit code of the `lodmark` command for this error: 2 usage, 3 bad input, 4 unsupported, 5 I/O,
    /// 6 target not reached, 70 internal, 130 interrupted.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input { .. } => 3,
            Self::Unsupported(_) => 4,
            Self::Io { .. } => 5,
            Self::TargetNotReached(_) => 6,
            Self::Internal(_) => 70,
            Self::Interrupted => 130,
        }
    }

    /// A damaged file: `message` says what, where in the file and what was expected.
    #[must_use]
    pub fn input(path: impl AsRef<Path>, message: impl Into<String>) -> Self {
        Self::Input {
            path: path.as_ref().to_path_buf(),
            message: message.into(),
        }
    }

    /// A refused system call: `action` is a verb such as "read".
    #[must_use]
    pub fn io(action: &'static str, path: impl AsRef<Path>, source: std::io::Error) -> Self {
        Self::Io {
            action,
            path: path.as_ref().to_path_buf(),
            source,
        }
    }
}
