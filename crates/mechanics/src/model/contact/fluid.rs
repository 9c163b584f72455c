//! The fluid between the sides of a contact.

use super::{ModelError, Sides, Steps};
use crate::contact::Fluid;
use crate::model::{ContactPart, PrimaryPart};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::Carrier;

impl Steps<'_> {
    /// The fluid of a contact, with its pressure in each step: it grows linearly to what it is at the end of the first, and of
    /// those that change it.
    pub(super) fn fluid(
        &self,
        sides: &Sides,
        part: &ContactPart,
    ) -> Result<Option<Fluid>, ModelError> {
        let Some(of) = &part.fluid else {
            return Ok(None);
        };
        self.takes_fluid(sides, part)?;
        let mut pressures = Vec::new();
        let (mut before, mut now) = (0.0, of.pressure);
        for changes in &self.changes {
            let own = changes
                .iter()
                .filter(|change| change.contact == sides.contact);
            now = own.rev().find_map(|change| change.fluid).unwrap_or(now);
            pressures.push([before, now]);
            before = now;
        }
        let mut seeds = of.seeds.clone();
        seeds.sort_unstable();
        seeds.dedup();
        if !seeds.iter().any(|node| sides.has(*node)) {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "its fluid comes from nodes that are on neither side",
                remedy: "name nodes of the surfaces that meet, as `from` of `fluid`",
            });
        }
        Ok(Some(Fluid {
            seeds,
            pressures,
            critical: of.critical,
            ramp: of.ramp,
            recedes: of.recedes,
        }))
    }

    fn takes_fluid(&self, sides: &Sides, part: &ContactPart) -> Result<(), ModelError> {
        let varies = self
            .variants
            .get(sides.contact)
            .is_some_and(|v| v.len() > 1);
        let is_own = matches!(part.primary, PrimaryPart::Itself);
        for (wrong, what, remedy) in [
            (
                part.two_pass,
                "in two passes a `fluid` would press twice",
                "passes = 1",
            ),
            (
                part.tie.is_some(),
                "no `fluid` comes between sides that are joined",
                "no `tied`",
            ),
            (
                is_own,
                "a `fluid` takes two sides",
                "the other side as `primary`",
            ),
            (
                sides.pair.secondary.is_none(),
                "a `fluid` goes along the facets of the secondary side, which is bare nodes",
                "a surface as `secondary`",
            ),
            (
                varies,
                "a `fluid` takes facets that are there in all steps",
                "no elements of its sides activated or deactivated",
            ),
        ] {
            if wrong {
                return Err(ModelError::Unsuited {
                    contact: part.name.clone(),
                    what,
                    remedy,
                });
            }
        }
        Ok(())
    }
}

impl Sides {
    /// Whether a node is of either side.
    fn has(&self, node: NodeId) -> bool {
        let surface = self.pair.primary.as_ref();
        let of_primary = (0..surface.nfacet() as u32).any(|facet| match surface.carrier(facet) {
            Carrier::Nodes(nodes) => nodes.contains(&node),
            _ => false,
        });
        of_primary || self.pair.points.binary_search(&node).is_ok()
    }
}
