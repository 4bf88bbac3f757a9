//! `lodmark billboards`: a scene on textured quads for the viewers of a cell.

use std::path::PathBuf;

use serde_json::json;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    bound::{planar::Aperture, view_cell},
    simplify::billboards::{self, Limit, Up},
};

/// Replace a scene by textured quads that viewers in a cell cannot tell from it (Eisemann & Décoret 2007)
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::cells())]
pub(super) struct BillboardsArgs {
    /// The scene: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Folder for billboards.obj, billboards.mtl and quad-NNNN.png; made if missing
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Where viewers may be: a view cell as JSON
    #[arg(long, value_name = "FILE")]
    cell: PathBuf,
    /// Largest angle across the horizon under which a viewer may see a point displaced, in [0, 90)
    #[arg(long, value_name = "DEGREES", required_unless_present = "error_abs")]
    error_deg: Option<f64>,
    /// Instead of an angle, a distance by which points may be displaced, wherever viewers are
    #[arg(long, value_name = "LENGTH", conflicts_with = "error_deg")]
    error_abs: Option<f64>,
    /// The axis that points up
    #[arg(long, value_enum, default_value = "z")]
    up: Up,
    /// Directions of planes over half a turn, 1 to 4096; the scene is projected on them across and slanted
    #[arg(long, value_name = "N", default_value_t = billboards::BillboardOptions::DIRECTIONS)]
    directions: u32,
    /// Most texels in a row or column of a texture, 1 to 4096
    #[arg(long, value_name = "N", default_value_t = billboards::BillboardOptions::TEXELS)]
    texels: u32,
    /// Draw all horizontal faces at one height, as the paper does: nothing bounds how far they go up or down
    #[arg(long)]
    any_height: bool,
}

impl BillboardsArgs {
    fn resolved(&self) -> Result<billboards::BillboardOptions> {
        let limit = match (self.error_deg, self.error_abs) {
            (Some(degrees), _) => Limit::Angle(Aperture::degrees(degrees)?),
            (None, Some(distance)) => Limit::Distance(distance),
            (None, None) => {
                let told = "no bound; give --error-deg or --error-abs";
                return Err(Error::Usage(told.into()));
            }
        };
        Ok(billboards::BillboardOptions {
            limit,
            up: self.up,
            directions: self.directions,
            texels: self.texels,
            any_height: self.any_height,
        })
    }
}

pub(super) fn run(args: &BillboardsArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let wanted = args.resolved()?;
    let cell = view_cell::file::read(&args.cell)?;
    let mesh = input::read(&args.input, true, terminal)?;
    input::require_triangles(&args.input, &mesh)?;
    let cloud = billboards::billboards(&mesh, &cell, &wanted, terminal)?;
    let path = billboards::files::write(&args.folder, &cloud, &mesh, terminal)?;
    let horizontal = cloud.quads.iter().filter(|q| q.horizontal).count();
    let most = |q: &&billboards::Quad| q.texels.contains(&wanted.texels);
    let coarse = cloud.quads.iter().filter(most).count();
    let moved = [cloud.displacement.horizontal, cloud.displacement.vertical];
    let [across, along] = moved.map(|angle| angle * (180.0 / std::f64::consts::PI));
    report(
        common,
        "billboards",
        json!({
            "input": args.input, "cell": args.cell, "error_deg": args.error_deg,
            "error_abs": args.error_abs, "up": args.up, "directions": wanted.directions,
            "texels": wanted.texels, "any_height": wanted.any_height,
        }),
        json!({
            "folder": args.folder, "triangles_in": mesh.triangles().len(), "quads": cloud.quads.len(),
            "quads_vertical": cloud.quads.len() - horizontal, "quads_horizontal": horizontal,
            "triangles_kept": cloud.kept.len(), "quads_at_texel_limit": coarse,
            "displacement_horizontal_deg": across, "displacement_vertical_deg": along,
        }),
    )?;
    if coarse > 0 {
        terminal.say(&format!(
            "{coarse} textures have the most texels allowed and may be coarser than the bound; give --texels"
        ));
    }
    answer!(
        "{}: {} triangles on {} vertical and {horizontal} horizontal quads, {} triangles kept",
        path.display(),
        mesh.triangles().len() - cloud.kept.len(),
        cloud.quads.len() - horizontal,
        cloud.kept.len()
    );
    answer!(
        "points are displaced by at most {across:.4} degrees across the horizon and {along:.4} degrees up or down"
    );
    Ok(Verdict::Good)
}
