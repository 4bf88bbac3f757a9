//! Users who want to stop.

use std::sync::atomic::{AtomicU64, Ordering};

use lodmark::Progress;

/// Wants to stop from the first step on.
pub(crate) struct Impatient;

impl Progress for Impatient {
    fn report(&self, phase: &str, done: u64, total: u64) {
        assert!(total == 0 || done <= total, "{phase}: {done} of {total}");
    }

    fn interrupted(&self) -> bool {
        true
    }
}

/// Wants to stop once a number of steps of one phase were reported.
pub(crate) struct StopsAfter {
    phase: &'static str,
    steps: u64,
    reported: AtomicU64,
}

impl StopsAfter {
    pub(crate) fn new(phase: &'static str, steps: u64) -> Self {
        Self {
            phase,
            steps,
            reported: AtomicU64::new(0),
        }
    }
}

impl Progress for StopsAfter {
    fn report(&self, phase: &str, done: u64, total: u64) {
        assert!(total == 0 || done <= total, "{phase}: {done} of {total}");
        if phase == self.phase {
            self.reported.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn interrupted(&self) -> bool {
        self.reported.load(Ordering::Relaxed) >= self.steps
    }
}
