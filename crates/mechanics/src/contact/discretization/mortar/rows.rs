//! Mortar rows as contact sees them.

use super::facets::search;
use super::integrals::Integrator;
use super::place::{Place, Workspace};
use super::{Mortar, ONE, TASK, integrals};
use crate::contact::discretization::projected::Point;
use crate::contact::discretization::{
    Anchored, Averaged, BentSides, Capabilities, Curved, Discretization, HeldAxes, Links, NOWHERE,
    OnRow, Pair, Pairing, Renewable, SlidingRange, SurfacePair,
};
use crate::contact::mortar::{Guests, Weights};
use crate::contact::row::{Participant, RowOrder, Rows, Wanted};
use rayon::prelude::*;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;

impl Discretization for Mortar {
    fn nrow(&self) -> usize {
        self.nodes.len()
    }

    fn point(&self, row: usize) -> Point<'_> {
        Point {
            nodes: self.nodes.get(row).map_or(&[], std::slice::from_ref),
            weights: &ONE,
            all: &[],
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        let sliding = match self.held {
            Some(_) => SlidingRange::Small,
            None => SlidingRange::Finite,
        };
        Capabilities {
            is_symmetric: self.held.is_some(),
            sliding,
            averaged: Some(self),
            curved: Some(self),
            ..Capabilities::default()
        }
    }

    fn averaged_mut(&mut self) -> Option<&mut dyn Averaged> {
        Some(self)
    }

    fn renewable_mut(&mut self) -> Option<&mut dyn Renewable> {
        None
    }

    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Search,
        last: &Pairing,
        next: RowOrder,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        if self.held.is_none() {
            out.weights.guests.clone_from(&last.weights.guests);
            self.weigh(pair, at, near, (&last.weights, next), &mut out.weights)?;
            if out.weights.guests.left.is_empty() {
                self.rest(pair, at, &mut out.weights, true)?;
            }
        }
        let near = |row: usize, facets: &mut Vec<u32>| {
            facets.clear();
            facets.extend_from_slice(near.candidates().near(row));
        };
        let before = |row: usize| last.pairs.get(row).copied().flatten();
        self.choose(pair, at, &near, &before, out)
    }

    fn row(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let weights = self.weights(links.pairing);
        let found = links.pairing.pairs.get(row).and_then(Option::as_ref);
        if found.is_some_and(|pair| pair.anchor != NOWHERE) {
            return self.points.row(row, pair, at, links, wanted, out);
        }
        let Some(now) = weights.row(row).filter(|_| found.is_some()) else {
            out.start([]);
            return Ok(());
        };
        let slides = wanted.slip && self.held.is_none();
        let place = Place {
            mortar: self,
            row,
            pair,
            at,
            weights,
            now,
            past: links.before.weights.row(row).filter(|_| slides),
            anchor: links.anchors.get(row).and_then(Option::as_ref),
            bond: links.bond,
        };
        let (facet, _) = self.around[row].first().copied().unwrap_or_default();
        let normal = now.normal.normalized();
        let normal = normal.ok_or(SurfaceError::Degenerate { facet })?;
        let mut scratch = std::mem::take(&mut out.scratch);
        let work = scratch.of::<Workspace>();
        if wanted.order == RowOrder::Gap {
            out.start([]);
        } else {
            place.participants(&mut work.participants);
            out.start(work.participants.iter().map(|&n| Participant::Node(n)));
        }
        out.set_secondary(0..now.nsecondary);
        let into = out.push(row, wanted);
        into.gap = place.gap();
        into.normal = normal;
        let done = match wanted.order {
            RowOrder::Gap => Ok(()),
            _ => place.fill(into, wanted, work),
        };
        out.scratch = scratch;
        done
    }

    /// Where the row is now: what lies before this state is in the weights.
    fn anchor(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        found: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError> {
        if found.anchor != NOWHERE {
            return self.points.anchor(row, pair, at, found, slip);
        }
        let x = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        let held = self.held.as_ref().and_then(|held| held.weights.row(row));
        let way = held.map_or(Vec3::ZERO, |of| of.way(x(self.nodes[row]), &x) / of.d);
        Ok(Anchored {
            anchor: NOWHERE,
            offset: way - slip,
        })
    }
}

impl Averaged for Mortar {
    fn support(
        &mut self,
        pair: &SurfacePair,
        held: HeldAxes,
    ) -> Result<Option<Vec<f64>>, SurfaceError> {
        self.take_supports(pair, held)
    }

    fn yield_at(&mut self, nodes: BTreeSet<NodeId>) {
        self.yields = nodes;
    }

    fn settle(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        now: &mut Pairing,
        before: &mut Pairing,
        anchors: &mut [Option<Anchored>],
        from_rest: bool,
    ) -> Result<bool, SurfaceError> {
        if self.held.is_some() {
            return Ok(false);
        }
        let kinds = now.weights.guests.pointwise.clone();
        let slips = self.slips(at, now, before, anchors);
        if !self.rest(pair, at, &mut now.weights, from_rest)? {
            return Ok(false);
        }
        let known = now.pairs.clone();
        let met = now.weights.clone();
        let near = |row: usize, facets: &mut Vec<u32>| self.met_around(row, pair, &met, facets);
        let last = |row: usize| known.get(row).copied().flatten();
        self.choose(pair, at, &near, &last, now)?;
        if let Some(facets) = pair
            .secondary
            .as_ref()
            .filter(|_| !before.weights.is_empty())
        {
            before.weights.guests.clone_from(&now.weights.guests);
            self.add_up_all(facets, at, &mut before.weights)?;
        }
        for (row, anchor) in anchors.iter_mut().enumerate() {
            let is = now.weights.guests.is_pointwise(row);
            if anchor.is_none() || kinds.get(row).is_some_and(|was| *was) == is {
                continue;
            }
            let slip = slips.get(row).copied().unwrap_or_default();
            *anchor = match &now.pairs[row] {
                Some(found) if is => Some(self.points.anchor(row, pair, at, found, slip)?),
                Some(_) => Some(Anchored {
                    anchor: NOWHERE,
                    offset: Vec3::ZERO,
                }),
                None => None,
            };
        }
        Ok(true)
    }

    fn more_nodes<'a>(&'a self, row: usize, pairing: &'a Pairing) -> &'a [NodeId] {
        match self.weights(pairing).rows.get(row) {
            Some(of) => &of.nodes[..of.nsecondary],
            None => self.near.get(row).map_or(&[], Vec::as_slice),
        }
    }

    fn more_facets(&self, row: usize, pairing: &Pairing, out: &mut Vec<u32>) {
        let Weights { facets, guests, .. } = self.weights(pairing);
        if guests.is_pointwise(row) {
            return;
        }
        let around = self.around.get(row).map_or(&[][..], Vec::as_slice);
        for (facet, ..) in guests.of(row, around) {
            let of = facets.get(facet as usize);
            out.extend(of.into_iter().flat_map(|f| &f.met));
        }
    }

    fn adjacent(&self, row: usize, pair: &SurfacePair, out: &mut Vec<usize>) {
        let Some(facets) = &pair.secondary else {
            return;
        };
        for &(facet, _) in self.around.get(row).into_iter().flatten() {
            let on = self.rows.get(facet as usize).map_or(&[][..], |rows| rows);
            for &other in on.iter().take(facets.nodes(facet).len()) {
                if other != row && !out.contains(&other) {
                    out.push(other);
                }
            }
        }
    }

    fn guests(&self, row: usize, pair: &SurfacePair, pairing: &Pairing, out: &mut Vec<NodeId>) {
        let Some(facets) = &pair.secondary else {
            return;
        };
        let guests = &self.weights(pairing).guests;
        let Guests { left, taken, .. } = guests;
        for &(facet, place, _) in taken.get(row).into_iter().flatten() {
            // a node of an edge may have a row of its own on another side
            let own = self.rows.get(facet as usize).map_or(0, |rows| rows[place]);
            let has = |row: usize| left.get(row) == Some(&false) || guests.is_pointwise(row);
            if self.of_same_node(own).any(has) {
                continue;
            }
            let node = facets.nodes(facet).get(place);
            out.extend(node.filter(|n| !out.contains(n)).copied());
        }
    }

    fn approach(&self, row: usize, pairing: &Pairing, by: &dyn Fn(NodeId) -> Vec3) -> Option<f64> {
        let of = self.weights(pairing).row(row)?;
        Some(-of.gap(by(self.nodes[row]), by) / of.d)
    }

    fn way(
        &self,
        row: usize,
        pairing: &Pairing,
        by: &dyn Fn(NodeId) -> Vec3,
    ) -> Option<(Vec3, Vec3)> {
        let of = self.weights(pairing).row(row)?;
        let way = of.way(by(self.nodes[row]), by) / of.d;
        Some((way, of.normal.normalized()?))
    }

    /// That of the whole facets around the node.
    fn stretch(&self, row: usize, pairing: &Pairing) -> f64 {
        if self.held.is_some() || pairing.weights.guests.is_pointwise(row) {
            return 1.0;
        }
        let (Some(start), Some(around)) = (self.area.get(row), self.around.get(row)) else {
            return 1.0;
        };
        let facets = &pairing.weights.facets;
        let full = |&(facet, place): &(u32, usize)| Some(facets.get(facet as usize)?.full[place]);
        let now: f64 = around.iter().filter_map(full).sum();
        if now > 0.0 && *start > 0.0 {
            now / start
        } else {
            1.0
        }
    }

    fn smooth(
        &self,
        pairing: &Pairing,
        touches: &dyn Fn(usize) -> bool,
        joined: bool,
        on_rows: &mut [OnRow],
    ) {
        self.exchange(self.weights(pairing), touches, joined, on_rows);
    }
}

impl Curved for Mortar {
    fn rises(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        pairing: &Pairing,
        bent: &BentSides,
    ) -> Result<Vec<f64>, SurfaceError> {
        let Some(facets) = &pair.secondary else {
            return Ok(Vec::new());
        };
        let search = search(pair, at);
        let of_facet = |integrator: &mut Integrator, facet: usize| {
            let facet = facet as u32;
            integrator.find(facets, facet, pair, at, &search);
            integrator.integrate(facets, facet, pair, at, integrals::Wanted::Values)?;
            integrator.rises(facets, facet, pair, self.measure, bent)
        };
        let of_facets = (0..self.kind.len())
            .into_par_iter()
            .with_min_len(TASK)
            .map_init(|| Integrator::new(self.measure, self.form.basis), of_facet);
        let of_facets: Vec<_> = of_facets.collect::<Result<_, SurfaceError>>()?;
        let weights = self.weights(pairing);
        let of_row = |row: usize| {
            let d = weights.row(row)?.d;
            let of = weights.guests.of(row, &self.around[row]);
            let sum = of.map(|(facet, place, share)| share * of_facets[facet as usize][place]);
            Some(sum.sum::<f64>() / d)
        };
        let rows = 0..self.nodes.len();
        Ok(rows.map(|row| of_row(row).unwrap_or(0.0)).collect())
    }
}
