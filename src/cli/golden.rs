//! `lodmark golden`: what this version computes, held against files, to the last bit.

use std::path::PathBuf;

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Result,
    selfcheck::{self, Group, Record},
};

/// Hold what this version computes against the recorded values, or record them
#[derive(Debug, clap::Args)]
pub(super) struct GoldenArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, clap::Subcommand)]
enum Verb {
    /// Compare to the last bit; exit code 1 where anything differs
    Check {
        #[command(flatten)]
        place: Place,
        /// Folder for `expected | actual | difference` pictures and mismatches.json; made where something differs
        #[arg(long, value_name = "DIR", default_value = "target/golden")]
        out: PathBuf,
        /// Compare this group of goldens only; may be given several times [default: all]
        #[arg(long = "group", value_name = "NAME")]
        groups: Vec<String>,
    },
    /// Record what this version computes; say in the commit why it should change
    Bless(Place),
    /// Print names and values as this version computes them
    List,
}

#[derive(Debug, clap::Args)]
struct Place {
    /// Folder of golden.txt and its pictures
    #[arg(long, value_name = "DIR", default_value = "golden")]
    dir: PathBuf,
}

pub(super) fn run(options: &GoldenArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let groups = match &options.verb {
        Verb::Check { groups, .. } => Group::named(groups)?,
        Verb::Bless(_) | Verb::List => Group::named(&[])?,
    };
    let items = Group::items_of(&groups, terminal)?;
    match &options.verb {
        Verb::Check {
            place,
            out,
            groups: named,
        } => {
            let asked = if named.is_empty() { &[][..] } else { &groups };
            let mismatches = selfcheck::check_groups(&place.dir, asked, &items, out)?;
            let (dir, all) = (place.dir.display(), items.len());
            let resolved = serde_json::json!({ "verb": "check", "dir": place.dir });
            let found = serde_json::json!({ "goldens": all, "mismatches": mismatches });
            report(common, "golden", resolved, found)?;
            if mismatches.is_empty() {
                answer!("{dir}: all {all} goldens hold");
                return Ok(Verdict::Good);
            }
            for mismatch in &mismatches {
                answer!("{mismatch}");
            }
            let (count, out) = (mismatches.len(), out.display());
            answer!("{dir}: {count} of {all} goldens do not hold; see {out}");
            terminal.say(&format!(
                "where the change is meant: lodmark golden bless --dir {dir}, and say why in the commit"
            ));
            Ok(Verdict::Negative)
        }
        Verb::Bless(place) => {
            selfcheck::bless(&place.dir, &items)?;
            answer!("{}: recorded {} goldens", place.dir.display(), items.len());
            Ok(Verdict::Good)
        }
        Verb::List => {
            for (name, value) in Record::of(&items).iter() {
                answer!("{name} {value}");
            }
            Ok(Verdict::Good)
        }
    }
}
