//! `lodmark replay`: any level of a recorded run; the last one as the run polished it.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    collapse::{History, Replay},
    encode::bytes,
    io,
    mesh::{self, content_sha256},
    simplify::normals::settle_level,
};

/// Rebuild any level of a recorded run: the mesh as the run had it there, bit for bit
///
/// Polishing follows the last collapse and belongs to the last level only.
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::HISTORY)]
pub(super) struct ReplayArgs {
    /// The mesh that was simplified
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file that `simplify --history` wrote
    #[arg(value_name = "HISTORY")]
    history: PathBuf,
    /// Where to write the level; an existing file is replaced
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// The level: at most this many triangles
    #[arg(long, short = 't', value_name = "N", allow_negative_numbers = true, value_parser = input::parse_triangles::<u32>)]
    triangles: u32,
    /// Exit with code 6, writing nothing, where the run did not get that far
    #[arg(long)]
    strict: bool,
}

pub(super) fn run(options: &ReplayArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    io::writable_format(&options.output)?;
    let beside = io::written_beside(&options.output);
    let outputs = [&options.output].into_iter().chain(&beside);
    input::require_outputs(outputs.chain(&common.json))?;
    let bytes = bytes::read(&options.history)?;
    let history = History::from_bytes(&bytes, &options.history)?;
    // A recorded run welded its input or not; the hash of the content tells which.
    let mesh = [true, false].into_iter().find_map(|weld| {
        let mesh = input::read(&options.input, weld, terminal).map(|m| mesh::canonical(&m).mesh);
        match mesh {
            Ok(m) if weld && mesh::content_digest(&m) != history.header().input => None,
            other => Some(other),
        }
    });
    let unanswered = || Error::Internal("the second way of loading always answers".into());
    let mesh = mesh.ok_or_else(unanswered)??;
    let named = |error| match error {
        Error::Input { message, .. } => Error::input(&options.history, message),
        other => other,
    };
    let triangles = options.triangles as usize;
    let mut replay = Replay::new(&mesh, &history).map_err(named)?;
    replay.seek(triangles).map_err(named)?;
    let live = replay.live();
    let reached = live.triangle_count();
    if reached > triangles {
        let short = format!(
            "the run ended with {reached} triangles; {triangles} were asked for; record a run that goes further"
        );
        if options.strict {
            return Err(Error::TargetNotReached(short));
        }
        terminal.say(&short);
    }
    let level = match replay.applied() {
        0 => mesh.clone(),
        _ => settle_level(&mesh, live.to_mesh()?, &history, terminal).map_err(named)?,
    };
    for note in io::write(&options.output, &level)? {
        terminal.say(&format!("{}: {note}", options.output.display()));
    }
    let run: Value = serde_json::from_str(&history.header().options).unwrap_or_default();
    let (applied, count) = (replay.applied(), level.triangles().len());
    report(
        common,
        "replay",
        json!({ "input": options.input, "triangles": triangles, "run": run }),
        json!({
            "triangles_out": count, "vertices_out": level.positions().len(), "records_applied": applied,
            "content_sha256": content_sha256(&level),
        }),
    )?;
    let (output, records) = (options.output.display(), history.len());
    answer!("{output}: {count} triangles after {applied} of {records} records");
    Ok(Verdict::Good)
}
