//! How well elements are shaped.
//!
//! ```text
//! F = ∂x/∂ξ (∂X/∂ξ)⁻¹,   X the equilateral or cubic element           (Q1)
//! η = d det(F)^(2/d) / (F : F),   the least over the nodes            (Q2)
//! ```
//!
//! η is 1 for the ideal shape whatever its size, tends to 0 as an element becomes flat, and counts as 0 where it is
//! turned inside out. Source: P. M. Knupp, Algebraic mesh quality metrics, SIAM J. Sci. Comput. 23 (2001) 193–218.

use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::{Mat3, Vec3};

/// Classes of the histogram.
pub const NCLASS: usize = 10;

/// The shapes of the elements of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quality {
    /// Cells of the mesh's dimension with their η.
    pub cells: Vec<(CellId, f64)>,
    /// How many lie in each tenth from 0 to 1.
    pub histogram: [usize; NCLASS],
}

impl Quality {
    /// Looks at all cells of the mesh's dimension.
    pub fn new(mesh: &Mesh) -> Self {
        let mut quality = Self::default();
        for cell in mesh.cells(mesh.dim()) {
            let Some(element) = mesh.element(cell) else {
                continue;
            };
            let nodes = mesh.cell(cell).iter();
            let points: Vec<Vec3> = nodes
                .filter_map(|&n| mesh.points.get(n as usize).copied())
                .collect();
            let eta = shape(element, &points);
            let class = (eta * NCLASS as f64) as usize;
            quality.histogram[class.min(NCLASS - 1)] += 1;
            quality.cells.push((cell, eta));
        }
        quality
    }

    /// The worst cell.
    pub fn worst(&self) -> Option<(CellId, f64)> {
        let cells = self.cells.iter().copied();
        cells.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// η of an element (Q2).
pub fn shape(element: Element, points: &[Vec3]) -> f64 {
    if points.len() != element.nnode() {
        return 0.0;
    }
    let (dim, ideal) = (element.dim(), ideal(element));
    let mut slopes = vec![Vec3::ZERO; element.nnode()];
    let at_node = |xi: &Vec3| {
        element.dshape(xi, &mut slopes);
        let mut jacobian = Mat3::default();
        for (x, slope) in points.iter().zip(&slopes) {
            let outer = Mat3::outer(*x, *slope);
            for (row, more) in jacobian.rows.iter_mut().zip(outer.rows) {
                *row = *row + more;
            }
        }
        if dim == 2 {
            jacobian.rows[2] = Vec3::unit(2);
        }
        let f = jacobian * ideal;
        let det = f.determinant();
        let square: f64 = f.rows.iter().map(|r| r.norm_squared()).sum();
        // the third direction of the plane adds its 1
        let square = if dim == 2 { square - 1.0 } else { square };
        let d = dim as f64;
        if det > 0.0 && square > 0.0 {
            d * det.powf(2.0 / d) / square
        } else {
            0.0
        }
    };
    element.nodes().iter().map(at_node).fold(1.0, f64::min)
}

/// `(∂X/∂ξ)⁻¹` of the ideal element.
fn ideal(element: Element) -> Mat3 {
    let (half, height) = (0.5, 0.75f64.sqrt());
    let columns = match (element.dim(), corners(element)) {
        (2, 3) => [[1.0, 0.0, 0.0], [half, height, 0.0], [0.0, 0.0, 1.0]],
        (3, 4) => [
            [1.0, 0.0, 0.0],
            [half, height, 0.0],
            [half, height / 3.0, (2.0f64 / 3.0).sqrt()],
        ],
        (3, 6) => [[1.0, 0.0, 0.0], [half, height, 0.0], [0.0, 0.0, half]],
        _ => return Mat3::IDENTITY,
    };
    let columns = Mat3::from_rows(columns.map(Vec3::from));
    let inverse = columns.transpose().inverse();
    inverse.map_or(Mat3::IDENTITY, |(inverse, _)| inverse)
}

/// The corners of an element: nodes at which its edges end.
fn corners(element: Element) -> usize {
    let ends = element.edges().iter().flatten();
    ends.max().map_or(0, |last| last + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element;

    fn moved(name: &str, by: impl Fn(Vec3) -> Vec3) -> f64 {
        let element = element::by_name(name).unwrap();
        let ideal = ideal(element).inverse().unwrap().0;
        let points: Vec<Vec3> = element.nodes().iter().map(|&x| by(ideal * x)).collect();
        shape(element, &points)
    }

    #[test]
    fn ideal_elements_of_any_size_and_place_have_quality_one() {
        let turn = Mat3::rotation(Vec3::new(0.0, 0.0, 0.7));
        for name in ["tri3", "quad4", "tet4", "hex8", "wedge6"] {
            let eta = moved(name, |x| turn * x * 3e-4 + Vec3::new(5.0, 6.0, 0.0));
            assert!((eta - 1.0).abs() < 1e-9, "{name}: {eta}");
        }
    }

    #[test]
    fn stretched_elements_have_the_quality_of_the_stretch() {
        for (name, dim) in [("tri3", 2.0), ("quad4", 2.0), ("tet4", 3.0), ("hex8", 3.0)] {
            for s in [0.1, 0.5, 4.0f64] {
                let eta = moved(name, |x| Vec3::new(s * x.x, x.y, x.z));
                let wanted = dim * s.powf(2.0 / dim) / (s * s + dim - 1.0);
                assert!((eta - wanted).abs() < 1e-12, "{name} {s}: {eta}");
            }
        }
    }

    #[test]
    fn flat_and_mirrored_elements_have_quality_zero() {
        for name in ["tri3", "quad4", "tet4", "hex8", "wedge6"] {
            assert_eq!(moved(name, |x| Vec3::new(0.0, x.y, x.z)), 0.0);
            assert_eq!(moved(name, |x| Vec3::new(-x.x, x.y, x.z)), 0.0);
        }
    }
}
