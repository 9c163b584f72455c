use super::logarithmic::Principal;
use super::principal::{InAxes, PAIRS};
use super::{Constants, ConstantsError, Material, MaterialError, Order, Response, Strain};
use std::f64::consts::PI;

/// A law that carries pressure alone, or tension alone, along each principal axis; no contraction across.
///
/// Each principal stress depends on the principal strain of its axis, smoothly, and tends to a residual stress on the side
/// that it does not carry. With `x = e/c`, `c = π s/E`, for a material without tension
///
/// ```text
/// s(e)  = E e (½ − atan(x)/π)                    → s for e → ∞, E e for e → −∞
/// s'(e) = E (½ − atan(x)/π − x/(π (1 + x²)))
/// W(e)  = E (e²/4 − c²/π h(x)),                  h(x) = ½ ((x² + 1) atan(x) − x)
/// ```
///
/// and for one without compression `−s(−e)`. The strain is linearized, or that of Green and Lagrange. The undeformed
/// material has half of Young's modulus. CalculiX names them `COMPRESSION_ONLY` and `TENSION_ONLY`.
#[derive(Clone, Debug)]
pub struct Unilateral {
    e: f64,
    /// `c`
    width: f64,
    /// 1 without tension, −1 without compression.
    sign: f64,
}

/// Up to here `h` is taken from its series, of this number of terms.
const SMALL: f64 = 0.3;
const TERMS: i32 = 18;

impl Unilateral {
    /// Without tension, from Young's modulus `E` and the stress `residual` that is left of it.
    ///
    /// # Errors
    /// One is missing, or not positive.
    pub fn no_tension(constants: &Constants) -> Result<Self, ConstantsError> {
        Self::new(constants, 1.0)
    }

    /// Without compression, from the same constants.
    ///
    /// # Errors
    /// One is missing, or not positive.
    pub fn no_compression(constants: &Constants) -> Result<Self, ConstantsError> {
        Self::new(constants, -1.0)
    }

    fn new(constants: &Constants, sign: f64) -> Result<Self, ConstantsError> {
        let e = constants.positive("E")?;
        let width = PI * constants.positive("residual")? / e;
        Ok(Self { e, width, sign })
    }

    /// `s`, `s'` and `W` at a principal strain.
    fn along(&self, strain: f64) -> [f64; 3] {
        let e = self.sign * strain;
        let x = e / self.width;
        let share = 0.5 - x.atan() / PI;
        let slope = share - x / (PI * (1.0 + x * x));
        let energy = 0.25 * e * e - self.width * self.width / PI * excess(x);
        [
            self.sign * self.e * e * share,
            self.e * slope,
            self.e * energy,
        ]
    }

    /// `(s(a) − s(b))/(a − b)`, without cancellation.
    fn between(&self, a: f64, b: f64) -> f64 {
        // of e atan(e/c): atan(a/c) + b (atan(a/c) − atan(b/c))/(a − b)
        let (a, b, c) = (self.sign * a, self.sign * b, self.width);
        let scale = c * c + a * b;
        let t = c * (a - b) / scale;
        let quotient = if scale <= 0.0 {
            ((a / c).atan() - (b / c).atan()) / (a - b)
        } else if t == 0.0 {
            c / scale
        } else {
            t.atan() / t * c / scale
        };
        self.e * (0.5 - ((a / c).atan() + b * quotient) / PI)
    }
}

/// `h`, with its digits where `x` is small: `Σ (−1)^(k+1) x^(2k+1)/((2k − 1)(2k + 1))`.
fn excess(x: f64) -> f64 {
    if x.abs() > SMALL {
        return 0.5 * ((x * x + 1.0) * x.atan() - x);
    }
    let terms = (1..=TERMS).rev().map(|k| f64::from(4 * k * k - 1).recip());
    x * x * x * terms.fold(0.0, |sum, term| term - x * x * sum)
}

impl Material for Unilateral {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let principal = Principal::new(&strain.value);
        let mut answer = InAxes::default();
        out.energy = 0.0;
        for (i, value) in principal.values.into_iter().enumerate() {
            let [stress, slope, energy] = self.along(value);
            answer.stress[i] = stress;
            answer.normal[i][i] = slope;
            out.energy += energy;
        }
        if order == Order::Tangent {
            let e = &principal.values;
            answer.shear = PAIRS.map(|(i, j)| self.between(e[i], e[j]));
        }
        answer.put(&principal, order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        0.5 * self.e
    }
}
