//! Sides for the tests of mortar integrals.

use crate::contact::mortar::*;
use crate::contact::tests::Random;
pub(super) use crate::contact::tests::reference::reference;
use crate::cubic::CUBIC;
use serde_json::Value;
use signorini_geometry::element::{MAX_FACET_NODES, TABLE, by_name};
use signorini_geometry::tensor::Mat3;

/// Every facet that mortar contact takes as a secondary one: lines first, and linear ones.
pub(super) fn secondaries() -> impl Iterator<Item = Element> {
    let facets = TABLE.into_iter().filter(|e| e.dim() < 3);
    let mut facets: Vec<Element> = facets.filter(|e| e.dual_basis().is_some()).collect();
    facets.sort_by_key(|e| (e.dim(), e.order()));
    facets.into_iter()
}

/// With every primary facet; made-up ones of degree 3 come last.
pub(super) fn pairings() -> Vec<[Element; 2]> {
    let known = secondaries().flat_map(|a| secondaries().map(move |b| [a, b]));
    let cubic = secondaries().flat_map(|a| CUBIC.map(move |b| [a, b]));
    let all = known.chain(cubic);
    all.filter(|[a, b]| a.dim() == b.dim()).collect()
}

/// Those of the plane.
pub(super) fn pairings_of_lines() -> impl Iterator<Item = [Element; 2]> {
    pairings().into_iter().filter(|pair| pair[0].dim() == 1)
}

/// Uniform on [0, 1].
pub(super) fn unit(random: &mut Random) -> f64 {
    0.5 + 0.5 * random.signed()
}

pub(super) fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect()
}

pub(super) fn rows(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().unwrap().iter().map(numbers).collect()
}

/// Nodes of a facet about the origin, warped by `noise`, cubic ones by less: their nodes are closer.
pub(super) fn facet(element: Element, noise: f64, random: &mut Random) -> Vec<Vec3> {
    let noise = if element.order() > 2 {
        0.2 * noise
    } else {
        noise
    };
    let place = |xi: &Vec3| {
        let mut n = random.vector() * noise;
        if element.dim() == 1 {
            n.z = 0.0;
        }
        *xi - element.centre() + n
    };
    element.nodes().iter().map(place).collect()
}

/// Two primary facets over a secondary one, so that each covers a part of it.
pub(super) fn primaries(element: Element, noise: f64, random: &mut Random) -> [Vec<Vec3>; 2] {
    [-1.0, 1.0].map(|side| {
        let over = |x: Vec3| match element.dim() {
            1 => Vec3::new(side * 0.8 - x.x, x.y + 0.1, 0.0),
            _ => Vec3::new(side * 0.6 + x.x, 0.15 - x.y, x.z + 0.1),
        };
        facet(element, noise, random)
            .into_iter()
            .map(over)
            .collect()
    })
}

pub(super) fn evaluate(elements: [Element; 2], x: &[Vec<Vec3>], derivatives: bool) -> Covered {
    measured(Measure::Flat, elements, x, derivatives)
}

pub(super) fn measured(
    measure: Measure,
    elements: [Element; 2],
    x: &[Vec<Vec3>],
    derivatives: bool,
) -> Covered {
    let mut covered = Covered::new(measure);
    let [secondary, primary] = elements;
    let others: Vec<Facet> = x[1..]
        .iter()
        .map(|x| Facet {
            element: primary,
            x,
        })
        .collect();
    let own = Facet {
        element: secondary,
        x: &x[0],
    };
    covered.evaluate(&own, &others, &[], derivatives).unwrap();
    covered
}

pub(super) fn random_scene(
    elements: [Element; 2],
    noise: f64,
    random: &mut Random,
) -> Vec<Vec<Vec3>> {
    let [a, b] = primaries(elements[1], noise, random);
    vec![facet(elements[0], noise, random), a, b]
}

/// A grid of rectangles of the plane z = `z`, its normal up or down, and the numbers of its nodes.
pub(super) fn grid(x: &[f64], y: &[f64], up: bool) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let nodes = y
        .iter()
        .flat_map(|&y| x.iter().map(move |&x| Vec3::new(x, y, 0.0)));
    let nx = x.len();
    let mut facets = Vec::new();
    if y.len() == 1 {
        for i in 0..nx - 1 {
            facets.push(if up { vec![i + 1, i] } else { vec![i, i + 1] });
        }
    }
    for k in 0..y.len() - 1 {
        for i in 0..nx - 1 {
            let a = k * nx + i;
            let mut nodes = vec![a, a + 1, a + nx + 1, a + nx];
            if !up {
                nodes.reverse();
            }
            facets.push(nodes);
        }
    }
    (nodes.collect(), facets)
}

/// D and M of two surfaces of facets of one kind, by node.
pub(super) fn surfaces(
    element: Element,
    [secondary, primary]: [&(Vec<Vec3>, Vec<Vec<usize>>); 2],
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let positions = |(x, facets): &(Vec<Vec3>, Vec<Vec<usize>>)| -> Vec<Vec<Vec3>> {
        facets
            .iter()
            .map(|f| f.iter().map(|&k| x[k]).collect())
            .collect()
    };
    let (own, others) = (positions(secondary), positions(primary));
    let others: Vec<Facet> = others.iter().map(|x| Facet { element, x }).collect();
    let mut d = vec![0.0; secondary.0.len()];
    let mut m = vec![vec![0.0; primary.0.len()]; d.len()];
    let mut covered = Covered::default();
    for (nodes, x) in secondary.1.iter().zip(&own) {
        covered
            .evaluate(&Facet { element, x }, &others, &[], false)
            .unwrap();
        let met = covered.met().iter().flat_map(|&f| &primary.1[f]);
        let columns: Vec<usize> = met.copied().collect();
        for (j, &node) in nodes.iter().enumerate() {
            d[node] += covered.d()[j];
            for (&l, m_jl) in columns.iter().zip(covered.m(j)) {
                m[node][l] += m_jl;
            }
        }
    }
    (d, m)
}

/// The same grid of quad8 or quad9: mid nodes follow the corners.
pub(super) fn quadratic_grid(
    element: Element,
    x: &[f64],
    y: &[f64],
    up: bool,
) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let (mut nodes, mut facets) = grid(x, y, up);
    for facet in &mut facets {
        let corners: Vec<Vec3> = facet.iter().map(|&k| nodes[k]).collect();
        let quad = by_name("quad4").unwrap();
        let mut shape = [0.0; 4];
        for xi in &element.nodes()[4..] {
            quad.shape(xi, &mut shape);
            let at: Vec3 = corners.iter().zip(shape).map(|(x, n)| *x * n).sum();
            let known = nodes.iter().position(|x| (*x - at).norm() < 1e-12);
            facet.push(known.unwrap_or(nodes.len()));
            if known.is_none() {
                nodes.push(at);
            }
        }
    }
    (nodes, facets)
}

/// `∫ψ_j (x − x^m)` along the normal at the nodes of a surface, with the basis of this α.
pub(super) fn gaps(
    element: Element,
    alpha: f64,
    [secondary, primary]: [&(Vec<Vec3>, Vec<Vec<usize>>); 2],
) -> Vec<f64> {
    let t = Transformation::with_alpha(element, alpha);
    let n = element.nnode();
    let mut gaps = vec![0.0; secondary.0.len()];
    for nodes in &secondary.1 {
        let x: Vec<Vec3> = nodes.iter().map(|&k| secondary.0[k]).collect();
        let frame = Frame::of(&Facet { element, x: &x }).unwrap();
        let nu = frame.normal();
        // over all primary facets: ∫N, ∫N Nᵀ, and ∫N (x − x^m)·ν
        let (mut d, mut g, mut apart) = (
            [0.0; MAX_FACET_NODES],
            [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES],
            [0.0; MAX_FACET_NODES],
        );
        for facet in &primary.1 {
            let other: Vec<Vec3> = facet.iter().map(|&k| primary.0[k]).collect();
            let mut pair = Pair::default();
            let other = Facet { element, x: &other };
            if !pair.integrate(&frame, &other, 0, false).unwrap() {
                continue;
            }
            for j in 0..n {
                d[j] += pair.n(j);
                for k in 0..n {
                    g[j][k] += pair.nn(j, k);
                    apart[j] += pair.nn(j, k) * nu.dot(x[k]);
                    apart[j] -= pair.nm(j, k) * nu.dot(other.x[k]);
                }
            }
        }
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for (j, row) in s.iter_mut().enumerate().take(n) {
            for (k, s) in row.iter_mut().enumerate().take(n) {
                let over = |i: usize| (0..n).map(|m| t.get(k, m) * g[i][m]).sum::<f64>();
                *s = (0..n).map(|i| t.get(j, i) * over(i)).sum();
            }
        }
        let inverse = basis::inverse(&s, n).unwrap();
        for j in 0..n {
            let d: f64 = (0..n).map(|k| t.get(j, k) * d[k]).sum();
            let over = |i: usize| (0..n).map(|k| t.get(i, k) * apart[k]).sum::<f64>();
            let mean: f64 = (0..n).map(|i| inverse[j][i] * over(i)).sum();
            gaps[nodes[j]] += d * mean;
        }
    }
    gaps
}

/// What holds of every facet that was integrated over: `Σ_l M_jl = D_j ≥ 0`.
pub(super) fn balanced(covered: &Covered, what: &str) {
    for (j, d) in covered.d().iter().enumerate() {
        let sum: f64 = covered.m(j).iter().sum();
        assert!((d - sum).abs() < 1e-13, "{what}: {d:e} {sum:e}");
        assert!(*d >= 0.0, "{what}: {d:e}");
    }
}

/// The integrals, or why there are none.
pub(super) fn attempt(elements: [Element; 2], x: [&[Vec3]; 2]) -> Result<Covered, MortarError> {
    let [own, other] = [0, 1].map(|k| Facet {
        element: elements[k],
        x: x[k],
    });
    let mut covered = Covered::default();
    covered.evaluate(&own, &[other], &[], true)?;
    Ok(covered)
}

/// A facet bent about the y axis by `half` an angle to either side, its normal at the centre turned by `angle` from −e_z.
pub(super) fn bent(element: Element, half: f64, angle: f64) -> Vec<Vec3> {
    let turn = Mat3::rotation(Vec3::new(0.0, angle, 0.0));
    let place = |xi: &Vec3| {
        let at = (*xi - element.centre()) * 2.0 / if element.ncorner() == 3 { 1.0 } else { 2.0 };
        let phi = at.x * half;
        turn * Vec3::new(phi.sin() / half, -at.y, (phi.cos() - 1.0) / half)
    };
    element.nodes().iter().map(place).collect()
}

/// A facet and a flat one over the part of it about `at`, `size` times as large.
pub(super) fn patch(element: Element, at: Vec3, size: f64) -> Vec<Vec<Vec3>> {
    let centre = element.centre();
    let own: Vec<Vec3> = element.nodes().iter().map(|x| *x - centre).collect();
    let over = |x: &Vec3| match element.dim() {
        1 => *x * -size + at,
        _ => Vec3::new(x.x, -x.y, 0.0) * size + at,
    };
    vec![own.clone(), own.iter().map(over).collect()]
}
