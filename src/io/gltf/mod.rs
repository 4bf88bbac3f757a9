//! glTF 2.0.

#[cfg_attr(
    not(test),
    expect(dead_code, reason = "the reader of buffer views is its first caller")
)]
mod meshopt;
