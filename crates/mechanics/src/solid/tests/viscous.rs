//! Stiffness that damps: forces against the initial stiffness, stiffness against differences, turning bodies, what is spent.

use super::*;
use crate::solid::{Truss, TrussParts};
use crate::system::{Increment, Rates, Scheme};

const RETARDATION: f64 = 0.3;
const H: f64 = 0.1;

fn step(scheme: Option<Scheme>, kinematics: Kinematics) -> StepContext {
    StepContext {
        nonlinear: kinematics == Kinematics::Finite,
        scheme,
        ..StepContext::default()
    }
}

/// An increment of a motion: from where, at which velocities and accelerations, and to where.
struct Motion {
    scheme: Scheme,
    kinematics: Kinematics,
    from: State,
}

impl Motion {
    fn new(scheme: Scheme, kinematics: Kinematics, mut from: State) -> Self {
        let any = |seed: usize| {
            let one = move |k| 0.4 * noise(seed + k);
            let all = 0..from.x.len();
            all.map(move |k| Vec3::new(one(3 * k), one(3 * k + 1), one(3 * k + 2)))
        };
        let mut rates = Rates::new(any(11).collect(), Vec::new());
        rates.acceleration = any(87).collect();
        from.rates = Some(rates);
        Self {
            scheme,
            kinematics,
            from,
        }
    }

    fn begin(&self, term: &mut dyn Term) {
        let increment = Increment {
            number: 1,
            from: 0.0,
            to: H,
        };
        let step = step(Some(self.scheme), self.kinematics);
        term.begin(&Phase::of_increment(step, increment), &self.from)
            .unwrap();
    }

    fn between(&self, layout: &Layout, end: &State) -> State {
        let mut middle = end.clone();
        middle.set_between(&self.scheme, layout, [&self.from, end]);
        middle
    }

    /// (1 − αf) v₁ + αf v₀ of every unknown, written again from the recursion.
    fn velocities(&self, layout: &Layout, end: &State) -> Vec<f64> {
        let Scheme {
            alpha_f,
            beta,
            gamma,
            ..
        } = self.scheme;
        let rates = self.from.rates.as_ref().unwrap();
        let mut out = vec![0.0; layout.ndof()];
        for node in 0..layout.nnode() {
            for axis in 0..layout.ndim() {
                let dof = layout.node(node as u32, axis) as usize;
                let (v, a) = (rates.velocity[node][axis], rates.acceleration[node][axis]);
                let way = end.u[dof] - self.from.u[dof];
                let last = (way - H * v - H * H * (0.5 - beta) * a) / (beta * H * H);
                let end = v + H * ((1.0 - gamma) * a + gamma * last);
                out[dof] = (1.0 - alpha_f) * end + alpha_f * v;
            }
        }
        out
    }
}

fn evaluated(term: &dyn Term, at: &State, order: Order) -> Dense {
    let n = at.u.len();
    let mut dense = Dense {
        force: vec![0.0; n],
        stiffness: vec![0.0; if order == Order::Tangent { n * n } else { 0 }],
    };
    let mut work = Work::default();
    for chunk in 0..term.nchunk() {
        term.evaluate(chunk, at, order, &mut work, &mut dense)
            .unwrap();
    }
    dense
}

/// Elements in each space, with remedies and laws, at a size of strains.
fn bodies() -> Vec<(String, Body, Kinematics)> {
    let mut bodies = Vec::new();
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for locking in LOCKINGS {
                let wish = Wish {
                    locking,
                    ..Wish::plain(space, kinematics)
                };
                // the largest elements once
                let laws: [Box<dyn Material>; 3] = [
                    elastic("neo-hookean", 0.3),
                    elastic("saint-venant-kirchhoff", 0.3),
                    derivatives::plastic(),
                ];
                let count = if element.nnode() > 10 { 1 } else { 3 };
                for (k, material) in laws.into_iter().take(count).enumerate() {
                    if locking == Locking::Auto {
                        continue;
                    }
                    let Ok(mut body) = body(&mesh, material, &wish) else {
                        continue;
                    };
                    body.solid.set_retardation(RETARDATION);
                    let name = format!("{} {space:?} {kinematics:?} {locking} {k}", element.name());
                    bodies.push((name, body, kinematics));
                }
            }
        }
    }
    assert!(bodies.len() > 60, "{}", bodies.len());
    bodies
}

fn ends(body: &Body) -> [State; 2] {
    let n = body.layout.ndof();
    let strained = |seed: usize, size: f64| (0..n).map(move |k| size * noise(seed + k));
    let from: Vec<f64> = strained(5, 0.02).collect();
    let to = strained(5, 0.02).zip(strained(61, 0.03));
    let to: Vec<f64> = to.map(|(one, other)| one + other).collect();
    [from, to].map(|u| body.state(&u))
}

fn schemes() -> [Scheme; 2] {
    [Scheme::generalized_alpha(0.8), Scheme::energy_momentum()]
}

/// Forces at small strain are `b K₀ v_α`, with the stiffness of the undeformed body.
#[test]
fn forces_at_small_strain_are_those_of_the_initial_stiffness() {
    for (name, mut body, kinematics) in bodies() {
        if kinematics == Kinematics::Finite {
            continue;
        }
        for scheme in schemes() {
            if scheme.conserves && body.solid.conserves_energy(kinematics).is_err() {
                continue;
            }
            let [from, to] = ends(&body);
            let motion = Motion::new(scheme, kinematics, from);
            let middle = motion.between(&body.layout, &to);
            motion.begin(&mut body.solid);
            let damped = evaluated(&body.solid, &middle, Order::Residual).force;
            body.solid.set_retardation(0.0);
            motion.begin(&mut body.solid);
            let bare = evaluated(&body.solid, &middle, Order::Residual).force;
            body.solid.set_retardation(RETARDATION);
            let n = body.layout.ndof();
            let mut initial = Dense {
                force: vec![0.0; n],
                stiffness: vec![0.0; n * n],
            };
            let mut work = Work::default();
            for chunk in 0..body.solid.nchunk() {
                body.solid
                    .add_initial(chunk, &mut work, &mut initial)
                    .unwrap();
            }
            let v = motion.velocities(&body.layout, &to);
            for (row, (damped, bare)) in damped.iter().zip(&bare).enumerate() {
                let line = initial.stiffness[row * n..(row + 1) * n].iter().zip(&v);
                let wanted = RETARDATION * line.map(|(k, v)| k * v).sum::<f64>();
                let off = (damped - bare - wanted).abs();
                assert!(off < 1e-10 * initial.scale(), "{name} {row}: {off:e}");
            }
        }
    }
}

#[test]
fn stiffness_with_damping_matches_differences() {
    for (name, mut body, kinematics) in bodies() {
        for scheme in schemes() {
            let [from, to] = ends(&body);
            let motion = Motion::new(scheme, kinematics, from);
            if scheme.conserves && body.solid.conserves_energy(kinematics).is_err() {
                continue;
            }
            motion.begin(&mut body.solid);
            // against the end, or against where it is evaluated
            let share = match body.solid.properties().to_end {
                true => 1.0,
                false => 1.0 - scheme.alpha_f,
            };
            let (n, layout) = (body.layout.ndof(), body.layout);
            let middle = motion.between(&layout, &to);
            let here = evaluated(&body.solid, &middle, Order::Tangent);
            let columns = (0..n).step_by(if n > 24 { 7 } else { 1 });
            for column in columns {
                let moved = |by: f64| {
                    let mut u = to.u.clone();
                    u[column] += by;
                    let middle = motion.between(&layout, &body.state(&u));
                    evaluated(&body.solid, &middle, Order::Residual).force
                };
                let h = 1e-6;
                let (up, down) = (moved(h), moved(-h));
                for row in 0..n {
                    let slope = (up[row] - down[row]) / (2.0 * h);
                    let off = (share * here.stiffness[row * n + column] - slope).abs();
                    assert!(
                        off < 1e-7 * here.scale(),
                        "{name} {row} {column}: {off:e} of {:e}",
                        here.scale()
                    );
                }
            }
        }
    }
}

/// What is spent is the work of the viscous forces, whatever rotations are superposed at both ends; in a rotation of the body as it is
/// there are no viscous forces. Of f-bar only the latter is exact.
#[test]
fn turning_bodies_lose_what_bodies_lose_that_do_not_turn() {
    for (name, mut body, kinematics) in bodies() {
        let space = body.solid.space;
        if kinematics == Kinematics::Small || space == Idealisation::Axisymmetric {
            continue;
        }
        let turn = |angle: f64| match space {
            Idealisation::Space => Mat3::rotation(Vec3::new(0.4, -0.5, 0.8) * angle),
            _ => Mat3::rotation(Vec3::new(0.0, 0.0, angle)),
        };
        let strained = ends(&body);
        let still = [vec![0.0; body.layout.ndof()], vec![0.0; body.layout.ndof()]];
        let still = still.map(|u| body.state(&u));
        let mut spent = |ends: &[State; 2], angles: [f64; 2]| {
            let mut ends = [(&ends[0], angles[0]), (&ends[1], angles[1])].map(|(state, angle)| {
                let places = state.x.iter().zip(body.reference.iter());
                let u = places.map(|(x, start)| (turn(angle) * *x - *start).to_array());
                let ndim = body.layout.ndim();
                let u: Vec<f64> = u.flat_map(|u| u.into_iter().take(ndim)).collect();
                body.state(&u)
            });
            ends[1].rates = None;
            let [from, to] = ends;
            let motion = Motion::new(Scheme::generalized_alpha(1.0), kinematics, from);
            motion.begin(&mut body.solid);
            let before = body.solid.damping.spent;
            body.solid.accept(&to).unwrap();
            // histories begin again
            let virgin = body.solid.blocks.iter().map(|b| b.undeformed.clone());
            let virgin: Vec<Vec<f64>> = virgin.collect();
            for (block, virgin) in body.solid.blocks.iter_mut().zip(virgin) {
                block.history = virgin.repeat(block.labels.len());
            }
            body.solid.damping.spent - before
        };
        let plain = spent(&strained, [0.0, 0.0]);
        assert!(plain > 0.0, "{name}");
        let rigid = spent(&still, [0.3, 1.1]);
        assert!(rigid.abs() < 1e-24 + 1e-13 * plain, "{name}: {rigid:e}");
        if !name.contains("f-bar") {
            let turned = spent(&strained, [0.3, 1.1]);
            assert!(
                (turned / plain - 1.0).abs() < 1e-10,
                "{name}: {turned} {plain}"
            );
        }
    }
}

/// Neither static steps nor looks at accepted states know of it; explicit steps have forces of it, and stiffness without.
#[test]
fn only_motions_are_damped() {
    let mesh = one(element::by_name("quad4").unwrap(), PLANE);
    for kinematics in [Kinematics::Small, Kinematics::Finite] {
        let wish = Wish::plain(PLANE, kinematics);
        let mut body = body(&mesh, elastic("neo-hookean", 0.3), &wish).unwrap();
        let [from, to] = ends(&body);
        let mut of = |scheme: Option<Scheme>, retardation: f64, at: &State| {
            body.solid.set_retardation(retardation);
            let step = step(scheme, kinematics);
            let increment = Increment {
                number: 1,
                from: 0.0,
                to: H,
            };
            let phase = Phase::of_increment(step, increment);
            body.solid.begin(&phase, &from).unwrap();
            let residual = evaluated(&body.solid, at, Order::Residual).force;
            let with = evaluated(&body.solid, at, Order::Tangent);
            (residual, with.stiffness)
        };
        assert_eq!(of(None, RETARDATION, &to), of(None, 0.0, &to));
        let explicit = Scheme::explicit(crate::system::Leapfrog {
            safety: 0.9,
            scaling: None,
        });
        let (forces, stiffness) = of(Some(explicit), RETARDATION, &to);
        let (bare, usual) = of(None, 0.0, &to);
        assert_eq!(stiffness, usual);
        let spent: f64 = (0..forces.len())
            .map(|dof| (forces[dof] - bare[dof]) * (to.u[dof] - from.u[dof]))
            .sum();
        assert!(spent > 0.0);
    }
}

const PLANE: Idealisation = Idealisation::PlaneStrain { thickness: 0.7 };

fn bars(ndim: usize) -> (Truss, Layout, Arc<[Vec3]>) {
    let points = [
        Vec3::new(0.1, -0.2, 0.0),
        Vec3::new(1.2, 0.7, 0.0),
        Vec3::new(0.6, 0.35, 0.0),
    ];
    let mut mesh = Mesh::default();
    for x in points {
        mesh.points.push(x);
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let cell = mesh.push_cell(element::by_name("line3").unwrap(), &[0, 1, 2], 4);
    let layout = Layout::new(ndim, 3, 0);
    let reference: Arc<[Vec3]> = points.into();
    let truss = Truss::new(TrussParts {
        name: "bars",
        mesh: &mesh,
        reference: reference.clone(),
        cells: &[cell],
        layout,
        space: match ndim {
            2 => PLANE,
            _ => Idealisation::Space,
        },
        material: elastic("neo-hookean", 0.3),
        area: 0.4,
        small: false,
        temperature: None,
    });
    let mut truss = truss.unwrap();
    truss.set_retardation(RETARDATION);
    (truss, layout, reference)
}

#[test]
fn bars_damp_along_themselves() {
    for ndim in [2, 3] {
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let (mut truss, layout, reference) = bars(ndim);
            let n = layout.ndof();
            let u = |seed: usize| -> Vec<f64> { (0..n).map(|k| 0.03 * noise(seed + k)).collect() };
            let from = state(&layout, &reference, &u(4));
            let scheme = Scheme::generalized_alpha(0.8);
            let motion = Motion::new(scheme, kinematics, from.clone());
            motion.begin(&mut truss);
            let to = u(40);
            let forces = |to: &[f64], order| {
                let end = state(&layout, &reference, to);
                evaluated(&truss, &motion.between(&layout, &end), order)
            };
            let here = forces(&to, Order::Tangent);
            for column in 0..n {
                let moved = |by: f64| {
                    let mut to = to.clone();
                    to[column] += by;
                    forces(&to, Order::Residual).force
                };
                let (up, down) = (moved(1e-6), moved(-1e-6));
                for row in 0..n {
                    let slope = (up[row] - down[row]) / 2e-6;
                    let own = (1.0 - scheme.alpha_f) * here.stiffness[row * n + column];
                    assert!((own - slope).abs() < 1e-7 * here.scale(), "{ndim} {row}");
                }
            }
            truss.accept(&state(&layout, &reference, &to)).unwrap();
            assert!(truss.damping.spent != 0.0);
            // turned as it is, it loses nothing
            let turn = |angle: f64| {
                let turn = Mat3::rotation(Vec3::new(0.0, 0.0, angle));
                let u = reference.iter().map(|x| (turn * *x - *x).to_array());
                let u: Vec<f64> = u.flat_map(|u| u.into_iter().take(ndim)).collect();
                state(&layout, &reference, &u)
            };
            if kinematics == Kinematics::Finite {
                let even = Motion::new(Scheme::generalized_alpha(1.0), kinematics, turn(0.2));
                even.begin(&mut truss);
                let before = truss.damping.spent;
                truss.accept(&turn(1.0)).unwrap();
                assert!((truss.damping.spent - before).abs() < 1e-20);
            }
        }
    }
}
