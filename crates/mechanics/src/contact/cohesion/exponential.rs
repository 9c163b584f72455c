use super::{CohesionError, CohesiveLaw, Loaded};
use std::f64::consts::E;

/// A traction that rises to the strength and falls exponentially.
///
/// ```text
/// λ² = ⟨e_n⟩² + β² |e_s|²,   β = S/N,   δ_c = G_c/(e N)
/// t = (G_c/δ_c²) e^{−κ/δ_c} (⟨e_n⟩ ν + β² e_s),   κ = max λ
/// Φ = G_c [1 − (1 + z + z²/2) e^{−z}],   z = κ/δ_c
/// ```
///
/// so that `K = G_c/δ_c² [1, β²]` and `D = 1 − e^{−κ/δ_c}`: it has no elastic part, and no number of its own for the stiffness.
///
/// # Source
/// Ortiz and Pandolfi, IJNME 44, 1999, equations (26) to (38).
///
/// # Example
/// ```
/// use signorini_mechanics::contact::cohesion::{CohesiveLaw, Exponential};
///
/// let law = Exponential::new([20.0, 30.0], [0.5; 2])?;
/// // the traction is largest at δ_c, where it is the strength
/// let (d, k) = (0.5 / (20.0 * std::f64::consts::E), law.stiffness());
/// assert!(((1.0 - law.load([d, 0.0]).damage) * k[0] * d - 20.0).abs() < 1e-12);
/// # Ok::<(), signorini_mechanics::contact::cohesion::CohesionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// δ_c.
    length: f64,
    /// β².
    square: f64,
    toughness: f64,
}

impl Exponential {
    /// The law.
    ///
    /// # Errors
    /// Modes of different toughness.
    pub fn new(strength: [f64; 2], toughness: [f64; 2]) -> Result<Self, CohesionError> {
        let ([n, s], [g, other]) = (strength, toughness);
        if g != other {
            return Err(CohesionError::Unequal);
        }
        Ok(Self {
            length: g / (E * n),
            square: (s / n) * (s / n),
            toughness: g,
        })
    }

    /// δ_c, at which the traction is largest.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }
}

impl CohesiveLaw for Exponential {
    fn stiffness(&self) -> [f64; 2] {
        let k = self.toughness / (self.length * self.length);
        [k, self.square * k]
    }

    fn load(&self, [x, y]: [f64; 2]) -> Loaded {
        let way = (x * x + self.square * y * y).sqrt();
        if way <= 0.0 {
            return Loaded::default();
        }
        let left = (-way / self.length).exp();
        let by_way = left / (self.length * way);
        Loaded {
            damage: 1.0 - left,
            slope: [by_way * x, by_way * self.square * y],
        }
    }

    fn released(&self, _: [f64; 2], damage: f64) -> f64 {
        let left = 1.0 - damage;
        if left <= 0.0 {
            return self.toughness;
        }
        let z = -left.ln();
        self.toughness * (1.0 - (1.0 + z + 0.5 * z * z) * left)
    }
}
