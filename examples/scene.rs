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

use std::{env, path::Path, process::ExitCode};

use glam::DVec3;
use lodmark::{
    Error, Result,
    bound::view_cell::{ViewCell, file},
    io,
    mesh::generate,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match write(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            #[allow(clippy::print_stderr, reason = "an example has no terminal of its own")]
            {
                eprintln!("{error}");
            }
            ExitCode::from(error.exit_code())
        }
    }
}

fn write(words: &[&str]) -> Result<()> {
    let usage = || {
        Error::Usage(
            "expected: city COLUMNS ROWS MESH CELL, forest TREES RADIUS MESH CELL, names, mesh NAME MESH, or \
             engine DETAIL, motor DETAIL or waves SIDE MESH"
                .into(),
        )
    };
    match *words {
        ["names"] => {
            #[allow(clippy::print_stdout, reason = "an example has no terminal of its own")]
            for name in generate::NAMES {
                println!("{name}");
            }
            return Ok(());
        }
        ["mesh", name, file] => {
            let mesh = generate::by_name(name).ok_or_else(usage)?;
            return io::write(Path::new(file), &mesh).map(drop);
        }
        [name @ ("engine" | "motor" | "waves"), size, file] => {
            let size: u32 = size.parse().map_err(|_| usage())?;
            let mesh = match name {
                "engine" => generate::engine(size),
                "motor" => generate::motor(size),
                _ => generate::grid(size, size, generate::Height::Waves),
            };
            return io::write(Path::new(file), &mesh).map(drop);
        }
        _ => {}
    }
    let [scene, first, second, mesh, cell] = words else {
        return Err(usage());
    };
    let count: u32 = first.parse().map_err(|_| usage())?;
    let (scene, viewers) = match *scene {
        "city" => (
            generate::buildings(count, second.parse().map_err(|_| usage())?),
            ViewCell::half_space(DVec3::new(0.0, -6.0, 0.0), DVec3::Y)?,
        ),
        "forest" => (
            generate::trees(count, second.parse().map_err(|_| usage())?),
            ViewCell::segment([DVec3::new(-10.0, 0.0, 0.0), DVec3::new(10.0, 0.0, 0.0)])?,
        ),
        _ => return Err(usage()),
    };
    io::write(Path::new(mesh), &scene)?;
    std::fs::write(cell, file::to_json(&viewers)?).map_err(|e| Error::io("write", cell, e))
}
