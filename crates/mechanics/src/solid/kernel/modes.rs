//! Incompatible modes, condensed within the element; small strain.
//!
//! Beside its nodes the element has the functions `M_a = 1 − ξ_a²` with displacements `α_a` of their own. Their gradient
//!
//! ```text
//! M_a,X = (j₀ e₀)/(j e) J₀⁻ᵀ M_a,ξ                                                             (E11)
//! ```
//!
//! takes map `J₀`, determinant `j₀` and extent `e₀` (thickness, or 2πR) from the centre: its integral over the element
//! vanishes, so that a homogeneous stress does no work on the modes and the patch test holds, for bodies of revolution
//! too, where the modes have no hoop strain. The modes are in equilibrium within the element,
//!
//! ```text
//! f_α(u, α) = 0,   K = K_uu − K_uα K_αα⁻¹ K_αu,   f = f_u − K_uα K_αα⁻¹ f_α                      (E12)
//! ```
//!
//! found by Newton's method from the accepted `α`, which is part of the history: force, stiffness and energy are then
//! functions of `u` alone and derivatives of each other. Sources: Taylor, Beresford, Wilson 1976; for (E11) in the sense
//! of an assumed strain Simo and Rifai 1990.

use super::gradient::{
    deformation, displacement_gradient, inverse, jacobian, place, position, strain,
};
use super::stiffness::{add_force, add_stiffness, contract};
use super::{Element, Failure, Output, dense};
use crate::material::{MaterialError, Order, Response};

/// Newton steps before it is given up.
const STEPS: usize = 25;

/// The force on the modes, relative to what adds up to it, at which they are in equilibrium: what it leaves is second
/// order in forces, by (E12).
const BALANCED: f64 = 1e-9;

/// The largest number of numbers that describe the modes.
const MOST: usize = 9;

pub(super) fn respond<const NN: usize, const NT: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let (n, nmode) = (NN * ND, (NT - NN) * ND);
    let total = n + nmode;
    let nhistory = element.npoint() * element.material.nhistory();
    let mut u = [[0.0; ND]; NT];
    u.as_flattened_mut()[..n].copy_from_slice(&element.u[..n]);
    u.as_flattened_mut()[n..].copy_from_slice(&element.old[nhistory..nhistory + nmode]);

    let mut scratch = std::mem::take(out.scratch);
    scratch.clear();
    scratch.resize(total + total * total + nmode * (nmode + n + 1), 0.0);
    let (force, rest) = scratch.split_at_mut(total);
    let (stiffness, rest) = rest.split_at_mut(total * total);
    let (inner, solution) = rest.split_at_mut(nmode * nmode);
    let mut outcome = Err(Failure::Material(MaterialError::NotConverged {
        what: "equilibrium of its incompatible modes",
    }));
    for _ in 0..STEPS {
        let mut local = Output {
            force: &mut *force,
            stiffness: &mut *stiffness,
            energy: 0.0,
            new: &mut *out.new,
            samples: &mut *out.samples,
            scratch: &mut *out.scratch,
        };
        let size = match integrate::<NN, NT, ND, NG>(element, u.as_flattened(), &mut local) {
            Ok(size) => size,
            Err(failure) => {
                outcome = Err(failure);
                break;
            }
        };
        out.energy = local.energy;
        // K_αα⁻¹ (K_αu, f_α)
        for (i, row) in stiffness.chunks_exact(total).skip(n).enumerate() {
            inner[i * nmode..(i + 1) * nmode].copy_from_slice(&row[n..]);
            let to = &mut solution[i * (n + 1)..(i + 1) * (n + 1)];
            to[..n].copy_from_slice(&row[..n]);
            to[n] = force[n + i];
        }
        if dense::solve(inner, nmode, solution, n + 1).is_none() {
            break;
        }
        let left = force[n..].iter().fold(0.0f64, |m, f| m.max(f.abs()));
        if left <= BALANCED * size {
            outcome = Ok(());
            break;
        }
        for (mode, value) in u.as_flattened_mut()[n..].iter_mut().enumerate() {
            *value -= solution[mode * (n + 1) + n];
        }
    }
    if outcome.is_ok() {
        condense(out, order, n, nmode, force, stiffness, solution);
        out.new[nhistory..nhistory + nmode].copy_from_slice(&u.as_flattened()[n..]);
    }
    *out.scratch = scratch;
    outcome
}

/// (E12), from `solution = K_αα⁻¹ (K_αu, f_α)`.
fn condense(
    out: &mut Output<'_>,
    order: Order,
    n: usize,
    nmode: usize,
    force: &[f64],
    stiffness: &[f64],
    solution: &[f64],
) {
    let total = n + nmode;
    for mode in 0..nmode {
        out.energy -= 0.5 * force[n + mode] * solution[mode * (n + 1) + n];
    }
    for (i, row) in stiffness.chunks_exact(total).take(n).enumerate() {
        let coupling = &row[n..];
        let rows = || coupling.iter().zip(solution.chunks_exact(n + 1));
        out.force[i] = force[i] - rows().map(|(k, x)| k * x[n]).sum::<f64>();
        if order == Order::Tangent
            && let Some(to) = out.stiffness.get_mut(i * n..(i + 1) * n)
        {
            to.copy_from_slice(&row[..n]);
            for (k, x) in rows() {
                to.iter_mut().zip(x).for_each(|(to, x)| *to -= k * x);
            }
        }
    }
}

/// Forces and stiffness of nodes and modes together; answers with the size of what was added up in the modes' forces.
fn integrate<const NN: usize, const NT: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    u: &[f64],
    out: &mut Output<'_>,
) -> Result<f64, Failure> {
    let points = element.reference;
    let centre = jacobian::<ND>(&element.x[..NN], &points.dshape_at_centre);
    let (turn, det) = inverse(centre)?;
    let middle = position(element.x, &points.shape_at_centre);
    let volume = det * element.space.extent(middle);
    out.force.fill(0.0);
    out.stiffness.fill(0.0);
    let mut response = Response::default();
    let mut size = [0.0; MOST];
    for (point, xi) in points.rule.points.iter().enumerate() {
        let at = place::<NN, ND, NG>(element, point)?;
        let mut gradient = [[0.0; NG]; NT];
        gradient[..NN].copy_from_slice(&at.gradient);
        let scale = volume * points.rule.weights[point] / at.weight;
        for (a, to) in gradient[NN..].iter_mut().enumerate() {
            for b in 0..ND {
                to[b] = -2.0 * xi[a] * scale * turn.rows[b][a]; // (E11)
            }
        }
        let h = displacement_gradient::<NT, ND, NG>(&gradient, u);
        let (f, _) = deformation::<ND, NG>(h, false)?;
        let value = strain(h, false);
        element.respond(point, value, Order::Tangent, out.new, &mut response)?;
        out.energy += at.weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            *sample = element.sample(point, h, at.weight, out.new, &response);
        }
        let force = contract::<NT, ND, NG>(&gradient, &f, &response.stress);
        add_force(out.force, at.weight, &force);
        for (size, f) in size.iter_mut().zip(force[NN..].as_flattened()) {
            *size += at.weight * f.abs();
        }
        let (stress, tangent) = (&response.stress, &response.tangent);
        add_stiffness::<NT, ND, NG>(&gradient, None, at.weight, stress, tangent, false, out);
    }
    Ok(size.into_iter().fold(0.0, f64::max))
}
