//! Edges of a body at which the secondary side of a contact ends.
//!
//! Where a block is dragged, its leading edge rolls under. If the contact has the lower face alone, the flank next to the edge
//! then passes through what the block rests on, unseen. An edge counts where the body is convex there, turns by more than
//! 30 degrees, and lies over the inside of a facet of the primary side, within reach.

use crate::contact::discretization::SurfacePair;
use crate::model::OpenEdges;
use signorini_geometry::mesh::{Face, Mesh, NodeId, boundary};
use signorini_geometry::proximity::Bvh;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Feature, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// The cosine of the angle by which a body turns at an edge, at most: 30 degrees.
const EDGE: f64 = 0.866;

/// The corners of an edge, sorted; in the plane, a node twice.
type Edge = [NodeId; 2];

/// The edges of a mesh at which the secondary side of a pair ends over the other side; `None` where there are none.
pub(super) fn open_edges(mesh: &Mesh, pair: &SurfacePair, at: &Placement) -> Option<OpenEdges> {
    let side = pair.secondary.as_ref().filter(|_| !pair.same)?;
    let mut ends: HashMap<Edge, Option<u32>> = HashMap::new();
    for facet in 0..side.nfacet() as u32 {
        for edge in edges_of(side, facet) {
            let alone = ends.entry(edge).and_modify(|f| *f = None);
            alone.or_insert(Some(facet));
        }
    }
    ends.retain(|_, facet| facet.is_some());
    let others = next_to(mesh, side)?;
    let boxes = (0..pair.primary.nfacet() as u32).map(|f| pair.primary.aabb(at, f));
    let tree = Bvh::build(&boxes.collect::<Vec<_>>());
    let mut found: Vec<(Edge, Face)> = Vec::new();
    for other in 0..others.nfacet() as u32 {
        for edge in edges_of(&others, other) {
            let Some(&Some(own)) = ends.get(&edge) else {
                continue;
            };
            let turns = is_convex((side, own), (&others, other), edge, at) == Some(true);
            if turns && lies_over(pair, &tree, edge, at) {
                found.extend(others.face(other).map(|face| (edge, face)));
            }
        }
    }
    found.sort_unstable();
    let &([node, _], face) = found.first()?;
    Some(OpenEdges {
        count: found.len(),
        node,
        face,
    })
}

/// The outer faces of the bodies behind a side that touch its nodes, without those of the side.
fn next_to(mesh: &Mesh, side: &Facets) -> Option<Facets> {
    let nodes = side.all_nodes();
    let meets = |of: &[NodeId]| of.iter().any(|n| nodes.binary_search(n).is_ok());
    let own = |face: &Face| (0..side.nfacet() as u32).any(|f| side.face(f) == Some(*face));
    let solids = mesh.cells(mesh.dim()).filter(|c| meets(mesh.cell(*c)));
    let mut outer = boundary(mesh, solids);
    outer.retain(|face| mesh.face(*face).is_some_and(|(_, of)| meets(&of)) && !own(face));
    Facets::new(mesh, &outer).ok()
}

fn edges_of(facets: &Facets, facet: u32) -> Vec<Edge> {
    let n = facets.element(facet).map_or(0, |e| e.ncorner());
    let corners = facets.nodes(facet).get(..n).unwrap_or_default();
    if facets.ntan() == 1 {
        return corners.iter().map(|&n| [n, n]).collect();
    }
    let next = corners.iter().cycle().skip(1);
    let sorted = |(&a, &b): (&NodeId, &NodeId)| [a.min(b), a.max(b)];
    corners.iter().zip(next).map(sorted).collect()
}

/// Whether a body is convex, and turns by more than 30 degrees, at the edge between two of its facets.
fn is_convex(
    (side, own): (&Facets, u32),
    (others, other): (&Facets, u32),
    edge: Edge,
    at: &Placement,
) -> Option<bool> {
    let centre = |facets: &Facets, facet: u32| {
        let local = facets.domain(facet)?.centre();
        let mut jet = SurfaceJet::default();
        facets.jet(at, &Anchor { facet, local }, &mut jet).ok()?;
        Some((jet.position, jet.normal))
    };
    let ((_, normal), (beyond, turned)) = (centre(side, own)?, centre(others, other)?);
    let from = middle(edge, at);
    Some(normal.dot(turned) < EDGE && normal.dot(beyond - from) < 0.0)
}

fn middle(edge: Edge, at: &Placement) -> Vec3 {
    let x = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
    (x(edge[0]) + x(edge[1])) * 0.5
}

/// Whether the middle of an edge has its closest point inside a facet of the primary side, within reach.
fn lies_over(pair: &SurfacePair, tree: &Bvh, edge: Edge, at: &Placement) -> bool {
    let (point, primary) = (middle(edge, at), pair.primary.as_ref());
    let (mut near, mut jet) = (Vec::new(), SurfaceJet::default());
    tree.query(point, pair.reach, &mut near);
    near.into_iter().any(|facet| {
        let found = primary.project(at, facet, point, None, &mut jet);
        let inside = |p: &signorini_geometry::surface::Projection| {
            p.feature == Feature::Face && p.distance <= pair.reach
        };
        found.ok().flatten().as_ref().is_some_and(inside)
    })
}
