//! Every method with every law, every friction and every kind of facet: tangents against differences, balance,
//! symmetry, and whether the pattern holds what comes.

use super::super::friction::{Coulomb, Falling, FrictionLaw, Stick, Tresca};
use super::super::law::{
    Arctangent, AugmentedNewton, ContactLaw, Exponential, Gasket, Lagrange, Multiplier, Penalty,
    Table, Uzawa,
};
use super::scene::{Choice, Kind, Method, PENALTY, Scene};
use super::{Random, largest, next_increment};
use crate::system::{Choices, Order, Term};
use signorini_geometry::surface::Carrier;
use signorini_geometry::tensor::Vec3;
use std::ops::Range;
use std::sync::Arc;

pub(super) fn laws() -> Vec<Box<dyn ContactLaw>> {
    let rows = vec![[-0.2, 2.0], [-0.06, 0.5], [-0.01, 0.2], [0.02, 0.0]];
    vec![
        Box::new(Penalty),
        Box::new(Table::new(rows).unwrap()),
        Box::new(Exponential {
            p0: 0.3,
            c0: 0.08,
            within: f64::INFINITY,
        }),
        Box::new(Arctangent {
            stiffness: 3.0,
            tension: 0.02,
            within: 0.5,
        }),
        Box::new(Uzawa),
        Box::new(AugmentedNewton),
        Box::new(Lagrange),
        Box::new(gasket()),
    ]
}

/// The place of the gasket among the laws.
const GASKET: usize = 7;

fn gasket() -> Gasket {
    let loading = vec![[0.0, 0.0], [0.01, 0.2], [0.06, 0.5], [0.2, 2.0]];
    let opening = vec![[0.05, 0.0], [0.15, 0.3], [0.2, 2.0]];
    Gasket::new(loading, vec![(0.2, opening)], None, 0.0).unwrap()
}

pub(super) type Friction = Option<(Arc<dyn FrictionLaw>, Stick)>;

pub(super) fn frictions() -> Vec<Friction> {
    let falling = Falling {
        stationary: 0.5,
        kinetic: 0.2,
        transition: 0.2,
    };
    let coulomb = |cap| Coulomb { mu: 0.4, cap };
    let laws: [Arc<dyn FrictionLaw>; 4] = [
        Arc::new(coulomb(f64::INFINITY)),
        Arc::new(coulomb(0.15)),
        Arc::new(Tresca(0.2)),
        Arc::new(falling),
    ];
    let sticks = [Stick::Stiffness(3.0), Stick::Slip(0.04)];
    let rough = laws.iter().flat_map(|law| {
        let of_law = sticks.map(|stick| Some((law.clone(), stick)));
        of_law.into_iter()
    });
    std::iter::once(None).chain(rough).collect()
}

pub(super) fn methods(kind: Kind) -> Vec<Method> {
    let on_surfaces = vec![
        Method::NodeToSegment,
        Method::SmallSliding,
        Method::OfIncrement,
    ];
    let on_facets = vec![
        Method::Gauss,
        Method::Lobatto,
        Method::GivenNormals,
        Method::PrimaryNormals,
        Method::SecondaryNormals,
        Method::Mortar,
        Method::NodalMortar,
        Method::HeldMortar,
    ];
    match kind {
        Kind::Elements(_) => [on_surfaces, on_facets].concat(),
        _ => on_surfaces,
    }
}

/// Which states occurred.
#[derive(Default)]
struct Seen {
    open: bool,
    stick: bool,
    slip: bool,
    tied: bool,
    elsewhere: bool,
}

/// The worst relative error of the tangent in the rows of displacements, and in those of multipliers.
#[derive(Default)]
pub(super) struct Worst {
    pub displacement: f64,
    pub multiplier: f64,
    pub tried: usize,
}

impl Worst {
    fn add(&mut self, other: &Self) {
        self.displacement = self.displacement.max(other.displacement);
        self.multiplier = self.multiplier.max(other.multiplier);
        self.tried += other.tried;
    }
}

/// Small enough to stay clear of the kinks of tables and caps, which no verdict reports.
const STEP: f64 = 5e-6;

/// Whether the stiffness jumps where [`tangent_error`] takes differences of forces: at the largest closure so far of a gasket, say.
pub(super) fn has_kink(scene: &mut Scene, seed: u64) -> bool {
    let mut random = Random::new(seed);
    let n = scene.layout.ndof();
    let first = n - scene.layout.nmultiplier();
    [0..first, first..n].into_iter().any(|part| {
        let mut v = vec![0.0; n];
        v[part].fill_with(|| random.signed());
        let [before, after] = [-2.0, 2.0].map(|step| {
            let there = scene.moved(&v, step * STEP);
            scene.respond(&there, Order::Tangent)
        });
        let pairs = before.along(&v).into_iter().zip(after.along(&v));
        let jump: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let jumps = |rows: Range<usize>| {
            let stiffness = &before.stiffness[rows.start * n..rows.end * n];
            largest(&jump[rows]) > 1e-3 * largest(stiffness)
        };
        jumps(0..first) || first < n && jumps(first..n)
    })
}

pub(super) fn tangent_error(scene: &mut Scene, seed: u64) -> Worst {
    let mut random = Random::new(seed);
    let base = scene.state.clone();
    let n = scene.layout.ndof();
    let here = scene.respond(&base, Order::Tangent);
    scene.interface.verdict(&base);
    assert!(scene.pattern().covers(&here), "the pattern misses entries");
    let mut worst = Worst::default();
    let first = n - scene.layout.nmultiplier();
    // both, one after the other: an error in one does not hide behind the other
    for part in [0..first, first..n] {
        if part.is_empty() {
            continue;
        }
        let mut v = vec![0.0; n];
        v[part.clone()].fill_with(|| random.signed());
        let h = STEP;
        let mut change = vec![0.0; n];
        let mut same = true;
        for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let there = scene.moved(&v, step * h);
            let force = scene.respond(&there, Order::Residual).force;
            same &= scene.is_settled(&there);
            for (c, f) in change.iter_mut().zip(&force) {
                *c += weight * f / (12.0 * h);
            }
        }
        if !same {
            continue;
        }
        worst.tried += 1;
        let along = here.along(&v);
        let error: Vec<f64> = along.iter().zip(&change).map(|(a, b)| a - b).collect();
        let relative = |rows: std::ops::Range<usize>| {
            let stiffness = &here.stiffness[rows.start * n..rows.end * n];
            largest(&error[rows]) / largest(stiffness)
        };
        worst.displacement = worst.displacement.max(relative(0..first));
        if first < n {
            worst.multiplier = worst.multiplier.max(relative(first..n));
        }
    }
    worst
}

pub(super) fn balance(scene: &mut Scene, method: Method, rubs: bool, bond: bool, name: &str) {
    let state = scene.state.clone();
    let whole = scene.respond(&state, Order::Residual);
    let (force, moment, size) = scene.resultant(&whole.force);
    assert!(size > 0.0, "{name}: nothing acts");
    assert!(force.norm() < 1e-12 * size, "{name}: {force:?} of {size}");
    let expected = if method.is_inside() || method.is_mortar() {
        // points share nodes: moments do not follow exactly from forces on nodes
        if rubs || bond || matches!(method, Method::NodalMortar | Method::HeldMortar) {
            return;
        }
        // where normals have turned, moments balance to the tilt times the gap
        if !scene.interface.pairing().weights.guests.turned.is_empty() {
            return;
        }
        Vec3::ZERO
    } else {
        scene.moment_of_pairs(&whole.force, method.is_between_nodes())
    };
    let error = moment - expected;
    assert!(error.norm() < 1e-12 * 5.0 * size, "{name}: {error:?}");
    let is_free = !rubs && !bond && method == Method::NodeToSegment;
    if is_free {
        assert!(moment.norm() < 1e-12 * 5.0 * size, "{name}: {moment:?}");
    }
}

/// The columns of a row whose anchor is on its facet, with those of its multiplier.
fn on_one_facet(scene: &Scene) -> usize {
    let parts = scene.interface.parts();
    let nodes = match parts.pair.primary.carrier(0) {
        Carrier::Nodes(nodes) => nodes.len(),
        _ => 2,
    };
    let of_point = parts.discretization.point(0).nodes.len();
    let of_multiplier = match parts.nmultiplier(scene.layout.ndim()) {
        2 => 3,
        n => n,
    };
    3 * (nodes + of_point) + of_multiplier
}

/// Tries a combination with a few seeds until all states occurred that can.
fn check(
    kind: Kind,
    method: Method,
    law: usize,
    friction: &Friction,
    (bond, tangential): (bool, Option<f64>),
) -> Worst {
    let (mut worst, mut seen) = (Worst::default(), Seen::default());
    let mut name = String::new();
    let mut kinks = 0;
    for seed in 1..=12 {
        let choice = Choice {
            friction: friction.clone(),
            bond,
            tangential,
            gasket: (law == GASKET).then(|| Arc::new(gasket())),
            ..Choice::of(laws().swap_remove(law))
        };
        let multiplier = choice.law.multiplier();
        let rubs = friction.is_some();
        let how = friction
            .as_ref()
            .map(|(law, stick)| (law.limit(&Default::default()), *stick));
        name = format!(
            "{kind:?} {method:?} law {law} {multiplier:?} {how:?} bond {bond} {tangential:?} {seed}"
        );
        let mut scene = Scene::with_past(kind, method, choice, seed);
        let found = tangent_error(&mut scene, seed);
        if law == GASKET && found.displacement > 1e-7 && has_kink(&mut scene, seed) {
            kinks += 1;
            assert!(kinks < 4, "{name}: kinks at {kinks} seeds");
            continue;
        }
        assert!(
            found.displacement < 1e-7 && found.multiplier < 1e-7,
            "{name}: {:e} {:e}",
            found.displacement,
            found.multiplier
        );
        worst.add(&found);
        let state = scene.state.clone();
        let whole = scene.respond(&state, Order::Tangent);
        balance(&mut scene, method, rubs, bond, &name);
        let averages = matches!(
            method,
            Method::PrimaryNormals
                | Method::SecondaryNormals
                | Method::Mortar
                | Method::NodalMortar
        );
        let is_symmetric = bond || !rubs && !averages;
        if is_symmetric && (kind.ndim() == 2 || matches!(kind, Kind::Elements(_))) {
            assert!(whole.asymmetry() < 1e-12, "{name}: {:e}", whole.asymmetry());
        }
        let report = scene.report();
        seen.open |= report.area_open > 0.0;
        seen.stick |= report.area_stick > 0.0 && !bond;
        seen.tied |= report.area_stick > 0.0 && bond;
        seen.slip |= report.area_slip > 0.0;
        seen.elsewhere |= whole.most > on_one_facet(&scene);
        // the exponential never ends
        let always = law == 2;
        let goes_on = matches!(method, Method::NodeToSegment) || method.is_inside();
        let has_other_facets = matches!(kind, Kind::Elements(_)) && goes_on;
        let enough = if bond {
            seen.tied
        } else {
            let elsewhere = seen.elsewhere || !has_other_facets;
            (seen.open || always) && seen.slip && (!rubs || seen.stick && elsewhere)
        };
        if enough && worst.tried > 0 {
            return worst;
        }
    }
    panic!(
        "{name}: open {} stick {} slip {} anchors on other facets {} tried {}",
        seen.open, seen.stick, seen.slip, seen.elsewhere, worst.tried
    );
}

/// All methods and laws with all frictions, and joined.
fn walk(kind: Kind) {
    for method in methods(kind) {
        let mut worst = Worst::default();
        // rows know nothing of laws, and those of mortar take their time
        let every = if method.is_mortar() { 3 } else { 1 };
        for law in 0..laws().len() {
            for friction in frictions().iter().step_by(every) {
                worst.add(&check(kind, method, law, friction, (false, None)));
            }
            // curves join nothing
            if law == 0 || laws()[law].multiplier() != Multiplier::None {
                worst.add(&check(kind, method, law, &None, (true, None)));
            }
            // points that hold a tangent plane know the motion along it
            let on_points = !method.is_mortar() && !method.is_between_nodes();
            if law == 0 && on_points {
                let tangential = Some(0.3 * PENALTY);
                worst.add(&check(kind, method, law, &None, (true, tangential)));
            }
        }
        println!(
            "{kind:?} {method:?}: {:.1e} {:.1e} of {}",
            worst.displacement, worst.multiplier, worst.tried
        );
    }
}

#[test]
fn tangents_match_differences_on_line2() {
    walk(Kind::Elements("line2"));
}

#[test]
fn tangents_match_differences_on_line3() {
    walk(Kind::Elements("line3"));
}

#[test]
fn tangents_match_differences_on_tri3() {
    walk(Kind::Elements("tri3"));
}

#[test]
fn tangents_match_differences_on_tri6() {
    walk(Kind::Elements("tri6"));
}

#[test]
fn tangents_match_differences_on_quad4() {
    walk(Kind::Elements("quad4"));
}

#[test]
fn tangents_match_differences_on_quad8() {
    walk(Kind::Elements("quad8"));
}

#[test]
fn tangents_match_differences_on_quad9() {
    walk(Kind::Elements("quad9"));
}

#[test]
fn tangents_match_differences_on_rigid_surfaces() {
    for kind in [Kind::Circle, Kind::Sphere, Kind::Torus] {
        walk(kind);
    }
}

#[test]
fn multipliers_that_stick_act_as_they_hold() {
    for kind in ["line2", "line3", "tri3", "quad4", "quad9"] {
        for method in [Method::NodeToSegment, Method::Gauss, Method::GivenNormals] {
            let exact = laws().into_iter().filter(|l| l.multiplier().is_unknown());
            for law in exact {
                let choice = Choice {
                    friction: Some((Arc::new(Tresca(1e3)), Stick::Stiffness(1.0))),
                    ..Choice::of(law)
                };
                let mut scene = Scene::new(Kind::Elements(kind), method, choice, 3);
                let pressed = scene.further(&mut Random::new(4));
                let nodal = scene.layout.nnode() * scene.layout.ndim();
                scene.state.u[nodal..].copy_from_slice(&pressed.u[nodal..]);
                let state = scene.state.clone();
                scene.interface.begin(&next_increment(), &state).unwrap();
                scene.settle();
                let whole = scene.respond(&state, Order::Tangent);
                let n = scene.layout.ndof();
                let (mut odd, mut most) = (0.0f64, 0.0f64);
                for i in nodal..n {
                    for j in 0..nodal {
                        let (a, b) = (whole.stiffness[i * n + j], whole.stiffness[j * n + i]);
                        odd = odd.max((a - b).abs());
                        most = most.max(a.abs());
                    }
                }
                assert!(
                    most > 0.1 && odd < 1e-13 * most,
                    "{kind} {method:?}: {odd:e}"
                );
                assert!(scene.report().area_stick > 0.0);
            }
        }
    }
}

#[test]
fn a_pressure_that_acts_at_a_distance_is_coupled() {
    let choice = Choice::of(Box::new(Exponential {
        p0: 1.0,
        c0: 1.0,
        within: f64::INFINITY,
    }));
    let kind = Kind::Elements("quad4");
    let mut scene = Scene::new(kind, Method::NodeToSegment, choice, 1);
    let mut up = vec![0.0; scene.layout.ndof()];
    for &node in &scene.points {
        up[scene.layout.node(node, 2) as usize] = 0.5;
    }
    let away = scene.moved(&up, 1.0);
    let whole = scene.respond(&away, Order::Tangent);
    assert!(largest(&whole.stiffness) > 0.1);
    assert!(scene.pattern().covers(&whole));
}
