//! The element as it is, between the ends of an increment, with the stress that does exactly the work of its energy.
//!
//! With the strains E₀, E₁ at the ends, `Ē = ½ (E₀ + E₁)`, which is not the strain of the mean place, and `ΔE = E₁ − E₀`:
//!
//! ```text
//! S̄ = S(Ē) + α ΔE        α = (W(E₁) − W(E₀) − S(Ē):ΔE)/(ΔE:ΔE)                                   (E21)
//! f = Σ w B(F_½)ᵀ S̄        K = Σ w (B(F_½)ᵀ (dS̄/dE₁) B(F₁) + ½ Gᵀ S̄ G)                           (E22)
//! dS̄/dE₁ = ½ C(Ē) + ΔE ⊗ (S(E₁) − S(Ē) − ½ C(Ē):ΔE − 2 α ΔE)/(ΔE:ΔE) + α 1                      (E23)
//! ```
//!
//! `F_½ − ½ (F₁ − F₀)` being `F₀`, `F_½ᵀ (F₁ − F₀)` has the symmetric part `ΔE`, so that `f·Δd = Σ w S̄:ΔE = ΔW`. A law that is linear in E
//! has `α = 0`: then it is the method of Simo and Tarnow. The stiffness is that against the end of the increment.
//!
//! Source: Gonzalez, CMAME 190, 2000, equations 3.16 and 4.3 (a discrete gradient of the strain energy).

use super::element::{Element, Failure, Output};
use super::gradient::{deformation, displacement_gradient, place, strain};
use super::stiffness::{add_force, add_stiffness, contract};
use crate::material::{Order, Response};
use signorini_geometry::tensor::Sym3;

/// ΔE:ΔE below which α is nothing but rounding errors: its terms vanish with ΔE.
const STILL: f64 = 1e-16;

pub(super) fn respond<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let finite = element.is_finite();
    out.reset();
    let mut responses = [Response::default(); 3];
    for point in 0..element.npoint() {
        let at = place::<NN, ND, NG>(element, point)?;
        let h = displacement_gradient::<NN, ND, NG>(&at.gradient, element.u);
        let half = displacement_gradient::<NN, ND, NG>(&at.gradient, element.way) * 0.5;
        let (middle, _) = deformation::<ND, NG>(h, finite)?;
        let (end, _) = deformation::<ND, NG>(h + half, finite)?;
        let [first, last] = [h - half, h + half].map(|h| strain(h, finite));
        let strains = [first, last, (first + last) * 0.5];
        for (strain, response) in strains.into_iter().zip(&mut responses) {
            element.respond(point, strain, order, out.new, response)?;
        }
        let secant = Secant::new(last - first, &responses);
        out.energy += at.weight * responses[2].energy;
        let force = contract::<NN, ND, NG>(&at.gradient, &middle, &secant.stress);
        add_force(out.force, at.weight, &force); // (E22)
        if order == Order::Tangent {
            let f = finite.then_some([&middle, &end]);
            let (stress, tangent) = (secant.stress * 0.5, secant.tangent(&responses));
            add_stiffness::<NN, ND, NG>(&at.gradient, f, at.weight, &stress, &tangent, false, out);
        }
    }
    Ok(())
}

/// (E21) at a point.
struct Secant {
    change: Sym3,
    /// ΔE:ΔE; none where it is nothing.
    size: Option<f64>,
    alpha: f64,
    stress: Sym3,
}

impl Secant {
    /// That of a change of strain, with what the law answers at both ends and for the mean strain.
    fn new(change: Sym3, [first, last, mean]: &[Response; 3]) -> Self {
        let squared = change.double_dot(change);
        let size = (squared >= STILL).then_some(squared);
        let gain = last.energy - first.energy - mean.stress.double_dot(change);
        let alpha = size.map_or(0.0, |size| gain / size);
        Self {
            change,
            size,
            alpha,
            stress: mean.stress + change * alpha,
        }
    }

    /// (E23).
    fn tangent(&self, [_, last, mean]: &[Response; 3]) -> [[f64; 6]; 6] {
        let mut out = mean.tangent.map(|row| row.map(|c| 0.5 * c));
        let Some(size) = self.size else {
            return out;
        };
        let change = self.change.to_pairs();
        let mut doubled = change;
        doubled[3..].iter_mut().for_each(|c| *c *= 2.0);
        let along = mean.tangent.map(|row| {
            let products = row.iter().zip(&doubled).map(|(c, d)| c * d);
            products.sum::<f64>()
        });
        let rest = last.stress - mean.stress - Sym3::from_pairs(along) * 0.5;
        let rest = (rest - self.change * (2.0 * self.alpha)) * size.recip();
        let rest = rest.to_pairs();
        for p in 0..6 {
            for q in 0..6 {
                out[p][q] += change[p] * rest[q];
            }
            // of tensor components, of which shears count twice
            out[p][p] += if p < 3 { self.alpha } else { 0.5 * self.alpha };
        }
        out
    }
}
