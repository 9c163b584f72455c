//! The element as it is, several cells at once: what [`super::plain`] does, in lanes.
//!
//! Only symmetric stiffness, in space. A law that is isotropic and linear in the strain is evaluated in lanes too, with
//!
//! ```text
//! A_iakb = λ F_ia F_kb + μ (F_ib F_ka + δ_ab F_ic F_kc) + δ_ik S_ab                              (E17)
//! ```
//!
//! which is (E2) with `C_rasb = λ δ_ra δ_sb + μ (δ_rs δ_ab + δ_rb δ_as)`; any other law cell by cell.

use super::element::{Element, Points};
use super::lanes::{Lanes, MOST};
use super::stiffness::PAIR;
use crate::material::{Lame, Order, Response};
use pulp::{Arch, Simd, WithSimd};
use signorini_geometry::tensor::Sym3;

/// The kernel of one element type; false where it has no answer for some cell, and [`super::Kernel`] has to say why.
pub(in crate::solid) type BatchKernel = fn(&Batch<'_>, Order, &mut Results<'_>) -> bool;

/// As many cells as there are lanes.
pub(in crate::solid) struct Batch<'a> {
    pub reference: &'a Points,
    /// Whether strains are those of Green and Lagrange.
    pub is_finite: bool,
    /// Positions of the nodes at the start: node by node, axis by axis, lane by lane.
    pub x: &'a [f64],
    /// Displacements.
    pub u: &'a [f64],
    /// The correction that led to them, for (E36); empty: the geometric stiffness takes the stress.
    pub correction: &'a [f64],
    /// The constants of a law that is isotropic and linear, without anything at the start.
    pub lame: Option<Lame>,
    /// The cell in a lane, of which only the material's part is asked.
    pub cell: &'a dyn Fn(usize) -> Element<'a>,
}

/// Results, lane by lane.
pub(in crate::solid) struct Results<'a> {
    pub energy: &'a mut [f64],
    /// Node by node.
    pub force: &'a mut [f64],
    /// The stiffness: blocks `(I, J)` of nodes with `I ≤ J`, those of the first `J` first, each row-major.
    pub blocks: &'a mut [f64],
    /// Scratch for the history of a cell.
    pub new: &'a mut [f64],
}

pub(super) fn respond<const NN: usize>(
    batch: &Batch<'_>,
    order: Order,
    out: &mut Results<'_>,
) -> bool {
    Arch::new().dispatch(Evaluation::<NN> { batch, order, out })
}

struct Evaluation<'a, 'b, 'c, const NN: usize> {
    batch: &'a Batch<'b>,
    order: Order,
    out: &'a mut Results<'c>,
}

impl<const NN: usize> WithSimd for Evaluation<'_, '_, '_, NN> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { batch, order, out } = self;
        let zero = Lanes::splat(simd, 0.0);
        let x = S::as_simd_f64s(batch.x).0.as_chunks::<3>().0;
        let u = S::as_simd_f64s(batch.u).0.as_chunks::<3>().0;
        let correction = S::as_simd_f64s(batch.correction).0.as_chunks::<3>().0;
        let force = S::as_mut_simd_f64s(out.force).0.as_chunks_mut::<3>().0;
        let blocks = S::as_mut_simd_f64s(out.blocks).0.as_chunks_mut::<9>().0;
        force.as_flattened_mut().fill(zero.value());
        blocks.as_flattened_mut().fill(zero.value());
        let mut energy = zero;
        for point in 0..batch.reference.rule.npoint() {
            let Some((gradient, weight)) = place::<S, NN>(simd, batch, point, x) else {
                return false;
            };
            // H and F
            let h = slope(simd, &gradient, u);
            let one = Lanes::splat(simd, 1.0);
            let mut f = [[zero; 3]; 3];
            for i in 0..3 {
                f[i][i] = one;
            }
            if batch.is_finite {
                f = h;
                for i in 0..3 {
                    f[i][i] = f[i][i] + one;
                }
                if !determinant(&f).are_positive() {
                    return false;
                }
            }
            let strain = strain(simd, &h, batch.is_finite);
            let mut tangent = [[zero; 6]; 6];
            let stress = match batch.lame {
                Some(lame) => {
                    let (stress, w) = linear(simd, lame, &strain);
                    energy = weight.mul_add(w, energy);
                    stress
                }
                None => {
                    let answer = ask(simd, batch, point, order, &strain, out.new, &mut tangent);
                    let Some((stress, w)) = answer else {
                        return false;
                    };
                    energy = weight.mul_add(w, energy);
                    stress
                }
            };
            // w F S
            let mut p = [[zero; 3]; 3];
            for i in 0..3 {
                for a in 0..3 {
                    let mut sum = f[i][0] * stress[PAIR[0][a]];
                    for r in 1..3 {
                        sum = f[i][r].mul_add(stress[PAIR[r][a]], sum);
                    }
                    p[i][a] = weight * sum;
                }
            }
            for (to, g) in force.iter_mut().zip(&gradient) {
                for i in 0..3 {
                    let mut sum = Lanes::new(simd, to[i]);
                    for a in 0..3 {
                        sum = p[i][a].mul_add(g[a], sum); // (E1)
                    }
                    to[i] = sum.value();
                }
            }
            if order == Order::Tangent {
                let mut stress = stress;
                if !correction.is_empty() {
                    let change = slope(simd, &gradient, correction);
                    predict(simd, batch.lame, &tangent, &change, &mut stress);
                }
                let mut moduli = match batch.lame {
                    Some(lame) => isotropic(simd, lame, &f),
                    None => moduli(&f, &tangent),
                };
                for i in 0..3 {
                    for a in 0..3 {
                        for k in 0..3 {
                            for b in 0..3 {
                                let mut sum = moduli[i][a][k][b];
                                if i == k && batch.is_finite {
                                    sum = sum + stress[PAIR[a][b]];
                                }
                                moduli[i][a][k][b] = weight * sum;
                            }
                        }
                    }
                }
                add_stiffness(simd, &gradient, &moduli, blocks);
            }
        }
        if let Some(to) = S::as_mut_simd_f64s(out.energy).0.first_mut() {
            *to = energy.value();
        }
        true
    }
}

type Gradient<S, const NN: usize> = [[Lanes<S>; 3]; NN];

/// H = ∂u/∂X.
#[inline(always)]
fn slope<S: Simd, const NN: usize>(
    simd: S,
    gradient: &Gradient<S, NN>,
    u: &[[S::f64s; 3]],
) -> [[Lanes<S>; 3]; 3] {
    let mut h = [[Lanes::splat(simd, 0.0); 3]; 3];
    for (g, u) in gradient.iter().zip(u) {
        for i in 0..3 {
            for a in 0..3 {
                h[i][a] = Lanes::new(simd, u[i]).mul_add(g[a], h[i][a]);
            }
        }
    }
    h
}

/// Takes C:Q off a stress (E36), with the slope of the correction.
#[inline(always)]
fn predict<S: Simd>(
    simd: S,
    lame: Option<Lame>,
    tangent: &[[Lanes<S>; 6]; 6],
    change: &[[Lanes<S>; 3]; 3],
    stress: &mut [Lanes<S>; 6],
) {
    // −Q
    let minus = Lanes::splat(simd, -0.5);
    let mut strain = [Lanes::splat(simd, 0.0); 6];
    for (to, (i, j)) in strain.iter_mut().zip(Sym3::PAIRS) {
        let mut sum = change[0][i] * change[0][j];
        for k in 1..3 {
            sum = change[k][i].mul_add(change[k][j], sum);
        }
        *to = minus * sum;
    }
    if let Some(lame) = lame {
        let (less, _) = linear(simd, lame, &strain);
        for (to, less) in stress.iter_mut().zip(less) {
            *to = *to + less;
        }
        return;
    }
    for q in 3..6 {
        strain[q] = strain[q] + strain[q]; // shears count twice
    }
    for (to, row) in stress.iter_mut().zip(tangent) {
        for (c, q) in row.iter().zip(&strain) {
            *to = c.mul_add(*q, *to);
        }
    }
}

/// Gradients of the shape functions at a point, and the volume that belongs to it; nothing where the map from the
/// reference element has no positive determinant.
#[inline(always)]
fn place<S: Simd, const NN: usize>(
    simd: S,
    batch: &Batch<'_>,
    point: usize,
    x: &[[S::f64s; 3]],
) -> Option<(Gradient<S, NN>, Lanes<S>)> {
    let zero = Lanes::splat(simd, 0.0);
    let slopes = batch.reference.dshape(point);
    let mut map = [[zero; 3]; 3];
    for (x, slope) in x.iter().zip(slopes) {
        for (row, slope) in map.iter_mut().zip(slope.to_array()) {
            let slope = Lanes::splat(simd, slope);
            for i in 0..3 {
                row[i] = slope.mul_add(Lanes::new(simd, x[i]), row[i]);
            }
        }
    }
    let det = determinant(&map);
    if !det.are_positive() {
        return None;
    }
    let scale = det.recip();
    let mut inverse = [[zero; 3]; 3];
    for i in 0..3 {
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let other = map[b][k] * map[c][j];
            inverse[i][a] = map[b][j].mul_add(map[c][k], -other) * scale;
        }
    }
    let mut gradient = [[zero; 3]; NN];
    for (to, slope) in gradient.iter_mut().zip(slopes) {
        let slope = slope.to_array();
        for i in 0..3 {
            let mut sum = inverse[i][0] * Lanes::splat(simd, slope[0]);
            for a in 1..3 {
                sum = inverse[i][a].mul_add(Lanes::splat(simd, slope[a]), sum);
            }
            to[i] = sum;
        }
    }
    let weight = Lanes::splat(simd, batch.reference.rule.weights[point]);
    Some((gradient, weight * det))
}

#[inline(always)]
fn determinant<S: Simd>(m: &[[Lanes<S>; 3]; 3]) -> Lanes<S> {
    let minor = |b: usize, c: usize| m[1][b].mul_add(m[2][c], -(m[1][c] * m[2][b]));
    let sum = m[0][0] * minor(1, 2);
    let sum = m[0][1].mul_add(minor(2, 0), sum);
    m[0][2].mul_add(minor(0, 1), sum)
}

/// `½ (H + Hᵀ)`, and `½ HᵀH` more at finite strain.
#[inline(always)]
fn strain<S: Simd>(simd: S, h: &[[Lanes<S>; 3]; 3], is_finite: bool) -> [Lanes<S>; 6] {
    let half = Lanes::splat(simd, 0.5);
    let mut strain = [Lanes::splat(simd, 0.0); 6];
    for (to, (i, j)) in strain.iter_mut().zip(Sym3::PAIRS) {
        let mut sum = h[i][j] + h[j][i];
        if is_finite {
            for k in 0..3 {
                sum = h[k][i].mul_add(h[k][j], sum);
            }
        }
        *to = half * sum;
    }
    strain
}

/// Stress and energy of an isotropic linear law.
#[inline(always)]
fn linear<S: Simd>(simd: S, lame: Lame, strain: &[Lanes<S>; 6]) -> ([Lanes<S>; 6], Lanes<S>) {
    let twice = Lanes::splat(simd, 2.0 * lame.mu);
    let mean = Lanes::splat(simd, lame.lambda) * (strain[0] + strain[1] + strain[2]);
    let mut stress = [mean; 6];
    let (mut normal, mut shear) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 0.0));
    for k in 0..3 {
        stress[k] = twice.mul_add(strain[k], mean);
        normal = stress[k].mul_add(strain[k], normal);
    }
    for k in 3..6 {
        stress[k] = twice * strain[k];
        shear = stress[k].mul_add(strain[k], shear);
    }
    (
        stress,
        Lanes::splat(simd, 0.5).mul_add(normal, shear), // shears count twice
    )
}

/// Stress, energy and tangent of any law, cell by cell; nothing where one has no answer.
#[inline(always)]
fn ask<S: Simd>(
    simd: S,
    batch: &Batch<'_>,
    point: usize,
    order: Order,
    strain: &[Lanes<S>; 6],
    new: &mut [f64],
    tangent: &mut [[Lanes<S>; 6]; 6],
) -> Option<([Lanes<S>; 6], Lanes<S>)> {
    let width = S::F64_LANES;
    let mut strains = [0.0; 6 * MOST];
    let (to, _) = S::as_mut_simd_f64s(&mut strains);
    for (to, from) in to.iter_mut().zip(strain) {
        *to = from.value();
    }
    let (mut stresses, mut energies) = ([0.0; 6 * MOST], [0.0; MOST]);
    let mut tangents = [0.0; 36 * MOST];
    let mut response = Response::default();
    for lane in 0..width {
        let strain = std::array::from_fn(|k| strains[k * width + lane]);
        let strain = Sym3::from_pairs(strain);
        let outcome = (batch.cell)(lane).respond(point, strain, order, new, &mut response);
        outcome.ok()?;
        energies[lane] = response.energy;
        for (k, stress) in response.stress.to_pairs().into_iter().enumerate() {
            stresses[k * width + lane] = stress;
        }
        if order == Order::Tangent {
            for (k, c) in response.tangent.as_flattened().iter().enumerate() {
                tangents[k * width + lane] = *c;
            }
        }
    }
    let mut stress = [Lanes::splat(simd, 0.0); 6];
    for (to, from) in stress.iter_mut().zip(S::as_simd_f64s(&stresses).0) {
        *to = Lanes::new(simd, *from);
    }
    let tangent = tangent.as_flattened_mut().iter_mut();
    for (to, from) in tangent.zip(S::as_simd_f64s(&tangents).0) {
        *to = Lanes::new(simd, *from);
    }
    let energy = Lanes::new(simd, *S::as_simd_f64s(&energies).0.first()?);
    Some((stress, energy))
}

type Moduli<S> = [[[[Lanes<S>; 3]; 3]; 3]; 3];

/// `F_ir C_rasb F_ks`
#[inline(always)]
fn moduli<S: Simd>(f: &[[Lanes<S>; 3]; 3], tangent: &[[Lanes<S>; 6]; 6]) -> Moduli<S> {
    let mut out = [[[[f[0][0]; 3]; 3]; 3]; 3];
    for i in 0..3 {
        for a in 0..3 {
            let mut half = [f[0][0]; 6];
            for q in 0..6 {
                half[q] = f[i][0] * tangent[PAIR[0][a]][q];
                for r in 1..3 {
                    half[q] = f[i][r].mul_add(tangent[PAIR[r][a]][q], half[q]);
                }
            }
            for k in 0..3 {
                for b in 0..3 {
                    let mut sum = f[k][0] * half[PAIR[0][b]];
                    for s in 1..3 {
                        sum = f[k][s].mul_add(half[PAIR[s][b]], sum);
                    }
                    out[i][a][k][b] = sum;
                }
            }
        }
    }
    out
}

/// (E17) without the stress.
#[inline(always)]
fn isotropic<S: Simd>(simd: S, lame: Lame, f: &[[Lanes<S>; 3]; 3]) -> Moduli<S> {
    let (lambda, mu) = (Lanes::splat(simd, lame.lambda), Lanes::splat(simd, lame.mu));
    let mut out = [[[[lambda; 3]; 3]; 3]; 3];
    for i in 0..3 {
        for k in 0..3 {
            let mut left = f[i][0] * f[k][0];
            for c in 1..3 {
                left = f[i][c].mul_add(f[k][c], left);
            }
            for a in 0..3 {
                for b in 0..3 {
                    let mut shear = f[i][b] * f[k][a];
                    if a == b {
                        shear = shear + left;
                    }
                    out[i][a][k][b] = mu.mul_add(shear, lambda * (f[i][a] * f[k][b]));
                }
            }
        }
    }
    out
}

/// Adds `N_I,a A_iakb N_J,b` (E2).
#[inline(always)]
fn add_stiffness<S: Simd, const NN: usize>(
    simd: S,
    gradient: &Gradient<S, NN>,
    moduli: &Moduli<S>,
    blocks: &mut [[S::f64s; 9]],
) {
    let mut rest = blocks;
    for (j, right) in gradient.iter().enumerate() {
        // A_iakb N_J,b
        let mut column = [[[right[0]; 3]; 3]; 3];
        for i in 0..3 {
            for a in 0..3 {
                for k in 0..3 {
                    let of = &moduli[i][a][k];
                    let sum = of[0] * right[0];
                    let sum = of[1].mul_add(right[1], sum);
                    column[i][a][k] = of[2].mul_add(right[2], sum);
                }
            }
        }
        let Some((own, others)) = rest.split_at_mut_checked(j + 1) else {
            return;
        };
        rest = others;
        for (to, left) in own.iter_mut().zip(gradient) {
            for i in 0..3 {
                for k in 0..3 {
                    let mut sum = Lanes::new(simd, to[3 * i + k]);
                    for a in 0..3 {
                        sum = left[a].mul_add(column[i][a][k], sum);
                    }
                    to[3 * i + k] = sum.value();
                }
            }
        }
    }
}
