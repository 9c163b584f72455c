use super::{ContactLaw, Eval, Multiplier, Scale, each};

/// The multiplier itself, whatever the gap: in explicit steps, where impulses say which rows are closed.
#[derive(Clone, Copy, Debug)]
pub struct Impulse;

impl ContactLaw for Impulse {
    fn name(&self) -> &str {
        "impulse"
    }

    fn multiplier(&self) -> Multiplier {
        Multiplier::Direct
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |_, lambda| match lambda > 0.0 {
            true => Eval {
                value: lambda,
                dgap: 0.0,
                dlambda: 1.0,
            },
            false => Eval::default(),
        });
    }

    fn energy(&self, _: f64, _: f64, _: &Scale) -> Option<f64> {
        None
    }
}
