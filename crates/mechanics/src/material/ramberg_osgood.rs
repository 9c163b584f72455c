use super::logarithmic::{Logarithmic, Principal};
use super::principal::{InAxes, PAIRS, squares};
use super::{
    Constants, ConstantsError, Kinematics, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

/// The deformation theory of plasticity with the curve of Ramberg and Osgood: nonlinear elasticity, the same path back
/// and forth.
///
/// Under uniaxial stress `E e = s + α (|s|/s₀)ⁿ⁻¹ s`. In general, with the equivalent stress `q` of von Mises and the
/// equivalent strain `ε = √(⅔ e:e)` of the deviator `e`,
///
/// ```text
/// ε = q/(3μ) + α/E (q/s₀)ⁿ⁻¹ q                                   solved for q
/// σ = K tr(ε) I + 2G e,    G = q/(3ε),    G_t = ⅓ dq/dε
/// C = K I⊗I + 2G I_dev + 4/3 (G_t − G)/ε² e⊗e
/// W = ½ K tr(ε)² + q²/(6μ) + α/E n/(n + 1) (q/s₀)ⁿ⁻¹ q²
/// ```
///
/// At finite strain the curve is between one of two pairs:
///
/// | | stress | strain | |
/// |---|---|---|---|
/// | [`Self::logarithmic`] | Kirchhoff | logarithmic | has a potential |
/// | [`Self::eulerian`] | Cauchy | of Almansi, `½ (I − F⁻ᵀF⁻¹)` | has none, its tangent is not symmetric |
///
/// The second is what CalculiX documents; with `c_i = 1 + 2E_i` its principal values are
///
/// ```text
/// S_i = J σ_i(a)/c_i,   a_i = E_i/c_i,   ∂S_i/∂E_j = J σ_i/(c_i c_j) (1 − 2 δ_ij) + J/(c_i c_j²) ∂σ_i/∂a_j
/// (S_i − S_j)/(E_i − E_j) = 2J/(c_i c_j) (G/c_i − σ_j)
/// ```
///
/// and its energy `J W(a)`, a measure alone. The strain of Almansi is at most ½: sheets and bars that are compressed to where
/// its trace cannot vanish have no state without stress across.
///
/// History: the equivalent plastic strain `α/E (q/s₀)ⁿ⁻¹ q`, for results.
///
/// Source: Ramberg and Osgood, NACA TN 902, 1943; Hutchinson, *J. Mech. Phys. Solids* 16 (1968) 13–31, section 2.
#[derive(Clone, Debug)]
pub struct RambergOsgood {
    e: f64,
    bulk: f64,
    shear: f64,
    /// `s₀`
    stress: f64,
    /// `n`
    exponent: f64,
    /// `α`
    offset: f64,
    eulerian: bool,
}

/// Newton steps for the equivalent stress; from above, where the curve is convex, ten do.
const STEPS: usize = 60;

/// What a deviator is answered with.
struct Secant {
    /// `G`
    shear: f64,
    /// `4/3 (G_t − G)/ε²`
    change: f64,
    energy: f64,
    plastic: f64,
}

impl RambergOsgood {
    /// From `E`, `nu`, the stress `reference_stress` at which the plastic strain is `offset` times the elastic one, and
    /// the `exponent` of the curve; between Kirchhoff's stress and the logarithmic strain.
    ///
    /// # Errors
    /// One is missing, or out of its range.
    pub fn logarithmic(constants: &Constants) -> Result<Self, ConstantsError> {
        Self::new(constants, false)
    }

    /// From the same constants; between Cauchy's stress and the strain of Almansi.
    ///
    /// # Errors
    /// One is missing, or out of its range.
    pub fn eulerian(constants: &Constants) -> Result<Self, ConstantsError> {
        Self::new(constants, true)
    }

    fn new(constants: &Constants, eulerian: bool) -> Result<Self, ConstantsError> {
        let (e, nu) = constants.isotropic()?;
        let at_least = |name, least: f64, allowed| {
            let value = constants.number(name)?;
            if value >= least && value.is_finite() {
                return Ok(value);
            }
            Err(ConstantsError::Range {
                name,
                value,
                allowed,
            })
        };
        Ok(Self {
            e,
            bulk: e / (3.0 * (1.0 - 2.0 * nu)),
            shear: e / (2.0 * (1.0 + nu)),
            stress: constants.positive("reference_stress")?,
            exponent: at_least("exponent", 1.0, "at least 1")?,
            offset: at_least("offset", 0.0, "not negative")?,
            eulerian,
        })
    }

    /// The plastic part of the equivalent strain at the equivalent stress `q`.
    fn plastic(&self, q: f64) -> f64 {
        self.offset / self.e * (q / self.stress).powf(self.exponent - 1.0) * q
    }

    /// The equivalent stress of an equivalent strain, from above by Newton's method.
    fn equivalent(&self, strain: f64) -> Result<f64, MaterialError> {
        let elastic = 3.0 * self.shear;
        let mut q = elastic * strain;
        if self.offset > 0.0 {
            let scale = self.e * strain / (self.offset * self.stress);
            q = q.min(self.stress * scale.powf(self.exponent.recip()));
        }
        for _ in 0..STEPS {
            if q <= 0.0 {
                return Ok(0.0);
            }
            let plastic = self.plastic(q);
            let excess = q / elastic + plastic - strain;
            let step = excess / (elastic.recip() + self.exponent * plastic / q);
            // the rest is rounding
            if step <= f64::EPSILON * q {
                return Ok(q - step);
            }
            q -= step;
        }
        Err(MaterialError::NotConverged {
            what: "stress on the curve of Ramberg and Osgood",
        })
    }

    fn secant(&self, deviator: &Sym3) -> Result<Secant, MaterialError> {
        let strain = (deviator.double_dot(*deviator) * 2.0 / 3.0).sqrt();
        let q = self.equivalent(strain)?;
        let plastic = self.plastic(q);
        let share = if q > 0.0 {
            plastic / q
        } else if self.exponent == 1.0 {
            self.offset / self.e
        } else {
            0.0
        };
        let elastic = (3.0 * self.shear).recip();
        let shear = (elastic + share).recip() / 3.0;
        let tangent = (elastic + self.exponent * share).recip() / 3.0;
        let square = strain * strain;
        Ok(Secant {
            shear,
            change: if square > 0.0 {
                4.0 / 3.0 * (tangent - shear) / square
            } else {
                0.0
            },
            energy: q * q * (0.5 * elastic + share * self.exponent / (self.exponent + 1.0)),
            plastic,
        })
    }

    /// The law between one stress and one strain.
    fn linearized(
        &self,
        strain: &Sym3,
        order: Order,
        out: &mut Response,
    ) -> Result<f64, MaterialError> {
        let trace = strain.trace();
        let deviator = *strain - Sym3::IDENTITY * (trace / 3.0);
        let secant = self.secant(&deviator)?;
        out.stress = deviator * (2.0 * secant.shear) + Sym3::IDENTITY * (self.bulk * trace);
        out.energy = secant.energy + 0.5 * self.bulk * trace * trace;
        if order == Order::Tangent {
            let e = deviator.to_pairs();
            let lambda = self.bulk - 2.0 / 3.0 * secant.shear;
            for (p, row) in out.tangent.iter_mut().enumerate() {
                *row = e.map(|other| secant.change * e[p] * other);
                if p < 3 {
                    row[..3].iter_mut().for_each(|c| *c += lambda);
                    row[p] += 2.0 * secant.shear;
                } else {
                    row[p] += secant.shear;
                }
            }
        }
        Ok(secant.plastic)
    }

    /// The law between Cauchy's stress and the strain of Almansi.
    fn spatial(
        &self,
        strain: &Sym3,
        order: Order,
        out: &mut Response,
    ) -> Result<f64, MaterialError> {
        let principal = Principal::new(strain);
        let c = squares(&principal.values)?;
        let mut a = [0.0; 3];
        for ((to, e), c) in a.iter_mut().zip(principal.values).zip(c) {
            *to = e / c;
        }
        let trace = a.iter().sum::<f64>();
        let deviator = a.map(|a| a - trace / 3.0);
        let secant = self.secant(&Sym3::diagonal(deviator[0], deviator[1], deviator[2]))?;
        let (g, mean) = (secant.shear, self.bulk * trace);
        let cauchy = deviator.map(|e| 2.0 * g * e + mean);
        let ratio = (c[0] * c[1] * c[2]).sqrt();
        let mut answer = InAxes::default();
        for i in 0..3 {
            answer.stress[i] = ratio * cauchy[i] / c[i];
            for j in 0..3 {
                let same = f64::from(u8::from(i == j));
                let slope = self.bulk
                    + 2.0 * g * (same - 1.0 / 3.0)
                    + secant.change * deviator[i] * deviator[j];
                let turned = cauchy[i] * (1.0 - 2.0 * same) + slope / c[j];
                answer.normal[i][j] = ratio / (c[i] * c[j]) * turned;
            }
        }
        answer.shear = PAIRS.map(|(i, j)| 2.0 * ratio / (c[i] * c[j]) * (g / c[i] - cauchy[j]));
        out.energy = ratio * (secant.energy + 0.5 * self.bulk * trace * trace);
        answer.put(&principal, order, out);
        Ok(secant.plastic)
    }
}

impl Material for RambergOsgood {
    fn nhistory(&self) -> usize {
        1
    }

    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let plastic = match (strain.kinematics, self.eulerian) {
            (Kinematics::Small, _) => self.linearized(&strain.value, order, out)?,
            (Kinematics::Finite, true) => self.spatial(&strain.value, order, out)?,
            (Kinematics::Finite, false) => {
                let logarithmic = Logarithmic::new(&strain.value)?;
                let plastic = self.linearized(&logarithmic.value(), order, out)?;
                logarithmic.pull_back(order, out);
                plastic
            }
        };
        if let Some(to) = new.first_mut() {
            *to = plastic;
        }
        Ok(())
    }

    /// That of the elastic part; with an exponent of 1 the plastic part counts, too.
    fn modulus(&self) -> f64 {
        let mut softness = (3.0 * self.shear).recip();
        if self.exponent == 1.0 {
            softness += self.offset / self.e;
        }
        self.bulk + 4.0 / 9.0 / softness
    }

    fn is_symmetric(&self) -> bool {
        !self.eulerian
    }

    /// Plastic strains are for results.
    fn is_elastic(&self) -> bool {
        true
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        history.first().copied()
    }
}
