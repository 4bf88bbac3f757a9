//! Comparing meshes: pictures, distances, boundaries and silhouettes.

use std::path::Path;

use serde::Serialize;

use super::{CompareArgs, Found, mesh_table, sheets};
use crate::{
    Error, Result,
    cli::{Common, Verdict, input, report, terminal::Terminal},
    mesh::{Mesh, content_sha256},
    metric::report::{
        CandidateReport, CompareOptions, Comparison, ErrorReport, Judge, MeshShape, PictureReport,
    },
    view::{ViewSet, ViewsName},
};

/// A mesh as its file holds it, and welded.
struct Source<'a> {
    path: &'a Path,
    sha256: String,
    mesh: Mesh,
}

/// A mesh alone, after welding.
#[derive(Serialize)]
pub(super) struct FileShape<'a> {
    pub(super) file: &'a Path,
    #[serde(flatten)]
    pub(super) shape: MeshShape,
    /// Of the mesh in the file, before welding.
    content_sha256: &'a str,
}

/// One candidate against the reference.
#[derive(Serialize)]
pub(super) struct Judgement<'a> {
    pub(super) candidate: FileShape<'a>,
    /// True where the files hold the same mesh.
    pub(super) equal: bool,
    #[serde(flatten)]
    pub(super) errors: ErrorReport,
    /// Those of `errors`, which the command always measures.
    #[serde(skip)]
    pub(super) pictures: PictureReport,
}

#[derive(Serialize)]
struct Findings<'a> {
    reference: FileShape<'a>,
    #[serde(flatten)]
    found: Found<Judgement<'a>>,
}

pub(super) fn run(options: &CompareArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let sources = options.files().map(|path| read(path, terminal));
    let sources = sources.collect::<Result<Vec<_>>>()?;
    let (reference, candidates) = sources
        .split_first()
        .ok_or_else(|| Error::Internal("a reference without a file".into()))?;
    let wanted = options.resolved()?;
    let meshes: Vec<&Mesh> = candidates.iter().map(|source| &source.mesh).collect();
    let judge = Judge::new(&reference.mesh, &wanted)?;
    let set = judge.views().ok_or_else(without_pictures)?;
    let comparison = judge.compare(&meshes, terminal)?;
    if let Some(folder) = &options.red_differences {
        sheets::write_red(options, folder, &judge, &meshes, terminal)?;
    }
    let findings = Findings::new(comparison, reference, candidates)?;
    let found = findings.found.as_slice();
    if let Some(path) = &options.difference {
        sheets::write_worst(options, path, &judge, &meshes, found)?;
        terminal.say(&format!("{}: written", path.display()));
    }
    let holds = found.iter().all(|j| {
        let rms = j.pictures.largest_rms();
        options.holds(j.equal, Some(rms))
    });
    report(common, "compare", options.in_report(set), &findings)?;
    terminal.finish();
    mesh_table::show(options, &findings.reference.shape, found);
    Ok(Verdict::of(holds))
}

fn read<'a>(path: &'a Path, terminal: &Terminal) -> Result<Source<'a>> {
    let mesh = input::read(path, false, terminal)?;
    input::require_triangles(path, &mesh)?;
    Ok(Source {
        path,
        sha256: content_sha256(&mesh),
        mesh: input::welded(path, mesh, terminal),
    })
}

impl<'a> Findings<'a> {
    fn new(
        comparison: Comparison,
        reference: &'a Source<'a>,
        candidates: &'a [Source<'a>],
    ) -> Result<Self> {
        let mut found = Vec::new();
        for (source, report) in candidates.iter().zip(comparison.candidates) {
            let CandidateReport { shape, errors } = report;
            found.push(Judgement {
                candidate: FileShape::new(source, shape),
                equal: source.sha256 == reference.sha256,
                pictures: errors.pictures.ok_or_else(without_pictures)?,
                errors,
            });
        }
        Ok(Self {
            reference: FileShape::new(reference, comparison.reference),
            found: Found::new(found),
        })
    }
}

fn without_pictures() -> Error {
    Error::Internal("a comparison without the pictures that it was asked for".into())
}

impl<'a> FileShape<'a> {
    fn new(source: &'a Source<'a>, shape: MeshShape) -> Self {
        Self {
            file: source.path,
            shape,
            content_sha256: &source.sha256,
        }
    }
}

impl CompareArgs {
    /// The options of the library; a view file says size and samples itself.
    fn resolved(&self) -> Result<CompareOptions> {
        if let Some(ViewsName::File(path)) = &self.views
            && (self.size.is_some() || self.samples.is_some())
        {
            return Err(Error::Usage(format!(
                "--size and --samples are part of the view file {}; leave them out",
                path.display()
            )));
        }
        let default = CompareOptions::default();
        Ok(CompareOptions {
            views: self.views.clone().or(default.views),
            size: self.size.unwrap_or(default.size),
            samples: self.samples.unwrap_or(default.samples),
            image_error: self.image_error,
            distance_samples: self.distance_samples(),
            ..CompareOptions::default()
        })
    }

    /// The options as `--json` has them.
    fn in_report(&self, set: &ViewSet) -> serde_json::Value {
        let views = self.views.as_ref();
        serde_json::json!({
            "reference": self.reference,
            "candidates": self.candidates,
            "views": views.unwrap_or(&ViewsName::Rhombicuboctahedron).to_string(),
            "width": set.width,
            "height": set.height,
            "samples": set.samples,
            "distance_samples": self.distance_samples(),
            "equal": self.equal,
            "max_rms": self.max_rms,
            "difference": self.difference,
            "difference_scale": self.pictured().then(|| self.difference_scale()),
            "image_error": self.image_error,
            "red_differences": self.red_differences,
        })
    }
}
