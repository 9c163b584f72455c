//! The cell of a mesh in which a point lies, and the weights of its nodes there.
//!
//! ```text
//! x(ξ) = Σ N_i(ξ) X_i = p                                                                        (E1)
//! ξ ← ξ + J⁻ᵀ (p − x(ξ))                                                                          (E2)
//! ```
//!
//! A hierarchy of boxes names the cells whose box has the point; (E2), Newton's method, finds where in them it lies. A
//! point outside of all cells has the weights of the closest point of the closest face on the boundary, and its distance.
//!
//! Limits: cells whose map folds within may be missed; the point then counts for the closest face.

use crate::element::{Element, MAX_NODES};
use crate::mesh::{CellId, Mesh, NodeId, boundary};
use crate::proximity::{Aabb, Bvh};
use crate::surface::{ContactSurface, Facets, Placement, SurfaceJet};
use crate::tensor::{Mat3, Vec3};

/// By how much of its extent the box around the nodes of a curved cell may be exceeded.
const BULGE: f64 = 0.25;
/// Newton's iterations.
const ITERATIONS: usize = 30;
/// The change of ξ at which they end.
const SETTLED: f64 = 1e-13;
/// By how much ξ may lie outside of the reference domain, through rounding.
const ROUNDING: f64 = 1e-9;
/// How far from the reference domain the iteration is given up.
const FAR: f64 = 10.0;

/// Where a point lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Located {
    /// Nodes with their weights, which sum to one.
    pub weights: Vec<(NodeId, f64)>,
    /// How far it is from the mesh; zero within.
    pub distance: f64,
    /// The size of the cell, or of the face that it is close to.
    pub size: f64,
}

/// Finds points in a mesh.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::location::Locator;
/// use signorini_geometry::mesh::Mesh;
/// use signorini_geometry::tensor::Vec3;
///
/// let mut mesh = Mesh::default();
/// for [x, y] in [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]] {
///     mesh.points.push(Vec3::new(x, y, 0.0));
///     mesh.node_labels.push(mesh.points.len() as u64);
/// }
/// let quad4 = by_name("quad4").ok_or("not in the table")?;
/// let cell = mesh.push_cell(quad4, &[0, 1, 2, 3], 1);
/// let found = Locator::new(&mesh, &[cell]).and_then(|l| l.locate(Vec3::new(1.0, 1.0, 0.0)));
/// let weights: Vec<f64> = found.ok_or("no cells")?.weights.iter().map(|w| w.1).collect();
/// assert_eq!(weights, [0.375, 0.125, 0.125, 0.375]);
/// # Ok::<(), &str>(())
/// ```
pub struct Locator<'a> {
    mesh: &'a Mesh,
    cells: Vec<CellId>,
    of_cells: Bvh,
    faces: Facets,
    of_faces: Bvh,
}

impl<'a> Locator<'a> {
    /// A locator of points in these cells, which have the dimension of the mesh; `None` where there are none.
    #[must_use]
    pub fn new(mesh: &'a Mesh, cells: &[CellId]) -> Option<Self> {
        let has_cell = |cell: &&CellId| mesh.element(**cell).is_some_and(|e| e.dim() == mesh.dim());
        let cells: Vec<CellId> = cells.iter().filter(has_cell).copied().collect();
        let boxes: Vec<Aabb> = cells.iter().map(|&cell| box_of(mesh, cell)).collect();
        let faces = boundary(mesh, cells.iter().copied());
        let faces = Facets::new(mesh, &faces).ok()?;
        let at = Placement {
            x: &mesh.points,
            poses: &[],
        };
        let nfacet = faces.nfacet() as u32;
        let of_faces: Vec<Aabb> = (0..nfacet).map(|facet| faces.aabb(&at, facet)).collect();
        (!cells.is_empty()).then(|| Self {
            mesh,
            of_cells: Bvh::build(&boxes),
            of_faces: Bvh::build(&of_faces),
            cells,
            faces,
        })
    }

    /// Where a point lies; `None` where it is not finite.
    #[must_use]
    pub fn locate(&self, point: Vec3) -> Option<Located> {
        self.within(point).or_else(|| self.nearby(point))
    }

    fn within(&self, point: Vec3) -> Option<Located> {
        let mut found = None;
        // boxes that have the point alone: they are at no distance
        self.of_cells.visit_near(point, |id| {
            if found.is_none()
                && let Some(&cell) = self.cells.get(id as usize)
            {
                found = self.in_cell(cell, point);
            }
            0.0
        });
        found
    }

    fn in_cell(&self, cell: CellId, point: Vec3) -> Option<Located> {
        let element = self.mesh.element(cell)?;
        let nodes = self.mesh.cell(cell);
        let places: Vec<Vec3> = nodes
            .iter()
            .filter_map(|&n| self.mesh.points.get(n as usize))
            .copied()
            .collect();
        if places.len() != element.nnode() {
            return None;
        }
        let nearest = places.iter().zip(element.nodes()).min_by(|a, b| {
            let away = |x: &Vec3| (*x - point).norm_squared();
            away(a.0).total_cmp(&away(b.0))
        });
        let starts = [Some(element.centre()), nearest.map(|(_, xi)| *xi)];
        let xi = starts
            .into_iter()
            .flatten()
            .find_map(|xi| invert(element, &places, point, xi))?;
        let mut shape = [0.0; MAX_NODES];
        element.shape(&xi, shape.get_mut(..element.nnode())?);
        Some(Located {
            weights: nodes.iter().copied().zip(shape).collect(),
            distance: 0.0,
            size: Aabb::around(places).width(),
        })
    }

    fn nearby(&self, point: Vec3) -> Option<Located> {
        let at = Placement {
            x: &self.mesh.points,
            poses: &[],
        };
        let mut best: Option<(f64, u32, Vec<f64>)> = None;
        let mut jet = SurfaceJet::default();
        self.of_faces.visit_near(point, |facet| {
            let closest = self.faces.project(&at, facet, point, None, &mut jet);
            let distance = (jet.position - point).norm();
            let known = best.as_ref().map_or(f64::INFINITY, |best| best.0);
            if matches!(closest, Ok(Some(_))) && distance < known {
                best = Some((distance, facet, jet.shape.to_vec()));
            }
            best.as_ref().map_or(f64::INFINITY, |best| best.0)
        });
        let (distance, facet, shape) = best?;
        Some(Located {
            weights: self.faces.nodes(facet).iter().copied().zip(shape).collect(),
            distance,
            size: self.faces.size(&at, facet),
        })
    }
}

/// The box that a cell stays in.
fn box_of(mesh: &Mesh, cell: CellId) -> Aabb {
    let places = mesh
        .cell(cell)
        .iter()
        .filter_map(|&n| mesh.points.get(n as usize));
    let bounds = Aabb::around(places.copied());
    let is_linear = mesh
        .element(cell)
        .is_some_and(|element| element.is_linear());
    let extent = bounds.extent().max_abs();
    bounds.inflated(extent * if is_linear { ROUNDING } else { BULGE })
}

/// ξ of a point, (E2); `None` where it lies outside.
fn invert(element: Element, places: &[Vec3], point: Vec3, start: Vec3) -> Option<Vec3> {
    let (n, dim) = (element.nnode(), element.dim());
    let (mut shape, mut slopes) = ([0.0; MAX_NODES], [Vec3::ZERO; MAX_NODES]);
    let mut xi = start;
    for _ in 0..ITERATIONS {
        element.shape(&xi, shape.get_mut(..n)?);
        element.dshape(&xi, slopes.get_mut(..n)?);
        let (mut x, mut jacobian) = (Vec3::ZERO, Mat3::ZERO);
        for ((place, n), d) in places.iter().zip(shape).zip(slopes) {
            x += *place * n;
            for a in 0..dim {
                jacobian.rows[a] += *place * d[a];
            }
        }
        for a in dim..3 {
            jacobian.rows[a] = Vec3::unit(a);
        }
        let (inverse, _) = jacobian.transpose().inverse()?;
        let mut step = inverse * (point - x);
        let off = (dim..3).fold(0.0, |off: f64, a| off.max(step[a].abs()));
        (dim..3).for_each(|a| step[a] = 0.0);
        xi += step;
        if !xi.is_finite() || xi.max_abs() > FAR {
            return None;
        }
        if step.max_abs() < SETTLED {
            let size = Aabb::around(places.iter().copied()).width();
            let is_in_plane = off <= ROUNDING * size;
            return (is_in_plane && element.contains(&xi, ROUNDING)).then_some(xi);
        }
    }
    None
}

#[cfg(test)]
mod tests;
