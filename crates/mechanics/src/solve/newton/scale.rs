//! How large residuals may be: condition (a).

use crate::solve::economy::Excess;
use crate::system::{Assembly, ByScale, Dof, Layout, MAX_FIELDS, System};

/// Condition (d): the last correction over the increment's displacement.
pub(super) const CORRECTION: f64 = 1e-2;

/// A component carries load where its forces exceed this part of the largest.
const LOADED: f64 = 1e-12;
/// Rounding error of a residual over the sum of the absolute values in it.
pub(super) const ROUND_OFF: f64 = 100.0 * f64::EPSILON;

/// A state, judged by its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Judgement {
    /// max |r| / q over the scales.
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
    /// The mean of each scale.
    pub q: ByScale,
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
        q: [0.0; MAX_FIELDS],
    };

    /// Of a state with a force that is no number.
    const fn broken(dof: usize, q: ByScale) -> Self {
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

/// Sizes of changes: of motions, and of each field with a scale of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sizes(ByScale);

impl Sizes {
    /// The largest of the values of each.
    pub fn new(layout: &Layout, value: impl Fn(usize) -> f64) -> Self {
        Self(layout.largest(value))
    }

    /// That of motions alone.
    #[cfg(test)]
    pub fn of_motions(size: f64) -> Self {
        Self::default().with_motions(size)
    }

    /// The same with another size of motions.
    pub const fn with_motions(mut self, size: f64) -> Self {
        self.0[Layout::FORCES] = size;
        self
    }

    /// The size of motions.
    pub const fn motions(self) -> f64 {
        self.0[Layout::FORCES]
    }

    /// The sizes times a factor.
    pub fn times(self, factor: f64) -> Self {
        Self(self.0.map(|size| factor * size))
    }

    /// The larger ones.
    pub fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].max(other.0[k])))
    }

    /// The same with those of fields with a scale of their own raised to where a correction of this size is small: a
    /// field that an increment leaves as it is has no change to compare with.
    pub fn at_least_of_own(self, rounding: Self) -> Self {
        let least = rounding.times(1.0 / CORRECTION).with_motions(0.0);
        self.max(least)
    }

    /// Whether none exceeds that of `most`.
    pub fn is_within(self, most: Self) -> bool {
        self.0.iter().zip(most.0).all(|(size, most)| *size <= most)
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

/// What counts as small: residuals are judged against their mean, separately for forces, moments, multipliers, and each
/// field with a scale of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::solve) struct ForceScale {
    /// q of each scale over the accepted states so far.
    accepted: ByScale,
}

impl ForceScale {
    pub fn accept(&mut self, q: ByScale) {
        for (a, q) in self.accepted.iter_mut().zip(q) {
            *a = a.max(q);
        }
    }

    /// The mean force over the accepted states so far.
    pub(super) const fn mean_force(&self) -> f64 {
        self.accepted[Layout::FORCES]
    }

    /// The values of the scales of a layout, for a checkpoint.
    pub fn values(&self, layout: &Layout) -> &[f64] {
        self.accepted.get(..layout.nscale()).unwrap_or_default()
    }

    /// Values that were stored.
    pub fn from_values(values: &[f64]) -> Self {
        let mut accepted = ByScale::default();
        let pairs = accepted.iter_mut().zip(values);
        pairs.for_each(|(to, value)| *to = *value);
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
        let mut q: ByScale = std::array::from_fn(|k| mean[k].max(self.accepted[k]));
        q[Layout::FORCES] = q[Layout::FORCES].max(tolerance.rounding / tolerance.force_tol);
        // a reaction must be a number, too
        if let Some(dof) = assembly.residual.iter().position(|r| !r.is_finite()) {
            return Judgement::broken(dof, q);
        }
        // moments are sums of forces times distances, whose rounding stays where they cancel
        largest[Layout::MOMENTS] += largest[Layout::FORCES] * tolerance.extent;
        let mut judgement = Judgement {
            q,
            ..Judgement::EMPTY
        };
        let mut least = f64::INFINITY;
        for &dof in dofs {
            let k = layout.scale(dof);
            let r = assembly.residual[dof as usize].abs();
            let floor = ROUND_OFF * largest[k] + assembly.uncertainty[dof as usize];
            judgement.round_off &= r <= floor;
            let limit = (tolerance.force_tol * q[k]).max(floor);
            judgement.small &= r <= limit;
            let excess = if k == Layout::MULTIPLIERS {
                &mut judgement.excess.multipliers
            } else {
                least = least.min(limit);
                &mut judgement.excess.forces
            };
            if r > *excess * limit {
                *excess = r / limit;
            }
            // all equations but forces may hold nothing but their residual: its mean says nothing
            let done = r == 0.0 || (k != Layout::FORCES && r <= floor);
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

/// Of each scale, the mean over the loaded components of Σ_e |f_e|_i, and its maximum.
fn forces(layout: &Layout, assembly: &Assembly) -> (ByScale, ByScale) {
    let mut largest = ByScale::default();
    for (dof, m) in assembly.magnitude.iter().enumerate() {
        let k = layout.scale(dof as Dof);
        largest[k] = largest[k].max(*m);
    }
    let mut sum = ByScale::default();
    let mut count = [0usize; MAX_FIELDS];
    for (dof, m) in assembly.magnitude.iter().enumerate() {
        let k = layout.scale(dof as Dof);
        if *m > LOADED * largest[k] {
            sum[k] += m;
            count[k] += 1;
        }
    }
    let mean = std::array::from_fn(|k| sum[k] / count[k].max(1) as f64);
    (mean, largest)
}
