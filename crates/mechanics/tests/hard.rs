//! Situations in which contact programs fail.
//!
//! SOURCE      Written for the purpose.
//! GOAL        Every method converges with default settings, to the right answer.
//! MESH        A block of 1 × 1 × 1 with 5 × 5 × 5 cells on a block of 2 × 2 × 1 with 6 × 6 × 2, 1,089 unknowns: meshes do not match.
//! CONDITIONS  Small and large steps, loads and motions, with free rigid modes, overlaps, friction, bad stiffnesses.
//! EXPECTED    The vertical force: that of the load, or of a mesh twice as fine; shear over normal force = μ in full sliding.
//! TOLERANCE   3 % in force, 1e-3 in friction, 1e-6 under loads; three exceptions, [`NODES_ALONE`]
#![allow(clippy::unwrap_used)]

mod common;

use common::{Grid, Part};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::load::{Course, Force, Load, Place};
use signorini_mechanics::material::NeoHookean;
use signorini_mechanics::model::{
    Change, ContactPart, Enforcement, FrictionPart, LoadPart, Method, Model, Parts, PointKind,
    PointRule, PrimaryPart, SidePart, StepPart, StickPart, Target,
};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::Idealisation;
use std::cell::RefCell;

/// A situation; the default is a block pressed by 5 %.
#[derive(Clone)]
struct Situation {
    name: &'static str,
    element: &'static str,
    lower: usize,
    upper: usize,
    /// Moduli of the lower and the upper block.
    moduli: [f64; 2],
    /// Height of the upper block.
    height: f64,
    /// Where the foot of the upper block is at the start.
    gap: f64,
    /// About y, in degrees.
    tilt: f64,
    /// How far its head is pressed down; a load where there is a force.
    press: f64,
    force: f64,
    /// Whether the head is held sideways.
    guided: bool,
    slide: f64,
    mu: f64,
    /// Stiffness of sticking over the penalty.
    stick: f64,
    /// The penalty over the automatic one.
    penalty: f64,
    /// All lengths.
    unit: f64,
    increments: usize,
    /// Of the slide.
    slid_in: usize,
    force_tol: f64,
}

const PRESSED: Situation = Situation {
    name: "pressed",
    element: "hex8",
    lower: 6,
    upper: 5,
    moduli: [1e5, 1000.0],
    height: 1.0,
    gap: 0.0,
    tilt: 0.0,
    press: 0.05,
    force: 0.0,
    guided: true,
    slide: 0.0,
    mu: 0.0,
    stick: 1.0,
    penalty: 1.0,
    unit: 1.0,
    increments: 4,
    slid_in: 10,
    force_tol: 1e-6,
};

/// What came of it.
#[derive(Clone, Copy, Debug)]
struct Result {
    force: Vec3,
    /// |shear| over |normal|.
    rubs: f64,
    iterations: usize,
    increments: usize,
    cutbacks: usize,
}

/// Two grids in one mesh.
struct Blocks {
    mesh: Mesh,
    low: Part,
    high: Part,
}

fn blocks(s: &Situation, refine: usize) -> Blocks {
    let unit = s.unit;
    let low = Grid::new(s.element, s.lower * refine, 2 * refine, |x| {
        Vec3::new(2.0 * x.x, 2.0 * x.y, x.z - 1.0) * unit
    });
    let angle = s.tilt.to_radians();
    let corner = angle.sin();
    let layers = (s.upper as f64 * s.height).ceil() as usize * refine;
    let high = Grid::new(s.element, s.upper * refine, layers, |x| {
        let x = Vec3::new(x.x, x.y, s.height * x.z);
        let turned = Vec3::new(
            angle.cos() * x.x + angle.sin() * x.z,
            x.y,
            angle.cos() * x.z - angle.sin() * x.x + corner,
        );
        (turned + Vec3::new(0.4, 0.5, s.gap)) * unit
    });
    let mut mesh = Mesh::default();
    let low = low.join(&mut mesh, |x| x.z > 1.0 - 1e-9);
    let high = high.join(&mut mesh, |x| x.z < 1e-9);
    Blocks { mesh, low, high }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    NodeToSegment,
    GaussPoint,
    Lagrange,
    Mortar,
}

/// Presses the blocks together, then slides the upper one.
fn steps(s: &Situation, mesh: &Mesh, low: &Part, high: &Part) -> Vec<StepPart> {
    let base = low.nodes(|x| x.z < 1e-9);
    let head = high.nodes(|x| x.z > 1.0 - 1e-9);
    let hold = |nodes: &[NodeId], axes: &[usize]| {
        let motions = axes.iter().map(|&axis| (axis, Motion::Hold)).collect();
        Change::Prescribe(Target::Nodes(nodes.to_vec()), motions)
    };
    let unit = s.unit;
    let mut changes = vec![hold(&base, &[0, 1, 2])];
    if s.guided {
        changes.push(hold(&head, &[0, 1]));
    }
    let mut loads = Vec::new();
    if s.force > 0.0 {
        let top = signorini_geometry::mesh::boundary(mesh, high.cells.iter().copied());
        let is_head = |f: &Face| {
            let (_, nodes) = mesh.face(*f).unwrap();
            nodes.iter().all(|n| head.contains(n))
        };
        loads.push(LoadPart {
            name: "weight".into(),
            load: Force(Vec3::new(0.0, 0.0, -s.force * unit * unit))
                .on(Place::Faces(top.into_iter().filter(is_head).collect())),
            course: Course::Ramp,
        });
    } else {
        let down = vec![(2, Motion::Ramp(-s.press * unit))];
        changes.push(Change::Prescribe(Target::Nodes(head.clone()), down));
    }
    let increments = |n: usize| Increments::Adaptive {
        initial: 1.0 / n as f64,
        min: 1e-4,
        max: 1.0,
        count_max: 200,
    };
    let step = |name: &str, changes, loads, n| StepPart {
        name: name.into(),
        duration: 1.0,
        increments: increments(n),
        nonlinear: true,
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
    };
    let mut steps = vec![step("press", changes, loads, s.increments)];
    if s.slide != 0.0 {
        let along = vec![(0, Motion::Ramp(s.slide * unit))];
        let slide = Change::Prescribe(Target::Nodes(head), along);
        steps.push(step("slide", vec![slide], Vec::new(), s.slid_in));
    }
    steps
}

fn touch(s: &Situation, way: Way, refine: usize, sides: [Vec<Face>; 2]) -> ContactPart {
    let [low, high] = sides;
    let mut contact = ContactPart::new("touch", SidePart::Faces(high), PrimaryPart::Faces(low));
    // 10 M/h of the softer side
    let cells = (s.lower as f64 / 2.0, s.upper as f64);
    let sides = [s.moduli[0] * cells.0, s.moduli[1] * cells.1];
    let modulus = sides[0].min(sides[1]) * refine as f64 * 0.7 / (1.3 * 0.4);
    let automatic = 10.0 * modulus / s.unit;
    if s.penalty != 1.0 {
        contact.enforcement = Enforcement::Penalty(Some(automatic * s.penalty));
    }
    match way {
        Way::NodeToSegment => contact.method = Method::NodeToSegment,
        Way::GaussPoint => {
            contact.method = Method::GaussPoint(PointRule {
                kind: PointKind::Gauss,
                points: None,
                cut: false,
            });
        }
        Way::Lagrange => {
            contact.method = Method::NodeToSegment;
            contact.enforcement = Enforcement::Lagrange;
        }
        Way::Mortar => {
            contact.method = Method::Mortar(Default::default());
            contact.enforcement = Enforcement::Auto;
        }
    }
    if s.mu > 0.0 {
        contact.friction = Some(FrictionPart {
            stick: (s.stick != 1.0).then_some(StickPart::Stiffness(automatic * s.stick)),
            ..FrictionPart::coulomb(s.mu)
        });
    }
    contact
}

fn run(s: &Situation, way: Way, refine: usize) -> std::result::Result<Result, String> {
    let Blocks { mesh, low, high } = blocks(s, refine);
    let solid = |name: &str, cells: &[CellId], modulus| {
        common::solid(name, cells, NeoHookean::new(modulus, 0.3))
    };
    let parts = Parts {
        steps: steps(s, &mesh, &low, &high),
        bodies: vec![
            solid("low", &low.cells, s.moduli[0]),
            solid("high", &high.cells, s.moduli[1]),
        ],
        contacts: vec![touch(s, way, refine, [low.faces, high.faces])],
        traction_tol: 0.1 * s.force_tol,
        ..Parts::new(&mesh, Idealisation::Space)
    };
    let mut model = Model::assemble(parts).map_err(|e| e.to_string())?;
    let mut settings = StepperSettings::default();
    settings.newton.force_tol = s.force_tol;
    let mut stepper = Stepper::new(&model.system, settings);
    let mut result = Result {
        force: Vec3::ZERO,
        rubs: 0.0,
        iterations: 0,
        increments: 0,
        cutbacks: 0,
    };
    let mut watch = |event: &Event<'_>| {
        match event {
            Event::Increment { record, frame } => {
                let contact = &frame.contacts[0];
                result.force = contact.secondary.force;
                result.rubs = contact.force_shear.norm() / contact.force_normal.norm();
                result.iterations += record.iterations;
                result.increments += 1;
            }
            Event::Cutback { .. } => result.cutbacks += 1,
            _ => {}
        }
        Flow::Continue
    };
    let outcome = stepper.run(&mut model.system, &model.steps, &mut watch);
    match outcome {
        Ok(Outcome::Finished) => Ok(result),
        Ok(Outcome::Stopped) => Err("stopped".into()),
        Err(e) => Err(e.to_string()),
    }
}

fn situations() -> Vec<Situation> {
    let s = |name, change: &dyn Fn(&mut Situation)| {
        let mut s = Situation { name, ..PRESSED };
        change(&mut s);
        s
    };
    vec![
        PRESSED,
        s("loaded", &|s| s.force = 40.0),
        s("gap closed under load", &|s| (s.force, s.gap) = (40.0, 0.1)),
        s("held sideways by friction", &|s| {
            (s.force, s.guided, s.mu) = (40.0, false, 0.3)
        }),
        s("overlap, 4 increments", &|s| {
            (s.gap, s.press) = (-0.05, 0.0)
        }),
        s("overlap, 1 increment", &|s| {
            (s.gap, s.press, s.increments) = (-0.05, 0.0, 1)
        }),
        s("slid, mu 0.3", &|s| {
            (s.slide, s.mu, s.press) = (0.5, 0.3, 0.005)
        }),
        s("slid, mu 1.0", &|s| {
            (s.slide, s.mu, s.press) = (0.5, 1.0, 0.005)
        }),
        s("stick ten times stiffer", &|s| {
            (s.slide, s.mu, s.stick, s.press) = (0.5, 0.3, 10.0, 0.005)
        }),
        s("stiffness ratio 20,000", &|s| s.moduli = [2e7, 1000.0]),
        s("coarse secondary", &|s| (s.upper, s.lower) = (3, 10)),
        s("tilted", &|s| (s.tilt, s.press) = (3.0, 0.08)),
        s("penalty x 1000", &|s| s.penalty = 1000.0),
        s("tet10", &|s| {
            (s.element, s.upper, s.lower) = ("tet10", 2, 3)
        }),
        s("hex20", &|s| {
            (s.element, s.upper, s.lower) = ("hex20", 3, 3)
        }),
        s("metres for millimetres", &|s| s.unit = 1e-3),
        s("half off the edge", &|s| {
            (s.slide, s.height, s.press) = (1.1, 0.5, 0.01)
        }),
    ]
}

/// Methods that look at nodes alone, where these are not enough, and by how much they may be off: a penalty at nodes cannot
/// carry the consistent forces of quadratic faces, and nodes do not see the half cell in front of an edge. `auto` takes
/// neither of them there.
const NODES_ALONE: [(&str, Way, f64); 3] = [
    ("hex20", Way::NodeToSegment, 0.05),
    ("half off the edge", Way::NodeToSegment, 0.13),
    ("half off the edge", Way::Lagrange, 0.10),
];

/// The vertical force that is right, and by how much a result may differ.
fn expected(s: &Situation, fine: &dyn Fn(&Situation) -> f64) -> (f64, f64) {
    if s.force > 0.0 {
        return (s.force, 1e-6);
    }
    let converged = Situation {
        element: "hex8",
        upper: PRESSED.upper,
        lower: PRESSED.lower,
        moduli: PRESSED.moduli,
        penalty: 1.0,
        unit: 1.0,
        gap: 0.0,
        press: s.press - s.gap,
        increments: 4,
        ..s.clone()
    };
    (fine(&converged) * s.unit * s.unit, 0.03)
}

#[test]
#[ignore = "takes two minutes: run by .ci/run"]
fn every_method_gets_through_every_situation() {
    let known: RefCell<Vec<(String, f64)>> = RefCell::default();
    let fine = |s: &Situation| {
        let key = format!("{} {} {} {} {}", s.press, s.tilt, s.slide, s.height, s.mu);
        let found = known.borrow().iter().find(|(k, _)| *k == key).map(|k| k.1);
        found.unwrap_or_else(|| {
            let value = run(s, Way::GaussPoint, 2).unwrap().force.z;
            known.borrow_mut().push((key, value));
            value
        })
    };
    println!(
        "| situation | method | force | off by | shear/normal | increments | iterations | cut-backs |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let only = std::env::var("SITUATION").unwrap_or_default();
    for s in situations().iter().filter(|s| s.name.contains(&only)) {
        for way in [
            Way::NodeToSegment,
            Way::GaussPoint,
            Way::Lagrange,
            Way::Mortar,
        ] {
            let r = run(s, way, 1).unwrap_or_else(|e| panic!("{} {way:?}: {e}", s.name));
            let (force, tolerance) = expected(s, &fine);
            let off = r.force.z / force - 1.0;
            println!(
                "| {} | {way:?} | {:.5} | {:+.2} % | {:.4} | {} | {} | {} |",
                s.name,
                r.force.z,
                100.0 * off,
                r.rubs,
                r.increments,
                r.iterations,
                r.cutbacks
            );
            if s.mu > 0.0 && s.slide > 0.0 {
                assert!((r.rubs - s.mu).abs() < 1e-3, "{} {way:?}: {r:?}", s.name);
            }
            let known = NODES_ALONE
                .iter()
                .find(|one| (one.0, one.1) == (s.name, way));
            if let Some((.., allowed)) = known {
                assert!(
                    off.abs() > tolerance,
                    "{} {way:?} is no exception any more",
                    s.name
                );
                assert!(off.abs() < *allowed, "{} {way:?}: {off:+.4} {r:?}", s.name);
                continue;
            }
            assert!(off.abs() < tolerance, "{} {way:?}: {off:+.4} {r:?}", s.name);
        }
    }
}

/// Published are iterations of another program's mortar method on situations like these, in four increments at its
/// tolerance of 5e-3.
#[test]
fn mortar_needs_few_iterations() {
    for (name, published) in [
        ("pressed", 8),
        ("slid, mu 0.3", 23),
        ("slid, mu 1.0", 25),
        ("tilted", 11),
        ("stick ten times stiffer", 22),
        ("half off the edge", 24),
        ("overlap, 4 increments", 8),
    ] {
        let mut s = situations().into_iter().find(|s| s.name == name).unwrap();
        (s.force_tol, s.slid_in) = (5e-3, 4);
        let r = run(&s, Way::Mortar, 1).unwrap();
        println!(
            "{name}: {} iterations (published {published}) in {} increments, {} cut-backs",
            r.iterations, r.increments, r.cutbacks
        );
        assert!(r.iterations <= published, "{name}: {}", r.iterations);
        assert!(
            (r.rubs - s.mu).abs() < 5e-3 || s.slide == 0.0,
            "{name}: {}",
            r.rubs
        );
    }
}
