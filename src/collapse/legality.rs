//! The rules of a legal collapse and its place: topology, features, locks, and the shape of the faces that stay.
//!
//! Topology: the link condition of Dey, Edelsbrunner, Guha & Nekhayev 1999 for 2-complexes, which assumes no
//! manifold: edges that have not exactly two faces (boundaries, fins) form a graph that a collapse must preserve too.
//! Features: edges where texture coordinates, colours or materials differ, where a texture is mirrored, or with more
//! than two faces. Shape: the normal of a face that stays turns by less than the given angle in every single step
//! (a bare sign test lets a chain of steps near 90 degrees flip a face), and no face becomes degenerate.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{
    EdgeStar, Evaluation, LiveMesh, Patch, Refusal, check_collapse_folds,
    edge_star::normal,
    wedge::{self, WedgeValues},
};
use crate::num::Each;

/// Treatment of the topology by collapses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Topology {
    /// As preserved where the target can be met so. Else, settled before the run, seams lose their course where least is
    /// lost, pieces vanish that no view sees, holes close and parts merge, and faces turn over in the texture, in this order.
    #[default]
    Auto,
    /// Holes, handles, components, boundaries, non-manifold curves and the course of seams stay as they are.
    Preserve,
    /// Any edge may be collapsed (Lindstrom & Turk 2000, section 5.2); faces that coincide become one.
    Free,
}

/// Limits of a collapse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rules {
    /// Treatment of the topology.
    pub topology: Topology,
    /// Smallest cosine between the normals of a face before and after one collapse, in [0, 1).
    pub normal_cosine: f64,
    /// Smallest cosine between the normals of two neighbouring faces that a change may lead to, in [-1, 1); -1 allows
    /// any fold. Where an edge is sharper already, it may stay so.
    #[serde(default = "no_fold")]
    pub fold_cosine: f64,
    /// Let pieces that are seen and materials vanish with the topology; else [`Topology::Auto`] leaves a triangle of each.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub drop_pieces: bool,
    /// The last of the concessions so far; none but in a run under [`Topology::Auto`].
    #[serde(skip)]
    pub concession: Concession,
}

/// A rule that gives way, in this order and only as far as the target needs, where no edge may collapse any more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Concession {
    /// Nothing.
    #[default]
    None,
    /// The course of seams: a face may take the values of the chart beside it.
    Seams,
    /// Pieces that no view sees may vanish. Before the topology, which may open what hides them.
    UnseenPieces,
    /// Holes may close and parts may merge; every piece that is seen keeps a triangle.
    Topology,
    /// A face may turn over in the texture.
    Texture,
}

impl Concession {
    /// The name, as a phrase that `give way` follows.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "nothing",
            Self::Seams => "seams",
            Self::UnseenPieces => "unseen pieces",
            Self::Topology => "topology",
            Self::Texture => "sides of the texture",
        }
    }
}

impl Rules {
    /// The rules that a run goes through one after the other while its target is not met.
    pub fn steps(self) -> impl Iterator<Item = Self> {
        use Concession::{None, Seams, Texture, Topology as Holes, UnseenPieces};
        let count = if self.topology == Topology::Auto {
            5
        } else {
            1
        };
        let steps = [None, Seams, UnseenPieces, Holes, Texture];
        let steps = steps.into_iter().take(count);
        let steps = steps.filter(move |&step| step >= self.concession);
        steps.map(move |concession| Self { concession, ..self })
    }

    /// True where the topology around an edge need not be preserved.
    fn is_topology_free(self, live: &LiveMesh, ends: [u32; 2]) -> bool {
        self.topology == Topology::Free
            || self.concession >= Concession::Topology
            || self.concession == Concession::UnseenPieces && is_expendable(live, ends)
    }

    /// True where the star may vanish as a whole, though faces are left elsewhere.
    fn may_vanish(self, live: &LiveMesh, ends: [u32; 2]) -> bool {
        self.concession < Concession::UnseenPieces || self.drop_pieces || is_expendable(live, ends)
    }
}

fn is_expendable(live: &LiveMesh, ends: [u32; 2]) -> bool {
    ends.iter().all(|&v| live.is_expendable(v))
}

/// Sharper than 143 degrees is a fold, not a feature.
const fn no_fold() -> f64 {
    -0.8
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            topology: Topology::default(),
            normal_cosine: 0.2,
            fold_cosine: no_fold(),
            drop_pieces: false,
            concession: Concession::None,
        }
    }
}

/// Places that the rules leave to the new vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Anywhere.
    Free,
    /// Only at this end of the edge (an index into [`EdgeStar::ends`]).
    At(usize),
}

/// A position that was rounded to the file's precision and then passed every rule at its [`Site`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Admitted(DVec3);

impl Admitted {
    /// The position in frame units.
    pub fn position(self) -> DVec3 {
        self.0
    }
}

/// An edge that may be collapsed, as a method sees it.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// The mesh.
    pub live: &'a LiveMesh,
    /// The faces around the edge.
    pub star: &'a EdgeStar,
    /// Places that the rules leave to the new vertex.
    pub anchor: Anchor,
    /// A seam would lose its course, as [`Concession::Seams`] has it.
    pub breaks_seam: bool,
    /// The rules.
    pub rules: Rules,
    /// Accuracy that is asked for: [`Evaluation::Exact`] unless the method's plan has rough evaluations.
    pub accuracy: Evaluation,
    /// The values of new wedges, where a method gives some.
    pub values: Option<&'a dyn WedgeValues>,
}

impl<'a> Site<'a> {
    /// The site of a star, for an exact evaluation.
    ///
    /// # Errors
    /// The rule that forbids this collapse wherever the new vertex lies.
    pub fn new(live: &'a LiveMesh, star: &'a EdgeStar, rules: Rules) -> Result<Self, Refusal> {
        let (anchor, breaks_seam) = anchor(live, star, rules)?;
        Ok(Self {
            live,
            star,
            anchor,
            breaks_seam,
            rules,
            accuracy: Evaluation::Exact,
            values: None,
        })
    }

    /// The one position the rules leave, or `None` where the method chooses.
    pub fn fixed(&self) -> Option<DVec3> {
        match self.anchor {
            Anchor::Free => None,
            Anchor::At(end) => Some(self.star.points[end]),
        }
    }

    /// The area (frame units squared) that a broken seam gives to another chart; 0 where no seam breaks.
    pub fn seam_loss(&self, position: Admitted) -> f64 {
        if self.breaks_seam {
            wedge::displaced_area(self.star, position.0)
        } else {
            0.0
        }
    }

    /// Rounds a position to the file's precision and tests it. Judge costs at what this returns.
    ///
    /// # Errors
    /// The rule that forbids it. A position away from the anchor is [`Refusal::Locked`].
    pub fn admit(&self, position: DVec3) -> Result<Admitted, Refusal> {
        let position = self.live.round(position).ok_or(Refusal::Unplaced)?;
        if self.fixed().is_some_and(|p| p != position) {
            return Err(Refusal::Locked);
        }
        shape(self.star, position, self.rules)?;
        check_collapse_folds(self.live, self.star, position, self.rules)?;
        let may_turn = self.rules.concession == Concession::Texture;
        if !may_turn && wedge::turns_texture(self.live, self.star, (position, self.values)) {
            return Err(Refusal::Mirror);
        }
        Ok(Admitted(position))
    }

    /// Fills `patch` with the collapse to `position`: the faces of this candidate, under their final ids.
    pub fn patch(&self, position: Admitted, patch: &mut Patch) {
        self.star
            .patch_by(self.live, position.0, self.values, patch);
    }
}

/// Most faces around an edge that may collapse. A file of a megabyte can hold a vertex with 30,000 faces; to
/// visit all of them for each of its edges would take hours. Collapses at the rim bring such a vertex below the limit. A
/// method may have a lower one: [`Plan::star_limit`](super::Plan::star_limit).
pub const STAR_LIMIT: usize = 512;

/// Finds the places that the rules which do not depend on the new position leave to the new vertex, and whether a seam
/// loses its course.
///
/// # Errors
/// The first rule that forbids the collapse altogether.
fn anchor(live: &LiveMesh, star: &EdgeStar, rules: Rules) -> Result<(Anchor, bool), Refusal> {
    // Where faces are left elsewhere, the star may vanish as a whole.
    let everything = live.triangle_count() <= star.faces.len();
    let vanishes = !star.faces.iter().any(|f| f.survives);
    if vanishes && (everything || !rules.may_vanish(live, star.ends)) {
        return Err(Refusal::LastTriangle);
    }
    if star.takes_locked(live, vanishes) {
        return Err(Refusal::Locked);
    }
    let free = rules.is_topology_free(live, star.ends);
    if !free {
        topology(star)?;
    }
    counts(live, star, rules)?;
    let (feature, breaks_seam) = features(star, rules, free)?;
    let locked = star.ends.each(|v| live.is_locked(v));
    let anchor = match (locked, feature) {
        ([false, false], anchor) => anchor,
        ([true, false], Anchor::Free | Anchor::At(0)) => Anchor::At(0),
        ([false, true], Anchor::Free | Anchor::At(1)) => Anchor::At(1),
        _ => return Err(Refusal::Locked),
    };
    Ok((anchor, breaks_seam))
}

/// Tests the rules that depend on faces elsewhere: no material vanishes, no mesh of a document gets less than its share.
///
/// # Errors
/// [`Refusal::LastTriangle`] or [`Refusal::Share`].
pub(super) fn counts(live: &LiveMesh, star: &EdgeStar, rules: Rules) -> Result<(), Refusal> {
    let gone = star.faces.iter().filter(|f| !f.survives).map(|f| f.id);
    let keeps_materials = rules.topology != Topology::Free && !rules.drop_pieces;
    if keeps_materials && live.takes_last_of_material(gone.clone()) {
        return Err(Refusal::LastTriangle);
    }
    if live.has_its_share(gone) {
        return Err(Refusal::Share);
    }
    Ok(())
}

fn topology(star: &EdgeStar) -> Result<(), Refusal> {
    let common = |s: &super::Spoke| s.faces[0] > 0 && s.faces[1] > 0;
    if star.spokes.iter().any(|s| common(s) && !s.beside) {
        return Err(Refusal::Link);
    }
    if star.faces.iter().any(|f| !f.survives && !f.has_both()) {
        return Err(Refusal::Duplicate);
    }
    let singular = |count: u32| count != 0 && count != 2;
    if star.edge_faces == 2 {
        // Pinched vertices are found last: the walk around them is the dearest test.
        let on_graph = |end| star.singular_degree(end) > 0 || star.is_pinched(end);
        if on_graph(0) && on_graph(1) {
            return Err(Refusal::Pinch);
        }
        return Ok(());
    }
    let ear = |s: &super::Spoke| singular(s.faces[0]) && singular(s.faces[1]);
    if star.spokes.iter().any(ear) {
        return Err(Refusal::Ear);
    }
    let corner = |end| star.singular_degree(end) != 2 || star.is_pinched(end);
    if corner(0) && corner(1) {
        return Err(Refusal::Corner);
    }
    Ok(())
}

/// Seams and borders of materials keep their course (notes: section 3.4, rules a to d); the second is true where one
/// does not.
fn features(star: &EdgeStar, rules: Rules, free: bool) -> Result<(Anchor, bool), Refusal> {
    let complex = star.spokes.iter().any(|s| s.faces[0] > 2 || s.faces[1] > 2);
    if free && (complex || star.edge_faces > 2) {
        return Ok((Anchor::Free, false));
    }
    let degree = star.feature_degree;
    // Along a feature only its ends and branchings stay, beside one all that lies on it.
    let (stays, refusal) = if star.edge_feature {
        let corner = degree.each(|d| d != 0 && d != 2);
        (corner, Refusal::FeatureCorner)
    } else {
        (degree.each(|d| d > 0), Refusal::FeaturePinch)
    };
    match stays {
        [false, false] => Ok((Anchor::Free, false)),
        [true, false] => Ok((Anchor::At(0), false)),
        [false, true] => Ok((Anchor::At(1), false)),
        [true, true] if rules.concession >= Concession::Seams => Ok((Anchor::Free, true)),
        [true, true] => Err(refusal),
    }
}

/// Smallest ratio of twice the area to the squared longest side below which a triangle counts as degenerate.
///
/// Far below what shapes need and far above what rounding leaves of a normal computed from `f32` coordinates in a
/// frame of size 1.
pub const DEGENERATE: f64 = 1e-7;

/// Tests the faces that stay with the new vertex at `position` (frame units, already rounded).
///
/// # Errors
/// [`Refusal::Degenerate`] or [`Refusal::Flip`].
pub fn shape(star: &EdgeStar, position: DVec3, rules: Rules) -> Result<(), Refusal> {
    for face in star.faces.iter().filter(|f| f.survives) {
        turn(face.points, face.normal, face.points_after(position), rules)?;
    }
    Ok(())
}

/// Tests a face that changes its shape; `old` is twice its area along its normal before.
///
/// # Errors
/// [`Refusal::Degenerate`] or [`Refusal::Flip`].
#[inline]
pub(super) fn turn(
    before: [DVec3; 3],
    old: DVec3,
    after: [DVec3; 3],
    rules: Rules,
) -> Result<(), Refusal> {
    let new = normal(after);
    let (old2, new2) = (old.dot(old), new.dot(new));
    if is_degenerate(after, new2) {
        return if was_as_bad(before, old2, after, new2) {
            Ok(())
        } else {
            Err(Refusal::Degenerate)
        };
    }
    if is_degenerate(before, old2) {
        return Ok(());
    }
    let least = rules.normal_cosine * rules.normal_cosine;
    let cosine = old.dot(new);
    if cosine <= 0.0 || cosine * cosine <= least * (old2 * new2) {
        return Err(Refusal::Flip);
    }
    Ok(())
}

/// True where `normal2`, the squared length of the cross product, is too small for the triangle's longest side.
pub fn is_degenerate(points: [DVec3; 3], normal2: f64) -> bool {
    let side2 = longest2(points);
    normal2 <= (DEGENERATE * DEGENERATE) * (side2 * side2)
}

fn was_as_bad(before: [DVec3; 3], old2: f64, after: [DVec3; 3], new2: f64) -> bool {
    let (side_old, side_new) = (longest2(before), longest2(after));
    is_degenerate(before, old2) && new2 * (side_old * side_old) >= old2 * (side_new * side_new)
}

fn longest2([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (b - a, c - b, a - c);
    x.dot(x).max(y.dot(y)).max(z.dot(z))
}
