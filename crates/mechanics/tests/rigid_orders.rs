//! Convergence of contact with a rigid analytical surface, as `method = "auto"` takes it.
//!
//! SOURCE      Written for the purpose. Orders after Hild, Laborde, Appl. Numer. Math. 41 (2002)
//! GOAL        The error in the energy norm falls with h for linear elements and with h^3/2 for quadratic ones, of which the
//!             pressure goes to zero as the square root of the distance to a free end of contact
//! MESH        2 × 1 on the plane y = 0, 2n × n cells; in space a slice of them, n/4 cells thick
//! CONDITIONS  Plane strain, small strain, no friction. With z = x − x0 + iy and Westergaard's function Z = iC√z,
//!             Z = dẐ/dz (symmetric about y = 0, without shear there):
//!                 σ_xx = Re Z − y Im Z',  σ_yy = Re Z + y Im Z',  σ_xy = −y Re Z'
//!                 2μ u = (κ − 1)/2 Re Ẑ − y Im Z,  2μ v = (κ + 1)/2 Im Ẑ − y Re Z,  κ = 3 − 4ν
//!             On y = 0 that is v = 0 and σ_yy = −C√(x0 − x) for x < x0, and σ_yy = 0 and v ~ (x − x0)^3/2 > 0 beyond: it
//!             solves Signorini's problem. Its displacements are prescribed on the other three sides
//! EXPECTED    The exact solution
//! TOLERANCE   0.05 below the order 1, and 0.1 below the order 3/2, which depends on where in a facet the end lies
#![allow(clippy::unwrap_used)]

mod common;

use common::{Grid, Point, degree, sample, shape, solid};
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::surface::{Analytical, Mount, Plane};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use signorini_mechanics::load::{Course, Force, Load, Place};
use signorini_mechanics::material::SaintVenantKirchhoff;
use signorini_mechanics::model::{
    BodyKind, Change, ContactPart, Enforcement, FrictionPart, LoadPart, Model, Parts, PrimaryPart,
    SidePart, StepPart, Target,
};
use signorini_mechanics::solid::Locking;
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::{ContactFrame, Idealisation};
use std::sync::Arc;

const MODULUS: f64 = 1.0;
const POISSON: f64 = 0.3;
const SHEAR: f64 = MODULUS / (2.0 * (1.0 + POISSON));
/// C.
const LOAD: f64 = 1e-3;
/// x0, off the nodes of all meshes.
const END: f64 = 0.1371;
/// From x = −1 on.
const SIZE: Vec3 = Vec3::new(2.0, 1.0, 0.25);

/// A complex number.
#[derive(Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    /// The root with a positive imaginary part, in the upper half of the plane.
    fn root(self) -> Self {
        let size = self.re.hypot(self.im);
        Self {
            re: (0.5 * (size + self.re)).max(0.0).sqrt(),
            im: (0.5 * (size - self.re)).max(0.0).sqrt(),
        }
    }
}

/// iC.
const FACTOR: Complex = Complex { re: 0.0, im: LOAD };

/// z, its root, and Z.
fn functions(x: Vec3) -> [Complex; 3] {
    let z = Complex {
        re: x.x - END,
        im: x.y,
    };
    let root = z.root();
    [z, root, FACTOR.times(root)]
}

fn displacement(x: Vec3) -> Vec3 {
    let [z, root, of_z] = functions(x);
    let integral = FACTOR.times(root.times(z));
    let kappa = 3.0 - 4.0 * POISSON;
    let u = (kappa - 1.0) / 3.0 * integral.re - x.y * of_z.im;
    let v = (kappa + 1.0) / 3.0 * integral.im - x.y * of_z.re;
    Vec3::new(u, v, 0.0) / (2.0 * SHEAR)
}

fn stress(x: Vec3) -> [f64; 3] {
    let [_, root, of_z] = functions(x);
    let size = root.re.powi(2) + root.im.powi(2);
    let inverse = Complex {
        re: 0.5 * root.re / size,
        im: -0.5 * root.im / size,
    };
    let slope = FACTOR.times(inverse);
    [
        of_z.re - x.y * slope.im,
        of_z.re + x.y * slope.im,
        -x.y * slope.re,
    ]
}

fn strain(x: Vec3) -> Sym3 {
    let [xx, yy, xy] = stress(x);
    let of = |a: f64, b: f64| (1.0 + POISSON) * ((1.0 - POISSON) * a - POISSON * b) / MODULUS;
    Sym3::new(of(xx, yy), of(yy, xx), 0.0, 0.5 * xy / SHEAR, 0.0, 0.0)
}

/// Twice the energy per volume of Hooke's law.
fn energy(strain: Sym3) -> f64 {
    let lambda = 2.0 * SHEAR * POISSON / (1.0 - 2.0 * POISSON);
    2.0 * SHEAR * strain.double_dot(strain) + lambda * strain.trace().powi(2)
}

/// The block on its plane, as the contact chooses for itself.
struct Block {
    grid: Grid,
    space: Idealisation,
    u: Vec<f64>,
    contact: ContactFrame,
    enforcement: Enforcement,
}

impl Block {
    fn new(element: &str, n: usize) -> Self {
        let grid = Grid::of(element, [2 * n, n, (n / 4).max(1)], |at| {
            Vec3::new(SIZE.x * at.x - 1.0, SIZE.y * at.y, SIZE.z * at.z)
        });
        let mut changes = Vec::new();
        for node in grid.nodes(|at| at.x < 1e-9 || at.x > 1.0 - 1e-9 || at.y > 1.0 - 1e-9) {
            let x = grid.mesh.points[node as usize];
            let to = displacement(x);
            let mut motions = vec![(0, Motion::Ramp(to.x))];
            // at the ends of the contact the plane holds, or nothing does
            if x.y > 1e-9 {
                motions.push((1, Motion::Ramp(to.y)));
            }
            changes.push(Change::Prescribe(Target::Nodes(vec![node]), motions));
        }
        Self::solve(grid, changes, Vec::new(), None)
    }

    fn solve(
        grid: Grid,
        mut changes: Vec<Change>,
        loads: Vec<LoadPart>,
        friction: Option<f64>,
    ) -> Self {
        let space = match grid.mesh.dim() {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        };
        if space == Idealisation::Space {
            let sides = grid.nodes(|at| at.z < 1e-9 || at.z > 1.0 - 1e-9);
            let held = Change::Prescribe(Target::Nodes(sides), vec![(2, Motion::Hold)]);
            changes.push(held);
        }
        let plane = Plane::new(Vec3::ZERO, Vec3::unit(1)).unwrap();
        let plane = Analytical::new(Mount::fixed(space.ndim() - 1), Box::new(plane)).unwrap();
        let mut contact = ContactPart::new(
            "floor",
            SidePart::Faces(grid.faces(|at| at.y < 1e-9)),
            PrimaryPart::Surface(Arc::new(plane)),
        );
        contact.friction = friction.map(FrictionPart::coulomb);
        let material = SaintVenantKirchhoff::new(MODULUS, POISSON);
        let mut body = solid("block", &grid.cells, material);
        if let BodyKind::Solid { locking, .. } = &mut body.kind {
            *locking = Locking::None;
        }
        let parts = Parts {
            bodies: vec![body],
            contacts: vec![contact],
            steps: vec![StepPart {
                name: "press".into(),
                duration: 1.0,
                increments: Increments::Fixed(1),
                nonlinear: false,
                scheme: None,
                control: None,
                vibration: None,
                physics: signorini_mechanics::system::Physics::default(),
                changes,
                loads,
                contacts: Vec::new(),
                temperatures: Vec::new(),
                freed_temperatures: Vec::new(),
                activity: Vec::new(),
            }],
            ..Parts::new(&grid.mesh, space)
        };
        let mut model = Model::assemble(parts).unwrap();
        let enforcement = model.contacts[0].enforcement.clone();
        let mut stepper = Stepper::new(&model.system, StepperSettings::default());
        let mut found = None;
        let mut watch = |event: &Event<'_>| {
            if let Event::Increment { frame, .. } = event {
                found = Some(frame.contacts[0].clone());
            }
            Flow::Continue
        };
        let outcome = stepper.run(&mut model.system, &model.steps, &mut watch);
        assert_eq!(outcome.unwrap(), Outcome::Finished);
        let u = stepper.state().u.clone();
        Self {
            grid,
            space,
            u,
            contact: found.unwrap(),
            enforcement,
        }
    }

    fn strain(&self, cell: CellId, point: &Point) -> Sym3 {
        let ndim = self.space.ndim();
        let mut gradient = Mat3::ZERO;
        for (&node, slope) in self.grid.mesh.cell(cell).iter().zip(&point.gradients) {
            let u = &self.u[node as usize * ndim..][..ndim];
            for (row, u) in gradient.rows.iter_mut().zip(u) {
                *row += *slope * *u;
            }
        }
        Sym3::symmetric_part(gradient)
    }

    /// The error in the energy norm, relative to that of the exact solution.
    fn error(&self, element: &str) -> f64 {
        let rule = shape(element).rule();
        let (mut difference, mut whole) = (0.0, 0.0);
        for &cell in &self.grid.cells {
            for (xi, w) in &rule {
                let point = sample(&self.grid.mesh, self.space, cell, xi, *w);
                let expected = strain(point.x);
                whole += point.volume * energy(expected);
                difference += point.volume * energy(self.strain(cell, &point) - expected);
            }
        }
        (difference / whole).sqrt()
    }
}

/// The slope that fits best, each mesh twice as fine as the last.
fn order(errors: &[f64]) -> f64 {
    let middle = 0.5 * (errors.len() - 1) as f64;
    let each = errors.iter().enumerate();
    let (slopes, squares) = each.fold((0.0, 0.0), |(slopes, squares), (k, error)| {
        let at = k as f64 - middle;
        (slopes - at * error.log2(), squares + at * at)
    });
    slopes / squares
}

/// Prints a row of the page, and asserts the order.
fn optimal(element: &str, meshes: [usize; 3]) {
    let errors = meshes.map(|n| {
        let block = Block::new(element, n);
        assert!(matches!(block.enforcement, Enforcement::Lagrange));
        block.error(element)
    });
    let found = order(&errors);
    let said = errors.map(|e| format!("{e:.2e}")).join(" | ");
    println!("| {element} | {meshes:?} | {said} | {found:.2} |");
    let expected = if degree(element) < 2.0 { 0.95 } else { 1.4 };
    assert!(found > expected, "{element}: {found}");
}

#[test]
fn stresses_are_those_of_the_displacements() {
    let h = 1e-6;
    for x in [Vec3::new(0.5, 0.3, 0.0), Vec3::new(-0.4, 0.2, 0.0)] {
        let along = |axis: usize| {
            let step = Vec3::unit(axis) * h;
            (displacement(x + step) - displacement(x - step)) / (2.0 * h)
        };
        let (dx, dy) = (along(0), along(1));
        let found = Sym3::new(dx.x, dy.y, 0.0, 0.5 * (dx.y + dy.x), 0.0, 0.0);
        let off = found - strain(x);
        assert!(off.double_dot(off).sqrt() < 1e-9, "{x:?}");
    }
    let [touching, open] = [-0.7, 0.9].map(|x| Vec3::new(x, 0.0, 0.0));
    assert!(displacement(touching).y.abs() < 1e-15 && stress(touching)[1] < 0.0);
    assert!(displacement(open).y > 0.0 && stress(open)[1].abs() < 1e-15);
}

#[test]
fn plane_elements_on_a_rigid_plane_converge_at_their_order() {
    for element in ["quad4", "tri6", "quad8", "quad9"] {
        optimal(element, [4, 8, 16]);
    }
}

#[test]
fn elements_in_space_on_a_rigid_plane_converge_at_their_order() {
    optimal("hex8", [2, 4, 8]);
    for element in ["tet10", "hex20", "hex27"] {
        optimal(element, [2, 4, 8]);
    }
}

/// A column under an even load: every kind of face carries it without scatter, and nothing penetrates.
#[test]
fn an_even_pressure_is_carried_by_every_kind_of_face() {
    for element in ["quad8", "tri6", "tet10", "wedge15", "hex20", "hex27"] {
        let grid = Grid::new(element, 2, 2, |at| at);
        let load = LoadPart {
            name: "weight".into(),
            load: Force(Vec3::new(0.0, -1e-3, 0.0))
                .on(Place::Faces(grid.faces(|at| at.y > 1.0 - 1e-9))),
            course: Course::Ramp,
        };
        let side = grid.nodes(|at| at.x < 1e-9);
        let held = Change::Prescribe(Target::Nodes(side), vec![(0, Motion::Hold)]);
        let block = Block::solve(grid, vec![held], vec![load], None);
        assert!(
            matches!(block.enforcement, Enforcement::Lagrange),
            "{element}"
        );
        let contact = &block.contact;
        for (k, pressure) in contact.pressure.iter().enumerate() {
            assert!((pressure - 1e-3).abs() < 1e-10, "{element}: {pressure}");
            assert!(
                contact.gap[k].abs() < 1e-12,
                "{element}: {}",
                contact.gap[k]
            );
        }
        let area: f64 = contact.area.iter().sum();
        assert!((area - 1.0).abs() < 1e-12, "{element}: {area}");
    }
}

/// Half of a block with its plane of symmetry, where a fixed surface and held nodes leave multipliers of friction nothing
/// to act on, against the whole block.
#[test]
fn half_a_block_with_friction_is_half_of_the_whole() {
    let force = |whole: bool, element: &str| {
        let grid = Grid::of(element, [if whole { 8 } else { 4 }, 3, 1], |at| {
            let x = if whole { 2.0 * at.x - 1.0 } else { at.x };
            Vec3::new(x, at.y, at.z)
        });
        let place = |wanted: &dyn Fn(Vec3) -> bool| -> Vec<NodeId> {
            let points = grid.mesh.points.iter().zip(0..);
            points
                .filter(|(x, _)| wanted(**x))
                .map(|(_, n)| n)
                .collect()
        };
        let press = vec![(1, Motion::Ramp(-0.01))];
        let mut changes = vec![Change::Prescribe(
            Target::Nodes(place(&|x| x.y > 1.0 - 1e-9)),
            press,
        )];
        let middle = place(&|x| x.x.abs() < 1e-9);
        let hold = vec![(0, Motion::Hold)];
        changes.push(Change::Prescribe(Target::Nodes(middle), hold));
        let block = Block::solve(grid, changes, Vec::new(), Some(0.1));
        assert!(matches!(block.enforcement, Enforcement::Lagrange));
        block.contact.secondary.force.y
    };
    for element in ["quad4", "quad8", "hex20"] {
        let [whole, half] = [true, false].map(|whole| force(whole, element));
        let off = 2.0 * half / whole - 1.0;
        assert!(off.abs() < 1e-6, "{element}: {half} of {whole}");
    }
}

/// Multipliers at nodes that cannot follow would have no solution: such contacts keep a penalty.
#[test]
fn where_nodes_are_held_across_the_surface_a_penalty_stays() {
    let grid = Grid::new("quad8", 2, 1, |at| at);
    let corner = grid.nodes(|at| at.x < 1e-9 && at.y < 1e-9);
    let hold = vec![(0, Motion::Hold), (1, Motion::Hold)];
    let top = grid.nodes(|at| at.y > 1.0 - 1e-9);
    let changes = vec![
        Change::Prescribe(Target::Nodes(corner), hold),
        Change::Prescribe(Target::Nodes(top), vec![(1, Motion::Ramp(-0.01))]),
    ];
    let block = Block::solve(grid, changes, Vec::new(), None);
    assert!(matches!(block.enforcement, Enforcement::Penalty(Some(_))));
}
