//! Users who want to stop, and users who look on.

use std::sync::{
    Mutex,
    atomic::{AtomicU64, Ordering},
};

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

/// Wants to stop once a number of steps of the phases that begin with a word were reported, and counts how often it is asked after that.
pub(crate) struct StopsAfter {
    phase: &'static str,
    steps: u64,
    reported: AtomicU64,
    asked_after: AtomicU64,
}

impl StopsAfter {
    pub(crate) fn new(phase: &'static str, steps: u64) -> Self {
        Self {
            phase,
            steps,
            reported: AtomicU64::new(0),
            asked_after: AtomicU64::new(0),
        }
    }

    /// How many steps of the phase were reported, and how often an answer was yes.
    pub(crate) fn counts(&self) -> [u64; 2] {
        [&self.reported, &self.asked_after].map(|n| n.load(Ordering::Relaxed))
    }
}

impl Progress for StopsAfter {
    fn report(&self, phase: &str, done: u64, total: u64) {
        assert!(total == 0 || done <= total, "{phase}: {done} of {total}");
        if phase.starts_with(self.phase) {
            self.reported.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn interrupted(&self) -> bool {
        let stop = self.reported.load(Ordering::Relaxed) >= self.steps;
        if stop {
            self.asked_after.fetch_add(1, Ordering::Relaxed);
        }
        stop
    }
}

/// Keeps the phases of all steps that are reported.
#[derive(Default)]
pub(crate) struct Recorder(Mutex<Vec<String>>);

impl Recorder {
    pub(crate) fn phases(&self) -> Vec<String> {
        self.0
            .lock()
            .expect("no test panics while it reports")
            .clone()
    }
}

impl Progress for Recorder {
    fn report(&self, phase: &str, _: u64, _: u64) {
        let mut phases = self.0.lock().expect("no test panics while it reports");
        phases.push(phase.into());
    }

    fn interrupted(&self) -> bool {
        false
    }
}
