//! Tractions against the stress of the adjoining elements (A4).

use super::support::Support;
use super::{Rules, nothing, worst};
use crate::system::{Frame, Measured};
use signorini_geometry::tensor::{Mat3, Vec3};

/// The part of the contact force that stress may not carry: discretization errors, where few facets touch.
const UNCARRIED: f64 = 0.7;
/// The part of all stress that counts as a traction: that along the surface is not exact either.
const ALONG: f64 = 0.5;
/// How many times the stress around it a traction may be.
const STRAINED: f64 = 10.0;

/// Tractions that the stress around them does not carry.
pub fn check(support: &Support<'_>, frame: &Frame, rules: &dyn Rules) -> Measured {
    let of = support.of;
    let mut measured = nothing(UNCARRIED);
    let stress = |k: usize| {
        let node = of.nodes.get(k).copied()? as usize;
        let fixed = frame.reaction_force.get(node)?.to_array();
        let held = fixed.iter().filter(|r| **r != 0.0).count();
        let solid = *frame.stress_weight.get(node)? > 0.0;
        let free = held < 2 && solid && !rules.is_rigid(node as u32);
        free.then(|| frame.stress.get(node).map(|s| s.to_mat3()))?
    };
    let mut found: Vec<(usize, f64)> = Vec::new();
    let (mut strained, mut most) = (0.0, 0.0);
    for &k in &support.closed {
        let Some(stress) = stress(k) else {
            continue;
        };
        let size = norm(&stress);
        let traction = support.traction(k).norm();
        if traction > STRAINED * size {
            let load = support.load(k);
            strained += load;
            found.push((k, load));
            if load > most {
                most = load;
                (measured.worst, measured.allowed) = (traction, size);
                measured.pressure = of.pressure.get(k).copied().unwrap_or_default();
            }
        }
    }
    let (difference, whole) = differences(support, &stress);
    let part = if whole > 0.0 { difference / whole } else { 0.0 };
    measured.part = (strained / support.force).max(part);
    measured.nodes = worst(of, found);
    measured
}

/// The norm of a tensor.
fn norm(a: &Mat3) -> f64 {
    let [x, y, z] = a.rows;
    (x.norm_squared() + y.norm_squared() + z.norm_squared()).sqrt()
}

/// `Σ |S(A t − A σ n)|` and `Σ A (|t| + |σ|/2)` over the facets whose nodes are all carried by stress.
fn differences(support: &Support<'_>, stress: &dyn Fn(usize) -> Option<Mat3>) -> (f64, f64) {
    let of = support.of;
    let mut on_facets: Vec<Option<(Vec3, f64)>> = vec![None; support.facets.len()];
    for ((facet, (_, nodes)), to) in support.facets.iter().zip(&of.facets).zip(&mut on_facets) {
        if !facet.supports {
            continue;
        }
        let mut sum = (Vec3::ZERO, 0.0);
        let mut all = true;
        for &k in nodes {
            let k = k as usize;
            let Some(stress) = stress(k) else {
                all = false;
                break;
            };
            let share =
                support.area(k) / f64::from(support.nodes.get(k).map_or(1, |n| n.count.max(1)));
            let traction = match support.is_closed.get(k) {
                Some(true) => support.traction(k),
                _ => Vec3::ZERO,
            };
            sum.0 += (traction - stress * facet.normal) * share;
            sum.1 += (traction.norm() + ALONG * norm(&stress)) * share;
        }
        *to = all.then_some(sum);
    }
    let (mut difference, mut whole) = (0.0, 0.0);
    for (f, own) in on_facets.iter().enumerate() {
        let Some((own, load)) = own else {
            continue;
        };
        whole += load;
        difference += smoothed(support, &on_facets, f).unwrap_or(*own).norm();
    }
    (difference, whole)
}

/// The mean over a facet and those that share nodes with it.
fn smoothed(
    support: &Support<'_>,
    on_facets: &[Option<(Vec3, f64)>],
    facet: usize,
) -> Option<Vec3> {
    let nodes = &support.of.facets.get(facet)?.1;
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for &k in nodes {
        for &g in support.around(k as usize) {
            if let Some(Some((value, _))) = on_facets.get(g as usize) {
                sum += *value;
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}
