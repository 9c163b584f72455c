//! Rows at nodes: one, or, at an edge, one for each smooth part of the surface around the node.
//!
//! Facets belong to the same part where they share an edge and turn by hardly more than 30 degrees at the node. Of several
//! rows of a node one is in use at a time. What is joined is held as a whole, and has one row everywhere.

use super::corner_normal;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// The cosine of the largest angle between facets without an edge between them: a little over 30 degrees, so that a circle
/// of twelve facets has none.
const SMOOTH: f64 = 0.86;

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
