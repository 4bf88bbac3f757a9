//! Running the command as a user does.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Output},
};

use lodmark::{io, mesh::Mesh};
use tempfile::TempDir;

/// A folder below `target` that goes away.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("target is writable")
}

/// The arguments of a command: a line of words, or a list.
pub(crate) trait Arguments {
    fn list(&self) -> Vec<&str>;
}

impl Arguments for str {
    fn list(&self) -> Vec<&str> {
        split(self)
    }
}

impl Arguments for String {
    fn list(&self) -> Vec<&str> {
        split(self)
    }
}

impl Arguments for [&str] {
    fn list(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Arguments for Vec<&str> {
    fn list(&self) -> Vec<&str> {
        self.clone()
    }
}

impl<const N: usize> Arguments for [&str; N] {
    fn list(&self) -> Vec<&str> {
        self.to_vec()
    }
}

/// The words of a command line.
pub(crate) fn split(words: &str) -> Vec<&str> {
    words.split_whitespace().collect()
}

/// Runs the command in a folder.
pub(crate) fn lodmark(folder: &TempDir, arguments: &(impl Arguments + ?Sized)) -> Output {
    command(folder, arguments)
        .output()
        .expect("the command starts")
}

pub(crate) fn command(folder: &TempDir, arguments: &(impl Arguments + ?Sized)) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lodmark"));
    command.current_dir(folder.path()).args(arguments.list());
    command
}

pub(crate) fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal ended it")
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Runs the command and holds it to an exit code; the answer is what it said on stderr.
#[track_caller]
pub(crate) fn expect(folder: &TempDir, exit: i32, arguments: &(impl Arguments + ?Sized)) -> String {
    let output = lodmark(folder, arguments);
    let said = stderr(&output);
    assert_eq!(code(&output), exit, "{:?} said {said}", arguments.list());
    if exit > 1 {
        let words = arguments.list();
        assert_eq!(stdout(&output), "", "{words:?}: a failure has no result");
    }
    said
}

/// Runs the command and holds it to an exit code and to a part of what it says on stderr.
#[track_caller]
pub(crate) fn refused(
    folder: &TempDir,
    exit: i32,
    arguments: &(impl Arguments + ?Sized),
    part: &str,
) {
    let said = expect(folder, exit, arguments);
    assert!(said.contains(part), "{:?} said {said}", arguments.list());
}

/// The bytes of a file that was written into a folder.
pub(crate) fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).expect("written")
}

/// The text of a file that was written into a folder.
pub(crate) fn text(folder: &TempDir, name: &str) -> String {
    String::from_utf8(bytes(folder, name)).expect("text")
}

/// Writes a mesh into a folder.
pub(crate) fn put(folder: &TempDir, name: &str, mesh: &Mesh) -> PathBuf {
    let path = folder.path().join(name);
    io::write(&path, mesh).expect("writes");
    path
}

/// A JSON file of a folder.
pub(crate) fn json(folder: &TempDir, name: &str) -> serde_json::Value {
    serde_json::from_slice(&bytes(folder, name)).expect("JSON")
}
