//! Choices of a contact that do not go together, and what each refusal proposes instead.

use crate::contact::discretization::mortar;
use crate::contact::law::Exponential;
use crate::cubic::Tri10;
use crate::material::NeoHookean;
use crate::model::{
    AreaPart, BodyKind, BodyPart, CarrierPart, Change, ContactPart, Enforcement, Method, Model,
    ModelError, Normals, PairOrder, Parts, PointKind, PointRule, PrimaryPart, SidePart, StepPart,
    Target, TiePart,
};
use crate::solve::{Increments, Motion};
use crate::system::Idealisation;
use signorini_geometry::element::{Element, by_name};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::surface::{Analytical, Mount, Plane};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

const BY_NODES: Method = Method::NodeToSegment;
const BY_POINTS: Method = Method::GaussPoint(PointRule {
    kind: PointKind::Gauss,
    points: None,
    cut: false,
});
const BY_PENALTY: Enforcement = Enforcement::Penalty(None);

fn by_mortar() -> Method {
    Method::Mortar(mortar::Form::default())
}

const UP: Normals = Normals::Given(Vec3::new(0.0, 1.0, 0.0));

fn pairs(normals: Normals) -> Method {
    let pairs = PairOrder::Nearest;
    Method::NodeToNode { normals, pairs }
}

fn face(index: u32, side: u8) -> Face {
    let cell = CellId { block: 0, index };
    Face { cell, side }
}

/// The lower side of the upper square.
fn foot() -> SidePart {
    SidePart::Faces(vec![face(1, 0)])
}

/// The nodes of that side.
fn bare() -> SidePart {
    SidePart::Nodes(vec![4, 5])
}

/// The plane of the upper side of the lower square.
fn floor() -> PrimaryPart {
    let plane = Plane::new(Vec3::ZERO, Vec3::unit(1)).unwrap();
    let surface = Analytical::new(Mount::fixed(1), Box::new(plane)).unwrap();
    PrimaryPart::Surface(Arc::new(surface))
}

/// A square on another, with this contact between them.
fn assembled(part: &ContactPart) -> Result<(), ModelError> {
    let (mut mesh, low) = square_below();
    let first = push_points(&mut mesh, SQUARE, 0.0);
    let nodes = [first, first + 1, first + 2, first + 3];
    let high = mesh.push_cell(by_name("quad4").unwrap(), &nodes, 2);
    let bodies = vec![solid("low", low), solid("high", high)];
    let held = vec![
        hold(Target::Nodes(vec![0, 1])),
        hold(Target::Nodes(vec![6, 7])),
    ];
    Model::assemble(Parts {
        bodies,
        contacts: vec![part.clone()],
        steps: vec![step(held)],
        ..Parts::new(&mesh, Idealisation::PlaneStrain { thickness: 1.0 })
    })
    .map(|_| ())
}

/// A rigid made-up triangle of degree 3 on a square, with this contact between them.
fn cubic_on_square(part: &ContactPart) -> Result<(), ModelError> {
    let (mut mesh, low) = square_below();
    let triangle: Element = &Tri10;
    let corners: Vec<(f64, f64)> = triangle.nodes().iter().map(|x| (x.x, x.y)).collect();
    let first = push_points(&mut mesh, corners, 0.0);
    let nodes: Vec<NodeId> = (first..).take(triangle.nnode()).collect();
    let rigid = BodyPart {
        name: "cubic".into(),
        cells: vec![mesh.push_cell(triangle, &nodes, 2)],
        kind: BodyKind::Rigid {
            carrier: 0,
            density: None,
        },
    };
    let carrier = CarrierPart {
        name: "cubic".into(),
        at: None,
    };
    Model::assemble(Parts {
        bodies: vec![solid("low", low), rigid],
        carriers: vec![carrier],
        contacts: vec![part.clone()],
        steps: vec![step(vec![
            hold(Target::Nodes(vec![0, 1])),
            hold(Target::Rigid(0)),
        ])],
        ..Parts::new(&mesh, Idealisation::PlaneStrain { thickness: 1.0 })
    })
    .map(|_| ())
}

const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];

fn push_points(
    mesh: &mut Mesh,
    points: impl IntoIterator<Item = (f64, f64)>,
    above: f64,
) -> NodeId {
    let first = mesh.nnode() as NodeId;
    for (x, y) in points {
        mesh.points.push(Vec3::new(x, above + y, 0.0));
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    first
}

fn square_below() -> (Mesh, CellId) {
    let mut mesh = Mesh::default();
    push_points(&mut mesh, SQUARE, -1.0);
    let cell = mesh.push_cell(by_name("quad4").unwrap(), &[0, 1, 2, 3], 1);
    (mesh, cell)
}

fn solid(name: &str, cell: CellId) -> BodyPart {
    BodyPart {
        name: name.into(),
        cells: vec![cell],
        kind: BodyKind::solid(Box::new(NeoHookean::new(1000.0, 0.3))),
    }
}

fn hold(target: Target) -> Change {
    Change::Prescribe(target, vec![(0, Motion::Hold), (1, Motion::Hold)])
}

fn step(changes: Vec<Change>) -> StepPart {
    StepPart {
        name: "step".into(),
        duration: 1.0,
        increments: Increments::Fixed(1),
        nonlinear: true,
        scheme: None,
        control: None,
        vibration: None,
        physics: crate::system::Physics::default(),
        changes,
        loads: Vec::new(),
        contacts: Vec::new(),
        temperatures: Vec::new(),
        freed_temperatures: Vec::new(),
        activity: Vec::new(),
    }
}

/// What is refused, the remedy, what provokes it, and what the remedy says.
type Case = (
    &'static str,
    &'static str,
    fn(&mut ContactPart),
    fn(&mut ContactPart),
);

const PENALTY: &str = "enforcement = { penalty = \"auto\" }";
const AT_NODES: &str = "method = \"node-to-segment\"";
const AT_POINTS: &str = "method = \"gauss-point\"";
const NORMAL: &str = "normals = [0, 1, 0]";

#[rustfmt::skip]
const CASES: [Case; 16] = [
    ("two passes by multipliers", PENALTY,
        |c| { c.method = BY_NODES; c.two_pass = true; c.enforcement = Enforcement::Lagrange; },
        |c| c.enforcement = BY_PENALTY),
    ("points stand for facets opposite", "area = \"reference\"",
        |c| { c.method = BY_NODES; c.primary = floor(); c.area = AreaPart::Opposite; },
        |c| c.area = AreaPart::Reference),
    ("a surface that touches itself has multipliers", PENALTY,
        |c| { c.primary = PrimaryPart::Itself; c.enforcement = Enforcement::Lagrange; },
        |c| c.enforcement = BY_PENALTY),
    ("a surface that may touch itself is given by faces", "secondary = \"a set of faces\"",
        |c| { c.primary = PrimaryPart::Itself; c.secondary = bare(); },
        |c| c.secondary = foot()),
    ("points inside facets are too many", PENALTY,
        |c| { c.method = BY_POINTS; c.enforcement = Enforcement::Lagrange; },
        |c| c.enforcement = BY_PENALTY),
    ("points inside facets need a secondary side made of faces", AT_NODES,
        |c| { c.method = BY_POINTS; c.secondary = bare(); },
        |c| c.method = BY_NODES),
    ("mortar contact needs two sides made of faces", AT_NODES,
        |c| { c.method = by_mortar(); c.secondary = bare(); },
        |c| c.method = BY_NODES),
    ("mortar contact needs two sides made of faces", AT_NODES,
        |c| { c.method = by_mortar(); c.primary = floor(); },
        |c| c.method = BY_NODES),
    ("mortar contact has one pass", AT_POINTS,
        |c| { c.method = by_mortar(); c.enforcement = BY_PENALTY; c.two_pass = true; },
        |c| c.method = BY_POINTS),
    ("mortar contact has one pass", AT_POINTS,
        |c| { c.method = by_mortar(); c.area = AreaPart::Present; },
        |c| c.method = BY_POINTS),
    ("mortar contact has one pass", AT_POINTS,
        |c| { c.method = by_mortar(); c.enforcement = BY_PENALTY; c.primary = PrimaryPart::Itself; },
        |c| c.method = BY_POINTS),
    ("node-to-node contact is between the nodes of two sides", AT_NODES,
        |c| { c.method = pairs(Normals::Primary); c.primary = floor(); },
        |c| c.method = BY_NODES),
    ("normals of bare nodes cannot be averaged", NORMAL,
        |c| { c.method = pairs(Normals::Primary); c.primary = PrimaryPart::Nodes(vec![2, 3]); },
        |c| c.method = pairs(UP)),
    ("normals of bare nodes cannot be averaged", NORMAL,
        |c| { c.method = pairs(Normals::Secondary); c.secondary = bare(); },
        |c| c.method = pairs(UP)),
    ("the given normal is zero", NORMAL,
        |c| c.method = pairs(Normals::Given(Vec3::ZERO)),
        |c| c.method = pairs(UP)),
    ("sides that are joined pull, too", PENALTY,
        |c| {
            c.method = BY_NODES;
            c.tie = Some(TiePart::default());
            c.enforcement = Enforcement::Law(Arc::new(Exponential { p0: 1.0, c0: 0.1, within: f64::INFINITY }));
        },
        |c| c.enforcement = BY_PENALTY),
];

#[test]
fn choices_that_do_not_go_together_are_refused_with_one_that_does() {
    let plain = ContactPart::new("touch", foot(), PrimaryPart::Faces(vec![face(0, 2)]));
    assert_eq!(assembled(&plain), Ok(()));
    for (words, proposed, provoke, mend) in CASES {
        let mut part = plain.clone();
        provoke(&mut part);
        match assembled(&part) {
            Err(ModelError::Unsuited {
                contact,
                what,
                remedy,
            }) => {
                assert_eq!((contact.as_str(), remedy), ("touch", proposed));
                assert!(what.starts_with(words), "{words}: {what}");
            }
            other => panic!("{words}: {other:?}"),
        }
        mend(&mut part);
        assert_eq!(assembled(&part), Ok(()), "{words}");
    }
}

#[test]
fn facets_without_a_dual_basis_press_by_points_and_are_refused_by_mortar_by_name() {
    let under = Face {
        cell: CellId { block: 1, index: 0 },
        side: 0,
    };
    let secondary = SidePart::Faces(vec![under]);
    let mut part = ContactPart::new("touch", secondary, PrimaryPart::Faces(vec![face(0, 2)]));
    part.enforcement = BY_PENALTY;
    let all_points = Method::GaussPoint(PointRule {
        kind: PointKind::Gauss,
        points: None,
        cut: true,
    });
    for method in [Method::Auto, BY_NODES, BY_POINTS, all_points] {
        part.method = method;
        assert_eq!(cubic_on_square(&part), Ok(()));
    }
    part.method = by_mortar();
    let refused = cubic_on_square(&part).unwrap_err();
    let expected = ModelError::NoDualBasis {
        contact: "touch".into(),
        element: "cubic line",
        label: 2,
    };
    assert_eq!(refused, expected);
    let words = refused.to_string();
    for word in ["\"touch\"", "element 2", "cubic line", "dual basis"] {
        assert!(words.contains(word), "{words}");
    }
}
