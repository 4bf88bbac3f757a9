//! Runs: of an engine, and of anything on given numbers of threads.

use lodmark::{
    Silent,
    collapse::{Engine, Method, Stop},
};

/// Lets an engine collapse, which nobody interrupts.
pub(crate) fn collapse(engine: &mut Engine, method: &mut dyn Method, triangles: usize) -> Stop {
    let stop = engine.run(method, triangles, &mut (), &Silent);
    stop.expect("nobody interrupts")
}

/// Runs something with so many threads to divide it among.
pub(crate) fn on_threads<R: Send>(threads: usize, run: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads").install(run)
}

/// The result that a run has on 1, 2, 3 and 8 threads, all of them alike.
#[track_caller]
pub(crate) fn same_on_all_threads<R: PartialEq + Send>(run: impl Fn() -> R + Sync) -> R {
    let one = on_threads(1, &run);
    for threads in [2, 3, 8] {
        assert!(on_threads(threads, &run) == one, "{threads} threads");
    }
    one
}
