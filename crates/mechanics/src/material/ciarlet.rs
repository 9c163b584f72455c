use super::neo_hookean::{higher_order, inverse_of_c, set_tangent, volume_terms};
use super::{Lame, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::Sym3;

/// The compressible law of Ciarlet with the energy `W = λ/4 (det C − 1 − ln det C) + μ/2 (tr C − 3 − ln det C)`.
///
/// `S = λ/2 (det C − 1) C⁻¹ + μ (I − C⁻¹)`,
/// `C_ijkl = λ det C C⁻¹_ij C⁻¹_kl + (μ − λ/2 (det C − 1))(C⁻¹_ik C⁻¹_jl + C⁻¹_il C⁻¹_jk)`.
///
/// The energy grows without bound where the volume vanishes and where it grows, and is polyconvex: the law suits metals
/// under large compression, where that of Saint Venant and Kirchhoff softens. It is not linear at small strain either: it
/// takes the linearized strain for `E` there, as CalculiX does with `CIARLET_EL`.
///
/// Source: Ciarlet, *Mathematical Elasticity* I 1988, section 4.10.
#[derive(Clone, Debug)]
pub struct Ciarlet {
    lame: Lame,
}

impl Ciarlet {
    /// From Young's modulus and Poisson's ratio of the undeformed material.
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lame: Lame::new(e, nu),
        }
    }
}

impl Material for Ciarlet {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let Lame { lambda, mu } = self.lame;
        let e = &strain.value;
        let (inverse, det) = inverse_of_c(e)?;
        // det C − 1 by invariants of E, without cancellation
        let higher = higher_order(e);
        let growth = 2.0 * e.trace() + higher;
        let (_, excess) = volume_terms(e, det);
        // I − C⁻¹ = 2 E C⁻¹; E and C commute
        let product = e.to_mat3() * inverse.to_mat3();
        let pressure = 0.5 * lambda * growth;
        out.stress = Sym3::symmetric_part(product) * (2.0 * mu) + inverse * pressure;
        out.energy = 0.25 * lambda * (excess + higher) + 0.5 * mu * excess;
        if order == Order::Tangent {
            set_tangent(&inverse, lambda * (1.0 + growth), mu - pressure, out);
        }
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }
}
