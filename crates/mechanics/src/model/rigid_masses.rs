//! The masses of rigid bodies: those of their cells, of nodes that follow them, and those that are given.

use super::{CarrierMass, CarrierVelocity, Context};
use crate::load::mass::Moments;
use crate::system::{BodyRates, Rates, RigidMass};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;

impl Context<'_> {
    /// Finds the carriers that have a mass.
    pub(super) fn weigh(&mut self, at_nodes: &[(NodeId, f64)], given: &[CarrierMass]) {
        self.heavy = self.rigid_masses(at_nodes, given).into();
    }

    fn rigid_masses(&self, at_nodes: &[(NodeId, f64)], given: &[CarrierMass]) -> Vec<RigidMass> {
        let carriers = self.elimination.bodies();
        let mut moments = vec![Moments::default(); carriers.len()];
        let origin = |carrier: RigidId| {
            let body = carriers.get(carrier as usize);
            body.map_or(Vec3::ZERO, |body| body.reference)
        };
        let bodies = self.substances.iter().zip(self.cells_of_bodies());
        for (body, cells) in bodies {
            let (Some(carrier), Some(density)) = (body.carrier, body.density) else {
                continue;
            };
            if let Some(of) = moments.get_mut(carrier as usize) {
                let region = self.massive(body, &cells, density);
                of.push_cells(&region, self.reference, origin(carrier));
            }
        }
        for &(node, mass) in at_nodes {
            let carrier = self.elimination.body_of(node);
            let place = self.reference.get(node as usize);
            let of = carrier.and_then(|carrier| moments.get_mut(carrier as usize));
            if let (Some(carrier), Some(place), Some(of)) = (carrier, place, of) {
                of.push(mass, *place - origin(carrier));
            }
        }
        for one in given {
            let at = one
                .centroid
                .map_or(Vec3::ZERO, |at| at - origin(one.carrier));
            if let Some(of) = moments.get_mut(one.carrier as usize) {
                of.push_body(one.mass, at, one.inertia);
            }
        }
        let all = (0..).zip(&moments);
        all.filter_map(|(carrier, moments)| {
            let (mass, arm, inertia) = moments.body()?;
            Some(RigidMass {
                carrier,
                mass,
                arm,
                inertia,
            })
        })
        .collect()
    }

    /// How everything moves at the start; none where nothing does. Nodes that follow a rigid body with a mass move as it does.
    pub(super) fn rates_at_start(
        &self,
        mut velocity: Vec<Vec3>,
        given: &[CarrierVelocity],
    ) -> Option<Rates> {
        if velocity.is_empty() && given.is_empty() {
            return None;
        }
        velocity.resize(self.layout.nnode(), Vec3::ZERO);
        let carriers = self.elimination.bodies();
        let mut rates = vec![BodyRates::default(); self.heavy.len()];
        for (body, rates) in self.heavy.iter().zip(&mut rates) {
            let given = given.iter().rfind(|one| one.carrier == body.carrier);
            let carrier = carriers.get(body.carrier as usize);
            let (Some(given), Some(carrier)) = (given, carrier) else {
                continue;
            };
            let at = |place: Vec3| given.velocity + given.spin.cross(place - given.about);
            rates.velocity = at(carrier.reference + body.arm);
            rates.spin = given.spin;
            for &node in &carrier.nodes {
                let node = node as usize;
                if let (Some(to), Some(x)) = (velocity.get_mut(node), self.reference.get(node)) {
                    *to = at(*x);
                }
            }
        }
        Some(Rates::new(velocity, rates))
    }
}
