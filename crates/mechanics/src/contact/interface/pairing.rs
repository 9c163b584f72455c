//! Pairing, sticking rows, and the coupling of unknowns.

use super::{Carrier, Contact, Interface, InterfaceParts, Judged};
use crate::contact::discretization::{Anchored, Averaged, NOWHERE, Pair};
use crate::contact::law::Eval;
use crate::contact::row::RowOrder;
use crate::system::{Dof, Layout, NO_DOF, PatternSink, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Feature, Placement, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// Where nothing is closed, nor was at the start of the increment, a step ends where something does: what touches first may go past the other side by this part of its
/// way, and this part of the reach. Where all that a free body could meet closes at once, most of it opens again, to no end.
const LANDING: f64 = 0.01;
const DEPTH: f64 = 1e-5;
/// By how much that grows with each step that has closed nothing.
const DEEPER: f64 = 4.0;

impl Interface {
    pub(super) fn search(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        self.search_for(at, RowOrder::Gap)
    }

    /// Looks for nearby facets; `next` is the probable next order.
    pub(super) fn search_for(
        &mut self,
        at: &Placement,
        next: RowOrder,
    ) -> Result<(), SurfaceError> {
        if self.parts.bond.is_some() {
            return self.hold(at);
        }
        let pair = &self.parts.pair;
        let discretization = self.parts.discretization.as_ref();
        self.near.update(discretization, pair, at);
        let (near, last) = (&self.near.search, &self.now);
        discretization.pair_up(pair, at, near, last, next, &mut self.next)?;
        self.hold_restless(at)?;
        std::mem::swap(&mut self.now, &mut self.next);
        Ok(())
    }

    /// No point holds a tangent plane any more.
    pub(super) fn let_go(&mut self) {
        for pair in self.now.pairs.iter_mut().flatten() {
            pair.held = None;
        }
    }

    /// Bonds stay where they are, however far they stretch. Those that know normal and tangent hold the plane they meet.
    fn hold(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let surface = self.parts.pair.primary.as_ref();
        let holds = self.parts.bond_tangential.is_some();
        let mut jet = SurfaceJet::default();
        for (pair, anchor) in self.now.pairs.iter_mut().zip(self.history.anchors()) {
            let kept = pair.and_then(|p| p.held);
            let Some(anchor) = anchor.map(|a| a.anchor) else {
                *pair = None;
                continue;
            };
            let held = match (holds, kept) {
                (false, _) => None,
                (true, Some(normal)) => Some(normal),
                (true, None) => {
                    surface.jet(at, &anchor, &mut jet)?;
                    Some(jet.normal)
                }
            };
            *pair = Some(Pair {
                anchor,
                feature: Feature::Face,
                gap: 0.0,
                held,
            });
        }
        Ok(())
    }

    /// Rows that touch, or may, and stick nowhere yet, stick where they are. So do those that compare the sides in another
    /// way than when they came to stick.
    pub(super) fn stick(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let waits = self.parts.remembers_traction;
        let rubs = self.laws().friction.is_some() || self.walks();
        if self.parts.bond.is_some() || !rubs || waits {
            return Ok(());
        }
        let discretization = self.parts.discretization.as_ref();
        let pair = &self.parts.pair;
        let anchors = self.history.anchors_mut();
        for (row, (found, anchor)) in self.now.pairs.iter().zip(anchors).enumerate() {
            let Some(found) = found else { continue };
            let fits = |a: &Anchored| (a.anchor == NOWHERE) == (found.anchor == NOWHERE);
            if !anchor.as_ref().is_some_and(fits) {
                *anchor = Some(discretization.anchor(row, pair, at, found, Vec3::ZERO)?);
            }
        }
        Ok(())
    }

    /// The row of a point, and what to say of it, that was near a facet and has jumped through it, out of reach behind
    /// it: contact would be lost without ever having been noticed.
    pub(super) fn passed_through(&self, at: &Placement) -> Option<(usize, String)> {
        if !self.is_active() {
            return None;
        }
        let surface = self.parts.pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        let averaged = self.parts.discretization.capabilities().averaged;
        let rows = self.accepted.pairs.iter().zip(&self.now.pairs).enumerate();
        for (row, (before, now)) in rows {
            let (Some(before), None) = (before, now) else {
                continue;
            };
            let point = self.near.points.get(row).copied().unwrap_or_default();
            let place = |n: u32| at.x.get(n as usize).copied().unwrap_or_default();
            let approach = averaged.and_then(|of| of.approach(row, &self.accepted, &place));
            let (behind, distance) = if let Some(behind) = approach {
                (behind, behind.abs())
            } else if surface.jet(at, &before.anchor, &mut jet).is_ok() {
                let away = point - jet.position;
                (-away.dot(jet.normal), away.norm())
            } else {
                continue;
            };
            let [_, reach] = self.reach_of(row, before, at);
            if distance > reach && behind > 0.5 * distance {
                return Some((
                    row,
                    format!(
                        "a point went through the surface in one increment, {behind:.3} behind it and further than \
                         the reach of {reach:.3}"
                    ),
                ));
            }
        }
        None
    }

    /// How far from its facet, and behind it, the point of a row counts.
    fn reach_of(&self, row: usize, found: &Pair, at: &Placement) -> [f64; 2] {
        let InterfaceParts {
            pair,
            discretization,
            ..
        } = &self.parts;
        let of = discretization.as_ref();
        let inside = of.capabilities().inside.and_then(|points| points.get(row));
        let facet = found.anchor.facet;
        let reach = pair.reach_of_row(of, row, facet, at);
        let deepest = pair.deepest(of.point(row).nodes, inside, facet, at);
        [reach, reach.min(deepest)]
    }

    /// The largest part of a step in which no point that is near goes through the surface further than half the reach.
    pub(super) fn longest_step(&self, trial: &State, du: &[f64]) -> f64 {
        if self.parts.bond.is_some() || !self.is_active() {
            return 1.0;
        }
        let at = trial.placement();
        let surface = self.parts.pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        let moves = |node: u32| {
            let mut u = Vec3::ZERO;
            for axis in 0..self.layout.ndim() {
                let dof = self.layout.node(node, axis);
                u[axis] = du.get(dof as usize).copied().unwrap_or_default();
            }
            u
        };
        let is_open = |judged: &Judged| judged.state == Contact::Open;
        let mut of_both = self.accepted_judged.iter().chain(&self.judged);
        let lands = self.nmultiplier() > 0 && of_both.all(is_open);
        let discretization = self.parts.discretization.as_ref();
        let averaged = discretization.capabilities().averaged;
        let mut longest = 1.0f64;
        for (row, pair) in self.now.pairs.iter().enumerate() {
            let Some(pair) = pair else { continue };
            let [reach, deepest] = self.reach_of(row, pair, &at);
            let room = if lands {
                let gap = (pair.gap + self.shift(row, trial.time)).max(0.0);
                let depth = DEPTH * DEEPER.powi(i32::from(self.flights));
                (1.0 + LANDING) * gap + depth.min(0.5) * reach
            } else {
                pair.gap.max(0.0) + deepest.min(0.5 * reach)
            };
            if let Some(closes) = averaged.and_then(|of| of.approach(row, &self.now, &moves)) {
                if closes > room {
                    longest = longest.min(room / closes);
                }
                continue;
            }
            if surface.jet(&at, &pair.anchor, &mut jet).is_err() {
                continue;
            }
            let point = discretization.point(row);
            let of_point = point.nodes.iter().zip(point.weights);
            let mut approach: Vec3 = of_point.map(|(&n, w)| moves(n) * *w).sum();
            match surface.carrier(pair.anchor.facet) {
                Carrier::Nodes(nodes) => {
                    for (&n, w) in nodes.iter().zip(jet.shape) {
                        approach -= moves(n) * w;
                    }
                }
                Carrier::Rigid(body) => {
                    let value = |dof: Dof| match dof {
                        NO_DOF => 0.0,
                        dof => du.get(dof as usize).copied().unwrap_or_default(),
                    };
                    for axis in 0..3 {
                        approach[axis] -= value(self.layout.translation(body, axis));
                    }
                }
                Carrier::Fixed => {}
            }
            let closes = -approach.dot(jet.normal);
            if closes > room {
                longest = longest.min(room / closes);
            }
        }
        longest
    }

    /// Couples every row that touches, or may soon, with the facets it meets and that of its anchor; says whether that
    /// adds to what was coupled.
    pub(super) fn couple(&mut self, trial: &State) -> bool {
        let averaged = self.parts.discretization.capabilities().averaged;
        let mut wanted = std::mem::take(&mut self.wanted);
        wanted.clear();
        for row in 0..self.now.pairs.len() {
            if self.is_near(row, trial) {
                self.facets_of(row, averaged, &mut wanted.facets);
            }
            wanted.end_row();
        }
        let surface = self.parts.pair.primary.as_ref();
        let many = averaged.is_some();
        let covers = |coupled: &u32, facet: &u32| {
            coupled == facet || !many && surface.neighbours(*coupled).contains(facet)
        };
        let covered = |row: usize| {
            let coupled = self.coupled.row(row);
            let mut facets = wanted.row(row).iter();
            facets.all(|facet| coupled.iter().any(|c| covers(c, facet)))
        };
        let more = std::mem::take(&mut self.sees_others) || !(0..self.now.pairs.len()).all(covered);
        if more {
            std::mem::swap(&mut self.coupled, &mut wanted);
        }
        self.wanted = wanted;
        more
    }

    /// Whether a row touches, or may soon.
    fn is_near(&self, row: usize, trial: &State) -> bool {
        let Some(pair) = &self.now.pairs[row] else {
            return false;
        };
        if self.parts.fluid.is_some() {
            // a fluid may come to any row
            return true;
        }
        let laws = self.laws();
        let gap = pair.gap + self.shift(row, trial.time);
        let acts = || {
            let lambda = self.lambda(row, trial);
            let most = lambda.scalar.max(lambda.vector.norm());
            laws.law.pressure(gap, most, laws.scale) != Eval::default()
        };
        let soon = || gap < 0.25 * self.reach_of(row, pair, &trial.placement())[0];
        laws.bond || soon() || acts() || self.conducts_at(gap)
    }

    /// The facets that a row meets and that of its anchor, each once.
    pub(super) fn facets_of(
        &self,
        row: usize,
        averaged: Option<&dyn Averaged>,
        out: &mut Vec<u32>,
    ) {
        let first = out.len();
        let anchors = [
            self.now.pairs[row].map(|p| p.anchor),
            self.history.anchors()[row].map(|a| a.anchor),
        ];
        let single = anchors.into_iter().flatten().filter(|a| *a != NOWHERE);
        out.extend(single.map(|a| a.facet));
        if let Some(averaged) = averaged {
            averaged.more_facets(row, &self.now, out);
            if self.laws().slips() {
                averaged.more_facets(row, &self.before, out);
            }
        }
        out[first..].sort_unstable();
        let mut kept = first;
        for k in first..out.len() {
            if k == first || out[k] != out[kept - 1] {
                out[kept] = out[k];
                kept += 1;
            }
        }
        out.truncate(kept);
    }

    pub(super) fn cliques(&self, out: &mut dyn PatternSink) {
        let surface = self.parts.pair.primary.as_ref();
        let discretization = self.parts.discretization.as_ref();
        let averaged = discretization.capabilities().averaged;
        let many = averaged.is_some();
        let is_present = self.phase().is_none_or(|phase| phase.present);
        // without friction a row of one closest point sees one facet at a time
        let at_once = many || self.laws().slips() || self.heat().is_some();
        let (mut dofs, mut of_row, mut facets) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..self.now.pairs.len() {
            let coupled = if is_present {
                self.coupled.row(row)
            } else {
                &[]
            };
            of_row.clear();
            self.multiplier_dofs(row, &mut of_row);
            let borrowers = self.lents.of(row).map_or(&[][..], |lent| &lent.borrowers);
            for &(borrower, _) in borrowers {
                self.multiplier_dofs(borrower, &mut of_row);
            }
            of_row.retain(|&d| d != NO_DOF);
            if coupled.is_empty() {
                if !of_row.is_empty() {
                    out.interface(&of_row);
                }
                continue;
            }
            let point = discretization.point(row);
            let more = averaged.map_or(&[][..], |of| of.more_nodes(row, &self.now));
            for &node in point.nodes.iter().chain(point.all).chain(more) {
                of_row.extend((0..3).map(|c| self.layout.node(node, c)));
            }
            facets.clear();
            facets.extend_from_slice(coupled);
            if !many {
                let around = coupled.iter().flat_map(|&f| surface.neighbours(f));
                facets.extend(around);
            }
            facets.sort_unstable();
            facets.dedup();
            dofs.clear();
            dofs.extend_from_slice(&of_row);
            for &facet in &facets {
                if !at_once {
                    dofs.truncate(of_row.len());
                }
                dofs_of(surface.carrier(facet), &self.layout, &mut dofs);
                if !at_once {
                    out.interface(&dofs);
                }
            }
            if at_once {
                dofs.sort_unstable();
                dofs.dedup();
                out.interface(&dofs);
                self.couple_heat(&dofs, out);
            }
        }
    }
}

/// The unknowns of what moves a facet.
fn dofs_of(carrier: Carrier<'_>, layout: &Layout, out: &mut Vec<Dof>) {
    match carrier {
        Carrier::Nodes(nodes) => {
            let of = |&n: &NodeId| (0..3).map(move |c| layout.node(n, c));
            out.extend(nodes.iter().flat_map(of));
        }
        Carrier::Rigid(body) => {
            out.extend((0..3).map(|c| layout.translation(body, c)));
            out.extend((0..3).map(|c| layout.rotation(body, c)));
        }
        Carrier::Fixed => {}
    }
}
