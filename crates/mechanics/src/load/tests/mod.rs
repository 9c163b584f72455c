//! Loads against differences, closed forms and whole runs.

mod courses;
mod derivatives;
mod mass;
mod model;
mod resultants;
mod rigid;

use super::{
    Acting, BodyForce, Centrifugal, Course, FollowingPressure, Force, Gravity, Load, Moment,
    NodalForces, Place, Pressure, Region, Schedule, Section, Spin, Traction, Wrench, spread,
};
use crate::system::{
    Dof, Elimination, Idealisation, Layout, Order, Phase, Sink, State, StepContext, Symmetry, Term,
    Work,
};
use signorini_geometry::element::{self, Element};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::sync::Arc;

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// Space for elements of three dimensions, every idealisation for those of the plane.
fn spaces(element: Element) -> Vec<Idealisation> {
    if element.dim() == 3 {
        return vec![Idealisation::Space];
    }
    vec![
        Idealisation::PlaneStrain { thickness: 1.3 },
        Idealisation::PlaneStress { thickness: 0.7 },
        Idealisation::Axisymmetric,
    ]
}

/// Every solid in every space that it is made for.
fn cases() -> impl Iterator<Item = (Element, Idealisation)> {
    let solids = element::TABLE.into_iter().filter(|e| e.dim() > 1);
    solids.flat_map(|e| spaces(e).into_iter().map(move |s| (e, s)))
}

/// One element, its nodes moved at random by at most `distortion`, away from the axis.
struct Single {
    element: Element,
    space: Idealisation,
    layout: Layout,
    reference: Arc<[Vec3]>,
    mesh: Mesh,
    cell: CellId,
}

impl Single {
    fn new(element: Element, space: Idealisation, distortion: f64) -> Self {
        let mut mesh = Mesh::default();
        for (i, xi) in element.nodes().iter().enumerate() {
            let mut x = *xi + Vec3::unit(0) * 2.0;
            for axis in 0..element.dim() {
                x[axis] += distortion * noise(3 * i + axis);
            }
            mesh.points.push(x);
            mesh.node_labels.push(i as u64 + 1);
        }
        let nodes: Vec<NodeId> = (0..element.nnode() as NodeId).collect();
        let cell = mesh.push_cell(element, &nodes, 7);
        let layout = Layout::new(space.ndim(), mesh.nnode(), 0);
        Self {
            element,
            space,
            layout,
            reference: mesh.points.clone().into(),
            mesh,
            cell,
        }
    }

    fn state(&self, u: &[f64]) -> State {
        let nothing = Elimination::default();
        let zero = State::initial(&self.layout, &self.reference, &nothing);
        let mut moved = zero.clone();
        moved.advance_from(&zero, u, 1.0, &self.layout, &self.reference, &nothing);
        moved.time = 1.0;
        moved
    }

    /// One of its faces.
    fn face(&self, side: usize) -> Region {
        let mut region = Region::default();
        self.add(side, &mut region);
        region
    }

    /// All its faces.
    fn surface(&self) -> Region {
        let mut region = Region::default();
        (0..self.element.sides().len()).for_each(|side| self.add(side, &mut region));
        region
    }

    fn add(&self, side: usize, region: &mut Region) {
        let face = Face {
            cell: self.cell,
            side: side as u8,
        };
        let (element, nodes) = self.mesh.face(face).unwrap();
        region.push(element, self.space, &nodes, 1.0);
    }

    fn volume(&self, density: f64) -> Region {
        let mut region = Region::default();
        region.push(self.element, self.space, self.mesh.cell(self.cell), density);
        region
    }

    fn pressure(&self, faces: Region, pressure: f64) -> FollowingPressure {
        let (layout, reference) = (self.layout, self.reference.clone());
        let what = (faces, pressure);
        FollowingPressure::new("p", what, full(), layout, reference)
    }

    fn centrifugal(&self, density: f64, spin: Spin) -> Centrifugal {
        let (layout, reference) = (self.layout, self.reference.clone());
        let what = (self.volume(density), spin);
        Centrifugal::new("spin", what, &[self.cell], full(), layout, reference)
    }

    fn dead(&self, forces: spread::NodalVectors) -> NodalForces {
        let components = |(node, f): (NodeId, Vec3)| {
            (0..self.layout.ndim()).map(move |axis| (self.layout.node(node, axis), f[axis]))
        };
        let forces: Vec<_> = forces.into_iter().flat_map(components).collect();
        NodalForces::new("dead", &forces, full())
    }

    /// Force and moment about the origin that a term exerts.
    fn resultant(&self, term: &dyn Term, state: &State) -> [Vec3; 2] {
        let r = response(term, &self.layout, state).residual;
        let mut sum = [Vec3::ZERO; 2];
        for (node, x) in state.x.iter().enumerate() {
            let mut f = Vec3::ZERO;
            for axis in 0..self.layout.ndim() {
                f[axis] = -r[node * self.layout.ndim() + axis];
            }
            sum[0] += f;
            sum[1] += x.cross(f);
        }
        sum
    }
}

/// At full size at the time 1 of the first step.
fn full() -> Schedule {
    Schedule::ramps(&[1.0])
}

fn step(nonlinear: bool) -> StepContext {
    StepContext {
        nonlinear,
        ..StepContext::default()
    }
}

/// What a term adds to the system.
struct Response {
    residual: Vec<f64>,
    stiffness: Vec<f64>,
    energy: Option<f64>,
}

struct Dense<'a>(&'a mut Response);

impl Sink for Dense<'_> {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = self.0.residual.len();
        for (i, &row) in dofs.iter().enumerate() {
            self.0.residual[row as usize] += force[i];
            for (j, &column) in dofs.iter().enumerate() {
                let value = stiffness.get(i * dofs.len() + j).copied().unwrap_or(0.0);
                self.0.stiffness[row as usize * n + column as usize] += value;
            }
        }
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        crate::system::couple_as_square(self, rows, columns, stiffness);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

fn response(term: &dyn Term, layout: &Layout, state: &State) -> Response {
    let n = layout.ndof();
    let mut response = Response {
        residual: vec![0.0; n],
        stiffness: vec![0.0; n * n],
        energy: Some(0.0),
    };
    let mut work = Work::default();
    for chunk in 0..term.nchunk() {
        term.evaluate(
            chunk,
            state,
            Order::Tangent,
            &mut work,
            &mut Dense(&mut response),
        )
        .unwrap();
        let energy = term.energy(chunk, state, &mut work).unwrap();
        response.energy = response.energy.zip(energy).map(|(a, b)| a + b);
    }
    response
}

fn assert_near(got: Vec3, expected: Vec3, tolerance: f64, what: &str) {
    let error = (got - expected).max_abs();
    assert!(error <= tolerance, "{what}: {got:?} {expected:?} {error:e}");
}
