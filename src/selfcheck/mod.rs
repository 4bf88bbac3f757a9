//! Goldens: what this version computes for a fixed set of small cases, to the last bit.
//!
//! A golden is a name and a value: the SHA-256 of raw pixels, of a mesh or of the bytes of a file, or a few exact
//! integers. All lie sorted in one text file ([`Record`]), a few also as small pictures for eyes, which are compared by
//! their pixels. There is no tolerance. A golden changes only together with the reason why the result should change.
//!
//! The cases use generated meshes, so that they need no files: [`Record::embedded`] is the text file as it was when
//! this program was built, and `lodmark selfcheck` holds the machine it runs on against it. The whole set takes about
//! seven seconds in release on one thread, four fifths of them in the group `simplify`, so that slow machines and emulators
//! can run it too.

mod billboards;
mod compared;
mod fixtures;
mod golden_files;
mod groups;
mod hidden_parts;
mod pictures;
mod record;
mod replayed;
mod simplified;
mod view_cell_bounds;
mod visibility;
mod written_files;

pub use golden_files::{RECORD_NAME, bless, check, check_groups, picture_path};
pub use groups::{Collector, GROUPS, Group, Item};
pub use record::{Mismatch, Record};
