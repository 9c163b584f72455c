use super::{Material, MaterialError, Order, Response, Strain};

/// Stands for the law of a body that conducts heat and never deforms: it has no answer to a strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Undeformed;

impl Material for Undeformed {
    fn respond(
        &self,
        _: &Strain,
        _: &[f64],
        _: &mut [f64],
        _: Order,
        _: &mut Response,
    ) -> Result<(), MaterialError> {
        Err(MaterialError::Undeformable)
    }

    /// One: nothing that it scales acts where nothing deforms.
    fn modulus(&self) -> f64 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Kinematics;
    use signorini_geometry::tensor::Sym3;

    #[test]
    fn it_has_no_answer_to_a_strain() {
        let strain = Strain::new(Kinematics::Small, Sym3::ZERO);
        let answer = Undeformed.respond(
            &strain,
            &[],
            &mut [],
            Order::Stress,
            &mut Response::default(),
        );
        assert_eq!(answer, Err(MaterialError::Undeformable));
    }
}
