use super::logarithmic::Logarithmic;
use super::ogden::exp_m1_less_linear;
use super::{
    Constants, ConstantsError, Kinematics, Lame, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

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
        let [mu, alpha, nu] = ["mu", "alpha", "nu"].map(|name| constants.list(name));
        let (mu, alpha, nu) = (mu?, alpha?, nu?);
        if mu.len() != alpha.len() || ![1, mu.len()].contains(&nu.len()) {
            return Err(ConstantsError::Unfit {
                what: "mu and alpha must have as many numbers each, nu as many or one",
            });
        }
        if let Some(&value) = alpha.iter().find(|a| **a == 0.0 || !a.is_finite()) {
            return Err(ConstantsError::Range {
                name: "alpha",
                value,
                allowed: "a number other than 0",
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

    /// `τ`, its derivative and the energy in the principal axes.
    fn principal(&self, strain: &[f64; 3], order: Order, out: &mut Response) {
        let trace = strain[0] + strain[1] + strain[2];
        let (mut stress, mut normal, mut shear) = ([0.0; 3], [[0.0; 3]; 3], [0.0; 3]);
        out.energy = 0.0;
        for &Term { mu, alpha, beta } in &self.terms {
            let x = strain.map(|e| (alpha * e).exp_m1());
            let volume = (-alpha * beta * trace).exp_m1();
            // what is linear cancels: x_i − α ε_i, and (J^(−αβ) − 1)/β + α e
            let change = match beta {
                0.0 => 0.0,
                beta => exp_m1_less_linear(-alpha * beta * trace) / beta,
            };
            let stretched: f64 = strain.iter().map(|e| exp_m1_less_linear(alpha * e)).sum();
            out.energy += 2.0 * mu / (alpha * alpha) * (stretched + change);
            for i in 0..3 {
                stress[i] += 2.0 * mu / alpha * (x[i] - volume);
                for to in &mut normal[i] {
                    *to += 2.0 * mu * beta * (1.0 + volume);
                }
                normal[i][i] += 2.0 * mu * (1.0 + x[i]);
            }
            for (shear, (i, j)) in shear.iter_mut().zip([(0, 1), (1, 2), (0, 2)]) {
                // (τ_i − τ_j)/(ε_i − ε_j)/2
                let distance = alpha * (strain[i] - strain[j]);
                let share = if distance == 0.0 {
                    1.0
                } else {
                    distance.exp_m1() / distance
                };
                *shear += mu * (1.0 + x[j]) * share;
            }
        }
        out.stress = Sym3::diagonal(stress[0], stress[1], stress[2]);
        if order == Order::Tangent {
            out.tangent = [[0.0; 6]; 6];
            for i in 0..3 {
                out.tangent[i][..3].copy_from_slice(&normal[i]);
                out.tangent[i + 3][i + 3] = shear[i];
            }
        }
    }
}

impl Material for Hyperfoam {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        if strain.kinematics == Kinematics::Small {
            self.lame.respond(&strain.value, order, out);
            return Ok(());
        }
        let logarithmic = Logarithmic::new(&strain.value)?;
        self.principal(&logarithmic.strain, order, out);
        logarithmic.pull_back(order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }
}
