//! An element as kernels see it: what they take, and what they return.

use crate::material::{Kinematics, Material, MaterialError};
use crate::system::{Idealisation, profile_at};
use signorini_geometry::element::ReferenceElement;
use signorini_geometry::element::quadrature::{self, Rule};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// An element with its nodes.
pub(in crate::solid) struct Element<'a> {
    pub reference: &'a Points,
    pub x: &'a [Vec3],
    pub u: &'a [f64],
    /// The correction that led to `u`, from which the geometric stiffness predicts its stress; empty: it takes the stress.
    pub correction: &'a [f64],
    /// Their way in the increment, where stresses are secants; `u` is then halfway.
    pub way: &'a [f64],
    /// Their velocities, where stresses follow from rates of strain, and by what these change with displacements.
    pub rate: &'a [f64],
    pub slope: f64,
    pub material: &'a dyn Material,
    pub kinematics: Kinematics,
    pub space: Idealisation,
    /// What the thickness is multiplied by at the nodes; empty: 1.
    pub profile: &'a [f64],
    /// Temperatures of the nodes; empty where there are none.
    pub temperature: &'a [f64],
    /// What they were at the start of the run.
    pub temperature_at_start: &'a [f64],
    /// Terms of the polynomial onto which the dilatation is projected.
    pub ndilatation: usize,
    /// History at the start of the increment: of each point, then the incompatible modes.
    pub old: &'a [f64],
    /// What each point has at the start; empty where no point has anything.
    pub initial: &'a [Initial],
    /// Axes of the material: none, those of the cell, or of each point.
    pub axes: &'a [Mat3],
}

impl Element<'_> {
    /// The extent where the nodes have these shape functions, at a position.
    #[inline]
    pub fn extent(&self, shape: &[f64], at: Vec3) -> f64 {
        self.space.extent(at) * profile_at(self.profile, shape)
    }
}

/// What a point has at the start.
#[derive(Clone, Copy, Default)]
pub(in crate::solid) struct Initial {
    /// Stress without strain.
    pub stress: Sym3,
    /// Strain without stress.
    pub strain: Sym3,
}

/// Results of one element. Forces and stiffness are those of displacements, node by node.
pub(in crate::solid) struct Output<'a> {
    pub force: &'a mut [f64],
    /// Row-major; empty where it is not wanted. Of a law that is symmetric the blocks `(I, J)` of nodes with `I ≤ J`.
    pub stiffness: &'a mut [f64],
    pub energy: f64,
    /// Stiffness against temperatures of the nodes, row-major; empty where it is not wanted.
    pub thermal: &'a mut [f64],
    /// History at the end of the increment.
    pub new: &'a mut [f64],
    /// What is known at the quadrature points; empty where it is not wanted.
    pub samples: &'a mut [Sample],
    pub scratch: &'a mut Vec<f64>,
}

impl Output<'_> {
    /// Zeroes what points add to.
    pub fn reset(&mut self) {
        self.energy = 0.0;
        self.force.fill(0.0);
        self.stiffness.fill(0.0);
        self.thermal.fill(0.0);
    }
}

/// What is known at a quadrature point.
#[derive(Clone, Copy, Default)]
pub(in crate::solid) struct Sample {
    /// Cauchy stress.
    pub stress: Sym3,
    /// Linearized, or logarithmic at finite strain.
    pub strain: Sym3,
    /// Where the material has one.
    pub plastic_strain: Option<f64>,
    /// Present volume that belongs to the point.
    pub volume: f64,
    /// The strain that the material sees: linearized, or of Green and Lagrange; with what it found across.
    pub seen: Sym3,
    /// What it was at.
    pub temperature: f64,
    /// What it was at at the start of the run.
    pub temperature_at_start: f64,
    /// Energy per volume at the start.
    pub energy: f64,
    /// That volume.
    pub volume_at_start: f64,
}

/// Why an element has no response.
pub(in crate::solid) enum Failure {
    Inverted { ratio: f64 },
    Material(MaterialError),
}

impl From<MaterialError> for Failure {
    fn from(error: MaterialError) -> Self {
        match error {
            MaterialError::Inverted { ratio } => Self::Inverted { ratio },
            other => Self::Material(other),
        }
    }
}

/// Shape functions at the quadrature points of a reference element: the same for all its cells.
pub(in crate::solid) struct Points {
    pub rule: &'static Rule,
    pub shape: Vec<f64>,
    pub dshape: Vec<Vec3>,
    /// What temperatures of nodes are multiplied with; empty where it is the shape functions.
    pub thermal: Vec<f64>,
    pub shape_at_centre: Vec<f64>,
    pub dshape_at_centre: Vec<Vec3>,
    pub nnode: usize,
    pub dim: usize,
}

impl Points {
    pub fn new(element: &dyn ReferenceElement, rule: &'static Rule) -> Self {
        let (nnode, npoint) = (element.nnode(), rule.npoint());
        let mut points = Self {
            rule,
            shape: vec![0.0; nnode * npoint],
            dshape: vec![Vec3::ZERO; nnode * npoint],
            thermal: Vec::new(),
            shape_at_centre: vec![0.0; nnode],
            dshape_at_centre: vec![Vec3::ZERO; nnode],
            nnode,
            dim: element.dim(),
        };
        for (point, xi) in rule.points.iter().enumerate() {
            let at = point * nnode..(point + 1) * nnode;
            element.shape(xi, &mut points.shape[at.clone()]);
            element.dshape(xi, &mut points.dshape[at]);
        }
        let centre = element.centre();
        element.shape(&centre, &mut points.shape_at_centre);
        element.dshape(&centre, &mut points.dshape_at_centre);
        points
    }

    /// Makes temperatures linear where the rule has more points than a reduced one of two along each axis: with those points
    /// `q`, at `±1/√3`, the temperature at a point is `Σ_q Π_a ½ (1 + 3 ξ_a q_a) T(q)`.
    pub fn linear_temperatures(&mut self, element: &dyn ReferenceElement) {
        let reduced = element.reduced_rule();
        let two_along_axes = [&quadrature::QUAD_4, &quadrature::HEX_8];
        let is_known = two_along_axes
            .iter()
            .any(|rule| std::ptr::eq(*rule, reduced));
        if !is_known || reduced.npoint() >= self.rule.npoint() {
            return;
        }
        let mut shape = vec![0.0; self.nnode];
        self.thermal = vec![0.0; self.nnode * self.rule.npoint()];
        for q in reduced.points {
            element.shape(q, &mut shape);
            let rows = self.thermal.chunks_exact_mut(self.nnode);
            for (xi, row) in self.rule.points.iter().zip(rows) {
                let axes = 0..element.dim();
                let weight: f64 = axes.map(|a| 0.5 * (1.0 + 3.0 * xi[a] * q[a])).product();
                for (to, n) in row.iter_mut().zip(&shape) {
                    *to += weight * n;
                }
            }
        }
    }

    /// What temperatures of nodes are multiplied with at a point.
    pub fn thermal(&self, point: usize) -> &[f64] {
        let own = self
            .thermal
            .get(point * self.nnode..(point + 1) * self.nnode);
        own.unwrap_or_else(|| self.shape(point))
    }

    /// Shape functions at a point.
    pub fn shape(&self, point: usize) -> &[f64] {
        &self.shape[point * self.nnode..(point + 1) * self.nnode]
    }

    pub fn dshape(&self, point: usize) -> &[Vec3] {
        &self.dshape[point * self.nnode..(point + 1) * self.nnode]
    }

    /// `∫ max_k |N_k,X|² dV` over a brick whose nodes are at `x`, with the functions of the quadrilateral in its middle; 0 where
    /// its map has no inverse.
    pub fn stretch_of_middle(&self, x: &[Vec3]) -> f64 {
        let dshape = &self.dshape_at_centre;
        let jacobian = map(x, dshape);
        let Some((inverse, det)) = jacobian.inverse() else {
            return 0.0;
        };
        let (negative, positive) = dshape.split_at(dshape.len() / 2);
        let middles = negative.iter().zip(positive).map(|(a, b)| *a + *b);
        let slopes = middles.map(|d| (inverse * d).norm_squared());
        let volume = self.rule.weights.iter().sum::<f64>() * det.abs();
        slopes.fold(0.0, f64::max) * volume
    }

    /// The largest extent over the smallest of a cell whose nodes are at `x`: of the singular values of the map from the
    /// reference element at the centre. Not finite where that has no inverse.
    pub fn slenderness(&self, x: &[Vec3]) -> f64 {
        let map = map(x, &self.dshape_at_centre);
        let mut squares = Sym3::gram(map.transpose()).eigenvalues();
        squares.sort_by(f64::total_cmp);
        let [.., largest] = squares;
        // in the plane the row across is zero
        let smallest = squares.get(3 - self.dim).copied().unwrap_or_default();
        (largest / smallest.max(0.0)).sqrt()
    }

    /// `∫ max_i |N_i,X|² dV` over a cell whose nodes are at `x`; 0 where its map has no inverse.
    pub fn stretch(&self, x: &[Vec3], space: Idealisation) -> f64 {
        let weights = self.rule.weights.iter().enumerate();
        let at_point = weights.map(|(point, weight)| {
            let mut jacobian = map(x, self.dshape(point));
            let shape = x.iter().zip(self.shape(point));
            let at = shape.fold(Vec3::ZERO, |at, (x, n)| at + *x * *n);
            if space.ndim() == 2 {
                jacobian.rows[2] = Vec3::unit(2);
            }
            let Some((inverse, det)) = jacobian.inverse() else {
                return 0.0;
            };
            let slopes = self.dshape(point).iter().map(|d| (inverse * *d).norm());
            let steepest = slopes.fold(0.0, f64::max);
            steepest * steepest * weight * det.abs() * space.extent(at)
        });
        at_point.sum()
    }
}

/// The rows `∂x/∂ξ_a` of the map from the reference element, along all of its axes.
fn map(x: &[Vec3], dshape: &[Vec3]) -> Mat3 {
    let mut map = Mat3::ZERO;
    for (x, slopes) in x.iter().zip(dshape) {
        for (row, slope) in map.rows.iter_mut().zip(slopes.to_array()) {
            *row += *x * slope;
        }
    }
    map
}
