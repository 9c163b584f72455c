//! Two elastic bodies that touch in a circle.
//!
//! SOURCE      Johnson, *Contact Mechanics*, 1985, (4.22) to (4.24)
//! GOAL        Mortar pressures at nodes are those of Hertz, on meshes that do not match
//! MESH        A quarter of two blocks 8 a wide and high, hex8 or tet10; the face of the upper one is a paraboloid. Ten even
//!             facets, or four, in the radius a of the contact, five for six below; away from it cells grow
//! CONDITIONS  Small strain, small sliding (tet10: finite), no friction; an even traction on top whose resultant F is
//!             given; the base is held
//! EXPECTED    p = p0 √(1 − r²/a²), a = (3 F R/(4 E*))^⅓, p0 = 3 F/(2π a²)
//! TOLERANCE   p0 1 %; the root mean square over nodes with r < a, or with a pressure, as said at each test
#![allow(clippy::unwrap_used)]

mod common;

use common::Grid;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, boundary};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::contact::discretization::SlidingRange;
use signorini_mechanics::load::{Course, Force, Load, Place};
use signorini_mechanics::material::SaintVenantKirchhoff;
use signorini_mechanics::model::{
    Change, ContactPart, LoadPart, Method, Model, Parts, PrimaryPart, SidePart, StepPart, Target,
};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::{ContactFrame, Idealisation};
use std::f64::consts::PI;

const MODULUS: f64 = 1000.0;
const POISSON: f64 = 0.3;
/// Radius of the paraboloid, and of the contact.
const R: f64 = 10.0;
/// Combined modulus of the two bodies.
const COMBINED: f64 = MODULUS / (1.0 - POISSON * POISSON) / 2.0;
const A: f64 = 0.3;
/// Extent of a quarter.
const SIZE: f64 = 8.0 * A;
/// From there on, every cell over the one before it.
const GROWTH: f64 = 1.4;
/// How far facets are even.
const EVEN: f64 = 1.5 * A;

/// Lines from 0 to the end of a block: even ones first, then at distances that grow.
fn lines(h: f64) -> Vec<f64> {
    let even = (EVEN / h).ceil() as usize;
    let mut lines: Vec<f64> = (0..=even).map(|k| h * k as f64).collect();
    grow(&mut lines, h);
    lines
}

fn grow(lines: &mut Vec<f64>, mut h: f64) {
    let from = lines.len() - 1;
    let start = lines[from];
    while lines[lines.len() - 1] < SIZE {
        h *= GROWTH;
        lines.push(lines[lines.len() - 1] + h);
    }
    let factor = (SIZE - start) / (lines[lines.len() - 1] - start);
    for x in &mut lines[from + 1..] {
        *x = start + (*x - start) * factor;
    }
}

/// A block above its face, or with lines of negative heights below it.
fn block(element: &str, across: &[f64], up: &[f64], face: impl Fn(Vec3) -> f64) -> Grid {
    // mid nodes lie halfway between lines
    let place = |lines: &[f64], s: f64| {
        let twice = (2.0 * s * (lines.len() - 1) as f64).round() as usize;
        0.5 * (lines[twice / 2] + lines[twice.div_ceil(2)])
    };
    let n = across.len() - 1;
    Grid::of(element, [n, n, up.len() - 1], |s| {
        let x = Vec3::new(place(across, s.x), place(across, s.y), 0.0);
        let z = place(up, s.z);
        Vec3::new(x.x, x.y, z + face(x) * (1.0 - z / SIZE))
    })
}

/// The contact of bodies with so many even facets in the radius.
fn pressed(facets: f64, element: &str, sliding: SlidingRange) -> ContactFrame {
    let force = 4.0 * COMBINED * A.powi(3) / (3.0 * R);
    let up = |h: f64| {
        let mut up = vec![0.0];
        grow(&mut up, h / GROWTH);
        up
    };
    let (fine, coarse) = (A / facets, 1.2 * A / facets);
    let upper = block(element, &lines(fine), &up(fine), |x| x.dot(x) / (2.0 * R));
    let down: Vec<f64> = up(coarse).iter().rev().map(|z| -z).collect();
    let lower = block(element, &lines(coarse), &down, |_| 0.0);
    let mut mesh = Mesh::default();
    let lower = lower.join(&mut mesh, |s| s.z > 1.0 - 1e-9);
    let upper = upper.join(&mut mesh, |s| s.z < 1e-9);
    let nodes = |wanted: &dyn Fn(Vec3) -> bool| {
        let lower = lower.nodes(wanted).into_iter();
        lower.chain(upper.nodes(wanted)).collect::<Vec<NodeId>>()
    };
    let hold = |nodes: Vec<NodeId>, axis| {
        Change::Prescribe(Target::Nodes(nodes), vec![(axis, Motion::Hold)])
    };
    let changes = vec![
        hold(nodes(&|s| s.x < 1e-9), 0),
        hold(nodes(&|s| s.y < 1e-9), 1),
        hold(lower.nodes(|s| s.z < 1e-9), 2),
    ];
    let head = upper.nodes(|s| s.z > 1.0 - 1e-9);
    let outside = boundary(&mesh, upper.cells.iter().copied());
    let is_head = |face: &Face| {
        let (_, nodes) = mesh.face(*face).unwrap();
        nodes.iter().all(|n| head.binary_search(n).is_ok())
    };
    let load = LoadPart {
        name: "weight".into(),
        load: Force(Vec3::new(0.0, 0.0, -0.25 * force))
            .on(Place::Faces(outside.into_iter().filter(is_head).collect())),
        course: Course::Ramp,
    };
    let solid = |name: &str, cells: &[CellId]| {
        common::solid(name, cells, SaintVenantKirchhoff::new(MODULUS, POISSON))
    };
    let mut contact = ContactPart::new(
        "circle",
        SidePart::Faces(upper.faces.clone()),
        PrimaryPart::Faces(lower.faces.clone()),
    );
    contact.method = Method::Mortar(Default::default());
    contact.sliding = sliding;
    contact.smooths = true;
    let step = StepPart {
        name: "press".into(),
        duration: 1.0,
        increments: Increments::Fixed(1),
        nonlinear: false,
        scheme: None,
        control: None,
        vibration: None,
        physics: signorini_mechanics::system::Physics::default(),
        changes,
        loads: vec![load],
        contacts: Vec::new(),
        temperatures: Vec::new(),
        freed_temperatures: Vec::new(),
        activity: Vec::new(),
    };
    let parts = Parts {
        bodies: vec![solid("lower", &lower.cells), solid("upper", &upper.cells)],
        contacts: vec![contact],
        steps: vec![step],
        ..Parts::new(&mesh, Idealisation::Space)
    };
    let mut model = Model::assemble(parts).unwrap();
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut found = None;
    let mut watch = |event: &Event<'_>| {
        if let Event::Increment { record, frame } = event {
            println!(
                "{} unknowns, {} iterations",
                3 * mesh.points.len(),
                record.iterations
            );
            found = Some(frame.contacts[0].clone());
        }
        Flow::Continue
    };
    let outcome = stepper.run(&mut model.system, &model.steps, &mut watch);
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    found.unwrap()
}

/// What pressures at nodes are off by, over p0: of the largest, and of each node in the circle or with a pressure.
fn errors(contact: &ContactFrame) -> (f64, Vec<f64>) {
    let p0 = 2.0 * COMBINED * A / (PI * R);
    let nodes = contact.points.iter().zip(&contact.pressure);
    let error = |(x, p): (&Vec3, &f64)| {
        let r = x.x.hypot(x.y) / A;
        let exact = (1.0 - r * r).max(0.0).sqrt();
        (r < 1.0 || *p > 0.0).then_some(p / p0 - exact)
    };
    (
        contact.pressure_max / p0 - 1.0,
        nodes.filter_map(error).collect(),
    )
}

fn mean(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Published, of meshes like the first: 3.7 % by the mortar method of another program, 12.7 % by its penalty. There, a node
/// is a hundredth of a facet inside the edge; in the mean over all places of the edge errors are larger, all of them at the
/// rim, where pressures fall like a root.
#[test]
fn pressures_of_a_coarse_circle_johnson_4_22() {
    let mut all = Vec::new();
    for off in [0.03, -0.4, -0.2, 0.2, 0.4] {
        let (p0, errors) = errors(&pressed(4.0 + off, "hex8", SlidingRange::Small));
        let mean = mean(&errors);
        println!(
            "{:.2} facets a radius: p0 {:+.2} %, pressures {:.2} %",
            4.0 + off,
            100.0 * p0,
            100.0 * mean
        );
        assert!(p0.abs() < 0.02);
        assert!(off != 0.03 || mean < 0.037);
        all.extend(errors);
    }
    println!(
        "about four facets a radius: pressures {:.2} %",
        100.0 * mean(&all)
    );
    assert!(mean(&all) < 0.05);
}

/// The multipliers themselves scatter by 3.6 % over the inner half of the circle, on a mesh like this one. They stay in the
/// results next to the smoothed ones, with the same resultant.
#[test]
fn pressures_of_quadratic_triangles_johnson_4_22() {
    let p0 = 2.0 * COMBINED * A / (PI * R);
    let contact = pressed(3.3, "tet10", SlidingRange::Finite);
    let r = |x: &Vec3| x.x.hypot(x.y) / A;
    let nodes = || contact.points.iter().zip(&contact.pressure);
    let inner: Vec<f64> = nodes()
        .filter(|(x, _)| r(x) < 0.7)
        .map(|(x, p)| p / p0 - (1.0 - r(x).powi(2)).sqrt())
        .collect();
    let largest = contact.pressure_max / p0 - 1.0;
    println!(
        "p0 {:+.2} %, pressures inside {:.2} %",
        100.0 * largest,
        100.0 * mean(&inner)
    );
    assert!(largest.abs() < 0.02 && mean(&inner) < 0.022);
    let peaks = contact.pressure_peak.iter().zip(&contact.pressure);
    assert!(peaks.clone().all(|(peak, p)| *peak >= p * (1.0 - 1e-12)));
    let raw = contact.points.iter().zip(&contact.multiplier);
    let raw: Vec<f64> = raw
        .filter(|(x, _)| r(x) < 0.7)
        .map(|(x, p)| p / p0 - (1.0 - r(x).powi(2)).sqrt())
        .collect();
    assert!(mean(&raw) > 1.5 * mean(&inner), "{}", mean(&raw));
    let resultant = |of: &[f64]| contact.area.iter().zip(of).map(|(a, p)| a * p).sum::<f64>();
    let [smooth, scattered] = [&contact.pressure, &contact.multiplier].map(|of| resultant(of));
    assert!(
        (smooth / scattered - 1.0).abs() < 1e-9,
        "{smooth}, {scattered}"
    );
    // without friction no traction is along the surface; normals of facets around a node differ by a little
    for (traction, pressure) in contact.traction.iter().zip(&contact.pressure) {
        let whole = traction.norm();
        assert!(whole <= pressure * (1.0 + 1e-12) && whole >= 0.999 * pressure);
    }
    // the surface is flat to 1/250
    let carried: f64 = contact
        .area
        .iter()
        .zip(&contact.pressure)
        .map(|(a, p)| a * p)
        .sum();
    let force = contact.secondary.force.norm();
    assert!((carried / force - 1.0).abs() < 5e-4, "{carried} of {force}");
}

#[test]
#[ignore = "takes half a minute: run by .ci/run"]
fn pressures_of_a_circle_johnson_4_22() {
    let (p0, errors) = errors(&pressed(10.0, "hex8", SlidingRange::Small));
    let mean = mean(&errors);
    println!(
        "ten facets a radius: p0 {:+.2} %, pressures {:.2} %",
        100.0 * p0,
        100.0 * mean
    );
    assert!(p0.abs() < 0.01 && mean < 0.02);
}
