use super::logarithmic::Principal;
use super::principal::{InAxes, PAIRS, squares};
use super::{Kinematics, Lame, Linearity, Material, MaterialError, Order, Response, Strain};

/// Hooke's law in the axes that turn with the material: `S = λ tr(U − I) I + 2μ (U − I)` with the right stretch `U` and
/// the second stress of Piola and Kirchhoff `S`.
///
/// In the principal axes, with `u_i = √(1 + 2E_i)`,
///
/// ```text
/// S_i = λ Σ (u_k − 1) + 2μ (u_i − 1),    ∂S_i/∂E_j = λ/u_j + δ_ij 2μ/u_i,    (S_i − S_j)/(E_i − E_j) = 4μ/(u_i + u_j)
/// ```
///
/// At small strain it is linear elasticity. `S` is conjugate to `E`, not to `U`: with `λ ≠ 0` the tangent is not symmetric
/// and there is no potential; the energy is then `½ S : (U − I)`, a measure alone. CalculiX names it
/// `UNDO_NLGEOM_LIN_ISO_EL`: a linear law for large rotations.
#[derive(Clone, Debug)]
pub struct RotatedLinear {
    lame: Lame,
}

impl RotatedLinear {
    /// From Young's modulus and Poisson's ratio.
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lame: Lame::new(e, nu),
        }
    }
}

impl Material for RotatedLinear {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        if strain.kinematics == Kinematics::Small {
            self.lame.respond(&strain.value, order, out);
            return Ok(());
        }
        let Lame { lambda, mu } = self.lame;
        let principal = Principal::new(&strain.value);
        let u = squares(&principal.values)?.map(f64::sqrt);
        let mut stretch = [0.0; 3]; // u − 1, without cancellation
        for ((to, e), u) in stretch.iter_mut().zip(principal.values).zip(u) {
            *to = 2.0 * e / (1.0 + u);
        }
        let mean = lambda * stretch.iter().sum::<f64>();
        let mut answer = InAxes {
            stress: stretch.map(|b| mean + 2.0 * mu * b),
            ..InAxes::default()
        };
        out.energy = 0.5
            * answer
                .stress
                .iter()
                .zip(stretch)
                .map(|(s, b)| s * b)
                .sum::<f64>();
        if order == Order::Tangent {
            for (i, row) in answer.normal.iter_mut().enumerate() {
                *row = u.map(|u| lambda / u);
                row[i] += 2.0 * mu / u[i];
            }
            answer.shear = PAIRS.map(|(i, j)| 4.0 * mu / (u[i] + u[j]));
        }
        answer.put(&principal, order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }

    fn is_symmetric(&self) -> bool {
        self.lame.lambda == 0.0
    }

    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}
