//! Laws of rows that wear: a compliance in series.
//!
//! ```text
//! g* = g + h + K s p              what the law sees at the end of the increment, h the depth at its start            (W1)
//! p = P(g*)                       dp/dg = P'/(1 − P' K (s + p ds/dp))         laws without an unknown multiplier
//! c = c(g + h + K s ⟨λ⟩, λ)       ∂c/∂λ = c_λ + c_g K s                       multipliers                            (W2)
//! s = ⟨|e| − L(p)/k⟩              |e| with multipliers and without friction; or a distance that is given
//! ```
//!
//! P falls with the gap, so that (W2) has one root between no pressure and that of the gap without wear. Where s comes from the slip e,
//! g* changes with it as the gap does: rows have `K p (e/|e|)·∂e/∂d` in their gradient.
//!
//! Source: Archard, J. Appl. Phys. 24, 1953 (`dh = K p ds`).

use super::friction::{Sliding, Stick};
use super::kernel::Laws;
use super::law::Eval;
use super::row::{SeenGap, Series};

/// What may be left of a pressure, over itself, and how often it is corrected at most.
const LEFT: f64 = 4.0 * f64::EPSILON;
const ROUNDS: usize = 60;

impl Laws<'_> {
    /// How far a row slides at a pressure, what sticking yields left out, and the slope against the pressure.
    pub fn slid(&self, of: &Series, pressure: f64) -> (f64, f64) {
        let (yields, slope) = match (self.stick, self.friction) {
            (_, None) => (0.0, 0.0),
            _ if !of.eases || self.sticks_exactly() => (0.0, 0.0),
            (Stick::Slip(length), _) => (length, 0.0),
            (Stick::Stiffness(stiffness), Some(friction)) => {
                let at = Sliding {
                    pressure,
                    path: of.path,
                };
                let limit = friction.limit(&at);
                let (value, slope) = match of.held {
                    Some(held) => (held, 0.0),
                    None => (limit.value, limit.dpressure),
                };
                (value / stiffness, slope / stiffness)
            }
        };
        match of.way > yields {
            true => (of.way - yields, -slope),
            false => (0.0, 0.0),
        }
    }

    /// The law's pressure of a row.
    pub(super) fn law_at(&self, gap: SeenGap, scalar: f64) -> Eval {
        let Some(of) = gap.worn else {
            return self.law.pressure(gap.now, scalar, self.scale);
        };
        if self.law.multiplier().is_unknown() {
            return self.with_multiplier(&of, gap.now, scalar, |g| {
                self.law.pressure(g, scalar, self.scale)
            });
        }
        self.in_series(&of, gap.now, scalar)
    }

    /// The pressure that an unknown multiplier is compared with.
    pub(super) fn law_tried(&self, gap: SeenGap, scalar: f64) -> Eval {
        let trial = |g: f64| self.law.trial(g, scalar, self.scale);
        match gap.worn {
            Some(of) => self.with_multiplier(&of, gap.now, scalar, trial),
            None => trial(gap.now),
        }
    }

    /// The function whose root is contact.
    pub(super) fn complements(&self, gap: SeenGap, scalar: f64) -> Eval {
        let c = |g: f64| self.law.complementarity(g, scalar, self.scale);
        match gap.worn {
            Some(of) => self.with_multiplier(&of, gap.now, scalar, c),
            None => c(gap.now),
        }
    }

    /// (W2) of a multiplier.
    fn with_multiplier(
        &self,
        of: &Series,
        gap: f64,
        lambda: f64,
        law: impl Fn(f64) -> Eval,
    ) -> Eval {
        let presses = lambda.max(0.0);
        let (way, slope) = self.slid(of, presses);
        let at = law(gap + of.coefficient * way * presses);
        if lambda < 0.0 {
            return at;
        }
        let grows = of.coefficient * (way + presses * slope);
        Eval {
            dlambda: at.dlambda + at.dgap * grows,
            ..at
        }
    }

    /// (W2) of a law without an unknown multiplier.
    fn in_series(&self, of: &Series, gap: f64, lambda: f64) -> Eval {
        let law = |g: f64| self.law.pressure(g, lambda, self.scale);
        let unworn = law(gap);
        if unworn.value <= 0.0 {
            return unworn;
        }
        let at = |p: f64| {
            let (way, slope) = self.slid(of, p);
            let pressed = law(gap + of.coefficient * way * p);
            let yields = 1.0 - pressed.dgap * of.coefficient * (way + p * slope);
            (pressed, yields)
        };
        let (mut low, mut high, mut p) = (0.0, unworn.value, 0.0);
        for _ in 0..ROUNDS {
            let (pressed, yields) = at(p);
            let missing = p - pressed.value;
            if missing > 0.0 {
                high = p;
            } else {
                low = p;
            }
            let newton = p - missing / yields;
            let next = match newton >= low && newton <= high {
                true => newton,
                false => 0.5 * (low + high),
            };
            let change = (next - p).abs();
            p = next;
            if change <= LEFT * p {
                break;
            }
        }
        let (pressed, yields) = at(p);
        Eval {
            value: p,
            dgap: pressed.dgap / yields,
            dlambda: pressed.dlambda / yields,
        }
    }

    /// The potential of a row whose way is given: that of the law, and what wear takes.
    pub fn energy_at(&self, gap: SeenGap, scalar: f64) -> Option<f64> {
        if gap.worn.is_none() {
            return self.law.energy(gap.now, scalar, self.scale);
        }
        let pressure = self.law_at(gap, scalar).value;
        let seen = self.seen_by_law(gap, pressure);
        let spent = 0.5 * (seen - gap.now) * pressure.max(0.0);
        Some(self.law.energy(seen, scalar, self.scale)? + spent)
    }

    /// The gap that the law of a row sees at a pressure.
    pub fn seen_by_law(&self, gap: SeenGap, pressure: f64) -> f64 {
        let worn = |of: Series| of.coefficient * self.slid(&of, pressure).0 * pressure.max(0.0);
        gap.now + gap.worn.map_or(0.0, worn)
    }
}
