//! `lodmark merge-visibility`: parts of one measurement put together.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::{
    Error, Result,
    cli::{Common, Verdict, file_help, input, report, terminal::Terminal},
    encode::{atomic, bytes},
    mesh::Mesh,
    visibility::{PartialVisibility, Visibility},
};

/// Put partial visibility results together, in any order: the bytes of a run over all their views
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::PARTIAL)]
pub(in crate::rooms::cli) struct MergeArgs {
    /// Files that `visibility --partial` or this command wrote
    #[arg(value_name = "PARTIAL", required = true)]
    partials: Vec<PathBuf>,
    /// Where to write the sum; an existing file is replaced
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

pub(crate) fn run(options: &MergeArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    input::require_outputs([&options.out].into_iter().chain(&common.json))?;
    let mut sum: Option<PartialVisibility> = None;
    for path in &options.partials {
        let part = read(path)?;
        match &mut sum {
            None => sum = Some(part),
            Some(sum) => sum.merge(&part).map_err(|error| match error {
                Error::Usage(message) => Error::Usage(format!("{}: {message}", path.display())),
                other => other,
            })?,
        }
    }
    let sum = sum.ok_or_else(|| Error::Usage("no files to merge; name at least one".into()))?;
    write(&options.out, &sum)?;
    if !sum.is_complete() {
        let (ranges, cameras) = (ranges(&sum), sum.options().cameras());
        terminal.say(&format!("not complete yet: views {ranges} of {cameras}"));
    }
    let resolved = json!({ "partials": options.partials, "measurement": sum.options() });
    report(common, "merge-visibility", resolved, summary(&sum))?;
    tell(&options.out, &sum);
    Ok(Verdict::Good)
}

/// Reads a survey.
pub(crate) fn read(path: &Path) -> Result<PartialVisibility> {
    PartialVisibility::from_bytes(&bytes::read(path)?, path)
}

/// The visibility that a survey in a file holds, which must be of `mesh` and of all views.
pub(crate) fn finish(path: &Path, survey: &PartialVisibility, mesh: &Mesh) -> Result<Visibility> {
    let named = |message| format!("{}: {message}", path.display());
    survey.finish(mesh).map_err(|error| match error {
        Error::Usage(message) => Error::input(path, message),
        Error::Unsupported(message) => Error::Unsupported(named(message)),
        other => other,
    })
}

/// Writes a survey; an existing file is replaced as a whole.
pub(super) fn write(path: &Path, survey: &PartialVisibility) -> Result<()> {
    atomic::write_bytes(path, &survey.to_bytes())
}

/// The views and sizes of a survey, for a report.
pub(super) fn summary(survey: &PartialVisibility) -> Value {
    let views: Vec<[u32; 2]> = survey.views().iter().map(|r| [r.start, r.end]).collect();
    json!({
        "views": views, "complete": survey.is_complete(), "triangles": survey.triangle_count(),
        "cameras": survey.options().cameras(),
    })
}

/// Prints the views and sizes of a survey.
pub(super) fn tell(path: &Path, survey: &PartialVisibility) {
    answer!(
        "{}: views {} of {} cameras, {} triangles",
        path.display(),
        ranges(survey),
        survey.options().cameras(),
        survey.triangle_count()
    );
}

fn ranges(survey: &PartialVisibility) -> String {
    let ranges = survey.views().iter();
    let texts = ranges.map(|r| format!("{}..{}", r.start, r.end));
    texts.collect::<Vec<_>>().join(", ")
}
