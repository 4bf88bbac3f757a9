//! Draws the reference images of a mesh that a renderer of your own can be held against: exact triangle ids and depths,
//! and `scene.json` with the views to draw them in and the hashes of all images.
//!
//! ```sh
//! cargo run --release --example reference_pictures -- bunny.ply images
//! ```

#![allow(clippy::print_stdout, reason = "an example says what it finds")]

use lodmark::{Error, Mesh, options::RenderOptions, render, views::ViewsName};

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, folder] = arguments.as_slice() else {
        return Err(Error::Usage("expected IN FOLDER".into()));
    };

    let mesh = Mesh::read(input)?;
    let options = RenderOptions::default()
        .views(ViewsName::Dodecahedron)
        .pictures(64, 1);
    let rendering = render(&mesh, &options)?;
    rendering.write(folder)?;

    for (i, images) in rendering.images.iter().enumerate() {
        let seen = images.ids.values().iter().filter(|&&id| id > 0).count();
        println!(
            "view {i:2}: the mesh covers {seen} of {} samples",
            images.ids.values().len()
        );
    }
    Ok(())
}
