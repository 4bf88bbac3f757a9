//! Pinched vertices: sheets that touch there in a point and hang together through no edge.

/// Most faces at a vertex that are compared pair by pair; for more a forest is built.
const FEW: usize = 16;

/// True where the faces at a vertex, given by their sides across from it, do not hang together through edges at the
/// vertex.
///
/// O(faces) for the usual fan, O(faces log faces) around a hub.
#[inline]
pub(super) fn is_pinched(sides: impl Iterator<Item = [u32; 2]> + Clone) -> bool {
    let mut fan = [[0_u32; 2]; FEW];
    let mut count = 0;
    for side in sides.clone() {
        if count == fan.len() {
            return is_hub_pinched(&sides.collect::<Vec<_>>());
        }
        fan[count] = side;
        count += 1;
    }
    // Faces that are reached come first.
    let mut reached = count.min(1);
    let mut next = 0;
    while next < reached {
        let [a, b] = fan[next];
        let mut i = reached;
        while i < count {
            let [c, d] = fan[i];
            if a == c || a == d || b == c || b == d {
                fan.swap(reached, i);
                reached += 1;
            }
            i += 1;
        }
        next += 1;
    }
    reached < count
}

/// [`is_pinched`] for many faces: they hang together where the vertices across do.
fn is_hub_pinched(sides: &[[u32; 2]]) -> bool {
    let mut vertices: Vec<u32> = sides.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let index = |v: u32| vertices.binary_search(&v).unwrap_or(0);
    let mut forest = Forest::of(vertices.len());
    for side in sides {
        let [a, b] = side.map(index);
        forest.unite(a, b);
    }
    let mut roots = sides.iter().map(|side| forest.root(index(side[0])));
    let first = roots.next();
    roots.any(|r| Some(r) != first)
}

/// Disjoint sets of the numbers below a count; each has its smallest member as its root.
#[derive(Debug)]
pub(crate) struct Forest {
    parents: Vec<usize>,
}

impl Forest {
    /// Every number alone.
    pub(crate) fn of(count: usize) -> Self {
        Self {
            parents: (0..count).collect(),
        }
    }

    /// The root of a number's set; makes the way there shorter.
    pub(crate) fn root(&mut self, mut at: usize) -> usize {
        while self.parents[at] != at {
            self.parents[at] = self.parents[self.parents[at]];
            at = self.parents[at];
        }
        at
    }

    /// Makes one set of two.
    pub(crate) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b);
    }
}
