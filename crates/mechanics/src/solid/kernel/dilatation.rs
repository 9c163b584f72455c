//! The dilatation projected: B-bar at small strain, F-bar at finite strain, both from one energy.
//!
//! With `ϑ = tr ε` or `ϑ = ln J`, its projection `π[ϑ]` onto a polynomial over the element (least squares, weighted with
//! the volume at the start), and `m = ⅓ (π[ϑ] − ϑ)`, the material sees
//!
//! ```text
//! ε̄ = ε + m I                            at small strain                                       (E5)
//! F̄ = eᵐ F,  Ē = e²ᵐ E + ½ (e²ᵐ − 1) I   at finite strain                                      (E6)
//! ```
//!
//! and the energy is `Σ w W(ε̄)` or `Σ w W(Ē)`. With `s = eᵐ`, `C = I + 2E` (at small strain `s = 1`, `C = I`), `S = s² S̄`,
//! `ℂ = s⁴ ℂ̄` and `p = S:C` its variations are
//!
//! ```text
//! δW  = S:δE + p δm                                                                            (E7)
//! ΔδW = δE:ℂ:ΔE + S:ΔδE + δm (C:ℂ + 2S):ΔE + δE:(ℂ:C + 2S) Δm + (C:ℂ:C + 2p) δm Δm + p Δδm       (E8)
//! δm  = ⅓ (π[δϑ] − δϑ),  Σ w p Δδm = ⅓ Σ w (π[p] − p) Δδϑ                                        (E9)
//! δ ln J = tr(F⁻¹ δF),  Δδ ln J = −tr(F⁻¹ δF F⁻¹ ΔF)                                            (E10)
//! ```
//!
//! (E9) holds because the projection is symmetric in the product with the weights. At small strain the terms `2S`, `2p`
//! and `p Δδm` are absent. The mean of `ln J` takes the place of the usual mean of `J`: it is linear in nothing but
//! `δϑ`, keeps `J̄` positive, and agrees with it to first order.

use super::dense;
use super::element::{Element, Failure, Output};
use super::gradient::{Place, deformation, displacement_gradient, place, position, row, strain};
use super::stiffness::{add_force, add_stiffness, add_thermal, contract};
use crate::material::{Order, Response};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// The most terms of the polynomial: constant and linear.
pub(super) const MOST: usize = 4;

/// Vectors at the nodes.
pub(super) type Nodal<const NN: usize, const ND: usize> = [[f64; ND]; NN];

/// A point and its dilatation.
pub(super) struct Dilated<const NN: usize, const ND: usize, const NG: usize> {
    pub at: Place<NN, NG>,
    pub h: Mat3,
    pub f: Mat3,
    /// ϑ.
    pub value: f64,
    /// F⁻ᵀ N_I,X.
    pub spatial: [[f64; NG]; NN],
    /// The polynomial's terms.
    pub basis: [f64; MOST],
}

impl<const NN: usize, const ND: usize, const NG: usize> Dilated<NN, ND, NG> {
    pub fn new(element: &Element<'_>, frame: &Frame, point: usize) -> Result<Self, Failure> {
        let at = place::<NN, ND, NG>(element, point)?;
        let h = displacement_gradient::<NN, ND, NG>(&at.gradient, element.u);
        let finite = element.is_finite();
        let (f, _) = deformation::<ND, NG>(h, finite)?;
        let mut spatial = at.gradient;
        let mut value = h.rows[0].x + h.rows[1].y + h.rows[2].z;
        if finite {
            value = determinant_minus_one(h).ln_1p();
            let (inverse, _) = super::gradient::inverse(f)?;
            for (to, g) in spatial.iter_mut().zip(&at.gradient) {
                for a in 0..NG {
                    to[a] = (0..NG).map(|b| inverse.rows[b][a] * g[b]).sum();
                }
            }
        }
        let position = position(element.x, element.reference.shape(point));
        Ok(Self {
            at,
            h,
            f,
            value,
            spatial,
            basis: frame.basis(position),
        })
    }

    /// δϑ of each node's displacement.
    pub fn divergence(&self) -> Nodal<NN, ND> {
        let mut out = [[0.0; ND]; NN];
        for (out, g) in out.iter_mut().zip(&self.spatial) {
            out.copy_from_slice(&g[..ND]);
            if NG > ND {
                out[0] += g[ND];
            }
        }
        out
    }
}

/// `det(I + H) − 1`, by invariants, which keeps its digits at small `H`.
fn determinant_minus_one(h: Mat3) -> f64 {
    let [a, b, c] = h.rows;
    let trace = a.x + b.y + c.z;
    let second = a.x * b.y - a.y * b.x + b.y * c.z - b.z * c.y + a.x * c.z - a.z * c.x;
    trace + second + h.determinant()
}

/// Where the polynomial has its origin, and its length.
pub(super) struct Frame {
    centre: Vec3,
    per_length: f64,
    pub nterm: usize,
}

impl Frame {
    pub fn new(element: &Element<'_>) -> Self {
        let centre = element.x.iter().copied().sum::<Vec3>() / element.x.len() as f64;
        let sizes = element.x.iter().map(|x| (*x - centre).max_abs());
        Self {
            centre,
            per_length: sizes.fold(0.0, f64::max).recip(),
            nterm: element.ndilatation.min(MOST),
        }
    }

    fn basis(&self, position: Vec3) -> [f64; MOST] {
        let at = (position - self.centre) * self.per_length;
        [1.0, at.x, at.y, at.z]
    }
}

/// The projection onto the polynomial: the inverse of `Σ w φ φᵀ`.
pub(super) struct Projection {
    inverse: [f64; MOST * MOST],
    nterm: usize,
}

impl Projection {
    pub fn new(gram: &[[f64; MOST]; MOST], nterm: usize) -> Result<Self, Failure> {
        let mut a = [0.0; MOST * MOST];
        let mut inverse = [0.0; MOST * MOST];
        for i in 0..nterm {
            a[i * nterm..(i + 1) * nterm].copy_from_slice(&gram[i][..nterm]);
            inverse[i * nterm + i] = 1.0;
        }
        dense::solve(&mut a, nterm, &mut inverse, nterm).ok_or(Failure::Inverted { ratio: 0.0 })?;
        Ok(Self { inverse, nterm })
    }

    /// What moments are multiplied by to give the projection's value where the terms are `basis`.
    pub fn factors(&self, basis: &[f64; MOST]) -> [f64; MOST] {
        let n = self.nterm;
        let mut out = [0.0; MOST];
        for i in 0..n {
            for j in 0..n {
                out[j] += basis[i] * self.inverse[i * n + j];
            }
        }
        out
    }
}

pub(super) fn dot(a: &[f64; MOST], b: &[f64; MOST]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Moments of the terms of the projection over an element.
pub(super) struct Moments<const NN: usize, const ND: usize> {
    /// Σ w φ φᵀ
    pub gram: [[f64; MOST]; MOST],
    /// Σ w φ ϑ
    pub value: [f64; MOST],
    /// Σ w φ δϑ
    pub divergence: [[[f64; ND]; NN]; MOST],
}

impl<const NN: usize, const ND: usize> Moments<NN, ND> {
    #[inline]
    pub fn new<const NG: usize>(element: &Element<'_>, frame: &Frame) -> Result<Self, Failure> {
        let mut moments = Self {
            gram: [[0.0; MOST]; MOST],
            value: [0.0; MOST],
            divergence: [[[0.0; ND]; NN]; MOST],
        };
        for point in 0..element.npoint() {
            let here = Dilated::<NN, ND, NG>::new(element, frame, point)?;
            let divergence = here.divergence();
            for m in 0..frame.nterm {
                let factor = here.at.weight * here.basis[m];
                (0..frame.nterm).for_each(|n| moments.gram[m][n] += factor * here.basis[n]);
                moments.value[m] += factor * here.value;
                add_force(
                    moments.divergence[m].as_flattened_mut(),
                    factor,
                    &divergence,
                );
            }
        }
        Ok(moments)
    }
}

pub(super) fn respond<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let finite = element.is_finite();
    let symmetric = element.material.is_symmetric();
    let npoint = element.npoint();
    out.reset();

    let frame = Frame::new(element);
    let moments = Moments::<NN, ND>::new::<NG>(element, &frame)?;
    let projection = Projection::new(&moments.gram, frame.nterm)?;

    let mut response = Response::default();
    let mut pressures = Pressures::new(npoint, out);
    for point in 0..npoint {
        let here = Dilated::<NN, ND, NG>::new(element, &frame, point)?;
        let weight = here.at.weight;
        let factors = projection.factors(&here.basis);
        let m = (dot(&factors, &moments.value) - here.value) / 3.0;
        let dm = projected(&factors, &moments.divergence, here.divergence());
        let (value, metric, square) = dilated(strain(here.h, finite), m, finite);
        element.respond(point, value, order, out.new, &mut response)?;
        out.energy += weight * response.energy;
        if let Some(sample) = out.samples.get_mut(point) {
            let (h, ratio) = if finite {
                let growth = m.exp_m1();
                let h = here.h * (1.0 + growth) + Mat3::IDENTITY * growth;
                (h, here.value.exp())
            } else {
                (here.h + Mat3::IDENTITY * m, 1.0)
            };
            *sample = element.sample(point, h, [weight, ratio], out.new, &response);
            continue;
        }
        let stretched = Stretched {
            dm,
            metric,
            square,
            finite,
            symmetric,
        };
        let pressure = stretched.add(&here, &response, order, out);
        if !out.thermal.is_empty() {
            stretched.add_thermal(&here, &response, element.reference.thermal(point), out);
        }
        pressures.add(point, &here, pressure, out);
    }
    if finite && !out.stiffness.is_empty() {
        pressures.curve::<NN, ND, NG>(element, &frame, &projection, symmetric, out)?;
    }
    Ok(())
}

/// `⅓ (π[δϑ] − δϑ)` of every displacement, from the moments of `δϑ` and its value here.
#[inline]
pub(super) fn projected<const NN: usize, const ND: usize>(
    factors: &[f64; MOST],
    moments: &[Nodal<NN, ND>; MOST],
    mut here: Nodal<NN, ND>,
) -> Nodal<NN, ND> {
    for (node, dm) in here.iter_mut().enumerate() {
        for i in 0..ND {
            // terms that are not in use have the factor 0
            let mean: f64 = (0..MOST).map(|t| factors[t] * moments[t][node][i]).sum();
            dm[i] = (mean - dm[i]) / 3.0;
        }
    }
    here
}

/// A point at which the dilatation has been projected.
pub(super) struct Stretched<const NN: usize, const ND: usize> {
    /// δm of each displacement.
    pub dm: Nodal<NN, ND>,
    /// C.
    pub metric: Sym3,
    /// s².
    pub square: f64,
    pub finite: bool,
    /// Whether only blocks on and above the diagonal are wanted.
    pub symmetric: bool,
}

impl<const NN: usize, const ND: usize> Stretched<NN, ND> {
    /// Adds (E7) and all of (E8) but its last part, for which the pressure comes back.
    #[inline]
    pub fn add<const NG: usize>(
        &self,
        here: &Dilated<NN, ND, NG>,
        response: &Response,
        order: Order,
        out: &mut Output<'_>,
    ) -> f64 {
        let Self {
            dm,
            metric,
            square,
            finite,
            symmetric,
        } = self;
        let (gradient, weight) = (&here.at.gradient, here.at.weight);
        let stress = response.stress * *square;
        let pressure = stress.double_dot(*metric);
        let force = contract::<NN, ND, NG>(gradient, &here.f, &stress);
        add_force(out.force, weight, &force);
        add_force(out.force, weight * pressure, dm); // (E7)
        if order == Order::Stress {
            return pressure;
        }
        // (E8)
        let tangent = response.tangent.map(|r| r.map(|c| c * square * square));
        let f = finite.then_some([&here.f; 2]);
        add_stiffness::<NN, ND, NG>(gradient, f, weight, &stress, &tangent, *symmetric, out);
        let twice = if *finite { 2.0 } else { 0.0 };
        let (left, right) = contractions(&tangent, metric);
        let both = right.double_dot(*metric) + twice * pressure;
        let left = contract::<NN, ND, NG>(gradient, &here.f, &(left + stress * twice));
        let right = contract::<NN, ND, NG>(gradient, &here.f, &(right + stress * twice));
        let (dm, left, right) = (dm.as_flattened(), left.as_flattened(), right.as_flattened());
        let n = NN * ND;
        for (dof, to) in out.stiffness.chunks_exact_mut(n).enumerate() {
            let first = if *symmetric { dof / ND * ND } else { 0 };
            let (a, b) = (weight * dm[dof], weight * (right[dof] + both * dm[dof]));
            for ((to, left), dm) in to[first..].iter_mut().zip(&left[first..]).zip(&dm[first..]) {
                *to += a * left + b * dm;
            }
        }
        pressure
    }
}

impl<const NN: usize, const ND: usize> Stretched<NN, ND> {
    /// Adds the derivative of (E7) with respect to temperatures of the nodes, which have these shape functions.
    fn add_thermal<const NG: usize>(
        &self,
        here: &Dilated<NN, ND, NG>,
        response: &Response,
        shape: &[f64],
        out: &mut Output<'_>,
    ) {
        let (gradient, weight) = (&here.at.gradient, here.at.weight);
        let stress = response.thermal * self.square;
        let force = contract::<NN, ND, NG>(gradient, &here.f, &stress);
        add_thermal(out.thermal, weight, force.as_flattened(), shape);
        let pressure = stress.double_dot(self.metric);
        add_thermal(
            out.thermal,
            weight * pressure,
            self.dm.as_flattened(),
            shape,
        );
    }
}

/// Pressures of the points, and their moments.
pub(super) struct Pressures([f64; MOST]);

impl Pressures {
    pub fn new(npoint: usize, out: &mut Output<'_>) -> Self {
        out.scratch.clear();
        out.scratch.resize(npoint, 0.0);
        Self([0.0; MOST])
    }

    #[inline]
    pub fn add<const NN: usize, const ND: usize, const NG: usize>(
        &mut self,
        point: usize,
        here: &Dilated<NN, ND, NG>,
        pressure: f64,
        out: &mut Output<'_>,
    ) {
        out.scratch[point] = pressure;
        for (to, basis) in self.0.iter_mut().zip(&here.basis) {
            *to += here.at.weight * basis * pressure;
        }
    }

    /// Adds the last part of (E8).
    pub fn curve<const NN: usize, const ND: usize, const NG: usize>(
        &self,
        element: &Element<'_>,
        frame: &Frame,
        projection: &Projection,
        symmetric: bool,
        out: &mut Output<'_>,
    ) -> Result<(), Failure> {
        for point in 0..element.npoint() {
            let here = Dilated::<NN, ND, NG>::new(element, frame, point)?;
            let mean = dot(&projection.factors(&here.basis), &self.0);
            let factor = here.at.weight * (mean - out.scratch[point]) / 3.0; // (E9)
            add_curvature::<NN, ND, NG>(&here.spatial, factor, symmetric, out.stiffness);
        }
        Ok(())
    }
}

/// The strain with the dilatation `m`, its metric, and the square of the stretch.
#[inline]
pub(super) fn dilated(plain: Sym3, m: f64, finite: bool) -> (Sym3, Sym3, f64) {
    let identity = Sym3::IDENTITY;
    if finite {
        let growth = (2.0 * m).exp_m1();
        let value = plain * (1.0 + growth) + identity * (0.5 * growth); // (E6)
        (value, identity + plain * 2.0, 1.0 + growth)
    } else {
        (plain + identity * m, identity, 1.0) // (E5)
    }
}

/// `C:ℂ` and `ℂ:C`.
fn contractions(tangent: &[[f64; 6]; 6], metric: &Sym3) -> (Sym3, Sym3) {
    let mut doubled = metric.to_pairs();
    doubled[3..].iter_mut().for_each(|c| *c *= 2.0);
    let (mut left, mut right) = ([0.0; 6], [0.0; 6]);
    for p in 0..6 {
        for q in 0..6 {
            left[q] += doubled[p] * tangent[p][q];
            right[p] += tangent[p][q] * doubled[q];
        }
    }
    (Sym3::from_pairs(left), Sym3::from_pairs(right))
}

/// Adds `factor · Δδ ln J` (E10).
fn add_curvature<const NN: usize, const ND: usize, const NG: usize>(
    spatial: &[[f64; NG]; NN],
    factor: f64,
    symmetric: bool,
    stiffness: &mut [f64],
) {
    let n = NN * ND;
    for (dof, to) in stiffness.chunks_exact_mut(n).enumerate() {
        let (node, i) = (dof / ND, dof % ND);
        let first = if symmetric { node } else { 0 };
        let mine = spatial[node];
        let others = to.chunks_exact_mut(ND).zip(spatial).skip(first);
        for (to, other) in others {
            for k in 0..ND {
                to[k] -= factor * mine[k] * other[i];
            }
            if NG > ND && row::<ND, NG>(i, ND).is_some() {
                to[0] -= factor * mine[ND] * other[ND];
            }
        }
    }
}
