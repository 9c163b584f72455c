use super::*;
use crate::connector::SpringLaw;
use crate::material;
use crate::model::{
    BodyKind, ConstraintKind, ConstraintPart, ContactPart, PrimaryPart, SidePart, SpringPart,
    Unknown,
};
use crate::system::RigidBody;
use signorini_geometry::element;
use signorini_geometry::mesh::{CellId, Face};

/// Unit cubes at these places, each a body of its own.
struct Cubes {
    mesh: Mesh,
    bodies: Vec<BodyPart>,
    elimination: Elimination,
    carriers: Vec<CarrierPart>,
}

fn solid() -> BodyKind {
    let law = material::by_name("linear-elastic").unwrap();
    BodyKind::solid((law.make)(&material::Constants::elastic(1.0, 0.3)).unwrap())
}

fn cubes(at: &[Vec3]) -> Cubes {
    let mut mesh = Mesh::default();
    let mut bodies = Vec::new();
    let hex8 = element::by_name("hex8").unwrap();
    for (number, &origin) in at.iter().enumerate() {
        let first = mesh.points.len() as u32;
        for (x, y, z) in [
            (0, 0, 0),
            (1, 0, 0),
            (1, 1, 0),
            (0, 1, 0),
            (0, 0, 1),
            (1, 0, 1),
            (1, 1, 1),
            (0, 1, 1),
        ] {
            let corner = Vec3::new(f64::from(x), f64::from(y), f64::from(z));
            mesh.points.push(origin + corner);
            mesh.node_labels.push(mesh.points.len() as u64);
        }
        let nodes: Vec<u32> = (first..first + 8).collect();
        let cell = mesh.push_cell(hex8, &nodes, number as u64 + 1);
        bodies.push(BodyPart {
            name: format!("cube{number}"),
            cells: vec![cell],
            kind: solid(),
        });
    }
    Cubes {
        mesh,
        bodies,
        elimination: Elimination::default(),
        carriers: Vec::new(),
    }
}

impl Cubes {
    /// Adds a carrier without nodes.
    fn with_carrier(mut self, at: Vec3) -> Self {
        self.carriers.push(CarrierPart {
            name: "pilot".into(),
            at: Some(at),
        });
        let body = RigidBody {
            reference: at,
            nodes: Vec::new(),
        };
        self.elimination = Elimination::new(vec![body], self.mesh.nnode());
        self
    }

    fn held(&self) -> Held<'_> {
        let (bodies, carriers) = (&self.bodies, &self.carriers);
        let space = Idealisation::Space;
        Held::new(
            &self.mesh,
            space,
            bodies,
            carriers,
            &self.elimination,
            &|_| true,
        )
    }
}

fn fix(held: &mut Held<'_>, nodes: &[NodeId], axes: &[usize]) {
    for &node in nodes {
        for &axis in axes {
            equation(held, vec![(Unknown::Node(node, axis), 1.0)]);
        }
    }
}

fn constrain(held: &mut Held<'_>, kind: ConstraintKind) {
    held.constraints(&[ConstraintPart {
        name: String::new(),
        kind,
    }]);
}

fn equation(held: &mut Held<'_>, terms: Vec<(Unknown, f64)>) {
    constrain(held, ConstraintKind::Equation { terms, rhs: 0.0 });
}

fn hold_carrier(held: &mut Held<'_>, components: std::ops::Range<usize>) {
    for component in components {
        equation(held, vec![(Unknown::Carrier(0, component), 1.0)]);
    }
}

fn motions(held: &Held<'_>) -> Vec<String> {
    held.unheld().into_iter().map(|u| u.motion).collect()
}

const ORIGIN: Vec3 = Vec3::ZERO;
const BOTTOM: [NodeId; 4] = [0, 1, 2, 3];

#[test]
fn motions_that_supports_leave_are_told_in_words() {
    let model = cubes(&[ORIGIN]);
    for (nodes, axes, wanted) in [
        (
            &[][..],
            &[][..],
            "slide in every direction and to turn about every axis",
        ),
        (
            &BOTTOM[..],
            &[2][..],
            "slide along x and y and to turn about z",
        ),
        (
            &BOTTOM[..],
            &[0][..],
            "slide along y and z and to turn about x and y",
        ),
        (&[6][..], &[0, 1, 2][..], "turn about (1, 1, 1)"),
        (
            &[1, 2][..],
            &[0, 1, 2][..],
            "turn about the axis along y through (1, 0.5, 0)",
        ),
        (
            &[0, 6][..],
            &[0, 1, 2][..],
            "turn about the axis along (0.577, 0.577, 0.577) through (0.5, 0.5, 0.5)",
        ),
        (
            // nodes in a plane may leave it
            &BOTTOM[..],
            &[0, 1][..],
            "slide along z and to turn about the axis along x through (0.5, 0.5, 0) \
             and to turn about the axis along y through (0.5, 0.5, 0)",
        ),
    ] {
        let mut held = model.held();
        fix(&mut held, nodes, axes);
        assert_eq!(motions(&held), [wanted]);
    }
    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    assert!(motions(&held).is_empty());
    assert!(held.judge().unwrap().is_empty());
}

#[test]
fn a_sleeve_on_a_pin_slides_and_turns() {
    // the nodes of a cylinder of four sides may not move radially
    let model = cubes(&[Vec3::new(-0.5, -0.5, 3.0)]);
    let mut held = model.held();
    for node in 0..8 {
        let x = model.mesh.points[node as usize];
        let radial = vec![(Unknown::Node(node, 0), x.x), (Unknown::Node(node, 1), x.y)];
        equation(&mut held, radial);
    }
    assert_eq!(
        motions(&held),
        ["slide along z and to turn about the axis along z through (0, 0, 3.5)"]
    );
}

#[test]
fn as_many_motions_are_free_as_the_rank_of_random_supports_leaves() {
    let model = cubes(&[Vec3::new(3.0, -1.0, 2.0)]);
    let mut seed = 5u64;
    let mut random = |n: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) % n
    };
    for _ in 0..300 {
        let mut held = model.held();
        let mut rows = Vec::new();
        for _ in 0..random(8) {
            let (node, axis) = (random(8) as u32, random(3) as usize);
            fix(&mut held, &[node], &[axis]);
            let x = model.mesh.points[node as usize];
            let turned = |about: usize| Vec3::unit(about).cross(x)[axis];
            let along = |a: usize| f64::from(u8::from(a == axis));
            rows.push([
                along(0),
                along(1),
                along(2),
                turned(0),
                turned(1),
                turned(2),
            ]);
        }
        let matrix = faer::Mat::from_fn(rows.len().max(1), 6, |i, j| {
            rows.get(i).map_or(0.0, |row: &[f64; 6]| row[j])
        });
        let values = matrix.singular_values().unwrap();
        let rank = values.iter().filter(|v| **v > 1e-9).count();
        assert_eq!(held.free()[0].len(), 6 - rank);
    }
}

#[test]
fn motions_do_not_depend_on_size_or_place() {
    for size in [1e-9, 1e-3, 1e6] {
        let mut model = cubes(&[Vec3::new(7.0, 8.0, 9.0)]);
        model.mesh.points.iter_mut().for_each(|x| *x *= size);
        let mut held = model.held();
        fix(&mut held, &[1, 2], &[0, 1, 2]);
        let motion = motions(&held).remove(0);
        assert!(
            motion.starts_with("turn about the axis along y through"),
            "{motion}"
        );
    }
}

#[test]
fn contact_is_told_from_supports() {
    let model = cubes(&[ORIGIN, Vec3::new(0.0, 0.0, 1.1)]);
    let contact = |held: &mut Held<'_>| {
        let cell = |index| CellId { block: 0, index };
        held.contact(
            &ContactPart::new(
                "c",
                SidePart::Nodes(vec![8, 9, 10, 11]),
                PrimaryPart::Faces(vec![Face {
                    cell: cell(0),
                    side: 1,
                }]),
            ),
            false,
            &[],
        );
    };
    let base = |held: &mut Held<'_>| fix(held, &BOTTOM, &[0, 1, 2]);
    let mut held = model.held();
    base(&mut held);
    contact(&mut held);
    fix(&mut held, &[8, 9, 10, 11], &[0, 1]);
    let found = held.judge().unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].to_string(), "body \"cube1\"");
    assert!(found[0].motion.starts_with("slide along z"));
    // no contact stops a motion along the surface
    let mut held = model.held();
    base(&mut held);
    contact(&mut held);
    fix(&mut held, &[8, 9, 10, 11], &[1]);
    let error = held.judge().unwrap_err().to_string();
    assert!(
        error.contains("\"cube1\" is free to slide along x:"),
        "{error}"
    );
}

/// Two squares of an element, one upon the other, held sideways by supports and upwards by contact alone.
fn squares(name: &str) -> Result<Vec<Unheld>, ModelError> {
    let square = element::by_name(name).unwrap();
    let mut mesh = Mesh::default();
    let mut bodies = Vec::new();
    for number in 0..2_u32 {
        let first = mesh.points.len() as u32;
        for xi in square.nodes() {
            let up = 2.0 * f64::from(number);
            mesh.points.push(*xi + Vec3::unit(1) * up);
            mesh.node_labels.push(mesh.points.len() as u64);
        }
        let nodes: Vec<u32> = (first..mesh.points.len() as u32).collect();
        let cell = mesh.push_cell(square, &nodes, u64::from(number) + 1);
        bodies.push(BodyPart {
            name: format!("square{number}"),
            cells: vec![cell],
            kind: solid(),
        });
    }
    let side = |index, side| Face {
        cell: CellId { block: 0, index },
        side,
    };
    let space = Idealisation::PlaneStrain { thickness: 1.0 };
    let elimination = Elimination::default();
    let mut held = Held::new(&mesh, space, &bodies, &[], &elimination, &|_| true);
    held.contact(
        &ContactPart::new(
            "c",
            SidePart::Faces(vec![side(1, 0)]),
            PrimaryPart::Faces(vec![side(0, 2)]),
        ),
        false,
        &[],
    );
    let upper = square.nnode() as u32;
    fix(&mut held, &[0, 1], &[0, 1]);
    fix(&mut held, &[upper, upper + 3], &[0]);
    held.judge()
}

#[test]
fn contact_of_linear_and_quadratic_lines_stops_the_same_motions() {
    for name in ["quad4", "quad8", "quad9"] {
        let found = squares(name).unwrap();
        assert_eq!(found.len(), 1, "{name}");
        assert!(found[0].motion.starts_with("slide along y"), "{name}");
    }
}

#[test]
fn a_loose_part_of_a_body_is_named_by_a_node() {
    let mut model = cubes(&[ORIGIN, Vec3::new(5.0, 0.0, 0.0)]);
    let second = model.bodies.remove(1);
    model.bodies[0].cells.extend(second.cells);
    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    let found = held.unheld();
    assert_eq!(
        found[0].to_string(),
        "body \"cube0\" (the part with node 9)"
    );
}

#[test]
fn couplings_hold_what_hangs_on_them() {
    let model = cubes(&[ORIGIN]).with_carrier(Vec3::new(0.5, 0.5, 4.0));
    let top = [4, 5, 6, 7];
    let mut held = model.held();
    let kinematic = |axes| ConstraintKind::Kinematic {
        nodes: top.to_vec(),
        carrier: 0,
        axes,
    };
    hold_carrier(&mut held, 0..6);
    constrain(&mut held, kinematic([true; 3]));
    assert!(motions(&held).is_empty());

    let mut held = model.held();
    hold_carrier(&mut held, 0..6);
    constrain(&mut held, kinematic([false, false, true]));
    assert_eq!(motions(&held), ["slide along x and y and to turn about z"]);

    // the carrier of a distributing coupling has no more motions than its nodes
    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    let nodes = top.map(|n| (n, 1.0)).to_vec();
    constrain(
        &mut held,
        ConstraintKind::Distributing { nodes, carrier: 0 },
    );
    assert!(motions(&held).is_empty());

    // and the nodes no more than the carrier
    let mut held = model.held();
    let nodes = top.map(|n| (n, 0.5)).to_vec();
    constrain(
        &mut held,
        ConstraintKind::Distributing { nodes, carrier: 0 },
    );
    hold_carrier(&mut held, 0..5);
    let both = motions(&held);
    let turn = "turn about the axis along z through";
    assert!(
        both.len() == 2 && both.iter().all(|m| m.starts_with(turn)),
        "{both:?}"
    );
}

#[test]
fn what_is_tied_to_a_held_body_is_held() {
    let model = cubes(&[ORIGIN, Vec3::new(1.5, 0.0, 0.0)]);
    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    for axis in 0..3 {
        for node in 0..3 {
            let terms = vec![
                (Unknown::Node(node + 8, axis), 2.0),
                (Unknown::Node(node, axis), -2.0),
            ];
            equation(&mut held, terms);
        }
    }
    assert!(motions(&held).is_empty());

    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    held.springs(&[SpringPart {
        name: String::new(),
        ends: vec![(8, Some(1)), (11, None)],
        law: SpringLaw::Linear(3.0),
        direction: Some(Vec3::unit(0)),
    }]);
    assert_eq!(
        motions(&held),
        ["slide along y and z and to turn about x and y"]
    );
}

#[test]
fn nodes_that_stay_in_a_plane_tie_two_bodies() {
    let model = cubes(&[ORIGIN, Vec3::new(1.5, 0.0, 0.0)]);
    let mut held = model.held();
    fix(&mut held, &BOTTOM, &[0, 1, 2]);
    let nodes = vec![4, 5, 6, 7, 12, 13, 14, 15];
    constrain(&mut held, ConstraintKind::Plane { nodes });
    assert_eq!(motions(&held), ["slide along x and y and to turn about z"]);
}

#[test]
fn plane_and_axisymmetric_bodies_have_three_motions_and_one() {
    let mut mesh = Mesh::default();
    for (x, y) in [(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0)] {
        mesh.points.push(Vec3::new(x, y, 0.0));
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let cell = mesh.push_cell(element::by_name("quad4").unwrap(), &[0, 1, 2, 3], 1);
    let bodies = [BodyPart {
        name: "plate".into(),
        cells: vec![cell],
        kind: solid(),
    }];
    let elimination = Elimination::default();
    let plane = Idealisation::PlaneStrain { thickness: 1.0 };
    let held = |space| Held::new(&mesh, space, &bodies, &[], &elimination, &|_| true);
    assert_eq!(
        motions(&held(plane)),
        ["slide in every direction and to turn"]
    );
    assert_eq!(
        motions(&held(Idealisation::Axisymmetric)),
        ["slide along y"]
    );
    let mut pinned = held(plane);
    fix(&mut pinned, &[0], &[0, 1]);
    assert_eq!(motions(&pinned), ["turn about (1, 0)"]);
    fix(&mut pinned, &[1], &[1]);
    assert!(motions(&pinned).is_empty());
}

#[test]
fn a_bar_that_turns_about_itself_does_not_move() {
    let mut mesh = Mesh::default();
    for x in [0.0, 1.0] {
        mesh.points.push(Vec3::new(x, 0.0, 0.0));
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let cell = mesh.push_cell(element::by_name("line2").unwrap(), &[0, 1], 1);
    let bodies = [BodyPart {
        name: "bar".into(),
        cells: vec![cell],
        kind: solid(),
    }];
    let elimination = Elimination::default();
    let mut held = Held::new(
        &mesh,
        Idealisation::Space,
        &bodies,
        &[],
        &elimination,
        &|_| true,
    );
    fix(&mut held, &[0, 1], &[0, 1, 2]);
    assert!(motions(&held).is_empty());
}
