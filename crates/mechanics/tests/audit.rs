//! States that are right by construction pass; each is then spoilt in one way.
#![allow(clippy::unwrap_used)]

use signorini_geometry::element::by_name;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Analytical, Mount, Placement, Plane};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use signorini_mechanics::audit::{Rules, Sides, contact, viscous};
use signorini_mechanics::system::{Check, ContactAudit, ContactFrame, Frame, Status};

/// A law without friction, a penalty or a multiplier, and with it.
#[derive(Clone, Copy, Default)]
struct Law {
    penalty: Option<f64>,
    mu: Option<f64>,
    shift: f64,
    moved: f64,
    joined: bool,
}

impl Rules for Law {
    fn joined(&self) -> bool {
        self.joined
    }

    fn shift(&self, _: usize) -> f64 {
        self.shift
    }

    fn moved(&self, _: usize) -> f64 {
        self.moved
    }

    fn gap(&self, _: usize, pressure: f64) -> f64 {
        self.penalty.map_or(0.0, |e| -pressure / e)
    }

    fn limit(&self, _: usize, pressure: f64) -> Option<f64> {
        self.mu.map(|mu| mu * pressure)
    }

    fn partner(&self, _: usize) -> Option<NodeId> {
        None
    }

    fn deepest(&self, _: NodeId, _: u32) -> f64 {
        f64::INFINITY
    }

    fn deepest_back(&self, _: NodeId, _: u32) -> f64 {
        f64::INFINITY
    }

    fn is_rigid(&self, _: NodeId) -> bool {
        false
    }
}

/// Four quadrilaterals of size 1, facing down on a plane that is tilted by an angle about z, at a height above it;
/// pressure 2 everywhere, carried by the stress.
struct Scene {
    turn: Mat3,
    height: f64,
    heights: [f64; 9],
    shear: f64,
    status: Status,
    law: Law,
    stress: f64,
    held: bool,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            turn: Mat3::rotation(Vec3::new(0.3, -0.2, 0.4)),
            height: 0.0,
            heights: [0.0; 9],
            shear: 0.0,
            status: Status::Slip,
            law: Law::default(),
            stress: 1.0,
            held: false,
        }
    }
}

impl Scene {
    fn audit(&self) -> ContactAudit {
        let place = |k: usize| (k % 3, k / 3);
        let flat = |k: usize| {
            Vec3::new(
                place(k).0 as f64,
                self.height + self.heights[k],
                place(k).1 as f64,
            )
        };
        let x: Vec<Vec3> = (0..9).map(|k| self.turn * flat(k)).collect();
        let up = self.turn * Vec3::unit(1);
        let along = self.turn * Vec3::unit(0);
        let quad = by_name("quad4").unwrap();
        // t1 × t2 points down
        let facet = |i: u32, j: u32| {
            let a = i + 3 * j;
            (quad, vec![a, a + 1, a + 4, a + 3])
        };
        let traction = up * 2.0 + along * self.shear;
        let of = ContactFrame {
            name: "c".into(),
            nodes: (0..9).collect(),
            facets: [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(i, j)| facet(i, j))
                .to_vec(),
            pressure: vec![2.0; 9],
            pressure_max: 2.0,
            status: vec![self.status; 9],
            traction: vec![traction; 9],
            area: vec![0.25, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.25],
            slip: vec![Vec3::ZERO; 9],
            facet_size: 1.0,
            ..ContactFrame::default()
        };
        // σ·(−up) is the traction
        let down = -up;
        let across = Mat3::outer(traction, down) + Mat3::outer(down, traction)
            - Mat3::outer(down, down) * traction.dot(down);
        let frame = Frame {
            stress: vec![Sym3::symmetric_part(across * self.stress); 9],
            stress_weight: vec![1.0; 9],
            reaction_force: vec![Vec3::ZERO; 9],
            contacts: vec![of.clone()],
            ..Frame::default()
        };
        let plane = Plane::new(Vec3::ZERO, up).unwrap();
        let plane = Analytical::new(Mount::fixed(2), Box::new(plane)).unwrap();
        let lifted: Vec<Vec3> = x.iter().map(|x| *x + up * 0.4).collect();
        let now = Placement { x: &x, poses: &[] };
        let start = Placement {
            x: &lifted,
            poses: &[],
        };
        let sides = Sides {
            secondary: None,
            primary: &plane,
            now,
            start: self.held.then_some(start),
            reference: &x,
            same: false,
        };
        contact(&of, &frame, &sides, &self.law)
    }

    fn failures(&self) -> Vec<Check> {
        self.audit().failures().map(|f| f.0).collect()
    }
}

#[test]
fn surfaces_that_touch_pass() {
    for held in [false, true] {
        let scene = Scene {
            held,
            ..Scene::default()
        };
        let audit = scene.audit();
        assert_eq!(audit.failures().count(), 0, "{audit:?}");
        assert_eq!(audit.nclosed, 9);
        assert!((audit.force - 8.0).abs() < 1e-12);
    }
}

#[test]
fn pressure_at_a_distance_fails_unless_it_is_prescribed_or_was_there() {
    for held in [false, true] {
        let apart = Scene {
            height: 0.01,
            held,
            ..Scene::default()
        };
        assert_eq!(apart.failures(), [Check::Apart]);
        let audit = apart.audit();
        let measured = audit.of(Check::Apart);
        assert!((measured.worst - 0.01).abs() < 1e-12 && measured.part == 1.0);
        let prescribed = Law {
            shift: -0.01,
            ..Law::default()
        };
        // a pressure of an earlier time
        let moving = Law {
            moved: 0.01,
            ..Law::default()
        };
        for law in [prescribed, moving] {
            let scene = Scene { law, ..apart };
            assert_eq!(scene.failures(), []);
        }
    }
}

#[test]
fn one_corner_that_touches_holds_the_nodes_around_it_only() {
    let scene = Scene {
        heights: [0.0, 0.1, 0.2, 0.1, 0.2, 0.3, 0.2, 0.3, 0.4],
        turn: Mat3::IDENTITY,
        ..Scene::default()
    };
    let audit = scene.audit();
    // the corner, its two neighbours and the middle have 0.25 + 0.5 + 0.5 + 1 of 4
    assert!(
        (audit.of(Check::Apart).part - 1.75 / 4.0).abs() < 1e-12,
        "{audit:?}"
    );
}

#[test]
fn depth_fails_unless_the_law_has_it() {
    let deep = Scene {
        height: -0.1,
        ..Scene::default()
    };
    assert_eq!(deep.failures(), [Check::Through]);
    let soft = Law {
        penalty: Some(20.0),
        ..Law::default()
    };
    let scene = Scene { law: soft, ..deep };
    assert_eq!(scene.failures(), []);
}

#[test]
fn a_soft_law_does_not_excuse_a_gap() {
    let law = Law {
        penalty: Some(20.0),
        ..Law::default()
    };
    let scene = Scene {
        height: 0.01,
        law,
        ..Scene::default()
    };
    assert_eq!(scene.failures(), [Check::Apart]);
}

#[test]
fn shear_is_what_friction_allows() {
    let case = |mu, shear, status| Scene {
        law: Law {
            mu,
            ..Law::default()
        },
        shear,
        status,
        ..Scene::default()
    };
    let (stick, slip) = (Status::Stick, Status::Slip);
    for (mu, shear, status, passes) in [
        (None, 0.0, slip, true),
        (None, 0.3, slip, false),
        (Some(0.5), 1.0, slip, true),
        (Some(0.5), 0.6, slip, false),
        (Some(0.5), 0.0, slip, true),
        (Some(0.5), 0.6, stick, true),
        (Some(0.5), 1.3, stick, false),
    ] {
        let found = case(mu, shear, status).failures();
        let expected: &[Check] = if passes { &[] } else { &[Check::Direction] };
        assert_eq!(found, expected, "{mu:?} {shear} {status:?}");
    }
}

#[test]
fn tractions_without_stress_fail() {
    for (stress, passes) in [(1.0, true), (0.8, true), (0.0, false), (-1.0, false)] {
        for joined in [false, true] {
            let scene = Scene {
                stress,
                status: if joined { Status::Tied } else { Status::Slip },
                law: Law {
                    joined,
                    ..Law::default()
                },
                ..Scene::default()
            };
            let expected: &[Check] = if passes { &[] } else { &[Check::Stress] };
            assert_eq!(scene.failures(), expected, "{stress} {joined}");
        }
    }
}

#[test]
fn jumps_are_judged_by_the_work_from_outside() {
    let frame = |work_jumps, work_turnover| Frame {
        work_jumps,
        work_turnover,
        ..Frame::default()
    };
    assert!(viscous(&frame(0.0, 0.0)).passes());
    assert!(viscous(&frame(0.01, 1.0)).passes());
    assert!(!viscous(&frame(0.1, 1.0)).passes());
}
