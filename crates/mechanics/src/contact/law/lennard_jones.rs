use super::{ContactLaw, Eval, Scale, each};
use signorini_vocabulary::{Description, Entry, POSITIVE, key};
use std::sync::Arc;

/// The entry of [`LennardJones`].
pub(super) const ENTRY: Entry<Arc<dyn ContactLaw>> = Entry {
    description: Description::new(
        "lennard_jones",
        "adhesion: the pressure between half-spaces of atoms",
        &[
            key("work", POSITIVE, "work of adhesion, per area").required(),
            key(
                "range",
                POSITIVE,
                "the distance of atoms that touch (length)",
            )
            .required(),
        ],
    ),
    make: |values| {
        Ok(Arc::new(LennardJones {
            work: values.number("work")?,
            range: values.number("range")?,
        }))
    },
};

/// `p = −(8 w_a/3z₀) [(z₀/z)³ − (z₀/z)⁹]` with `z = g + z₀`: no pressure at zero gap, and the largest tension at a fifth of z₀.
///
/// Below `g = −z₀/4` it goes on along its tangent, so that a bad start does not overflow.
///
/// # Source
/// Greenwood, Proc. R. Soc. Lond. A 453, 1997, equation (1).
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, LennardJones, Scale};
///
/// let law = LennardJones { work: 0.3, range: 2.0 };
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// // the largest tension, 16/(9√3) w_a/z₀
/// let most = law.pressure(2.0 * (3f64.powf(1.0 / 6.0) - 1.0), 0.0, &scale);
/// assert!((most.value + 16.0 / (9.0 * 3f64.sqrt()) * 0.15).abs() < 1e-14 && most.dgap.abs() < 1e-14);
/// assert!((law.energy(0.0, 0.0, &scale).unwrap() + 0.3).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LennardJones {
    /// w_a: work of adhesion, per area.
    pub work: f64,
    /// z₀.
    pub range: f64,
}

impl LennardJones {
    /// The gap over z₀ below which the curve is its tangent.
    const STRAIGHT: f64 = -0.25;

    /// Pressure and slope of the curve itself.
    fn at(&self, gap: f64) -> (f64, f64) {
        let (z0, ratio) = (self.range, self.range / (gap + self.range));
        let (scale, third) = (8.0 * self.work / (3.0 * z0), ratio.powi(3));
        let ninth = third.powi(3);
        let slope = scale * ratio / z0 * (3.0 * third - 9.0 * ninth);
        (scale * (ninth - third), slope)
    }

    /// The potential of the curve, zero far outside.
    fn potential(&self, gap: f64) -> f64 {
        let ratio = self.range / (gap + self.range);
        self.work * (ratio.powi(8) - 4.0 * ratio * ratio) / 3.0
    }
}

impl ContactLaw for LennardJones {
    fn name(&self) -> &str {
        ENTRY.description.name
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            let bend = gap.max(Self::STRAIGHT * self.range);
            let (value, slope) = self.at(bend);
            Eval {
                value: value + slope * (gap - bend),
                dgap: slope,
                dlambda: 0.0,
            }
        });
    }

    fn softens(&self) -> bool {
        true
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let bend = gap.max(Self::STRAIGHT * self.range);
        let (value, slope) = self.at(bend);
        let further = gap - bend;
        Some(self.potential(bend) - value * further - 0.5 * slope * further * further)
    }
}
