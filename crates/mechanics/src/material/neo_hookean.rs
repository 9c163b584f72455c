use super::{Kinematics, Lame, Linearity, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::Sym3;

/// The compressible neo-Hookean law with the energy `W = μ/2 (tr C − 3) − μ ln J + λ/2 (ln J)²`.
///
/// `S = μ (I − C⁻¹) + λ ln J C⁻¹`, `C_ijkl = λ C⁻¹_ij C⁻¹_kl + (μ − λ ln J)(C⁻¹_ik C⁻¹_jl + C⁻¹_il C⁻¹_jk)`.
/// At small strain it is linear elasticity. Source: Bonet and Wood, *Nonlinear Continuum Mechanics for Finite Element
/// Analysis*, 2nd ed. 2008, section 6.4.3.
///
/// # Example
/// ```
/// use signorini_geometry::tensor::Sym3;
/// use signorini_mechanics::material::{Kinematics, Material, NeoHookean, Order, Response, Strain};
///
/// // volumetric stretch J = 8 (E = ³⁄₂ I): S = (μ (1 − 1/4) + λ ln 8/4) I
/// let rubber = NeoHookean::new(2.5, 0.25);
/// let strain = Strain::new(Kinematics::Finite, Sym3::diagonal(1.5, 1.5, 1.5));
/// let mut response = Response::default();
/// rubber.respond(&strain, &[], &mut [], Order::Stress, &mut response)?;
/// let exact = 0.75 + 8_f64.ln() / 4.0;
/// assert!((response.stress.xx() - exact).abs() < 1e-14);
/// # Ok::<(), signorini_mechanics::material::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct NeoHookean {
    lame: Lame,
}

impl NeoHookean {
    /// From Young's modulus and Poisson's ratio of the undeformed material.
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lame: Lame::new(e, nu),
        }
    }
}

impl Material for NeoHookean {
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
        let (inverse, det) = inverse_of_c(&strain.value)?;
        let (log, excess) = volume_terms(&strain.value, det);
        // I − C⁻¹ = 2 E C⁻¹, without cancellation; E and C commute
        let product = strain.value.to_mat3() * inverse.to_mat3();
        out.stress = Sym3::symmetric_part(product) * (2.0 * mu) + inverse * (lambda * log);
        out.energy = 0.5 * mu * excess + 0.5 * lambda * log * log;
        if order == Order::Tangent {
            set_tangent(&inverse, lambda, mu - lambda * log, out);
        }
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }

    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}

/// Largest component of `E` at which the logarithm is taken from invariants of `E`, and terms of its series.
const SMALL: f64 = 0.01;
const TERMS: i32 = 12;

/// `C⁻¹` and `det C`, with `C = I + 2E`.
///
/// # Errors
/// `det C` is not positive.
pub(super) fn inverse_of_c(e: &Sym3) -> Result<(Sym3, f64), MaterialError> {
    let c = *e * 2.0 + Sym3::IDENTITY;
    let (inverse, det) = c.inverse().ok_or(MaterialError::Inverted { ratio: 0.0 })?;
    if det <= 0.0 {
        return Err(MaterialError::Inverted { ratio: det });
    }
    Ok((inverse, det))
}

/// The tangent `C_ijkl = b C⁻¹_ij C⁻¹_kl + s (C⁻¹_ik C⁻¹_jl + C⁻¹_il C⁻¹_jk)`.
pub(super) fn set_tangent(inverse: &Sym3, bulk: f64, shear: f64, out: &mut Response) {
    let (b, ci) = (inverse.to_mat3(), inverse.to_pairs());
    for (p, (i, j)) in Sym3::PAIRS.into_iter().enumerate() {
        for (q, (k, l)) in Sym3::PAIRS.into_iter().enumerate() {
            out.tangent[p][q] = bulk * ci[p] * ci[q]
                + shear * (b.rows[i][k] * b.rows[j][l] + b.rows[i][l] * b.rows[j][k]);
        }
    }
}

/// `det C − 1 − 2 tr E`, by invariants of `E`.
pub(super) fn higher_order(e: &Sym3) -> f64 {
    let trace = e.trace();
    let second = 0.5 * (trace * trace - e.double_dot(*e));
    4.0 * second + 8.0 * e.determinant()
}

/// `ln J` and `tr C − 3 − ln det C`.
///
/// At small strain from `d = det C − 1` by invariants of `E`, without cancellation: `ln J = ½ ln(1 + d)`, and
/// `tr C − 3 − ln det C = (tr C − 3 − d) + (d − ln(1 + d))`.
pub(super) fn volume_terms(e: &Sym3, det: f64) -> (f64, f64) {
    let trace = e.trace();
    if e.to_pairs().iter().any(|e| e.abs() > SMALL) {
        let log = det.ln();
        return (0.5 * log, 2.0 * trace - log);
    }
    let higher = higher_order(e);
    let d = 2.0 * trace + higher;
    let series = (2..2 + TERMS)
        .rev()
        .fold(0.0, |sum, n| f64::from(n).recip() - d * sum);
    (0.5 * d.ln_1p(), d * d * series - higher)
}
