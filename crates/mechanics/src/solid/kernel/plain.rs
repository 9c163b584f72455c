//! The element as it is.

use super::element::{Element, Failure, Output};
use super::gradient::{deformation, displacement_gradient, place, strain};
use super::predicted::predicted;
use super::stiffness::{add_force, add_stiffness, add_thermal, contract};
use crate::material::{Order, Response};
use signorini_geometry::tensor::Mat3;

pub(super) fn respond<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let finite = element.is_finite();
    let symmetric = element.material.is_symmetric();
    out.reset();
    let mut response = Response::default();
    for point in 0..element.npoint() {
        let at = place::<NN, ND, NG>(element, point)?;
        let h = displacement_gradient::<NN, ND, NG>(&at.gradient, element.u);
        let (f, ratio) = deformation::<ND, NG>(h, finite)?;
        element.respond(point, strain(h, finite), order, out.new, &mut response)?;
        out.energy += at.weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            *sample = element.sample(point, h, [at.weight, ratio], out.new, &response);
            continue;
        }
        let force = contract::<NN, ND, NG>(&at.gradient, &f, &response.stress);
        add_force(out.force, at.weight, &force); // (E1)
        if order == Order::Tangent {
            let f = finite.then_some([&f; 2]);
            let (stress, tangent) = (
                &predicted::<NN, ND, NG>(element.correction, &at.gradient, &response),
                &response.tangent,
            );
            add_stiffness::<NN, ND, NG>(
                &at.gradient,
                f,
                at.weight,
                stress,
                tangent,
                symmetric,
                out,
            );
            if !out.thermal.is_empty() {
                let f = f.map_or(&Mat3::IDENTITY, |[f, _]| f);
                let force = contract::<NN, ND, NG>(&at.gradient, f, &response.thermal);
                let shape = element.reference.thermal(point);
                add_thermal(out.thermal, at.weight, force.as_flattened(), shape);
            }
        }
    }
    Ok(())
}
