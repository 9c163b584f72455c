//! The sizes of the facets of both sides, on which the local reach depends.

use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement};

/// The sizes of facets of both sides at the start. Where it is empty, the reach is the same everywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FacetSizes {
    /// Of each facet of the secondary side.
    pub secondary: Vec<f64>,
    /// Of each facet of the primary side.
    pub primary: Vec<f64>,
    /// Of the largest facet around each point of the secondary side.
    pub around: Vec<f64>,
}

impl FacetSizes {
    /// Those of these sides; `points` are the sorted nodes of the secondary one.
    #[must_use]
    pub fn new(
        points: &[NodeId],
        secondary: Option<&Facets>,
        primary: &Facets,
        at: &Placement,
    ) -> Self {
        let sizes = |facets: &Facets| -> Vec<f64> {
            let all = 0..facets.nfacet() as u32;
            all.map(|f| facets.size(at, f)).collect()
        };
        let mut new = Self {
            secondary: secondary.map(sizes).unwrap_or_default(),
            primary: sizes(primary),
            around: vec![0.0; points.len()],
        };
        let Some(facets) = secondary else {
            return new;
        };
        for (facet, &size) in (0..).zip(&new.secondary) {
            for node in facets.nodes(facet) {
                let place = points.binary_search(node).ok();
                if let Some(around) = place.and_then(|k| new.around.get_mut(k)) {
                    *around = around.max(size);
                }
            }
        }
        new
    }
}
