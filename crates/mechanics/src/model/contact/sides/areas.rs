//! Areas of points and rows.

use crate::contact::discretization::Mortar;
use crate::contact::mortar;
use crate::system::Idealisation;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets};
use signorini_geometry::tensor::Vec3;

/// The first facet of an element without a dual basis.
pub(super) fn no_dual(facets: &Facets) -> Option<u32> {
    let has_none = |f: &u32| facets.element(*f).is_none_or(|e| e.dual_basis().is_none());
    (0..facets.nfacet() as u32).find(has_none)
}

/// Areas of mortar rows, with the thickness of the plane.
pub(super) fn mortar_areas(mortar: &Mortar, x: &[Vec3], space: Idealisation) -> Vec<f64> {
    let nodes = mortar.nodes().iter();
    let at = nodes.map(|&n| x.get(n as usize).copied().unwrap_or_default());
    let areas = at.zip(mortar.areas());
    let thickness = |x| match measure(space) {
        mortar::Measure::Flat => space.extent(x),
        mortar::Measure::Revolved => 1.0,
    };
    areas.map(|(x, area)| area * thickness(x)).collect()
}

/// What mortar integrals are taken over.
pub(super) fn measure(space: Idealisation) -> mortar::Measure {
    match space {
        Idealisation::Axisymmetric => mortar::Measure::Revolved,
        _ => mortar::Measure::Flat,
    }
}

/// The areas of some nodes, from those of all nodes in their order.
pub(super) fn of_points(points: &[NodeId], areas: &[(NodeId, f64)]) -> Vec<f64> {
    let of = |node: &NodeId| {
        let found = areas.binary_search_by_key(node, |a| a.0).ok();
        found.and_then(|k| areas.get(k)).map_or(0.0, |a| a.1)
    };
    points.iter().map(of).collect()
}

/// The extent across a facet, from what the planes of all facets stand for.
pub(super) fn extent(spaces: &[Idealisation], facet: u32, at: Vec3) -> f64 {
    let space = spaces.get(facet as usize);
    space.map_or(1.0, |space| space.extent(at))
}
