use super::stretches::{InStretches, Principal, exp_m1_less_linear, exponents};
use super::{Constants, ConstantsError, Lame};

/// The compressible law of Ogden; Mooney and Rivlin's is the one with two terms.
///
/// ```text
/// W = Σ_p 2μ_p/α_p² (l̄_1^α_p + l̄_2^α_p + l̄_3^α_p − 3) + K/2 (J − 1)²,      l̄_i = J^(−1/3) l_i
/// ```
///
/// in the principal stretches `l_i`. The initial shear modulus is `μ_0 = Σ μ_p`, the bulk modulus `K`. This is Abaqus's
/// form with `D_1 = 2/K`; in Ogden's own, `μ_p/α_p` stands for `2μ_p/α_p²`, and `μ_0 = ½ Σ μ_p α_p`.
///
/// It is evaluated by logarithmic principal strains `ε_i`, whose deviator is `d_i = ε_i − ⅓ Σ ε`, with `x_i = exp(α d_i)`:
///
/// ```text
/// τ_i = Σ_p 2μ/α (x_i − x̄) + K J (J − 1),      ∂τ_i/∂ε_j = Σ_p 2μ (x_i δ_ij − ⅓(x_i + x_j − x̄)) + K J (2J − 1)
/// ```
///
/// with the mean `x̄`. At small strain it is linear elasticity with `μ_0` and `K`.
///
/// # Limits
/// The volumetric energy stays finite as `J → 0`; that of [`Ogden::mooney_rivlin_logarithmic`], `K/2 (ln J)²`, does not,
/// and its pressure falls again beyond `J = e`.
///
/// # Source
/// Ogden, *Proc. R. Soc. Lond. A* 328 (1972) 567–583; Holzapfel, *Nonlinear Solid Mechanics* 2000, section 6.5.
#[derive(Clone, Debug)]
pub struct Ogden {
    terms: Vec<Term>,
    bulk: f64,
    volume: Volume,
    lame: Lame,
}

/// The energy of a change of volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Volume {
    /// K/2 (J − 1)².
    Quadratic,
    /// K/2 (ln J)².
    Logarithmic,
}

#[derive(Clone, Copy, Debug)]
struct Term {
    mu: f64,
    alpha: f64,
}

impl Ogden {
    /// From the constants `mu` and `alpha`, lists of one length, and `bulk`.
    ///
    /// # Errors
    /// One is missing, the lists are not of one length, an exponent is zero, the sum of `mu` or the bulk modulus is not
    /// positive.
    pub fn new(constants: &Constants) -> Result<Self, ConstantsError> {
        let (mu, alpha) = (constants.list("mu")?, exponents(constants)?);
        if mu.len() != alpha.len() {
            return Err(ConstantsError::Unfit {
                what: "mu and alpha must have as many numbers each",
            });
        }
        let sum: f64 = mu.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return Err(ConstantsError::Unfit {
                what: "the sum of mu, the initial shear modulus, must be greater than 0",
            });
        }
        let terms = mu.iter().zip(alpha);
        Ok(Self::from_terms(
            terms.map(|(&mu, &alpha)| Term { mu, alpha }).collect(),
            constants.positive("bulk")?,
        ))
    }

    /// Mooney and Rivlin's law `W = c10 (Ī_1 − 3) + c01 (Ī_2 − 3) + K/2 (J − 1)²`, from `c10`, `c01` and `bulk`: Ogden's
    /// with `μ = (2 c10, 2 c01)` and `α = (2, −2)`. `μ_0 = 2 (c10 + c01)`.
    ///
    /// # Errors
    /// One is missing, `c10 + c01` or the bulk modulus is not positive.
    pub fn mooney_rivlin(constants: &Constants) -> Result<Self, ConstantsError> {
        let (c10, c01) = (constants.number("c10")?, constants.number("c01")?);
        if !(c10 + c01 > 0.0 && (c10 + c01).is_finite()) {
            return Err(ConstantsError::Unfit {
                what: "c10 + c01, half the initial shear modulus, must be greater than 0",
            });
        }
        let term = |mu, alpha| Term { mu, alpha };
        Ok(Self::from_terms(
            vec![term(2.0 * c10, 2.0), term(2.0 * c01, -2.0)],
            constants.positive("bulk")?,
        ))
    }

    /// Mooney and Rivlin's law with the volumetric energy `K/2 (ln J)²`.
    ///
    /// # Errors
    /// Those of [`Ogden::mooney_rivlin`].
    pub fn mooney_rivlin_logarithmic(constants: &Constants) -> Result<Self, ConstantsError> {
        Ok(Self {
            volume: Volume::Logarithmic,
            ..Self::mooney_rivlin(constants)?
        })
    }

    fn from_terms(terms: Vec<Term>, bulk: f64) -> Self {
        let mu = terms.iter().map(|t| t.mu).sum();
        let lambda = bulk - 2.0 / 3.0 * mu;
        Self {
            terms,
            bulk,
            volume: Volume::Quadratic,
            lame: Lame { lambda, mu },
        }
    }
}

impl InStretches for Ogden {
    fn initial(&self) -> &Lame {
        &self.lame
    }

    fn add(&self, strain: &[f64; 3], to: &mut Principal) {
        let trace = strain[0] + strain[1] + strain[2];
        let dilation = trace.exp_m1(); // J − 1
        let ratio = 1.0 + dilation;
        // τ of a change of volume, its derivative by the trace, its energy
        let (pressure, slope, energy) = match self.volume {
            Volume::Quadratic => (
                self.bulk * ratio * dilation,
                self.bulk * ratio * (ratio + dilation),
                0.5 * self.bulk * dilation * dilation,
            ),
            Volume::Logarithmic => (
                self.bulk * trace,
                self.bulk,
                0.5 * self.bulk * trace * trace,
            ),
        };
        to.stress = [pressure; 3];
        to.normal = [[slope; 3]; 3];
        to.energy = energy;
        for &Term { mu, alpha } in &self.terms {
            let d = strain.map(|e| alpha * (e - trace / 3.0));
            let x = d.map(f64::exp_m1);
            let mean = (x[0] + x[1] + x[2]) / 3.0;
            for i in 0..3 {
                to.stress[i] += 2.0 * mu / alpha * (x[i] - mean);
                to.energy += 2.0 * mu / (alpha * alpha) * exp_m1_less_linear(d[i]);
                to.normal[i][i] += 2.0 * mu * (1.0 + x[i]);
                for j in 0..3 {
                    to.normal[i][j] -= 2.0 * mu / 3.0 * (1.0 + x[i] + x[j] - mean);
                }
            }
            to.shear(mu, alpha, strain, x);
        }
    }
}
