//! Settings of property tests.

/// A property test of so many cases that writes nothing into the source tree when it fails.
pub(crate) fn cases(count: u32) -> proptest::test_runner::Config {
    proptest::test_runner::Config {
        failure_persistence: None,
        ..proptest::test_runner::Config::with_cases(count)
    }
}

/// A number from the environment.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |v| v.parse().expect("a whole number"))
}

/// Cases of a property of bounds: as many as `LODMARK_BOUND_CASES` says, else so many.
pub(crate) fn bound_cases(default: u64) -> u64 {
    number("LODMARK_BOUND_CASES", default)
}

/// The same as a small number.
pub(crate) fn bound_count(default: u64) -> u32 {
    u32::try_from(bound_cases(default)).expect("a number of cases")
}

/// The number that cases of bounds are drawn from: `LODMARK_SEED`, else 2007.
pub(crate) fn bound_seed() -> u64 {
    number("LODMARK_SEED", 2007)
}

/// As [`cases`], for a property of bounds: where `LODMARK_BOUND_CASES` is given, the cases are those of [`bound_seed`].
pub(crate) fn bounded(default: u32) -> proptest::test_runner::Config {
    let own = cases(bound_count(default.into()));
    if std::env::var_os("LODMARK_BOUND_CASES").is_none() {
        return own;
    }
    proptest::test_runner::Config {
        rng_seed: proptest::test_runner::RngSeed::Fixed(bound_seed()),
        ..own
    }
}
