use super::{ContactLaw, Eval, Scale, TOUCH, each};

/// The linear penalty, `p = ε⟨−g⟩`.
///
/// At `g = 0` the slope has two values. A surface that just touches, to rounding, gets that of contact: bodies that
/// touch at the start are then pressed together from the first solve on, and not driven into each other.
#[derive(Clone, Copy, Debug)]
pub struct Penalty;

impl ContactLaw for Penalty {
    fn name(&self) -> &str {
        "penalty"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            if gap <= TOUCH * scale.length {
                Eval {
                    value: -scale.penalty * gap.min(0.0),
                    dgap: -scale.penalty,
                    dlambda: 0.0,
                }
            } else {
                Eval::default()
            }
        });
    }

    fn energy(&self, gap: f64, _: f64, scale: &Scale) -> Option<f64> {
        let penetration = gap.min(0.0);
        Some(0.5 * scale.penalty * penetration * penetration)
    }
}
