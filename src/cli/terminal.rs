//! Progress on stderr: a bar on a terminal, plain lines elsewhere; and the interrupt key.

use std::{
    io::{IsTerminal, Write},
    sync::{
        Mutex, Once,
        atomic::{AtomicBool, Ordering},
    },
};

use indicatif::{ProgressBar, ProgressStyle};

use crate::Progress;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);
static HANDLER: Once = Once::new();

/// The user's terminal.
#[derive(Debug)]
pub(super) struct Terminal {
    quiet: bool,
    bar: Option<ProgressBar>,
    /// The phase and tenth that were reported last.
    last: Mutex<(String, u64)>,
}

impl Terminal {
    /// Takes over the interrupt key: the first press ends the work in good order, the second at once.
    pub(super) fn new(quiet: bool) -> Self {
        HANDLER.call_once(|| {
            // Without a handler the key still works: it ends the process.
            let _ = ctrlc::set_handler(|| {
                if INTERRUPTED.swap(true, Ordering::Relaxed) {
                    std::process::exit(130);
                }
            });
        });
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let template = "{msg:14} {wide_bar} {pos}/{len} {eta}";
            let bar = ProgressBar::no_length();
            bar.set_style(
                ProgressStyle::with_template(template).unwrap_or(ProgressStyle::default_bar()),
            );
            bar
        });
        Self {
            quiet,
            bar,
            last: Mutex::new((String::new(), 0)),
        }
    }

    /// A line for the user.
    pub(super) fn say(&self, line: &str) {
        match &self.bar {
            _ if self.quiet => {}
            Some(bar) => bar.suspend(|| put(line)),
            None => put(line),
        }
    }

    /// Removes the bar.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Terminal {
    fn report(&self, phase: &str, done: u64, total: u64) {
        if self.quiet {
            return;
        }
        let Ok(mut last) = self.last.lock() else {
            return;
        };
        let new_phase = last.0 != phase;
        if let Some(bar) = &self.bar {
            if new_phase {
                bar.reset();
                bar.set_message(phase.to_string());
                *last = (phase.to_string(), 0);
            }
            bar.set_length(total);
            bar.set_position(done);
            return;
        }
        let tenth = (done * 10).checked_div(total).unwrap_or(0);
        if new_phase || tenth > last.1 {
            *last = (phase.to_string(), tenth);
            if total == 0 {
                put(phase);
            } else {
                put(&format!("{phase}: {done} of {total}"));
            }
        }
    }

    fn interrupted(&self) -> bool {
        INTERRUPTED.load(Ordering::Relaxed)
    }
}

/// A line on stderr. Where stderr is gone nobody is there to be told.
fn put(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
