//! Convergence of every solid element to a manufactured solution.
//!
//! SOURCE      the method of manufactured solutions; Roache, *Verification and Validation*, 1998
//! GOAL        errors fall with h^(p+1) in L2 and with h^p in the seminorm of H1, p the degree of the element; with the
//!             remedies against locking also for ν = 0.4999, where plain elements stand still
//! MESH        n and 2n cells along each edge of the unit square or cube, smoothly distorted
//! CONDITIONS  small strain; u = Σ a sin(k·x + φ), on the boundary prescribed, inside by its body force; for ν = 0.4999
//!             its divergence is zero (a·k = 0)
//! EXPECTED    the slopes between the two meshes
//! TOLERANCE   0.15 below the order: the coarser meshes are not yet asymptotic
#![allow(clippy::unwrap_used)]

mod common;

use common::{Grid, degree, sample, shape};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_mechanics::load::{Acting, Course};
use signorini_mechanics::material::SaintVenantKirchhoff;
use signorini_mechanics::model::{
    BodyKind, BodyPart, Change, LoadPart, Model, Parts, StepPart, Target,
};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::Idealisation;
use std::collections::BTreeMap;

fn distorted(x: Vec3, dim: usize) -> Vec3 {
    let wave = |a: f64, b: f64| 0.05 * (2.0 * a + 1.0).sin() * (3.0 * b).cos();
    let mut moved = x + Vec3::new(wave(x.x, x.y), wave(x.y, x.x), 0.0);
    if dim == 3 {
        moved += Vec3::new(wave(x.x, x.z), 0.0, wave(x.z, x.y));
    }
    moved
}

/// A displacement field with its material.
struct Field {
    space: Idealisation,
    /// Amplitude, wave vector and phase.
    waves: [(Vec3, Vec3, f64); 2],
    e: f64,
    nu: f64,
}

impl Field {
    /// Waves in space or plane; without divergence where the material is nearly incompressible.
    fn new(space: Idealisation, nu: f64) -> Self {
        let mut waves = [
            (Vec3::new(0.02, 0.01, 0.03), Vec3::new(1.1, 1.6, 0.7), 0.3),
            (Vec3::new(-0.01, 0.02, 0.01), Vec3::new(-0.8, 1.3, 1.2), 1.1),
        ];
        for (a, k, _) in &mut waves {
            if space.ndim() == 2 {
                (a.z, k.z) = (0.0, 0.0);
            }
            if nu > 0.49 {
                *a -= *k * (a.dot(*k) / k.dot(*k));
            }
        }
        let e = 3.0;
        Self {
            space,
            waves,
            e,
            nu,
        }
    }

    fn displacement(&self, x: Vec3) -> Vec3 {
        let one = |(a, k, p): &(Vec3, Vec3, f64)| *a * (k.dot(x) + p).sin();
        self.waves.iter().map(one).sum()
    }

    fn gradient(&self, x: Vec3) -> Mat3 {
        let mut h = Mat3::ZERO;
        for (a, k, p) in &self.waves {
            let slope = (k.dot(x) + p).cos();
            for (row, a) in h.rows.iter_mut().zip(a.to_array()) {
                *row += *k * (a * slope);
            }
        }
        h
    }

    fn stress(&self, x: Vec3) -> Mat3 {
        let mut h = self.gradient(x);
        if self.space == Idealisation::Axisymmetric {
            h.rows[2].z = self.displacement(x).x / x.x;
        }
        let mu = self.e / (2.0 * (1.0 + self.nu));
        let mut lambda = self.e * self.nu / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu));
        if let Idealisation::PlaneStress { .. } = self.space {
            lambda = 2.0 * lambda * mu / (lambda + 2.0 * mu);
        }
        let trace: f64 = (0..3).map(|i| h.rows[i][i]).sum();
        let mut stress = Mat3::ZERO;
        for i in 0..3 {
            for j in 0..3 {
                stress.rows[i][j] = mu * (h.rows[i][j] + h.rows[j][i]);
            }
            stress.rows[i][i] += lambda * trace;
        }
        stress
    }

    /// −div σ, by differences of the stress of fourth order.
    fn body_force(&self, x: Vec3) -> Vec3 {
        let h = 1e-3;
        let mut force = Vec3::ZERO;
        for axis in 0..self.space.ndim() {
            let at = |s: f64| self.stress(x + Vec3::unit(axis) * (s * h));
            let [p, m, pp, mm] = [1.0, -1.0, 2.0, -2.0].map(at);
            for i in 0..self.space.ndim() {
                let d = |s: &Mat3| s.rows[i][axis];
                force[i] -= (8.0 * (d(&p) - d(&m)) - (d(&pp) - d(&mm))) / (12.0 * h);
            }
        }
        if self.space == Idealisation::Axisymmetric {
            let s = self.stress(x);
            force.x -= (s.rows[0].x - s.rows[2].z) / x.x;
            force.y -= s.rows[0].y / x.x;
        }
        force
    }
}

/// What is done with the elements.
#[derive(Clone, Copy)]
struct Choice {
    integration: Integration,
    locking: Locking,
}

/// The displacements of the nodes where the body force acts and the boundary moves as in the field.
fn solution(
    mesh: &Mesh,
    cells: &[CellId],
    boundary: &[NodeId],
    rule: &[(Vec3, f64)],
    field: &Field,
    choice: Choice,
) -> Vec<f64> {
    let mut forces: BTreeMap<NodeId, Vec3> = BTreeMap::new();
    for &cell in cells {
        for (xi, w) in rule {
            let point = sample(mesh, field.space, cell, xi, *w);
            let force = field.body_force(point.x) * point.volume;
            for (&node, n) in mesh.cell(cell).iter().zip(&point.weights) {
                *forces.entry(node).or_default() += force * *n;
            }
        }
    }
    let prescribe = |&node: &NodeId| {
        let u = field.displacement(mesh.points[node as usize]);
        let motions = (0..field.space.ndim()).map(|axis| (axis, Motion::Ramp(u[axis])));
        Change::Prescribe(Target::Nodes(vec![node]), motions.collect())
    };
    let parts = Parts {
        bodies: vec![BodyPart {
            name: "block".into(),
            cells: cells.to_vec(),
            kind: BodyKind::Solid {
                material: Box::new(SaintVenantKirchhoff::new(field.e, field.nu)),
                later: Vec::new(),
                density: None,
                mass: Default::default(),
                integration: choice.integration,
                locking: choice.locking,
                space: None,
                profile: None,
                linear_temperatures: false,
                at_nodes: Default::default(),
                initial: Vec::new(),
                axes: None,
                heat: None,
            },
        }],
        steps: vec![StepPart {
            name: "step".into(),
            duration: 1.0,
            increments: Increments::Fixed(1),
            nonlinear: false,
            scheme: None,
            control: None,
            vibration: None,
            physics: signorini_mechanics::system::Physics::default(),
            changes: boundary.iter().map(prescribe).collect(),
            loads: vec![LoadPart {
                name: "body force".into(),
                load: Acting::forces(forces.into_iter().collect()),
                course: Course::Ramp,
            }],
            contacts: Vec::new(),
            temperatures: Vec::new(),
            freed_temperatures: Vec::new(),
            activity: Vec::new(),
        }],
        ..Parts::new(mesh, field.space)
    };
    let mut model = Model::assemble(parts).unwrap();
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut quiet = |_: &Event<'_>| Flow::Continue;
    let outcome = stepper.run(&mut model.system, &model.steps, &mut quiet);
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    stepper.state().u.clone()
}

/// Errors in L2 and in the seminorm of H1 with `n` cells along an edge.
fn errors(name: &str, n: usize, field: &Field, choice: Choice) -> [f64; 2] {
    let away = field.space == Idealisation::Axisymmetric;
    let dim = field.space.ndim();
    let offset = Vec3::unit(0) * if away { 0.5 } else { 0.0 };
    let grid = Grid::new(name, n, n, |x| distorted(x, dim) + offset);
    let on_boundary = |x: Vec3| (0..dim).any(|axis| x[axis] < 1e-9 || x[axis] > 1.0 - 1e-9);
    let boundary = grid.nodes(on_boundary);
    let Grid { mesh, cells, .. } = grid;
    let rule = shape(name).rule();
    let u = solution(&mesh, &cells, &boundary, &rule, field, choice);
    let mut sums = [0.0; 2];
    for &cell in &cells {
        for (xi, w) in &rule {
            let point = sample(&mesh, field.space, cell, xi, *w);
            let mut difference = field.displacement(point.x);
            let mut slope = field.gradient(point.x);
            let shapes = point.weights.iter().zip(&point.gradients);
            for (&node, (n, g)) in mesh.cell(cell).iter().zip(shapes) {
                for axis in 0..dim {
                    let u = u[node as usize * dim + axis];
                    difference[axis] -= n * u;
                    slope.rows[axis] -= *g * u;
                }
            }
            sums[0] += point.volume * difference.dot(difference);
            sums[1] += point.volume * slope.rows.iter().map(|r| r.dot(*r)).sum::<f64>();
        }
    }
    sums.map(f64::sqrt)
}

/// Asserts the order between meshes of `n` and `2n` cells.
fn optimal(name: &str, n: usize, field: &Field, choice: Choice) {
    let (coarse, fine) = (
        errors(name, n, field, choice),
        errors(name, 2 * n, field, choice),
    );
    let [l2, h1] = [0, 1].map(|k| f64::log2(coarse[k] / fine[k]));
    println!(
        "{name:7} {:?} {:?} {:?} nu {}: L2 {:.2e} order {l2:.2}, H1 {:.2e} order {h1:.2}",
        field.space, choice.integration, choice.locking, field.nu, fine[0], fine[1]
    );
    let p = degree(name);
    assert!(l2 > p + 1.0 - SHORT, "{name}: {l2} in L2");
    assert!(h1 > p - SHORT, "{name}: {h1} in H1");
}

const SHORT: f64 = 0.15;
const PLANE: [&str; 5] = ["tri3", "quad4", "tri6", "quad8", "quad9"];
const SPACE: [&str; 7] = [
    "tet4", "wedge6", "hex8", "tet10", "wedge15", "hex20", "hex27",
];
const PLAIN: Choice = Choice {
    integration: Integration::Full,
    locking: Locking::None,
};
const CURED: Choice = Choice {
    integration: Integration::Full,
    locking: Locking::Auto,
};
const REDUCED: Choice = Choice {
    integration: Integration::Reduced,
    locking: Locking::None,
};

/// Cells along an edge of the coarser mesh in space.
fn coarse(name: &str) -> usize {
    if degree(name) < 2.0 { 4 } else { 2 }
}

#[test]
fn plane_elements_converge_at_their_order() {
    let spaces = [
        Idealisation::PlaneStrain { thickness: 0.7 },
        Idealisation::PlaneStress { thickness: 0.7 },
        Idealisation::Axisymmetric,
    ];
    for space in spaces {
        let field = Field::new(space, 0.3);
        for name in PLANE {
            optimal(name, 6, &field, PLAIN);
        }
        optimal("quad8", 6, &field, REDUCED);
    }
}

#[test]
fn elements_in_space_converge_at_their_order() {
    let field = Field::new(Idealisation::Space, 0.3);
    for name in SPACE {
        optimal(name, coarse(name), &field, PLAIN);
    }
    optimal("hex20", 2, &field, REDUCED);
}

#[test]
fn remedies_keep_the_order_of_nearly_incompressible_elements() {
    let field = Field::new(Idealisation::PlaneStrain { thickness: 1.0 }, 0.4999);
    for name in ["quad4", "tri6", "quad8", "quad9"] {
        optimal(name, 6, &field, CURED);
    }
    let field = Field::new(Idealisation::Space, 0.4999);
    for name in ["hex8", "tet10", "wedge15", "hex20", "hex27"] {
        optimal(name, coarse(name), &field, CURED);
    }
}
