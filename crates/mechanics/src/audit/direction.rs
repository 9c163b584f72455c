//! Directions of tractions (A3).

use super::gaps::Seen;
use super::support::Support;
use super::{Rules, Sides, nothing, worst};
use crate::system::{Measured, Status};
use signorini_geometry::tensor::Vec3;
use std::f64::consts::FRAC_PI_4;

/// The allowed part of the contact force in wrong directions.
const WRONG: f64 = 0.02;
/// The allowed error of a direction in addition to the turn between facets: 1 degree.
const OFF: f64 = 0.017_453_292_519_943_295;
/// Shear below this part of its limit is that of a point without friction for the while.
const FREE: f64 = 0.01;
/// The part by which friction may miss its limit.
const NEAR: f64 = 0.01;

/// Tractions in directions that friction does not allow.
pub fn check(support: &Support<'_>, sides: &Sides<'_>, rules: &dyn Rules, seen: &Seen) -> Measured {
    let of = support.of;
    let mut measured = nothing(WRONG);
    let mut found: Vec<(usize, f64)> = Vec::new();
    let (mut wrong, mut most) = (0.0, 0.0);
    for &k in &support.closed {
        let (Some(met), Some(node)) = (seen.nodes.get(k).copied().flatten(), support.nodes.get(k))
        else {
            continue;
        };
        if met.sharp {
            continue;
        }
        let bend = seen.bend(&met).angle + met.curvature * node.size;
        let allowance = (OFF + node.turn.max(bend)).min(FRAC_PI_4).tan();
        // the mean over points inside of facets is below the limit where some stick, or slip another way
        let is_mean = of.faces.is_some();
        let slips = !is_mean && of.status.get(k) == Some(&Status::Slip);
        let limit = |pressure| rules.limit(k, pressure);
        let judge = |normal| Parts::new(support.traction(k), normal, &limit, (slips, allowance));
        let mut parts = judge(met.normal);
        // a method that keeps the geometry of the start keeps the normals of one side or the other
        if let Some(own) = node.normal.normalized().filter(|_| sides.start.is_some()) {
            let others = judge(-own);
            if others.excess < parts.excess {
                parts = others;
            }
        }
        if parts.excess <= 0.0 {
            continue;
        }
        let load = support.area(k) * parts.excess;
        wrong += load;
        found.push((k, load));
        if load > most {
            most = load;
            let normal = parts.normal.abs().max(f64::MIN_POSITIVE);
            measured.worst = parts.shear / normal;
            measured.allowed = parts.limit / normal;
            measured.pressure = of.pressure.get(k).copied().unwrap_or_default();
        }
    }
    measured.part = wrong / support.force;
    measured.nodes = worst(of, found);
    measured
}

/// A traction along a normal.
struct Parts {
    normal: f64,
    shear: f64,
    /// The limit of friction; 0 without.
    limit: f64,
    /// Shear beyond the allowed one.
    excess: f64,
}

impl Parts {
    fn new(
        traction: Vec3,
        along: Vec3,
        limit: &dyn Fn(f64) -> Option<f64>,
        (slips, allowance): (bool, f64),
    ) -> Self {
        let normal = traction.dot(along);
        let shear = (traction - along * normal).norm();
        let limit = limit(normal.max(0.0));
        let excess = match limit {
            None => shear,
            Some(limit) if slips && shear > FREE * limit => (shear - limit).abs() - NEAR * limit,
            Some(limit) => shear - (1.0 + NEAR) * limit,
        };
        Self {
            normal,
            shear,
            limit: limit.unwrap_or(0.0),
            excess: excess - normal.abs() * allowance,
        }
    }
}
