//! What a stress over the rate of strain does at finite strain, without a remedy and with a projected dilatation.
//!
//! With the velocities `v` of the nodes, `L = ∂v/∂X`, and the initial stiffness `b ℂ₀` of the material, which the law here is,
//!
//! ```text
//! Ė = ½ (FᵀL + LᵀF)        S = b ℂ₀:Ė        f = Σ w B(F)ᵀ S                                        (E24)
//! K = Σ w (B(F)ᵀ b ℂ₀ B(c F + L) + Gᵀ S G)    where velocities change by c times displacements      (E25)
//! ```
//!
//! A rigid rotation has `L = ω × F` and no `Ė`. With the projected dilatation of (E6) the rate is that of `Ē`, and what `L` adds to its
//! derivative in a direction with `δF`
//!
//! ```text
//! Ē̇  = s² (Ė + C ṁ)        δĒ = s² (δE + C δm)                                                      (E26)
//! δĒ̇ = 2 δm Ē̇ + s² (½ (δFᵀL + LᵀδF) + 2 ṁ δE + C δṁ)                                                (E27)
//! δṁ = ⅓ (π[δϑ̇] − δϑ̇),  δϑ̇ = −tr(F⁻¹ L F⁻¹ δF)                                                      (E28)
//! ```
//!
//! at velocities that do not change. The rest of the stiffness is (E8), with the stress `S` and the tangent `c b ℂ₀`.
//!
//! Source: Armero and Romero, CMAME 190, 2001 (viscous forces that leave rigid motions alone).

use super::dilatation::{
    Dilated, Frame, MOST, Moments, Nodal, Pressures, Projection, Stretched, dilated, dot, projected,
};
use super::element::{Element, Failure, Output};
use super::gradient::{deformation, displacement_gradient, place, row, strain};
use super::stiffness::{add_force, add_stiffness, contract};
use crate::material::{Order, Response};
use signorini_geometry::tensor::{Mat3, Sym3};

/// Without a remedy.
pub(super) fn plain<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    out.reset();
    let mut response = Response::default();
    for point in 0..element.npoint() {
        let at = place::<NN, ND, NG>(element, point)?;
        let h = displacement_gradient::<NN, ND, NG>(&at.gradient, element.u);
        let flow = displacement_gradient::<NN, ND, NG>(&at.gradient, element.rate);
        let (f, _) = deformation::<ND, NG>(h, true)?;
        let rate = Sym3::symmetric_part(f.transpose() * flow);
        element.respond(point, rate, order, out.new, &mut response)?;
        let force = contract::<NN, ND, NG>(&at.gradient, &f, &response.stress);
        add_force(out.force, at.weight, &force); // (E24)
        if order == Order::Tangent {
            // (E25)
            let f = Some([&f, &(f * element.slope + flow)]);
            let (stress, tangent) = (&response.stress, &response.tangent);
            add_stiffness::<NN, ND, NG>(&at.gradient, f, at.weight, stress, tangent, false, out);
        }
    }
    Ok(())
}

/// With a projected dilatation.
pub(super) fn dilatation<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    out.reset();
    let npoint = element.npoint();
    let frame = Frame::new(element);
    let moments = Moments::<NN, ND>::new::<NG>(element, &frame)?;
    let projection = Projection::new(&moments.gram, frame.nterm)?;
    let turned = turned::<NN, ND, NG>(element, &frame, order)?;
    let mut response = Response::default();
    let mut pressures = Pressures::new(npoint, out);
    for point in 0..npoint {
        let here = Dilated::<NN, ND, NG>::new(element, &frame, point)?;
        let factors = projection.factors(&here.basis);
        let m = (dot(&factors, &moments.value) - here.value) / 3.0;
        let dm = projected(&factors, &moments.divergence, here.divergence());
        let (_, metric, square) = dilated(strain(here.h, true), m, true);
        let flow = Flow {
            gradient: displacement_gradient::<NN, ND, NG>(&here.at.gradient, element.rate),
            growth: dm
                .as_flattened()
                .iter()
                .zip(element.rate)
                .map(|(m, v)| m * v)
                .sum(),
        };
        let plain = Sym3::symmetric_part(here.f.transpose() * flow.gradient);
        let rate = (plain + metric * flow.growth) * square; // (E26)
        element.respond(point, rate, order, out.new, &mut response)?;
        let law = response.tangent;
        response.tangent = law.map(|row| row.map(|c| c * element.slope));
        let stretched = Stretched {
            dm,
            metric,
            square,
            finite: true,
            symmetric: false,
        };
        let pressure = stretched.add(&here, &response, order, out);
        pressures.add(point, &here, pressure, out);
        if order == Order::Tangent {
            let dgrowth = projected(&factors, &turned, turning(&here, element.rate));
            flow.add(&here, &stretched, (rate, &dgrowth), &law, out);
        }
    }
    if order == Order::Tangent {
        pressures.curve::<NN, ND, NG>(element, &frame, &projection, false, out)?;
    }
    Ok(())
}

/// `δϑ̇` of each displacement (E28), `−ℓ_ci s_Ic` with `ℓ = L F⁻¹` and `s_I = F⁻ᵀ N_I,X`.
fn turning<const NN: usize, const ND: usize, const NG: usize>(
    here: &Dilated<NN, ND, NG>,
    rate: &[f64],
) -> Nodal<NN, ND> {
    let spatial = displacement_gradient::<NN, ND, NG>(&here.spatial, rate);
    let mut out = [[0.0; ND]; NN];
    for (out, s) in out.iter_mut().zip(&here.spatial) {
        for i in 0..ND {
            out[i] = -(0..ND).map(|c| s[c] * spatial.rows[c][i]).sum::<f64>();
            if NG > ND && row::<ND, NG>(i, ND).is_some() {
                out[i] -= s[ND] * spatial.rows[ND][ND];
            }
        }
    }
    out
}

/// Σ w φ δϑ̇; nothing where no stiffness is wanted.
fn turned<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    frame: &Frame,
    order: Order,
) -> Result<[Nodal<NN, ND>; MOST], Failure> {
    let mut out = [[[0.0; ND]; NN]; MOST];
    if order == Order::Stress {
        return Ok(out);
    }
    for point in 0..element.npoint() {
        let here = Dilated::<NN, ND, NG>::new(element, frame, point)?;
        let turning = turning(&here, element.rate);
        for (to, basis) in out.iter_mut().zip(here.basis).take(frame.nterm) {
            add_force(to.as_flattened_mut(), here.at.weight * basis, &turning);
        }
    }
    Ok(out)
}

/// How a point deforms in time.
struct Flow {
    /// L.
    gradient: Mat3,
    /// ṁ.
    growth: f64,
}

impl Flow {
    /// Adds `δĒ:b ℂ₀:δĒ̇` (E27).
    fn add<const NN: usize, const ND: usize, const NG: usize>(
        &self,
        here: &Dilated<NN, ND, NG>,
        of: &Stretched<NN, ND>,
        (rate, dgrowth): (Sym3, &Nodal<NN, ND>),
        law: &[[f64; 6]; 6],
        out: &mut Output<'_>,
    ) {
        let mut strains = [[Sym3::ZERO; ND]; NN];
        let mut stresses = [[Sym3::ZERO; ND]; NN];
        let n = NN * ND;
        for node in 0..NN {
            for i in 0..ND {
                let mut change = Mat3::ZERO;
                for (b, g) in here.at.gradient[node].iter().enumerate() {
                    if let Some(row) = row::<ND, NG>(i, b) {
                        change.rows[row][b] = *g;
                    }
                }
                let along = |f: &Mat3| Sym3::symmetric_part(f.transpose() * change);
                let (strain, dm) = (along(&here.f), of.dm[node][i]);
                strains[node][i] = (strain + of.metric * dm) * of.square;
                let turned = along(&self.gradient) + strain * (2.0 * self.growth);
                let change = turned + of.metric * dgrowth[node][i];
                let change = change * of.square + rate * (2.0 * dm);
                let mut doubled = change.to_pairs();
                doubled[3..].iter_mut().for_each(|c| *c *= 2.0);
                let product = |row: [f64; 6]| row.iter().zip(&doubled).map(|(c, e)| c * e).sum();
                stresses[node][i] = Sym3::from_pairs(law.map(product)) * here.at.weight;
            }
        }
        let rows = out.stiffness.chunks_exact_mut(n);
        for (to, strain) in rows.zip(strains.as_flattened()) {
            for (to, stress) in to.iter_mut().zip(stresses.as_flattened()) {
                *to += strain.double_dot(*stress);
            }
        }
    }
}
