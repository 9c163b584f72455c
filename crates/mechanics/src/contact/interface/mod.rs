//! One pair of surfaces with its choices, as the one contact term there is.

mod audited;
mod drift;
mod freedom;
mod history;
mod lent;
mod pairing;
mod passing;
mod report;
mod restless;
mod reversals;
mod rows;

use super::discretization::{BentSides, Discretization, Pair, Pairing, SurfacePair};
use super::friction::{FrictionLaw, Stick};
use super::kernel::{Contact, Derivatives, Lambda, Laws, Past};
use super::law::{ContactLaw, Multiplier, Penalty, Scale};
use super::row::{Participant, RowOrder, Rows, Wanted};
use crate::system::{
    Adaptive, Aid, Archive, ArchiveError, Audited, Capabilities, Choices, ContactAudit, Dof,
    Elimination, Frame, Layout, Order, Part, PatternSink, Phase, Properties, Sink, State,
    StepContext, Stored, Symmetry, Term, TermError, Verdict, Viscous, Work,
};
use history::History;
use lent::Lents;
pub use pairing::closest_points;
use pairing::{Coupled, Near};
use reversals::Reversals;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// Changes within one increment after which a choice is kept.
const RESTLESS: u8 = 4;

/// How many nodes a verdict names.
const NAMED: usize = 4;

/// What a unit of the law's pressure acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The tributary area of the row.
    Area,
    /// The row itself: the law gives forces.
    Node,
}

/// What a step makes of a contact.
#[derive(Clone)]
pub struct ContactPhase {
    /// Whether it acts.
    pub active: bool,
    /// Its friction; `None`: none.
    pub friction: Option<(Arc<dyn FrictionLaw>, Stick)>,
}

/// What is added to the gap of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shift {
    /// Always.
    pub constant: f64,
    /// At the start of the first step in which the contact acts; it fades to nothing over that step.
    pub fading: f64,
}

/// Which increments of the first step in which a contact acts allow for what overlaps at their start: that fades to
/// nothing over what is left of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Allowance {
    /// None does: what is allowed for is in [`Shift`].
    #[default]
    Never,
    /// The first; what is left at its end is resolved at once.
    First,
    /// Every one.
    Every,
}

/// Gaps that are measured between the surfaces that straight facets were cut from.
///
/// What the facets miss is found for every iterate, so that residuals know where sides have slid to. Tangents do not know how
/// it changes: that is less than half the angle by which facets turn, times what slides.
#[derive(Clone, Debug, Default)]
pub struct Bend {
    /// These surfaces.
    pub sides: BentSides,
    /// By how much the gap of each row exceeds that between these, at the start (length).
    pub rises: Vec<f64>,
    /// Whether that is found again for each iterate: where sides slide.
    pub slides: bool,
}

/// Tributary areas of all rows, from the positions of all nodes.
pub type Areas =
    Box<dyn Fn(&dyn Discretization, &[Vec3]) -> Result<Vec<f64>, SurfaceError> + Send + Sync>;

/// What an interface is made of.
pub struct InterfaceParts {
    /// Its name.
    pub name: String,
    /// The two sides.
    pub pair: SurfacePair,
    /// How they are compared.
    pub discretization: Box<dyn Discretization>,
    /// The contact law.
    pub law: Arc<dyn ContactLaw>,
    /// What becomes of it in each step; the last goes on.
    pub phases: Vec<ContactPhase>,
    /// Whether sticking points remember a traction, not a place. Then those that close are without friction until the
    /// increment has ended.
    pub remembers_traction: bool,
    /// Whether the sides are joined where they are at the start: each row sticks to its anchor, if it has one.
    pub bond: Option<Vec<Option<super::discretization::Anchored>>>,
    /// The stiffness of such a bond within the tangent plane at the start of each increment, if the law is a penalty;
    /// `None`: as along the normal.
    pub bond_tangential: Option<f64>,
    /// What the law's pressure acts on.
    pub measure: Measure,
    /// Tributary area of each row; empty where the secondary side has none.
    pub area: Vec<f64>,
    /// Tributary areas at the start of each increment, where they change.
    pub areas: Option<Areas>,
    /// The numbers the law scales with.
    pub scale: Scale,
    /// What is added to the gap of each row; empty where nothing is.
    pub shifts: Vec<Shift>,
    /// Which increments allow for what overlaps at their start.
    pub allowance: Allowance,
    /// The surfaces that straight facets were cut from, where gaps are measured between these.
    pub bend: Option<Bend>,
    /// The first multiplier, where the law solves for them: one for each row, and with friction, or joined, one for each
    /// row and direction.
    pub first_multiplier: usize,
    /// The gap up to which a multiplier method may leave a contact open or penetrated, as a length.
    pub gap_tolerance: f64,
    /// What multipliers that friction limits may be off by, over themselves.
    pub traction_tolerance: f64,
    /// Whether pressures of quadratic triangles are smoothed in results.
    pub smooths: bool,
    /// Whether it is the second pass of a contact, whose results belong to the first with the sides swapped.
    pub swapped: bool,
}

impl InterfaceParts {
    /// A linear penalty without friction, in force per gap of each row.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        pair: SurfacePair,
        discretization: Box<dyn Discretization>,
        penalty: f64,
    ) -> Self {
        Self {
            name: name.into(),
            pair,
            discretization,
            law: Arc::new(Penalty),
            phases: Vec::new(),
            remembers_traction: false,
            bond: None,
            bond_tangential: None,
            measure: Measure::Node,
            area: Vec::new(),
            areas: None,
            scale: Scale {
                penalty,
                shear: penalty,
                length: 1.0,
            },
            shifts: Vec::new(),
            allowance: Allowance::default(),
            bend: None,
            first_multiplier: 0,
            gap_tolerance: 1e-6,
            traction_tolerance: 1e-7,
            smooths: false,
            swapped: false,
        }
    }

    /// Multipliers of one row.
    #[must_use]
    pub fn nmultiplier(&self, ndim: usize) -> usize {
        nmultiplier(self.law.as_ref(), self.has_vectors(), ndim)
    }

    /// Whether multipliers are tractions.
    fn has_vectors(&self) -> bool {
        self.bond.is_some() || self.phases.iter().any(|p| p.friction.is_some())
    }
}

/// Multipliers of one row: tractions with friction in any step, and of bonds.
#[must_use]
pub fn nmultiplier(law: &dyn ContactLaw, vectors: bool, ndim: usize) -> usize {
    match (law.multiplier().is_unknown(), vectors) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => ndim,
    }
}

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
}

/// Overlaps that an increment allows for.
#[derive(Debug, Default)]
struct Allowed {
    /// Of each row, at the start of the increment; empty where none is.
    overlaps: Vec<f64>,
    /// How much of them is left at a time, over the part of the step that was left when they were measured.
    of_step: f64,
}

/// What a verdict compares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Judged {
    state: Contact,
    facet: Option<(u32, u8)>,
    /// The direction in which it slips.
    direction: Vec3,
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
}

impl Interface {
    /// Makes the term.
    #[must_use]
    pub fn new(parts: InterfaceParts, layout: Layout, elimination: Arc<Elimination>) -> Self {
        let nrow = parts.discretization.nrow();
        let nothing = Pairing::nothing(nrow);
        let history = History::new(nrow, parts.bond.as_deref());
        let area_without_supports = parts.area.clone();
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
        Laws {
            law: self.parts.law.as_ref(),
            friction: friction.map(|(law, _)| law.as_ref()),
            stick: friction.map_or(Stick::Stiffness(0.0), |(_, stick)| *stick),
            scale: &self.parts.scale,
            bond: self.parts.bond.is_some(),
            bond_tangential: self.parts.bond_tangential,
            vectors: self.parts.has_vectors(),
            shear: self.parts.scale.shear,
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
            ..self.history.past(row)
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
        let constant = of_start.constant - self.rise(row);
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
        let in_first_step = self
            .first_step
            .is_some_and(|s| s.number == self.step.number);
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
        self.sees_others |= self.lend(from)?;
        self.measure_again(&at).map_err(|e| self.failed(&e))?;
        self.measure_what_bears(&at).map_err(|e| self.failed(&e))?;
        self.bend_again(&at).map_err(|e| self.failed(&e))?;
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

impl Term for Interface {
    fn name(&self) -> &str {
        &self.parts.name
    }

    fn properties(&self) -> Properties {
        let rubs = self.phase().is_some_and(|p| p.friction.is_some());
        // multipliers that are tractions keep their form where there is no friction for a while
        let tractions = self.nmultiplier() > 1 && self.parts.bond.is_none();
        let is_symmetric = self.parts.discretization.capabilities().is_symmetric;
        let symmetry = if rubs || tractions || !is_symmetric {
            Symmetry::Unsymmetric
        } else if self.nmultiplier() > 0 {
            Symmetry::Symmetric
        } else {
            Symmetry::Definite
        };
        Properties {
            has_saddle: self.parts.bond.is_none() && self.nmultiplier() > 0,
            ..Properties::new(symmetry, Part::Interface)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        self.cliques(out);
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        self.step = phase.step;
        if self.is_active() && self.first_step.is_none() {
            self.first_step = Some(phase.step);
        }
        match phase.increment {
            Some(_) => self.begin_increment(from),
            None => Ok(()),
        }
    }

    fn nchunk(&self) -> usize {
        rows::nchunk(self.parts.discretization.nrow())
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        for row in self.share(chunk) {
            self.act(row, trial, order, scratch, out)?;
        }
        Ok(())
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let laws = self.laws();
        if (laws.friction.is_some() && !self.history.holds_limits()) || self.nmultiplier() > 0 {
            return Ok(None);
        }
        let rows = &mut work.of::<Scratch>().rows;
        let mut total = 0.0;
        for k in rows::chunk(chunk, self.parts.discretization.nrow()) {
            total += self.measure(k) * self.energy_of(k, trial, rows)?.unwrap_or(0.0);
        }
        Ok(Some(total))
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        self.describe(state, frame)
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            choices: Some(self),
            stored: Some(self),
            audited: Some(self),
            ..Capabilities::default()
        }
    }

    fn adaptive(&mut self) -> Option<&mut dyn Adaptive> {
        Some(self)
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}

impl Adaptive for Interface {
    fn prepare(&mut self, trial: &State, next: Order) -> Result<bool, TermError> {
        let at = trial.placement();
        self.search_for(&at, rows::row_order(next))
            .map_err(|e| self.failed(&e))?;
        self.bend_again(&at).map_err(|e| self.failed(&e))?;
        let through = self.passed_through(&at).or_else(|| self.went_through(&at));
        if let Some((row, message)) = through {
            let nodes = self.parts.discretization.point(row).nodes;
            return Err(TermError::Surface {
                interface: self.parts.name.clone(),
                message,
                node: nodes.first().copied(),
            });
        }
        self.stick(&at).map_err(|e| self.failed(&e))?;
        self.share_out(trial);
        Ok(self.couple(trial))
    }

    fn converged(&mut self, trial: &State) -> Result<Verdict, TermError> {
        if self.settled < RESTLESS && self.settle(&trial.placement(), false)? {
            return Ok(Verdict::Repeat {
                changes: 1,
                closing: false,
                continuous: false,
                why: format!("contact \"{}\": other nodes are covered", self.parts.name),
                nodes: Vec::new(),
            });
        }
        if let Some(goes_on) = self.let_restless_go() {
            return Ok(goes_on);
        }
        let limits = self.renew_limits(trial)?;
        if self.parts.law.multiplier() != Multiplier::Frozen {
            return Ok(limits);
        }
        let multipliers = self.augment(trial)?;
        Ok(match multipliers {
            Verdict::Settled => limits,
            changed => changed,
        })
    }

    fn aid(&mut self, aid: Aid) -> bool {
        match aid {
            Aid::Safer => self.hold_limits(),
            Aid::Usual => self.history.forget_limits(),
            Aid::Remove | Aid::Restore => false,
        }
    }

    fn set_negligible(&mut self, force: f64) {
        self.negligible = force;
    }

    fn choices(&mut self) -> Option<&mut dyn Choices> {
        Some(self)
    }

    fn viscous(&mut self) -> Option<&mut dyn Viscous> {
        None
    }
}

impl Choices for Interface {
    fn prescribe(&mut self, prescribed: &[bool]) {
        self.lents.prescribe(prescribed);
    }

    fn max_step(&self, trial: &State, du: &[f64]) -> f64 {
        self.longest_step(trial, du)
    }

    fn verdict(&mut self, trial: &State) -> Verdict {
        let Ok(now) = self.judge(trial) else {
            // what cannot be evaluated fails where it is evaluated
            return Verdict::Settled;
        };
        let before = std::mem::replace(&mut self.judged, now);
        if self.judged.iter().all(|j| j.state == Contact::Open) {
            self.flights = self.flights.saturating_add(1);
        }
        let mut counts = Changes::default();
        if self.nmultiplier() > 1 {
            let directions = self.judged.iter().map(|judged| judged.direction);
            counts.turned = self.reversals.look(directions);
        }
        let mut nodes = Vec::new();
        for (row, (now, before)) in self.judged.iter().zip(&before).enumerate() {
            if !counts.compare(now, before) {
                continue;
            }
            if let Some(changes) = self.changes.get_mut(row)
                && before.facet.is_some()
                && now.facet != before.facet
            {
                *changes = changes.saturating_add(1);
            }
            if nodes.len() < NAMED {
                nodes.extend(self.parts.discretization.point(row).nodes.first());
            }
        }
        counts.verdict(&self.parts.name, nodes, !self.parts.has_vectors())
    }

    fn nactive(&self) -> usize {
        let closed = self.judged.iter().filter(|j| j.state != Contact::Open);
        closed.count()
    }

    fn reject(&mut self) {
        self.now.clone_from(&self.accepted);
        self.judged.clone_from(&self.accepted_judged);
        self.history.reject();
        self.flights = 0;
        self.changes.fill(0);
        self.reversals.reset(self.parts.discretization.nrow());
    }
}

impl Stored for Interface {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.accepted.clone_from(&self.now);
        self.accepted_judged.clone_from(&self.judged);
        self.started = true;
        self.changes.fill(0);
        if let Some(farthest) = self.farthest(state) {
            self.drift = self.drift.filter(|d| d.0 >= farthest.0).or(Some(farthest));
        }
        self.remember(state)
    }

    fn save(&self, out: &mut Archive) {
        self.store(out);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        self.restore(from)
    }
}

impl Audited for Interface {
    fn node_of(&self, multiplier: usize) -> Option<NodeId> {
        let own = multiplier.checked_sub(self.parts.first_multiplier)?;
        let row = own.checked_div(self.nmultiplier())?;
        let known = row < self.now.pairs.len();
        known.then(|| self.parts.discretization.point(row).nodes.first().copied())?
    }

    fn audit(&self, state: &State, frame: &Frame) -> Option<ContactAudit> {
        self.audited(state, frame)
    }
}

/// What changed from one iterate to the next.
#[derive(Default)]
struct Changes {
    closed: usize,
    opened: usize,
    slipping: usize,
    sticking: usize,
    moved: usize,
    turned: usize,
    /// Whether some row that was closed and still is has gone to another facet, whatever else changed there.
    elsewhere: bool,
}

impl Changes {
    /// Counts a change; says whether there is one.
    fn compare(&mut self, now: &Judged, before: &Judged) -> bool {
        let stays_closed = now.state != Contact::Open && before.state != Contact::Open;
        self.elsewhere |= stays_closed && now.facet != before.facet;
        match (before.state, now.state) {
            (Contact::Open, Contact::Open) => return false,
            (Contact::Open, _) => self.closed += 1,
            (_, Contact::Open) => self.opened += 1,
            (Contact::Stick, Contact::Slip) => self.slipping += 1,
            (Contact::Slip, Contact::Stick) => self.sticking += 1,
            _ if now.facet != before.facet => self.moved += 1,
            _ => return false,
        }
        true
    }

    fn verdict(&self, name: &str, nodes: Vec<NodeId>, forgets: bool) -> Verdict {
        let parts = [
            (self.closed, "closed"),
            (self.opened, "opened"),
            (self.slipping, "stick -> slip"),
            (self.sticking, "slip -> stick"),
            (self.moved, "went to another facet"),
            (self.turned, "slip the other way"),
        ];
        let changes = parts.iter().map(|p| p.0).sum();
        if changes == 0 {
            return Verdict::Settled;
        }
        let said = parts.iter().filter(|p| p.0 > 0);
        let said: Vec<String> = said.map(|(n, what)| format!("{n} {what}")).collect();
        Verdict::Repeat {
            changes,
            closing: forgets && changes == self.closed,
            continuous: !self.elsewhere,
            why: format!("contact \"{name}\": {}", said.join(", ")),
            nodes,
        }
    }
}

/// The unknowns of what moves a facet.
fn dofs_of(carrier: Carrier<'_>, layout: &Layout, out: &mut Vec<Dof>) {
    match carrier {
        Carrier::Nodes(nodes) => {
            let of = |&n: &NodeId| (0..3).map(move |c| layout.node(n, c));
            out.extend(nodes.iter().flat_map(of));
        }
        Carrier::Rigid(body) => {
            out.extend((0..3).map(|c| layout.translation(body, c)));
            out.extend((0..3).map(|c| layout.rotation(body, c)));
        }
        Carrier::Fixed => {}
    }
}
