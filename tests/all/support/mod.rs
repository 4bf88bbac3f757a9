//! What tests of several rooms use: meshes, random numbers, the command, models, oracles, property-test settings.

mod command;
pub(crate) mod meshes;
pub(crate) mod oracle;
mod property;
mod random;

pub(crate) use command::{code, command, expect, folder, lodmark, put, stderr, stdout};
pub(crate) use property::{bound_cases, bound_seed, bounded, cases};
pub(crate) use random::Random;
