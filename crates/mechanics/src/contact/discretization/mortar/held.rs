//! Weights that are held, along a normal at every point ((E8) to (E10) of [`crate::contact::mortar`]).

use super::facets::nodes_of;
use super::{Mortar, Normals};
use crate::contact::discretization::SurfacePair;
use crate::contact::mortar::{Facet, Held, Measure, Met, OfRow, Weights, bend};
use signorini_geometry::surface::{Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;

impl Mortar {
    /// Replaces the integrals of facets by those along normals between both sides, with this part of the secondary one; says
    /// whether there are any. Joined sides have no normal.
    pub(super) fn bend(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        share: f64,
        weights: &mut Weights,
    ) -> Result<bool, SurfaceError> {
        // about an axis, normals at points near it would give its node a pressure apart from those of its neighbours
        let wanted = !self.form.joined
            && self.form.normals != Normals::Nodal
            && self.measure == Measure::Flat;
        let Some(facets) = pair.secondary.as_ref().filter(|_| wanted) else {
            return Ok(false);
        };
        let x = |n: &u32| at.x.get(*n as usize).copied().unwrap_or_default();
        let held = Held {
            measure: self.measure,
            basis: self.form.basis,
            share,
        };
        let mut bent = false;
        for (facet, of) in (0..).zip(&mut weights.facets) {
            let Some(element) = facets.element(facet).filter(|_| !of.met.is_empty()) else {
                continue;
            };
            let own: Vec<Vec3> = facets.nodes(facet).iter().map(x).collect();
            let own = Facet { element, x: &own };
            let places: Vec<Vec<Vec3>> = of
                .met
                .iter()
                .map(|&other| nodes_of(pair, other).iter().map(x).collect())
                .collect();
            let primaries: Vec<Met<'_>> = of
                .met
                .iter()
                .zip(&places)
                .filter_map(|(&other, x)| {
                    let element = pair.primary.domain(other)?;
                    Some((Facet { element, x }, nodes_of(pair, other)))
                })
                .collect();
            bent |= bend(&own, &primaries, held, of);
        }
        if bent {
            self.add_up_all(facets, at, weights)?;
        }
        Ok(bent)
    }

    /// The vectors of all rows, by those of their facets where these bend.
    pub(super) fn along_normals(&self, facets: &Facets, weights: &mut Weights) {
        let Weights {
            rows,
            facets: of,
            guests,
            ..
        } = weights;
        for (row, to) in rows.iter_mut().enumerate() {
            let around = self.around.get(row).map_or(&[][..], Vec::as_slice);
            to.normal = Vec3::ZERO;
            to.vector.fill(Vec3::ZERO);
            for (facet, place, share) in guests.of(row, around) {
                let Some(covered) = of.get(facet as usize).filter(|of| !of.met.is_empty()) else {
                    continue;
                };
                let own = facets.nodes(facet);
                let (n, np) = (own.len(), covered.nodes.len());
                let mut add = |node, vector: Vec3, is_secondary| {
                    if let Some(sum) = sum_of(to, node, is_secondary) {
                        *sum += vector * share;
                    }
                };
                if covered.vectors.is_empty() {
                    let (nu, d) = (covered.normal, covered.d[place]);
                    for (&node, t) in own.iter().zip(&self.inverse(facet)[place]) {
                        add(node, nu * (t * d), true);
                    }
                    let m = covered.m.iter().skip(place * np);
                    for (&node, &m) in covered.nodes.iter().zip(m) {
                        add(node, nu * -m, false);
                    }
                    to.normal += nu * (share * d);
                    continue;
                }
                let vectors = covered.vectors.iter().skip(place * (n + np)).take(n + np);
                let nodes = own.iter().chain(&covered.nodes);
                for (k, (&node, &vector)) in nodes.zip(vectors).enumerate() {
                    add(node, vector, k < n);
                }
                let own = covered.vectors.iter().skip(place * (n + np)).take(n);
                to.normal += own.copied().sum::<Vec3>() * share;
            }
        }
    }
}

/// The entry of a node on one side in the vectors of a row.
fn sum_of(row: &mut OfRow, node: u32, is_secondary: bool) -> Option<&mut Vec3> {
    let (secondary, primary) = row.nodes.split_at_checked(row.nsecondary)?;
    let place = match is_secondary {
        true => secondary.iter().position(|n| *n == node),
        false => primary
            .iter()
            .position(|n| *n == node)
            .map(|k| k + secondary.len()),
    };
    row.vector.get_mut(place?)
}
