//! Simplifies a mesh by what it looks like, and measures how much the result differs from it.
//!
//! ```sh
//! cargo run --release --example simplify_and_compare -- bunny.ply small.ply 1333
//! ```

#![allow(clippy::print_stdout, reason = "an example says what it finds")]

use lodmark::{Error, Mesh, Options, Preset, Target, compare, simplify};

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, triangles] = arguments.as_slice() else {
        return Err(Error::Usage("expected IN OUT TRIANGLES".into()));
    };
    let triangles = triangles
        .parse()
        .map_err(|_| Error::Usage(format!("{triangles} is no number of triangles")))?;

    let mesh = Mesh::read(input)?; // welded, in canonical order
    let options = Options::image(Target::triangles(triangles)).preset(Preset::Fast);
    let outcome = simplify(&mesh, &options)?;
    outcome.mesh.write(output)?;

    let (before, after) = (mesh.triangles().len(), outcome.mesh.triangles().len());
    println!(
        "{after} of {before} triangles; stopped by {:?}",
        outcome.stop
    );
    let errors = compare(&mesh, &outcome.mesh)?.errors;
    if let Some(pictures) = errors.pictures {
        println!(
            "pictures differ by {:.2} levels of 255, flat",
            pictures.rms_flat
        );
    }
    if let Some(distance) = errors.distances.distance_max {
        println!("surfaces are at most {distance:.4} apart, where it was measured");
    }
    Ok(())
}
