//! Convergence of mortar contact whose edge is not known beforehand.
//!
//! SOURCE      Written for the purpose; orders after Hüeber, Wohlmuth, Comput. Methods Appl. Mech. Engrg. 194 (2005), and
//!             Popp, Wohlmuth, Gee, Wall, SIAM J. Sci. Comput. 34 (2012)
//! GOAL        The error in the energy norm falls with h for linear elements and with h^3/2 for quadratic ones: the pressure
//!             goes to zero as a square root at the edge of the contact, so that u is in H^s for s < 5/2 only
//! MESH        Two layers of 4 × 1, 4 n × n cells above and 6 n × 3/2 n below, which do not match; in space a slice of them,
//!             n/2 and 3/4 n cells thick; n doubles from mesh to mesh
//! CONDITIONS  Plane strain, small strain, no friction; u_x = 0 at x = 0 and u_y = 0 on the bottom; on top the pressure
//!             p0 cos²(πx/2) as far as x = 1. The upper layer lifts off from x = 1.6 on. Corners are free of singularities
//! EXPECTED    The slope of the error, relative to the energy norm of a solution with quad9, at least four times finer
//! TOLERANCE   0.05 below the order 1, and 0.1 below the order 3/2, which depends on where in a facet the edge lies
#![allow(clippy::unwrap_used)]

mod common;

use common::{Grid, Part, Point, sample, shape};
use signorini_geometry::element::quadrature;
use signorini_geometry::mesh::{CellId, Mesh, NodeId, boundary};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use signorini_mechanics::load::Course;
use signorini_mechanics::material::SaintVenantKirchhoff;
use signorini_mechanics::model::{
    BodyKind, BodyPart, Change, ContactPart, Load, LoadPart, Method, Model, Parts, PrimaryPart,
    SidePart, StepPart, Target,
};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::Idealisation;
use std::collections::BTreeMap;
use std::f64::consts::PI;

const MODULUS: f64 = 1.0;
const POISSON: f64 = 0.3;
/// Length of the layers; their height is 1.
const LENGTH: f64 = 4.0;
/// Half of the loaded length.
const LOADED: f64 = 1.0;
/// Lower and upper layer: cells in a height of 2, and where the bottom is.
const LAYERS: [(usize, f64); 2] = [(3, -1.0), (2, 0.0)];

/// What is solved.
#[derive(Clone, Copy)]
struct Case {
    /// Finite-sliding contact, or small sliding.
    finite: bool,
    /// The largest pressure of the load.
    load: f64,
    /// Whether the upper layer is the secondary side.
    upper: bool,
}

const CASE: Case = Case {
    finite: false,
    load: 1e-3,
    upper: true,
};

/// Two layers that have been pressed together.
struct Solution {
    element: &'static str,
    space: Idealisation,
    mesh: Mesh,
    /// Boxes along each axis, and the layer.
    layers: Vec<([usize; 3], Part)>,
    u: Vec<f64>,
}

fn load(x: Vec3) -> f64 {
    if x.x < LOADED {
        (0.5 * PI * x.x / LOADED).cos().powi(2)
    } else {
        0.0
    }
}

impl Solution {
    fn new(case: Case, element: &'static str, n: usize) -> Self {
        let space = match shape(element).linear().dim() {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        };
        let mut mesh = Mesh::default();
        let mut layers = Vec::new();
        for (layer, (cells, bottom)) in LAYERS.into_iter().enumerate() {
            let high = cells * n / 2;
            let count = [4 * high, high, high / 2];
            let size = Vec3::new(LENGTH, 1.0, 0.5);
            let grid = Grid::of(element, count, |x| {
                Vec3::new(size.x * x.x, bottom + size.y * x.y, size.z * x.z)
            });
            let facing = [1.0, 0.0][layer];
            let part = grid.join(&mut mesh, |x| (x.y - facing).abs() < 1e-9);
            layers.push((count, part));
        }
        let mut solution = Self {
            element,
            space,
            mesh,
            layers,
            u: Vec::new(),
        };
        solution.u = solution.solve(case);
        solution
    }

    fn layer(&self, layer: usize) -> &Part {
        &self.layers[layer].1
    }

    /// The forces on nodes that are consistent with the pressure on top.
    fn forces(&self, size: f64) -> Vec<(NodeId, Vec3)> {
        let mut forces: BTreeMap<NodeId, Vec3> = BTreeMap::new();
        let line = quadrature::gauss(5);
        let cells = self.layer(1).cells.iter().copied();
        for face in boundary(&self.mesh, cells) {
            let (element, nodes) = self.mesh.face(face).unwrap();
            let at: Vec<Vec3> = nodes
                .iter()
                .map(|&n| self.mesh.points[n as usize])
                .collect();
            if at.iter().any(|x| x.y < 1.0 - 1e-9) {
                continue;
            }
            let mut weights = vec![0.0; element.nnode()];
            let mut slopes = vec![Vec3::ZERO; element.nnode()];
            for (xi, w) in quadrature::on_facet(element, &line) {
                element.shape(&xi, &mut weights);
                element.dshape(&xi, &mut slopes);
                let along = |axis: usize| at.iter().zip(&slopes).map(|(x, d)| *x * d[axis]).sum();
                let across = if element.dim() == 1 {
                    Vec3::unit(2)
                } else {
                    along(1)
                };
                let area = along(0).cross(across).norm();
                let x: Vec3 = at.iter().zip(&weights).map(|(x, n)| *x * *n).sum();
                for (node, n) in nodes.iter().zip(&weights) {
                    forces.entry(*node).or_default().y -= size * load(x) * w * area * n;
                }
            }
        }
        forces.into_iter().collect()
    }

    /// The displacements of the nodes.
    fn solve(&self, case: Case) -> Vec<f64> {
        let mut changes = Vec::new();
        let mut hold = |nodes, axis| {
            let motion = vec![(axis, Motion::Hold)];
            changes.push(Change::Prescribe(Target::Nodes(nodes), motion));
        };
        hold(self.layer(0).nodes(|x| x.y < 1e-9), 1);
        for (_, part) in &self.layers {
            hold(part.nodes(|x| x.x < 1e-9), 0);
            if self.space == Idealisation::Space {
                hold(part.nodes(|x| x.z < 1e-9 || x.z > 1.0 - 1e-9), 2);
            }
        }
        let body = |name: &str, part: &Part| BodyPart {
            name: name.into(),
            cells: part.cells.clone(),
            kind: BodyKind::Solid {
                material: Box::new(SaintVenantKirchhoff::new(MODULUS, POISSON)),
                density: None,
                integration: Integration::Full,
                locking: Locking::None,
            },
        };
        let (secondary, primary) = if case.upper { (1, 0) } else { (0, 1) };
        let mut contact = ContactPart::new(
            "between",
            SidePart::Faces(self.layer(secondary).faces.clone()),
            PrimaryPart::Faces(self.layer(primary).faces.clone()),
        );
        contact.method = Method::Mortar {
            normals: Default::default(),
        };
        contact.small_sliding = !case.finite;
        let parts = Parts {
            bodies: vec![body("lower", self.layer(0)), body("upper", self.layer(1))],
            contacts: vec![contact],
            steps: vec![StepPart {
                name: "press".into(),
                duration: 1.0,
                increments: Increments::Fixed(1),
                nonlinear: false,
                changes,
                loads: vec![LoadPart {
                    name: "pressure".into(),
                    load: Load::Nodes(self.forces(case.load)),
                    course: Course::Ramp,
                }],
                contacts: Vec::new(),
                temperatures: Vec::new(),
            }],
            ..Parts::new(&self.mesh, self.space)
        };
        let mut model = Model::assemble(parts).unwrap();
        let mut stepper = Stepper::new(&model.system, StepperSettings::default());
        let mut watch = |event: &Event<'_>| {
            if let Event::Increment { record, frame } = event {
                let contact = &frame.contacts[0];
                let mut row: Vec<_> = contact
                    .points
                    .iter()
                    .zip(&contact.pressure)
                    .filter(|(_, p)| **p > 0.0)
                    .map(|(x, p)| (x.x, *p))
                    .collect();
                row.sort_by(|a, b| a.0.total_cmp(&b.0));
                println!(
                    "{} iterations, edge {:?}, force {}",
                    record.iterations,
                    row.last(),
                    contact.secondary.force.y
                );
            }
            Flow::Continue
        };
        let outcome = stepper.run(&mut model.system, &model.steps, &mut watch);
        assert_eq!(outcome.unwrap(), Outcome::Finished);
        stepper.state().u.clone()
    }

    fn strain(&self, cell: CellId, point: &Point) -> Sym3 {
        let ndim = self.space.ndim();
        let mut gradient = Mat3::ZERO;
        for (&node, slope) in self.mesh.cell(cell).iter().zip(&point.gradients) {
            let u = &self.u[node as usize * ndim..][..ndim];
            for (row, u) in gradient.rows.iter_mut().zip(u) {
                *row += *slope * *u;
            }
        }
        Sym3::symmetric_part(gradient)
    }

    /// The strain at a point of a layer, if this is a plane solution of quadrilaterals.
    fn strain_at(&self, layer: usize, x: Vec3) -> Sym3 {
        let ([nx, ny, _], part) = &self.layers[layer];
        let place = |s: f64, n: usize| {
            let place = (s * n as f64).clamp(0.0, n as f64 - 1e-9);
            (place as usize, 2.0 * place.fract() - 1.0)
        };
        let (column, xi) = place(x.x / LENGTH, *nx);
        let (row, eta) = place(x.y - LAYERS[layer].1, *ny);
        let cell = part.cells[row * nx + column];
        let xi = Vec3::new(xi, eta, 0.0);
        self.strain(cell, &sample(&self.mesh, self.space, cell, &xi, 1.0))
    }

    /// The difference in the energy norm to a plane solution of quadrilaterals, relative to its norm.
    fn error(&self, exact: &Self) -> f64 {
        let rule = shape(self.element).rule();
        let (mut difference, mut whole) = (0.0, 0.0);
        for (layer, (_, part)) in self.layers.iter().enumerate() {
            for &cell in &part.cells {
                for (xi, w) in &rule {
                    let point = sample(&self.mesh, self.space, cell, xi, *w);
                    let expected = exact.strain_at(layer, point.x);
                    let found = self.strain(cell, &point);
                    whole += point.volume * energy(expected);
                    difference += point.volume * energy(found - expected);
                }
            }
        }
        (difference / whole).sqrt()
    }
}

/// Twice the energy per volume of Hooke's law.
fn energy(strain: Sym3) -> f64 {
    let mu = MODULUS / (2.0 * (1.0 + POISSON));
    let lambda = 2.0 * mu * POISSON / (1.0 - 2.0 * POISSON);
    2.0 * mu * strain.double_dot(strain) + lambda * strain.trace().powi(2)
}

#[test]
fn explore() {
    let list = |name: &str, default: &str| std::env::var(name).unwrap_or(default.into());
    let case = Case {
        finite: list("FINITE", "0") == "1",
        upper: list("UPPER", "1") == "1",
        ..CASE
    };
    let clock = std::time::Instant::now();
    let n: usize = list("REF", "32").parse().unwrap();
    let exact = Solution::new(case, "quad9", n);
    println!("reference {n}: {:?}", clock.elapsed());
    for element in list("ELEMENTS", "tri3 quad4 tri6 quad8 quad9").split(' ') {
        let element: &'static str = Box::leak(element.to_string().into_boxed_str());
        let mut last = f64::NAN;
        for n in list("MESHES", "2 4 8").split(' ') {
            let n: usize = n.parse().unwrap();
            let solution = Solution::new(case, element, n);
            let error = solution.error(&exact);
            println!(
                "{element} {n} {error:.4e} {:.3} {:?}",
                (last / error).log2(),
                clock.elapsed()
            );
            last = error;
        }
    }
}
