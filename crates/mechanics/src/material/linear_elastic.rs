use super::{Lame, Material, MaterialError, Order, Response, Strain};

/// Isotropic linear elasticity.
///
/// At finite strain it relates the second Piola–Kirchhoff stress to the Green–Lagrange strain, as the Saint
/// Venant–Kirchhoff law does: rotations are exact, strains should stay small.
#[derive(Clone, Debug)]
pub struct LinearElastic {
    lame: Lame,
}

impl LinearElastic {
    /// From Young's modulus and Poisson's ratio.
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lame: Lame::new(e, nu),
        }
    }
}

impl Material for LinearElastic {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        self.lame.respond(&strain.value, order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }
}
