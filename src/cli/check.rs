//! `lodmark check`: what is wrong with a mesh.

use std::path::PathBuf;

use super::{Common, Verdict, input, report, terminal::Terminal};
use crate::{Result, mesh::Findings};

/// Report what is wrong with a mesh; exit code 1 when something is
#[derive(Debug, clap::Args)]
pub(super) struct CheckArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
}

pub(super) fn run(options: &CheckArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let mesh = input::read(&options.input, !options.no_weld, terminal)?;
    let findings = Findings::of(&mesh);
    answer!("{}", findings.report().trim_end());
    let resolved = serde_json::json!({ "input": options.input });
    report(common, "check", resolved, &findings)?;
    Ok(Verdict::of(findings.clean))
}
