//! Areas of points and rows.

use crate::contact::discretization::Mortar;
use crate::contact::mortar;
use crate::model::spaces::Spaces;
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
pub(super) fn mortar_areas(
    mortar: &Mortar,
    x: &[Vec3],
    space: Idealisation,
    spaces: &Spaces<'_>,
) -> Vec<f64> {
    let thickness = |&node: &NodeId| match measure(space) {
        mortar::Measure::Flat => {
            let at = x.get(node as usize).copied().unwrap_or_default();
            spaces.extent_of_node(node, at)
        }
        mortar::Measure::Revolved => 1.0,
    };
    let areas = mortar.nodes().iter().zip(mortar.areas());
    areas.map(|(node, area)| area * thickness(node)).collect()
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
