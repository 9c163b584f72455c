//! The balance of heat from one accepted state to the next.

use super::newton::Newton;
use super::stepping::Progress;
use super::work::ExternalWork;
use crate::system::{
    Archive, ArchiveError, Heat, HeatBalance, HeatFlows, NodeId, SizedFlows, System, of_residuals,
};

/// The names under which it is stored: flows per time, and since the start; the rest.
const STORED: [&str; 3] = [
    "progress.heat",
    "progress.heat_total",
    "progress.heat_sizes",
];

/// The flows of the last accepted increment of a step that finds temperatures: those of loads and supports by the forces that
/// [`ExternalWork`] has noted, the others by what terms know.
fn flows(system: &System, work: &ExternalWork) -> SizedFlows {
    let mut flows = SizedFlows::default();
    for node in 0..system.layout.nnode() as NodeId {
        let dof = system.layout.temperature(node);
        let [loads, supports] = work.exerted(dof);
        flows.add(HeatFlows {
            loads,
            supports,
            ..HeatFlows::default()
        });
    }
    let terms = system.terms.iter();
    for term in terms.filter_map(|term| term.capabilities().conducting) {
        flows += term.flows();
    }
    flows
}

/// Takes the increment between two times that has been accepted into the balance.
pub(super) fn advance(
    progress: &mut Progress,
    newton: &Newton,
    system: &System,
    [from, to]: [f64; 2],
) {
    let Progress { heat, work, .. } = progress;
    let physics = newton.step.physics;
    if !physics.has_heat() {
        // what it takes to have the temperatures that are given is not counted
        heat.iter_mut().for_each(HeatBalance::rest);
        return;
    }
    let dt = (physics.heat == Heat::Transient).then_some(to - from);
    let flows = flows(system, work);
    let [all, rounding] = of_residuals(&system.layout, &newton.assembly);
    let left = [all - flows.sum.supports, rounding];
    *heat = Some(heat.unwrap_or_default().next(&flows, dt, left));
}

/// Stores a balance.
pub(super) fn save(balance: Option<&HeatBalance>, out: &mut Archive) {
    let Some(balance) = balance else { return };
    let [rate, total, sizes] = STORED;
    out.put(rate, &balance.rate.to_array());
    out.put(total, &balance.total.to_array());
    let of = [balance.turnover, balance.uncertainty, balance.left];
    out.put(sizes, &of);
}

/// Takes it back; none where the archive does not know of it.
///
/// # Errors
/// An array that is not there.
pub(super) fn load(from: &Archive) -> Result<Option<HeatBalance>, ArchiveError> {
    let mut balance = HeatBalance::default();
    if from.length(STORED[0]).is_err() {
        return Ok(None);
    }
    let [rate, total, sizes] = STORED;
    for (name, flows) in [(rate, &mut balance.rate), (total, &mut balance.total)] {
        let mut values = [0.0; HeatFlows::N];
        from.get(name, &mut values)?;
        *flows = HeatFlows::from_array(values);
    }
    let mut values = [0.0; 3];
    from.get(sizes, &mut values)?;
    [balance.turnover, balance.uncertainty, balance.left] = values;
    Ok(Some(balance))
}
