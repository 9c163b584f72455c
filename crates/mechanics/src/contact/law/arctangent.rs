use super::{ContactLaw, Eval, Scale, each};
use signorini_vocabulary::{Description, Entry, NOT_NEGATIVE, POSITIVE, key};
use std::f64::consts::PI;
use std::sync::Arc;

/// The entry of [`Arctangent`].
pub(super) const ENTRY: Entry<Arc<dyn ContactLaw>> = Entry {
    description: Description::new(
        "arctangent",
        "a penalty rounded by an arctangent, with a tension at a distance",
        &[
            key(
                "stiffness",
                POSITIVE,
                "force or pressure per penetration, far inside",
            )
            .required(),
            key("tension", POSITIVE, "the tension at a distance").required(),
            key(
                "within",
                NOT_NEGATIVE,
                "the gap beyond which nothing acts, in sizes of the facets; absent: it acts at any distance",
            ),
        ],
    ),
    make: |values| {
        Ok(Arc::new(Arctangent {
            stiffness: values.number("stiffness")?,
            tension: values.number("tension")?,
            within: values.number_if("within").unwrap_or(f64::INFINITY),
        }))
    },
};

/// A penalty whose corner is rounded by an arctangent, with a tension that remains at a distance.
///
/// `p = K d (1/2 + atan(d/ε)/π)` at the penetration `d = −g`, with `ε = π t/K`: far inside it is `K d − t`, far outside the
/// tension `t`. Beyond `within` facets there is nothing; the pressure jumps there by less than `t`.
///
/// # Source
/// CalculiX CrunchiX User's Manual, node-to-face penalty contact, linear pressure-overclosure.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{Arctangent, ContactLaw, Scale};
///
/// let law = Arctangent { stiffness: 1e6, tension: 0.5, within: f64::INFINITY };
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// let pressure = |gap| law.pressure(gap, 0.0, &scale).value;
/// // far inside K d − t, far outside the tension
/// assert!((pressure(-0.1) - (1e5 - 0.5)).abs() < 1e-5);
/// assert!((pressure(0.1) + 0.5).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arctangent {
    /// K: pressure per penetration, far inside.
    pub stiffness: f64,
    /// t: the tension at a distance, positive.
    pub tension: f64,
    /// The gap beyond which nothing acts, over the size of the facets; infinite where it acts at any distance.
    pub within: f64,
}

impl Arctangent {
    fn width(&self) -> f64 {
        PI * self.tension / self.stiffness
    }

    /// The potential, zero at d = 0.
    fn potential(&self, d: f64) -> f64 {
        let width = self.width();
        let rounded = (d * d + width * width) * (d / width).atan() - width * d;
        self.stiffness * (0.25 * d * d + rounded / (2.0 * PI))
    }
}

impl ContactLaw for Arctangent {
    fn name(&self) -> &str {
        ENTRY.description.name
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            if gap > self.within * scale.length {
                return Eval::default();
            }
            let (d, width) = (-gap, self.width());
            let share = 0.5 + (d / width).atan() / PI;
            let bend = d * width / (PI * (d * d + width * width));
            Eval {
                value: self.stiffness * d * share,
                dgap: -self.stiffness * (share + bend),
                dlambda: 0.0,
            }
        });
    }

    fn energy(&self, gap: f64, _: f64, scale: &Scale) -> Option<f64> {
        let end = self.within * scale.length;
        let beyond = if end.is_finite() {
            self.potential(-end)
        } else {
            0.0
        };
        Some(self.potential(-gap.min(end)) - beyond)
    }
}
