//! A block that nothing but contact holds is pushed by another: away, onto a third one, or by a load of its own.
//!
//! SOURCE      Statics of rigid bodies: a motion is determined where some force opposes it (the condition of Fichera for the
//!             problem of Signorini: no load may be free of work in a motion that contact admits on one side only).
//! GOAL        the audit names the body that nothing stops, and no other
//! MESH        unit blocks of triangles, quadrilaterals, tetrahedra or hexahedra, along each axis, of sizes from 1e-3 to 1e3
//! CONDITIONS  the pusher moves by a tenth of its size in two increments; sides swapped; penalty and multipliers; friction
//! EXPECTED    pushed away: not stopped at the end. With a block behind it at 0, 2 or 99 % of the motion, with its end
//!             supported, or pushed by a load onto that block: stopped.
use crate::scene::{Case, Scene};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::audit::stopped;
use std::collections::BTreeMap;

/// What happens to the block in the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// Nothing is behind it.
    Away,
    /// Its end is supported.
    Supported,
    /// A third block is behind it, at this part of the motion.
    Behind(f64),
    /// A load pushes it onto a third block, at this distance.
    Loaded(f64),
}

#[derive(Clone, Copy, Debug)]
struct Push {
    element: &'static str,
    axis: usize,
    size: f64,
    method: &'static str,
    enforcement: &'static str,
    friction: f64,
    swapped: bool,
    end: End,
}

const PENALTY: &str = "\"auto\"";
const LAGRANGE: &str = "{ lagrange = {} }";
const AXES: [&str; 3] = ["x", "y", "z"];
/// The motion over the size.
const MOTION: f64 = 0.1;

impl Push {
    fn ndim(self) -> usize {
        if matches!(self.element, "tri3" | "quad4") {
            2
        } else {
            3
        }
    }

    fn case(self) -> Case {
        let (ndim, size) = (self.ndim(), self.size);
        let mut scene = Scene::default();
        let gap = match self.end {
            End::Behind(part) => Some(part * MOTION * size),
            End::Loaded(distance) => Some(distance * size),
            End::Away | End::Supported => None,
        };
        // from the pusher down; blocks become finer so that no nodes match
        let mut blocks = vec![("pusher", size, 2), ("middle", 0.0, 3)];
        blocks.extend(gap.map(|gap| ("stop", -size - gap, 2)));
        for &(name, from, n) in &blocks {
            let mut counts = [n, n, n];
            if ndim == 2 {
                counts[2] = 0;
            }
            scene.straight(name, self.element, counts, |at| {
                let mut x = Vec3::ZERO;
                for axis in 0..ndim {
                    x[axis] = size * at[axis] as f64 / n as f64;
                }
                x[self.axis] += from;
                x
            });
        }
        let near = 1e-9 * size;
        for (name, block, at) in [
            ("head", "pusher", 2.0 * size),
            ("foot", "pusher", size),
            ("top", "middle", size),
            ("bottom", "middle", 0.0),
            ("floor", "stop", -gap.unwrap_or(0.0)),
            ("base", "stop", -gap.unwrap_or(0.0) - size),
        ] {
            let faces = scene.facets_where(block, |x| (x[self.axis] - at).abs() < near);
            let faces: Vec<(usize, &str)> = faces.iter().map(|(c, s)| (*c, &**s)).collect();
            if !faces.is_empty() {
                scene.faces(name, &faces);
            }
        }
        let across: Vec<usize> = (0..ndim).filter(|axis| *axis != self.axis).collect();
        for &axis in &across {
            let name = AXES[axis];
            scene.place(
                &format!("side_{name}"),
                &format!("plane = \"{name}\", at = 0.0"),
            );
        }
        let space = if ndim == 2 { "plane-strain" } else { "3d" };
        let groups: Vec<&str> = blocks.iter().map(|block| block.0).collect();
        let mut case = scene.elastic(space, 1000.0, 0.3);
        for group in &groups {
            case = case.body(&[*group], "");
        }
        let keys = format!(
            "method = {:?}\nenforcement = {}\nfriction = {:?}",
            self.method, self.enforcement, self.friction
        );
        let side = |one, other| {
            if self.swapped {
                (other, one)
            } else {
                (one, other)
            }
        };
        let loaded = matches!(self.end, End::Loaded(_));
        let pushing = (!loaded).then(|| ("pushing", side("foot", "top")));
        let stopping = gap.map(|_| ("stopping", side("bottom", "floor")));
        for (name, (secondary, primary)) in [pushing, stopping].into_iter().flatten() {
            case = case.also(&format!(
                "[[contact]]\nname = {name:?}\nsecondary = {secondary:?}\nprimary = {primary:?}\n{keys}"
            ));
        }
        let along = AXES[self.axis];
        case = case.step("push", 2);
        for &axis in &across {
            case = case.fix(&format!("side_{}", AXES[axis]), AXES[axis]);
        }
        if gap.is_some() {
            case = case.fix("base", along);
        }
        if self.end == End::Supported {
            case = case.fix("bottom", along);
        }
        let motion = if loaded { 0.0 } else { -MOTION * size };
        case = case.displace("head", &format!("u{along} = {motion:?}"));
        if loaded {
            case = case.load("top", "pressure = 1.0");
        }
        case
    }

    /// Bodies that nothing has stopped at the end, by all frames of a run.
    fn free(self) -> Vec<String> {
        let run = self.case().run();
        let mut free = BTreeMap::new();
        for motion in run.frames.iter().flat_map(|frame| &frame.free_motions) {
            free.insert(motion.bodies.to_string(), stopped(motion));
        }
        let free = free.into_iter().filter(|(_, stopped)| !stopped);
        free.map(|(bodies, _)| bodies).collect()
    }
}

/// Pushes that differ in everything but their ends; every choice appears with each element.
fn pushes(end: End) -> Vec<Push> {
    let mut pushes = Vec::new();
    let laws = [(PENALTY, 0.0), (LAGRANGE, 0.0), (PENALTY, 0.3)];
    let methods = ["mortar", "node-to-segment", "gauss-point"];
    for (k, element) in ["tri3", "quad4", "tet4", "hex8"].into_iter().enumerate() {
        for (m, method) in methods.into_iter().enumerate() {
            let number = 3 * k + m;
            let (law, friction) = laws[(k + m) % laws.len()];
            // multipliers at Gauss points are not built
            let law = if method == "gauss-point" {
                PENALTY
            } else {
                law
            };
            pushes.push(Push {
                element,
                axis: number % if k < 2 { 2 } else { 3 },
                size: [1.0, 1e3, 1e-3][number % 3],
                method,
                enforcement: law,
                friction,
                swapped: number.is_multiple_of(2),
                end,
            });
        }
    }
    pushes
}

#[test]
fn a_block_that_is_pushed_away_is_not_stopped() {
    for push in pushes(End::Away) {
        assert_eq!(push.free(), ["\"middle\""], "{push:?}");
    }
}

#[test]
fn a_block_that_something_stops_is_stopped() {
    let ends = [
        End::Supported,
        End::Behind(0.0),
        End::Behind(0.02),
        End::Behind(0.99),
        End::Loaded(0.0),
        End::Loaded(0.5),
    ];
    for push in ends.into_iter().flat_map(pushes) {
        assert!(push.free().is_empty(), "{push:?}");
    }
}
