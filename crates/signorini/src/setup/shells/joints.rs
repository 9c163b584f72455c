//! Nodes with several directors.

use signorini_geometry::expansion::Expansion;
use signorini_geometry::mesh::Mesh;

/// Moves the nodes that only directors of knots have to the middle surface.
pub(super) fn place(expansion: &Expansion, mesh: &mut Mesh) {
    for knot in &expansion.knots {
        for director in expansion
            .directors
            .get(knot.directors.clone())
            .unwrap_or_default()
        {
            let ends = [director.negative, director.positive];
            let [low, high] =
                ends.map(|end| mesh.points.get(end as usize).copied().unwrap_or_default());
            if let Some(to) = mesh.points.get_mut(director.middle as usize) {
                *to = (low + high) * 0.5;
            }
        }
    }
}
