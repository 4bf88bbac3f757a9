//! `lodmark check`: what is wrong with a mesh.

use std::path::PathBuf;

use super::{Common, Verdict, report, source, terminal::Terminal};
use crate::{Result, mesh::Findings};

/// Report what is wrong with a mesh; exit code 1 when something is
#[derive(Debug, clap::Args)]
pub(super) struct Options {
    /// The mesh: .obj, .ply or .stl
    #[arg(value_name = "IN")]
    input: PathBuf,
}

pub(super) fn run(options: &Options, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let mesh = source::read(&options.input, false, terminal)?;
    let findings = Findings::of(&mesh);
    println!("{}", findings.report());
    report(
        common,
        "check",
        serde_json::json!({ "input": options.input }),
        &findings,
    )?;
    Ok(if findings.is_clean() {
        Verdict::Good
    } else {
        Verdict::Negative
    })
}
