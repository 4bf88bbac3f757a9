//! The `lodmark` command.

fn main() {}
