//! An audit of accepted states, independent of the methods that computed them.
//!
//! ```text
//!   ──●────────●────────●──   secondary        ● corners of facets, × corners of the other side: where the smallest
//!      ╲    ×      ×   ╱      primary            gap of two faceted surfaces is; × between ● is the end of a cell
//! ```
//!
//! A method of contact compares the sides in its own way: by means over facets, at points inside, at nodes. Its result is
//! checked here point by point, with nothing but the positions of both sides, the tractions, and the stress of the
//! elements. An audit sees no row, no multiplier and no mortar integral, so that it can judge all methods, and states from
//! elsewhere.
//!
//! | symbol | name in code | unit |
//! |---|---|---|
//! | g | gap of a sample: signed distance from the closest facet that faces it, with the prescribed shift | length |
//! | g*(p) | `Rules::gap`: what the law has at a pressure, −p/ε of a penalty, 0 of a multiplier | length |
//! | h, θ | size of a facet, turn from one to the next | length, angle |
//! | s = h θ/8 | `bend`: how far a chord is from the curve that it stands for | length |
//! | t, A | traction on the secondary side at a node, and its area | |
//! | ν | the normal of the primary side at the closest point | |
//! | σ | Cauchy stress at a node, the mean over the elements around it | |
//! | Q | `HeatFlows`: heat per time by loads, by what holds temperatures, from rigid surfaces, of friction, and into storage | |
//! | W, W_∞ | `FreeMotion::work`, `work_throughout`: of viscous forces in an increment, and had they acted throughout | energy |
//!
//! ```text
//! (A1) apart       min g over the support of node k  >  max(g*, 0) + tol_k,   tol_k = TOUCH h + s of both sides
//! (A2) through     g of a sample < 1.5 min(g*, 0) − tol_k − DEEP h
//! (A3) direction   T = |t − (t·ν)ν| against the limit L(t·ν): T > L anywhere, |T − L| where it slips, T without friction;
//!                  a node may be off by (t·ν) tan(θ + 1°)
//! (A4) stress      Σ |S(A t − A σ n)| / Σ A (|t| + |σ|/2) over facets, with means S over the facets around each; and nodes
//!                  with |t| > STRAINED |σ|
//! (A5) energy      work of viscous forces in jumps over Σ |ΔW| of loads and supports
//! (A6) stopped     Σ |f·Δu| of contact forces on bodies that only contact holds  ≥  max(STOPPED · W, TOUCHED · W_∞)
//! (A7) heat        |Σ Q_in − Q_stored + R| over the largest Q of all increments so far, where it is more than rounding, and what |R|
//!                  is above HEAT_LEFT of that; R: the sum of the residuals of free temperatures
//! ```
//!
//! Where energy is conserved, a pressure belongs to an increment and not to its end: (A1) and (A2) allow for what the gap moves in one.
//!
//! (A1), (A3) and (A4) are judged by the part of the contact force that they concern, so that the last node of an edge does
//! not cause alarm. Where a method holds the geometry of the start, `g = g₀ + ν₀·(u_s − u_p)` at the closest points of the
//! start is judged ([`Sides::start`]).
//!
//! (A2) takes points inside edges, too, where facets meet at an angle or end: edges that cross have no corner inside.
//!
//! Limits: (A1) in space takes corners and, where these are apart, a grid of points on each facet, so that two edges that
//! cross are seen to a part of a facet; in the plane it is exact for straight facets. Joints are checked by (A4) alone. Of a
//! surface that may touch itself, corners of the other side are left out, and so is depth that was there at the start. A side
//! that never presses is not checked.
//!
//! To add a check: an entry of [`Check`](crate::system::Check), a file here, a line in [`contact`].

mod closest;
mod direction;
mod flat;
mod gaps;
mod rules;
mod stress;
mod support;

use crate::system::{ContactAudit, ContactFrame, Frame, FreeMotion, Measured};
use rules::{HEAT, HEAT_LEFT, VISCOUS, nothing, worst};
pub use rules::{Rules, Sides};
use support::Support;

/// Audits one contact at an accepted state.
#[must_use]
pub fn contact(
    of: &ContactFrame,
    frame: &Frame,
    sides: &Sides<'_>,
    rules: &dyn Rules,
) -> ContactAudit {
    let support = Support::new(of, sides, rules.joined());
    let mut audit = ContactAudit {
        name: of.name.clone(),
        nclosed: support.closed.len(),
        force: support.force,
        checks: Default::default(),
    };
    let presses = support.force > 0.0;
    if !rules.joined() && (presses || sides.overlap(of)) {
        let seen = gaps::look(&support, sides, rules);
        audit.checks[1] = gaps::through(&support, rules, &seen);
        if presses {
            audit.checks[0] = gaps::apart(&support, sides, rules, &seen);
            audit.checks[2] = direction::check(&support, sides, rules, &seen);
        }
    }
    // with inertia, what a contact exerts is not what stress carries
    if presses && frame.velocity.is_empty() {
        audit.checks[3] = stress::check(&support, frame, rules);
    }
    audit
}

/// Bodies that only contact holds are stopped by it where the work of contact forces in their motion is at least this part
/// of that of viscous forces. It is as large as that where a load drives them, and larger where a support does; where
/// nothing stops them, it is what convergence leaves, 1e-8.
const STOPPED: f64 = 1e-3;

/// The same for the work that viscous forces would have done all the time, which is 1e-3 of an elastic one: where a cube of
/// steel of 10 mm is carried by its own size, its weight does 4e-6 of it; what rounding leaves is 1e-12.
const TOUCHED: f64 = 1e-7;

/// Whether contact stopped bodies that only contact holds at the end of their motion in an increment (A6).
#[must_use]
pub fn stopped(motion: &FreeMotion) -> bool {
    let least = (STOPPED * motion.work).max(TOUCHED * motion.work_throughout);
    motion.opposed >= least
}

/// Audits the balance of heat (A7), where the largest heat per time before was this; none where no temperature was found.
#[must_use]
pub fn heat(frame: &Frame, largest: f64) -> Option<Measured> {
    let balance = frame.heat.as_ref().filter(|of| of.turnover > 0.0)?;
    let largest = largest.max(balance.turnover);
    let lost = (balance.lost() * balance.turnover).abs();
    let left = (balance.left.abs() - HEAT_LEFT * largest).max(0.0);
    Some(Measured {
        part: (lost + left) / largest,
        worst: (balance.imbalance() * balance.turnover).abs(),
        allowed: largest,
        ..nothing(HEAT)
    })
}

/// Audits the work of viscous forces that led to another equilibrium where there was none nearby (A5).
#[must_use]
pub fn viscous(frame: &Frame) -> Measured {
    let mut measured = nothing(VISCOUS);
    (measured.worst, measured.allowed) = (frame.work_jumps, frame.work_turnover);
    if frame.work_jumps > 0.0 && frame.work_turnover > 0.0 {
        measured.part = frame.work_jumps / frame.work_turnover;
    }
    measured
}
