//! How large residuals may be: condition (a).

use crate::solve::economy::Excess;
use crate::system::{Assembly, Dof, DofName, Layout, System};

/// A component carries load where its forces exceed this part of the largest.
const LOADED: f64 = 1e-12;
/// Rounding error of a residual over the sum of the absolute values in it.
pub(super) const ROUND_OFF: f64 = 100.0 * f64::EPSILON;

/// Kinds of equations, each with a mean force of its own.
pub(super) const KINDS: usize = 3;
pub(super) const FORCES: usize = 0;
const ROTATIONS: usize = 1;
const MULTIPLIERS: usize = 2;

const fn kind(name: Option<DofName>) -> usize {
    match name {
        Some(DofName::Rotation(..)) => ROTATIONS,
        Some(DofName::Multiplier(_)) => MULTIPLIERS,
        _ => FORCES,
    }
}

/// A state, judged by its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Judgement {
    /// max |r| / q over the kinds.
    pub residual: f64,
    /// Residuals over what is allowed.
    pub excess: Excess,
    /// The least force or moment that is allowed.
    pub allowed: f64,
    /// The dof with the largest residual over q.
    pub worst: Option<Dof>,
    /// The residual there.
    pub force: f64,
    /// Condition (a).
    pub small: bool,
    /// Whether residuals are rounding errors.
    pub round_off: bool,
    /// The mean force of each kind.
    pub q: [f64; KINDS],
}

impl Judgement {
    /// Of a state without equations.
    pub const EMPTY: Self = Self {
        residual: 0.0,
        excess: Excess {
            forces: 0.0,
            multipliers: 0.0,
        },
        allowed: 0.0,
        worst: None,
        force: 0.0,
        small: true,
        round_off: true,
        q: [0.0; KINDS],
    };

    /// Of a state with a force that is no number.
    const fn broken(dof: usize, q: [f64; KINDS]) -> Self {
        Self {
            residual: f64::NAN,
            excess: Excess {
                forces: f64::NAN,
                multipliers: 0.0,
            },
            worst: Some(dof as Dof),
            force: f64::NAN,
            small: false,
            round_off: false,
            q,
            ..Self::EMPTY
        }
    }
}

/// What residuals are compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Largest residual over the mean force.
    pub force_tol: f64,
    /// Size of the model.
    pub extent: f64,
    /// The rounding error of the forces of bodies that move without a force.
    pub rounding: f64,
}

/// What counts as small: residuals are judged against the mean force, separately for forces, moments, multipliers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::solve) struct ForceScale {
    /// q of each kind over the accepted states so far.
    accepted: [f64; KINDS],
}

impl ForceScale {
    pub fn accept(&mut self, q: [f64; KINDS]) {
        for (a, q) in self.accepted.iter_mut().zip(q) {
            *a = a.max(q);
        }
    }

    /// The mean force over the accepted states so far.
    pub(super) const fn mean_force(&self) -> f64 {
        self.accepted[FORCES]
    }

    /// The values, for a checkpoint.
    pub const fn to_array(&self) -> [f64; KINDS] {
        self.accepted
    }

    pub const fn from_array(accepted: [f64; KINDS]) -> Self {
        Self { accepted }
    }

    /// Judges the residuals of the unknowns `dofs`.
    pub(super) fn judge(
        &self,
        system: &System,
        dofs: &[Dof],
        assembly: &Assembly,
        tolerance: Tolerance,
    ) -> Judgement {
        let layout = &system.layout;
        let (mean, mut largest) = forces(layout, assembly);
        let mut q: [f64; KINDS] = std::array::from_fn(|k| mean[k].max(self.accepted[k]));
        q[FORCES] = q[FORCES].max(tolerance.rounding / tolerance.force_tol);
        // a reaction must be a number, too
        if let Some(dof) = assembly.residual.iter().position(|r| !r.is_finite()) {
            return Judgement::broken(dof, q);
        }
        // moments are sums of forces times distances, whose rounding stays where they cancel
        largest[ROTATIONS] += largest[FORCES] * tolerance.extent;
        let mut judgement = Judgement {
            q,
            ..Judgement::EMPTY
        };
        let mut least = f64::INFINITY;
        for &dof in dofs {
            let k = kind(layout.name(dof));
            let r = assembly.residual[dof as usize].abs();
            let floor = ROUND_OFF * largest[k] + assembly.uncertainty[dof as usize];
            judgement.round_off &= r <= floor;
            let limit = (tolerance.force_tol * q[k]).max(floor);
            judgement.small &= r <= limit;
            let excess = if k == MULTIPLIERS {
                &mut judgement.excess.multipliers
            } else {
                least = least.min(limit);
                &mut judgement.excess.forces
            };
            if r > *excess * limit {
                *excess = r / limit;
            }
            // equations of multipliers and moments may hold nothing but their residual: its mean says nothing
            let done = r == 0.0 || (k != FORCES && r <= floor);
            let relative = if done { 0.0 } else { r / q[k] };
            if relative > judgement.residual {
                judgement.residual = relative;
                judgement.worst = Some(dof);
                judgement.force = r;
            }
        }
        judgement.allowed = if least.is_finite() { least } else { 0.0 };
        judgement
    }
}

/// Of each kind, the mean over the loaded components of Σ_e |f_e|_i, and its maximum.
fn forces(layout: &Layout, assembly: &Assembly) -> ([f64; KINDS], [f64; KINDS]) {
    let mut largest = [0.0f64; KINDS];
    for (dof, m) in assembly.magnitude.iter().enumerate() {
        let k = kind(layout.name(dof as Dof));
        largest[k] = largest[k].max(*m);
    }
    let mut sum = [0.0; KINDS];
    let mut count = [0usize; KINDS];
    for (dof, m) in assembly.magnitude.iter().enumerate() {
        let k = kind(layout.name(dof as Dof));
        if *m > LOADED * largest[k] {
            sum[k] += m;
            count[k] += 1;
        }
    }
    let mean = std::array::from_fn(|k| sum[k] / count[k].max(1) as f64);
    (mean, largest)
}
