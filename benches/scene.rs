//! Writes a scene that results are measured on: one of the two for billboards, of any size, with the view cell that goes
//! with it, or any generated mesh:
//!
//! ```text
//! cargo run --release --example scene -- engine 2 engine.ply
//! cargo run --release --example scene -- motor 3 motor.ply
//! cargo run --release --example scene -- city 20 21 city.obj city.json
//! cargo run --release --example scene -- forest 10000 500 forest.obj forest.json
//! cargo run --release --example scene -- names
//! cargo run --release --example scene -- mesh engine engine.obj
//! cargo run --release --example scene -- waves 920 waves.ply
//! ```
//! A city has so many buildings along a street and so many streets, its viewers are behind a plane at distance 6 of the
//! first row. A forest has so many trees in a disc of some radius, its viewers are on a segment of length 20. `names`
//! prints the names that `mesh` knows, one a line; waves are a height field of so many squares along each side.

#![allow(clippy::print_stdout, reason = "a bench has no terminal of its own")]

use std::{env, path::Path};

use glam::DVec3;
use lodmark::{
    Error, Result,
    bound::view_cell::{ViewCell, file},
    io,
    mesh::{Mesh, generate},
};

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let write = |file: &str, mesh: &Mesh| io::write(Path::new(file), mesh).map(drop);
    let (mesh, cell, scene, viewers) = match *words {
        ["names"] => {
            println!("{}", generate::NAMED.map(|(name, _)| name).join("\n"));
            return Ok(());
        }
        ["mesh", name, file] => {
            return write(file, &generate::by_name(name).ok_or_else(|| unknown(name))?);
        }
        ["engine", detail, file] => return write(file, &generate::engine(number(detail)?)),
        ["motor", detail, file] => return write(file, &generate::motor(number(detail)?)),
        ["waves", side, file] => {
            let (side, height) = (number(side)?, generate::Height::Waves);
            return write(file, &generate::grid(side, side, height));
        }
        ["city", columns, rows, mesh, cell] => (
            mesh,
            cell,
            generate::buildings(number(columns)?, number(rows)?),
            ViewCell::half_space(DVec3::new(0.0, -6.0, 0.0), DVec3::Y)?,
        ),
        ["forest", trees, radius, mesh, cell] => (
            mesh,
            cell,
            generate::trees(number(trees)?, number(radius)?),
            ViewCell::segment([DVec3::new(-10.0, 0.0, 0.0), DVec3::new(10.0, 0.0, 0.0)])?,
        ),
        _ => return Err(unknown(&words.join(" "))),
    };
    write(mesh, &scene)?;
    std::fs::write(cell, file::to_json(&viewers)?).map_err(|e| Error::io("write", cell, e))
}

fn number<T: std::str::FromStr>(word: &str) -> Result<T> {
    word.parse().map_err(|_| unknown(word))
}

fn unknown(words: &str) -> Error {
    Error::Usage(format!(
        "`{words}` is no scene; benches/scene.rs lists them all"
    ))
}
