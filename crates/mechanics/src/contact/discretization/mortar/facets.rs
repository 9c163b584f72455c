//! Nodes and normals of facets, nodes in their order along a curve, and the search for facets.

use crate::contact::discretization::SurfacePair;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Facets, Placement, SurfaceError, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// Nodes in the order of a curve through their box (Morton's).
pub(super) fn along_a_curve(nodes: Vec<NodeId>, x: &[Vec3]) -> Vec<NodeId> {
    let place = |n: &NodeId| x.get(*n as usize).copied().unwrap_or_default();
    let whole = Aabb::around(nodes.iter().map(place));
    let cells = f64::from((1u32 << 16) - 1);
    let size = whole.extent().max_abs();
    let key = |node: &NodeId| {
        let at = (place(node) - whole.min) * (cells / size);
        let at = at.to_array().map(|c| c as u64);
        let bits = (0..16).flat_map(|bit| at.map(|c| (c >> (15 - bit)) & 1));
        (bits.fold(0u64, |key, bit| key << 1 | bit), *node)
    };
    let mut nodes = nodes;
    nodes.sort_by_cached_key(key);
    nodes
}

/// A search among the primary facets in a configuration, as far as the reach of the pair.
pub(super) fn search(pair: &SurfacePair, at: &Placement) -> Search {
    let boxes = (0..pair.primary.nfacet() as u32).map(|f| pair.primary.aabb(at, f));
    let boxes: Vec<Aabb> = boxes.collect();
    let mut search = Search::default();
    search.update(&[], &boxes, pair.reach, 0.0, &|_, _| true);
    search
}

pub(super) fn nodes_of(pair: &SurfacePair, facet: u32) -> &[NodeId] {
    match pair.primary.carrier(facet) {
        Carrier::Nodes(nodes) => nodes,
        _ => &[],
    }
}

/// ν at a node of a facet, and the jet there.
pub(super) fn corner_normal(
    facets: &Facets,
    facet: u32,
    place: usize,
    at: &Placement,
) -> Result<(Vec3, SurfaceJet), SurfaceError> {
    let missing = || SurfaceError::NoSuchFacet { facet };
    let element = facets.element(facet).ok_or_else(missing)?;
    let local = *element.nodes().get(place).ok_or_else(missing)?;
    let mut jet = SurfaceJet::default();
    facets.jet(at, &Anchor { facet, local }, &mut jet)?;
    Ok((-jet.normal, jet))
}
