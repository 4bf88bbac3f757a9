//! Simplifies a mesh as far as a distance lets be, and proves by code that shares nothing with the method that no point
//! of either surface is farther from the other.
//!
//! ```sh
//! cargo run --release --example guaranteed_bound -- bunny.ply small.ply 0.005
//! ```

#![allow(clippy::print_stdout, reason = "an example says what it finds")]

use lodmark::{
    Error, Mesh, Options, Target,
    options::{Distance, ToleranceOptions},
    simplify, verify,
};

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, share] = arguments.as_slice() else {
        return Err(Error::Usage("expected IN OUT SHARE-OF-DIAGONAL".into()));
    };
    let share: f64 = share
        .parse()
        .map_err(|_| Error::Usage(format!("{share} is no share of the diagonal")))?;

    let mesh = Mesh::read(input)?;
    let own = ToleranceOptions::new(Distance::OfDiagonal(share));
    let outcome = simplify(&mesh, &Options::tolerance(own, Target::ErrorOnly))?;
    let report = verify::distance(&mesh, &outcome.mesh, share)?.require()?;
    outcome.mesh.write(output)?;

    println!(
        "{} of {} triangles, nowhere farther apart than {:.6}: proven",
        outcome.mesh.triangles().len(),
        mesh.triangles().len(),
        report.claimed,
    );
    Ok(())
}
