//! The solid-shell: a brick of eight nodes, thin along ζ, that locks neither in bending nor on curved surfaces.
//!
//! Its unknowns belong to the four directors `k` of the element: the displacement `v_k` of the middle and the half difference `d_k` of
//! the displacements of the faces, `u± = v ± d`. With the middle `X_k`, half the thickness vector `D_k`, and the functions `N_k` of
//! the quadrilateral,
//!
//! ```text
//! X = Σ N_k (X_k + ζ D_k),   u = Σ N_k (v_k + ζ d_k),   G_i = X,i   h_i = u,i   g_i = G_i + h_i
//! E_ij = ½ (G_i·h_j + h_i·G_j + h_i·h_j)                                                       (E37)
//! ```
//!
//! In these unknowns a thin element keeps its digits: bending is `d` alone, and no difference of large displacements. Strains across
//! are assumed,
//!
//! ```text
//! E_13 = ½ (1 − η) E_13(0, −1) + ½ (1 + η) E_13(0, 1),   E_23 = ½ (1 − ξ) E_23(−1, 0) + ½ (1 + ξ) E_23(1, 0)
//! E_33 = Σ N_k E_33(k)                                                                          (E38)
//! ```
//!
//! against locking in shear and of curved thickness, and all are enhanced by five modes `α`,
//!
//! ```text
//! M_kk |G₀ᵏ|² = ξ α_1, η α_2, ζ α_5,   2 M_12 |G₀¹||G₀²| = ξ α_3 + η α_4
//! E_ij += (G_i·G₀ᵏ)(G_j·G₀ˡ) M_kl (A₀/A)                                                       (E39)
//! ```
//!
//! with the map at the centre and the area `A = |G_1 × G_2|` of the middle, but without `A₀/A` for `α_5`: only then does the patch test
//! of bending pass on distorted elements. Of areas, not of volumes, for force is carried by a thickness that varies. The modes are in equilibrium within the element and condensed as in (E12), at small and at finite strain: force, stiffness and energy
//! are functions of the displacements alone.
//!
//! The stiffness of the stresses may take those that the last correction `du` predicted, which bend less: with `w_i = du,i`,
//!
//! ```text
//! Q_ij = ½ w_i·w_j,   S_p = S − C : (Q − M δα),   δα = H⁻¹ ∫ Mᵀ C Q                               (E40)
//! ```
//!
//! It is zero where Newton's method has converged, so that no solution changes. Source: Magisano, Leonetti, Garcea, IJNME 110, 2017.
//!
//! Sources: Dvorkin, Bathe 1984 (shear); Betsch, Stein 1995 (E_33); Klinkel, Gruttmann, Wagner, CMAME 195, 2006 (modes).

mod strains;

use super::element::{Element, Failure, Output};
use super::modes::{BALANCED, ROUNDING, STEPS, largest};
use crate::material::dense;
use crate::material::{Kinematics, MaterialError, Order, Response};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use strains::{AtPoint, Geometry, MODES, N, NB, Variation, Voigt};

/// Numbers of history of the modes.
pub(in crate::solid) const NMODE: usize = MODES;

const NOT_BALANCED: Failure = Failure::Material(MaterialError::NotConverged {
    what: "equilibrium of its enhanced modes",
});

/// What the modes of an element add up over its points.
#[derive(Default)]
struct OfModes {
    force: [f64; MODES],
    size: [f64; MODES],
    stiffness: [[f64; MODES]; MODES],
    /// What the strain does to them that the linear prediction has less.
    lagging: [f64; MODES],
    /// Their force against temperatures of the nodes.
    thermal: [[f64; NB]; MODES],
    /// The largest strain.
    strain: f64,
}

impl OfModes {
    /// Solves with their stiffness.
    fn solve<const C: usize>(&self, right: &mut [[f64; C]; MODES]) -> Result<(), Failure> {
        let mut matrix = self.stiffness;
        let (matrix, right) = (matrix.as_flattened_mut(), right.as_flattened_mut());
        dense::solve(matrix, MODES, right, C).ok_or(NOT_BALANCED)
    }

    fn add(&mut self, at: &AtPoint, stress: &Voigt, with_modes: &[[f64; MODES]; 6]) {
        for (k, (row, with)) in at.modes.iter().zip(with_modes).enumerate() {
            for (a, mode) in row.iter().enumerate() {
                let weight = at.weight * mode;
                self.force[a] += weight * stress[k];
                self.size[a] += (weight * stress[k]).abs();
                for (to, with) in self.stiffness[a].iter_mut().zip(with) {
                    *to += weight * with;
                }
            }
        }
    }
}

/// The material's answer at a point, along the convected axes.
struct Answer {
    stress: Voigt,
    tangent: [[f64; 6]; 6],
    /// The same against temperature.
    thermal: Voigt,
}

impl Answer {
    fn new(at: &AtPoint, response: &Response) -> Self {
        let to_axes = at.to_axes();
        let back = |of: Sym3| {
            let of = of.to_pairs();
            let mut to = [0.0; 6];
            for (row, s) in to_axes.iter().zip(of) {
                to.iter_mut().zip(row).for_each(|(to, t)| *to += t * s);
            }
            to
        };
        let half = times(&response.tangent, &to_axes);
        let mut tangent = [[0.0; 6]; 6];
        for (row, half) in to_axes.iter().zip(&half) {
            for (to, t) in tangent.iter_mut().zip(row) {
                to.iter_mut().zip(half).for_each(|(to, h)| *to += t * h);
            }
        }
        Self {
            stress: back(response.stress),
            tangent,
            thermal: back(response.thermal),
        }
    }
}

/// `A B`.
fn times<const C: usize>(a: &[[f64; 6]; 6], b: &[[f64; C]; 6]) -> [[f64; C]; 6] {
    let mut product = [[0.0; C]; 6];
    for (to, row) in product.iter_mut().zip(a) {
        for (factor, b) in row.iter().zip(b) {
            to.iter_mut().zip(b).for_each(|(to, b)| *to += factor * b);
        }
    }
    product
}

/// Force, stiffness, energy and samples of an element.
pub(super) fn respond(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let geometry = Geometry::new(element)?;
    let nhistory = element.npoint() * element.material.nhistory();
    let mut values = [0.0; MODES];
    let old = element.old.get(nhistory..).unwrap_or_default();
    values
        .iter_mut()
        .zip(old)
        .for_each(|(to, from)| *to = *from);
    let lag = balance(element, &geometry, &mut values, out)?;
    out.reset();
    let whole = order == Order::Tangent || !out.thermal.is_empty();
    let (modes, coupling) = integrate(element, &geometry, &values, whole.then_some(&lag), out)?;
    condense(element, &modes, &coupling, &mut values, out)?;
    let new = out.new.get_mut(nhistory..).unwrap_or_default();
    new.iter_mut().zip(values).for_each(|(to, mode)| *to = mode);
    Ok(())
}

/// Brings the modes into equilibrium. Answers with what the linear prediction of the last correction has them lag by.
fn balance(
    element: &Element<'_>,
    geometry: &Geometry,
    values: &mut [f64; MODES],
    out: &mut Output<'_>,
) -> Result<[f64; MODES], Failure> {
    let linearity = element.material.linearity();
    let is_linear = match element.kinematics {
        Kinematics::Small => linearity.is_linear(),
        Kinematics::Finite => linearity.lame().is_some(),
    };
    let predicts = !element.correction.is_empty();
    let mut response = Response::default();
    for _ in 0..STEPS {
        let mut modes = OfModes::default();
        for point in 0..element.npoint() {
            let at = geometry.at(element, point)?;
            let strain = at.tensor(&at.enhanced(values));
            element.respond(point, strain, Order::Tangent, out.new, &mut response)?;
            let answer = Answer::new(&at, &response);
            modes.add(&at, &answer.stress, &times(&answer.tangent, &at.modes));
            modes.strain = modes.strain.max(strain.double_dot(strain).sqrt());
            if predicts {
                let bend = geometry.bend_of_correction(&at).map(|e| [e]);
                let stress = times(&answer.tangent, &bend);
                for (row, [stress]) in at.modes.iter().zip(stress) {
                    let to = modes.lagging.iter_mut().zip(row);
                    to.for_each(|(to, m)| *to += at.weight * m * stress);
                }
            }
        }
        let mut right = [[0.0; 2]; MODES];
        let terms = modes.force.iter().zip(&modes.lagging);
        right
            .iter_mut()
            .zip(terms)
            .for_each(|(to, (f, l))| *to = [*f, *l]);
        modes.solve(&mut right)?;
        let left = largest(modes.force.iter());
        let change = largest(right.iter().map(|row| &row[0]));
        values
            .iter_mut()
            .zip(&right)
            .for_each(|(mode, row)| *mode -= row[0]);
        let scale = largest(modes.size.iter());
        if is_linear || left <= BALANCED * scale || change <= ROUNDING * modes.strain {
            return Ok(right.map(|row| row[1]));
        }
    }
    Err(NOT_BALANCED)
}

/// The force on the unknowns, and what modes and unknowns are against one another: `K_αu`, where a stiffness is wanted, and the
/// transpose of `K_uα`.
struct Coupling {
    force: [f64; N],
    across: [[f64; N]; MODES],
    back: [[f64; N]; MODES],
}

/// Adds up forces, stiffness, energy and samples over the points. With a stiffness comes what its stresses lag by.
fn integrate(
    element: &Element<'_>,
    geometry: &Geometry,
    values: &[f64; MODES],
    lag: Option<&[f64; MODES]>,
    out: &mut Output<'_>,
) -> Result<(OfModes, Coupling), Failure> {
    let finite = element.kinematics == Kinematics::Finite;
    let symmetric = element.material.is_symmetric();
    let mut modes = OfModes::default();
    let mut coupling = Coupling {
        force: [0.0; N],
        across: [[0.0; N]; MODES],
        back: [[0.0; N]; MODES],
    };
    let mut bends = [[0.0; NB]; NB];
    let mut response = Response::default();
    for point in 0..element.npoint() {
        let at = geometry.at(element, point)?;
        let enhanced = at.enhanced(values);
        let strain = at.tensor(&enhanced);
        element.respond(point, strain, Order::Tangent, out.new, &mut response)?;
        out.energy += at.weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            let (h, ratio) = seen(&at, strain, finite);
            *sample = element.sample(point, h, [at.weight, ratio], out.new, &response);
        }
        let answer = Answer::new(&at, &response);
        let with_modes = times(&answer.tangent, &at.modes);
        modes.add(&at, &answer.stress, &with_modes);
        let rows = geometry.variation(&at);
        for (row, stress) in rows.iter().zip(answer.stress) {
            add(&mut coupling.force, at.weight * stress, row);
        }
        couple(&mut coupling.back, at.weight, &rows, &with_modes);
        let Some(lag) = lag else {
            continue;
        };
        add_thermal(
            element,
            (point, &at),
            &rows,
            &answer.thermal,
            &mut modes,
            out,
        );
        if out.stiffness.is_empty() {
            continue;
        }
        let columns = times(&answer.tangent, &rows);
        if !symmetric {
            couple(&mut coupling.across, at.weight, &columns, &at.modes);
        }
        add_moduli(&rows, &columns, at.weight, symmetric, out.stiffness);
        if finite {
            let stress = ahead(element, geometry, &at, &answer, lag);
            geometry.bend(&at, &stress, &mut bends);
        }
    }
    if symmetric {
        coupling.across = coupling.back;
    }
    for (i, row) in out.stiffness.chunks_exact_mut(N).enumerate() {
        for (j, bend) in bends[i / 3].iter().enumerate() {
            row[3 * j + i % 3] += bend;
        }
    }
    Ok((modes, coupling))
}

/// The stress that the last correction predicted, (E40).
fn ahead(
    element: &Element<'_>,
    geometry: &Geometry,
    at: &AtPoint,
    answer: &Answer,
    lag: &[f64; MODES],
) -> Voigt {
    let mut stress = answer.stress;
    if element.correction.is_empty() {
        return stress;
    }
    let mut strain = geometry.bend_of_correction(at);
    for (e, row) in strain.iter_mut().zip(&at.modes) {
        *e -= row.iter().zip(lag).map(|(m, a)| m * a).sum::<f64>();
    }
    let less = times(&answer.tangent, &strain.map(|e| [e]));
    stress
        .iter_mut()
        .zip(less)
        .for_each(|(s, [less])| *s -= less);
    stress
}

/// Adds `w Mᵀ B`.
fn couple(to: &mut [[f64; N]; MODES], weight: f64, rows: &Variation, modes: &[[f64; MODES]; 6]) {
    for (row, modes) in rows.iter().zip(modes) {
        for (to, mode) in to.iter_mut().zip(modes) {
            add(to, weight * mode, row);
        }
    }
}

/// Adds `weight` times a row.
fn add(to: &mut [f64; N], weight: f64, row: &[f64; N]) {
    to.iter_mut().zip(row).for_each(|(to, b)| *to += weight * b);
}

/// Adds `w Bᵀ C B`, from the first column of each block on where it is symmetric.
fn add_moduli(
    rows: &Variation,
    columns: &Variation,
    weight: f64,
    symmetric: bool,
    stiffness: &mut [f64],
) {
    for (i, to) in stiffness.chunks_exact_mut(N).enumerate() {
        let first = if symmetric { i / 3 * 3 } else { 0 };
        for (row, column) in rows.iter().zip(columns) {
            let factor = weight * row[i];
            if factor != 0.0 {
                let pairs = to[first..].iter_mut().zip(&column[first..]);
                pairs.for_each(|(to, c)| *to += factor * c);
            }
        }
    }
}

/// Adds what temperatures of the nodes do to the forces.
fn add_thermal(
    element: &Element<'_>,
    (point, at): (usize, &AtPoint),
    rows: &Variation,
    thermal: &Voigt,
    modes: &mut OfModes,
    out: &mut Output<'_>,
) {
    if out.thermal.is_empty() {
        return;
    }
    let mut force = [0.0; N];
    for (row, stress) in rows.iter().zip(thermal) {
        add(&mut force, at.weight * stress, row);
    }
    let shape = element.reference.thermal(point);
    super::stiffness::add_thermal(out.thermal, 1.0, &force, shape);
    let mut on_modes = [0.0; MODES];
    for (row, stress) in at.modes.iter().zip(thermal) {
        on_modes
            .iter_mut()
            .zip(row)
            .for_each(|(to, m)| *to += at.weight * stress * m);
    }
    super::stiffness::add_thermal(modes.thermal.as_flattened_mut(), 1.0, &on_modes, shape);
}

/// (E12).
fn condense(
    element: &Element<'_>,
    modes: &OfModes,
    coupling: &Coupling,
    values: &mut [f64; MODES],
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    const COLUMNS: usize = 1 + N + NB;
    let mut solution = [[0.0; COLUMNS]; MODES];
    for (a, to) in solution.iter_mut().enumerate() {
        to[0] = modes.force[a];
        to[1..=N].copy_from_slice(&coupling.across[a]);
        to[1 + N..].copy_from_slice(&modes.thermal[a]);
    }
    modes.solve(&mut solution)?;
    for ((f, mode), row) in modes.force.iter().zip(values).zip(&solution) {
        out.energy -= 0.5 * f * row[0];
        *mode -= row[0];
    }
    let terms = |i: usize| coupling.back.iter().map(move |back| back[i]).zip(&solution);
    for (i, (to, force)) in out.force.iter_mut().zip(coupling.force).enumerate() {
        *to = force - terms(i).map(|(back, row)| back * row[0]).sum::<f64>();
    }
    let symmetric = element.material.is_symmetric();
    for (i, to) in out.stiffness.chunks_exact_mut(N).enumerate() {
        let first = if symmetric { i / 3 * 3 } else { 0 };
        terms(i)
            .for_each(|(back, row)| dense::subtract(&mut to[first..], back, &row[1 + first..=N]));
    }
    for (i, to) in out.thermal.chunks_exact_mut(NB).enumerate() {
        terms(i).for_each(|(back, row)| dense::subtract(to, back, &row[1 + N..]));
    }
    Ok(())
}

/// The displacement gradient that a law sees, `F = R U` with the rotation of the compatible one and the assumed strain, and the ratio of
/// volumes.
fn seen(at: &AtPoint, strain: Sym3, finite: bool) -> (Mat3, f64) {
    if !finite {
        return (strain.to_mat3(), 1.0);
    }
    let mut compatible = Mat3::IDENTITY;
    for (h, dual) in at.moved.iter().zip(at.dual) {
        compatible = compatible + Mat3::outer(*h, dual);
    }
    let assumed = root(Sym3::IDENTITY + strain * 2.0);
    let stretch = root(Sym3::gram(compatible))
        .inverse()
        .map(|(inverse, _)| inverse);
    let rotation = stretch.map_or(Mat3::IDENTITY, |inverse| compatible * inverse.to_mat3());
    let f = rotation * assumed.to_mat3();
    let mut h = f;
    for (axis, row) in h.rows.iter_mut().enumerate() {
        *row -= Vec3::unit(axis);
    }
    (h, f.determinant())
}

/// The square root of a positive definite tensor by its invariants: Hoger, Carlson, Quart. Appl. Math. 42, 1984.
fn root(c: Sym3) -> Sym3 {
    let [a, b, d] = c.eigenvalues().map(|value| value.max(0.0).sqrt());
    let (i1, i2, i3) = (a + b + d, a * b + b * d + d * a, a * b * d);
    let m = c.to_mat3();
    let square = Sym3::symmetric_part(m * m);
    let sum = Sym3::IDENTITY * (i1 * i3) + c * (i1 * i1 - i2) - square;
    sum * (i1 * i2 - i3).recip()
}
