//! Cohesive laws: how a bond loses its stiffness as it is pulled apart.
//!
//! ```text
//!   t ▲
//!   N │   ╱╲            bilinear      (1 − D) K λ
//!     │  ╱  ╲
//!     │ ╱    ╲
//!   ──┼╱──────╲───▶ λ
//!        δ₀   δ_f
//! ```
//!
//! | symbol | name in code | |
//! |---|---|---|
//! | x = ⟨e_n⟩, y = \|e_s\| | `opening` | how far the sides are apart, along the normal and across it |
//! | K_n, K_s | `stiffness` | traction per opening of what is undamaged |
//! | N, S | `strength` | the largest traction of each mode |
//! | G_I, G_II | `toughness` | the energy per area that each mode takes |
//! | A = K_n x² + K_s y², B = K_s y²/A | | the share of shear in the energy |
//! | D | `grown` | the damage of a law without viscosity |
//! | D_v | `acting` | the damage that acts |
//! | τ | `viscosity` | a time |
//!
//! ```text
//! t = (1 − D_v)(K_n ⟨e_n⟩ ν + K_s e_s)                                          (E1)
//! D = max(D before, D of the law), 0 ≤ D ≤ 1                                    (E2)
//! D_v = D_v before + r/(1 + r) (D − D_v before),  r = Δt/τ;  D_v = D where τ = 0 (E3)
//! released in an increment: Φ(D_v) − Φ(D_v before) at its last B                 (E4)
//! viscous: ∫ ½ A dD_v − that, with an opening that changes evenly                (E5)
//! ```
//!
//! Laws hold no state: [`Damage`] is the caller's, once accepted and once as it was where the increment began.
//!
//! To add one: a file that implements [`CohesiveLaw`], and its line in `all` of the tests.

mod bilinear;
mod exponential;
#[cfg(test)]
mod tests;

pub use bilinear::{Bilinear, Initiation, Mixity};
pub use exponential::Exponential;

use signorini_geometry::tensor::Vec3;
use std::fmt::{self, Debug};
use std::sync::Arc;

/// The damage that loading without history leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loaded {
    /// The damage, from 0 to 1.
    pub damage: f64,
    /// Its derivatives with respect to the opening.
    pub slope: [f64; 2],
}

/// A law of damage.
pub trait CohesiveLaw: Debug + Send + Sync {
    /// K_n and K_s.
    fn stiffness(&self) -> [f64; 2];

    /// The damage of an opening that is the largest so far, with its derivatives.
    fn load(&self, opening: [f64; 2]) -> Loaded;

    /// Φ: the energy per area that damage has taken at the mode mix of an opening.
    fn released(&self, opening: [f64; 2], damage: f64) -> f64;
}

/// The damage of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damage {
    /// D.
    pub grown: f64,
    /// D_v.
    pub acting: f64,
}

/// What a bond has suffered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torn {
    /// The damage.
    pub damage: Damage,
    /// The stretch within the tangent plane at which friction would be none.
    pub sticks: Vec3,
}

/// A cohesive law with its viscosity.
#[derive(Clone, Debug)]
pub struct Cohesion {
    /// The law.
    pub law: Arc<dyn CohesiveLaw>,
    /// τ, 0: none.
    pub viscosity: f64,
}

/// The damage at an opening.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grown {
    /// The damage.
    pub damage: Damage,
    /// Derivatives of what acts with respect to the opening.
    pub slope: [f64; 2],
}

impl Cohesion {
    /// (E2), (E3).
    #[must_use]
    pub fn grow(&self, opening: [f64; 2], before: Damage, duration: f64) -> Grown {
        let loaded = self.law.load(opening);
        let grows = loaded.damage > before.grown;
        let grown = loaded.damage.max(before.grown);
        let share = if self.viscosity > 0.0 {
            duration / (self.viscosity + duration)
        } else {
            1.0
        };
        let acting = match share {
            1.0 => grown,
            share => before.acting + share * (grown - before.acting),
        };
        Grown {
            damage: Damage { grown, acting },
            slope: match grows {
                true => loaded.slope.map(|d| share * d),
                false => [0.0; 2],
            },
        }
    }

    /// (E4) and (E5): what damage releases and what viscosity takes, per area, on the way from one opening to the next.
    #[must_use]
    pub fn spent(&self, openings: [[f64; 2]; 2], [before, now]: [Damage; 2]) -> [f64; 2] {
        if now.acting == before.acting {
            return [0.0; 2];
        }
        let [from, to] = openings;
        let at = |damage: Damage| self.law.released(to, damage.acting);
        let released = at(now) - at(before);
        if self.viscosity == 0.0 {
            return [released, 0.0];
        }
        let k = self.law.stiffness();
        let mean = |a: f64, b: f64| (a * a + a * b + b * b) / 3.0;
        let energy = k[0] * mean(from[0], to[0]) + k[1] * mean(from[1], to[1]);
        let all = 0.5 * energy * (now.acting - before.acting);
        [released, all - released]
    }
}

/// Values that make no cohesive law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CohesionError {
    /// The bond breaks before it has taken its toughness: the least stiffness that is enough.
    Brittle {
        /// The one given.
        stiffness: f64,
        /// The least.
        least: f64,
    },
    /// The exponential law takes as much in shear as in opening.
    Unequal,
}

impl fmt::Display for CohesionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Brittle { stiffness, least } => write!(
                f,
                "a cohesive stiffness of {stiffness:.4e} stores more than the toughness before it breaks: at least {least:.4e} is needed"
            ),
            Self::Unequal => f.write_str(
                "exponential softening takes one toughness: give both modes the same, or write  softening = \"bilinear\"",
            ),
        }
    }
}

impl std::error::Error for CohesionError {}
