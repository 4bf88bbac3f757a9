//! The sections of a glTF document: kept as the text that they are, and parsed where the mesh needs them.

use std::{collections::BTreeMap, fmt};

use serde::{
    Deserialize, Deserializer,
    de::{DeserializeOwned, IgnoredAny, MapAccess, Visitor},
};
use serde_json::value::RawValue;

use super::wrong;
use crate::{Error, Result, mesh::Asset};

/// Extensions that a document may require: nothing in them changes how a mesh is read, or it is read here.
const SUPPORTED: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// The advice about a mesh under Draco compression. Version 4.5 of this tool was seen to decode it.
pub(super) const DRACO: &str = "Draco compression (KHR_draco_mesh_compression) is not supported; decode the file first: \
                                npx @gltf-transform/cli copy in.glb out.glb";

/// The parts of a document that a mesh is made of. Unknown members are left to the raw text.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub accessors: Vec<Accessor>,
    pub buffers: Vec<Buffer>,
    pub views: Vec<BufferView>,
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub nodes: Vec<Node>,
    pub skins: Vec<Skin>,
    pub scenes: Vec<Scene>,
    /// The default scene.
    pub scene: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub shape: String,
    pub sparse: Option<Box<Sparse>>,
}

/// Elements of an accessor that differ from those of its view.
#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: usize,
    #[serde(default)]
    pub extensions: BufferExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct BufferExtensions {
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    pub meshopt: Option<Fallback>,
}

/// Whether a buffer only stands in for what compressed views hold: it may have no bytes.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Fallback {
    #[serde(default)]
    pub fallback: bool,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
    #[serde(default)]
    pub extensions: BufferViewExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct BufferViewExtensions {
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    pub meshopt: Option<Box<Meshopt>>,
}

/// Where the compressed bytes of a view lie.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Meshopt {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: usize,
    pub count: usize,
    pub mode: String,
    pub filter: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct Primitive {
    /// Accessors by name.
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub targets: Vec<BTreeMap<String, usize>>,
    #[serde(default)]
    pub extensions: PrimitiveExtensions,
}

impl Primitive {
    /// Whether it consists of triangles, strips or fans; the others are points and lines.
    pub(super) fn has_triangles(&self) -> bool {
        !matches!(self.mode, Some(0..=3))
    }
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub draco: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Material {
    pub name: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    #[serde(default)]
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    /// Column by column.
    pub matrix: Option<Box<[f64; 16]>>,
    pub translation: Option<[f64; 3]>,
    /// A quaternion: x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    #[serde(default)]
    pub extensions: NodeExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Box<Instancing>>,
}

/// The accessors of the transforms of many instances.
#[derive(Debug, Deserialize)]
pub(super) struct Instancing {
    #[serde(default)]
    pub attributes: BTreeMap<String, usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub inverse_bind_matrices: Option<usize>,
    pub joints: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Version {
    version: String,
    min_version: Option<String>,
}

/// Splits the text of a document into its sections, in its order.
pub(super) fn sections(text: &str) -> Result<Vec<(String, String)>> {
    let Sections(found) = serde_json::from_str(text).map_err(|error| {
        wrong(format!(
            "the JSON text is damaged: {error}; expected the object of a glTF document"
        ))
    })?;
    let mut names: Vec<&String> = found.iter().map(|(name, _)| name).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(wrong(format!(
            "the section `{}` stands twice; expected each at most once",
            pair[0]
        )));
    }
    Ok(found)
}

struct Sections(Vec<(String, String)>);

impl<'de> Deserialize<'de> for Sections {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Members;
        impl<'de> Visitor<'de> for Members {
            type Value = Sections;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Sections, A::Error> {
                let mut found = Vec::new();
                while let Some((name, text)) = members.next_entry::<String, Box<RawValue>>()? {
                    found.push((name, text.get().to_owned()));
                }
                Ok(Sections(found))
            }
        }
        from.deserialize_map(Members)
    }
}

impl Document {
    /// Parses the sections that a mesh needs. O(text).
    ///
    /// # Errors
    /// [`Error::Input`] for a section that does not have its form; [`Error::Unsupported`] for another version of glTF, and
    /// for an extension that is required and unknown.
    pub(super) fn parse(asset: &Asset) -> Result<Self> {
        let Some(version) = section::<Option<Version>>(asset, "asset")? else {
            return Err(wrong(
                "there is no section `asset`; expected a glTF 2.0 document",
            ));
        };
        let needed = version.min_version.as_ref().unwrap_or(&version.version);
        if needed.split('.').next() != Some("2")
            || (version.min_version.is_some() && needed != "2.0")
        {
            return Err(Error::Unsupported(format!(
                "glTF {needed} is not supported; convert the file to glTF 2.0"
            )));
        }
        for name in section::<Vec<String>>(asset, "extensionsRequired")? {
            if name == "KHR_draco_mesh_compression" {
                return Err(Error::Unsupported(DRACO.into()));
            }
            if !SUPPORTED.contains(&name.as_str()) && !name.starts_with("KHR_materials_") {
                return Err(Error::Unsupported(format!(
                    "the file requires the extension {name}, which is not supported; export it without"
                )));
            }
        }
        Ok(Self {
            accessors: section(asset, "accessors")?,
            buffers: section(asset, "buffers")?,
            views: section(asset, "bufferViews")?,
            meshes: section(asset, "meshes")?,
            materials: section(asset, "materials")?,
            nodes: section(asset, "nodes")?,
            skins: section(asset, "skins")?,
            scenes: section(asset, "scenes")?,
            scene: section(asset, "scene")?,
        })
    }
}

/// Parses a section; its default where there is none.
fn section<T: DeserializeOwned + Default>(asset: &Asset, name: &str) -> Result<T> {
    let Some((_, text)) = asset.sections.iter().find(|(known, _)| known == name) else {
        return Ok(T::default());
    };
    serde_json::from_str(text).map_err(|error| {
        wrong(format!(
            "the section `{name}` does not have its form: {error} of the section"
        ))
    })
}

/// The element of a list that an index names; `what` is the name of the list, `from` says who names it.
pub(super) fn named<'a, T>(
    list: &'a [T],
    index: usize,
    what: &str,
    from: impl FnOnce() -> String,
) -> Result<&'a T> {
    list.get(index).ok_or_else(|| {
        wrong(format!(
            "{} names {what}[{index}], but there are {}",
            from(),
            list.len()
        ))
    })
}
