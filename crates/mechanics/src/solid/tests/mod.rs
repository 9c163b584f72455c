//! Elements against differences, patches, rigid motions; several at once; remedies, history, reports.

use super::*;
use crate::material::{
    ByTemperature, Constants, Expanding, Hardening, HardeningKind, Kinematics, Material,
    MaterialError, Order as MaterialOrder, Plasticity, Response, Strain, TABLE,
};
use crate::system::{
    Archive, Assembler, Assembly, Director, Directors, Dof, Elimination, Frame, Idealisation,
    InitialStiffness, Layout, Lifetime, NodalField, Order, Phase, Sampled, Samples, Sink, State,
    StepContext, Stored, Symmetry, Term, TermError, Work,
};
use signorini_geometry::element::{self, Element};
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::sync::Arc;

mod axes;
mod batch;
mod conserving;
mod derivatives;
mod heat;
mod history;
mod locking;
mod patch;
mod predicted;
mod samples;
mod shell;
mod speed;
mod start;
mod truss;
mod viscous;

const LOCKINGS: [Locking; 6] = [
    Locking::Auto,
    Locking::None,
    Locking::BBar,
    Locking::FBar,
    Locking::Incompatible,
    Locking::Shear,
];

/// Every element in every idealisation that has it.
fn elements() -> impl Iterator<Item = (Element, Idealisation)> {
    let plane = [
        Idealisation::PlaneStrain { thickness: 0.7 },
        Idealisation::PlaneStress { thickness: 0.7 },
        Idealisation::Axisymmetric,
    ];
    let flat = of_dimension(2).flat_map(move |e| plane.map(|s| (e, s)));
    let solid = of_dimension(3).map(|e| (e, Idealisation::Space));
    flat.chain(solid)
}

fn of_dimension(dim: usize) -> impl Iterator<Item = Element> {
    element::TABLE.into_iter().filter(move |e| e.dim() == dim)
}

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

fn elastic(name: &str, nu: f64) -> Box<dyn Material> {
    let law = TABLE.iter().find(|l| l.name == name).unwrap();
    (law.make)(&Constants::elastic(500.0, nu)).unwrap()
}

/// A mesh of one distorted element. Bodies of revolution lie at radii around 2.
fn one(element: Element, space: Idealisation) -> Mesh {
    let mut mesh = Mesh::default();
    let radius = match space {
        Idealisation::Axisymmetric => 2.0,
        _ => 0.0,
    };
    let size = if element.nnode() > 8 { 0.05 } else { 0.1 };
    for (i, xi) in element.nodes().iter().enumerate() {
        let mut x = *xi + Vec3::new(radius, 0.0, 0.0);
        for axis in 0..element.dim() {
            x[axis] += size * noise(3 * i + axis);
        }
        mesh.points.push(x);
        mesh.node_labels.push(i as u64 + 1);
    }
    let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
    mesh.push_cell(element, &nodes, 7);
    mesh
}

/// A body of all cells of a mesh.
struct Body {
    solid: Solid,
    layout: Layout,
    reference: Arc<[Vec3]>,
}

struct Wish {
    space: Idealisation,
    kinematics: Kinematics,
    locking: Locking,
    integration: Integration,
}

impl Wish {
    fn plain(space: Idealisation, kinematics: Kinematics) -> Self {
        Self {
            space,
            kinematics,
            locking: Locking::None,
            integration: Integration::Full,
        }
    }
}

fn body(mesh: &Mesh, material: Box<dyn Material>, wish: &Wish) -> Result<Body, SolidError> {
    let layout = Layout::new(wish.space.ndim(), mesh.nnode(), 0);
    body_in(layout, mesh, material, wish, None, &Directors::default())
}

/// A body in a layout that may have temperatures, with those that are given.
fn body_in(
    layout: Layout,
    mesh: &Mesh,
    material: Box<dyn Material>,
    wish: &Wish,
    temperature: Option<Arc<NodalField>>,
    directors: &Directors,
) -> Result<Body, SolidError> {
    let cells: Vec<_> = mesh.cells(wish.space.ndim()).collect();
    let reference: Arc<[Vec3]> = mesh.points.clone().into();
    let mut solid = Solid::new(SolidParts {
        name: "body",
        mesh,
        reference: reference.clone(),
        cells: &cells,
        layout,
        space: wish.space,
        profile: None,
        material,
        integration: wish.integration,
        locking: wish.locking,
        temperature,
        linear_temperatures: false,
        at_nodes: Default::default(),
        initial: &[],
        axes: None,
        directors,
    })?;
    solid.locking(wish.kinematics)?;
    solid.set_kinematics(wish.kinematics);
    Ok(Body {
        solid,
        layout,
        reference,
    })
}

impl Body {
    fn state(&self, u: &[f64]) -> State {
        state(&self.layout, &self.reference, u)
    }

    /// Displacements of all nodes as a function of their place.
    fn field(&self, of: impl Fn(Vec3) -> Vec3) -> Vec<f64> {
        let ndim = self.layout.ndim();
        let moved = self.reference.iter().map(|x| of(*x).to_array());
        moved.flat_map(|u| u.into_iter().take(ndim)).collect()
    }

    fn energy(&self, u: &[f64], work: &mut Work) -> f64 {
        let state = self.state(u);
        let chunks = 0..self.solid.nchunk();
        let energies = chunks.map(|c| self.solid.energy(c, &state, work).unwrap().unwrap());
        energies.sum()
    }

    /// Force and stiffness of everything, dense.
    fn assemble(&self, u: &[f64], order: Order, work: &mut Work) -> Dense {
        let n = self.layout.ndof();
        let mut dense = Dense {
            force: vec![0.0; n],
            stiffness: vec![0.0; if order == Order::Tangent { n * n } else { 0 }],
        };
        let state = self.state(u);
        for chunk in 0..self.solid.nchunk() {
            let outcome = self.solid.evaluate(chunk, &state, order, work, &mut dense);
            outcome.unwrap();
        }
        dense
    }

    fn report(&self, u: &[f64]) -> Frame {
        let mut frame = Frame::new(self.layout.nnode(), &[1]);
        self.solid.report(&self.state(u), &mut frame).unwrap();
        frame
    }
}

/// A sink without sparsity.
struct Dense {
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Sink for Dense {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = self.force.len();
        for (&dof, f) in dofs.iter().zip(force) {
            self.force[dof as usize] += f;
        }
        for (&row, values) in dofs.iter().zip(stiffness.chunks_exact(dofs.len())) {
            for (&column, k) in dofs.iter().zip(values) {
                self.stiffness[row as usize * n + column as usize] += k;
            }
        }
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        crate::system::couple_as_square(self, rows, columns, stiffness);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

impl Dense {
    fn scale(&self) -> f64 {
        self.stiffness.iter().fold(0.0, |m, k| m.max(k.abs()))
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
fn a_rigid_rotation_stores_no_energy_at_finite_strain() {
    for (element, space) in elements() {
        if space == Idealisation::Axisymmetric {
            continue;
        }
        let mesh = one(element, space);
        for locking in [Locking::None, Locking::FBar] {
            let wish = Wish {
                locking,
                ..Wish::plain(space, Kinematics::Finite)
            };
            let Ok(body) = body(&mesh, elastic("neo-hookean", 0.3), &wish) else {
                continue;
            };
            let turn = match space {
                Idealisation::Space => Mat3::rotation(Vec3::new(0.4, -0.5, 1.1)),
                _ => Mat3::rotation(Vec3::new(0.0, 0.0, 1.1)),
            };
            let u = body.field(|x| turn * x - x + Vec3::new(0.3, -0.2, 0.1));
            let mut work = Work::default();
            let at = body.assemble(&u, Order::Residual, &mut work);
            let name = element.name();
            assert!(at.force.iter().all(|f| f.abs() < 1e-11), "{name}");
            assert!(body.energy(&u, &mut work) < 1e-20, "{name}");
            assert!(at.stiffness.is_empty());
        }
    }
}

#[test]
fn a_stiffness_that_lasts_has_the_same_bits_at_all_states() {
    let laws: Vec<_> = TABLE.iter().map(|l| l.name).collect();
    let mut count = 0;
    for (element, space) in elements() {
        let mesh = one(element, space);
        for (law, locking) in laws.iter().flat_map(|law| LOCKINGS.map(|l| (law, l))) {
            let wish = Wish {
                locking,
                ..Wish::plain(space, Kinematics::Small)
            };
            let make = TABLE.iter().find(|l| l.name == *law).unwrap().make;
            let Ok(material) = make(&Constants::elastic(500.0, 0.3)) else {
                continue;
            };
            let Ok(body) = body(&mesh, material, &wish) else {
                continue;
            };
            if body.solid.properties().lifetime < Lifetime::Step {
                continue;
            }
            let mut work = Work::default();
            let mut stiffness = |size: f64| {
                let u: Vec<f64> = (0..body.layout.ndof()).map(|k| size * noise(k)).collect();
                body.assemble(&u, Order::Tangent, &mut work).stiffness
            };
            assert_eq!(stiffness(0.0), stiffness(0.03), "{} {law}", element.name());
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

#[test]
fn auto_chooses_by_element_strain_space_and_material() {
    let plane = Idealisation::PlaneStrain { thickness: 1.0 };
    let sheet = Idealisation::PlaneStress { thickness: 1.0 };
    let space = Idealisation::Space;
    let (none, modes) = (Locking::None, Locking::Incompatible);
    let (small, finite) = (Locking::BBar, Locking::FBar);
    // ordinary small and finite, then of a material that keeps its volume
    for (name, idealisation, integration, chosen) in [
        ("tri3", plane, Integration::Full, [none; 4]),
        (
            "quad4",
            plane,
            Integration::Full,
            [modes, none, small, finite],
        ),
        (
            "quad4",
            sheet,
            Integration::Full,
            [modes, none, modes, none],
        ),
        (
            "hex8",
            space,
            Integration::Full,
            [modes, none, small, finite],
        ),
        ("tet4", space, Integration::Full, [none; 4]),
        (
            "tet10",
            space,
            Integration::Full,
            [none, none, small, finite],
        ),
        ("quad8", sheet, Integration::Full, [none; 4]),
        (
            "hex20",
            space,
            Integration::Full,
            [none, none, small, finite],
        ),
        ("hex20", space, Integration::Reduced, [none; 4]),
    ] {
        let mesh = one(element::by_name(name).unwrap(), idealisation);
        let laws = [elastic("neo-hookean", 0.3), derivatives::plastic()];
        let keeping = elastic("neo-hookean", 0.49);
        for (law, pair) in laws.into_iter().chain([keeping]).zip([0, 2, 2]) {
            let wish = Wish {
                locking: Locking::Auto,
                integration,
                ..Wish::plain(idealisation, Kinematics::Small)
            };
            let solid = body(&mesh, law, &wish).unwrap().solid;
            let sizes = [Kinematics::Small, Kinematics::Finite];
            let found = sizes.map(|k| solid.locking(k).unwrap()[0].1);
            assert_eq!(found, chosen[pair..pair + 2], "{name} {idealisation:?}");
        }
    }
}

#[test]
fn an_element_turned_inside_out_is_named() {
    let mesh = one(element::by_name("hex8").unwrap(), Idealisation::Space);
    let wish = Wish::plain(Idealisation::Space, Kinematics::Finite);
    let body = body(&mesh, elastic("neo-hookean", 0.3), &wish).unwrap();
    let mut u = vec![0.0; body.layout.ndof()];
    for i in 4..8 {
        u[3 * i + 2] = -2.5;
    }
    let outcome = body.solid.energy(0, &body.state(&u), &mut Work::default());
    assert!(matches!(
        outcome,
        Err(TermError::Inverted { element: 7, .. })
    ));
}

#[test]
fn a_radius_below_zero_is_refused_and_one_of_zero_is_not() {
    let quad = element::by_name("quad4").unwrap();
    for (left, allowed) in [(0.0, true), (-0.01, false)] {
        let mut mesh = Mesh::default();
        for (k, x) in quad.nodes().iter().enumerate() {
            let r = if x.x < 0.0 { left } else { 1.0 };
            mesh.points.push(Vec3::new(r, x.y, 0.0));
            mesh.node_labels.push(k as u64);
        }
        mesh.push_cell(quad, &[0, 1, 2, 3], 3);
        let wish = Wish::plain(Idealisation::Axisymmetric, Kinematics::Small);
        match body(&mesh, elastic("linear-elastic", 0.3), &wish) {
            Ok(_) => assert!(allowed),
            Err(SolidError::Radius {
                label: 3, radius, ..
            }) => {
                assert!(!allowed && radius < 0.0);
            }
            Err(other) => panic!("{other}"),
        }
    }
}
