//! Integrals of one facet along a normal at every point, for weights that stay as they are at the start.
//!
//! ```text
//! a_i = t1 × t2 of side i,  t_a = Σ_k ∂N_k/∂p_a x_k,  ν_i = −a_i/|a_i|       (E8)
//! ν = ν_s + (1 − β)(ν_m − ν_s), of length 1;  w = x_s − x_m ∥ ν              (E9)
//! D_j = ∫ψ_j |a_s| dp,  n_jk = ∫ψ_j ν N_k |a_s| dp,  n_jl = −∫ψ_j ν N^m_l |a_s| dp  (E10)
//! ```
//!
//! `|a_s|` is the area of the secondary surface per area of the plane: areas are those of the surface, where
//! [`Covered`](super::Covered) has those of the plane. The dual basis is that of the surface, too. A uniform pressure has
//! `Σ_j ψ_j = 1`, and so, where the sides coincide, the forces `p ∫N_k a dp` of a pressure on the bent facet at every node of
//! it; a gap that is the same along all normals is that gap in every row. With one normal for the facet, both scatter
//! between corners and middle nodes by the angle that the facet turns through.
//!
//! *Between both sides.* Where curved bodies are pressed flat, neither keeps its normals: the common surface is nearer to the
//! one that is stiffer. With the moduli `M` of both, `β = M_s/(M_s + M_m)` is the part of the secondary side, as in Hertz's
//! theory, where body i moves by `C_i/(C_1 + C_2)` of the gap. With the normals of one side alone, friction would act on a
//! slope that is not there: of two equal cylinders with half of the width of contact `a/R` = 0.085 and a coefficient of 0.3,
//! what slips at one end has slipped by twice as much as at the other. Sides whose normals differ by more than 30 degrees are
//! no pair of smooth surfaces: there, ν is that of the secondary one.
//!
//! *Balance.* Both sides of a row have the same points: `Σ_k n_jk + Σ_l n_jl = 0`. The point of the primary facet, or of its
//! continuation, is the one along ν, so that forces have no moment, open or closed.
//!
//! Of surfaces of revolution, areas have the factor `2π r` with the radius of the secondary point.
//!
//! *Limits.* There are no derivatives: only weights that are held may use it. Cells are those of the plane.
//!
//! Source: Johnson, Contact Mechanics, 1985, 4.1 (what of the gap each body makes up).

use super::basis::{Small, inverse};
use super::pair::facing;
use super::{Basis, Facet, Measure, OfFacet, Transformation};
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::overlap::{Facing, Parameters, Point, integrate};
use signorini_geometry::tensor::Vec3;
use std::f64::consts::TAU;

/// Degrees that areas and normals add to the integrands.
const DEGREES: usize = 2;

/// The cosine of the largest angle between both sides of smooth surfaces: 30 degrees.
pub const SMOOTH: f64 = 0.866_025_403_784_438_6;

/// Iterations for the point along the normal, and how far it may be from the one that is looked for in parameters.
const ITERATIONS: usize = 8;
const FAR: f64 = 1.0;

/// The residual distance across the normal, over the largest coordinate.
const ACROSS: f64 = 1e-15;

/// How facets are weighed.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// What integrals are taken over.
    pub measure: Measure,
    /// The weights of nodes of quadratic facets.
    pub basis: Basis,
    /// β: the part of the normals of the secondary side, between 0 and 1.
    pub share: f64,
}

/// A primary facet and the numbers of its nodes.
pub type Met<'a> = (Facet<'a>, &'a [NodeId]);

/// The sums over the points that a facet shares with others: `∫N_j N_k |a|`, `∫N_j N^m_l |a|`, and those with `a`.
struct Sums {
    mass: Small,
    mixed: Vec<f64>,
    own: [[Vec3; MAX_FACET_NODES]; MAX_FACET_NODES],
    others: Vec<Vec3>,
}

/// The normal between those of two sides, both out of the primary one, with this part of the secondary one; that of the
/// secondary one where they are no pair of smooth surfaces.
#[must_use]
pub fn between(secondary: Vec3, primary: Vec3, share: f64) -> Vec3 {
    if secondary.dot(primary) < SMOOTH {
        return secondary;
    }
    let mean = secondary * share + primary * (1.0 - share);
    mean.normalized().unwrap_or(secondary)
}

/// Replaces the integrals of a facet by (E10), over the primary facets that it was found to meet; says whether that was
/// possible. Where a point of either facet has no parameters, the integrals of the plane stay.
pub fn bend(secondary: &Facet, primaries: &[Met<'_>], held: Held, to: &mut OfFacet) -> bool {
    let n = secondary.x.len();
    let Some(sums) = Sums::over(secondary, primaries, held, &to.nodes) else {
        return false;
    };
    let Some(t) = Transformation::of(secondary.element, held.basis) else {
        return false;
    };
    whole(secondary, held.measure, &t, &mut to.full);
    sums.weigh(n, &t, super::scatters(secondary.element), to);
    true
}

/// The vector area −t1 × t2 per area in the parameters that the slopes are by.
fn vector_area(facet: &Facet, slopes: [&[f64]; 2]) -> Vec3 {
    let along = |slopes: &[f64]| -> Vec3 { slopes.iter().zip(facet.x).map(|(&d, &x)| x * d).sum() };
    let t2 = match facet.element.dim() {
        1 => Vec3::unit(2),
        _ => along(slopes[1]),
    };
    -along(slopes[0]).cross(t2)
}

/// By what areas are multiplied at a point.
fn factor(facet: &Facet, measure: Measure, at: Vec3) -> f64 {
    match measure {
        Measure::Revolved if facet.element.dim() == 1 => TAU * at.x,
        _ => 1.0,
    }
}

fn place(facet: &Facet, shape: &[f64]) -> Vec3 {
    shape.iter().zip(facet.x).map(|(&n, &x)| x * n).sum()
}

/// `D⁰_j` of the surface.
fn whole(facet: &Facet, measure: Measure, t: &Transformation, full: &mut [f64; MAX_FACET_NODES]) {
    let n = facet.x.len();
    let mut sums = [0.0; MAX_FACET_NODES];
    let (mut shape, mut dshape) = ([0.0; MAX_FACET_NODES], [Vec3::ZERO; MAX_FACET_NODES]);
    for (xi, w) in facet.element.surface_rule().iter() {
        facet.element.shape(xi, &mut shape[..n]);
        facet.element.dshape(xi, &mut dshape[..n]);
        let slopes = [0, 1].map(|a| dshape.map(|d| d[a]));
        let slopes = [&slopes[0][..n], &slopes[1][..n]];
        let factor = factor(facet, measure, place(facet, &shape[..n]));
        let area = w * vector_area(facet, slopes).norm() * factor;
        for (sum, shape) in sums.iter_mut().zip(&shape[..n]) {
            *sum += area * shape;
        }
    }
    for (j, full) in full.iter_mut().enumerate().take(n) {
        *full = (0..n).map(|k| t.get(j, k) * sums[k]).sum();
    }
}

impl Sums {
    fn over(
        secondary: &Facet,
        primaries: &[Met<'_>],
        held: Held,
        nodes: &[NodeId],
    ) -> Option<Self> {
        let (n, np) = (secondary.x.len(), nodes.len());
        let plane = secondary.plane()?;
        let flat = secondary.flat_on(&plane, Facing::Same)?;
        let mut sums = Self {
            mass: [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES],
            mixed: vec![0.0; n * np],
            own: [[Vec3::ZERO; MAX_FACET_NODES]; MAX_FACET_NODES],
            others: vec![Vec3::ZERO; n * np],
        };
        for (primary, numbers) in primaries {
            let other = primary.flat_on(&plane, Facing::Opposite)?;
            let normal = Vec3::from(primary.plane()?.normal);
            let (weight, _) = facing(-normal.dot(Vec3::from(plane.normal)));
            let column = |node: &NodeId| nodes.iter().position(|k| k == node);
            let columns: Vec<usize> = numbers.iter().map(column).collect::<Option<_>>()?;
            let mut each = |point: &Point| {
                let seen = Seen::at([secondary, primary], held, point);
                sums.add(&seen, (&columns, n), weight * point.weight);
            };
            let done = integrate(&flat, &other, |cell| {
                cell.simplices(|simplex| simplex.points(DEGREES, &mut each))
            });
            done.ok()?;
        }
        Some(sums)
    }

    /// Adds what a point contributes.
    fn add(&mut self, seen: &Seen, (columns, n): (&[usize], usize), weight: f64) {
        let np = self.mixed.len() / n.max(1);
        let area = weight * seen.area;
        for (j, &own) in seen.own.iter().take(n).enumerate() {
            for (k, &other) in seen.own.iter().take(n).enumerate() {
                self.mass[j][k] += area * own * other;
                self.own[j][k] += seen.normal * (area * own * other);
            }
            for (&column, &other) in columns.iter().zip(&seen.other) {
                self.mixed[j * np + column] += area * own * other;
                self.others[j * np + column] += seen.normal * (area * own * other);
            }
        }
    }

    /// (E1) and (E3) of the room with these sums, and (E9).
    fn weigh(&self, n: usize, t: &Transformation, scatters: bool, to: &mut OfFacet) {
        let np = to.nodes.len();
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        let mut d = [0.0; MAX_FACET_NODES];
        for j in 0..n {
            for k in 0..n {
                let line: f64 = (0..n).map(|m| t.get(j, m) * self.mass[m][k]).sum();
                d[j] += line;
                s[j][k] = (0..n)
                    .map(|i| {
                        (0..n)
                            .map(|m| t.get(j, i) * self.mass[i][m] * t.get(k, m))
                            .sum::<f64>()
                    })
                    .sum();
            }
            d[j] = d[j].max(0.0);
        }
        to.mass.clear();
        let whole = d[..n].iter().all(|d| *d > 0.0);
        if scatters && whole && s[..n].iter().all(|row| row[..n].iter().all(|s| *s >= 0.0)) {
            to.mass.extend(s[..n].iter().flat_map(|row| &row[..n]));
        }
        let found = inverse(&s, n);
        to.d = d;
        to.m.clear();
        to.vectors.clear();
        for j in 0..n {
            let mut b = [0.0; MAX_FACET_NODES];
            for (k, b) in b.iter_mut().enumerate().take(n).filter(|_| d[j] > 0.0) {
                *b = match &found {
                    Some(inverse) => {
                        d[j] * (0..n).map(|i| inverse[j][i] * t.get(i, k)).sum::<f64>()
                    }
                    None => t.get(j, k),
                };
            }
            let of = |l: usize| (0..n).map(|k| b[k] * self.mixed[k * np + l]).sum::<f64>();
            let own = |l: usize| (0..n).map(|k| self.own[k][l] * b[k]).sum::<Vec3>();
            let other = |l: usize| -(0..n).map(|k| self.others[k * np + l] * b[k]).sum::<Vec3>();
            to.m.extend((0..np).map(of));
            to.vectors.extend((0..n).map(own));
            to.vectors.extend((0..np).map(other));
        }
        self.balance(n, t, to);
    }

    /// What rounding leaves of the balance of each row goes to the primary nodes as `Ñ_j` would distribute it.
    fn balance(&self, n: usize, t: &Transformation, to: &mut OfFacet) {
        let np = to.nodes.len();
        for j in (0..n).filter(|&j| to.d[j] > 0.0) {
            let lumped = |l: usize| {
                (0..n)
                    .map(|k| t.get(j, k) * self.mixed[k * np + l])
                    .sum::<f64>()
            };
            let m = &mut to.m[j * np..][..np];
            let rest = (to.d[j] - m.iter().sum::<f64>()) / to.d[j];
            let vectors = &mut to.vectors[j * (n + np)..][..n + np];
            let forces: Vec3 = vectors.iter().copied().sum();
            for (l, m) in m.iter_mut().enumerate() {
                *m += rest * lumped(l);
                vectors[n + l] -= forces * (lumped(l) / to.d[j]);
            }
        }
    }
}

/// Shape functions, normal and area at a point of both sides.
struct Seen {
    /// N_k and N^m_l.
    own: [f64; MAX_FACET_NODES],
    other: [f64; MAX_FACET_NODES],
    /// ν.
    normal: Vec3,
    /// |a_s|, with the factor of the measure.
    area: f64,
}

impl Seen {
    fn at([secondary, primary]: [&Facet; 2], held: Held, point: &Point) -> Self {
        let vector = |facet: &Facet, there: &Parameters| {
            let slopes = [0, 1].map(|a| there.gradient.map(|g| g[a]));
            vector_area(facet, [&slopes[0], &slopes[1]])
        };
        let area = vector(secondary, &point.secondary);
        let of_primary = vector(primary, &point.primary).normalized();
        let own = area.normalized().unwrap_or_default();
        let normal = between(own, of_primary.unwrap_or(own), held.share);
        let at = place(secondary, &point.secondary.shape);
        Self {
            own: point.secondary.shape,
            other: along(primary, &point.primary, at, normal),
            normal,
            area: area.norm() * factor(secondary, held.measure, at),
        }
    }
}

/// The shape functions of a facet, or of its continuation, at its point along a normal from a place, by Newton's method
/// from a point near it; those there where it is not found.
fn along(facet: &Facet, near: &Parameters, from: Vec3, normal: Vec3) -> [f64; MAX_FACET_NODES] {
    let (element, n) = (facet.element, facet.x.len());
    let tolerance = ACROSS
        * facet
            .x
            .iter()
            .map(|x| x.max_abs())
            .fold(from.max_abs(), f64::max);
    let start = Vec3::new(near.xi[0], near.xi[1], 0.0);
    let (mut xi, mut shape) = (start, near.shape);
    let mut dshape = [Vec3::ZERO; MAX_FACET_NODES];
    for _ in 0..ITERATIONS {
        let away = from - place(facet, &shape[..n]);
        let across = away - normal * away.dot(normal);
        if across.norm() <= tolerance {
            return shape;
        }
        element.dshape(&xi, &mut dshape[..n]);
        let Some(step) = step(element, facet, &dshape[..n], across, normal) else {
            return near.shape;
        };
        xi += step;
        if (xi - start).norm() > FAR {
            return near.shape;
        }
        element.shape(&xi, &mut shape[..n]);
    }
    shape
}

/// The change of parameters that moves a point of a facet by this way across a normal.
fn step(
    element: Element,
    facet: &Facet,
    dshape: &[Vec3],
    across: Vec3,
    normal: Vec3,
) -> Option<Vec3> {
    let tangent = |a: usize| -> Vec3 {
        let t: Vec3 = dshape.iter().zip(facet.x).map(|(d, &x)| x * d[a]).sum();
        t - normal * t.dot(normal)
    };
    let t1 = tangent(0);
    if element.dim() == 1 {
        let square = t1.norm_squared();
        return (square > 0.0).then(|| Vec3::unit(0) * (t1.dot(across) / square));
    }
    let t2 = tangent(1);
    let det = t1.cross(t2).dot(normal);
    let parameters = Vec3::new(
        across.cross(t2).dot(normal),
        t1.cross(across).dot(normal),
        0.0,
    );
    (det != 0.0).then(|| parameters / det)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::mortar::Covered;
    use crate::contact::tests::Random;
    use signorini_geometry::element::{Element, TABLE, by_name, quadrature};

    /// Every facet with a dual basis.
    fn facets() -> impl Iterator<Item = Element> {
        let facets = TABLE.into_iter().filter(|e| e.dim() < 3);
        facets.filter(|e| e.dual_basis().is_some())
    }

    const HELD: Held = Held {
        measure: Measure::Flat,
        basis: Basis::Part,
        share: 0.5,
    };

    /// A facet on `height` over its parameters about its centre; lines lie in the plane.
    fn over(element: Element, height: impl Fn(Vec3) -> f64) -> Vec<Vec3> {
        let place = |xi: &Vec3| {
            let at = *xi - element.centre();
            match element.dim() {
                1 => Vec3::new(at.x, height(at), 0.0),
                _ => Vec3::new(at.x, at.y, height(at)),
            }
        };
        element.nodes().iter().map(place).collect()
    }

    /// The same surface, seen from its other side.
    fn reversed(element: Element, x: &[Vec3]) -> Vec<Vec3> {
        let mut shape = vec![0.0; x.len()];
        let mut place = |xi: &Vec3| {
            let other = match element.dim() {
                1 => -*xi,
                _ => Vec3::new(xi.y, xi.x, 0.0),
            };
            element.shape(&other, &mut shape);
            shape.iter().zip(x).map(|(n, x)| *x * *n).sum()
        };
        element.nodes().iter().map(&mut place).collect()
    }

    fn bent(element: Element, x: &[Vec3], others: &[Vec<Vec3>], held: Held) -> OfFacet {
        let own = Facet { element, x };
        let n = x.len() as u32;
        let numbers: Vec<Vec<u32>> = (0..others.len() as u32)
            .map(|k| (k * n..(k + 1) * n).collect())
            .collect();
        let met: Vec<Met<'_>> = others
            .iter()
            .zip(&numbers)
            .map(|(x, numbers)| (Facet { element, x }, &numbers[..]))
            .collect();
        let mut of = OfFacet {
            nodes: numbers.concat(),
            ..OfFacet::default()
        };
        assert!(bend(&own, &met, held, &mut of));
        of
    }

    /// `∫N_k a` by many points.
    fn forces(facet: &Facet, measure: Measure) -> Vec<Vec3> {
        let n = facet.x.len();
        let mut sums = vec![Vec3::ZERO; n];
        let (mut shape, mut dshape) = (vec![0.0; n], vec![Vec3::ZERO; n]);
        for (xi, w) in quadrature::on_facet(facet.element, &quadrature::gauss(8)) {
            facet.element.shape(&xi, &mut shape);
            facet.element.dshape(&xi, &mut dshape);
            let slopes = [0, 1].map(|a| dshape.iter().map(|d| d[a]).collect::<Vec<f64>>());
            let area = vector_area(facet, [&slopes[0], &slopes[1]]);
            let area = area * (w * factor(facet, measure, place(facet, &shape)));
            for (sum, shape) in sums.iter_mut().zip(&shape) {
                *sum += area * *shape;
            }
        }
        sums
    }

    #[test]
    fn an_even_pressure_has_the_forces_of_a_pressure_on_the_bent_surface_at_every_node() {
        for element in facets() {
            let name = element.name();
            for bend in [0.0, 0.05, 0.3] {
                let x = over(element, |at| bend * (at.x * at.x + 0.6 * at.y * at.y));
                let of = bent(element, &x, &[reversed(element, &x)], HELD);
                let n = x.len();
                let right = forces(&Facet { element, x: &x }, Measure::Flat);
                for (k, right) in right.iter().enumerate() {
                    let sum: Vec3 = (0..n).map(|j| of.vectors[j * 2 * n + k]).sum();
                    let error = (sum - *right).norm();
                    assert!(error < 1e-9, "{name} {bend} {k}: {sum:?} {right:?}");
                }
                // all of it is covered; areas of bent facets are no polynomials
                for (d, full) in of.d.iter().zip(&of.full).take(n) {
                    let rule = if bend == 0.0 { 1e-12 } else { 2e-3 * bend };
                    assert!((d - full).abs() < rule, "{name} {bend}: {d} {full}");
                }
            }
        }
    }

    #[test]
    fn an_even_pressure_on_a_surface_of_revolution_has_the_force_of_its_rings_along_the_axis() {
        for name in ["line2", "line3"] {
            let element = by_name(name).unwrap();
            let measure = Measure::Revolved;
            let x = over(element, |at| 0.3 * at.x * at.x + 0.1 * at.x);
            let x: Vec<Vec3> = x.iter().map(|x| *x + Vec3::unit(0) * 2.0).collect();
            let of = bent(
                element,
                &x,
                &[reversed(element, &x)],
                Held { measure, ..HELD },
            );
            let n = x.len();
            let along: f64 = (0..n)
                .flat_map(|j| &of.vectors[j * 2 * n..][..n])
                .map(|v| v.y)
                .sum();
            let rings = std::f64::consts::PI * (3.0f64.powi(2) - 1.0);
            assert!(
                (along.abs() - rings).abs() < 1e-11 * rings,
                "{name}: {along}"
            );
        }
    }

    /// Noise on all nodes, within the plane for lines.
    fn shaken(x: Vec<Vec3>, dim: usize, noise: f64, random: &mut Random) -> Vec<Vec3> {
        let shake = |x: Vec3| {
            let mut by = random.vector() * noise;
            if dim == 1 {
                by.z = 0.0;
            }
            x + by
        };
        x.into_iter().map(shake).collect()
    }

    #[test]
    fn forces_and_moments_of_every_row_balance_where_sides_are_apart_and_tilted() {
        let mut random = Random::new(11);
        for element in facets() {
            let name = element.name();
            for share in [0.0, 0.3, 1.0] {
                let noise = 0.04;
                let own = shaken(over(element, |_| 0.0), element.dim(), noise, &mut random);
                let up = if element.dim() == 1 { 1 } else { 2 };
                let others = [-0.7, 0.6].map(|side| {
                    let other = reversed(element, &over(element, |at| 0.15 * at.x));
                    let way = Vec3::unit(0) * side + Vec3::unit(up) * 0.2;
                    let other = other.into_iter().map(|x| x + way).collect();
                    shaken(other, element.dim(), noise, &mut random)
                });
                let of = bent(element, &own, &others, Held { share, ..HELD });
                let x: Vec<Vec3> = own.iter().copied().chain(others.concat()).collect();
                let n = x.len();
                for j in (0..own.len()).filter(|&j| of.d[j] > 0.0) {
                    let row = &of.vectors[j * n..][..n];
                    let force: Vec3 = row.iter().copied().sum();
                    let moment: Vec3 = row.iter().zip(&x).map(|(v, x)| x.cross(*v)).sum();
                    let size = row.iter().map(|v| v.norm()).fold(0.0, f64::max);
                    assert!(
                        force.norm() < 1e-13 * size.max(1.0),
                        "{name} {j}: {force:?}"
                    );
                    assert!(
                        moment.norm() < 1e-12 * size.max(1.0),
                        "{name} {j}: {moment:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn on_plane_facets_the_integrals_are_those_of_the_plane() {
        for element in facets() {
            let name = element.name();
            let own = over(element, |at| 0.2 * at.x);
            let moved = own.iter().map(|x| *x + Vec3::new(0.4, 0.08, 0.0));
            let moved: Vec<Vec3> = match element.dim() {
                1 => moved.collect(),
                _ => own.iter().map(|x| *x + Vec3::new(0.4, 0.0, 0.08)).collect(),
            };
            let other = reversed(element, &moved);
            let of = bent(element, &own, std::slice::from_ref(&other), HELD);
            let mut covered = Covered::new(Measure::Flat);
            let [own, other] = [&own, &other].map(|x| Facet { element, x });
            covered.evaluate(&own, &[other], &[], false).unwrap();
            let n = own.x.len();
            for j in 0..n {
                assert!((of.d[j] - covered.d()[j]).abs() < 1e-13, "{name}");
                for (l, m) in covered.m(j).iter().enumerate() {
                    let error = of.vectors[j * 2 * n + n + l] + covered.normal() * *m;
                    assert!(error.norm() < 1e-11, "{name} {j} {l}: {error:?}");
                }
            }
        }
    }
}
