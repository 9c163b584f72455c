use super::{ContactLaw, Eval, Scale, each};
use signorini_vocabulary::{Description, Entry, NOT_NEGATIVE, POSITIVE, key};
use std::sync::Arc;

/// The entry of [`Exponential`].
pub(super) const ENTRY: Entry<Arc<dyn ContactLaw>> = Entry {
    description: Description::new(
        "exponential",
        "a pressure that grows exponentially as the gap closes",
        &[
            key("p0", POSITIVE, "pressure at zero gap").required(),
            key("c0", POSITIVE, "the gap at which it has fallen to 1 %").required(),
            key(
                "within",
                NOT_NEGATIVE,
                "the gap beyond which nothing acts (length); absent: it acts at any distance",
            ),
        ],
    ),
    make: |values| {
        Ok(Arc::new(Exponential {
            p0: values.number("p0")?,
            c0: values.number("c0")?,
            within: values.number_if("within").unwrap_or(f64::INFINITY),
        }))
    },
};

/// A pressure that falls exponentially with the gap: `p0` at `g = 0`, 1 % of it at `g = c0`; without end inside, and
/// outside up to a gap.
///
/// `p = p0 exp(ln(0.01) g/c0)`; below `g = −2 c0` it goes on along its tangent, so that a bad start does not overflow.
/// Beyond `within` there is nothing: the pressure jumps there.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Exponential, Scale};
///
/// let law = Exponential { p0: 5.0, c0: 0.1, within: f64::INFINITY };
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// let pressure = |gap| law.pressure(gap, 0.0, &scale).value;
/// assert!((pressure(0.0) - 5.0).abs() < 1e-14);
/// assert!((pressure(0.1) - 0.05).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// Pressure at zero gap.
    pub p0: f64,
    /// The gap at which it has fallen to 1 %.
    pub c0: f64,
    /// The gap beyond which nothing acts; infinite where it acts at any distance.
    pub within: f64,
}

impl Exponential {
    /// The gap below which the curve is its tangent, over c0.
    const STRAIGHT: f64 = -2.0;

    fn rate(&self) -> f64 {
        0.01_f64.ln() / self.c0
    }

    /// Pressure and slope of the curve itself.
    fn at(&self, gap: f64) -> (f64, f64) {
        let p = self.p0 * (self.rate() * gap).exp();
        (p, self.rate() * p)
    }

    /// The potential, zero far outside.
    fn potential(&self, gap: f64) -> f64 {
        let bend = gap.max(Self::STRAIGHT * self.c0);
        let (value, slope) = self.at(bend);
        let further = gap - bend;
        -value / self.rate() - value * further - 0.5 * slope * further * further
    }
}

impl ContactLaw for Exponential {
    fn name(&self) -> &str {
        ENTRY.description.name
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            if gap > self.within {
                return Eval::default();
            }
            let bend = gap.max(Self::STRAIGHT * self.c0);
            let (value, slope) = self.at(bend);
            Eval {
                value: value + slope * (gap - bend),
                dgap: slope,
                dlambda: 0.0,
            }
        });
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let beyond = match self.within.is_finite() {
            true => self.potential(self.within),
            false => 0.0,
        };
        Some(self.potential(gap.min(self.within)) - beyond)
    }
}
