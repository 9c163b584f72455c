//! Sides that are joined where supports and planes of symmetry hold their nodes: uniform stress stays uniform.

use crate::common::{Run, run};
use signorini::{Compat, Loaded, Reading, build, load};
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_io::case::{
    Directions, Enforcement, Free, Method, Offset, Set, SetContent, Step, Tied,
};
use signorini_io::diagnostic::Place;
use std::collections::BTreeMap;
use std::fmt::Write;

const E: f64 = 210_000.0;
const NU: f64 = 0.3;
/// What the far end of two blocks of length 1 each moves, with a cross-section of 2, or 2 by 2.
const STRETCH: f64 = 0.002;

/// Two blocks on top of each other that are joined.
#[derive(Clone, Debug)]
struct Stack {
    ndim: usize,
    quadratic: bool,
    /// Elements of the lower and of the upper block in each direction across.
    across: [usize; 2],
    /// Across which directions, from 0, a plane of symmetry holds nodes, and whether at the far side.
    planes: Vec<(usize, bool)>,
    /// Whether only the upper block has these supports.
    upper_only: bool,
    /// By how many directions the axes are exchanged in a cycle.
    cycle: usize,
    /// A turn of everything, in degrees.
    turn: f64,
    /// Whether the lower block is the secondary side.
    swapped: bool,
    joint: &'static str,
    /// Whether all outer nodes are moved as a field is that stretches and shears, in place of all supports.
    sheared: bool,
}

const BY_TIE: &str = "*TIE, NAME=T\nSEC, PRI\n";
const BY_PAIR: &str = "*CONTACT PAIR, INTERACTION=C, TYPE=SURFACE TO SURFACE\nSEC, PRI\n*SURFACE INTERACTION, NAME=C\n\
                       *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.e7\n*FRICTION\n1., 1.e7\n";

impl Stack {
    /// The direction in which it is stretched; before the turn.
    fn axis(&self) -> usize {
        (self.ndim - 1 + self.cycle) % self.ndim
    }

    /// A place with the stretched direction last, in the axes before the turn.
    fn cycled(&self, x: Vec3) -> Vec3 {
        let mut y = Vec3::ZERO;
        for k in 0..self.ndim {
            y[(k + self.cycle) % self.ndim] = x[k];
        }
        y
    }

    fn rotation(&self) -> Mat3 {
        Mat3::rotation(Vec3::unit(2) * self.turn.to_radians())
    }

    /// The displacement of a place of uniform stress along the axis, both with the stretched direction last.
    fn exact(&self, x: Vec3) -> Vec3 {
        let strain = 0.5 * STRETCH;
        let mut u = Vec3::ZERO;
        if self.sheared {
            let along = [0.7, 0.3, 1.0];
            for (k, along) in along.into_iter().enumerate().take(self.ndim) {
                let across = 0.2 * (k + 1) as f64 * x[0];
                u[k] = strain * (along * x[self.ndim - 1] + across);
            }
            return u;
        }
        for k in 0..self.ndim - 1 {
            let far = self.planes.contains(&(k, true));
            u[k] = -NU * strain * (x[k] - if far { 2.0 } else { 0.0 });
        }
        u[self.ndim - 1] = strain * x[self.ndim - 1];
        u
    }

    /// Places of the nodes of both blocks, their elements, and the sides that meet.
    fn mesh(&self) -> (Vec<Vec3>, [Vec<Vec<usize>>; 2]) {
        let mut points: Vec<Vec3> = Vec::new();
        let mut blocks = [Vec::new(), Vec::new()];
        let last = self.ndim - 1;
        for (block, elements) in blocks.iter_mut().enumerate() {
            let n = self.across[block];
            let mut known: BTreeMap<[usize; 3], usize> = BTreeMap::new();
            let mut node = |at: [usize; 3]| {
                *known.entry(at).or_insert_with(|| {
                    let mut x = Vec3::ZERO;
                    for (k, at) in at.iter().enumerate().take(last) {
                        x[k] = *at as f64 / n as f64;
                    }
                    x[last] = block as f64 + 0.5 * at[last] as f64;
                    points.push(x);
                    points.len() - 1
                })
            };
            let cells = n.pow(last as u32);
            for cell in 0..cells {
                let mut low = [0; 3];
                (low[0], low[1]) = (
                    2 * (cell % n),
                    if self.ndim == 3 { 2 * (cell / n) } else { 0 },
                );
                let at = |[i, j, k]: [usize; 3]| [low[0] + i, low[1] + j, low[2] + k];
                elements.push(self.places().iter().map(|&of| node(at(of))).collect());
            }
        }
        (points, blocks)
    }

    /// Places of the nodes of an element in halves of its edges.
    fn places(&self) -> Vec<[usize; 3]> {
        let (corners, edges): (Vec<[usize; 3]>, Vec<[usize; 2]>) = if self.ndim == 2 {
            let corners = vec![[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]];
            (corners, vec![[0, 1], [1, 2], [2, 3], [3, 0]])
        } else {
            let ring = [[0, 0], [2, 0], [2, 2], [0, 2]];
            let corners = [0, 2]
                .into_iter()
                .flat_map(|k| ring.map(|[i, j]| [i, j, k]));
            let level = |first: usize| (0..4).map(move |k| [first + k, first + (k + 1) % 4]);
            let edges = level(0).chain(level(4)).chain((0..4).map(|k| [k, k + 4]));
            (corners.collect(), edges.collect())
        };
        let mut all = corners.clone();
        if self.quadratic {
            let middle =
                |[a, b]: [usize; 2]| std::array::from_fn(|k| (corners[a][k] + corners[b][k]) / 2);
            all.extend(edges.into_iter().map(middle));
        }
        all
    }

    fn deck(&self) -> String {
        let (points, blocks) = self.mesh();
        let last = self.ndim - 1;
        let mut deck = String::from("*NODE, NSET=NALL\n");
        for (k, x) in points.iter().enumerate() {
            let x = self.rotation() * self.cycled(*x);
            let _ = writeln!(deck, "{}, {:.17}, {:.17}, {:.17}", k + 1, x.x, x.y, x.z);
        }
        let kind = match (self.ndim, self.quadratic) {
            (2, false) => "CPS4",
            (2, true) => "CPS8",
            (_, false) => "C3D8",
            (_, true) => "C3D20",
        };
        let mut number = 0;
        for (elements, name) in blocks.iter().zip(["A", "B"]) {
            let _ = writeln!(deck, "*ELEMENT, TYPE={kind}, ELSET={name}");
            for nodes in elements {
                number += 1;
                let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
                let (first, rest) = nodes.split_at(nodes.len().min(10));
                let _ = write!(deck, "{number}, {}", first.join(", "));
                let more = if rest.is_empty() {
                    String::new()
                } else {
                    format!(",\n{}", rest.join(", "))
                };
                let _ = writeln!(deck, "{more}");
            }
        }
        let sides = if self.ndim == 2 {
            ["S3", "S1"]
        } else {
            ["S2", "S1"]
        };
        let names = if self.swapped {
            ["SEC", "PRI"]
        } else {
            ["PRI", "SEC"]
        };
        for ((elements, side), name) in ["A", "B"].into_iter().zip(sides).zip(names) {
            let _ = writeln!(deck, "*SURFACE, NAME={name}\n{elements}, {side}");
        }
        deck.push_str("*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n*SOLID SECTION, ELSET=A, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=B, MATERIAL=M\n1.\n");
        deck.push_str(self.joint);
        if self.turn != 0.0 {
            let [x, y] = [0, 1].map(|k| self.rotation() * Vec3::unit(k));
            let _ = writeln!(
                deck,
                "*TRANSFORM, NSET=NALL\n{}, {}, {}, {}, {}, {}",
                x.x, x.y, x.z, y.x, y.y, y.z
            );
        }
        let nlower = blocks[0].iter().flatten().max().map_or(0, |node| node + 1);
        let prescribe = |of: &dyn Fn(usize, Vec3) -> bool,
                         direction: usize,
                         to: &dyn Fn(Vec3) -> f64| {
            let dof = (direction + self.cycle) % self.ndim + 1;
            let nodes = points.iter().enumerate().filter(|(k, x)| of(*k, **x));
            let lines = nodes.map(|(k, x)| format!("{}, {dof}, {dof}, {:.17}\n", k + 1, to(*x)));
            lines.collect::<String>()
        };
        let hold = |of: &dyn Fn(usize, Vec3) -> bool, direction: usize, value: f64| {
            prescribe(of, direction, &|_| value)
        };
        if self.sheared {
            deck.push_str("*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n");
            let is_end = |x: f64| x == 0.0 || x == 2.0;
            let outer = |_, x: Vec3| (0..self.ndim).any(|k| is_end(x[k]));
            for direction in 0..self.ndim {
                deck.push_str(&prescribe(&outer, direction, &|x| self.exact(x)[direction]));
            }
            deck.push_str("*END STEP\n");
            return deck;
        }
        deck.push_str("*BOUNDARY\n");
        deck.push_str(&hold(&|_, x| x[last] == 0.0, last, 0.0));
        for &(direction, far) in &self.planes {
            let at = if far { 2.0 } else { 0.0 };
            let held = |k, x: Vec3| x[direction] == at && (!self.upper_only || k >= nlower);
            deck.push_str(&hold(&held, direction, 0.0));
        }
        for direction in (0..last).filter(|d| self.planes.iter().all(|(k, _)| k != d)) {
            // one node keeps motions away along which nothing else is held
            deck.push_str(&hold(&|_, x| x == Vec3::ZERO, direction, 0.0));
        }
        deck.push_str("*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n");
        deck.push_str(&hold(&|_, x| x[last] == 2.0, last, STRETCH));
        deck.push_str("*END STEP\n");
        deck
    }

    fn loaded(&self, compat: Compat) -> Loaded {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("deck.inp");
        std::fs::write(&path, self.deck()).unwrap();
        let reading = Reading {
            compat: Some(compat),
            ..Reading::default()
        };
        load(&path, &reading).unwrap_or_else(|found| panic!("{self:?}\n{}", found.plain()))
    }

    /// The largest error of the force of the joint and of displacements, over their largest values.
    fn errors(&self, loaded: Loaded) -> [f64; 2] {
        let of_force = if self.sheared { 0.0 } else { 1.0 };
        let mut model =
            build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{self:?}\n{}", e.plain()));
        let done: Run = run(&mut model);
        assert!(done.error.is_none(), "{self:?}: {:?}", done.error);
        let frame = done.frames.last().unwrap();
        let area = if self.ndim == 2 { 2.0 } else { 4.0 };
        let force = 0.5 * E * STRETCH * area;
        let along = self.rotation() * Vec3::unit(self.axis());
        let sign = if self.swapped { 1.0 } else { -1.0 };
        let of_joint = frame.contacts[0].secondary.force;
        let (points, _) = self.mesh();
        let errors = points.iter().zip(&frame.displacement).map(|(x, u)| {
            let exact = self.rotation() * self.cycled(self.exact(*x));
            (exact - *u).max_abs()
        });
        [
            of_force * (of_joint - along * (sign * force)).max_abs() / force,
            errors.fold(0.0, f64::max) / STRETCH,
        ]
    }
}

/// Stacks of every kind: both sides finer, planes of symmetry across any direction and across several, at either end.
fn stacks() -> Vec<Stack> {
    let mut all = Vec::new();
    for ndim in [2, 3] {
        let planes: &[&[(usize, bool)]] = match ndim {
            2 => &[&[(0, false)], &[(0, true)]],
            _ => &[
                &[(0, false)],
                &[(1, true)],
                &[(0, false), (1, false)],
                &[(0, true), (1, false)],
            ],
        };
        for quadratic in [false, true] {
            for across in [[2, 3], [3, 2], [2, 2], [1, 3]] {
                for &planes in planes {
                    all.push(Stack {
                        ndim,
                        quadratic,
                        across,
                        planes: planes.to_vec(),
                        upper_only: false,
                        // in the plane that would be a mirror
                        cycle: if ndim == 3 { all.len() % 3 } else { 0 },
                        turn: 0.0,
                        swapped: all.len() % 3 == 0,
                        joint: BY_TIE,
                        sheared: false,
                    });
                }
            }
        }
    }
    all
}

fn uniform(stack: &Stack, loaded: Loaded, tolerance: f64) {
    let errors = stack.errors(loaded);
    assert!(
        errors.iter().all(|error| *error < tolerance),
        "{stack:?}: {errors:?}"
    );
}

#[test]
fn a_tie_on_planes_of_symmetry_carries_uniform_stress() {
    for stack in stacks() {
        uniform(&stack, stack.loaded(Compat::None), 1e-8);
    }
}

#[test]
fn so_does_a_pair_that_is_tied() {
    for stack in stacks().into_iter().step_by(3) {
        let stack = Stack {
            joint: BY_PAIR,
            ..stack
        };
        uniform(&stack, stack.loaded(Compat::None), 1e-8);
    }
}

#[test]
fn so_does_a_joint_on_planes_that_lie_along_no_axis() {
    for stack in stacks().into_iter().step_by(2) {
        for turn in [30.0, 90.0] {
            let stack = Stack {
                turn,
                ..stack.clone()
            };
            uniform(&stack, stack.loaded(Compat::None), 1e-8);
        }
    }
}

#[test]
fn so_does_a_joint_of_which_one_side_alone_is_held() {
    for stack in stacks().into_iter().step_by(2) {
        let stack = Stack {
            upper_only: true,
            ..stack
        };
        uniform(&stack, stack.loaded(Compat::None), 1e-8);
    }
}

/// Nodes on nodes pass on forces as they are; where the law of CalculiX joins nodes to facets, they may.
#[test]
fn nodes_of_matching_meshes_are_joined_by_multipliers_and_in_the_way_of_calculix() {
    for stack in stacks()
        .into_iter()
        .filter(|stack| stack.across[0] == stack.across[1])
    {
        let mut by_nodes = stack.loaded(Compat::None);
        for contact in &mut by_nodes.case.contacts {
            contact.method = Method::NodeToSegment.into();
            contact.enforcement = Enforcement::Lagrange;
            contact.tied = Some(Tied {
                offset: Offset::Keep,
                ..Tied::default()
            });
        }
        uniform(&stack, by_nodes, 1e-8);
        // of quadratic elements in the plane CalculiX ties corners alone
        if stack.ndim == 3 || !stack.quadratic {
            uniform(&stack, stack.loaded(Compat::Ccx), 1e-8);
        }
    }
}

/// Whatever a case says of its own: `tied = true` and every method.
#[test]
fn cases_join_sides_on_planes_of_symmetry_by_any_means() {
    for (k, stack) in stacks().into_iter().step_by(3).enumerate() {
        let mut loaded = stack.loaded(Compat::None);
        for contact in &mut loaded.case.contacts {
            contact.tied = Some(Tied::default());
            contact.method = [Method::Auto, Method::Mortar][k % 2].into();
        }
        uniform(&stack, loaded, 1e-8);
    }
}

#[test]
fn a_joint_passes_shear_where_all_nodes_around_it_are_moved() {
    // facets whose nodes are all moved are joined at nodes, which transfer uniform stress on matching meshes only
    let follows = |stack: &Stack| stack.planes.len() == 1 && stack.across[0] > 1;
    for stack in stacks().into_iter().filter(follows) {
        for swapped in [false, true] {
            let stack = Stack {
                sheared: true,
                swapped,
                ..stack.clone()
            };
            uniform(&stack, stack.loaded(Compat::None), 1e-8);
        }
    }
}

/// The second step sets the upper block free: nodes of the joint that were held have their own rows again.
#[test]
fn a_joint_follows_supports_that_change_from_step_to_step() {
    for stack in stacks().into_iter().step_by(4) {
        let mut loaded = stack.loaded(Compat::None);
        let (points, blocks) = stack.mesh();
        let first = blocks[1].iter().flatten().min().unwrap();
        let upper = points.iter().enumerate().skip(*first);
        let upper = upper.filter(|(_, x)| x[stack.ndim - 1] < 2.0);
        loaded.case.sets.push(Set {
            name: "upper".to_owned().into(),
            content: SetContent::Nodes(upper.map(|(k, _)| k as u64 + 1).collect()),
            place: Place::nowhere(),
        });
        let mut u = Directions::default();
        for (direction, _) in &stack.planes {
            u.xyz[(direction + stack.cycle) % stack.ndim] = true;
        }
        let held = loaded.case.steps[0].clone();
        loaded.case.steps.push(Step {
            name: "upper block is free".to_owned().into(),
            fixes: Vec::new(),
            moves: Vec::new(),
            frees: vec![Free {
                on: "upper".to_owned().into(),
                u,
                rot: Directions::default(),
                temperature: false,
                place: Place::nowhere(),
            }],
            ..held
        });
        uniform(&stack, loaded, 1e-8);
    }
}
