use super::{ContactLaw, Eval, Scale};

/// The linear penalty, `p = ε⟨−g⟩`.
#[derive(Clone, Copy, Debug)]
pub struct Penalty;

impl ContactLaw for Penalty {
    fn pressure(&self, gap: f64, _: f64, scale: &Scale) -> Eval {
        if gap < 0.0 {
            Eval {
                value: -scale.penalty * gap,
                dgap: -scale.penalty,
                dlambda: 0.0,
            }
        } else {
            Eval::default()
        }
    }

    fn energy(&self, gap: f64, _: f64, scale: &Scale) -> Option<f64> {
        let penetration = gap.min(0.0);
        Some(0.5 * scale.penalty * penetration * penetration)
    }
}
