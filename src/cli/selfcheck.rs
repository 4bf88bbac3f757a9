//! `lodmark selfcheck`: whether this program computes the right bits on this machine.

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Progress, Result, parallel,
    selfcheck::{Group, Record},
};

/// Compute the goldens that this program was built with, without any files; exit code 1 where a bit differs
#[derive(Debug, clap::Args)]
pub(super) struct SelfcheckArgs {
    /// Compute this group of goldens only; may be given several times [default: all]
    #[arg(long = "group", value_name = "NAME")]
    groups: Vec<String>,
}

/// Machine and build that the program runs on: none of it may change a result.
#[derive(Debug, serde::Serialize)]
struct Machine {
    architecture: &'static str,
    system: &'static str,
    threads: usize,
    /// Whether overflow checks and debug assertions are compiled in.
    build: &'static str,
    /// Instruction sets beyond the architecture's baseline that the compiler was free to use.
    features: Vec<&'static str>,
}

impl Machine {
    fn here() -> Self {
        let sets = [
            ("sse4.2", cfg!(target_feature = "sse4.2")),
            ("avx", cfg!(target_feature = "avx")),
            ("avx2", cfg!(target_feature = "avx2")),
            ("fma", cfg!(target_feature = "fma")),
            ("avx512f", cfg!(target_feature = "avx512f")),
            ("neon", cfg!(target_feature = "neon")),
            ("sve", cfg!(target_feature = "sve")),
        ];
        let debug = cfg!(debug_assertions);
        let on = sets.into_iter().filter(|(_, on)| *on);
        Self {
            architecture: std::env::consts::ARCH,
            system: std::env::consts::OS,
            threads: parallel::threads(),
            build: if debug { "debug" } else { "release" },
            features: on.map(|(name, _)| name).collect(),
        }
    }
}

pub(super) fn run(args: &SelfcheckArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let groups = Group::named(&args.groups)?;
    let machine = Machine::here();
    let sets = match machine.features[..] {
        [] => "baseline".to_string(),
        _ => machine.features.join(" "),
    };
    answer!(
        "lodmark {} on {}-{}, {} threads, {} build, instruction sets: {sets}",
        env!("CARGO_PKG_VERSION"),
        machine.architecture,
        machine.system,
        machine.threads,
        machine.build
    );
    let record = Record::embedded()?.of_groups(&groups);
    let mut mismatches = Vec::new();
    for (i, group) in groups.iter().enumerate() {
        terminal.step("goldens", i as u64, groups.len() as u64)?;
        let items = group.items()?;
        let found = record.group(group.name).compare(&items);
        let verdict = match found.len() {
            0 => "ok".to_string(),
            count => format!("{count} DIFFER"),
        };
        let (name, about) = (group.name, group.about);
        answer!("  {name:9} {:4} {verdict:12} {about}", items.len());
        mismatches.extend(found);
    }
    for mismatch in &mismatches {
        answer!("{mismatch}");
    }
    let verdict = Verdict::of(mismatches.is_empty());
    match verdict {
        Verdict::Good => answer!("every bit is as it should be"),
        Verdict::Negative => answer!(
            "this program does not compute what it should on this machine; please report it"
        ),
    }
    let found = serde_json::json!({ "goldens": record.len(), "mismatches": mismatches });
    report(common, "selfcheck", &machine, found)?;
    Ok(verdict)
}
