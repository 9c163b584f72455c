use super::error::AnalyticalError;
use super::facets::Facets;
use super::mount::{Mount, finite};
use super::{
    Anchor, Carrier, ContactSurface, Outward, Placement, Projection, SurfaceError, SurfaceJet,
};
use crate::element::Element;
use crate::mesh::NodeId;
use crate::proximity::Aabb;
use crate::tensor::Vec3;
use std::collections::HashMap;

/// A rigid surface of triangles, such as that of an STL file: [`Facets`] in the initial configuration on a [`Mount`].
#[derive(Clone, Debug)]
pub struct Triangulated {
    mount: Mount,
    facets: Facets,
    points: Vec<Vec3>,
}

impl Triangulated {
    /// From points and triples of them, counter-clockwise seen from outside. Triangles that share points are
    /// neighbours: points must be welded. Facet `i` is `triangles[i]`.
    ///
    /// # Errors
    /// A mount that is not of space, points that are not finite or do not exist, triangles without area, neighbours of
    /// which one is turned inside out, more than two triangles on one edge.
    pub fn new(
        mount: Mount,
        points: Vec<Vec3>,
        triangles: &[[NodeId; 3]],
    ) -> Result<Self, AnalyticalError> {
        let mount = mount.validated()?;
        if mount.ntan == 1 {
            let wanted = "a surface cannot be made of triangles";
            return Err(AnalyticalError::OutOfPlane { wanted });
        }
        for &point in &points {
            finite("the points of the triangles", point)?;
        }
        let beyond = |&&n: &&NodeId| n as usize >= points.len();
        let missing = |(t, nodes): (usize, &[NodeId; 3])| Some((t, *nodes.iter().find(beyond)?));
        if let Some((triangle, point)) = triangles.iter().enumerate().find_map(missing) {
            return Err(AnalyticalError::NoSuchPoint {
                triangle: triangle + 1,
                point,
                npoint: points.len(),
            });
        }
        one_side(triangles)?;
        let facets = Facets::of_triangles(triangles).ok_or(AnalyticalError::NoTriangles)?;
        let surface = Self {
            mount,
            facets,
            points,
        };
        let mut jet = SurfaceJet::default();
        for facet in 0..triangles.len() as u32 {
            let local = Vec3::ZERO;
            let triangle = facet as usize + 1;
            surface
                .facets
                .jet(&surface.initial(), &Anchor { facet, local }, &mut jet)
                .map_err(|_| AnalyticalError::Flat { triangle })?;
        }
        Ok(surface)
    }

    /// The configuration in which the triangles are kept.
    fn initial(&self) -> Placement<'_> {
        Placement {
            x: &self.points,
            poses: &[],
        }
    }

    /// From the initial to the present configuration.
    fn carry(&self, at: &Placement, jet: &mut SurfaceJet) {
        let motion = self.mount.motion(at);
        jet.nnode = 0;
        jet.position = motion.point(jet.position);
        jet.normal = motion.vector(jet.normal);
        jet.tangent = jet.tangent.map(|t| motion.vector(t));
        jet.curvature = jet.curvature.map(|c| motion.vector(c));
    }
}

/// Whether neighbours run along their common edge in opposite directions.
fn one_side(triangles: &[[NodeId; 3]]) -> Result<(), AnalyticalError> {
    let mut edges = HashMap::with_capacity(3 * triangles.len());
    for (second, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [[a, b], [b, c], [c, a]] {
            if let Some(first) = edges.insert(edge, second) {
                return Err(AnalyticalError::SameWay {
                    first: first + 1,
                    second: second + 1,
                });
            }
        }
    }
    Ok(())
}

impl ContactSurface for Triangulated {
    fn ntan(&self) -> usize {
        self.mount.ntan
    }

    fn nfacet(&self) -> usize {
        self.facets.nfacet()
    }

    fn carrier(&self, _: u32) -> Carrier<'_> {
        self.mount.carrier()
    }

    fn aabb(&self, at: &Placement, facet: u32) -> Aabb {
        let motion = self.mount.motion(at);
        let nodes = self.facets.nodes(facet).iter();
        let corners = nodes.filter_map(|&n| self.points.get(n as usize));
        Aabb::around(corners.map(|&x| motion.point(x)))
    }

    fn size(&self, _: &Placement, facet: u32) -> f64 {
        self.facets.size(&self.initial(), facet)
    }

    fn jet(
        &self,
        at: &Placement,
        point: &Anchor,
        out: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        self.facets.jet(&self.initial(), point, out)?;
        self.carry(at, out);
        Ok(())
    }

    fn domain(&self, facet: u32) -> Option<Element> {
        self.facets.domain(facet)
    }

    fn neighbours(&self, facet: u32) -> &[u32] {
        self.facets.neighbours(facet)
    }

    fn crossing(&self, _: &Placement, _: u32, _: Vec3, _: Vec3) -> Option<f64> {
        None
    }

    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        let outward = self.facets.outward(&self.initial(), found)?;
        Ok(Outward {
            direction: self.mount.motion(at).vector(outward.direction),
            ..outward
        })
    }

    fn project(
        &self,
        at: &Placement,
        facet: u32,
        point: Vec3,
        hint: Option<Anchor>,
        out: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        let initial = self.mount.motion(at).undone(point);
        let found = self
            .facets
            .project(&self.initial(), facet, initial, hint, out)?;
        self.carry(at, out);
        Ok(found)
    }
}
