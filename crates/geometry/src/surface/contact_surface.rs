//! The trait of surfaces that points can touch.

use super::error::SurfaceError;
use super::placement::{Carrier, Placement};
use super::point::{Anchor, Outward, Projection, SurfaceJet};
use super::projection::{Search, closest};
use crate::element::Element;
use crate::proximity::Aabb;
use crate::tensor::Vec3;

/// A surface that points can touch. Facets of elements and analytical surfaces alike.
pub trait ContactSurface: Send + Sync {
    /// The number of tangents: 2 in space, 1 in the plane.
    fn ntan(&self) -> usize;

    /// The number of facets; an analytical surface has one.
    fn nfacet(&self) -> usize;

    /// What moves a facet.
    fn carrier(&self, facet: u32) -> Carrier<'_>;

    /// A box around the facet; unbounded for an infinite surface.
    fn aabb(&self, at: &Placement, facet: u32) -> Aabb;

    /// A length that stands for the size of the facet: the root of its area, its length in the plane.
    fn size(&self, at: &Placement, facet: u32) -> f64;

    /// Everything of second order at a point of the surface.
    ///
    /// # Errors
    /// The facet does not exist or has no normal there.
    fn jet(&self, at: &Placement, point: &Anchor, out: &mut SurfaceJet)
    -> Result<(), SurfaceError>;

    /// The reference element over whose domain the parameters of a facet run; `None` for an analytical surface, which
    /// then brings its own [`ContactSurface::project`].
    fn domain(&self, facet: u32) -> Option<Element>;

    /// Every facet that shares at least one node with this one, without itself, sorted.
    fn neighbours(&self, facet: u32) -> &[u32];

    /// The outward direction at a closest point, with the facets around an edge or vertex taken into account.
    ///
    /// # Errors
    /// As [`ContactSurface::jet`].
    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError>;

    /// The closest point of one facet, with its jet in `out`. `None` where there is none, such as at the centre of a
    /// sphere. `hint` is a point that was closest a moment ago.
    ///
    /// # Errors
    /// As [`ContactSurface::jet`].
    fn project(
        &self,
        at: &Placement,
        facet: u32,
        point: Vec3,
        hint: Option<Anchor>,
        out: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        let search = Search {
            jet: |anchor: &Anchor, out: &mut SurfaceJet| self.jet(at, anchor, out),
            facet,
            point,
            ntan: self.ntan(),
        };
        closest(self.domain(facet), search, hint, out)
    }

    /// The smallest `s ≥ 0` at which the line `origin + s direction` crosses a facet; `None` where it does not, and on
    /// surfaces that are not made of facets of elements.
    fn crossing(&self, at: &Placement, facet: u32, origin: Vec3, direction: Vec3) -> Option<f64>;
}
