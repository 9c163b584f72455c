use super::stretches::{InStretches, Principal, exp_m1_less_linear, exponents};
use super::{Constants, ConstantsError, Lame};

/// The law of foams, which change their volume easily.
///
/// ```text
/// W = Σ_p 2μ_p/α_p² (l_1^α_p + l_2^α_p + l_3^α_p − 3 + (J^(−α_p β_p) − 1)/β_p),      β_p = ν_p/(1 − 2ν_p)
/// ```
///
/// in the principal stretches `l_i`; where `ν_p = 0`, the last term is `−α_p ln J`. The initial shear modulus is
/// `Σ μ_p`, the initial bulk modulus `Σ 2μ_p (⅓ + β_p)`. By logarithmic principal strains `ε_i`, `e = Σ ε`:
///
/// ```text
/// τ_i = Σ_p 2μ/α (exp(α ε_i) − exp(−αβ e)),      ∂τ_i/∂ε_j = Σ_p 2μ (exp(α ε_i) δ_ij + β exp(−αβ e))
/// ```
///
/// At small strain it is linear elasticity with the initial moduli.
///
/// # Source
/// Storåkers, *J. Mech. Phys. Solids* 34 (1986) 125–145; Ogden, *Proc. R. Soc. Lond. A* 328 (1972) 567–583.
#[derive(Clone, Debug)]
pub struct Hyperfoam {
    terms: Vec<Term>,
    lame: Lame,
}

#[derive(Clone, Copy, Debug)]
struct Term {
    mu: f64,
    alpha: f64,
    beta: f64,
}

impl Hyperfoam {
    /// From the constants `mu` and `alpha`, lists of one length, and `nu`, as many or one for all.
    ///
    /// # Errors
    /// One is missing, the lists do not fit each other, an exponent is zero, a `nu` is not between −1 and ½, or an
    /// initial modulus is not positive.
    pub fn new(constants: &Constants) -> Result<Self, ConstantsError> {
        let (mu, alpha) = (constants.list("mu")?, exponents(constants)?);
        let nu = constants.list("nu")?;
        if mu.len() != alpha.len() || ![1, mu.len()].contains(&nu.len()) {
            return Err(ConstantsError::Unfit {
                what: "mu and alpha must have as many numbers each, nu as many or one",
            });
        }
        if let Some(&value) = nu.iter().find(|nu| !(**nu > -1.0 && **nu < 0.5)) {
            return Err(ConstantsError::Range {
                name: "nu",
                value,
                allowed: "greater than -1 and less than 0.5",
            });
        }
        let terms: Vec<Term> = (mu.iter().zip(alpha).zip(nu.iter().cycle()))
            .map(|((&mu, &alpha), &nu)| Term {
                mu,
                alpha,
                beta: nu / (1.0 - 2.0 * nu),
            })
            .collect();
        let lame = Lame {
            lambda: terms.iter().map(|t| 2.0 * t.mu * t.beta).sum(),
            mu: terms.iter().map(|t| t.mu).sum(),
        };
        let bulk = lame.lambda + 2.0 / 3.0 * lame.mu;
        if !(lame.mu > 0.0 && bulk > 0.0 && (lame.mu + bulk).is_finite()) {
            return Err(ConstantsError::Unfit {
                what: "the initial moduli, sums over mu, must be greater than 0",
            });
        }
        Ok(Self { terms, lame })
    }
}

impl InStretches for Hyperfoam {
    fn initial(&self) -> &Lame {
        &self.lame
    }

    fn add(&self, strain: &[f64; 3], to: &mut Principal) {
        let trace = strain[0] + strain[1] + strain[2];
        for &Term { mu, alpha, beta } in &self.terms {
            let x = strain.map(|e| (alpha * e).exp_m1());
            let volume = (-alpha * beta * trace).exp_m1();
            // linear terms cancel: x_i − α ε_i, and (J^(−αβ) − 1)/β + α e
            let change = match beta {
                0.0 => 0.0,
                beta => exp_m1_less_linear(-alpha * beta * trace) / beta,
            };
            let stretched: f64 = strain.iter().map(|e| exp_m1_less_linear(alpha * e)).sum();
            to.energy += 2.0 * mu / (alpha * alpha) * (stretched + change);
            for (i, x) in x.into_iter().enumerate() {
                to.stress[i] += 2.0 * mu / alpha * (x - volume);
                for normal in &mut to.normal[i] {
                    *normal += 2.0 * mu * beta * (1.0 + volume);
                }
                to.normal[i][i] += 2.0 * mu * (1.0 + x);
            }
            to.shear(mu, alpha, strain, x);
        }
    }
}
