//! Rows at edges of the secondary side, and where it ends.

use super::edges::Part;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets};

/// Whether each row is at an edge of the surface or where it ends.
pub(super) fn structural(facets: &Facets, nodes: &[NodeId], around: &[Part]) -> Vec<bool> {
    let at_edge = |row: usize| {
        let same = |k: usize| nodes.get(k) == nodes.get(row);
        same(row + 1) || row.checked_sub(1).is_some_and(same)
    };
    let ends = |part: &Part| {
        let mut edges: Vec<([NodeId; 2], u32)> = Vec::new();
        let mut inside = false;
        for &(facet, place) in part {
            let Some(element) = facets.element(facet) else {
                continue;
            };
            let (of, ncorner) = (facets.nodes(facet), element.ncorner());
            if facets.ntan() == 1 {
                inside |= place >= ncorner || part.len() > 1;
                continue;
            }
            for (k, &[a, b]) in element.edges().iter().enumerate() {
                if ![a, b].contains(&place) && !element.inside_edge(k).contains(&place) {
                    continue;
                }
                let mut edge = [of[a], of[b]];
                edge.sort_unstable();
                match edges.iter_mut().find(|(known, _)| *known == edge) {
                    Some((_, count)) => *count += 1,
                    None => edges.push((edge, 1)),
                }
            }
        }
        match facets.ntan() {
            1 => !inside,
            _ => edges.iter().any(|(_, count)| *count == 1),
        }
    };
    let rows = around.iter().enumerate();
    rows.map(|(row, part)| at_edge(row) || ends(part)).collect()
}
