use super::{ContactLaw, Eval, Scale, each};
use signorini_vocabulary::{Description, Entry, POSITIVE, key};
use std::sync::Arc;

/// The entry of [`Dugdale`].
pub(super) const ENTRY: Entry<Arc<dyn ContactLaw>> = Entry {
    description: Description::new(
        "dugdale",
        "adhesion: a tension that is the same up to a gap",
        &[
            key("work", POSITIVE, "work of adhesion, per area").required(),
            key("range", POSITIVE, "the gap up to which it pulls (length)").required(),
        ],
    ),
    make: |values| {
        Ok(Arc::new(Dugdale {
            work: values.number("work")?,
            range: values.number("range")?,
        }))
    },
};

/// A constant tension `σ₀ = w_a/h₀` up to the range `h₀`, and the penalty inside: `p = −σ₀ + ε⟨−g⟩`.
///
/// The tension ends over a tenth of the range before it and a tenth behind it, so that the work is `w_a`.
///
/// # Source
/// Maugis, J. Colloid Interface Sci. 150, 1992.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Dugdale, Scale};
///
/// let law = Dugdale { work: 0.05, range: 0.01 };
/// let scale = Scale { penalty: 1e4, shear: 1e4, length: 1.0 };
/// assert_eq!(law.pressure(0.005, 0.0, &scale).value, -5.0);
/// assert_eq!(law.pressure(0.02, 0.0, &scale).value, 0.0);
/// assert!((law.energy(0.0, 0.0, &scale).unwrap() + 0.05).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dugdale {
    /// w_a: work of adhesion, per area.
    pub work: f64,
    /// h₀.
    pub range: f64,
}

impl Dugdale {
    /// The part of the range over which the tension ends, on either side of it.
    const ENDS: f64 = 0.1;
}

impl ContactLaw for Dugdale {
    fn name(&self) -> &str {
        ENTRY.description.name
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        let (tension, ends) = (self.work / self.range, Self::ENDS * self.range);
        let slope = tension / (2.0 * ends);
        each(gaps, lambdas, out, |gap, _| {
            let beyond = gap - self.range;
            let (value, dgap) = if gap <= 0.0 {
                (-tension - scale.penalty * gap, -scale.penalty)
            } else if beyond <= -ends {
                (-tension, 0.0)
            } else if beyond < ends {
                (slope * (beyond - ends), slope)
            } else {
                (0.0, 0.0)
            };
            Eval {
                value,
                dgap,
                dlambda: 0.0,
            }
        });
    }

    fn softens(&self) -> bool {
        true
    }

    fn energy(&self, gap: f64, _: f64, scale: &Scale) -> Option<f64> {
        let (tension, ends) = (self.work / self.range, Self::ENDS * self.range);
        let left = (self.range + ends - gap).max(0.0);
        let inside = gap.min(0.0);
        // half of what the ramp would be, were it to go on, less what it is not
        let pull = match left > 2.0 * ends {
            true => tension * (left - ends),
            false => tension * left * left / (4.0 * ends),
        };
        Some(0.5 * scale.penalty * inside * inside - pull)
    }
}
