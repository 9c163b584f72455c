//! Hyperelastic laws in the principal stretches, whose energy has powers of them.

use super::logarithmic::Logarithmic;
use super::principal::{PAIRS, put_in_axes};
use super::{
    Constants, ConstantsError, Kinematics, Lame, Material, MaterialError, Order, Response, Strain,
};

/// Such a law, evaluated by the logarithmic principal strains `ε_i`. Whoever has it is a material.
pub(super) trait InStretches: std::fmt::Debug + Send + Sync {
    /// The initial moduli; at small strain there are no others.
    fn initial(&self) -> &Lame;

    /// Adds `τ_i`, its derivatives and the energy.
    fn add(&self, strain: &[f64; 3], to: &mut Principal);
}

/// What a law answers in the principal axes.
#[derive(Default)]
pub(super) struct Principal {
    pub energy: f64,
    /// `τ_i`
    pub stress: [f64; 3],
    /// `∂τ_i/∂ε_j`
    pub normal: [[f64; 3]; 3],
    /// `(τ_i − τ_j)/(ε_i − ε_j)/2` of the pairs 12, 23, 13.
    shear: [f64; 3],
}

impl Principal {
    /// Adds the shear stiffness that belongs to `2μ/α x_i` in the stress, `x_i + 1` being some common factor times
    /// `exp(α ε_i)`.
    pub fn shear(&mut self, mu: f64, alpha: f64, strain: &[f64; 3], x: [f64; 3]) {
        for (shear, (i, j)) in self.shear.iter_mut().zip(PAIRS) {
            let distance = alpha * (strain[i] - strain[j]);
            let share = if distance == 0.0 {
                1.0
            } else {
                distance.exp_m1() / distance
            };
            *shear += mu * (1.0 + x[j]) * share;
        }
    }
}

impl<L: InStretches> Material for L {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        if strain.kinematics == Kinematics::Small {
            self.initial().respond(&strain.value, order, out);
            return Ok(());
        }
        let logarithmic = Logarithmic::new(&strain.value)?;
        let mut principal = Principal::default();
        self.add(&logarithmic.strain, &mut principal);
        let Principal {
            energy,
            stress,
            normal,
            shear,
        } = principal;
        out.energy = energy;
        put_in_axes(stress, &normal, shear, order, out);
        logarithmic.pull_back(order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.initial().lambda + 2.0 * self.initial().mu
    }
}

/// The exponents `alpha`, none of which may be zero.
pub(super) fn exponents(constants: &Constants) -> Result<&[f64], ConstantsError> {
    let alpha = constants.list("alpha")?;
    match alpha.iter().find(|a| **a == 0.0 || !a.is_finite()) {
        None => Ok(alpha),
        Some(&value) => Err(ConstantsError::Range {
            name: "alpha",
            value,
            allowed: "a number other than 0",
        }),
    }
}

/// `exp(x) − 1 − x`, with its digits where `x` is small.
pub(super) fn exp_m1_less_linear(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    // ½x² (1 + x/3 (1 + x/4 (…)))
    let mut sum = 1.0;
    for n in (3..18).rev() {
        sum = 1.0 + sum * x / f64::from(n);
    }
    0.5 * x * x * sum
}
