//! The triangles around a new vertex in the plane of a layout, and polygons cut along the spokes between them.
//!
//! A polygon is not clipped by lines but walked around: each corner belongs to the sector that it lies deepest in, and a
//! side crosses the spokes between the sectors of its ends. So the parts fit together whatever the rounding: the sides
//! along a spoke come in pairs of opposite directions with the same ends, bit for bit, and all other sides are those of
//! the polygon. New corners come only where a crossed side lies on a side of the original triangle, and are exactly on
//! that; other sides are shared with pieces outside of the layout and cross at one of their ends.

use glam::DVec2;

use super::{layout::Part, outline::OutlineCorner, sides::Side};
use crate::num::{Each, fixed::Weights31, math::sqrt};

/// Corners no farther than this from a spoke lie on it: a few roundings of weights, in a plane where faces have a size
/// near 1.
const SNAP: f64 = 4e-9;

/// Sectors around a hub.
#[derive(Clone, Debug)]
pub(super) struct Sectors {
    hub: DVec2,
    /// The last sector ends where the first one begins.
    closed: bool,
    /// Directions of the sides of the sectors, one more than sectors.
    spokes: Vec<DVec2>,
    sectors: Vec<Part>,
}

/// An event of a walk around a polygon.
#[derive(Clone, Copy, Debug)]
enum Event {
    Corner(OutlineCorner),
    /// Into the next sector, or back, at a point.
    Crossing {
        spoke: usize,
        forward: bool,
        at: OutlineCorner,
    },
}

/// The continuation of a crossing: at another crossing, or over the hub.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Link {
    Open,
    Crossing(usize),
    Hub,
}

/// Buffers of a cut.
#[derive(Clone, Debug, Default)]
pub(super) struct CutScratch {
    sectors: Vec<usize>,
    events: Vec<Event>,
    /// Events that are crossings, by spoke and distance from the hub.
    crossings: Vec<(usize, f64, usize)>,
    links: Vec<Link>,
    visited: Vec<bool>,
    polygon: Vec<OutlineCorner>,
}

impl Sectors {
    /// Sectors in counter-clockwise order, each with the corner that is the hub; `None` where they go around it more than
    /// once.
    pub(super) fn new(hub: DVec2, closed: bool, parts: Vec<(Part, usize)>) -> Option<Self> {
        let direction = |p: DVec2| {
            let d = p - hub;
            d / sqrt(d.dot(d))
        };
        let mut spokes: Vec<DVec2> = parts
            .iter()
            .map(|(part, apex)| direction(part.plane[(apex + 1) % 3]))
            .collect();
        let (last, apex) = parts.last()?;
        spokes.push(if closed {
            spokes[0]
        } else {
            direction(last.plane[(apex + 2) % 3])
        });
        let first = spokes[0];
        let beyond = if closed { 1 } else { 0 };
        let again = (1..parts.len() - beyond.min(parts.len() - 1))
            .any(|i| spokes[i].perp_dot(first) > 0.0 && first.perp_dot(spokes[i + 1]) > 0.0);
        (!again).then(|| Self {
            hub,
            closed,
            spokes,
            sectors: parts.into_iter().map(|(part, _)| part).collect(),
        })
    }

    /// The sector in which a point lies, or lies nearest to.
    fn sector_of(&self, p: DVec2) -> usize {
        let r = p - self.hub;
        let mut after = self.spokes[0].perp_dot(r);
        let (mut best, mut deepest) = (0, f64::NEG_INFINITY);
        for i in 0..self.sectors.len() {
            let next = self.spokes[i + 1].perp_dot(r);
            let depth = after.min(-next);
            if depth >= 0.0 {
                return i;
            }
            if depth > deepest {
                (best, deepest) = (i, depth);
            }
            after = next;
        }
        best
    }

    fn is_hub(&self, p: DVec2) -> bool {
        let d = p - self.hub;
        d.dot(d) <= SNAP * SNAP
    }

    /// Cuts a polygon along the spokes and calls `visit` with what lies in each sector, as long as that says true.
    /// `None` where that says so, and where the polygon crosses itself or goes around the hub in any other way than once.
    pub(super) fn cut(
        &self,
        outline: &[OutlineCorner],
        scratch: &mut CutScratch,
        visit: &mut dyn FnMut(&Part, &[OutlineCorner]) -> Option<bool>,
    ) -> Option<bool> {
        scratch.sectors.clear();
        let sectors = outline.iter().map(|c| self.sector_of(c.plane));
        scratch.sectors.extend(sectors);
        let first = scratch.sectors[0];
        if scratch.sectors.iter().all(|&s| s == first) {
            return visit(&self.sectors[first], outline);
        }
        let around = self.walk(outline, &mut scratch.sectors, &mut scratch.events)?;
        if scratch.events.len() == outline.len() {
            return visit(&self.sectors[scratch.sectors[0]], outline);
        }
        self.link(
            &scratch.events,
            around,
            &mut scratch.crossings,
            &mut scratch.links,
        )?;
        let hub = around.then(|| OutlineCorner {
            source: hub_source(outline, self.hub),
            plane: self.hub,
            fixed: false,
        });
        scratch.visited.clear();
        scratch.visited.resize(scratch.events.len(), false);
        for start in 0..scratch.events.len() {
            let Event::Crossing { spoke, forward, .. } = scratch.events[start] else {
                continue;
            };
            if scratch.visited[start] {
                continue;
            }
            let sector = self.behind(spoke, forward);
            self.trace(start, sector, hub, scratch)?;
            if !visit(&self.sectors[sector], &scratch.polygon)? {
                return Some(false);
            }
        }
        Some(true)
    }

    /// Traces the part of the polygon in one sector, from the crossing `start` into it and back there; `None` where it
    /// does not come back.
    fn trace(
        &self,
        start: usize,
        sector: usize,
        hub: Option<OutlineCorner>,
        scratch: &mut CutScratch,
    ) -> Option<()> {
        let CutScratch {
            events,
            links,
            visited,
            polygon,
            ..
        } = scratch;
        polygon.clear();
        let mut at = start;
        while !visited[at] {
            visited[at] = true;
            let mut leave = at;
            loop {
                match events[leave] {
                    Event::Corner(corner) | Event::Crossing { at: corner, .. } => {
                        polygon.push(corner);
                    }
                }
                let crossed = matches!(events[leave], Event::Crossing { .. });
                if crossed && leave != at {
                    break;
                }
                leave = (leave + 1) % events.len();
                if leave == at {
                    // A single crossing has nothing to lead back through.
                    return None;
                }
            }
            at = match links[leave] {
                Link::Crossing(other) => other,
                Link::Hub => {
                    polygon.extend(hub);
                    let entry = |i: &usize| {
                        links[*i] == Link::Hub
                            && matches!(events[*i], Event::Crossing { spoke, forward: true, .. }
                                if self.behind(spoke, true) == sector)
                    };
                    (0..events.len()).find(entry)?
                }
                Link::Open => return None,
            };
        }
        (at == start).then_some(())
    }

    /// The sector behind a spoke that is crossed.
    fn behind(&self, spoke: usize, forward: bool) -> usize {
        let m = self.sectors.len();
        if forward {
            spoke % m
        } else {
            (spoke + m - 1) % m
        }
    }

    /// Writes down corners and crossings; true where they go around the hub once.
    fn walk(
        &self,
        outline: &[OutlineCorner],
        sectors: &mut [usize],
        events: &mut Vec<Event>,
    ) -> Option<bool> {
        let (n, m) = (outline.len(), self.sectors.len() as isize);
        let mut hubs = (0..n).filter(|&i| self.is_hub(outline[i].plane));
        let at_hub = hubs.next();
        if hubs.next().is_some() {
            return None;
        }
        if let Some(i) = at_hub {
            sectors[i] = sectors[(i + n - 1) % n];
        }
        let forward = |i: usize| {
            let steps = sectors[(i + 1) % n] as isize - sectors[i] as isize;
            if self.closed {
                steps.rem_euclid(m)
            } else {
                steps
            }
        };
        let steps = |i: usize| {
            let steps = forward(i);
            let (p, q) = (
                outline[i].plane - self.hub,
                outline[(i + 1) % n].plane - self.hub,
            );
            if self.closed && steps > 0 && p.perp_dot(q) < 0.0 {
                steps - m
            } else {
                steps
            }
        };
        let total: isize = (0..n).filter(|&i| Some(i) != at_hub).map(steps).sum();
        let at_hub_steps = at_hub.map(|i| (i, -total));
        if total.abs() > m {
            return None;
        }
        let around = match at_hub_steps {
            Some(_) => false,
            None if total == 0 => false,
            None if total == m && self.closed => true,
            None => return None,
        };
        events.clear();
        for i in 0..n {
            events.push(Event::Corner(outline[i]));
            let (at_hub, mut left) = match at_hub_steps {
                Some((h, steps)) if h == i => (true, steps),
                _ => (false, steps(i)),
            };
            let mut sector = sectors[i] as isize;
            while left != 0 {
                let forward = left > 0;
                let spoke = if forward { sector + 1 } else { sector };
                let spoke = if self.closed {
                    spoke.rem_euclid(m)
                } else {
                    spoke
                } as usize;
                let at = if at_hub {
                    outline[i]
                } else {
                    self.crossing(outline[i], outline[(i + 1) % n], spoke)
                };
                events.push(Event::Crossing { spoke, forward, at });
                let step = left.signum();
                (sector, left) = (sector + step, left - step);
                if self.closed {
                    sector = sector.rem_euclid(m);
                }
            }
        }
        Some(around)
    }

    /// The point at which a side crosses a spoke.
    fn crossing(&self, p: OutlineCorner, q: OutlineCorner, spoke: usize) -> OutlineCorner {
        let along = self.spokes[spoke];
        let [dp, dq] = [p, q].each(|c| along.perp_dot(c.plane - self.hub));
        let on = |d: f64, c: OutlineCorner| d.abs() <= SNAP && along.dot(c.plane - self.hub) > 0.0;
        if on(dq, q) {
            return q;
        }
        if on(dp, p) {
            return p;
        }
        let Some(side) = Side::of(p.source, q.source) else {
            return if dp.abs() < dq.abs() { p } else { q };
        };
        let t = dp / (dp - dq);
        let t = if t.is_finite() {
            t.clamp(0.0, 1.0)
        } else {
            0.5
        };
        OutlineCorner {
            source: side.between(p.source, q.source, t),
            plane: p.plane.lerp(q.plane, t),
            fixed: false,
        }
    }

    /// Pairs the crossings of every spoke, from the hub outwards: inside lies between the first two, the next two, or
    /// between the hub and the first one.
    fn link(
        &self,
        events: &[Event],
        around: bool,
        crossings: &mut Vec<(usize, f64, usize)>,
        links: &mut Vec<Link>,
    ) -> Option<()> {
        crossings.clear();
        for (i, event) in events.iter().enumerate() {
            if let Event::Crossing { spoke, at, .. } = event {
                let d = at.plane - self.hub;
                crossings.push((*spoke, d.dot(d), i));
            }
        }
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        links.clear();
        links.resize(events.len(), Link::Open);
        let is_forward = |i: usize| matches!(events[i], Event::Crossing { forward: true, .. });
        for on_spoke in crossings.chunk_by(|a, b| a.0 == b.0) {
            let mut rest = on_spoke;
            if around {
                let (nearest, others) = rest.split_first()?;
                if !is_forward(nearest.2) {
                    return None;
                }
                links[nearest.2] = Link::Hub;
                rest = others;
            }
            for pair in rest.chunks(2) {
                let [a, b] = pair else { return None };
                if is_forward(a.2) == is_forward(b.2) {
                    return None;
                }
                links[a.2] = Link::Crossing(b.2);
                links[b.2] = Link::Crossing(a.2);
            }
        }
        Some(())
    }
}

/// Where a polygon's inside is mapped to, at a point: mean value coordinates (Floater 2003), which are right for affine
/// maps and continuous for all others.
fn hub_source(outline: &[OutlineCorner], hub: DVec2) -> Weights31 {
    let n = outline.len();
    let half_tangent = |i: usize| {
        let (p, q) = (outline[i].plane - hub, outline[(i + 1) % n].plane - hub);
        let cross = p.perp_dot(q);
        (sqrt(p.dot(p)) * sqrt(q.dot(q)) - p.dot(q)) / cross
    };
    let (mut sum, mut at) = (0.0, [0.0; 2]);
    for (i, corner) in outline.iter().enumerate() {
        let d = corner.plane - hub;
        let weight = (half_tangent((i + n - 1) % n) + half_tangent(i)) / sqrt(d.dot(d));
        let source = corner.source.get();
        sum += weight;
        at = [0, 1].each(|k| at[k] + weight * source[k]);
    }
    let at = at.each(|x| x / sum);
    if at.iter().all(|x| x.is_finite()) {
        return Weights31::new(at);
    }
    // On a side, up to rounding.
    let mean = |k: usize| outline.iter().map(|c| c.source.get()[k]).sum::<f64>() / n as f64;
    Weights31::new([mean(0), mean(1)])
}
