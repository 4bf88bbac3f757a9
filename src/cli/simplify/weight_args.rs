//! Weights of vertices on the command line: a NumPy file, or a channel of the input's colours.

use std::path::{Path, PathBuf};

use crate::{
    Error, Result,
    cli::{has_extension, input},
    encode::npy,
    mesh::{Canonical, ChannelKind, Mesh},
    simplify::Weights,
};

/// The colours of vertices, as glTF names them.
const COLORS: &str = "COLOR_0.";

/// Where weights are read from.
#[derive(Clone, Debug)]
pub(super) enum WeightSource {
    /// A one-dimensional array of `f32`.
    File(PathBuf),
    /// A channel of the vertex colours: 0 to 3 for red, green, blue and opacity.
    Color(usize),
}

/// The source that an argument names.
pub(super) fn parse(text: &str) -> Result<WeightSource, String> {
    if let Some(channel) = text.strip_prefix(COLORS) {
        let at = ["r", "g", "b", "a"].iter().position(|&c| c == channel);
        return at.map(WeightSource::Color).ok_or_else(|| {
            format!("the colours have no channel `{channel}`; expected {COLORS}r, .g, .b or .a")
        });
    }
    if has_extension(Path::new(text), "npy") {
        return Ok(WeightSource::File(text.into()));
    }
    Err(format!(
        "expected the name of a .npy file, or a channel of the colours such as {COLORS}r"
    ))
}

impl WeightSource {
    /// The weights of the vertices of the mesh in canonical order. `path` is the file that was read.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Input`] where the array is not one of weights, one for every vertex, or there is no such
    /// channel.
    pub(super) fn read(
        &self,
        path: &Path,
        read: &input::Read,
        canonical: &Canonical,
    ) -> Result<Vec<f32>> {
        match self {
            Self::File(file) => {
                let of_read = of_file(file, path, read)?;
                let before = canonical.vertices.iter();
                Ok(before.map(|&v| of_read[v as usize]).collect())
            }
            Self::Color(at) => of_color(*at, path, &canonical.mesh),
        }
    }
}

/// The weights in a file for the vertices that were read and welded.
fn of_file(file: &Path, path: &Path, read: &input::Read) -> Result<Vec<f32>> {
    let (values, shape) = npy::read_array::<f32>(file)?;
    if shape.len() != 1 {
        let told = format!(
            "holds an array of {} dimensions; expected 1: a weight per vertex",
            shape.len()
        );
        return Err(Error::input(file, told));
    }
    if let Some((vertex, weight)) = Weights::first_wrong(&values) {
        let told =
            format!("the weight of vertex {vertex} is {weight}; expected a number from 0 to 1");
        return Err(Error::input(file, told));
    }
    let (stored, places) = (read.vertices.len(), read.mesh.positions().len());
    if values.len() == stored {
        let mut of_places = vec![0.0_f32; places];
        for (&vertex, weight) in read.vertices.iter().zip(values) {
            let of_place = &mut of_places[vertex as usize];
            *of_place = of_place.max(weight);
        }
        return Ok(of_places);
    }
    if values.len() == places {
        return Ok(values);
    }
    let (count, path) = (values.len(), path.display());
    Err(Error::input(
        file,
        format!(
            "holds {count} weights, but {path} stores {stored} vertices at {places} places; expected as many as one or the \
             other (see `lodmark inspect`)"
        ),
    ))
}

/// A channel of the colours by vertex: the largest value of its corners, cut to 0 to 1; 0 where there is none.
fn of_color(at: usize, path: &Path, mesh: &Mesh) -> Result<Vec<f32>> {
    let attributes = mesh.attributes();
    let kinds = [ChannelKind::ColorAlpha, ChannelKind::Color];
    let found = kinds.into_iter().find_map(|kind| attributes.channel(kind));
    let Some(channel) = found else {
        let told = "has no vertex colours to take weights from; paint some, or give a .npy file";
        return Err(Error::input(path, told));
    };
    if at >= channel.kind.width() {
        let told = "has vertex colours without opacity; expected COLOR_0.r, .g or .b";
        return Err(Error::input(path, told));
    }
    let mut weights = vec![0.0_f32; mesh.positions().len()];
    for (vertices, wedges) in mesh.triangles().iter().zip(attributes.corners()) {
        for (&vertex, &wedge) in vertices.iter().zip(wedges) {
            // The larger of a number and NaN is the number.
            let value = attributes.value(channel, wedge)[at] as f32;
            let weight = &mut weights[vertex as usize];
            *weight = weight.max(value).min(1.0);
        }
    }
    Ok(weights)
}
