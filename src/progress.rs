//! Progress of long-running work: it reports its steps here and learns that it should stop.

use crate::{Error, Result};

/// Watches over work that takes more than a moment. Nothing it answers changes a result, except that an
/// interruption ends the work with [`Error::Interrupted`].
pub trait Progress: Sync {
    /// `done` of `total` steps of `phase` are finished. Called often; `total` 0 means unknown.
    fn report(&self, phase: &str, done: u64, total: u64);

    /// True once the user has asked to stop.
    fn interrupted(&self) -> bool;

    /// [`Progress::report`], then [`Error::Interrupted`] if the user has asked to stop.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    fn step(&self, phase: &str, done: u64, total: u64) -> Result<()> {
        self.report(phase, done, total);
        if self.interrupted() {
            Err(Error::Interrupted)
        } else {
            Ok(())
        }
    }
}

/// No reports, no interruption.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _: &str, _: u64, _: u64) {}

    fn interrupted(&self) -> bool {
        false
    }
}
