//! Assembly of solids, and preparation and assembly of contact: `cargo bench -p signorini-mechanics`.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, boundary};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::contact::discretization::mortar;
use signorini_mechanics::material::NeoHookean;
use signorini_mechanics::model::{
    BodyKind, BodyPart, Change, ContactPart, Method, Model, Parts, PrimaryPart, SidePart, StepPart,
    Target,
};
use signorini_mechanics::solve::{Increments, Motion};
use signorini_mechanics::system::{
    Assembler, Assembly, Idealisation, Order, Phase, State, StepContext,
};

/// A cube of `n³` hexahedra of side 1 at a height, with the nodes of its lower and upper side.
fn cube(mesh: &mut Mesh, n: u32, z: f64) -> (Vec<CellId>, [Vec<NodeId>; 2]) {
    let first = mesh.points.len() as u32;
    let side = n + 1;
    for node in 0..side * side * side {
        let [x, y, up] = [node % side, node / side % side, node / side / side]
            .map(|k| f64::from(k) / f64::from(n));
        mesh.points.push(Vec3::new(x, y, z + up));
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let hex8 = by_name("hex8").unwrap();
    let cells = (0..n * n * n).map(|c| {
        let corner = first + c % n + side * (c / n % n + side * (c / n / n));
        let ring = |low: u32| [low, low + 1, low + 1 + side, low + side];
        let nodes = [ring(corner), ring(corner + side * side)].concat();
        mesh.push_cell(hex8, &nodes, u64::from(first + c + 1))
    });
    let cells = cells.collect();
    let layer = |k: u32| (first + k * side * side..first + (k + 1) * side * side).collect();
    (cells, [layer(0), layer(n)])
}

/// Two cubes, the upper one pressed into the lower one by a hundredth.
fn model(method: Option<Method>) -> (Model, State) {
    let mut mesh = Mesh::default();
    let (low, [base, low_top]) = cube(&mut mesh, 10, 0.0);
    let (high, [foot, head]) = cube(&mut mesh, 9, 1.0);
    let all = boundary(&mesh, mesh.cells(3));
    let faces = |nodes: &[NodeId]| -> Vec<Face> { mesh.faces_among(&all, nodes) };
    let body = |name: &str, cells: Vec<CellId>| BodyPart {
        name: name.into(),
        cells,
        kind: BodyKind::solid(Box::new(NeoHookean::new(1000.0, 0.3))),
    };
    let held = |nodes: Vec<NodeId>| {
        let motions = (0..3).map(|axis| (axis, Motion::Hold)).collect();
        Change::Prescribe(Target::Nodes(nodes), motions)
    };
    let mut step = StepPart::new("press", Increments::Fixed(1));
    step.changes = vec![held(base), held(head)];
    let contacts = method.map(|method| {
        let sides = (
            SidePart::Faces(faces(&foot)),
            PrimaryPart::Faces(faces(&low_top)),
        );
        let mut contact = ContactPart::new("touch", sides.0, sides.1);
        contact.method = method;
        contact
    });
    let mut model = Model::assemble(Parts {
        bodies: vec![body("low", low), body("high", high)],
        contacts: contacts.into_iter().collect(),
        steps: vec![step],
        ..Parts::new(&mesh, Idealisation::Space)
    })
    .unwrap();
    let start = model.system.initial_state();
    let mut du = vec![0.0; start.u.len()];
    for (node, x) in mesh.points.iter().enumerate() {
        du[3 * node + 2] = 0.001 * (7.0 * x.x).sin() - if x.z > 1.0 { 0.01 } else { 0.0 };
    }
    let mut trial = start.clone();
    model.system.advance(&mut trial, &start, &du, 1.0);
    for term in &mut model.system.terms {
        term.begin(&Phase::of_step(StepContext::default()), &start)
            .unwrap();
    }
    (model, trial)
}

/// Times the tangent of a whole system.
fn tangent(c: &mut Criterion, name: &str, method: Option<Method>) {
    let (mut model, trial) = model(method);
    let system = &mut model.system;
    for term in system.adaptive() {
        term.prepare(&trial, Order::Tangent).unwrap();
    }
    let mut assembler = Assembler::new(&system.layout, &system.elimination, &system.terms);
    assembler.begin_step(&system.layout, &system.elimination, &system.terms);
    let mut out = Assembly::default();
    c.bench_function(name, |b| {
        b.iter(|| {
            assembler.begin_increment(&system.terms);
            let (layout, elimination) = (&system.layout, &system.elimination);
            let order = Order::Tangent;
            assembler
                .assemble(layout, elimination, &system.terms, &trial, order, &mut out)
                .unwrap();
        });
    });
}

fn assembly(c: &mut Criterion) {
    tangent(c, "tangent of 1729 hex8", None);
    let methods = [
        ("node-to-segment", Method::NodeToSegment),
        ("mortar", Method::Mortar(mortar::Form::default())),
    ];
    for (name, method) in methods {
        tangent(
            c,
            &format!("the same in contact, {name}"),
            Some(method.clone()),
        );
        let (mut model, trial) = model(Some(method));
        c.bench_function(&format!("search and pairing, {name}"), |b| {
            b.iter(|| {
                for term in model.system.adaptive() {
                    term.prepare(&trial, Order::Tangent).unwrap();
                }
            });
        });
    }
}

criterion_group!(benches, assembly);
criterion_main!(benches);
