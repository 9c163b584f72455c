//! From rows to force and stiffness: (E1) to (E6) of the room. It never asks what the segment is.

mod heat;
mod target;

pub(super) use heat::Slopes;
pub(super) use target::Target;

use super::cohesion::{Cohesion, Torn};
use super::friction::{Coulomb, FrictionLaw, Limit, Sliding, Stick};
use super::law::{ContactLaw, Eval, Multiplier, Scale, secant};
use super::row::{Row, SeenGap, Viscous};
use pulp::Arch;
use signorini_geometry::tensor::Vec3;
use target::{add_stiffness, join};

/// The laws of an interface, and the numbers they scale with.
#[derive(Clone, Copy)]
pub(super) struct Laws<'a> {
    pub law: &'a dyn ContactLaw,
    pub friction: Option<&'a dyn FrictionLaw>,
    pub stick: Stick,
    pub scale: &'a Scale,
    /// Whether the law is asked with what the row remembers, in the place of a multiplier.
    pub has_past: bool,
    /// Whether the sides are joined.
    pub bond: bool,
    /// The stiffness of bonds within the tangent plane; `None`: as along the normal.
    pub bond_tangential: Option<f64>,
    /// How bonds break; `None`: they do not.
    pub cohesion: Option<&'a Cohesion>,
    /// The length of the increment, over which damage is delayed.
    pub duration: f64,
    /// Whether multipliers are tractions.
    pub vectors: bool,
    /// c_t of the row at hand: the shear traction per slip of an unknown multiplier.
    pub shear: f64,
    /// Whether tangents are those of small vibrations: what slips moves freely along the other side, and what sticks does not
    /// feel a pressure that changes.
    pub vibrates: bool,
    /// Whether rows know how far they slide without friction, too: for wear.
    pub walks: bool,
    /// What the laws answer for the row at hand, where they were asked for many rows at once.
    pub answer: Option<&'a Answer>,
}

/// What the laws answer for a row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Answer {
    /// The gap and the multiplier along the normal that they were asked with.
    pub at: (SeenGap, f64),
    pub pressure: Eval,
    /// The limit of friction, and what it was asked with.
    pub limit: Option<(Sliding, Limit)>,
}

impl Answer {
    /// The pressure, where it is that of these numbers to the last bit.
    fn pressure_at(&self, gap: SeenGap, lambda: f64) -> Option<Eval> {
        let bits = |(gap, lambda): (SeenGap, f64)| {
            (
                [gap.now, lambda, gap.viscous.pressure].map(f64::to_bits),
                gap.from.map(f64::to_bits),
            )
        };
        let is_same = bits(self.at) == bits((gap, lambda)) && self.at.0.worn == gap.worn;
        is_same.then_some(self.pressure)
    }

    /// The limit of friction, where it is that of these numbers.
    fn limit_at(&self, at: &Sliding) -> Option<Limit> {
        let (with, limit) = self.limit?;
        (with == *at).then_some(limit)
    }
}

/// Stands for no friction where multipliers are tractions all the same.
static SMOOTH: Coulomb = Coulomb {
    mu: 0.0,
    cap: f64::INFINITY,
};

/// Relative distance from the limit of friction within which sticking and slipping are the same.
const ON_LIMIT: f64 = 1e-9;

/// The multiplier of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lambda {
    /// λ, ≥ 0 in compression: without friction.
    pub scalar: f64,
    /// The traction: with friction, and of bonds.
    pub vector: Vec3,
}

/// What acts on a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Traction {
    /// ≥ 0 in compression.
    pub pressure: f64,
    /// With the sign of the internal force on the point: along the slip that it resists.
    pub tangential: Vec3,
    /// The trial, and whether it is beyond the limit.
    pub limit: f64,
    pub state: Contact,
    /// The direction of the trial of what slips.
    pub direction: Vec3,
}

/// What a row brings with it from before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Past {
    /// Length of all slip since contact was made.
    pub path: f64,
    /// The limit of friction, where it is held for the sake of convergence.
    pub limit: Option<f64>,
    /// Its status in the previous iterate.
    pub state: Contact,
    /// The damage of a bond, at the start of the increment.
    pub torn: Torn,
}

impl Past {
    /// What a friction law is asked with. Where a law pulls, it rubs as much as where it pushes: CalculiX prints such
    /// tractions.
    pub fn sliding(&self, pressure: f64) -> Sliding {
        Sliding {
            pressure: pressure.abs(),
            path: self.path,
        }
    }
}

/// Whether and how a row touches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Contact {
    #[default]
    Open,
    Stick,
    Slip,
}

/// Buffers for derivatives: one entry for each column, those of the multiplier included.
#[derive(Default)]
pub(super) struct Derivatives {
    pressure: Vec<f64>,
    tangential: Vec<Vec3>,
    trial: Vec<Vec3>,
    actual_pressure: Vec<f64>,
    actual_tangential: Vec<Vec3>,
    /// Those of the active traction, component by component: the tangential traction, then the pressure.
    slopes: [Vec<f64>; 4],
}

impl Derivatives {
    /// dp, and d(Pλ): how the pressure and the tangential part of the multiplier change.
    #[inline]
    fn project(&mut self, row: &Row, pressure: &Eval, lambda: &Lambda, width: usize) {
        let (n, nu, sliding) = (row.weights.len(), row.normal, &row.sliding);
        let along = nu.dot(lambda.vector);
        for j in 0..n {
            let turned = lambda.vector.dot(sliding.dnormal[j]);
            self.pressure[j] = pressure.dgap * row.gradient[j] - pressure.dlambda * turned;
            self.actual_pressure[j] = -turned;
            self.trial[j] = sliding.dnormal[j] * -along - nu * turned;
            self.actual_tangential[j] = self.trial[j];
        }
        for c in 0..width - n {
            self.pressure[n + c] = -pressure.dlambda * nu[c];
            self.actual_pressure[n + c] = -nu[c];
            self.trial[n + c] = Vec3::unit(c) - nu * nu[c];
            self.actual_tangential[n + c] = self.trial[n + c];
        }
    }

    fn reset(&mut self, n: usize) {
        self.pressure.clear();
        self.pressure.resize(n, 0.0);
        self.actual_pressure.clear();
        self.actual_pressure.resize(n, 0.0);
        for vectors in [
            &mut self.tangential,
            &mut self.trial,
            &mut self.actual_tangential,
        ] {
            vectors.clear();
            vectors.resize(n, Vec3::ZERO);
        }
    }
}

impl<'a> Laws<'a> {
    /// Whether rows have a tangential part.
    pub fn slips(&self) -> bool {
        self.bond || self.walks || self.friction().is_some()
    }

    fn friction(&self) -> Option<&'a dyn FrictionLaw> {
        let smooth = || self.vectors.then_some(&SMOOTH as &dyn FrictionLaw);
        self.friction.or_else(smooth)
    }

    /// λ along the normal, or what a law with a past is asked with in its place.
    pub fn scalar(&self, normal: Vec3, lambda: &Lambda) -> f64 {
        if self.vectors && !self.has_past {
            -lambda.vector.dot(normal)
        } else {
            lambda.scalar
        }
    }

    /// The pressure of a gap alone.
    pub fn pressure(&self, gap: SeenGap, normal: Vec3, lambda: &Lambda) -> Eval {
        self.pressed(gap, self.scalar(normal, lambda))
    }

    /// The pressure of a gap and a multiplier along the normal.
    fn pressed(&self, gap: SeenGap, scalar: f64) -> Eval {
        let known = self.answer.and_then(|a| a.pressure_at(gap, scalar));
        known.unwrap_or_else(|| {
            let at_end = self.law_at(gap, scalar);
            self.in_motion(gap, at_end)
        })
    }

    /// What becomes in a motion of the law's pressure at the end of an increment: the one that does the work of the law's energy since
    /// that began, and with what damps, as long as it presses.
    pub fn in_motion(&self, gap: SeenGap, at_end: Eval) -> Eval {
        let elastic = self.elastic_pressure(gap, at_end);
        if gap.viscous == Viscous::default() || elastic == Eval::default() {
            return elastic;
        }
        let value = elastic.value + gap.viscous.pressure;
        if value <= 0.0 && !gap.viscous.pulls {
            return Eval::default();
        }
        Eval {
            value,
            dgap: elastic.dgap - gap.viscous.slope,
            ..elastic
        }
    }

    /// The same without what damps.
    pub fn elastic_pressure(&self, gap: SeenGap, at_end: Eval) -> Eval {
        let secant = gap
            .from
            .and_then(|from| secant(self.law, [from, gap.now], self.scale));
        secant.unwrap_or(at_end)
    }

    /// The pressure that friction is limited by.
    pub fn tried(&self, gap: SeenGap, scalar: f64) -> Eval {
        if self.law.multiplier().is_unknown() {
            self.law_tried(gap, scalar)
        } else {
            self.pressed(gap, scalar)
        }
    }

    /// The limit of friction of a row at a pressure.
    pub(super) fn limit_of(
        &self,
        row: &Row,
        past: &Past,
        friction: &dyn FrictionLaw,
        pressure: f64,
    ) -> Limit {
        if row.sliding.free {
            return Limit::default();
        }
        let held = past.limit.map(|value| Limit {
            value,
            dpressure: 0.0,
        });
        held.unwrap_or_else(|| {
            let at = past.sliding(pressure);
            let known = self.answer.and_then(|a| a.limit_at(&at));
            let limit = known.unwrap_or_else(|| friction.limit(&at));
            Limit {
                dpressure: limit.dpressure.copysign(pressure * limit.dpressure),
                ..limit
            }
        })
    }

    /// Whether anything acts at this gap.
    pub fn acts(&self, gap: SeenGap, normal: Vec3, lambda: &Lambda) -> bool {
        self.pressure(gap, normal, lambda) != Eval::default()
    }

    /// Tangential traction per slip, of what sticks.
    pub fn stick_stiffness(&self, traction: &Traction) -> f64 {
        match (self.bond, self.stick_of()) {
            (true, _) => {
                let cohesive = self.cohesion.map(|c| c.law.stiffness());
                let [kn, ks] = cohesive.unwrap_or_default();
                let bond = self.scale.penalty.max(self.bond_tangential());
                bond.max(kn).max(ks)
            }
            (false, Stick::Stiffness(stiffness)) if self.slips() => stiffness,
            (false, Stick::Slip(length)) if self.slips() => traction.limit / length,
            _ => 0.0,
        }
    }

    /// Whether what sticks does not yield.
    pub fn sticks_exactly(&self) -> bool {
        self.law.multiplier() != Multiplier::None
    }

    /// The elastic slip that belongs to a traction of friction.
    pub fn elastic(&self, traction: &Traction) -> Vec3 {
        if self.bond || self.sticks_exactly() {
            return Vec3::ZERO;
        }
        match self.stick {
            Stick::Stiffness(stiffness) if stiffness > 0.0 => traction.tangential / stiffness,
            Stick::Slip(length) if traction.limit > 0.0 => {
                traction.tangential * (length / traction.limit)
            }
            _ => Vec3::ZERO,
        }
    }

    /// The limit of friction at a row's pressure.
    pub fn limit(&self, row: &Row, lambda: &Lambda, path: f64) -> f64 {
        let scalar = self.scalar(row.normal, lambda);
        let pressure = self.tried(row.seen(), scalar);
        let past = Past {
            path,
            ..Past::default()
        };
        let limit = |f: &dyn FrictionLaw| self.limit_of(row, &past, f, pressure.value).value;
        if pressure == Eval::default() {
            return 0.0;
        }
        self.friction.map_or(0.0, limit)
    }

    /// The potential of friction with its limit held.
    pub fn friction_energy(&self, row: &Row, lambda: &Lambda, limit: f64) -> f64 {
        let trial = self.trial(row, lambda);
        let size = trial.norm();
        match self.stick_of() {
            Stick::Stiffness(stiffness) if stiffness > 0.0 => {
                let along = lambda.vector.dot(row.normal);
                let start = (lambda.vector - row.normal * along).norm_squared();
                let stored = if size <= limit {
                    0.5 * size * size
                } else {
                    limit * size - 0.5 * limit * limit
                };
                (stored - 0.5 * start) / stiffness
            }
            Stick::Slip(length) if size <= length => 0.5 * limit * size * size / length,
            Stick::Slip(length) => limit * (size - 0.5 * length),
            Stick::Stiffness(_) => 0.0,
        }
    }

    /// What acts on a row, without derivatives.
    pub fn traction(&self, row: &Row, lambda: &Lambda, past: Past) -> Traction {
        if self.bond {
            return match self.cohesion {
                Some(cohesion) => self.torn(cohesion, row, &past),
                None => self.bonded(row, lambda),
            };
        }
        let scalar = self.scalar(row.normal, lambda);
        let pressure = self.tried(row.seen(), scalar);
        if pressure == Eval::default() {
            return Traction::default();
        }
        let Some(friction) = self.friction() else {
            return Traction {
                pressure: self.pressed(row.seen(), scalar).value,
                state: Contact::Slip,
                ..Traction::default()
            };
        };
        let limit = self.limit_of(row, &past, friction, pressure.value);
        let trial = self.trial(row, lambda);
        let (tangential, state) = self.returned(trial, &limit, past.state);
        let slips = state == Contact::Slip;
        let direction = trial.normalized().filter(|_| slips).unwrap_or_default();
        let limit = limit.value;
        if self.law.multiplier() == Multiplier::Direct {
            let along = lambda.vector.dot(row.normal);
            return Traction {
                pressure: -along,
                tangential: lambda.vector - row.normal * along,
                limit,
                state,
                direction,
            };
        }
        Traction {
            pressure: pressure.value,
            tangential,
            limit,
            state,
            direction,
        }
    }

    /// The trial of the return: a traction, or a slip where sticking is given by a slip.
    fn trial(&self, row: &Row, lambda: &Lambda) -> Vec3 {
        match self.stick_of() {
            Stick::Stiffness(stiffness) => {
                let along = row.normal.dot(lambda.vector);
                row.sliding
                    .movable(lambda.vector - row.normal * along + row.sliding.slip * stiffness)
            }
            Stick::Slip(_) => row.sliding.slip,
        }
    }

    /// The return to the limit. A point on the limit to rounding keeps the status it had `before`: the
    /// traction is the same either way, and a state that is found does not change for ever.
    pub(super) fn returned(&self, trial: Vec3, limit: &Limit, before: Contact) -> (Vec3, Contact) {
        if *limit == Limit::default() {
            return (Vec3::ZERO, Contact::Slip);
        }
        let (size, limit) = (trial.norm(), limit.value);
        if limit.is_nan() {
            // nothing sticks below what is no number: the force is none either, and the attempt fails
            return (trial * limit, before);
        }
        let (end, sticking) = match self.stick_of() {
            Stick::Stiffness(_) => (limit, trial),
            Stick::Slip(length) => (length, trial * (limit / length)),
        };
        let slips = size > end;
        let traction = if slips {
            trial * (limit / size)
        } else {
            sticking
        };
        let on_limit = (size - end).abs() < ON_LIMIT * size;
        let state = match before {
            Contact::Stick | Contact::Slip if on_limit => before,
            _ if slips => Contact::Slip,
            _ => Contact::Stick,
        };
        (traction, state)
    }

    /// Multipliers stick exactly, whatever the stiffness.
    fn stick_of(&self) -> Stick {
        match self.law.multiplier() {
            Multiplier::None => self.stick,
            Multiplier::Frozen => Stick::Stiffness(self.scale.penalty),
            _ => Stick::Stiffness(self.shear),
        }
    }

    fn bond_tangential(&self) -> f64 {
        self.bond_tangential.unwrap_or(self.scale.penalty)
    }

    /// E e of (E6).
    fn stretched(&self, row: &Row, e: Vec3) -> Vec3 {
        let tangential = self.bond_tangential();
        let more = self.scale.penalty - tangential;
        e * tangential + row.normal * (row.normal.dot(e) * more)
    }

    /// The energy in a bond, without multipliers.
    pub fn bond_energy(&self, row: &Row, past: &Past) -> f64 {
        if let Some(cohesion) = self.cohesion {
            return self.torn_energy(cohesion, row, past);
        }
        let e = row.sliding.slip;
        0.5 * e.dot(self.stretched(row, e))
    }

    fn bonded(&self, row: &Row, lambda: &Lambda) -> Traction {
        let stretched = match self.law.multiplier() {
            Multiplier::Direct => lambda.vector,
            _ if row.sliding.free => lambda.vector,
            _ => lambda.vector + self.stretched(row, row.sliding.slip),
        };
        let along = stretched.dot(row.normal);
        Traction {
            pressure: -along,
            tangential: stretched - row.normal * along,
            limit: f64::INFINITY,
            state: Contact::Stick,
            direction: Vec3::ZERO,
        }
    }

    /// Adds forces and stiffness of a row.
    pub fn act(
        &self,
        row: &Row,
        measure: f64,
        lambda: &Lambda,
        past: Past,
        work: &mut Derivatives,
        target: &mut Target<'_>,
    ) {
        if self.bond {
            self.tie(row, measure, lambda, past, target);
        } else if let Some(friction) = self.friction() {
            self.rub(friction, row, measure, lambda, past, work, target);
        } else {
            self.press(row, measure, lambda.scalar, target);
        }
        if row.viscous.drag > 0.0 {
            drag(row, measure, work, target);
        }
    }

    /// Contact without friction: (E1), (E2).
    fn press(&self, row: &Row, measure: f64, lambda: f64, target: &mut Target<'_>) {
        let n = row.weights.len();
        let width = target.force.len();
        let pressure = self.pressed(row.seen(), lambda);
        let scaled = measure * pressure.value;
        for (f, b) in target.force.iter_mut().zip(&row.weights) {
            *f -= scaled * b; // (E1)
        }
        let unknown = self.law.multiplier().is_unknown();
        let row_of_lambda = self.complements(row.seen(), lambda);
        if unknown {
            target.force[n] += measure * row_of_lambda.value;
        }
        if target.stiffness.is_empty() {
            return;
        }
        if pressure != Eval::default() {
            let slope = measure * pressure.dgap;
            let lines = target.stiffness.chunks_exact_mut(width);
            for ((line, b), db) in lines.zip(&row.weights).zip(row.dweights.chunks_exact(n)) {
                let along = slope * b;
                for ((k, g), db) in line.iter_mut().zip(&row.gradient).zip(db) {
                    *k -= along * g + scaled * db; // (E2)
                }
                if unknown {
                    line[n] -= measure * pressure.dlambda * b;
                }
            }
        }
        if unknown {
            let line = &mut target.stiffness[n * width..];
            for (k, g) in line.iter_mut().zip(&row.gradient) {
                *k += measure * row_of_lambda.dgap * g;
            }
            line[n] += measure * row_of_lambda.dlambda;
        }
    }

    /// Contact with friction: (E3) to (E5).
    #[allow(clippy::too_many_arguments)]
    fn rub(
        &self,
        friction: &dyn FrictionLaw,
        row: &Row,
        measure: f64,
        lambda: &Lambda,
        past: Past,
        work: &mut Derivatives,
        target: &mut Target<'_>,
    ) {
        let (n, width) = (row.weights.len(), target.force.len());
        let unknown = self.law.multiplier().is_unknown();
        let direct = self.law.multiplier() == Multiplier::Direct;
        let wants_tangent = !target.stiffness.is_empty();
        let (nu, sliding) = (row.normal, &row.sliding);
        let along = nu.dot(lambda.vector);
        let pressure = self.tried(row.seen(), self.scalar(nu, lambda));
        let open = pressure == Eval::default();

        work.reset(width);
        work.project(row, &pressure, lambda, width);
        let limit = self.limit_of(row, &past, friction, pressure.value);
        let trial = self.trial(row, lambda);
        let mut tangential = Vec3::ZERO;
        if !open && limit != Limit::default() {
            let state;
            (tangential, state) = self.returned(trial, &limit, past.state);
            let size = trial.norm();
            let slides = self.vibrates && state == Contact::Slip;
            for j in 0..if slides { 0 } else { width } {
                let dslip = sliding.dslip.get(j).copied().unwrap_or_default();
                let dpressure = if self.vibrates { 0.0 } else { limit.dpressure };
                let dlimit = dpressure * work.pressure[j];
                work.tangential[j] = match (self.stick_of(), state) {
                    (Stick::Stiffness(stiffness), Contact::Slip) => {
                        let dz = sliding.movable(work.trial[j] + dslip * stiffness);
                        slipping(trial, size, limit.value, dz, dlimit)
                    }
                    (Stick::Stiffness(stiffness), _) => {
                        sliding.movable(work.trial[j] + dslip * stiffness)
                    }
                    (Stick::Slip(_), Contact::Slip) => {
                        slipping(trial, size, limit.value, dslip, dlimit)
                    }
                    (Stick::Slip(length), _) => {
                        dslip * (limit.value / length) + trial * (dlimit / length)
                    }
                };
            }
        }

        if self.vibrates && work.tangential.iter().all(|t| *t == Vec3::ZERO) {
            work.actual_tangential.fill(Vec3::ZERO);
        }
        let (acting, acting_tangential) = if direct {
            (-along, lambda.vector - nu * along)
        } else {
            (pressure.value, tangential)
        };
        if unknown {
            // λ − that, over c along the normal and over c_t across it, so that the tangent of what sticks is symmetric
            let (along_normal, across) = (1.0 / self.scale.penalty, 1.0 / self.shear);
            let missing = lambda.vector + nu * pressure.value - tangential;
            let scales = [along_normal, across];
            add_complementarity(row, measure, pressure.value, missing, scales, work, target);
        }
        for i in 0..n {
            let f = sliding.operator[i].dot(acting_tangential) - acting * row.weights[i];
            target.force[i] += measure * f; // (E3)
        }
        if !wants_tangent {
            return;
        }
        let (dp, dt) = if direct {
            (&work.actual_pressure, &work.actual_tangential)
        } else {
            (&work.pressure, &work.tangential)
        };
        for (c, slopes) in work.slopes.iter_mut().enumerate() {
            slopes.clear();
            match c {
                3 => slopes.extend_from_slice(dp),
                _ => slopes.extend(dt.iter().map(|dt| dt[c])),
            }
        }
        let acting = (acting, acting_tangential);
        Arch::new().dispatch(
            #[inline(always)]
            || add_stiffness(row, measure, acting, &work.slopes, target.stiffness),
        );
    }

    /// Sides that are joined: (E6), or by bonds that may break.
    fn tie(&self, row: &Row, measure: f64, lambda: &Lambda, past: Past, target: &mut Target<'_>) {
        if let Some(cohesion) = self.cohesion {
            let pull = self.pull(cohesion, row, &past);
            return join(row, measure, pull.traction, |e| pull.slope * e, target);
        }
        let stretched = |e: Vec3| match self.law.multiplier() {
            Multiplier::Direct => Vec3::ZERO,
            _ if row.sliding.free => Vec3::ZERO,
            _ => self.stretched(row, e),
        };
        let traction = lambda.vector + stretched(row.sliding.slip);
        join(row, measure, traction, stretched, target);
    }
}

/// Adds a shear `c_t/h P Bᵀ Δd` against the slip of an increment, (E11) of `damped`.
fn drag(row: &Row, measure: f64, work: &mut Derivatives, target: &mut Target<'_>) {
    let (n, width) = (row.weights.len(), target.force.len());
    let (sliding, drag) = (&row.sliding, row.viscous.drag);
    let shear = sliding.way * drag;
    for (f, b) in target.force.iter_mut().zip(&sliding.operator) {
        *f += measure * b.dot(shear);
    }
    if target.stiffness.is_empty() {
        return;
    }
    for (c, slopes) in work.slopes.iter_mut().enumerate() {
        slopes.clear();
        let along = |slope: &Vec3| if c < 3 { drag * slope[c] } else { 0.0 };
        slopes.extend(sliding.dway.iter().map(along));
        slopes.resize(width.max(n), 0.0);
    }
    add_stiffness(row, measure, (0.0, shear), &work.slopes, target.stiffness);
}

/// The equations of the multiplier under friction: the residual `missing`, over the scales along the normal and across it.
#[inline]
fn add_complementarity(
    row: &Row,
    measure: f64,
    pressure: f64,
    missing: Vec3,
    [along_normal, across]: [f64; 2],
    work: &Derivatives,
    target: &mut Target<'_>,
) {
    let (n, width) = (row.weights.len(), target.force.len());
    let (nu, sliding) = (row.normal, &row.sliding);
    let apart = along_normal - across;
    let missed = nu.dot(missing);
    let scaled = missing * across + nu * (missed * apart);
    for c in 0..width - n {
        target.force[n + c] -= measure * scaled[c];
    }
    if target.stiffness.is_empty() {
        return;
    }
    for j in 0..width {
        let dnormal = sliding.dnormal.get(j).copied().unwrap_or_default();
        let mut change = nu * work.pressure[j] + dnormal * pressure - work.tangential[j];
        if j >= n {
            change += Vec3::unit(j - n);
        }
        let turned = nu.dot(change) + dnormal.dot(missing);
        let change = change * across + (nu * turned + dnormal * missed) * apart;
        for c in 0..width - n {
            target.stiffness[(n + c) * width + j] -= measure * change[c];
        }
    }
}

/// The derivative of `L z/|z|`.
pub(super) fn slipping(z: Vec3, size: f64, limit: f64, dz: Vec3, dlimit: f64) -> Vec3 {
    let q = z / size;
    q * dlimit + (dz - q * q.dot(dz)) * (limit / size)
}
