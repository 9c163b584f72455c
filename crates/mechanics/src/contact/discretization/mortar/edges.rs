//! Rows at nodes: one, or, at an edge, one for each smooth part of the surface around the node.
//!
//! Facets belong to the same part where they share an edge and turn by hardly more than 30 degrees at the node. Of several
//! rows of a node one is in use at a time. What is joined is held as a whole, and has one row everywhere.

use super::facets::corner_normal;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// The cosine of the largest angle between facets without an edge between them: a little over 30 degrees, so that a circle
/// of twelve facets has none.
pub(super) const SMOOTH: f64 = 0.86;

/// Facets around a node, and its place in them.
pub(super) type Part = Vec<(u32, usize)>;

/// The nodes of all rows, and the facets around them.
pub(super) fn parts(
    facets: &Facets,
    nodes: &[NodeId],
    joined: bool,
    x: &[Vec3],
) -> Result<(Vec<NodeId>, Vec<Part>), SurfaceError> {
    let at = Placement { x, poses: &[] };
    let mut around: HashMap<NodeId, Part> = HashMap::new();
    for facet in 0..facets.nfacet() as u32 {
        for (place, &node) in facets.nodes(facet).iter().enumerate() {
            around.entry(node).or_default().push((facet, place));
        }
    }
    let (mut of_rows, mut found) = (Vec::new(), Vec::new());
    for &node in nodes {
        let all = around.remove(&node).unwrap_or_default();
        let apart = if joined {
            vec![all]
        } else {
            split(facets, &all, &at)?
        };
        of_rows.extend(std::iter::repeat_n(node, apart.len()));
        found.extend(apart);
    }
    Ok((of_rows, found))
}

/// The facets around a node, part by part.
fn split(
    facets: &Facets,
    around: &[(u32, usize)],
    at: &Placement,
) -> Result<Vec<Part>, SurfaceError> {
    let normals = around
        .iter()
        .map(|&(facet, place)| Ok(corner_normal(facets, facet, place, at)?.0))
        .collect::<Result<Vec<Vec3>, SurfaceError>>()?;
    let continues = |&a: &usize, &b: &usize| {
        let [one, other] = [a, b].map(|k| facets.nodes(around[k].0));
        let shared = one.iter().filter(|n| other.contains(n)).count();
        shared >= facets.ntan() && normals[a].dot(normals[b]) >= SMOOTH
    };
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for k in 0..around.len() {
        let mut joined = vec![k];
        parts.retain_mut(|part| {
            let beside = part.iter().any(|other| continues(&k, other));
            if beside {
                joined.append(part);
            }
            !beside
        });
        joined.sort_unstable();
        parts.push(joined);
    }
    let of = |part: Vec<usize>| part.into_iter().map(|k| around[k]).collect();
    Ok(parts.into_iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::facets_of;

    /// Rows of a polygon with so many corners, its first facet's normal along no axis.
    fn polygon(corners: u32, joined: bool) -> (Vec<NodeId>, Vec<Part>) {
        let angle = |n: u32| 0.3 + f64::from(n) * std::f64::consts::TAU / f64::from(corners);
        let place = |n: u32| Vec3::new(angle(n).cos(), angle(n).sin(), 0.0);
        let mut x: Vec<Vec3> = (0..corners).map(place).collect();
        let side = |n: u32| ("line2", vec![n, (n + 1) % corners]);
        let sides: Vec<_> = (0..corners).map(side).collect();
        let facets = facets_of(&mut x, &sides);
        parts(&facets, &facets.all_nodes(), joined, &x).unwrap()
    }

    #[test]
    fn nodes_of_edges_have_a_row_for_each_side() {
        for (corners, rows) in [(4, 8), (11, 22), (12, 12), (30, 30)] {
            assert_eq!(polygon(corners, false).1.len(), rows);
            let (nodes, around) = polygon(corners, true);
            assert_eq!(
                (nodes.len(), around.len()),
                (corners as usize, corners as usize)
            );
        }
        let (nodes, around) = polygon(4, false);
        assert_eq!(nodes, [0, 0, 1, 1, 2, 2, 3, 3]);
        assert!(around.iter().all(|part| part.len() == 1));
    }

    #[test]
    fn a_cube_has_three_rows_at_corners_two_along_edges_and_one_inside_its_faces() {
        // two facets along each edge: a grid of 27 points without the one inside
        let at = |i: [u32; 3]| 9 * i[2] + 3 * i[1] + i[0];
        let mut x: Vec<Vec3> = (0..27u32)
            .map(|n| [n % 3, n / 3 % 3, n / 9].map(f64::from).into())
            .collect();
        let mut sides = Vec::new();
        for axis in 0..3 {
            for side in [0u32, 2] {
                for (u, v) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let mut corners = [(u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)];
                    if side == 0 {
                        corners.reverse();
                    }
                    let node = |(u, v): (u32, u32)| {
                        let mut i = [0; 3];
                        (i[axis], i[(axis + 1) % 3], i[(axis + 2) % 3]) = (side, u, v);
                        at(i)
                    };
                    sides.push(("quad4", corners.map(node).to_vec()));
                }
            }
        }
        let facets = facets_of(&mut x, &sides);
        let (nodes, around) = parts(&facets, &facets.all_nodes(), false, &x).unwrap();
        for (part, node) in around.iter().zip(&nodes) {
            let ends = [node % 3, node / 3 % 3, node / 9].map(|i| i != 1);
            let sides = ends.into_iter().filter(|end| *end).count();
            let rows = nodes.iter().filter(|n| *n == node).count();
            assert_eq!(
                (rows, part.len()),
                [(0, 0), (1, 4), (2, 2), (3, 1)][sides],
                "{node}"
            );
        }
        assert_eq!(nodes.len(), 8 * 3 + 12 * 2 + 6);
    }
}
