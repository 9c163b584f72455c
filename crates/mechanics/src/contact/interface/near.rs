//! The search for facets near points.

use crate::contact::discretization::{Discretization, Pairing, SurfacePair};
use crate::contact::row::RowOrder;
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;

/// The search for nearby facets, with its buffers.
#[derive(Default)]
pub(super) struct Near {
    pub search: Search,
    pub points: Vec<Vec3>,
    boxes: Vec<Aabb>,
}

impl Near {
    pub fn update(
        &mut self,
        discretization: &dyn Discretization,
        pair: &SurfacePair,
        at: &Placement,
    ) {
        let surface = pair.primary.as_ref();
        self.points.clear();
        let point = |row| discretization.point(row).position(at);
        self.points.extend((0..discretization.nrow()).map(point));
        self.boxes.clear();
        let facets = 0..surface.nfacet() as u32;
        self.boxes.extend(facets.map(|f| surface.aabb(at, f)));
        let apart = |row: u32, facet: u32| {
            let nodes = || discretization.point(row as usize).nodes;
            !(pair.same && pair.is_next_to(nodes(), facet))
        };
        let skin = 0.5 * pair.reach;
        self.search
            .update(&self.points, &self.boxes, pair.reach, skin, &apart);
    }
}

/// The closest points of all rows at a configuration.
///
/// # Errors
/// A facet that has no normal.
pub fn closest_points(
    discretization: &dyn Discretization,
    pair: &SurfacePair,
    at: &Placement,
) -> Result<Pairing, SurfaceError> {
    let mut near = Near::default();
    near.update(discretization, pair, at);
    let nothing = Pairing::nothing(discretization.nrow());
    let mut out = nothing.clone();
    let order = RowOrder::Gap;
    discretization.pair_up(pair, at, &near.search, &nothing, order, &mut out)?;
    Ok(out)
}
