//! How a system moves in time: the rates of its nodes and rigid bodies.

use super::{Dof, Layout, Rates, Scheme, State, System};
use signorini_geometry::tensor::Vec3;

/// The largest motion of an unknown in the small time of [`System::nodal_rates`].
const SOON: f64 = 1e-6;

impl System {
    /// The largest of the rates of unknowns that are motions.
    pub(crate) fn fastest(&self, rates: &[f64]) -> f64 {
        let motions = rates.iter().take(self.layout.nmotion());
        motions.fold(0.0, |most: f64, rate| most.max(rate.abs()))
    }

    /// How the nodes move at a state where unknowns change at these rates. Of nodes that follow others it is a difference
    /// over a small time, good to ten digits of the largest rate.
    pub(crate) fn nodal_rates(&self, state: &State, rates: &[f64]) -> Vec<Vec3> {
        let layout = &self.layout;
        let fastest = self.fastest(rates);
        let mut moved = state.clone();
        let time = if fastest > 0.0 { SOON / fastest } else { 0.0 };
        self.advance(&mut moved, state, rates, time);
        let of_node = |(node, (to, from)): (usize, (&Vec3, &Vec3))| {
            let mut rate = Vec3::ZERO;
            for axis in 0..layout.ndim() {
                let dof = layout.node(node as u32, axis);
                let own = rates.get(dof as usize).copied().unwrap_or_default();
                rate[axis] = match self.elimination.depends(dof, layout) {
                    true if time > 0.0 => (to[axis] - from[axis]) / time,
                    _ => own,
                };
            }
            rate
        };
        let places = moved.x.iter().zip(&state.x).enumerate();
        places.map(of_node).collect()
    }

    /// Sets the accelerations of the nodes and of rigid bodies at a state, given those of unknowns.
    pub fn accelerate(&self, state: &mut State, accelerations: &[f64]) {
        let acceleration = self.nodal_rates(state, accelerations);
        let (nnode, nbody) = (self.layout.nnode(), self.heavy.len());
        let mut rates = state.rates.take();
        let of = rates.get_or_insert_with(|| Rates::at_rest(nnode, nbody));
        of.acceleration = acceleration;
        for &node in self.massless() {
            if let Some(to) = of.acceleration.get_mut(node as usize) {
                *to = Vec3::ZERO;
            }
        }
        for (body, rates) in self.heavy.iter().zip(&mut of.bodies) {
            let [along, about] = self.motion_of(body.carrier, accelerations);
            let spin = body.rotation(state) * rates.spin;
            let start = body.rates(state, [Vec3::ZERO, spin], [along, about]);
            (rates.acceleration, rates.spin_rate) = (start.acceleration, start.spin_rate);
        }
        state.rates = rates;
    }

    /// How fast unknowns change at a state: those of nodes, and of references of rigid bodies with a mass.
    #[must_use]
    pub fn rates_of_unknowns(&self, state: &State) -> Vec<f64> {
        let layout = &self.layout;
        let mut of = vec![0.0; layout.ndof()];
        let Some(rates) = &state.rates else {
            return of;
        };
        let mut set = |dof: Dof, to: f64| {
            if let Some(rate) = of.get_mut(dof as usize) {
                *rate = to;
            }
        };
        let [velocity, _] = self.nodal_motions(state, rates);
        for (node, v) in (0..).zip(velocity) {
            (0..layout.ndim()).for_each(|axis| set(layout.node(node, axis), v[axis]));
        }
        for (body, rates) in self.heavy.iter().zip(&rates.bodies) {
            let [velocity, _] = body.at(state, rates, Vec3::ZERO);
            let spin = body.rotation(state) * rates.spin;
            for axis in 0..3 {
                set(layout.translation(body.carrier, axis), velocity[axis]);
                set(layout.rotation(body.carrier, axis), spin[axis]);
            }
        }
        of
    }

    /// Sets the velocities of the nodes and of rigid bodies at a state, given those of unknowns.
    pub fn set_velocities(&self, state: &mut State, velocities: &[f64]) {
        let velocity = self.nodal_rates(state, velocities);
        let mut rates = state.rates.take();
        let of = rates.get_or_insert_with(|| Rates::at_rest(velocity.len(), self.heavy.len()));
        of.velocity = velocity;
        for (body, rates) in self.heavy.iter().zip(&mut of.bodies) {
            let [along, about] = self.motion_of(body.carrier, velocities);
            let start = body.rates(state, [along, about], [Vec3::ZERO; 2]);
            (rates.velocity, rates.spin) = (start.velocity, start.spin);
        }
        state.rates = rates;
    }

    /// What a rigid body has of rates of unknowns: along its axes and about them.
    fn motion_of(&self, carrier: u32, rates: &[f64]) -> [Vec3; 2] {
        let (layout, elimination) = (&self.layout, &self.elimination);
        let of = |dof: Dof| elimination.increment(dof, rates);
        [Layout::translation, Layout::rotation]
            .map(|dof| Vec3::from([0, 1, 2].map(|axis| of(dof(layout, carrier, axis)))))
    }

    /// Moves rates on to the end of an increment that leads from one state to another.
    pub fn advance_rates(&self, rates: &mut Rates, scheme: &Scheme, [from, to]: [&State; 2]) {
        let h = to.time - from.time;
        rates.advance(scheme, h, [&from.x, &to.x], self.massless());
        for (body, rates) in self.heavy.iter().zip(&mut rates.bodies) {
            let way = body.way_between(scheme, &self.layout, [from, to]);
            *rates = rates.advanced(scheme, h, &way);
        }
    }

    /// The largest displacement of a node or a rigid body with a mass.
    #[must_use]
    pub fn largest_displacement(&self, state: &State) -> f64 {
        let of_nodes = state.x.iter().zip(self.reference.iter());
        let of_nodes = of_nodes.map(|(x, start)| (*x - *start).norm());
        let of_bodies = self.heavy.iter().filter_map(|body| {
            let carrier = body.carrier as usize;
            let start = self.elimination.bodies().get(carrier)?.reference;
            Some((state.poses.get(carrier)?.origin - start).norm())
        });
        of_nodes.chain(of_bodies).fold(0.0, f64::max)
    }

    /// ‖a₁ − a₀‖ of an increment that leads from one state to another: the root mean square over nodes and rigid bodies with a mass.
    #[must_use]
    pub fn change_of_acceleration(&self, scheme: &Scheme, [from, to]: [&State; 2]) -> f64 {
        let Some(rates) = &from.rates else {
            return 0.0;
        };
        let h = to.time - from.time;
        let change =
            |way: Vec3, v: Vec3, a: Vec3| (scheme.acceleration(way, h, v, a) - a).norm_squared();
        let mut massless = self.massless().iter().copied().peekable();
        let (mut sum, mut count) = (0.0, 0_usize);
        let places = to.x.iter().zip(&from.x);
        let nodes = places.zip(rates.velocity.iter().zip(&rates.acceleration));
        for (node, ((to, from), (v, a))) in (0..).zip(nodes) {
            if massless.next_if_eq(&node).is_none() {
                sum += change(*to - *from, *v, *a);
                count += 1;
            }
        }
        for (body, rates) in self.heavy.iter().zip(&rates.bodies) {
            let way = body.way_between(scheme, &self.layout, [from, to]);
            sum += change(way.centroid, rates.velocity, rates.acceleration);
            count += 1;
        }
        (sum / count.max(1) as f64).sqrt()
    }

    /// Velocities and accelerations of the nodes at a state: those that follow a rigid body with a mass move as it does.
    pub(super) fn nodal_motions(&self, state: &State, rates: &Rates) -> [Vec<Vec3>; 2] {
        let mut motions = [rates.velocity.clone(), rates.acceleration.clone()];
        for (body, rates) in self.heavy.iter().zip(&rates.bodies) {
            let carrier = body.carrier as usize;
            let bodies = self.elimination.bodies().get(carrier);
            let (Some(of), Some(pose)) = (bodies, state.poses.get(carrier)) else {
                continue;
            };
            for &node in &of.nodes {
                let node = node as usize;
                let place = if state.is_small {
                    self.reference.get(node).map(|x| *x - of.reference)
                } else {
                    state.x.get(node).map(|x| *x - pose.origin)
                };
                let moving = body.at(state, rates, place.unwrap_or_default());
                for (all, one) in motions.iter_mut().zip(moving) {
                    if let Some(to) = all.get_mut(node) {
                        *to = one;
                    }
                }
            }
        }
        motions
    }
}
