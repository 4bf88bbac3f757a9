//! Reference images: every sample is the minimum over `(depth, triangle)`, in integers.

use std::path::Path;

use crate::{
    Error, Progress, Result, Silent,
    encode::{atomic, hash, npy, png},
    mesh::Mesh,
    num::fixed::SubpixelBits,
    raster::{self, Grid, Picture, Scene},
    view::{
        self, Cull, Projection, Shading, Sphere, ViewSet, ViewsName, file::ImageHashes, frame_of,
    },
};

/// Views, size and shading of reference images.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderOptions {
    /// Views around the mesh, or a view file, which says all that follows itself [default: the 20 of a dodecahedron].
    pub views: ViewsName,
    /// Width and height in pixels [default: 256].
    pub size: u32,
    /// Samples per pixel along each axis: 1, 2 or 4 [default: 1].
    pub samples: u32,
    /// Perspective or orthographic [default: perspective].
    pub projection: Projection,
    /// Lighting of triangles [default: flat].
    pub shading: Shading,
    /// Which side is left out [default: none].
    pub cull: Cull,
    /// Bits of the sub-pixel grid: 8, as GPUs have, or 16 [default: 8].
    pub subpixel: SubpixelBits,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            views: ViewsName::Dodecahedron,
            size: 256,
            samples: 1,
            projection: Projection::Perspective,
            shading: Shading::default(),
            cull: Cull::None,
            subpixel: SubpixelBits::Eight,
        }
    }
}

impl RenderOptions {
    /// Draws these views.
    #[must_use]
    pub fn views(mut self, views: ViewsName) -> Self {
        self.views = views;
        self
    }

    /// Draws images of `size` x `size` pixels with `samples` x `samples` samples each.
    #[must_use]
    pub fn pictures(mut self, size: u32, samples: u32) -> Self {
        (self.size, self.samples) = (size, samples);
        self
    }

    /// Lights triangles in this way.
    #[must_use]
    pub fn shading(mut self, shading: Shading) -> Self {
        self.shading = shading;
        self
    }

    /// Leaves out triangles that show this side.
    #[must_use]
    pub fn cull(mut self, cull: Cull) -> Self {
        self.cull = cull;
        self
    }

    /// Makes the views around a sphere, in its units.
    ///
    /// # Errors
    /// [`Error::Usage`] for a size or a number of samples out of range; what reading a view file says.
    pub(crate) fn view_set(&self, sphere: &Sphere) -> Result<ViewSet> {
        let mut set = view::resolve(&self.views, sphere, [self.size; 2], self.projection)?;
        if matches!(self.views, ViewsName::File(_)) {
            return Ok(set);
        }
        set.subpixel = self.subpixel;
        set.with_shading(self.shading)
            .with_cull(self.cull)
            .with_samples(self.samples)
    }
}

/// Images of one view. Triangles count as in the mesh that was drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ViewImages {
    /// Luma of every pixel, 0 to 255: the mean of its samples.
    pub luma: Grid<u8>,
    /// Red, green and blue of every pixel: the mean of its samples.
    pub rgb: Grid<[u8; 3]>,
    /// 1 + the triangle at every sample, 0 for the background.
    pub ids: Grid<u32>,
    /// Depth at every sample in units of 2^-32, `u32::MAX` for the background.
    pub depths: Grid<u32>,
}

/// Images of a mesh, and the views that others can draw them from.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rendering {
    /// The views in the units of the mesh.
    pub views: ViewSet,
    /// The images of every view, in order.
    pub images: Vec<ViewImages>,
    /// Triangles that some view could not draw, because a coordinate was not finite in it.
    pub dropped: u64,
}

/// Draws reference images of a mesh from all around.
///
/// Exact: no other thread count, build or CPU changes a bit. O(triangles + samples) for every view.
///
/// # Errors
/// [`Error::Usage`] where the mesh has no triangles or an option is out of range; what reading a view file says.
pub fn render(mesh: &Mesh, options: &RenderOptions) -> Result<Rendering> {
    render_with(mesh, options, &Silent)
}

/// [`render`](fn@render), watched by `progress`.
///
/// # Errors
/// As [`render`](fn@render), and [`Error::Interrupted`].
pub fn render_with(
    mesh: &Mesh,
    options: &RenderOptions,
    progress: &dyn Progress,
) -> Result<Rendering> {
    let sphere = Sphere::of_mesh(mesh)
        .ok_or_else(|| Error::Usage("a mesh without triangles shows nothing".into()))?;
    let views = options.view_set(&sphere)?;
    let mut images = Vec::with_capacity(views.views.len());
    let dropped = draw(mesh, &views, progress, |_, picture| {
        images.push(ViewImages {
            luma: luma(picture, views.samples),
            rgb: raster::mean_rgb(&picture.tones, views.samples),
            ids: raster::ids(picture),
            depths: raster::depths(picture),
        });
        Ok(())
    })?;
    Ok(Rendering {
        views,
        images,
        dropped,
    })
}

/// Draws a mesh in every view, in the units of the mesh, and hands `take` the number of the view and its picture; the
/// answer is the number of triangles that some view could not draw.
///
/// # Errors
/// [`Error::Interrupted`]; that of `take`.
pub(crate) fn draw(
    mesh: &Mesh,
    views: &ViewSet,
    progress: &dyn Progress,
    mut take: impl FnMut(usize, &Picture<[u8; 3]>) -> Result<()>,
) -> Result<u64> {
    let frame = frame_of(mesh);
    let (framed, scene) = (
        views.enter_frame(frame),
        Scene::of(&mesh.enter_frame(frame)),
    );
    let mut dropped = 0;
    for (i, view) in framed.views.iter().enumerate() {
        progress.step("render", i as u64, framed.views.len() as u64)?;
        let picture = raster::rgb(&scene, view, &framed);
        dropped += picture.dropped;
        take(i, &picture)?;
    }
    Ok(dropped)
}

/// Luma of every pixel: the mean of its samples.
pub(crate) fn luma(picture: &Picture<[u8; 3]>, samples: u32) -> Grid<u8> {
    raster::mean_luma(&raster::sum_samples(&picture.luma(), samples), samples)
}

/// Writes `scene.json`, the view file with the hashes of its images, into a folder.
///
/// # Errors
/// [`Error::Io`].
pub(crate) fn write_scene(folder: &Path, views: &ViewSet, hashes: &[ImageHashes]) -> Result<()> {
    let scene = view::file::to_json(views, hashes)?;
    atomic::write_bytes(&folder.join("scene.json"), scene.as_bytes())
}

impl Rendering {
    /// Writes `view-NN-luma.png`, `view-NN-rgb.png`, `view-NN-ids.npy`, `view-NN-depth.npy` and `scene.json`, the view
    /// file with the hashes of the images, into a folder, which is made if missing.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<()> {
        let folder = folder.as_ref();
        atomic::folder(folder)?;
        let mut hashes = Vec::with_capacity(self.images.len());
        for (i, images) in self.images.iter().enumerate() {
            let path = |name: &str| folder.join(format!("view-{i:02}-{name}"));
            png::write_grey(&path("luma.png"), &images.luma)?;
            png::write_rgb(&path("rgb.png"), &images.rgb)?;
            npy::write_plane(&path("ids.npy"), &images.ids)?;
            npy::write_plane(&path("depth.npy"), &images.depths)?;
            hashes.push(ImageHashes::from([
                ("luma".into(), hash::plane_sha256(&images.luma)),
                ("ids".into(), hash::plane_sha256(&images.ids)),
                ("depth".into(), hash::plane_sha256(&images.depths)),
            ]));
        }
        write_scene(folder, &self.views, &hashes)
    }
}
