//! The one error type, and the exit code that each kind of error ends the command with.

use std::path::{Path, PathBuf};

/// The reason why something was not done, by kinds that call for different answers. Every message is one sentence that
/// says what, where, what was expected and what to try.
///
/// | kind | who can mend it | exit code of the command |
/// |---|---|---|
/// | [`Usage`](Error::Usage) | the caller, by another request | 2 |
/// | [`Input`](Error::Input) | whoever made the file or the arrays | 3 |
/// | [`Unsupported`](Error::Unsupported) | a later version, or another format | 4 |
/// | [`Io`](Error::Io) | whoever owns disk and permissions | 5 |
/// | [`TargetNotReached`](Error::TargetNotReached) | the caller, by a looser limit | 6 |
/// | [`Internal`](Error::Internal) | this crate: please report it | 70 |
/// | [`Interrupted`](Error::Interrupted) | nobody: it was asked for | 130 |
///
/// Further kinds may come.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The request itself makes no sense: an option out of range, two options that exclude each other.
    #[error("{0}")]
    Usage(String),
    /// The content of a file, or of arrays in memory, is damaged, hostile or inconsistent.
    #[error("{}: {message}", path.display())]
    Input {
        /// The file, or `-` where the content came from memory.
        path: PathBuf,
        /// The fault, its place in the file, and what was expected.
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
        /// The answer of the operating system.
        source: std::io::Error,
    },
    /// The result is valid but short of the target, and the caller asked for strictness.
    #[error("{0}")]
    TargetNotReached(String),
    /// The caller asked for a proof, and the claim is broken or undecided.
    #[error("{0}")]
    NotProven(String),
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
    /// Exit code of the `lodmark` command for this error: 1 a claim that is not proven, 2 usage, 3 bad input, 4 unsupported, 5 I/O,
    /// 6 target not reached, 70 internal, 130 interrupted.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NotProven(_) => 1,
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

    /// Arrays in memory that are no mesh, or another fault of content without a file.
    #[must_use]
    pub(crate) fn content(message: impl Into<String>) -> Self {
        Self::input("-", message)
    }

    /// The sentence without the path of the file, for a reader that puts its own before it.
    pub(crate) fn message(self) -> String {
        match self {
            Self::Input { message, .. } => message,
            other => other.to_string(),
        }
    }

    /// The same fault where only this crate can have made it: a bug.
    pub(crate) fn internal(self) -> Self {
        Self::Internal(self.message())
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
