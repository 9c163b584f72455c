use super::{ContactLaw, Eval, Multiplier, Scale, TOUCH, each};

/// `p = ⟨λ − εg⟩`.
fn augmented(gap: f64, lambda: f64, scale: &Scale) -> Eval {
    let p = lambda - scale.penalty * gap;
    if p >= -scale.penalty * TOUCH * scale.length {
        Eval {
            value: p.max(0.0),
            dgap: -scale.penalty,
            dlambda: 1.0,
        }
    } else {
        Eval::default()
    }
}

/// The augmented Lagrangian with multipliers that are updated between solutions, `λ ← ⟨λ − εg⟩`.
#[derive(Clone, Copy, Debug)]
pub struct Uzawa;

impl ContactLaw for Uzawa {
    fn name(&self) -> &str {
        "augmented"
    }

    fn multiplier(&self) -> Multiplier {
        Multiplier::Frozen
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, lambda| {
            augmented(gap, lambda, scale)
        });
    }

    fn energy(&self, gap: f64, lambda: f64, scale: &Scale) -> Option<f64> {
        let p = augmented(gap, lambda, scale).value;
        Some(0.5 * (p * p - lambda * lambda) / scale.penalty)
    }
}

/// The augmented Lagrangian with multipliers that are solved for together with the displacements.
#[derive(Clone, Copy, Debug)]
pub struct AugmentedNewton;

impl ContactLaw for AugmentedNewton {
    fn name(&self) -> &str {
        "augmented"
    }

    fn multiplier(&self) -> Multiplier {
        Multiplier::Augmented
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, lambda| {
            augmented(gap, lambda, scale)
        });
    }

    fn complementarity(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval {
        let p = augmented(gap, lambda, scale);
        Eval {
            value: (p.value - lambda) / scale.penalty,
            dgap: p.dgap / scale.penalty,
            dlambda: (p.dlambda - 1.0) / scale.penalty,
        }
    }

    fn energy(&self, _: f64, _: f64, _: &Scale) -> Option<f64> {
        None
    }
}
