//! Where textures, quads and the ground that is free of viewers end.

use lodmark::mesh::generate;

use super::{before_the_city, blocks, cloud, in_the_forest, within};
use crate::support::{at, mesh_of};

#[test]
fn a_filter_mixes_no_texel_with_nothing() {
    let mesh = blocks(40);
    let cloud = cloud(&mesh, &before_the_city(), &within(0.3));
    let (mut border, mut far) = (0, 0);
    for quad in cloud.quads.iter().filter(|q| q.replaces.len() > 4).take(8) {
        let texture = quad.texture(&mesh);
        let (width, height) = (texture.width(), texture.height());
        for y in 0..height {
            for x in 0..width {
                let texel = texture.at(x, y);
                if texel[3] != 0 {
                    continue;
                }
                let mut beside = (y.saturating_sub(1)..(y + 2).min(height))
                    .flat_map(|j| (x.saturating_sub(1)..(x + 2).min(width)).map(move |i| (i, j)));
                if beside.any(|(i, j)| texture.at(i, j)[3] != 0) {
                    border += 1;
                    assert!(texel[..3].iter().all(|&c| c > 0), "{texel:?} at {x}, {y}");
                } else {
                    far += 1;
                    assert_eq!(texel, [0; 4], "{x}, {y}");
                }
            }
        }
    }
    assert!(border > 100 && far > 100, "{border} {far}");
}

#[test]
fn a_wall_behind_the_plane_of_viewers_is_not_moved() {
    // Among the viewers, through their border, before them.
    let among = [at(0.0, -8.0, 0.0), at(2.0, -8.0, 0.0), at(0.0, -8.0, 3.0)];
    let through = [at(0.0, -7.0, 0.0), at(0.0, -3.0, 0.0), at(0.0, -3.0, 3.0)];
    let before = [at(0.0, 2.0, 0.0), at(2.0, 2.0, 0.0), at(0.0, 2.0, 3.0)];
    let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
    let mesh = mesh_of([among, through, before].concat(), faces);
    let cloud = cloud(&mesh, &before_the_city(), &within(1.0));
    assert_eq!(cloud.kept, [0, 1]);
    assert_eq!(cloud.quads.len(), 1);
}

#[test]
fn a_wall_beside_a_plane_that_takes_it_too_is_drawn_there_against_cracks() {
    let mesh = generate::trees(400, 120.0);
    let cloud = cloud(&mesh, &in_the_forest(), &within(0.5));
    let mut shared = 0;
    for quad in cloud.quads.iter().filter(|q| !q.horizontal) {
        let is_drawn = |t| quad.drawn.binary_search(t).is_ok();
        assert!(quad.replaces.iter().all(is_drawn));
        shared += quad.drawn.len() - quad.replaces.len();
    }
    assert!(shared > 0, "nothing is drawn twice");
}
