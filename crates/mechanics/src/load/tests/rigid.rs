//! Loads on the faces of a rigid box.

use super::*;
use crate::system::{Assembler, Assembly, RigidBody};
use signorini_linear::apply;
use std::f64::consts::TAU;

/// A rigid box of distorted quadratic faces, which turns about a point of its own.
struct RigidBox {
    single: Single,
    layout: Layout,
    elimination: Elimination,
}

impl RigidBox {
    fn new(name: &str, space: Idealisation, reference: Vec3) -> Self {
        let single = Single::new(element::by_name(name).unwrap(), space, 0.1);
        let body = RigidBody {
            reference,
            nodes: (0..single.layout.nnode() as NodeId).collect(),
        };
        Self {
            layout: Layout::new(single.layout.ndim(), single.layout.nnode(), 1),
            elimination: Elimination::new(vec![body], single.layout.nnode()),
            single,
        }
    }

    fn start(&self) -> State {
        let mut state = State::initial(&self.layout, &self.single.reference, &self.elimination);
        state.time = 1.0;
        state
    }

    fn moved(&self, from: &State, du: &[f64]) -> State {
        let mut state = from.clone();
        let reference = &self.single.reference;
        state.advance_from(from, du, 1.0, &self.layout, reference, &self.elimination);
        state
    }

    /// The unknowns of the body: translations, then rotations.
    fn dofs(&self) -> Vec<Dof> {
        let first = (self.layout.nnode() * self.layout.ndim()) as Dof;
        (first..self.layout.ndof() as Dof).collect()
    }

    /// A motion of the body.
    fn du(&self, motion: &[f64]) -> Vec<f64> {
        let mut du = vec![0.0; self.layout.ndof()];
        for (dof, d) in self.dofs().into_iter().zip(motion) {
            du[dof as usize] = *d;
        }
        du
    }

    /// What acts on the body, and its stiffness.
    fn evaluate(&self, terms: &[Box<dyn Term>], state: &State) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut assembler = Assembler::new(&self.layout, &self.elimination, terms);
        let mut out = Assembly::default();
        let (layout, elimination) = (&self.layout, &self.elimination);
        assembler
            .assemble(layout, elimination, terms, state, Order::Tangent, &mut out)
            .unwrap();
        let dofs = self.dofs();
        let column = |&dof: &Dof| {
            let (mut x, mut y) = (vec![0.0; layout.ndof()], vec![0.0; layout.ndof()]);
            x[dof as usize] = 1.0;
            let (bulk, interface) = (assembler.bulk(), assembler.interface());
            apply(bulk, interface, &out.values(), &x, &mut y);
            dofs.iter().map(|&d| y[d as usize]).collect()
        };
        let columns = dofs.iter().map(column).collect();
        let forces = dofs.iter().map(|&d| -out.residual[d as usize]);
        (forces.collect(), columns)
    }
}

/// Work of a term on the way through three turns about an axis, with the largest force on the way.
fn three_turns(model: &RigidBox, terms: &[Box<dyn Term>], axis: Vec3) -> (f64, f64, State) {
    const N: usize = 180;
    let mut state = model.start();
    let (mut work, mut largest) = (0.0, 0.0f64);
    let angle = 3.0 * TAU / N as f64;
    let turn = match model.layout.ndim() {
        2 => vec![0.0, 0.0, angle],
        _ => vec![
            0.0,
            0.0,
            0.0,
            angle * axis.x,
            angle * axis.y,
            angle * axis.z,
        ],
    };
    for _ in 0..N {
        // the moment is constant where the load follows: any rule integrates it exactly
        let (force, _) = model.evaluate(terms, &state);
        work += force.iter().zip(&turn).map(|(f, d)| f * d).sum::<f64>();
        largest = force.iter().fold(largest, |m, f| m.max(f.abs()));
        state = model.moved(&state, &model.du(&turn));
    }
    (work, largest, state)
}

#[test]
fn a_box_under_pressure_on_all_sides_turns_freely_and_comes_back() {
    let axis = Vec3::new(0.48, -0.6, 0.64);
    for (name, space) in [
        ("hex20", Idealisation::Space),
        ("tet10", Idealisation::Space),
        ("quad8", Idealisation::PlaneStrain { thickness: 2.0 }),
    ] {
        let model = RigidBox::new(name, space, Vec3::new(0.7, 0.2, 0.0));
        let pressure = model.single.pressure(model.single.surface(), 5.0);
        let (work, largest, end) = three_turns(&model, &[Box::new(pressure)], axis);
        assert!(
            work.abs() < 1e-10 && largest < 1e-12 * 300.0,
            "{name} {work:e} {largest:e}"
        );
        for (a, b) in end.x.iter().zip(model.single.reference.iter()) {
            assert_near(*a, *b, 1e-10, name);
        }
    }
}

#[test]
fn pressure_on_one_face_does_the_work_of_its_lever_and_none_where_it_has_none() {
    let point = Vec3::new(0.7, 0.2, 0.3);
    let model = RigidBox::new("hex8", Idealisation::Space, point);
    for side in 0..6 {
        let face = model.single.face(side);
        let x = &model.single.reference;
        let forces = spread::over_faces(&face, x, |n| n * -5.0);
        let lever = |(n, f): (&NodeId, &Vec3)| (x[*n as usize] - point).cross(*f);
        let moment: Vec3 = forces.iter().map(lever).sum();
        let terms: [Box<dyn Term>; 1] = [Box::new(model.single.pressure(face, 5.0))];
        // the moment turns with the body, so that the way along a fixed axis gives moment times angle
        let axis = Vec3::new(0.48, -0.6, 0.64);
        let (work, _, _) = three_turns(&model, &terms, axis);
        let exact = moment.dot(axis) * 3.0 * TAU;
        assert!(
            (work - exact).abs() < 1e-10 * exact.abs(),
            "{side} {work} {exact}"
        );
        let idle = moment.cross(axis).normalized().unwrap();
        let (work, largest, _) = three_turns(&model, &terms, idle);
        assert!(
            largest > 1.0 && work.abs() < 1e-10 * largest,
            "{side} {work:e}"
        );
    }
}

#[test]
fn the_stiffness_of_loads_on_a_rigid_box_is_the_derivative_of_their_forces() {
    for (name, space) in [
        ("hex8", Idealisation::Space),
        ("wedge15", Idealisation::Space),
        ("quad8", Idealisation::PlaneStrain { thickness: 2.0 }),
    ] {
        let model = RigidBox::new(name, space, Vec3::new(0.7, 0.2, 0.0));
        let single = &model.single;
        let x = &single.reference;
        let traction =
            spread::over_faces(&single.face(1), x, |n| Vec3::new(1.0, 2.0, -0.5) * n.norm());
        let dead = single
            .dead(traction)
            .following(&model.elimination, &model.layout);
        let spin = Spin {
            speed: 1.3,
            point: Vec3::ZERO,
            axis: Vec3::unit(2),
        };
        let loads: [(&str, Box<dyn Term>); 3] = [
            ("pressure", Box::new(single.pressure(single.face(1), 2.0))),
            ("dead", Box::new(dead)),
            ("centrifugal", Box::new(single.centrifugal(2.0, spin))),
        ];
        for (what, term) in loads {
            let terms = [term];
            let start = model.start();
            let n = model.dofs().len();
            let motion: Vec<f64> = (0..n).map(|k| 0.4 * noise(50 + k)).collect();
            let at = model.moved(&start, &model.du(&motion));
            let (force, columns) = model.evaluate(&terms, &at);
            let scale = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            let h = 1e-3;
            for (j, column) in columns.iter().enumerate() {
                let shifted = |d: f64| {
                    let mut motion = vec![0.0; n];
                    motion[j] = d;
                    model
                        .evaluate(&terms, &model.moved(&at, &model.du(&motion)))
                        .0
                };
                let [p1, m1, p2, m2] = [h, -h, 2.0 * h, -2.0 * h].map(shifted);
                for i in 0..n {
                    let slope = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * h);
                    let error = (slope + column[i]).abs();
                    assert!(error < 1e-9 * scale, "{name} {what} {i} {j} {error:e}");
                }
            }
        }
    }
}
