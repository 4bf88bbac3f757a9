//! The `lodmark` command: one file per subcommand.
//!
//! Results go to stdout, talk to stderr. Exit codes: see [`Error::exit_code`]; 1 is a negative verdict.

/// A line of the result, on stdout. A command goes on where that fails, and [`stdout::outcome`] tells in the end.
macro_rules! answer {
    ($($part:tt)*) => { $crate::cli::stdout::line(format_args!($($part)*)) };
}

mod billboards;
mod bound;
mod bound_region;
mod check;
mod check_rays;
mod compare;
mod demo;
mod file_help;
mod golden;
mod guidance_args;
mod input;

mod inspect;
mod levels;
mod lod;
mod render;
mod replay;
mod selfcheck;
mod simplify;
mod stdout;
mod table;
mod terminal;
mod verify;
mod visibility;

use std::{
    io::Write,
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand, error::ErrorKind};

use crate::{Error, Result, encode::json, parallel};
use terminal::Terminal;

/// Simplify 3D meshes by what they look like, with the same bits on every machine and no GPU.
#[derive(Debug, Parser)]
#[command(name = "lodmark", version, max_term_width = 110)]
#[command(propagate_version = true)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

/// Options of every command.
#[derive(Clone, Debug, clap::Args)]
struct Common {
    /// Number of threads; never changes a result [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Write a report with all resolved options as JSON; equal runs give equal bytes
    #[arg(long, global = true, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Say nothing on stderr but errors
    #[arg(long, short, global = true)]
    quiet: bool,
}

/// One verb each.
#[derive(Debug, Subcommand)]
enum Command {
    Simplify(simplify::SimplifyArgs),
    Replay(replay::ReplayArgs),
    Render(render::RenderArgs),
    Compare(compare::CompareArgs),
    Visibility(visibility::VisibilityArgs),
    MergeVisibility(visibility::MergeArgs),
    Bound(bound::BoundArgs),
    BoundRegion(bound_region::BoundRegionArgs),
    Verify(verify::VerifyArgs),
    Check(check::CheckArgs),
    CheckRays(check_rays::CheckRaysArgs),
    Inspect(inspect::InspectArgs),
    Lod(lod::LodArgs),
    Levels(levels::LevelsArgs),
    Billboards(billboards::BillboardsArgs),
    Golden(golden::GoldenArgs),
    Selfcheck(selfcheck::SelfcheckArgs),
    Demo(demo::DemoArgs),
    /// Anything else.
    #[command(external_subcommand)]
    Other(Vec<String>),
}

/// The answer of a command that succeeded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// Exit code 0.
    Good,
    /// Exit code 1: it worked, and the answer is no.
    Negative,
}

impl Verdict {
    /// The answer to whether something holds.
    fn of(holds: bool) -> Self {
        if holds { Self::Good } else { Self::Negative }
    }
}

/// The arguments of the command, with the headings of the help.
fn command() -> clap::Command {
    Arguments::command().mut_subcommand("simplify", simplify::option_table::with_headings)
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let parsed = command()
        .try_get_matches()
        .and_then(|matches| Arguments::from_arg_matches(&matches).map(|found| (found, matches)));
    let (arguments, matches) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return usage(&error.format(&mut command())),
    };
    let common = arguments.common.clone();
    // A panic is a bug; it ends with its own exit code, and unwinding removes temporary files.
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| run(arguments, &matches)));
    let error = match outcome {
        Ok(Ok(Verdict::Good)) => return ExitCode::SUCCESS,
        Ok(Ok(Verdict::Negative)) => return ExitCode::from(1),
        Ok(Err(error)) => error,
        Err(_) => Error::Internal("the command panicked".into()),
    };
    Terminal::new(common.quiet).finish();
    // Where stderr is gone there is still the exit code.
    let _ = writeln!(std::io::stderr(), "lodmark: {error}");
    ExitCode::from(error.exit_code())
}

fn usage(error: &clap::Error) -> ExitCode {
    // Nothing can be done where the terminal is gone.
    let _ = error.print();
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => ExitCode::SUCCESS,
        _ => ExitCode::from(2),
    }
}

fn run(arguments: Arguments, matches: &ArgMatches) -> Result<Verdict> {
    let common = &arguments.common;
    if let Some(threads) = common.threads {
        parallel::set_threads(usize::from(threads))?;
    }
    let terminal = Terminal::new(common.quiet);
    let verdict = match arguments.command {
        Command::Simplify(options) => {
            let given = matches.subcommand().map_or(matches, |(_, given)| given);
            simplify::run(&options, given, common, &terminal)
        }
        Command::Replay(options) => replay::run(&options, common, &terminal),
        Command::Render(options) => render::run(&options, common, &terminal),
        Command::Compare(options) => compare::run(&options, common, &terminal),
        Command::Visibility(options) => visibility::run(&options, common, &terminal),
        Command::MergeVisibility(options) => visibility::run_merge(&options, common, &terminal),
        Command::Bound(options) => bound::run(&options, common, &terminal),
        Command::BoundRegion(options) => bound_region::run(&options, common, &terminal),
        Command::Verify(options) => verify::run(&options, common, &terminal),
        Command::Check(options) => check::run(&options, common, &terminal),
        Command::CheckRays(options) => check_rays::run(&options, common, &terminal),
        Command::Inspect(options) => inspect::run(&options, common, &terminal),
        Command::Lod(options) => lod::run(&options, common, &terminal),
        Command::Levels(options) => levels::run(&options, common, &terminal),
        Command::Billboards(options) => billboards::run(&options, common, &terminal),
        Command::Golden(options) => golden::run(&options, common, &terminal),
        Command::Demo(options) => demo::run(&options, common, &terminal),
        Command::Selfcheck(options) => selfcheck::run(&options, common, &terminal),
        Command::Other(words) => {
            let name = words.first().cloned().unwrap_or_default();
            let told = format!("there is no command `{name}`; see `lodmark --help`");
            Err(Error::Usage(told))
        }
    };
    terminal.finish();
    let verdict = verdict?;
    stdout::outcome()?;
    Ok(verdict)
}

/// True where the name of a file ends in `.extension`, in whichever case.
fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// The frame of every JSON report: schema, command, version, options, then what the command found.
#[derive(Debug, serde::Serialize)]
struct Report<'a, O, R> {
    schema: u32,
    command: &'a str,
    version: &'a str,
    options: O,
    #[serde(flatten)]
    result: R,
}

/// Writes the report of a command where `--json` asks for one.
fn report(
    common: &Common,
    command: &str,
    options: impl serde::Serialize,
    result: impl serde::Serialize,
) -> Result<()> {
    let Some(path) = &common.json else {
        return Ok(());
    };
    let report = Report {
        schema: 1,
        command,
        version: env!("CARGO_PKG_VERSION"),
        options,
        result,
    };
    json::write(path, &report)
}
