//! Solving small systems: springs whose answers are known, and solids and contact where springs do not do.

mod fields;
mod newton;
mod restart;
mod stabilization;
mod stepping;

use super::{
    Event, Flow, IncrementRecord, Increments, IterationRecord, LineSearch, Motion, NewtonSettings,
    Outcome, Prescription, RunError, Step, Stepper, StepperSettings,
};
use crate::load::{NodalForces, Schedule};
use crate::system::{
    Adaptive, Aid, Capabilities, Choices, Dof, Elimination, Frame, Layout, Order, Part,
    PatternSink, Phase, Properties, Sink, State, Symmetry, System, Term, TermError, Verdict,
    Viscous, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// Energy, force and stiffness of a spring at an elongation.
type Law = fn(f64) -> [f64; 3];

/// A spring along x between two nodes, or between the ground and a node.
struct Spring {
    from: Option<NodeId>,
    to: NodeId,
    law: Law,
    /// Whether it admits to having an energy.
    potential: bool,
    /// The largest step it allows.
    max_step: f64,
}

impl Spring {
    fn between(from: Option<NodeId>, to: NodeId, law: Law) -> Box<dyn Term> {
        Box::new(Self {
            from,
            to,
            law,
            potential: true,
            max_step: 1.0,
        })
    }

    fn at(&self, trial: &State) -> [f64; 3] {
        let u = |node: NodeId| trial.u[x(node) as usize];
        (self.law)(u(self.to) - self.from.map_or(0.0, u))
    }

    fn dofs(&self) -> Vec<Dof> {
        self.from.into_iter().chain([self.to]).map(x).collect()
    }
}

/// The displacement of a node along x.
const fn x(node: NodeId) -> Dof {
    2 * node
}

fn linear(e: f64) -> [f64; 3] {
    [5.0 * e * e, 10.0 * e, 10.0]
}

/// Stiffens: `f = e + e³`.
fn hardening(e: f64) -> [f64; 3] {
    [
        0.5 * e * e + 0.25 * e.powi(4),
        e + e.powi(3),
        1.0 + 3.0 * e * e,
    ]
}

impl Term for Spring {
    fn name(&self) -> &str {
        "spring"
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        out.interface(&self.dofs());
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Symmetric, Part::Interface)
    }

    fn begin(&mut self, _: &Phase, _: &State) -> Result<(), TermError> {
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let [_, f, k] = self.at(trial);
        let (mut force, mut stiffness) = (vec![f], vec![k]);
        if self.from.is_some() {
            force.insert(0, -f);
            stiffness = vec![k, -k, -k, k];
        }
        if order == Order::Residual {
            stiffness.clear();
        }
        out.add(&self.dofs(), &force, &stiffness);
        Ok(())
    }

    fn energy(&self, _: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(self.potential.then(|| self.at(trial)[0]))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            choices: Some(self),
            ..Capabilities::default()
        }
    }
}

impl Choices for Spring {
    fn prescribe(&mut self, _: &[bool]) {}

    fn max_step(&self, _: &State, _: &[f64]) -> f64 {
        self.max_step
    }

    fn verdict(&mut self, _: &State) -> Verdict {
        Verdict::Settled
    }

    fn nactive(&self) -> usize {
        0
    }

    fn reject(&mut self) {}
}

/// A term without forces that finds fault with states.
struct Fault {
    /// What it refuses to evaluate: start of the increment, state.
    refuses: fn(&State, &State) -> bool,
    /// When it is not settled: start of the increment, state, how often it was asked in this increment.
    unsettled: fn(&State, &State, usize) -> bool,
    start: Option<State>,
    asked: usize,
    /// How many contacts it claims to have closed.
    nactive: usize,
    /// Whether its changes of status change no force.
    continuous: bool,
}

impl Fault {
    fn refuse(refuses: fn(&State, &State) -> bool) -> Box<dyn Term> {
        Box::new(Self {
            refuses,
            unsettled: |_, _, _| false,
            start: None,
            asked: 0,
            nactive: 0,
            continuous: false,
        })
    }

    fn unsettle(unsettled: fn(&State, &State, usize) -> bool) -> Box<dyn Term> {
        Box::new(Self {
            refuses: |_, _| false,
            unsettled,
            start: None,
            asked: 0,
            nactive: 0,
            continuous: false,
        })
    }

    /// Makes three changes of as many closed contacts when it is asked first in an increment.
    fn flip_of(nactive: usize) -> Box<dyn Term> {
        Box::new(Self {
            refuses: |_, _| false,
            unsettled: |_, _, asked| asked == 1,
            start: None,
            asked: 0,
            nactive,
            continuous: false,
        })
    }

    /// Is never settled, whether or not that changes any force.
    fn waver(continuous: bool) -> Box<dyn Term> {
        Box::new(Self {
            refuses: |_, _| false,
            unsettled: |_, _, _| true,
            start: None,
            asked: 0,
            nactive: 0,
            continuous,
        })
    }

    fn start(&self) -> &State {
        self.start.as_ref().unwrap()
    }

    fn error() -> TermError {
        TermError::NotFinite {
            what: "the fault".into(),
        }
    }
}

impl Term for Fault {
    fn name(&self) -> &str {
        "fault"
    }

    fn pattern(&self, _: &mut dyn PatternSink) {}

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Definite, Part::Interface)
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        if phase.increment.is_some() {
            self.start = Some(from.clone());
            self.asked = 0;
        }
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        _: Order,
        _: &mut Work,
        _: &mut dyn Sink,
    ) -> Result<(), TermError> {
        if (self.refuses)(self.start(), trial) {
            return Err(Self::error());
        }
        Ok(())
    }

    fn energy(&self, _: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        if (self.refuses)(self.start(), trial) {
            return Err(Self::error());
        }
        Ok(Some(0.0))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            choices: Some(self),
            ..Capabilities::default()
        }
    }

    fn adaptive(&mut self) -> Option<&mut dyn Adaptive> {
        Some(self)
    }
}

impl Adaptive for Fault {
    fn prepare(&mut self, _: &State, _: Order) -> Result<bool, TermError> {
        Ok(false)
    }

    fn converged(&mut self, _: &State) -> Result<Verdict, TermError> {
        Ok(Verdict::Settled)
    }

    fn aid(&mut self, _: Aid) -> bool {
        false
    }

    fn set_negligible(&mut self, _: f64) {}

    fn choices(&mut self) -> Option<&mut dyn Choices> {
        Some(self)
    }

    fn viscous(&mut self) -> Option<&mut dyn Viscous> {
        None
    }
}

impl Choices for Fault {
    fn prescribe(&mut self, _: &[bool]) {}

    fn max_step(&self, _: &State, _: &[f64]) -> f64 {
        1.0
    }

    fn reject(&mut self) {}

    fn nactive(&self) -> usize {
        self.nactive
    }

    fn verdict(&mut self, trial: &State) -> Verdict {
        self.asked += 1;
        if (self.unsettled)(self.start(), trial, self.asked) {
            return Verdict::Repeat {
                continuous: self.continuous,
                changes: 3,
                closing: false,
                why: "the fault wavers".into(),
                nodes: vec![1],
            };
        }
        Verdict::Settled
    }
}

/// A dead force along x on a node; its value at the end of each step.
fn load(node: NodeId, ends: &[f64]) -> Box<dyn Term> {
    Box::new(NodalForces::new(
        "load",
        &[(x(node), 1.0)],
        Schedule::ramps(ends),
    ))
}

/// Nodes in the plane, of which only the displacement along x is in use.
fn system(nnode: usize, terms: Vec<Box<dyn Term>>) -> System {
    let layout = Layout::new(2, nnode, 0);
    let reference: Arc<[Vec3]> = (0..nnode).map(|n| Vec3::unit(0) * n as f64).collect();
    System {
        layout,
        coordinates: reference.iter().map(|x| x.to_array()).collect(),
        reference,
        elimination: Arc::new(Elimination::default()),
        terms,
        body: vec![0; nnode],
        between: Vec::new(),
        ncell: Vec::new(),
        heavy: Arc::new([]),
        rates: None,
        at_start: Arc::default(),
        wanted: crate::system::Wanted::default(),
    }
}

fn step(increments: Increments, prescribed: &[(NodeId, Motion)]) -> Step {
    let prescription = |(node, motion): &(NodeId, Motion)| Prescription {
        dof: x(*node),
        motion: motion.clone(),
    };
    Step {
        name: "step".into(),
        duration: 1.0,
        increments,
        nonlinear: true,
        scheme: None,
        control: None,
        vibration: None,
        physics: crate::system::Physics::default(),
        prescriptions: prescribed.iter().map(prescription).collect(),
    }
}

fn adaptive(initial: f64, min: f64, max: f64) -> Increments {
    Increments::Adaptive {
        initial,
        min,
        max,
        count_max: 100,
    }
}

fn settings(force_tol: f64, line_search: LineSearch) -> StepperSettings {
    let newton = NewtonSettings {
        max_iterations: 20,
        force_tol,
        line_search,
        hold_free: false,
        ..NewtonSettings::default()
    };
    StepperSettings {
        newton,
        ..StepperSettings::default()
    }
}

/// Everything that a run said, and what it left.
struct Told {
    outcome: Result<Outcome, RunError>,
    iterations: Vec<IterationRecord>,
    increments: Vec<IncrementRecord>,
    /// Sizes that failed and those tried next.
    cuts: Vec<[f64; 2]>,
    /// Displacements and reactions of all nodes along x after each increment.
    u: Vec<Vec<f64>>,
    reactions: Vec<Vec<f64>>,
    state: State,
}

fn run_with(mut system: System, steps: &[Step], settings: StepperSettings) -> Told {
    let mut stepper = Stepper::new(&system, settings);
    let (mut iterations, mut increments, mut cuts) = (Vec::new(), Vec::new(), Vec::new());
    let (mut u, mut reactions) = (Vec::new(), Vec::new());
    let outcome = stepper.run(&mut system, steps, &mut |event: &Event<'_>| {
        match event {
            Event::Iteration(record) => iterations.push((*record).clone()),
            Event::Increment { record, frame } => {
                increments.push((*record).clone());
                u.push(frame.displacement.iter().map(|u| u.x).collect());
                reactions.push(frame.reaction_force.iter().map(|f| f.x).collect());
            }
            Event::Cutback { cause, next, .. } => cuts.push([cause.dt, *next]),
            Event::Step { .. }
            | Event::Followed { .. }
            | Event::Stabilized { .. }
            | Event::Held { .. }
            | Event::Solver { .. }
            | Event::Explicit { .. }
            | Event::Leap { .. }
            | Event::Vibrations { .. } => {}
        }
        Flow::Continue
    });
    Told {
        outcome,
        iterations,
        increments,
        cuts,
        u,
        reactions,
        state: stepper.state().clone(),
    }
}

fn run(system: System, steps: &[Step]) -> Told {
    run_with(system, steps, settings(1e-10, LineSearch::Auto))
}

impl Told {
    fn assert_finished(&self) {
        let finished = matches!(self.outcome, Ok(Outcome::Finished));
        assert!(finished, "{:?}", self.outcome);
    }

    fn sizes(&self) -> Vec<f64> {
        self.increments.iter().map(|i| i.dt).collect()
    }
}

fn assert_close(got: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(got.len(), expected.len(), "{got:?} {expected:?}");
    for (a, b) in got.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance, "{got:?} {expected:?}");
    }
}
