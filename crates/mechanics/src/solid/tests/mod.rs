//! Elements against differences, patches, rigid motions.

use super::*;
use crate::material::{Constants, Kinematics, TABLE};
use crate::system::{
    Assembler, Assembly, Dof, Elimination, Idealisation, Layout, Order, Sink, State, Term, Work,
};
use signorini_geometry::element;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

mod speed;

const ELEMENTS: [&str; 5] = ["tri3", "quad4", "tet4", "hex8", "wedge6"];

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// One distorted element.
fn single(name: &str, law: usize, nonlinear: bool) -> (Solid, Layout, Arc<[Vec3]>) {
    let element = element::by_name(name).unwrap();
    let mut mesh = Mesh::default();
    for (i, xi) in element.nodes().iter().enumerate() {
        let mut x = *xi;
        for axis in 0..element.dim() {
            x[axis] += 0.1 * noise(3 * i + axis);
        }
        mesh.points.push(x);
        mesh.node_labels.push(i as u64 + 1);
    }
    let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
    let cell = mesh.push_cell(element, &nodes, 7);
    let layout = Layout {
        ndim: element.dim(),
        nnode: mesh.nnode(),
        nrigid: 0,
        nmultiplier: 0,
    };
    let reference: Arc<[Vec3]> = mesh.points.clone().into();
    let material = (TABLE[law].make)(&Constants::sample()).unwrap();
    let mut solid = Solid::new(SolidParts {
        name: "body",
        mesh: &mesh,
        reference: reference.clone(),
        cells: &[cell],
        layout,
        space: match element.dim() {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        },
        material,
        integration: Integration::Full,
        locking: Locking::None,
        temperature: None,
    })
    .unwrap();
    solid.set_kinematics(if nonlinear {
        Kinematics::Finite
    } else {
        Kinematics::Small
    });
    (solid, layout, reference)
}

#[derive(Default)]
struct Local {
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Sink for Local {
    fn add(&mut self, _: &[Dof], force: &[f64], stiffness: &[f64]) {
        self.force = force.to_vec();
        self.stiffness = stiffness.to_vec();
    }
}

fn state(layout: &Layout, reference: &[Vec3], u: &[f64]) -> State {
    let elimination = Elimination::default();
    let zero = State::initial(layout, reference, &elimination);
    let mut moved = zero.clone();
    moved.advance_from(&zero, u, 1.0, layout, reference, &elimination);
    moved
}

#[test]
fn forces_are_the_gradient_of_energy_and_stiffness_that_of_forces() {
    for name in ELEMENTS {
        for law in 0..TABLE.len() {
            for nonlinear in [false, true] {
                let (solid, layout, reference) = single(name, law, nonlinear);
                let u: Vec<f64> = (0..layout.ndof()).map(|k| 0.06 * noise(100 + k)).collect();
                let mut work = Work::default();
                let mut at = |u: &[f64]| {
                    let state = state(&layout, &reference, u);
                    let mut local = Local::default();
                    solid
                        .evaluate(0, &state, Order::Tangent, &mut work, &mut local)
                        .unwrap();
                    let energy = solid.energy(0, &state, &mut work).unwrap().unwrap();
                    (local, energy)
                };
                let (local, _) = at(&u);
                let n = layout.ndof();
                let scale = local.stiffness.iter().fold(0.0f64, |m, k| m.max(k.abs()));
                let h = 1e-5;
                for j in 0..n {
                    let mut shifted = u.clone();
                    // fourth-order differences
                    let mut value = |d: f64| {
                        shifted[j] = u[j] + d;
                        at(&shifted)
                    };
                    let (p1, m1, p2, m2) = (value(h), value(-h), value(2.0 * h), value(-2.0 * h));
                    let slope =
                        |a: f64, b: f64, c: f64, d: f64| (8.0 * (a - b) - (c - d)) / (12.0 * h);
                    let force = slope(p1.1, m1.1, p2.1, m2.1);
                    assert!(
                        (force - local.force[j]).abs() < 1e-7 * scale,
                        "{name} {law}"
                    );
                    for i in 0..n {
                        let k = slope(p1.0.force[i], m1.0.force[i], p2.0.force[i], m2.0.force[i]);
                        let error = (k - local.stiffness[i * n + j]).abs();
                        assert!(
                            error < 1e-9 * scale,
                            "{name} {law} {nonlinear} {i} {j} {error:e}"
                        );
                        let transposed = local.stiffness[j * n + i];
                        assert!((local.stiffness[i * n + j] - transposed).abs() < 1e-12 * scale);
                    }
                }
            }
        }
    }
}

#[test]
fn a_rigid_rotation_stores_no_energy_at_finite_strain() {
    for name in ELEMENTS {
        let (solid, layout, reference) = single(name, 2, true);
        let turn = Mat3::rotation(Vec3::new(0.0, 0.0, 1.1));
        let mut u = vec![0.0; layout.ndof()];
        for (i, x) in reference.iter().enumerate() {
            let moved = turn * *x - *x + Vec3::new(0.3, -0.2, 0.0);
            for axis in 0..layout.ndim {
                u[i * layout.ndim + axis] = moved[axis];
            }
        }
        let mut local = Local::default();
        let state = state(&layout, &reference, &u);
        let mut work = Work::default();
        solid
            .evaluate(0, &state, Order::Residual, &mut work, &mut local)
            .unwrap();
        assert!(local.force.iter().all(|f| f.abs() < 1e-11), "{name}");
        assert!(local.stiffness.is_empty());
    }
}

#[test]
fn a_homogeneous_strain_gives_its_stress_everywhere_and_no_force_inside() {
    // five distorted quadrilaterals round an inner one: the classical patch
    let mut mesh = Mesh::default();
    for (x, y) in [
        (0.0, 0.0),
        (2.0, 0.0),
        (2.0, 3.0),
        (0.0, 3.0),
        (0.4, 0.4),
        (1.4, 0.6),
        (1.5, 2.0),
        (0.3, 1.6),
    ] {
        mesh.points.push(Vec3::new(x, y, 0.0));
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let quad = element::by_name("quad4").unwrap();
    let cells: Vec<_> = [
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
        [4, 5, 6, 7],
    ]
    .iter()
    .enumerate()
    .map(|(k, nodes)| mesh.push_cell(quad, nodes, k as u64 + 1))
    .collect();
    let layout = Layout {
        ndim: 2,
        nnode: 8,
        nrigid: 0,
        nmultiplier: 0,
    };
    let reference: Arc<[Vec3]> = mesh.points.clone().into();
    for nonlinear in [false, true] {
        let material = (TABLE[2].make)(&Constants::elastic(1000.0, 0.25)).unwrap();
        let mut solid = Solid::new(SolidParts {
            name: "patch",
            mesh: &mesh,
            reference: reference.clone(),
            cells: &cells,
            layout,
            space: Idealisation::PlaneStrain { thickness: 2.0 },
            material,
            integration: Integration::Full,
            locking: Locking::None,
            temperature: None,
        })
        .unwrap();
        solid.set_kinematics(if nonlinear {
            Kinematics::Finite
        } else {
            Kinematics::Small
        });
        let gradient = [[0.02, 0.01], [-0.03, -0.05]];
        let u: Vec<f64> = reference
            .iter()
            .flat_map(|x| gradient.map(|g| g[0] * x.x + g[1] * x.y))
            .collect();
        let state = state(&layout, &reference, &u);
        let terms: Vec<Box<dyn Term>> = vec![Box::new(solid)];
        let elimination = Elimination::default();
        let mut assembler = Assembler::new(&layout, &elimination, &terms);
        let mut out = Assembly::default();
        assembler
            .assemble(
                &layout,
                &elimination,
                &terms,
                &state,
                Order::Tangent,
                &mut out,
            )
            .unwrap();
        let inner = &out.residual[8..];
        assert!(inner.iter().all(|r| r.abs() < 1e-12 * 1000.0), "{inner:?}");
        let mut frame = crate::system::Frame::new(8, &[5]);
        terms[0].report(&state, &mut frame).unwrap();
        let first = frame.cell_stress[0][0];
        for stress in frame.cell_stress[0].iter().chain(&frame.stress) {
            let difference = (*stress - first).to_pairs();
            assert!(difference.iter().all(|d| d.abs() < 1e-11), "{difference:?}");
        }
        assert!(
            first.zz().abs() > 1.0,
            "plane strain has a stress across the plane"
        );
    }
}

#[test]
fn an_element_turned_inside_out_is_named() {
    let (solid, layout, reference) = single("hex8", 1, true);
    let mut u = vec![0.0; layout.ndof()];
    for i in 4..8 {
        u[3 * i + 2] = -2.5;
    }
    let state = state(&layout, &reference, &u);
    let outcome = solid.energy(0, &state, &mut Work::default());
    assert!(matches!(
        outcome,
        Err(crate::system::TermError::Inverted { element: 7, .. })
    ));
}
