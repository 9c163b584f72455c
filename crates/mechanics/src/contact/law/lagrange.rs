use super::{ContactLaw, Eval, Multiplier, Scale, TOUCH, each};

/// Lagrange multipliers with a primal-dual active set: no penetration.
///
/// Where nothing is known yet, `λ = 0`, a surface that touches to rounding counts as closed: bodies that touch at the
/// start are then pressed together from the first solve on.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Lagrange, Scale};
///
/// let scale = Scale { penalty: 10.0, shear: 10.0, length: 1.0 };
/// // contact without penetration satisfies the condition, as does an open gap without pressure
/// assert_eq!(Lagrange.complementarity(0.0, 3.0, &scale).value, 0.0);
/// assert_eq!(Lagrange.complementarity(0.2, 0.0, &scale).value, 0.0);
/// assert!(Lagrange.complementarity(-0.2, 3.0, &scale).value != 0.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Lagrange;

impl Lagrange {
    fn is_closed(gap: f64, lambda: f64, scale: &Scale) -> bool {
        lambda > scale.penalty * (gap - TOUCH * scale.length)
    }
}

impl ContactLaw for Lagrange {
    fn name(&self) -> &str {
        "lagrange"
    }

    fn multiplier(&self) -> Multiplier {
        Multiplier::Direct
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, lambda| {
            if Self::is_closed(gap, lambda, scale) {
                Eval {
                    value: lambda,
                    dgap: 0.0,
                    dlambda: 1.0,
                }
            } else {
                Eval::default()
            }
        });
    }

    fn complementarity(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval {
        let c = scale.penalty;
        if Self::is_closed(gap, lambda, scale) {
            Eval {
                value: -gap,
                dgap: -1.0,
                dlambda: 0.0,
            }
        } else {
            Eval {
                value: -lambda / c,
                dgap: 0.0,
                dlambda: -1.0 / c,
            }
        }
    }

    fn energy(&self, _: f64, _: f64, _: &Scale) -> Option<f64> {
        None
    }
}
