//! The facets around the nodes under pressure.

use super::Sides;
use crate::system::{ContactFrame, Status};
use signorini_geometry::element::{EdgeNode, Element};
use signorini_geometry::tensor::Vec3;

/// Pressures below this part of the largest are none.
const PRESSED: f64 = 1e-6;
/// The cosine of the angle beyond which facets meet in an edge: 30 degrees.
pub const SMOOTH: f64 = 0.866_025_403_784_438_6;

/// A facet of the secondary side.
#[derive(Clone, Copy, Debug)]
pub struct OfFacet {
    /// Its size: a length, the root of an area.
    pub size: f64,
    /// The normal of the flat facet through its corners; zero where that has none.
    pub normal: Vec3,
    /// The same at the start.
    pub before: Vec3,
    /// How far mid nodes are from the flat facet.
    pub bulge: f64,
    /// Whether one of its nodes is under pressure.
    pub supports: bool,
}

/// A node of the secondary side.
#[derive(Clone, Copy, Debug, Default)]
pub struct OfNode {
    /// The sum of the normals of the facets around it, weighted by their sizes.
    pub normal: Vec3,
    /// The largest size of these.
    pub size: f64,
    /// The largest angle between these now, edges left out.
    pub turn: f64,
    /// The largest bulge.
    pub bulge: f64,
    /// How many facets are around it.
    pub count: u32,
}

/// An edge of the secondary side where its facets end or do not go on smoothly.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its corners, by their places among the nodes.
    pub ends: [u32; 2],
    /// The sum of the normals of its facets.
    pub normal: Vec3,
}

/// The facets around the nodes under pressure, with their data.
pub struct Support<'a> {
    pub of: &'a ContactFrame,
    /// The nodes under pressure, by their place among those of the secondary side.
    pub closed: Vec<usize>,
    /// Whether each node is.
    pub is_closed: Vec<bool>,
    /// Of each facet.
    pub facets: Vec<OfFacet>,
    /// Of each node.
    pub nodes: Vec<OfNode>,
    /// Facets around node k: `around[first[k]..first[k + 1]]`.
    first: Vec<u32>,
    around: Vec<u32>,
    /// `Σ A |t|`.
    pub force: f64,
}

impl<'a> Support<'a> {
    pub fn new(of: &'a ContactFrame, sides: &Sides<'_>, joined: bool) -> Self {
        let n = of.nodes.len();
        let least = PRESSED * of.pressure_max;
        let presses = |k: &usize| match of.status.get(*k) {
            Some(Status::Tied) => joined,
            Some(status) => status.is_closed() && of.pressure.get(*k).is_some_and(|p| *p > least),
            None => false,
        };
        let closed: Vec<usize> = (0..n).filter(presses).collect();
        let mut is_closed = vec![false; n];
        for &k in &closed {
            is_closed[k] = true;
        }
        let place = |at: &[Vec3], k: u32| {
            let node = of.nodes.get(k as usize).copied().unwrap_or(u32::MAX);
            at.get(node as usize).copied().unwrap_or_default()
        };
        let x = |k: u32| place(sides.searched().x, k);
        let before = |k: u32| place(sides.reference, k);
        let facets: Vec<OfFacet> = of
            .facets
            .iter()
            .map(|(element, nodes)| OfFacet {
                supports: nodes
                    .iter()
                    .any(|&k| is_closed.get(k as usize) == Some(&true)),
                before: area_vector(*element, nodes, &before)
                    .normalized()
                    .unwrap_or_default(),
                ..of_facet(*element, nodes, &x)
            })
            .collect();
        let (first, around) = turned_round(of, n);
        let mut support = Self {
            of,
            closed,
            is_closed,
            facets,
            nodes: Vec::new(),
            first,
            around,
            force: 0.0,
        };
        support.nodes = (0..n).map(|k| support.of_node(k)).collect();
        support.force = support.closed.iter().map(|&k| support.load(k)).sum();
        support
    }

    /// The facets around a node.
    pub fn around(&self, node: usize) -> &[u32] {
        match (self.first.get(node), self.first.get(node + 1)) {
            (Some(&a), Some(&b)) => self.around.get(a as usize..b as usize).unwrap_or(&[]),
            _ => &[],
        }
    }

    /// The edges between corners where facets end, or met at more than 30° at the start; none in the plane.
    pub fn edges(&self) -> Vec<Edge> {
        let mut sides: Vec<([u32; 2], usize)> = Vec::new();
        for (f, (element, nodes)) in self.of.facets.iter().enumerate() {
            let corners = nodes.get(..element.ncorner()).unwrap_or(nodes);
            if element.dim() == 2 {
                let next = corners.iter().cycle().skip(1);
                let ends = corners.iter().zip(next);
                sides.extend(ends.map(|(&a, &b)| ([a.min(b), a.max(b)], f)));
            }
        }
        sides.sort_unstable();
        let edge = |of: &[([u32; 2], usize)]| {
            let facet = |side: &([u32; 2], usize)| self.facets.get(side.1);
            let (first, last) = (of.first()?, of.last()?);
            let turned = facet(first)?.before.dot(facet(last)?.before);
            (of.len() == 1 || turned < SMOOTH).then(|| Edge {
                ends: first.0,
                normal: of.iter().filter_map(facet).map(|f| f.normal).sum(),
            })
        };
        let of_edges = sides.chunk_by(|a, b| a.0 == b.0);
        of_edges.filter_map(edge).collect()
    }

    /// The traction on a node.
    pub fn traction(&self, node: usize) -> Vec3 {
        self.of.traction.get(node).copied().unwrap_or_default()
    }

    /// The area of a node; 1 where the secondary side has none, as its tractions are then forces.
    pub fn area(&self, node: usize) -> f64 {
        self.of.area.get(node).copied().unwrap_or(1.0)
    }

    /// `A |t|` of a node.
    pub fn load(&self, node: usize) -> f64 {
        self.area(node) * self.traction(node).norm()
    }

    fn of_node(&self, node: usize) -> OfNode {
        let mut found = OfNode {
            size: 0.0,
            ..OfNode::default()
        };
        let around = self.around(node);
        for &f in around {
            let Some(facet) = self.facets.get(f as usize) else {
                continue;
            };
            found.normal += facet.normal * facet.size;
            found.size = found.size.max(facet.size);
            found.bulge = found.bulge.max(facet.bulge);
            found.count += 1;
            for &g in around {
                if let Some(other) = self.facets.get(g as usize) {
                    let angle = turn([facet.before, other.before], [facet.normal, other.normal]);
                    found.turn = found.turn.max(angle);
                }
            }
        }
        if found.count == 0 {
            found.size = self.of.facet_size;
        }
        found
    }
}

/// The angle between two normals now; 0 where they met in an edge at the start.
pub fn turn(before: [Vec3; 2], now: [Vec3; 2]) -> f64 {
    if before[0].dot(before[1]) < SMOOTH {
        return 0.0;
    }
    now[0].cross(now[1]).norm().atan2(now[0].dot(now[1]))
}

/// The facets around each node, one node after the other.
fn turned_round(of: &ContactFrame, nnode: usize) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0u32; nnode + 1];
    let nodes = || of.facets.iter().map(|(_, nodes)| nodes);
    for &k in nodes().flatten() {
        if let Some(count) = first.get_mut(k as usize + 1) {
            *count += 1;
        }
    }
    for k in 0..nnode {
        first[k + 1] += first[k];
    }
    let mut next = first.clone();
    let mut around = vec![0; first.last().map_or(0, |n| *n as usize)];
    for (f, nodes) in nodes().enumerate() {
        for &k in nodes {
            let Some(to) = next.get_mut(k as usize) else {
                continue;
            };
            if let Some(place) = around.get_mut(*to as usize) {
                *place = f as u32;
                *to += 1;
            }
        }
    }
    (first, around)
}

/// The normal of the flat facet through its corners, as long as that is large: an area, a length in the plane.
fn area_vector(element: Element, nodes: &[u32], x: &dyn Fn(u32) -> Vec3) -> Vec3 {
    match *nodes.get(..element.ncorner()).unwrap_or(nodes) {
        [a, b] => (x(b) - x(a)).cross(Vec3::unit(2)),
        [a, b, c] => (x(b) - x(a)).cross(x(c) - x(a)) * 0.5,
        [a, b, c, d] => (x(c) - x(a)).cross(x(d) - x(b)) * 0.5,
        _ => Vec3::ZERO,
    }
}

fn of_facet(element: Element, nodes: &[u32], x: &dyn Fn(u32) -> Vec3) -> OfFacet {
    let vector = area_vector(element, nodes, x);
    let measure = vector.norm();
    let at = |i: usize| nodes.get(i).map_or(Vec3::ZERO, |&k| x(k));
    let bulge = |of: EdgeNode| (at(of.node) - of.straight(of.ends.map(at))).norm();
    OfFacet {
        size: if element.dim() == 1 {
            measure
        } else {
            measure.sqrt()
        },
        normal: vector.normalized().unwrap_or_default(),
        before: Vec3::ZERO,
        bulge: element.edge_nodes().map(bulge).fold(0.0, f64::max),
        supports: false,
    }
}
