use super::logarithmic::Logarithmic;
use super::{
    Constants, ConstantsError, Kinematics, Lame, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

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
        let (mu, alpha) = (constants.list("mu")?, constants.list("alpha")?);
        if mu.len() != alpha.len() {
            return Err(ConstantsError::Unfit {
                what: "mu and alpha must have as many numbers each",
            });
        }
        if let Some(&value) = alpha.iter().find(|a| **a == 0.0 || !a.is_finite()) {
            return Err(ConstantsError::Range {
                name: "alpha",
                value,
                allowed: "a number other than 0",
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

    /// `τ`, its derivative and the energy in the principal axes.
    fn principal(&self, strain: &[f64; 3], order: Order, out: &mut Response) {
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
        let mut stress = [pressure; 3];
        let mut normal = [[slope; 3]; 3];
        let mut shear = [0.0; 3];
        out.energy = energy;
        for &Term { mu, alpha } in &self.terms {
            let d = strain.map(|e| alpha * (e - trace / 3.0));
            let x = d.map(f64::exp_m1);
            let mean = (x[0] + x[1] + x[2]) / 3.0;
            for i in 0..3 {
                stress[i] += 2.0 * mu / alpha * (x[i] - mean);
                out.energy += 2.0 * mu / (alpha * alpha) * exp_m1_less_linear(d[i]);
                normal[i][i] += 2.0 * mu * (1.0 + x[i]);
                for j in 0..3 {
                    normal[i][j] -= 2.0 * mu / 3.0 * (1.0 + x[i] + x[j] - mean);
                }
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

impl Material for Ogden {
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

/// `exp(x) − 1 − x`, with its digits where `x` is small.
pub(super) fn exp_m1_less_linear(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    // ½x² (1 + x/3 (1 + x/4 (…)))
    let mut sum = 1.0;
    for n in (3..18).rev() {
        sum = 1.0 + sum * x / f64::from(n);
    }
    0.5 * x * x * sum
}
