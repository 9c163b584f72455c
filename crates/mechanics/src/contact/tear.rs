//! From rows of bonds that break to force and stiffness.
//!
//! ```text
//! t = (1 − D_v)(K_n ⟨e_n⟩ ν + K_s e_s) − p(e_n) ν + D_v τ                         (E12)
//! f = w Bᵀ t,   e_n = ν·e,   e_s = P e,   ν that at the start of the increment
//! ```
//!
//! `p` is the pressure of the contact law, whatever the damage, and `τ` the return to the limit of friction of a trial from
//! the place where the point stuck when damage began.

use super::cohesion::{Cohesion, Grown};
use super::friction::{Limit, Stick};
use super::kernel::{Contact, Laws, Past, Traction, slipping};
use super::law::Eval;
use super::row::Row;
use signorini_geometry::tensor::{Mat3, Vec3};

/// What acts on a bond that may break, (E12), with its derivative.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pull {
    /// t.
    pub traction: Vec3,
    /// ∂t/∂e.
    pub slope: Mat3,
    /// The damage.
    pub grown: Grown,
    /// p.
    pub pressure: f64,
    /// τ, its limit, and whether it slips or sticks, or is none.
    pub rubs: Vec3,
    pub limit: f64,
    pub state_of_friction: Contact,
    /// Of the whole row: a bond that is not torn sticks.
    pub state: Contact,
}

/// ⟨e_n⟩ and |e_s|.
pub(super) fn opening(stretch: Vec3, normal: Vec3) -> [f64; 2] {
    let along = stretch.dot(normal);
    [along.max(0.0), (stretch - normal * along).norm()]
}

impl Laws<'_> {
    /// What acts on a bond that may break.
    pub fn pull(&self, cohesion: &Cohesion, row: &Row, past: &Past) -> Pull {
        let (nu, e) = (row.normal, row.sliding.slip);
        let (along, across) = (nu.dot(e), row.within(e));
        let at = opening(e, nu);
        let grown = cohesion.grow(at, past.torn.damage, self.duration);
        let (left, [kn, ks]) = (1.0 - grown.damage.acting, cohesion.law.stiffness());
        let whole = nu * (kn * at[0]) + across * ks;
        let [by_x, by_y] = grown.slope;
        let is_open = along > 0.0;
        let opens = if is_open { nu } else { Vec3::ZERO };
        let ddamage = opens * by_x + across.normalized().unwrap_or_default() * by_y;
        let normals = Mat3::outer(nu, nu);
        let within = Mat3::IDENTITY - normals;
        let along_nu = if is_open { left * kn } else { 0.0 };
        let mut pull = Pull {
            traction: whole * left,
            slope: normals * along_nu + within * (left * ks) - Mat3::outer(whole, ddamage),
            grown,
            state: match left > 0.0 {
                true => Contact::Stick,
                false => Contact::Open,
            },
            ..Pull::default()
        };
        let pressure = match is_open {
            true => Eval::default(),
            false => self.law.pressure(along, 0.0, self.scale),
        };
        if pressure == Eval::default() {
            return pull;
        }
        pull.pressure = pressure.value;
        pull.traction -= nu * pressure.value;
        pull.slope = pull.slope - normals * pressure.dgap;
        if left <= 0.0 && pressure.value > 0.0 {
            pull.state = Contact::Slip;
        }
        self.rub_what_is_torn(row, past, &pressure, ddamage, &mut pull);
        pull
    }

    /// `D_v τ` with its derivative.
    fn rub_what_is_torn(
        &self,
        row: &Row,
        past: &Past,
        pressure: &Eval,
        ddamage: Vec3,
        pull: &mut Pull,
    ) {
        let (damage, nu) = (pull.grown.damage.acting, row.normal);
        let Some(friction) = self.friction.filter(|_| damage > 0.0) else {
            return;
        };
        let limit = self.limit_of(row, past, friction, pressure.value);
        if limit == Limit::default() {
            return;
        }
        let way = row.within(row.sliding.slip - past.torn.sticks);
        let (trial, per_way) = match self.stick {
            Stick::Stiffness(stiffness) => (way * stiffness, stiffness),
            Stick::Slip(length) => (way, limit.value / length),
        };
        let (rubs, state) = self.returned(trial, &limit, past.state);
        let within = Mat3::IDENTITY - Mat3::outer(nu, nu);
        let dlimit = limit.dpressure * pressure.dgap;
        let along = |c: usize| {
            let moved = Vec3::unit(c);
            let (dway, dl) = (within * moved, dlimit * nu[c]);
            match (self.stick, state) {
                (Stick::Stiffness(stiffness), Contact::Slip) => {
                    slipping(trial, trial.norm(), limit.value, dway * stiffness, dl)
                }
                (Stick::Slip(_), Contact::Slip) => {
                    slipping(trial, trial.norm(), limit.value, dway, dl)
                }
                (Stick::Stiffness(_), _) => dway * per_way,
                (Stick::Slip(length), _) => dway * per_way + trial * (dl / length),
            }
        };
        let drubs = Mat3::from_rows([0, 1, 2].map(along)).transpose();
        pull.traction += rubs * damage;
        pull.slope = pull.slope + drubs * damage + Mat3::outer(rubs, ddamage);
        (pull.rubs, pull.limit, pull.state_of_friction) = (rubs, limit.value, state);
        if damage >= 1.0 {
            pull.state = state;
        }
    }

    /// What acts on a bond that may break, as that on any row.
    pub(super) fn torn(&self, cohesion: &Cohesion, row: &Row, past: &Past) -> Traction {
        let pull = self.pull(cohesion, row, past);
        let along = pull.traction.dot(row.normal);
        Traction {
            pressure: -along,
            tangential: pull.traction - row.normal * along,
            limit: pull.limit,
            state: pull.state,
            direction: Vec3::ZERO,
        }
    }

    /// The energy in a bond that may break: what it gives back, and what the contact law and sticking hold.
    pub(super) fn torn_energy(&self, cohesion: &Cohesion, row: &Row, past: &Past) -> f64 {
        let pull = self.pull(cohesion, row, past);
        let [x, y] = opening(row.sliding.slip, row.normal);
        let [kn, ks] = cohesion.law.stiffness();
        let damage = pull.grown.damage.acting;
        let bond = 0.5 * (1.0 - damage) * (kn * x * x + ks * y * y);
        let along = row.normal.dot(row.sliding.slip).min(0.0);
        let pressed = self.law.energy(along, 0.0, self.scale).unwrap_or(0.0);
        bond + pressed + 0.5 * damage * pull.rubs.dot(self.yielded(&pull))
    }

    /// The elastic slip of `τ`.
    pub(super) fn yielded(&self, pull: &Pull) -> Vec3 {
        match self.stick {
            Stick::Stiffness(stiffness) if stiffness > 0.0 => pull.rubs / stiffness,
            Stick::Slip(length) if pull.limit > 0.0 => pull.rubs * (length / pull.limit),
            _ => Vec3::ZERO,
        }
    }
}
