//! The outer faces of all bodies, with their local lengths.

use super::THICK;
use signorini_geometry::element::{Family, quadrature};
use signorini_geometry::mesh::{CellId, Face, Mesh, boundary};
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{ContactSurface, Facets, FacetsError, Placement, bodies};
use signorini_geometry::tensor::Vec3;

/// The outer faces of bodies, in the order of the mesh.
#[derive(Clone, Debug)]
pub struct Skin {
    facets: Facets,
    body: Vec<u32>,
    size: Vec<f64>,
    thickness: Vec<f64>,
    takes_part: Vec<bool>,
}

impl Skin {
    /// The outer faces of these cells. Those that `leaves_out` names face nothing and stand in the way of lines only. A body
    /// is what shares nodes.
    ///
    /// # Errors
    /// A face that no surface can be made of.
    pub fn new(
        mesh: &Mesh,
        cells: &[CellId],
        leaves_out: impl Fn(Face) -> bool,
    ) -> Result<Self, FacetsError> {
        let faces = boundary(mesh, cells.iter().copied());
        let facets = Facets::new(mesh, &faces)?;
        let body = bodies(mesh, cells, &facets);
        let all = 0..facets.nfacet() as u32;
        let at = Placement {
            x: &mesh.points,
            poses: &[],
        };
        let size: Vec<f64> = all.map(|facet| size(&facets, &at, facet)).collect();
        let walls = Walls::new(&facets, &body, &at);
        let mut near = Vec::new();
        let of_facet = (0..).zip(&size);
        let thickness =
            of_facet.map(|(facet, size)| walls.thickness(facet, THICK * size, &mut near));
        let thickness = thickness.collect();
        let takes_part = faces.iter().map(|&face| !leaves_out(face)).collect();
        Ok(Self {
            facets,
            body,
            size,
            thickness,
            takes_part,
        })
    }

    /// The facets.
    #[must_use]
    pub fn facets(&self) -> &Facets {
        &self.facets
    }

    /// The body of each facet: those that share nodes have one number.
    #[must_use]
    pub fn body(&self) -> &[u32] {
        &self.body
    }

    /// The size of each facet at the start.
    #[must_use]
    pub fn size(&self) -> &[f64] {
        &self.size
    }

    /// The thickness of the body behind each facet at the start; infinite beyond four times its size.
    #[must_use]
    pub fn thickness(&self) -> &[f64] {
        &self.thickness
    }

    /// Whether a facet may face others.
    #[must_use]
    pub fn takes_part(&self, facet: u32) -> bool {
        self.takes_part.get(facet as usize).copied() == Some(true)
    }

    /// The middle of a facet, and the normal there of the polygon through its corners.
    #[must_use]
    pub fn middle(&self, x: &[Vec3], facet: u32) -> (Vec3, Vec3) {
        middle(&self.facets, x, facet)
    }

    /// The points of a facet from which lines go; how many there are comes back.
    pub fn points(&self, x: &[Vec3], facet: u32, to: &mut [Vec3; 4]) -> usize {
        let mut corners = [Vec3::ZERO; 4];
        let n = corners_of(&self.facets, x, facet, &mut corners);
        let corners = corners.get(..n).unwrap_or_default();
        let family = self.facets.element(facet).map(|element| element.family());
        let Some(family) = family else {
            return 0;
        };
        let rule = match family {
            Family::Line => &quadrature::LINE_2,
            Family::Triangle => &quadrature::TRI_3,
            _ => &quadrature::QUAD_4,
        };
        let mut shape = [0.0; 4];
        let Some(shape) = shape.get_mut(..n) else {
            return 0;
        };
        let places = rule.points.iter().map(|xi| {
            family.linear().shape(xi, shape);
            corners.iter().zip(shape.iter()).map(|(&x, n)| x * *n).sum()
        });
        to.iter_mut().zip(places).map(|(to, x)| *to = x).count()
    }

    /// Whether two facets have a node in common.
    #[must_use]
    pub fn touch(&self, a: u32, b: u32) -> bool {
        let others = self.facets.nodes(b);
        self.facets
            .nodes(a)
            .iter()
            .any(|node| others.contains(node))
    }
}

/// The outer faces of bodies, through which lines leave them.
struct Walls<'a> {
    facets: &'a Facets,
    body: &'a [u32],
    /// Middles of facets and normals there.
    middle: Vec<(Vec3, Vec3)>,
    tree: Bvh,
    at: &'a Placement<'a>,
}

impl<'a> Walls<'a> {
    fn new(facets: &'a Facets, body: &'a [u32], at: &'a Placement<'a>) -> Self {
        let all = 0..facets.nfacet() as u32;
        let boxes: Vec<Aabb> = all.clone().map(|f| facets.aabb(at, f)).collect();
        Self {
            facets,
            body,
            middle: all.map(|f| middle(facets, at.x, f)).collect(),
            tree: Bvh::build(&boxes),
            at,
        }
    }

    /// How far a line against the normal of a facet goes until it leaves the body; infinite beyond `most`.
    fn thickness(&self, facet: u32, most: f64, near: &mut Vec<u32>) -> f64 {
        let Some(&(from, normal)) = self.middle.get(facet as usize) else {
            return f64::INFINITY;
        };
        let nodes = self.facets.nodes(facet);
        let body = |facet: u32| self.body.get(facet as usize);
        let leaves = |other: u32| {
            let of_other = self.middle.get(other as usize);
            let shares = |node: &u32| nodes.contains(node);
            body(other) == body(facet)
                && of_other.is_some_and(|(_, n)| n.dot(normal) < 0.0)
                && !self.facets.nodes(other).iter().any(shares)
        };
        let line = (from, -normal * most);
        let first = self
            .facets
            .first_crossed(self.at, &self.tree, line, near, leaves);
        first.map_or(f64::INFINITY, |(s, _)| s * most)
    }
}

/// h_f.
fn size(facets: &Facets, at: &Placement<'_>, facet: u32) -> f64 {
    let size = facets.size(at, facet);
    match facets.element(facet).map(|element| element.family()) {
        Some(Family::Triangle) => size * std::f64::consts::SQRT_2,
        _ => size,
    }
}

/// The middle of the corners of a facet, and the normal there of the polygon that they are; none where they have none.
fn middle(facets: &Facets, x: &[Vec3], facet: u32) -> (Vec3, Vec3) {
    let mut corners = [Vec3::ZERO; 4];
    let n = corners_of(facets, x, facet, &mut corners);
    let corners = corners.get(..n).unwrap_or_default();
    let sum: Vec3 = corners.iter().copied().sum();
    let normal = match *corners {
        [a, b] => (b - a).cross(Vec3::unit(2)),
        [a, b, c] => (b - a).cross(c - a),
        [a, b, c, d] => (c - a).cross(d - b),
        _ => Vec3::ZERO,
    };
    let normal = normal.normalized().unwrap_or_default();
    (sum / n.max(1) as f64, normal)
}

/// The corners of a facet; how many there are comes back.
fn corners_of(facets: &Facets, x: &[Vec3], facet: u32, to: &mut [Vec3; 4]) -> usize {
    let ncorner = facets.element(facet).map_or(0, |e| e.ncorner());
    let nodes = facets.nodes(facet).iter().take(ncorner);
    let places = nodes.map(|&n| x.get(n as usize).copied().unwrap_or_default());
    to.iter_mut().zip(places).map(|(to, x)| *to = x).count()
}
