//! The `lodmark` command: see `lodmark --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    lodmark::command()
}
