//! Gaps point by point (A1, A2).

use super::closest::{Finder, Met, Seeker};
use super::support::{Edge, Support, turn};
use super::{Rules, Sides, nothing, worst};
use crate::system::Measured;
use rayon::prelude::*;
use signorini_geometry::element::{Element, Family, MAX_FACET_NODES};
use signorini_geometry::surface::{Anchor, Carrier, ContactSurface, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// What a gap may be off by, over the size of a facet, where all is straight.
const TOUCH: f64 = 0.002;
/// How deep a point of either side may be, over the size of a facet.
const DEEP: f64 = 0.05;
/// How much deeper than its law allows at the mean pressure of its surroundings.
const SLACK: f64 = 1.5;
/// The part of the contact force on nodes that are apart up to which this is allowed.
const APART: f64 = 0.01;
/// Points along the edge of a grid on a facet.
const GRID: usize = 9;
/// Where points inside an edge are looked from.
const IN_EDGE: [f64; 3] = [0.25, 0.5, 0.75];
/// Points looked for by one task.
const TASK: usize = 32;

/// Whether it was seen from one side or the other.
pub struct Seen {
    /// From each node of the secondary side, where it looked.
    pub nodes: Vec<Option<Met>>,
    /// The smallest gap that a corner of the primary side has above each facet; ∞ where there is none.
    pub corners: Vec<f64>,
    /// The gaps of points inside the secondary side's edges that are in the other side, each with the node at its end.
    pub edges: Vec<(usize, f64)>,
    /// How far facets of the primary side are from the curve that they stand for, sorted by facet.
    pub bends: Vec<(u32, Bend)>,
}

/// How facets of the primary side turn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bend {
    /// Distance of a chord from its curve.
    pub height: f64,
    /// Angle from one facet to the next.
    pub angle: f64,
}

impl Seen {
    /// How the facet that a node meets turns.
    pub fn bend(&self, met: &Met) -> Bend {
        let found = self.bends.binary_search_by_key(&met.facet, |b| b.0);
        found
            .ok()
            .and_then(|k| self.bends.get(k))
            .map_or(Bend::default(), |b| b.1)
    }
}

/// Looks from all nodes near the support to the other side, and back from corners there.
pub fn look(support: &Support<'_>, sides: &Sides<'_>, rules: &dyn Rules) -> Seen {
    if sides.primary.nfacet() == 0 {
        return from_partners(support, sides, rules);
    }
    let at = sides.searched();
    let held = sides.start.map(|_| sides.now);
    let finder = Finder::new(sides.primary, at, held, sides.same);
    let nodes = from_nodes(support, (sides, rules), &finder);
    let mut hit: Vec<u32> = nodes.iter().flatten().map(|met| met.facet).collect();
    hit.sort_unstable();
    hit.dedup();
    let bend = |&facet: &u32| (facet, bend(sides, facet));
    let bends: Vec<(u32, Bend)> = hit.par_iter().with_min_len(TASK).map(bend).collect();
    let corners = if sides.same {
        // a corner is its own closest point there
        vec![f64::INFINITY; support.facets.len()]
    } else {
        from_corners(support, (sides, rules), hit)
    };
    Seen {
        nodes,
        corners,
        edges: if sides.same {
            Vec::new()
        } else {
            from_edges(support, (sides, rules), &finder)
        },
        bends,
    }
}

/// Looks from nodes to the nodes opposite.
fn from_partners(support: &Support<'_>, sides: &Sides<'_>, rules: &dyn Rules) -> Seen {
    let of = support.of;
    let x = |node: u32| sides.now.x.get(node as usize).copied();
    let look = |k: usize| {
        let normal = of.normal.get(k).copied()?;
        let away = x(of.nodes.get(k).copied()?)? - x(rules.partner(k)?)?;
        Some(Met {
            facet: 0,
            gap: away.dot(normal),
            normal,
            sharp: false,
            curvature: 0.0,
            lean: 0.0,
        })
    };
    Seen {
        nodes: (0..of.nodes.len()).map(look).collect(),
        corners: vec![f64::INFINITY; support.facets.len()],
        edges: Vec::new(),
        bends: Vec::new(),
    }
}

/// Looks from the nodes: those that press as far as it goes, others as far as a facet.
fn from_nodes(
    support: &Support<'_>,
    (sides, rules): (&Sides<'_>, &dyn Rules),
    finder: &Finder<'_>,
) -> Vec<Option<Met>> {
    let of = support.of;
    let look = |k: usize| {
        let node = support.nodes.get(k)?;
        let supports = |f: &u32| support.facets.get(*f as usize).is_some_and(|f| f.supports);
        let near =
            support.is_closed.get(k) == Some(&true) || support.around(k).iter().any(supports);
        let own = if sides.same { support.around(k) } else { &[] };
        let id = of.nodes.get(k).copied()?;
        let seeker = Seeker {
            within: if near { f64::INFINITY } else { node.size },
            own,
            ..seeker(id, node.normal, sides)?
        };
        let met = finder.find(&seeker)?;
        let is_through = met.gap < 0.0 && -met.gap > rules.deepest(id, met.facet);
        // a point behind a facet at the start has not gone through it
        let was_behind = sides.same && met.gap < 0.0 && is_behind(sides, met.facet, id);
        (!was_behind && !is_through).then_some(met)
    };
    let all = (0..of.nodes.len()).into_par_iter().with_min_len(TASK);
    all.map(look).collect()
}

/// Looks from points inside edges where facets of the secondary side do not go on smoothly: two such edges may cross, with
/// all corners outside.
fn from_edges(
    support: &Support<'_>,
    (sides, rules): (&Sides<'_>, &dyn Rules),
    finder: &Finder<'_>,
) -> Vec<(usize, f64)> {
    let id = |k: u32| support.of.nodes.get(k as usize).copied();
    let look = |edge: &Edge| {
        let [first, last] = edge.ends;
        let [a, b] = [id(first)?, id(last)?].map(|node| seeker(node, edge.normal, sides));
        let (a, b) = (a?, b?);
        let within = (b.point - a.point).norm();
        let gaps = IN_EDGE.iter().filter_map(|&part| {
            let between = |a: Vec3, b: Vec3| a * (1.0 - part) + b * part;
            let met = finder.find(&Seeker {
                point: between(a.point, b.point),
                moved: between(a.moved, b.moved),
                within,
                ..a
            })?;
            (met.gap < 0.0 && -met.gap <= rules.deepest(id(first)?, met.facet)).then_some(met.gap)
        });
        let least = gaps.fold(0.0, f64::min);
        (least < 0.0).then_some((first as usize, least))
    };
    let edges = support.edges();
    edges
        .par_iter()
        .with_min_len(TASK)
        .filter_map(look)
        .collect()
}

/// Whether a node was behind a facet at the start.
fn is_behind(sides: &Sides<'_>, facet: u32, node: u32) -> bool {
    let at = Placement {
        x: sides.reference,
        poses: sides.now.poses,
    };
    let mut jet = SurfaceJet::default();
    let local = sides.primary.domain(facet).map(|e| e.centre());
    let anchor = local.map(|local| Anchor { facet, local });
    let known = anchor.is_some_and(|a| sides.primary.jet(&at, &a, &mut jet).is_ok());
    let point = sides.reference.get(node as usize).copied();
    known && point.is_some_and(|x| (x - jet.position).dot(jet.normal) < 0.0)
}

fn seeker(node: u32, normal: Vec3, sides: &Sides<'_>) -> Option<Seeker<'static>> {
    let x = |x: &[Vec3]| x.get(node as usize).copied();
    let point = x(sides.searched().x)?;
    Some(Seeker {
        point,
        moved: x(sides.now.x)? - point,
        normal,
        within: f64::INFINITY,
        own: &[],
    })
}

/// How a facet of the primary side turns against its neighbours.
fn bend(sides: &Sides<'_>, facet: u32) -> Bend {
    let at = sides.searched();
    let before = Placement {
        x: sides.reference,
        poses: at.poses,
    };
    let surface = sides.primary;
    let mut jet = SurfaceJet::default();
    let mut normal = |at: &Placement<'_>, facet: u32| {
        let local = surface.domain(facet)?.centre();
        let found = surface.jet(at, &Anchor { facet, local }, &mut jet);
        found.ok().map(|()| jet.normal)
    };
    let mut normals = |facet: u32| normal(&before, facet).zip(normal(&at, facet));
    let Some(own) = normals(facet) else {
        return Bend::default();
    };
    let others = surface.neighbours(facet).iter();
    let angle = others
        .filter_map(|&g| normals(g))
        .map(|other| turn([own.0, other.0], [own.1, other.1]))
        .fold(0.0, f64::max);
    Bend {
        height: surface.size(&at, facet) * angle / 8.0,
        angle,
    }
}

/// Looks back from the corners of these facets and those around them to the facets of the secondary side.
fn from_corners(
    support: &Support<'_>,
    (sides, rules): (&Sides<'_>, &dyn Rules),
    hit: Vec<u32>,
) -> Vec<f64> {
    let mut smallest = vec![f64::INFINITY; support.facets.len()];
    let Some(secondary) = sides.secondary else {
        return smallest;
    };
    let surface = sides.primary;
    let mut near = hit;
    let around: Vec<u32> = near
        .iter()
        .flat_map(|&f| surface.neighbours(f).iter().copied())
        .collect();
    near.extend(around);
    near.sort_unstable();
    near.dedup();
    let at = sides.searched();
    let mut corners: Vec<(u32, Vec3)> = Vec::new();
    let mut jet = SurfaceJet::default();
    for facet in near {
        let (Some(element), Carrier::Nodes(nodes)) =
            (surface.domain(facet), surface.carrier(facet))
        else {
            continue;
        };
        let local = element.centre();
        let flat = surface.jet(&at, &Anchor { facet, local }, &mut jet);
        let normal = flat.map_or(Vec3::ZERO, |()| jet.normal);
        corners.extend(nodes.iter().map(|&node| (node, normal)));
    }
    // one facet of each node is enough to say which way it faces
    corners.sort_by_key(|c| c.0);
    corners.dedup_by_key(|c| c.0);
    let held = sides.start.map(|_| sides.now);
    let finder = Finder::new(secondary, at, held, false);
    let look = |&(node, normal): &(u32, Vec3)| {
        let met = finder.find(&seeker(node, normal, sides)?)?;
        let size = support.facets.get(met.facet as usize)?.size;
        let is_through = -met.gap > rules.deepest_back(node, met.facet);
        (!met.sharp && !is_through && met.gap.abs() < size).then_some((met.facet, met.gap))
    };
    let found: Vec<Option<(u32, f64)>> = corners.par_iter().with_min_len(TASK).map(look).collect();
    for (facet, gap) in found.into_iter().flatten() {
        if let Some(to) = smallest.get_mut(facet as usize) {
            *to = to.min(gap);
        }
    }
    smallest
}

/// What a gap at a node may be off by: its facets are not the curve that they stand for, nor are those opposite.
fn tolerance(support: &Support<'_>, seen: &Seen, node: usize) -> f64 {
    let Some(of) = support.nodes.get(node) else {
        return 0.0;
    };
    let mut opposite: f64 = 0.0;
    let mut look = |k: usize| {
        if let Some(met) = seen.nodes.get(k).and_then(Option::as_ref) {
            let curved = met.curvature * of.size * of.size / 8.0;
            opposite = opposite.max(seen.bend(met).height.max(curved) + met.lean);
        }
    };
    look(node);
    for &f in support.around(node) {
        let nodes = support.of.facets.get(f as usize).map(|f| &f.1);
        nodes.into_iter().flatten().for_each(|&k| look(k as usize));
    }
    TOUCH * of.size + of.size * of.turn / 8.0 + of.bulge + opposite
}

/// The smallest gap over the support of a node, without the prescribed shift; `None` where nothing is opposite.
fn smallest(support: &Support<'_>, seen: &Seen, node: usize) -> Option<f64> {
    let mut least: Option<f64> = None;
    let mut take = |gap: f64| least = Some(least.map_or(gap, |l| l.min(gap)));
    let gap_at = |k: usize| seen.nodes.get(k).and_then(Option::as_ref).map(|m| m.gap);
    gap_at(node).into_iter().for_each(&mut take);
    for &f in support.around(node) {
        let nodes = support.of.facets.get(f as usize).map(|f| &f.1);
        let gaps = nodes
            .into_iter()
            .flatten()
            .filter_map(|&k| gap_at(k as usize));
        gaps.for_each(&mut take);
        let corner = seen.corners.get(f as usize).copied();
        corner
            .filter(|g| g.is_finite())
            .into_iter()
            .for_each(&mut take);
    }
    least
}

/// Nodes that press where nothing is near (A1).
pub fn apart(support: &Support<'_>, sides: &Sides<'_>, rules: &dyn Rules, seen: &Seen) -> Measured {
    let of = support.of;
    let mut measured = nothing(APART);
    let mut found: Vec<(usize, f64)> = Vec::new();
    let mut grid: Option<Finder<'_>> = None;
    let mut load = 0.0;
    for &k in &support.closed {
        let pressure = of.pressure.get(k).copied().unwrap_or_default();
        let tolerance = tolerance(support, seen, k);
        let allowed = rules.gap(k, pressure).max(0.0) + tolerance + rules.moved(k);
        let shifted = |gap: Option<f64>| gap.map_or(f64::INFINITY, |g| g + rules.shift(k));
        let mut gap = shifted(smallest(support, seen, k));
        if gap > allowed && sides.primary.nfacet() > 0 {
            let held = sides.start.map(|_| sides.now);
            let finder = grid.get_or_insert_with(|| {
                Finder::new(sides.primary, sides.searched(), held, sides.same)
            });
            gap = gap.min(shifted(over_grid(support, sides, finder, k)));
        }
        if gap > allowed {
            load += support.load(k);
            found.push((k, support.load(k)));
            if gap > measured.worst {
                measured.worst = gap;
                (measured.allowed, measured.pressure) = (allowed, pressure);
            }
        }
    }
    measured.part = load / support.force;
    measured.nodes = worst(of, found);
    measured
}

/// The smallest gap of a grid on the facets around a node.
fn over_grid(
    support: &Support<'_>,
    sides: &Sides<'_>,
    finder: &Finder<'_>,
    node: usize,
) -> Option<f64> {
    let secondary = sides.secondary?;
    let own = if sides.same {
        support.around(node)
    } else {
        &[]
    };
    let mut jet = SurfaceJet::default();
    let mut least: Option<f64> = None;
    for &facet in support.around(node) {
        let Some(element) = secondary.element(facet) else {
            continue;
        };
        for local in grid_points(element) {
            let anchor = Anchor { facet, local };
            let at = sides.searched();
            if secondary.jet(&at, &anchor, &mut jet).is_err() {
                continue;
            }
            let (point, normal) = (jet.position, jet.normal);
            let shape: [f64; MAX_FACET_NODES] = jet.shape;
            let nodes = secondary.nodes(facet).iter().zip(shape);
            let now =
                nodes.map(|(&n, w)| sides.now.x.get(n as usize).copied().unwrap_or_default() * w);
            let moved = now.sum::<Vec3>() - point;
            let seeker = Seeker {
                point,
                moved,
                normal,
                within: f64::INFINITY,
                own,
            };
            let found = finder.find(&seeker).filter(|met| {
                let id = support.of.nodes.get(node).copied().unwrap_or(u32::MAX);
                !(sides.same && met.gap < 0.0 && is_behind(sides, met.facet, id))
            });
            if let Some(met) = found {
                least = Some(least.map_or(met.gap, |l| l.min(met.gap)));
            }
        }
    }
    least
}

/// Points of a grid over the domain of a facet.
fn grid_points(element: Element) -> impl Iterator<Item = Vec3> {
    let last = (GRID - 1) as f64;
    let family = element.family();
    let each = move |k: usize| {
        let (i, j) = (k % GRID, k / GRID);
        let (a, b) = (i as f64 / last, j as f64 / last);
        match family {
            Family::Line => (j == 0).then(|| Vec3::new(2.0 * a - 1.0, 0.0, 0.0)),
            Family::Triangle => (i + j < GRID).then(|| Vec3::new(a, b, 0.0)),
            _ => Some(Vec3::new(2.0 * a - 1.0, 2.0 * b - 1.0, 0.0)),
        }
    };
    (0..GRID * GRID).filter_map(each)
}

/// Samples that are inside (A2).
pub fn through(support: &Support<'_>, rules: &dyn Rules, seen: &Seen) -> Measured {
    let of = support.of;
    let mut measured = nothing(DEEP);
    let mut found: Vec<(usize, f64)> = Vec::new();
    let mut judge = |k: usize, gap: f64, pressure: f64| {
        let Some(node) = support.nodes.get(k).filter(|n| n.size > 0.0) else {
            return;
        };
        let tolerance = tolerance(support, seen, k) + rules.moved(k);
        let allowed = SLACK * rules.gap(k, pressure).min(0.0) - tolerance;
        let gap = gap + rules.shift(k);
        let part = (allowed - gap) / node.size;
        if part > measured.limit {
            found.push((k, part));
        }
        if part > measured.part {
            measured.part = part;
            (measured.worst, measured.allowed) = (-gap, -allowed);
            measured.pressure = pressure;
        }
    };
    // the largest pressure around a sample: a law allows more there
    let pressure = |k: usize| {
        let mut most = of.pressure.get(k).copied().unwrap_or_default();
        for &f in support.around(k) {
            let nodes = of.facets.get(f as usize).map(|f| &f.1);
            for &j in nodes.into_iter().flatten() {
                most = most.max(of.pressure.get(j as usize).copied().unwrap_or_default());
            }
        }
        most
    };
    for (k, met) in seen.nodes.iter().enumerate() {
        if let Some(met) = met.filter(|met| met.gap < 0.0) {
            judge(k, met.gap, pressure(k));
        }
    }
    for ((_, nodes), &gap) in of.facets.iter().zip(&seen.corners) {
        if let Some(&k) = nodes.first()
            && gap < 0.0
        {
            judge(k as usize, gap, pressure(k as usize));
        }
    }
    for &(k, gap) in &seen.edges {
        judge(k, gap, pressure(k));
    }
    measured.nodes = worst(of, found);
    measured
}
