use super::{Inertia, Masses};
use crate::system::{
    Dof, Elimination, Increment, Layout, Order, Phase, Rates, Scheme, Sink, State, StepContext,
    Term, Work,
};
use signorini_geometry::tensor::Vec3;

/// Numbers in [-1, 1] that look random and are the same in every run.
pub(super) fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

fn vectors(n: usize, seed: usize) -> Vec<Vec3> {
    let number = |k: usize, c: usize| noise(seed + 3 * k + c);
    (0..n)
        .map(|k| Vec3::new(number(k, 0), number(k, 1), number(k, 2)))
        .collect()
}

/// Forces and stiffness, dense.
pub(super) struct Sum {
    ndof: usize,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
}

impl Sum {
    pub fn new(ndof: usize) -> Self {
        Self {
            ndof,
            force: vec![0.0; ndof],
            stiffness: vec![0.0; ndof * ndof],
        }
    }
}

impl Sink for Sum {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        for (i, &row) in dofs.iter().enumerate() {
            self.force[row as usize] += force[i];
            for (j, &column) in dofs.iter().enumerate() {
                let value = stiffness.get(i * dofs.len() + j).copied();
                self.stiffness[row as usize * self.ndof + column as usize] +=
                    value.unwrap_or_default();
            }
        }
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

fn scene() -> (Layout, Inertia, State) {
    let layout = Layout::new(3, 5, 0);
    let mut masses = Masses::default();
    masses.push(
        &[0, 1, 2],
        &[4.0, 1.0, 0.5, 1.0, 3.0, 0.2, 0.5, 0.2, 2.0],
        0.4,
    );
    masses.push(
        &[2, 3, 4],
        &[1.0, 0.3, 0.1, 0.3, 1.5, 0.4, 0.1, 0.4, 2.0],
        0.0,
    );
    masses.push(&[1], &[0.7], 0.9);
    masses.push(&[1], &[0.2], 0.9);
    let inertia = Inertia::new(layout, masses.complete(Vec::new()), None, None);
    let mut state = State::initial(&layout, &vectors(5, 50), &Elimination::default());
    state.rates = Some(Rates {
        velocity: vectors(5, 100),
        acceleration: vectors(5, 200),
        bodies: Vec::new(),
    });
    (layout, inertia, state)
}

pub(super) fn begin(inertia: &mut dyn Term, scheme: Scheme, h: f64, from: &State) {
    let step = StepContext {
        scheme: Some(scheme),
        ..StepContext::default()
    };
    let increment = Increment {
        number: 1,
        from: 0.0,
        to: h,
    };
    inertia.begin(&Phase::of_step(step), from).unwrap();
    inertia
        .begin(&Phase::of_increment(step, increment), from)
        .unwrap();
}

fn evaluate(inertia: &Inertia, layout: &Layout, trial: &State) -> Sum {
    let mut sum = Sum::new(layout.ndof());
    for chunk in 0..inertia.nchunk() {
        let mut work = Work::default();
        inertia
            .evaluate(chunk, trial, Order::Tangent, &mut work, &mut sum)
            .unwrap();
    }
    sum
}

/// The state between `from` and where unknowns have changed by `du`.
fn between(scheme: &Scheme, layout: &Layout, from: &State, du: &[f64]) -> State {
    let nothing = Elimination::default();
    let mut to = from.clone();
    to.advance_from(from, du, 1.0, layout, &vectors(5, 50), &nothing);
    let mut trial = from.clone();
    trial.set_between(scheme, layout, [from, &to]);
    trial
}

#[test]
fn stiffness_is_the_derivative_of_the_force_against_the_end() {
    for scheme in [
        Scheme::generalized_alpha(0.8),
        Scheme::generalized_alpha(0.0),
        Scheme::hilber_hughes_taylor(-0.2),
    ] {
        let (layout, mut inertia, from) = scene();
        begin(&mut inertia, scheme, 0.3, &from);
        let du: Vec<f64> = (0..layout.ndof()).map(noise).collect();
        let at = |du: &[f64]| {
            let trial = between(&scheme, &layout, &from, du);
            evaluate(&inertia, &layout, &trial)
        };
        let here = at(&du);
        for column in 0..layout.ndof() {
            let moved = |by: f64| {
                let mut du = du.clone();
                du[column] += by;
                at(&du).force
            };
            let (up, down) = (moved(1e-3), moved(-1e-3));
            for row in 0..layout.ndof() {
                let slope = (up[row] - down[row]) / 2e-3;
                let got = here.stiffness[row * layout.ndof() + column];
                assert!(
                    (got - slope).abs() < 1e-9 * 100.0,
                    "{row} {column}: {got} {slope}"
                );
            }
        }
    }
}

#[test]
fn forces_are_mass_times_acceleration_and_damping() {
    let (scheme, h) = (Scheme::generalized_alpha(0.6), 0.2);
    let (layout, mut inertia, from) = scene();
    begin(&mut inertia, scheme, h, &from);
    let du: Vec<f64> = (0..layout.ndof()).map(|k| noise(7 * k)).collect();
    let trial = between(&scheme, &layout, &from, &du);
    let got = evaluate(&inertia, &layout, &trial).force;
    let before = from.rates.clone().unwrap();
    let mut after = before.clone();
    let way = &trial.between.as_ref().unwrap().way;
    let ends: Vec<Vec3> = from.x.iter().zip(way).map(|(x, w)| *x + *w).collect();
    after.advance(&scheme, h, [&from.x, &ends], &[]);
    let mean = |a: Vec3, b: Vec3, share: f64| b * (1.0 - share) + a * share;
    let motion = |node: usize, damping: f64| {
        let a = mean(
            before.acceleration[node],
            after.acceleration[node],
            scheme.alpha_m,
        );
        let v = mean(before.velocity[node], after.velocity[node], scheme.alpha_f);
        a + v * damping
    };
    let wanted = motion(0, 0.4) * 4.0 + motion(1, 0.4) + motion(2, 0.4) * 0.5;
    for axis in 0..3 {
        assert!((got[axis] - wanted[axis]).abs() < 1e-10);
    }
    let of_cell = motion(0, 0.4) + motion(1, 0.4) * 3.0 + motion(2, 0.4) * 0.2;
    let wanted = of_cell + motion(1, 0.9) * 0.9;
    for axis in 0..3 {
        assert!((got[3 + axis] - wanted[axis]).abs() < 1e-10);
    }
}

/// Where a step begins there is mass and no force.
#[test]
fn the_stiffness_at_the_begin_of_a_step_is_the_mass() {
    let (layout, mut inertia, from) = scene();
    let step = StepContext {
        scheme: Some(Scheme::generalized_alpha(0.8)),
        ..StepContext::default()
    };
    inertia.begin(&Phase::of_step(step), &from).unwrap();
    let sum = evaluate(&inertia, &layout, &from);
    assert!(sum.force.iter().all(|f| *f == 0.0));
    let mass = |a: usize, b: usize| sum.stiffness[3 * a * layout.ndof() + 3 * b];
    assert_eq!([mass(0, 0), mass(0, 1), mass(1, 1)], [4.0, 1.0, 3.0 + 0.9]);
    assert_eq!([mass(2, 2), mass(2, 3), mass(0, 3)], [3.0, 0.3, 0.0]);
    // in a static one it takes no part
    let still = Phase::of_step(StepContext::default());
    inertia.begin(&still, &from).unwrap();
    assert_eq!(inertia.nchunk(), 0);
}

#[test]
fn kinetic_energy_is_half_the_momentum_times_the_velocity() {
    let (_, inertia, _) = scene();
    let even = vec![Vec3::new(0.0, 2.0, 0.0); 5];
    let all = 4.0 + 3.0 + 2.0 + 2.0 * (1.0 + 0.5 + 0.2) + 4.5 + 2.0 * (0.3 + 0.1 + 0.4) + 0.9;
    assert!((inertia.kinetic(&even) - 2.0 * all).abs() < 1e-13);
    assert!((inertia.total(&even) - even[0] * all).norm() < 1e-13);
}
