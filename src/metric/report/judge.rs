//! The judge: a reference ready to be drawn, and the comparison itself.

use super::{
    CandidateReport, CompareOptions, Comparison, DistanceReport, ErrorReport, ImageError,
    MeshShape, PictureReport, ViewReport,
};
use crate::{
    Error, Progress, Result,
    mesh::Mesh,
    metric::{
        appearance::{Appearance, appearance, flat, pictures},
        folds::folds,
        luma::ViewErrors,
        silhouette::silhouette_histogram,
        surface::surface_distance,
    },
    num::Frame,
    raster::{Grid, Scene},
    view::{Eye, Interpolation, Sphere, ViewSet, frame_of},
};

/// Measures how far candidates are from a reference.
///
/// Meshes are taken as they are: weld them first, or seams count as boundaries. The same bits for every number of
/// threads. Cost: two or three pictures of each mesh per view, and O(points log triangles) for distances.
///
/// # Errors
/// [`Error::Usage`] for a reference without triangles or options out of range; [`Error::Input`] and [`Error::Io`] for a
/// view file that cannot be used; [`Error::Unsupported`] where a mesh lies too far away to be drawn together with the
/// reference; [`Error::Interrupted`].
pub fn compare(
    reference: &Mesh,
    candidates: &[&Mesh],
    options: &CompareOptions,
    progress: &dyn Progress,
) -> Result<Comparison> {
    Judge::new(reference, options)?.compare(candidates, progress)
}

/// A reference with its views, ready to be compared with candidates and to be drawn beside them.
#[derive(Debug)]
pub struct Judge<'a> {
    reference: &'a Mesh,
    options: CompareOptions,
    frame: Frame,
    scene: Scene,
    /// Views of the pictures in file units, and in the frame.
    views: Option<[ViewSet; 2]>,
    /// Views of equation 5.11 in the frame.
    image_views: Option<ViewSet>,
}

impl<'a> Judge<'a> {
    /// Prepares a reference; refuses views that cannot be used, before any work.
    ///
    /// # Errors
    /// [`Error::Usage`] where it has no triangles, or for options out of range; what reading a view file says.
    pub fn new(reference: &'a Mesh, options: &CompareOptions) -> Result<Self> {
        let sphere = Sphere::of_mesh(reference)
            .ok_or_else(|| Error::Usage("a reference without triangles shows nothing".into()))?;
        let frame = frame_of(reference);
        let views = options.picture_views(&sphere)?;
        let image_views = options.image_error_views(&sphere)?;
        Ok(Self {
            reference,
            options: options.clone(),
            frame,
            scene: Scene::of(&reference.enter_frame(frame)),
            views: views.map(|set| [set.enter_frame(frame), set]),
            image_views: image_views.map(|set| set.enter_frame(frame)),
        })
    }

    /// The views of the pictures in file units; `None` where none are drawn.
    pub fn views(&self) -> Option<&ViewSet> {
        self.views.as_ref().map(|[_, set]| set)
    }

    /// A candidate in the frame of the reference, ready to be drawn.
    pub fn scene(&self, candidate: &Mesh) -> Scene {
        Scene::of(&candidate.enter_frame(self.frame))
    }

    /// Draws the reference and scenes of [`Judge::scene`] in one view, each pixel rounded to the mean of its samples.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no such view.
    pub fn pictures(
        &self,
        candidates: &[&Scene],
        view: usize,
        shading: Interpolation,
    ) -> Result<Vec<Grid<u8>>> {
        let Some([set, _]) = &self.views else {
            let told = "no views were asked for; expected some to draw pictures in";
            return Err(Error::Usage(told.into()));
        };
        let scenes = std::iter::once(&self.scene).chain(candidates.iter().copied());
        scenes
            .map(|scene| pictures([scene], set, view, shading).map(|[picture]| picture))
            .collect()
    }

    /// As [`compare`].
    ///
    /// # Errors
    /// As [`compare`].
    pub fn compare(&self, candidates: &[&Mesh], progress: &dyn Progress) -> Result<Comparison> {
        let reference = self.shape(self.reference, progress)?;
        let shapes = candidates.iter().map(|mesh| self.shape(mesh, progress));
        let shapes = shapes.collect::<Result<Vec<_>>>()?;
        let (looks, image_errors) = self.draw(candidates, progress)?;
        let mut reports = Vec::with_capacity(candidates.len());
        for (i, (mesh, shape)) in candidates.iter().zip(shapes).enumerate() {
            let errors = self.errors(mesh, looks.get(i), image_errors.get(i), progress)?;
            reports.push(CandidateReport { shape, errors });
        }
        Ok(Comparison {
            reference,
            candidates: reports,
        })
    }

    /// Measures what is not drawn, and puts it together with what was.
    fn errors(
        &self,
        mesh: &Mesh,
        look: Option<&Appearance>,
        image_error: Option<&ViewErrors>,
        progress: &dyn Progress,
    ) -> Result<ErrorReport> {
        let distances = match self.options.distance_samples {
            None => DistanceReport::default(),
            Some(samples) => {
                let distance = surface_distance(self.reference, mesh, samples, progress)?;
                DistanceReport::new(distance)
            }
        };
        let folds = || folds(self.reference, mesh, progress);
        let folds = self.options.folds.then(folds).transpose()?;
        Ok(ErrorReport {
            pictures: look.map(PictureReport::new),
            distances,
            folds,
            image_error: image_error.map(ImageError::new),
            views: match (self.views(), look) {
                (Some(set), Some(look)) => ViewReport::of_all(set, look),
                _ => Vec::new(),
            },
        })
    }

    /// Draws all candidates in both sets of views; their scenes live no longer than this.
    fn draw(
        &self,
        candidates: &[&Mesh],
        progress: &dyn Progress,
    ) -> Result<(Vec<Appearance>, Vec<ViewErrors>)> {
        let scenes: Vec<Scene> = candidates.iter().map(|mesh| self.scene(mesh)).collect();
        let looks = match &self.views {
            Some([set, _]) => appearance(&self.scene, &scenes, set, progress)?,
            None => Vec::new(),
        };
        let errors = match &self.image_views {
            Some(set) => flat(&self.scene, &scenes, set, progress)?,
            None => Vec::new(),
        };
        Ok((looks, errors))
    }

    /// The size of a mesh, and its silhouettes in the views of the pictures.
    fn shape(&self, mesh: &Mesh, progress: &dyn Progress) -> Result<MeshShape> {
        let histogram = match &self.views {
            Some([set, _]) if self.options.silhouettes => {
                let eyes: Vec<Eye> = set.views.iter().map(|view| view.eye).collect();
                let framed = mesh.enter_frame(self.frame);
                let mesh = framed.in_frame_units();
                Some(silhouette_histogram(mesh, &eyes, progress)?)
            }
            _ => None,
        };
        Ok(MeshShape::new(mesh, histogram))
    }
}
