//! What a contact law is.

use std::fmt::Debug;

/// What a law does with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiplier {
    /// Has none.
    None,
    /// Keeps it frozen during an increment's iterations and updates it after.
    Frozen,
    /// Solves for it; the pressure is that of the augmented Lagrangian.
    Augmented,
    /// Solves for it; it is the pressure.
    Direct,
}

impl Multiplier {
    /// Whether it is an unknown of the system.
    #[must_use]
    pub const fn is_unknown(self) -> bool {
        matches!(self, Self::Augmented | Self::Direct)
    }
}

/// The numbers a law scales with, from the model behind the row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// ε, or c: pressure (or force) per gap.
    pub penalty: f64,
    /// c_t: shear traction (or force) per slip, of unknown multipliers under friction.
    pub shear: f64,
    /// Size of the facets.
    pub length: f64,
}

/// A value with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Eval {
    /// The value.
    pub value: f64,
    /// Derivative with respect to the gap.
    pub dgap: f64,
    /// Derivative with respect to the multiplier.
    pub dlambda: f64,
}

/// A contact law.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Penalty, Scale};
///
/// let scale = Scale { penalty: 1e4, shear: 1e4, length: 1.0 };
/// let at = Penalty.pressure(-0.01, 0.0, &scale);
/// assert_eq!((at.value, at.dgap), (100.0, -1e4));
/// assert_eq!(Penalty.pressure(0.01, 0.0, &scale).value, 0.0);
/// // the energy of a spring, ½ ε g²
/// assert_eq!(Penalty.energy(-0.01, 0.0, &scale), Some(0.5));
/// ```
pub trait ContactLaw: Debug + Send + Sync {
    /// Its name in messages, as in a case.
    fn name(&self) -> &str;

    /// What it does with a multiplier.
    fn multiplier(&self) -> Multiplier {
        Multiplier::None
    }

    /// The pressures of many rows, ≥ 0 in compression; all zero where one is open. A law may pull a little
    /// ([`Arctangent`](super::Arctangent)), or as adhesion does ([`Dugdale`](super::Dugdale)).
    ///
    /// # Shapes
    /// One gap, one multiplier and one answer for each row. What a row is answered does not depend on the others:
    /// [`each`] makes this of a formula.
    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]);

    /// The pressure of one row.
    fn pressure(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval {
        let mut out = [Eval::default()];
        self.pressures(&[gap], &[lambda], scale, &mut out);
        let [at] = out;
        at
    }

    /// The function whose root is contact; zero for laws without an unknown multiplier.
    fn complementarity(&self, _gap: f64, _lambda: f64, _scale: &Scale) -> Eval {
        Eval::default()
    }

    /// The pressure that a multiplier is compared with, `λ + ε c(g, λ)`: what friction is limited by. Without a multiplier
    /// that is solved for, the pressure itself.
    fn trial(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval {
        let at = self.pressure(gap, lambda, scale);
        if !self.multiplier().is_unknown() || at == Eval::default() {
            return at;
        }
        let c = self.complementarity(gap, lambda, scale);
        Eval {
            // not even by rounding: a limit of friction has no sign
            value: (lambda + scale.penalty * c.value).max(0.0),
            dgap: scale.penalty * c.dgap,
            dlambda: 1.0 + scale.penalty * c.dlambda,
        }
    }

    /// Whether its pressure may grow with the gap: the stiffness is then not definite, and states may be unstable.
    fn softens(&self) -> bool {
        false
    }

    /// The potential of the pressure, `p = −∂W/∂g`, where there is one.
    fn energy(&self, gap: f64, lambda: f64, scale: &Scale) -> Option<f64>;
}

/// Answers each row with the formula of a law: of its gap and multiplier.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{Eval, each};
///
/// let springs = |gap: f64, _: f64| Eval { value: -2.0 * gap, dgap: -2.0, dlambda: 0.0 };
/// let mut out = [Eval::default(); 2];
/// each(&[-0.5, -1.0], &[0.0, 0.0], &mut out, springs);
/// assert_eq!(out.map(|at| at.value), [1.0, 2.0]);
/// ```
#[inline]
pub fn each(gaps: &[f64], lambdas: &[f64], out: &mut [Eval], law: impl Fn(f64, f64) -> Eval) {
    for ((out, gap), lambda) in out.iter_mut().zip(gaps).zip(lambdas) {
        *out = law(*gap, *lambda);
    }
}

/// Gap over the size of the facets up to which a surface touches.
pub(super) const TOUCH: f64 = 1e-12;
