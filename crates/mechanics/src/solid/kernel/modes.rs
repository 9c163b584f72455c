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
//! functions of `u` alone and derivatives of each other. (E12) is exact wherever a linear material is, so that it needs no
//! step. In the arrays the modes come before the nodes: the rows that condensed forces need are then the first. Sources: Taylor, Beresford, Wilson 1976; for (E11) in the sense
//! of an assumed strain Simo and Rifai 1990.

use super::dense;
use super::element::{Element, Failure, Output};
use super::gradient::{
    deformation, displacement_gradient, inverse, jacobian, place, position, strain,
};
use super::stiffness::{add_force, add_stiffness, add_thermal, contract, mirror};
use crate::material::{MaterialError, Order, Response};

/// Newton steps before it is given up.
pub(super) const STEPS: usize = 25;

/// The force on the modes, relative to what adds up to it, at which they are in equilibrium: what it leaves is second
/// order in forces, by (E12).
pub(super) const BALANCED: f64 = 1e-9;

/// A step of the modes, relative to the displacements of the nodes or to the strains, that is rounding: where stresses cancel, as in a body
/// that expands freely, there is no size of forces to compare with.
pub(super) const ROUNDING: f64 = 1e-13;

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
    let symmetric = element.material.is_symmetric();
    let mut u = [[0.0; ND]; NT];
    let (modes, nodes) = u.as_flattened_mut().split_at_mut(nmode);
    modes.copy_from_slice(&element.old[nhistory..nhistory + nmode]);
    nodes.copy_from_slice(&element.u[..n]);

    let wants_nodes = order == Order::Tangent;
    let nrow = if wants_nodes || !symmetric {
        total
    } else {
        nmode
    };
    let nheat = out.thermal.len() / n;
    let nright = if wants_nodes { 1 + n + nheat } else { 1 };
    // samples, and what forces are against temperatures, are those of modes in equilibrium
    let is_exact = element.material.linearity().is_linear() && out.samples.is_empty() && nheat == 0;
    let mut scratch = std::mem::take(out.scratch);
    let room = total + total * total + nmode * (nmode + nright) + total * nheat;
    scratch.resize(room, 0.0);
    let (force, rest) = scratch.split_at_mut(total);
    let (stiffness, rest) = rest.split_at_mut(total * total);
    let (inner, rest) = rest.split_at_mut(nmode * nmode);
    let (solution, thermal) = rest.split_at_mut(nmode * nright);
    let stiffness = &mut stiffness[..nrow * total];
    let mut outcome = Err(Failure::Material(MaterialError::NotConverged {
        what: "equilibrium of its incompatible modes",
    }));
    for _ in 0..STEPS {
        let mut local = Output {
            force: &mut *force,
            stiffness: &mut *stiffness,
            energy: 0.0,
            thermal: &mut *thermal,
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
        // K_αα⁻¹ (f_α, K_αu, K_αθ)
        let rows = stiffness.chunks_exact(total).zip(&*force);
        let to = inner.chunks_exact_mut(nmode);
        for (((row, f), inner), to) in rows.zip(to).zip(solution.chunks_exact_mut(nright)) {
            inner.copy_from_slice(&row[..nmode]);
            to[0] = *f;
            to[1..nright - nheat].copy_from_slice(&row[nmode..nmode + nright - nheat - 1]);
        }
        let of_modes = thermal.chunks_exact(nheat.max(1));
        for (to, from) in solution.chunks_exact_mut(nright).zip(of_modes) {
            to[nright - nheat..].copy_from_slice(from);
        }
        if symmetric {
            mirror(inner, nmode, ND);
        }
        if dense::solve(inner, nmode, solution, nright).is_none() {
            break;
        }
        let left = largest(force[..nmode].iter());
        let is_rounding = || {
            let steps = largest(solution.chunks_exact(nright).filter_map(<[f64]>::first));
            steps <= ROUNDING * largest(element.u[..n].iter())
        };
        if is_exact || left <= BALANCED * size || is_rounding() {
            outcome = Ok(());
            break;
        }
        step(u.as_flattened_mut(), solution, nright);
    }
    if outcome.is_ok() {
        condense::<ND>(out, symmetric, nmode, force, stiffness, solution, thermal);
        step(u.as_flattened_mut(), solution, nright);
        out.new[nhistory..nhistory + nmode].copy_from_slice(&u.as_flattened()[..nmode]);
    }
    *out.scratch = scratch;
    outcome
}

/// The largest size of numbers.
pub(super) fn largest<'a>(numbers: impl Iterator<Item = &'a f64>) -> f64 {
    numbers.fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Newton's step of the modes, from `solution = K_αα⁻¹ (f_α, …)`.
fn step(modes: &mut [f64], solution: &[f64], nright: usize) {
    for (mode, x) in modes.iter_mut().zip(solution.chunks_exact(nright)) {
        *mode -= x[0];
    }
}

/// (E12), from `solution = K_αα⁻¹ (f_α, K_αu, K_αθ)`; without `K_αu` for the force alone. What the forces are against temperatures,
/// `thermal`, is condensed as the stiffness is.
#[inline]
fn condense<const ND: usize>(
    out: &mut Output<'_>,
    symmetric: bool,
    nmode: usize,
    force: &[f64],
    stiffness: &[f64],
    solution: &[f64],
    thermal: &[f64],
) {
    let (total, nright) = (force.len(), solution.len() / nmode);
    let n = total - nmode;
    let rows = || solution.chunks_exact(nright);
    for (f, x) in force.iter().zip(rows()) {
        out.energy -= 0.5 * f * x[0];
    }
    for i in 0..n {
        let row = nmode + i;
        // K_uα: the transpose of K_αu where it is symmetric
        let coupling = |mode: usize| match symmetric {
            true => stiffness[mode * total + row],
            false => stiffness[row * total + mode],
        };
        let rows = || rows().enumerate().map(|(mode, x)| (coupling(mode), x));
        out.force[i] = force[row] - rows().map(|(k, x)| k * x[0]).sum::<f64>();
        if nright == 1 {
            continue;
        }
        let nheat = out.thermal.len() / n;
        if let Some(to) = out.thermal.get_mut(i * nheat..(i + 1) * nheat) {
            to.copy_from_slice(&thermal[row * nheat..(row + 1) * nheat]);
            rows().for_each(|(k, x)| dense::subtract(to, k, &x[1 + n..]));
        }
        let first = if symmetric { i / ND * ND } else { 0 };
        if let Some(to) = out.stiffness.get_mut(i * n + first..(i + 1) * n) {
            to.copy_from_slice(&stiffness[row * total + nmode + first..(row + 1) * total]);
            rows().for_each(|(k, x)| dense::subtract(to, k, &x[1 + first..1 + n]));
        }
    }
}

/// Forces and stiffness of modes and nodes together, above the diagonal where it is symmetric; answers with the size of what was added up in the modes' forces.
fn integrate<const NN: usize, const NT: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    u: &[f64],
    out: &mut Output<'_>,
) -> Result<f64, Failure> {
    let points = element.reference;
    let centre = jacobian::<ND>(&element.x[..NN], &points.dshape_at_centre);
    let (turn, det) = inverse(centre)?;
    let middle = position(element.x, &points.shape_at_centre);
    let volume = det * element.extent(&points.shape_at_centre, middle);
    let symmetric = element.material.is_symmetric();
    out.force.fill(0.0);
    out.stiffness.fill(0.0);
    out.thermal.fill(0.0);
    let mut response = Response::default();
    let mut size = [0.0; MOST];
    for (point, xi) in points.rule.points.iter().enumerate() {
        let at = place::<NN, ND, NG>(element, point)?;
        let mut gradient = [[0.0; NG]; NT];
        let nmode = NT - NN;
        gradient[nmode..].copy_from_slice(&at.gradient);
        let scale = volume * points.rule.weights[point] / at.weight;
        for (a, to) in gradient[..nmode].iter_mut().enumerate() {
            for b in 0..ND {
                to[b] = -2.0 * xi[a] * scale * turn.rows[b][a]; // (E11)
            }
        }
        // apart: compared with displacements that are large and cancel, those of the modes would lose their digits
        let (modes, nodes) = u.split_at(nmode * ND);
        let h = displacement_gradient::<NN, ND, NG>(&at.gradient, nodes)
            + displacement_gradient::<NT, ND, NG>(&gradient, modes);
        let (f, _) = deformation::<ND, NG>(h, false)?;
        let value = strain(h, false);
        element.respond(point, value, Order::Tangent, out.new, &mut response)?;
        out.energy += at.weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            *sample = element.sample(point, h, [at.weight, 1.0], out.new, &response);
        }
        let force = contract::<NT, ND, NG>(&gradient, &f, &response.stress);
        add_force(out.force, at.weight, &force);
        for (size, f) in size.iter_mut().zip(force[..nmode].as_flattened()) {
            *size += at.weight * f.abs();
        }
        let (stress, tangent) = (&response.stress, &response.tangent);
        add_stiffness::<NT, ND, NG>(&gradient, None, at.weight, stress, tangent, symmetric, out);
        if !out.thermal.is_empty() {
            let force = contract::<NT, ND, NG>(&gradient, &f, &response.thermal);
            let shape = points.thermal(point);
            add_thermal(out.thermal, at.weight, force.as_flattened(), shape);
        }
    }
    Ok(size.into_iter().fold(0.0, f64::max))
}
