//! One pair of surfaces with its choices, as the one contact term there is.

mod asked;
mod audited;
mod bonds;
mod carried;
mod cohesive;
mod conducting;
mod coupled;
mod damped;
mod depths;
mod drift;
mod dynamic_gap;
mod fluid;
mod freedom;
mod front;
mod history;
mod impulsive;
mod inherited;
mod judged;
mod lent;
mod lents;
mod means;
mod memory;
mod near;
mod pairing;
mod parts;
mod passing;
mod past;
mod report;
mod restless;
mod reversals;
mod row_heat;
mod rows;
mod term;
mod thermal;
mod warmth;
mod wear;
mod weighted;
mod wet;

pub use inherited::inherit;
pub use near::closest_points;
pub use parts::{
    Allowance, Areas, Bend, ContactPhase, InterfaceParts, Measure, Shift, WearParts, nmultiplier,
};
pub use wet::{Critical, Fluid};

pub use conducting::{ContactHeat, FrictionHeat};

use super::discretization::{Pair, Pairing};
use super::friction::Stick;
use super::kernel::{Answer, Contact, Derivatives, Lambda, Laws, Past};
use super::law::{Impulse, Multiplier};
use super::row::{Participant, RowOrder, Rows, Wanted};
use crate::system::{
    Archive, ArchiveError, Dof, Elimination, Layout, Order, Sink, State, StepContext, TermError,
    Verdict,
};
use asked::Asked;
use bonds::Bonds;
use coupled::Coupled;
use depths::Worn;
use judged::Judged;
use lents::Lents;
use memory::{DynamicGaps, Ends, History};
use near::Near;
use reversals::Reversals;
use row_heat::{ThermalScratch, Warmth};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;
use wet::Wetting;

/// Two surfaces that may touch: the only contact term, whatever the method, the law, the surfaces or the dimension.
pub struct Interface {
    parts: InterfaceParts,
    layout: Layout,
    elimination: Arc<Elimination>,
    near: Near,
    /// The choices for the present iterate, those of the last accepted state, and those at the start of the increment:
    /// these stay until the next begins, so that the report of an accepted state is of the forces that acted in it.
    now: Pairing,
    accepted: Pairing,
    before: Pairing,
    judged: Vec<Judged>,
    accepted_judged: Vec<Judged>,
    next: Pairing,
    /// Where the rows of each chunk end.
    shares: Vec<usize>,
    history: History,
    /// Whether the accepted choices are those of a state, and not just of nothing.
    started: bool,
    /// Whether they were read from an archive, which holds no weights.
    resumed: bool,
    /// Whether rows see others than the pattern knows.
    sees_others: bool,
    /// How often choices that hold while an iteration goes on were made again in this increment.
    settled: u8,
    /// What the pattern couples each row with, and what the present iterate asks for.
    coupled: Coupled,
    wanted: Coupled,
    step: StepContext,
    /// Rows of a joint whose nodes cannot follow lend their functions to others.
    lents: Lents,
    /// Areas of rows where no node is held.
    area_without_supports: Vec<f64>,
    /// The step in which it acts first.
    first_step: Option<StepContext>,
    /// What overlaps at the start of the increment and is allowed for; empty where nothing is.
    allowed: Allowed,
    /// Tributary areas at the start, where the part that counts depends on the facets met.
    whole: Vec<f64>,
    /// The largest motion along the other side so far, over the size of the facets, where contact keeps its geometry, and
    /// its node.
    drift: Option<(f64, NodeId)>,
    /// Rows whose slip turns round from iterate to iterate.
    reversals: Reversals,
    /// The size up to which a force is negligible.
    negligible: f64,
    /// Iterates of this increment with nothing closed.
    flights: u8,
    /// How often each row went to another facet in this increment. Those that alternate are held.
    changes: Vec<u8>,
    /// Rows that are held where they would not be by themselves in the present iterate, and where they would be.
    astray: Vec<(usize, Pair)>,
    gaps: DynamicGaps,
    /// Bonds that may break; empty where none do.
    bonds: Bonds,
    /// Forces at the ends of increments, where those before count.
    ends: Ends,
    /// The length of the increment; 0 where none has begun.
    duration: f64,
    /// When it begins.
    increment_start: f64,
    /// Where a fluid is.
    wetting: Wetting,
    /// What its sides have lost.
    worn: Worn,
    /// The heat across it.
    warmth: Warmth,
}

/// Overlaps that an increment allows for.
#[derive(Debug, Default)]
struct Allowed {
    /// Of each row, at the start of the increment; empty where none is.
    overlaps: Vec<f64>,
    /// How much of them is left at a time, over the part of the step that was left when they were measured.
    of_step: f64,
}

#[derive(Default)]
struct Scratch {
    rows: Rows,
    dofs: Vec<Dof>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    /// Where stiffness is spread over more multipliers.
    spread: Vec<f64>,
    derivatives: Derivatives,
    asked: Asked,
    thermal: ThermalScratch,
}

impl Interface {
    /// Makes the term.
    #[must_use]
    pub fn new(parts: InterfaceParts, layout: Layout, elimination: Arc<Elimination>) -> Self {
        let nrow = parts.discretization.nrow();
        let nothing = Pairing::nothing(nrow);
        let history = History::new(nrow, parts.bond.as_deref());
        let area_without_supports = parts.area.clone();
        let worn = Worn::new(parts.wear.as_ref(), nrow);
        Self {
            parts,
            layout,
            elimination,
            near: Near::default(),
            now: nothing.clone(),
            accepted: nothing.clone(),
            before: nothing.clone(),
            judged: vec![Judged::default(); nrow],
            accepted_judged: vec![Judged::default(); nrow],
            shares: Vec::new(),
            next: nothing,
            history,
            started: false,
            resumed: false,
            sees_others: false,
            settled: 0,
            coupled: Coupled::default(),
            wanted: Coupled::default(),
            step: StepContext::default(),
            lents: Lents::default(),
            area_without_supports,
            first_step: None,
            allowed: Allowed::default(),
            reversals: Reversals::new(nrow),
            negligible: 0.0,
            flights: 0,
            changes: vec![0; nrow],
            whole: Vec::new(),
            drift: None,
            astray: Vec::new(),
            gaps: DynamicGaps::default(),
            bonds: Bonds::default(),
            ends: Ends::default(),
            duration: 0.0,
            increment_start: 0.0,
            wetting: Wetting::default(),
            worn,
            warmth: Warmth::default(),
        }
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> &InterfaceParts {
        &self.parts
    }

    /// The choices made for the present iterate.
    #[must_use]
    pub const fn pairing(&self) -> &Pairing {
        &self.now
    }

    fn phase(&self) -> Option<&ContactPhase> {
        let phases = &self.parts.phases;
        phases.get(self.step.number).or(phases.last())
    }

    fn is_active(&self) -> bool {
        self.phase().is_none_or(|p| p.active)
    }

    fn laws(&self) -> Laws<'_> {
        let friction = self.phase().and_then(|p| p.friction.as_ref());
        let is_explicit = self.step.is_explicit();
        Laws {
            law: match is_explicit && self.has_unknown_multipliers() {
                true => &Impulse,
                false => self.parts.law.as_ref(),
            },
            friction: friction.map(|(law, _)| law.as_ref()),
            stick: match friction.map(|(_, stick)| *stick) {
                // what is stable must not fall as pressure rises
                Some(Stick::Slip(_)) if is_explicit => Stick::Stiffness(self.parts.scale.penalty),
                stick => stick.unwrap_or(Stick::Stiffness(0.0)),
            },
            scale: &self.parts.scale,
            has_past: self.parts.gasket.is_some(),
            bond: self.parts.bond.is_some(),
            bond_tangential: self.parts.bond_tangential,
            cohesion: self.parts.cohesion.as_ref(),
            duration: self.duration,
            vectors: self.parts.has_vectors(),
            shear: self.parts.scale.shear,
            vibrates: self.step.vibrates,
            walks: self.walks(),
            answer: None,
        }
    }

    /// The laws with the c_t of a row.
    fn laws_of(&self, row: usize) -> Laws<'_> {
        let laws = self.laws();
        Laws {
            shear: laws.shear * self.reversals.factor(row),
            ..laws
        }
    }

    /// The past of a row with its status in the previous iterate.
    fn past(&self, row: usize) -> Past {
        Past {
            state: self.judged.get(row).map_or(Contact::Open, |j| j.state),
            ..self.past_of_increment(row)
        }
    }

    fn nmultiplier(&self) -> usize {
        self.parts.nmultiplier(self.layout.ndim())
    }

    /// The multiplier of a row: solved for, frozen, or none.
    fn lambda(&self, row: usize, trial: &State) -> Lambda {
        let n = self.nmultiplier();
        if n == 0 {
            return self.history.lambda(row);
        }
        let mut lambda = Lambda::default();
        if self.parts.has_vectors() {
            let own = |row: usize| self.own_multiplier(row, trial);
            lambda.vector = self.lents.effective(row, &own);
        } else {
            lambda.scalar = self.own_multiplier(row, trial).x;
        }
        lambda
    }

    /// The unknowns of a row that are multipliers.
    fn own_multiplier(&self, row: usize, trial: &State) -> Vec3 {
        let n = self.nmultiplier();
        let first = self.parts.first_multiplier + n * row;
        let mut own = Vec3::ZERO;
        for c in 0..n {
            let dof = self.layout.multiplier(first + c);
            own[c] = trial.u.get(dof as usize).copied().unwrap_or_default();
        }
        own
    }

    /// The unknowns behind the multiplier columns of a row: three where it is a traction, in the plane too.
    fn multiplier_dofs(&self, row: usize, out: &mut Vec<Dof>) {
        let n = self.nmultiplier();
        let first = self.parts.first_multiplier + n * row;
        out.extend((0..n).map(|c| self.layout.multiplier(first + c)));
        if n == 2 {
            out.push(crate::system::NO_DOF);
        }
    }

    /// Columns of the multiplier of a row.
    fn ncolumn_of_multiplier(&self) -> usize {
        match self.nmultiplier() {
            2 => 3,
            n => n,
        }
    }

    fn measure(&self, row: usize) -> f64 {
        match self.parts.measure {
            Measure::Area => self.area(row),
            Measure::Node => 1.0,
        }
    }

    /// Tributary area of a row; 1 where the secondary side has none, so that pressures are then forces.
    fn area(&self, row: usize) -> f64 {
        self.parts.area.get(row).copied().unwrap_or(1.0)
    }

    /// What is added to the gap of a row.
    fn shift(&self, row: usize, time: f64) -> f64 {
        let of_start = self.parts.shifts.get(row).copied().unwrap_or_default();
        let constant = of_start.constant - self.rise(row) + self.worn.depth(row);
        let allowed = self.allowed.overlaps.get(row).copied().unwrap_or_default();
        if of_start.fading == 0.0 && allowed == 0.0 {
            return constant;
        }
        let left = self.left_of_first_step(time);
        let of_increment = match allowed {
            0.0 => 0.0,
            overlap => overlap * left / self.allowed.of_step,
        };
        constant + of_start.fading * left + of_increment
    }

    /// By how much the gap of a row between straight facets exceeds that of the surfaces they were cut from.
    fn rise(&self, row: usize) -> f64 {
        let bend = self.parts.bend.as_ref();
        let rise = bend.and_then(|bend| bend.rises.get(row));
        rise.copied().unwrap_or_default()
    }

    /// How much is left of the first step in which it acts, as a part of it.
    fn left_of_first_step(&self, time: f64) -> f64 {
        self.first_step.map_or(1.0, |step| {
            (1.0 - (time - step.start) / step.duration).clamp(0.0, 1.0)
        })
    }

    /// Measures the overlaps that an increment allows for, where it does; `seen` says whether the choices are those of
    /// its start.
    fn allow_for_overlaps(&mut self, from: &State, seen: bool) -> Result<(), TermError> {
        self.allowed.overlaps.clear();
        let left = self.left_of_first_step(from.time);
        // inertia has overlaps pushed apart at once
        let in_first_step = self
            .first_step
            .is_some_and(|s| s.number == self.step.number && s.scheme.is_none());
        let allows = match self.parts.allowance {
            Allowance::Never => false,
            Allowance::First => left >= 1.0,
            Allowance::Every => left > 0.0,
        };
        if !(allows && in_first_step && self.is_active()) {
            return Ok(());
        }
        let kept = (!seen).then(|| self.now.clone());
        if !seen {
            self.search(&from.placement())
                .map_err(|e| self.failed(&e))?;
        }
        let overlap = |row: usize, gap: f64| {
            let constant = self.parts.shifts.get(row).map_or(0.0, |s| s.constant);
            (-gap - constant + self.rise(row)).max(0.0)
        };
        let pairs = self.now.pairs.iter().enumerate();
        let overlaps = pairs.map(|(row, pair)| pair.map_or(0.0, |p| overlap(row, p.gap)));
        self.allowed.overlaps = overlaps.collect();
        self.allowed.of_step = left;
        if let Some(kept) = kept {
            self.now = kept;
        }
        Ok(())
    }

    /// Makes the choices that hold while an iteration goes on; says whether they are others.
    fn settle(&mut self, at: &Placement, from_rest: bool) -> Result<bool, TermError> {
        let parts = &self.parts;
        let Some(averaged) = parts.discretization.capabilities().averaged else {
            return Ok(false);
        };
        let (now, before) = (&mut self.now, &mut self.before);
        let anchors = self.history.anchors_mut();
        let others = averaged.settle(&parts.pair, at, now, before, anchors, from_rest);
        let others = others.map_err(|e| self.failed(&e))?;
        self.sees_others |= others;
        self.settled += u8::from(others);
        Ok(others)
    }

    /// The choices and the history that an increment begins with.
    fn begin_increment(&mut self, from: &State) -> Result<(), TermError> {
        let at = from.placement();
        self.worn.begin();
        if !self.parts.pair.sizes.primary.is_empty() {
            self.parts.pair.start.clear();
            self.parts.pair.start.extend_from_slice(at.x);
        }
        let supported = self.support()?;
        let of = self.parts.discretization.capabilities();
        let (renews, many) = (of.renews() | supported, of.averaged.is_some());
        let first = !self.started;
        if first {
            self.search(&at).map_err(|e| self.failed(&e))?;
            self.started = true;
        } else if std::mem::take(&mut self.resumed) && many {
            // weights are those of where the run stopped, and what they couple is known
            self.search(&at).map_err(|e| self.failed(&e))?;
            self.accepted.clone_from(&self.now);
            self.sees_others = false;
        }
        self.before.clone_from(&self.accepted);
        let settled = self.settle(&at, true)?;
        self.accepted.clone_from(&self.now);
        let others = self.renew_rows(from)?;
        if !others && (renews || self.parts.bond_tangential.is_some()) {
            self.let_go();
            self.search(&at).map_err(|e| self.failed(&e))?;
        }
        self.begin_bonds(from)?;
        self.sees_others |= self.lend(from)?;
        if !self.conserves() {
            // energy is stored over areas that stay
            self.measure_again(&at).map_err(|e| self.failed(&e))?;
            self.measure_what_bears(&at).map_err(|e| self.failed(&e))?;
        }
        self.bend_again(&at).map_err(|e| self.failed(&e))?;
        self.see_opposite(from)?;
        self.allow_for_overlaps(from, renews || first)?;
        if first || others || settled {
            self.judged = self.judge(from)?;
            self.accepted_judged.clone_from(&self.judged);
        }
        self.before.clone_from(&self.accepted);
        (self.settled, self.flights) = (0, 0);
        self.changes.fill(0);
        self.reversals.reset(self.parts.discretization.nrow());
        self.history.begin();
        self.begin_limits(from)?;
        self.begin_gaps(from)?;
        self.increment_start = from.time;
        self.begin_fluid(from)?;
        self.stick(&at).map_err(|e| self.failed(&e))
    }

    pub(super) fn failed(&self, error: &SurfaceError) -> TermError {
        TermError::Surface {
            interface: self.parts.name.clone(),
            message: error.to_string(),
            node: None,
        }
    }
}
