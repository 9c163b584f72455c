//! How thick a body is below its surface: one ray along the inward normal to the other side.

use super::{Facets, Placement};
use crate::element::MAX_FACET_NODES;
use crate::proximity::{Aabb, Bvh};
use crate::surface::ContactSurface;
use crate::tensor::Vec3;

/// How far beyond the edge of a facet a ray still meets it, relative to the facet: edges have no holes.
const EDGE: f64 = 1e-9;

/// The least cosine of the angle between a ray and the outward normal where it leaves through the other side of a body, and
/// not through a flank or a plane of symmetry next to it.
const ACROSS: f64 = 0.5;

/// The outline of a body, through which rays are sent.
#[derive(Debug)]
pub struct Outline {
    facets: Facets,
    tree: Bvh,
}

impl Outline {
    /// The outline made of these facets, all around a body, with its nodes at `x`.
    #[must_use]
    pub fn new(facets: Facets, x: &[Vec3]) -> Self {
        let at = Placement { x, poses: &[] };
        let boxes = (0..facets.nfacet() as u32).map(|f| facets.aabb(&at, f));
        let boxes: Vec<Aabb> = boxes.collect();
        Self {
            tree: Bvh::build(&boxes),
            facets,
        }
    }

    /// How far a ray from a point at or below the surface goes along a unit vector until it leaves the body through its other
    /// side, within 60 degrees of the normal there; `None` where that is farther than `within` (lengths). Facets of quadratic elements are taken as polygons through their nodes.
    #[must_use]
    pub fn leaves(&self, x: &[Vec3], from: Vec3, along: Vec3, within: f64) -> Option<f64> {
        let region = Aabb::around([from, from + along * within]);
        let mut near = Vec::new();
        self.tree
            .overlaps(&region.inflated(EDGE * within), &mut near);
        let hits = near.iter().filter_map(|&f| self.hit(x, f, from, along));
        hits.filter(|&way| way <= within).reduce(f64::min)
    }

    /// Where a ray leaves the body through a facet.
    fn hit(&self, x: &[Vec3], facet: u32, from: Vec3, along: Vec3) -> Option<f64> {
        let element = self.facets.element(facet)?;
        let mut nodes = [Vec3::ZERO; MAX_FACET_NODES];
        for (to, &node) in nodes.iter_mut().zip(self.facets.nodes(facet)) {
            *to = x.get(node as usize).copied().unwrap_or_default() - from;
        }
        let edges = element.edges().iter().enumerate();
        let sides = edges.flat_map(|(edge, &[start, end])| {
            let inside = element.inside_edge(edge);
            let ends = inside.clone().chain([end]);
            let pieces = std::iter::once(start).chain(inside).zip(ends);
            pieces.map(|(a, b)| (nodes[a], nodes[b]))
        });
        if element.dim() == 1 {
            let mut ways = sides.filter_map(|(a, b)| through_line(a, b, along));
            return ways.next();
        }
        let ncorner = element.ncorner();
        let sum: Vec3 = nodes[..ncorner].iter().copied().sum();
        let centre = sum / ncorner as f64;
        let mut ways = sides.filter_map(|(a, b)| through_triangle([centre, a, b], along));
        ways.next()
    }
}

/// How far along a ray from the origin its way out through a line of the plane is, whose outer side is on the right.
fn through_line(a: Vec3, b: Vec3, along: Vec3) -> Option<f64> {
    let side = b - a;
    let cross = |p: Vec3, q: Vec3| p.x * q.y - p.y * q.x;
    let out = cross(along, side);
    if out <= ACROSS * side.norm() {
        return None;
    }
    let place = cross(a, along) / out;
    let way = cross(a, side) / out;
    ((-EDGE..=1.0 + EDGE).contains(&place) && way > 0.0).then_some(way)
}

/// How far along a ray from the origin its way out through a triangle is, that is seen counter-clockwise from outside.
fn through_triangle([a, b, c]: [Vec3; 3], along: Vec3) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let out = normal.dot(along);
    if out <= ACROSS * normal.norm() {
        return None;
    }
    let way = normal.dot(a) / out;
    let at = along * way;
    let inside =
        |p: Vec3, q: Vec3| (q - p).cross(at - p).dot(normal) >= -EDGE * normal.norm_squared();
    (way > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)).then_some(way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::by_name;
    use crate::mesh::{Mesh, boundary};

    /// A ring of `n` cells between two radii, or, with a height, a tube.
    fn ring(n: u32, radii: [f64; 2], height: Option<f64>) -> (Outline, Vec<Vec3>) {
        let mut mesh = Mesh::default();
        let layers: &[f64] = if height.is_some() {
            &[0.0, 1.0]
        } else {
            &[0.0]
        };
        for z in layers {
            for r in radii {
                for k in 0..n {
                    let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
                    let z = z * height.unwrap_or(0.0);
                    mesh.points
                        .push(Vec3::new(r * angle.cos(), r * angle.sin(), z));
                }
            }
        }
        mesh.node_labels = (1..=mesh.points.len() as u64).collect();
        for k in 0..n {
            let next = (k + 1) % n;
            let face = [k, k + n, next + n, next];
            let label = u64::from(k) + 1;
            match height {
                None => mesh.push_cell(by_name("quad4").unwrap(), &face, label),
                Some(_) => {
                    let nodes = [face, face.map(|node| node + 2 * n)].concat();
                    mesh.push_cell(by_name("hex8").unwrap(), &nodes, label)
                }
            };
        }
        let faces = boundary(&mesh, mesh.cells(mesh.dim()));
        let facets = Facets::new(&mesh, &faces).unwrap();
        (Outline::new(facets, &mesh.points), mesh.points)
    }

    #[test]
    fn a_ray_into_the_wall_of_a_ring_or_a_tube_is_as_long_as_the_wall_is_thick() {
        for height in [None, Some(0.4)] {
            let (outline, x) = ring(64, [1.0, 1.3], height);
            let z = height.map_or(0.0, |h| 0.3 * h);
            for k in 0..40 {
                let angle = 0.1 + 0.37 * f64::from(k);
                let out = Vec3::new(angle.cos(), angle.sin(), 0.0);
                let lift = Vec3::unit(2) * z;
                let inner = outline.leaves(&x, out * 1.002 + lift, out, 1.0).unwrap();
                assert!((inner - 0.298).abs() < 4e-3, "{inner}");
                let outer = outline.leaves(&x, out * 1.297 + lift, -out, 1.0).unwrap();
                assert!((outer - 0.297).abs() < 4e-3, "{outer}");
                assert_eq!(outline.leaves(&x, out * 1.297 + lift, -out, 0.25), None);
            }
        }
    }

    #[test]
    fn a_ray_that_leaves_through_a_flank_has_not_met_the_other_side() {
        let (outline, x) = ring(64, [1.0, 3.0], Some(1.0));
        let from = Vec3::new(0.0, 1.0, 0.02);
        let along = Vec3::new(0.0, 1.0, -0.1).normalized().unwrap();
        assert_eq!(outline.leaves(&x, from, along, 5.0), None);
    }

    #[test]
    fn a_ray_along_the_edges_of_facets_slips_through_nowhere() {
        let (outline, x) = ring(12, [1.0, 2.0], Some(1.0));
        for k in 0..12 {
            let from = x[12 + k] + Vec3::unit(2) * 0.5;
            let inward = -x[12 + k].normalized().unwrap();
            let way = outline.leaves(&x, from, inward, 5.0).unwrap();
            assert!((way - 1.0).abs() < 1e-9, "{way}");
        }
    }
}
