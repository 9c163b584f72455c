//! The shear strain of the centre at all points of a plane element, at small strain: selective reduced integration.
//!
//! The material sees
//!
//! ```text
//! ε̄_xx = ε_xx,  ε̄_yy = ε_yy,  ε̄_zz = ε_zz,  ε̄_xy = ε_xy(ξ_0)                                    (E13)
//! ```
//!
//! and the energy is `Σ w W(ε̄)`: with the rows `B̄` of (E13), `f = Σ w B̄ᵀσ` and `K = Σ w B̄ᵀ C B̄`. A parallelogram bends
//! without the parasitic shear; its hourglass motions are left to the normal strains. Source: Hughes, The Finite Element
//! Method, 2000, section 4.4.

use super::element::{Element, Failure, Output};
use super::gradient::{displacement_gradient, inverse, jacobian, place};
use super::stiffness::add_thermal;
use crate::material::{Order, Response};
use signorini_geometry::tensor::Sym3;

/// Strains xx, yy, zz and twice xy.
const NSTRAIN: usize = 4;

pub(super) fn respond<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    out.reset();
    let slopes = &element.reference.dshape_at_centre;
    let (to_place, _) = inverse(jacobian::<ND>(&element.x[..NN], slopes))?;
    let mut centre = [[0.0; 2]; NN];
    for (to, slope) in centre.iter_mut().zip(slopes) {
        let g = to_place * *slope;
        *to = [g.x, g.y];
    }
    let of_nodes = centre.iter().zip(element.u.chunks_exact(ND));
    let shear: f64 = of_nodes
        .map(|(g, u)| 0.5 * (g[1] * u[0] + g[0] * u[1]))
        .sum();
    let mut response = Response::default();
    for point in 0..element.npoint() {
        let at = place::<NN, ND, NG>(element, point)?;
        let mut h = displacement_gradient::<NN, ND, NG>(&at.gradient, element.u);
        h.rows[0].y = shear;
        h.rows[1].x = shear;
        let strain = Sym3::symmetric_part(h);
        element.respond(point, strain, order, out.new, &mut response)?;
        out.energy += at.weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            *sample = element.sample(point, h, [at.weight, 1.0], out.new, &response);
            continue;
        }
        let mut rows = [[[0.0; NSTRAIN]; 2]; NN];
        for ((row, g), c) in rows.iter_mut().zip(&at.gradient).zip(&centre) {
            let hoop = if NG > ND { g[ND] } else { 0.0 };
            *row = [[g[0], 0.0, hoop, c[1]], [0.0, g[1], 0.0, c[0]]];
        }
        let stress = response.stress.to_pairs();
        for (to, row) in out.force.iter_mut().zip(rows.as_flattened()) {
            *to += at.weight * row.iter().zip(&stress).map(|(b, s)| b * s).sum::<f64>();
        }
        if order != Order::Tangent {
            continue;
        }
        if !out.thermal.is_empty() {
            let thermal = response.thermal.to_pairs();
            let of_row = |row: &[f64; NSTRAIN]| row.iter().zip(&thermal).map(|(b, s)| b * s).sum();
            let force: [[f64; 2]; NN] = rows.each_ref().map(|row| row.each_ref().map(of_row));
            let shape = element.reference.thermal(point);
            add_thermal(out.thermal, at.weight, force.as_flattened(), shape);
        }
        for (to, left) in out
            .stiffness
            .chunks_exact_mut(NN * ND)
            .zip(rows.as_flattened())
        {
            let mut along = [0.0; NSTRAIN];
            for (q, along) in along.iter_mut().enumerate() {
                *along = (0..NSTRAIN)
                    .map(|p| left[p] * response.tangent[p][q])
                    .sum::<f64>()
                    * at.weight;
            }
            for (to, right) in to.iter_mut().zip(rows.as_flattened()) {
                *to += along.iter().zip(right).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }
    Ok(())
}
