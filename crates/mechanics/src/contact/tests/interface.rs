//! Whole interfaces: balance, energy, tangent, rims, verdicts, checkpoints, renumbering.

use super::super::discretization::{Pairing, PointToSegment, SurfacePair};
use super::super::{Interface, InterfaceParts, Measure};
use super::{Random, facets, largest, pair_up, with_mid_nodes};
use crate::system::{
    Adaptive, Archive, Choices, Dof, Elimination, Frame, Layout, NO_DOF, Order, Sink, State,
    Status, Stored, Term, Verdict, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, ContactSurface, Feature, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

const CELLS: u32 = 6;
const POINTS: usize = 150;

/// A warped surface and nodes around it, as an interface with its state.
struct Scene {
    interface: Interface,
    layout: Layout,
    reference: Vec<Vec3>,
    state: State,
}

/// Which facets a surface is made of.
#[derive(Clone, Copy, Debug)]
enum Mixture {
    /// tri3 and quad4.
    Linear,
    /// tri6 and quad8.
    Serendipity,
    /// tri6 and quad9.
    Quadratic,
}

/// Nodes and facets of a warped surface of quadrilaterals and triangles over a square of side `CELLS`.
fn surface(mixture: Mixture, random: &mut Random) -> (Vec<Vec3>, Vec<Vec<NodeId>>) {
    let n = CELLS + 1;
    let node = |k: u32| {
        let (u, v) = (f64::from(k % n), f64::from(k / n));
        Vec3::new(u, v, 0.5 * (0.8 * u).sin() * (0.6 * v).cos()) + random.vector() * 0.25
    };
    let mut x: Vec<Vec3> = (0..n * n).map(node).collect();
    let mut nodes = Vec::new();
    for k in 0..CELLS * CELLS {
        let a = k / CELLS * n + k % CELLS;
        let quad = [a, a + 1, a + n + 1, a + n];
        if k % 3 == 0 {
            nodes.push(vec![quad[0], quad[1], quad[2]]);
            nodes.push(vec![quad[0], quad[2], quad[3]]);
        } else {
            nodes.push(quad.to_vec());
        }
    }
    let ncorner = x.len();
    match mixture {
        Mixture::Linear => {}
        Mixture::Serendipity => with_mid_nodes(&mut x, &mut nodes, false),
        Mixture::Quadratic => with_mid_nodes(&mut x, &mut nodes, true),
    }
    for x in &mut x[ncorner..] {
        *x += random.vector() * 0.1;
    }
    (x, nodes)
}

/// Points above and below the surface, a few past its rim.
fn points(x: &[Vec3], nodes: &[Vec<NodeId>], random: &mut Random) -> Vec<Vec3> {
    let mut around = x.to_vec();
    let surface = facets(&mut around, nodes);
    let at = Placement {
        x: &around,
        poses: &[],
    };
    let mut jet = SurfaceJet::default();
    let mut point = |k: usize| {
        let place = 0.5 * (random.signed() + 1.0) * surface.nfacet() as f64;
        let facet = place as u32;
        let triangle =
            nodes[facet as usize].len().is_multiple_of(3) && nodes[facet as usize].len() < 9;
        let mut local = Vec3::new(random.signed(), random.signed(), 0.0) * 1.01;
        if triangle {
            local = (local + Vec3::new(1.01, 1.01, 0.0)) * 0.25;
        }
        // every third over or under an edge: a valley is closest to points under it
        let on_edge = k.is_multiple_of(3);
        if on_edge {
            local.y = if triangle { 0.0 } else { -1.0 };
        }
        let anchor = Anchor { facet, local };
        surface.jet(&at, &anchor, &mut jet).unwrap();
        let away = if on_edge { Vec3::unit(2) } else { jet.normal };
        jet.position + away * (0.25 * random.signed() - 0.05)
    };
    (0..POINTS).map(&mut point).collect()
}

impl Scene {
    fn new(mut x: Vec<Vec3>, nodes: &[Vec<NodeId>], points: &[Vec3], ndim: usize) -> Self {
        let primary = Arc::new(facets(&mut x, nodes));
        let first = x.len() as NodeId;
        x.extend_from_slice(points);
        let layout = Layout::new(ndim, x.len(), 0);
        let points: Vec<NodeId> = (first..x.len() as NodeId).collect();
        let method = Box::new(PointToSegment::at_nodes(&points));
        let area = (0..points.len()).map(|k| 1.0 + 0.01 * k as f64).collect();
        let pair = SurfacePair::new(points, primary, 1.0);
        let parts = InterfaceParts {
            measure: Measure::Area,
            area,
            ..InterfaceParts::new("touch", pair, method, 7.0)
        };
        let elimination = Arc::new(Elimination::default());
        let state = State::initial(&layout, &x, &elimination);
        let mut interface = Interface::new(parts, layout, elimination);
        interface.prepare(&state, Order::Tangent).unwrap();
        Self {
            interface,
            layout,
            reference: x,
            state,
        }
    }

    fn random(seed: u64) -> Self {
        Self::mixed(Mixture::Linear, seed)
    }

    fn mixed(mixture: Mixture, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let (x, nodes) = surface(mixture, &mut random);
        let points = points(&x, &nodes, &mut random);
        Self::new(x, &nodes, &points, 3)
    }

    fn moved(&self, direction: &[f64], by: f64) -> State {
        let mut state = self.state.clone();
        let nothing = Elimination::default();
        state.advance_from(
            &self.state,
            direction,
            by,
            &self.layout,
            &self.reference,
            &nothing,
        );
        state
    }

    /// Force and tangent times direction at a state, after a search of its own; the energy.
    fn respond(&mut self, state: &State, direction: &[f64]) -> (Response, f64) {
        self.interface.prepare(state, Order::Tangent).unwrap();
        let mut work = Work::default();
        let mut sum = Response::new(direction);
        let mut energy = 0.0;
        for chunk in 0..self.interface.nchunk() {
            self.interface
                .evaluate(chunk, state, Order::Tangent, &mut work, &mut sum)
                .unwrap();
            let part = self.interface.energy(chunk, state, &mut work);
            energy += part.unwrap().unwrap();
        }
        (sum, energy)
    }

    fn force(&mut self) -> Vec<f64> {
        let (state, still) = (self.state.clone(), vec![0.0; self.layout.ndof()]);
        self.respond(&state, &still).0.force
    }
}

/// Everything that comes in, added up.
struct Response {
    direction: Vec<f64>,
    force: Vec<f64>,
    along: Vec<f64>,
}

impl Response {
    fn new(direction: &[f64]) -> Self {
        let zero = vec![0.0; direction.len()];
        Self {
            direction: direction.to_vec(),
            force: zero.clone(),
            along: zero,
        }
    }
}

impl Sink for Response {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = dofs.len();
        for (i, &p) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
            self.force[p as usize] += force[i];
            for (j, &q) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
                self.along[p as usize] += stiffness[i * n + j] * self.direction[q as usize];
            }
        }
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn agree(a: &Pairing, b: &Pairing) -> bool {
    let rows = a.pairs.iter().zip(&b.pairs);
    rows.into_iter().all(|pair| match pair {
        (Some(a), Some(b)) => a.agrees(b),
        (a, b) => a.is_none() && b.is_none(),
    })
}

#[test]
fn an_interface_balances_forces_and_moments() {
    let mut on_edges = 0;
    for seed in 1..=10 {
        let mut scene = Scene::random(seed);
        let f = scene.force();
        let (mut force, mut moment, mut size) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        for (f, &x) in f.chunks_exact(3).zip(&scene.state.x) {
            let f = Vec3::new(f[0], f[1], f[2]);
            force += f;
            moment += x.cross(f);
            size += f.norm();
        }
        assert!(size > 50.0, "many nodes touch");
        assert!(force.norm() < 1e-13 * size, "{force:?} of {size}");
        let arm = f64::from(CELLS);
        assert!(moment.norm() < 1e-13 * arm * size, "{moment:?} of {size}");

        let pairs = scene.interface.pairing().pairs.iter().flatten();
        let inside: Vec<_> = pairs.filter(|p| p.gap < 0.0).collect();
        let is_edge = |f: &Feature| matches!(f, Feature::Edge { .. });
        on_edges += inside.iter().filter(|p| is_edge(&p.feature)).count();

        // reported forces are those that act
        let mut frame = Frame::new(scene.layout.nnode(), &[]);
        scene.interface.report(&scene.state, &mut frame).unwrap();
        let report = &frame.contacts[0];
        let sum = report.secondary.force + report.primary.force;
        let turn = report.secondary.moment + report.primary.moment;
        assert!(sum.norm() < 1e-13 * size && turn.norm() < 1e-13 * arm * size);
        let closed = report.status.iter().filter(|s| **s == Status::Slip).count();
        assert_eq!(closed, inside.len());
        let pressed = report.moment_normal - report.secondary.moment;
        assert!(pressed.norm() < 1e-13 * arm * size, "nothing rubs");
        let chunks = 0..scene.interface.nchunk();
        let work = &mut Work::default();
        let energy = chunks.map(|c| {
            scene
                .interface
                .energy(c, &scene.state, work)
                .unwrap()
                .unwrap()
        });
        let (energy, stored) = (energy.sum::<f64>(), report.energy.iter().sum::<f64>());
        assert!(
            (energy - stored).abs() < 1e-13 * energy,
            "{stored} of {energy}"
        );
        for (k, normal) in report.normal.iter().enumerate() {
            let across = report.traction[k] - *normal * report.pressure[k];
            assert!(report.pressure[k] == 0.0 || (normal.norm() - 1.0).abs() < 1e-14);
            assert!(
                across.norm() < 1e-13 * report.pressure_max,
                "a point is a node"
            );
        }
    }
    assert!(on_edges > 10, "{on_edges}");
}

#[test]
fn an_interface_has_the_force_of_its_energy_and_the_tangent_of_its_force() {
    for mixture in [Mixture::Linear, Mixture::Serendipity, Mixture::Quadratic] {
        follows_from_energy(mixture);
    }
}

fn follows_from_energy(mixture: Mixture) {
    let mut tried = 0;
    for seed in 1..=4 {
        let mut scene = Scene::mixed(mixture, seed);
        let mut random = Random::new(100 + seed);
        for _ in 0..6 {
            let v: Vec<f64> = (0..scene.layout.ndof()).map(|_| random.signed()).collect();
            let base = scene.state.clone();
            let (here, _) = scene.respond(&base, &v);
            let pairing = scene.interface.pairing().clone();
            let h = 1e-5;
            let mut slope = 0.0;
            let mut change = vec![0.0; v.len()];
            let mut same = true;
            for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let there = scene.moved(&v, step * h);
                let (response, energy) = scene.respond(&there, &v);
                same &= agree(&pairing, scene.interface.pairing());
                slope += weight * energy / (12.0 * h);
                for (c, f) in change.iter_mut().zip(&response.force) {
                    *c += weight * f / (12.0 * h);
                }
            }
            // the tangent jumps where a node goes over from one facet to the next
            if !same {
                continue;
            }
            tried += 1;
            let power = dot(&here.force, &v);
            assert!((slope - power).abs() < 1e-7 * power.abs().max(1.0));
            let error = here.along.iter().zip(&change).map(|(a, b)| a - b);
            let error = largest(&error.collect::<Vec<_>>());
            assert!(error < 1e-7 * largest(&here.along), "{error:e}");
        }
    }
    assert!(tried >= 12, "{mixture:?}: {tried}");
}

/// Whether a point touches a flat square of side 2 made of four facets (in the plane: a line of two).
fn touches(nnode: usize, point: Vec3) -> bool {
    let (x, nodes): (Vec<Vec3>, Vec<Vec<NodeId>>) = if nnode == 2 {
        let at = [2.0, 1.0, 0.0].map(|u| Vec3::new(u, 0.0, 0.0));
        (at.to_vec(), vec![vec![0, 1], vec![1, 2]])
    } else {
        let node = |k: u32| Vec3::new(f64::from(k % 3), f64::from(k / 3), 0.0);
        let quads = [0, 1, 3, 4].map(|k| vec![k, k + 1, k + 4, k + 3]);
        let halves = quads
            .iter()
            .flat_map(|q| [vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]]);
        let nodes = if nnode == 3 {
            halves.collect()
        } else {
            quads.to_vec()
        };
        ((0..9).map(node).collect(), nodes)
    };
    let ndim = if nnode == 2 { 2 } else { 3 };
    let mut scene = Scene::new(x, &nodes, &[point], ndim);
    let force = scene.force();
    let normal = ndim - 1;
    let node = scene.layout.node(scene.layout.nnode() as NodeId - 1, 0) as usize;
    let sideways: f64 = (0..normal).map(|c| force[node + c].abs()).sum();
    assert!(sideways < 1e-12, "a flat surface pushes along its normal");
    let pushed = force[node + normal];
    assert!(pushed == 0.0 || (pushed - 7.0 * point[normal]).abs() < 1e-12);
    pushed < 0.0
}

#[test]
fn a_point_two_per_cent_past_the_rim_touches_and_one_twenty_per_cent_past_does_not() {
    for nnode in [2, 3, 4] {
        for (past, expected) in [(-0.02, true), (0.0, true), (0.02, true), (0.2, false)] {
            if nnode == 2 {
                for u in [-past, 2.0 + past] {
                    assert_eq!(touches(2, Vec3::new(u, -0.01, 0.0)), expected, "{u}");
                    assert!(!touches(2, Vec3::new(u, 0.01, 0.0)));
                }
                continue;
            }
            // inside a rim edge, and abreast of the nodes: corners of the rim, and where two facets meet there
            for along in [0.37, 1.0, 1.0 + 1e-12, 1.0 - 1e-12, 0.0, 1e-10, 2.0] {
                for u in [-past, 2.0 + past] {
                    for below in [Vec3::new(u, along, -0.01), Vec3::new(along, u, -0.01)] {
                        assert_eq!(touches(nnode, below), expected, "{nnode}: {below:?}");
                        assert!(!touches(nnode, below + Vec3::unit(2) * 0.02));
                    }
                }
            }
        }
    }
}

/// The force on a point under a valley of two facets along `y`, each rising to its side at 45 degrees.
fn under_a_valley(point: Vec3) -> Vec3 {
    let node = |k: u32| {
        let u = f64::from(k % 3) - 1.0;
        Vec3::new(u, f64::from(k / 3), u.abs())
    };
    let nodes = [vec![0, 1, 4, 3], vec![1, 2, 5, 4]];
    let mut scene = Scene::new((0..6).map(node).collect(), &nodes, &[point], 3);
    let force = scene.force();
    let node = scene.layout.node(scene.layout.nnode() as NodeId - 1, 0) as usize;
    Vec3::new(force[node], force[node + 1], force[node + 2])
}

#[test]
fn a_valley_holds_up_to_the_rim_and_just_past_it() {
    for along in [0.5, 0.01, 1e-10, 0.0, -1e-15, -1e-10, -0.005, -0.02] {
        for depth in [0.01, 0.1] {
            for y in [along, 1.0 - along] {
                let force = under_a_valley(Vec3::new(0.0, y, -depth));
                let expected = Vec3::new(0.0, 0.0, -7.0 * depth);
                assert!(
                    (force - expected).max_abs() < 1e-12,
                    "{y} {depth}: {force:?}"
                );
            }
        }
    }
    for y in [-0.2, 1.2] {
        assert_eq!(under_a_valley(Vec3::new(0.0, y, -0.1)), Vec3::ZERO);
    }
}

#[test]
fn a_verdict_repeats_until_the_choices_stay() {
    let mut scene = Scene::random(1);
    let inside = scene.interface.pairing().pairs.iter().flatten();
    let inside = inside.filter(|p| p.gap < 0.0).count();
    let state = scene.state.clone();
    let Verdict::Repeat {
        changes,
        closing,
        continuous,
        why,
        nodes,
    } = scene.interface.verdict(&state)
    else {
        panic!("nodes touch that did not before");
    };
    assert_eq!((changes, closing, continuous), (inside, true, true));
    assert!(why.contains("\"touch\"") && why.contains(&format!("{inside} closed")));
    assert!(
        !nodes.is_empty()
            && nodes
                .iter()
                .all(|n| scene.interface.parts().pair.points.contains(n))
    );
    scene.interface.prepare(&state, Order::Tangent).unwrap();
    assert_eq!(scene.interface.verdict(&state), Verdict::Settled);

    // one node leaves
    let pairs = scene.interface.pairing().pairs.iter();
    let row = pairs
        .enumerate()
        .find(|(_, p)| p.is_some_and(|p| p.gap < 0.0 && p.feature == Feature::Face));
    let row = row.unwrap().0;
    let node = scene.interface.parts().pair.points[row];
    let mut up = vec![0.0; scene.layout.ndof()];
    up[scene.layout.node(node, 2) as usize] = 0.9;
    let gone = scene.moved(&up, 1.0);
    scene.interface.prepare(&gone, Order::Tangent).unwrap();
    let Verdict::Repeat {
        changes,
        closing,
        continuous,
        why,
        nodes,
    } = scene.interface.verdict(&gone)
    else {
        panic!("a node has left");
    };
    assert_eq!((changes, closing, continuous), (1, false, true));
    assert_eq!(nodes, vec![node]);
    assert!(why.contains("1 opened"), "{why}");

    // an open node that stays open is no news, wherever it goes
    let further = scene.moved(&up, 1.3);
    scene.interface.prepare(&further, Order::Tangent).unwrap();
    assert_eq!(scene.interface.verdict(&further), Verdict::Settled);

    // back to what was accepted: nothing at all
    scene.interface.reject();
    assert!(scene.interface.pairing().pairs.iter().all(Option::is_none));
}

#[test]
fn a_loaded_interface_goes_on_with_the_same_choices() {
    let mut scene = Scene::random(2);
    let state = scene.state.clone();
    scene.interface.verdict(&state);
    scene.interface.accept(&state).unwrap();
    let mut archive = Archive::default();
    scene.interface.save(&mut archive);
    let mut other = Scene::random(2);
    other.interface.reject();
    assert!(other.interface.pairing().pairs.iter().all(Option::is_none));
    other.interface.load(&archive).unwrap();
    assert_eq!(other.interface.pairing(), scene.interface.pairing());

    // from there on they are the same, bit by bit
    let mut random = Random::new(9);
    for _ in 0..5 {
        let v: Vec<f64> = (0..scene.layout.ndof()).map(|_| random.signed()).collect();
        let next = scene.moved(&v, 0.03);
        let (a, ea) = scene.respond(&next, &v);
        let (b, eb) = other.respond(&next, &v);
        assert_eq!(scene.interface.pairing(), other.interface.pairing());
        assert_eq!((a.force, a.along, ea), (b.force, b.along, eb));
        assert_eq!(
            scene.interface.verdict(&next),
            other.interface.verdict(&next)
        );
    }

    let mut short = Archive::default();
    short.put("contact.touch.pairs", &[0.0; 8]);
    short.put("contact.touch.coupled", &[0.0; 1]);
    assert!(other.interface.load(&short).is_err());
    assert!(other.interface.load(&Archive::default()).is_err());
}

#[test]
fn results_do_not_depend_on_the_order_of_facets() {
    for seed in 1..=5 {
        let mut random = Random::new(seed);
        let (x, mut nodes) = surface(Mixture::Linear, &mut random);
        let points = points(&x, &nodes, &mut random);
        let mut scene = Scene::new(x.clone(), &nodes, &points, 3);
        let (force, pairs) = (scene.force(), scene.interface.pairing().clone());
        for k in (1..nodes.len()).rev() {
            nodes.swap(
                k,
                ((random.signed() + 1.0) * 0.5 * (k + 1) as f64) as usize % (k + 1),
            );
        }
        // the first node of a facet is arbitrary, too
        for n in &mut nodes {
            n.rotate_left(1);
        }
        let mut other = Scene::new(x, &nodes, &points, 3);
        let shuffled = other.force();
        let error = force.iter().zip(&shuffled).map(|(a, b)| a - b);
        let error = largest(&error.collect::<Vec<_>>());
        assert!(error < 1e-11 * largest(&force), "{error:e}");
        for (a, b) in pairs.pairs.iter().zip(&other.interface.pairing().pairs) {
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a.gap - b.gap).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn results_do_not_depend_on_how_many_candidates_there_are() {
    let scene = Scene::random(6);
    let pair = &scene.interface.parts().pair;
    let method = PointToSegment::at_nodes(&scene.interface.parts().pair.points);
    let at = scene.state.placement();
    let few = pair_up(&method, pair, &at, pair.reach);
    assert_eq!(&few, scene.interface.pairing());
    for range in [1.5, 3.0, 100.0] {
        assert_eq!(few, pair_up(&method, pair, &at, range));
    }
}
