//! The motion of bodies that nothing but contact holds, increment by increment.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu_i | motion of a node, or of a carrier, in the increment |
//! | f_i | contact force there at its end |
//! | W | work of viscous forces on the bodies in the increment |
//! | W_∞ | what it had been, had they acted all the time: `Σ k Δu²` |
//!
//! Contact that stops a motion does work in it, `Σ |f_i · Δu_i|`: as much as the load that drives the motion, or as the
//! supports that do. Where this is nothing next to W, nothing stopped the bodies: they were pushed away, and any other
//! place farther away would do as well. Where contact has taken over from the viscous forces, W is zero, and W_∞ says what
//! is nothing.

use super::frame::{Frame, FreeMotion};
use super::layout::{Dof, FieldId, Layout};
use super::state::State;
use std::sync::Arc;

/// Bodies that are tied to each other and held by contact alone, and the course of an increment.
#[derive(Clone, Debug)]
pub struct Course {
    /// Their names, as in `"pin" and "ring"`.
    bodies: Arc<str>,
    /// Their size, with which motions are compared.
    size: f64,
    /// The unknowns of their motion, and the stiffness of viscous forces on each; 0 where one follows from others.
    motion: Vec<(Dof, f64)>,
    /// The value of each when the increment began; empty before the first.
    start: Vec<f64>,
    /// The work of viscous forces on them in the increment.
    work: f64,
}

/// Motions below this part of the size of a body are let pass: they may be rounding.
const NOTICED: f64 = 1e-6;

impl Course {
    /// These bodies, before the first increment.
    #[must_use]
    pub fn new(bodies: impl Into<Arc<str>>, size: f64, motion: Vec<(Dof, f64)>) -> Self {
        Self {
            bodies: bodies.into(),
            size,
            motion,
            start: Vec::new(),
            work: 0.0,
        }
    }

    /// The unknowns on which viscous forces act, and the stiffness of each.
    pub fn damped(&self) -> impl Iterator<Item = (Dof, f64)> {
        self.motion
            .iter()
            .copied()
            .filter(|(_, stiffness)| *stiffness > 0.0)
    }

    /// An increment begins at this state.
    pub fn begin(&mut self, from: &State) {
        self.work = 0.0;
        self.start.clear();
        let values = self.motion.iter().map(|&(dof, _)| value(from, dof));
        self.start.extend(values);
    }

    /// Viscous forces on the bodies have done this work.
    pub fn spend(&mut self, work: f64) {
        self.work += work;
    }

    /// The work of viscous forces on them in the increment so far.
    #[must_use]
    pub const fn work(&self) -> f64 {
        self.work
    }

    /// What came of the increment that has led to this state, with these contact forces; `None` where nothing has moved.
    #[must_use]
    pub fn motion(&self, state: &State, layout: &Layout, frame: &Frame) -> Option<FreeMotion> {
        let mut found = FreeMotion {
            bodies: self.bodies.clone(),
            distance: 0.0,
            work: self.work,
            work_throughout: 0.0,
            opposed: 0.0,
        };
        for (&(dof, stiffness), start) in self.motion.iter().zip(&self.start) {
            let moved = value(state, dof) - start;
            found.work_throughout += stiffness * moved * moved;
            let (Some(name), true) = (layout.name(dof), moved != 0.0) else {
                continue;
            };
            let node = frame.contact_force.get(name.entity as usize);
            let body = frame.rigid.get(name.entity as usize);
            let force = match name.field {
                FieldId::DISPLACEMENT => node.copied(),
                FieldId::TRANSLATION => body.map(|body| body.contact.force),
                FieldId::ROTATION => body.map(|body| body.contact.moment),
                _ => None,
            };
            let force = force.map_or(0.0, |force| force[name.component]);
            found.opposed += (force * moved).abs();
            if name.field != FieldId::ROTATION {
                found.distance = found.distance.max(moved.abs());
            }
        }
        (found.distance > NOTICED * self.size).then_some(found)
    }
}

fn value(state: &State, dof: Dof) -> f64 {
    state.u.get(dof as usize).copied().unwrap_or_default()
}
