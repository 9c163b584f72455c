use super::{Lame, Linearity, Material, MaterialError, Order, Response, Strain};

/// The law of Saint Venant and Kirchhoff, `S = λ tr(E) I + 2μ E`.
///
/// Softens in compression: under uniaxial stress the nominal stress `½ E l (l² − 1)` has its extreme at the stretch
/// `l = 1/√3`, beyond which force-controlled problems have no solution. At small strain it is linear elasticity.
#[derive(Clone, Debug)]
pub struct SaintVenantKirchhoff {
    lame: Lame,
}

impl SaintVenantKirchhoff {
    /// From Young's modulus and Poisson's ratio.
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lame: Lame::new(e, nu),
        }
    }
}

impl Material for SaintVenantKirchhoff {
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

    fn linearity(&self) -> Linearity {
        Linearity::Isotropic(self.lame)
    }
}
