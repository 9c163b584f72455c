//! What an audit is to know of a contact.

use super::means::mean;
use super::{Interface, Measure, Multiplier, Rows, State};
use crate::audit::{self, Rules, Sides};
use crate::contact::friction::Sliding;
use crate::system::{ContactAudit, ContactFrame, Frame, NodeId};
use signorini_geometry::surface::Placement;
use signorini_geometry::tensor::Vec3;

/// Halvings of an interval in which a law is inverted.
const HALVINGS: usize = 60;

/// The laws of a contact, node by node.
struct Obeyed<'a> {
    of: &'a Interface,
    at: Placement<'a>,
    frame: &'a ContactFrame,
    /// The shifts of gaps; empty where there are none.
    shifts: Vec<f64>,
    /// How far gaps have gone in the increment; empty where pressures are those of its end.
    ways: Vec<f64>,
    /// The nodes opposite; empty where there are facets.
    partners: Vec<Option<NodeId>>,
}

impl Interface {
    /// Audits the contact, where it acts and is not the second pass of another.
    pub(super) fn audited(&self, state: &State, frame: &Frame) -> Option<ContactAudit> {
        if !self.is_active() || self.parts.swapped {
            return None;
        }
        let of = frame.contacts.iter().find(|c| c.name == self.parts.name)?;
        let held = self.holds_start();
        let nodes = state.x.iter().zip(&frame.displacement);
        let x: Vec<Vec3> = nodes.map(|(x, u)| *x - *u).collect();
        let poses = self.elimination.initial_poses();
        let start = Placement {
            x: &x,
            poses: &poses,
        };
        let sides = Sides {
            secondary: self.parts.pair.secondary.as_ref(),
            primary: self.parts.pair.primary.as_ref(),
            now: state.placement(),
            start: held.then_some(start),
            reference: &x,
            same: self.parts.pair.same,
        };
        let rules = Obeyed {
            of: self,
            at: state.placement(),
            frame: of,
            shifts: self.shifts_at_nodes(state),
            ways: self.ways_at_nodes(state),
            partners: self.partners(),
        };
        Some(audit::contact(of, frame, &sides, &rules))
    }

    /// Whether the geometry at the start holds for good.
    fn holds_start(&self) -> bool {
        let discretization = self.parts.discretization.as_ref();
        let mut pairs = self.now.pairs.iter().flatten();
        let of = discretization.capabilities();
        let keeps = !of.renews() && pairs.any(|pair| pair.held.is_some());
        of.keeps_weights() || keeps
    }

    /// The node opposite each node of the secondary side, where nodes meet nodes.
    fn partners(&self) -> Vec<Option<NodeId>> {
        let parts = &self.parts;
        if parts.pair.primary.nfacet() > 0 {
            return Vec::new();
        }
        let mut partners = vec![None; parts.pair.points.len()];
        for row in 0..parts.discretization.nrow() {
            if let &[secondary, primary, ..] = parts.discretization.point(row).all
                && let Ok(k) = parts.pair.points.binary_search(&secondary)
            {
                partners[k] = Some(primary);
            }
        }
        partners
    }

    /// The longest way of the dynamic gaps around each node of the secondary side in the increment; where impulses act on what
    /// closes in the next short increment, how far anything goes in one.
    fn ways_at_nodes(&self, state: &State) -> Vec<f64> {
        let is_explicit = self.step.is_explicit();
        if let Some(rates) = state
            .rates
            .as_ref()
            .filter(|_| is_explicit && self.has_unknown_multipliers())
        {
            let speeds = rates.velocity.iter().map(|v| v.norm());
            let fastest = speeds.fold(0.0, f64::max);
            return vec![fastest * self.duration; self.parts.pair.points.len()];
        }
        if self.gaps.start.is_empty() {
            return Vec::new();
        }
        let points = &self.parts.pair.points;
        let mut ways = vec![0.0_f64; points.len()];
        for row in 0..self.parts.discretization.nrow() {
            let ends = self.gap_at_start(row).zip(self.gap_kept(row));
            let Some(([from, _], to)) = ends else {
                continue;
            };
            for node in self.parts.discretization.point(row).nodes {
                let place = points.binary_search(node).ok();
                if let Some(way) = place.and_then(|k| ways.get_mut(k)) {
                    *way = way.max((to - from).abs());
                }
            }
        }
        ways
    }

    /// The shift of the gaps around each node of the secondary side, with what is worn off: the mean over its rows.
    fn shifts_at_nodes(&self, state: &State) -> Vec<f64> {
        let parts = &self.parts;
        if parts.shifts.is_empty() && self.allowed.overlaps.is_empty() && parts.wear.is_none() {
            return Vec::new();
        }
        let mut rows = Rows::default();
        let points = &self.parts.pair.points;
        let mut sums = vec![(0.0, 0.0); points.len()];
        for row in 0..self.parts.discretization.nrow() {
            let shift = self.shift(row, state.time) + self.wears_off(row, state, &mut rows);
            let point = self.parts.discretization.point(row);
            for (node, weight) in point.nodes.iter().zip(point.weights) {
                let place = points.binary_search(node).ok();
                if let Some((sum, weights)) = place.and_then(|k| sums.get_mut(k)) {
                    let weight = weight * weight;
                    *sum += weight * shift;
                    *weights += weight;
                }
            }
        }
        sums.into_iter().map(mean).collect()
    }
}

impl Obeyed<'_> {
    /// What the laws are asked with a traction: itself, or the force of a node.
    fn measure(&self, node: usize) -> f64 {
        match self.of.parts.measure {
            Measure::Area => 1.0,
            Measure::Node => self.frame.area.get(node).copied().unwrap_or(1.0),
        }
    }
}

impl Rules for Obeyed<'_> {
    fn joined(&self) -> bool {
        self.of.parts.bond.is_some()
    }

    fn shift(&self, node: usize) -> f64 {
        self.shifts.get(node).copied().unwrap_or_default()
    }

    fn moved(&self, node: usize) -> f64 {
        self.ways.get(node).copied().unwrap_or_default()
    }

    /// By halving: pressures fall with the gap. What a law with a past has been closed by, it may be closed by.
    fn gap(&self, node: usize, pressure: f64) -> f64 {
        let parts = &self.of.parts;
        if parts.gasket.is_some() {
            return -self
                .frame
                .closure_max
                .get(node)
                .copied()
                .unwrap_or_default();
        }
        let (law, scale) = (parts.law.as_ref(), &parts.scale);
        if law.multiplier() != Multiplier::None {
            return 0.0;
        }
        let wanted = pressure * self.measure(node);
        let stiffer = |gap: f64| law.pressure(gap, 0.0, scale).value >= wanted;
        let (mut near, mut far) = (-scale.length, scale.length);
        for _ in 0..HALVINGS {
            if stiffer(near) {
                break;
            }
            near *= 2.0;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if stiffer(middle) {
                near = middle;
            } else {
                far = middle;
            }
        }
        near
    }

    fn limit(&self, node: usize, pressure: f64) -> Option<f64> {
        let friction = self.of.phase().and_then(|p| p.friction.as_ref());
        let path = self.frame.slip.get(node).map_or(0.0, |s: &Vec3| s.norm());
        friction.map(|(law, _)| {
            let measure = self.measure(node);
            let at = Sliding {
                pressure: pressure * measure,
                path,
            };
            law.limit(&at).value / measure
        })
    }

    fn partner(&self, node: usize) -> Option<NodeId> {
        self.partners.get(node).copied().flatten()
    }

    fn deepest(&self, node: NodeId, primary: u32) -> f64 {
        let pair = &self.of.parts.pair;
        pair.deepest_from(&[node], None, primary, &self.at)
    }

    fn deepest_back(&self, node: NodeId, secondary: u32) -> f64 {
        let pair = &self.of.parts.pair;
        pair.deepest_back(node, secondary, &self.at)
    }

    fn is_rigid(&self, node: NodeId) -> bool {
        self.of.elimination.body_of(node).is_some()
    }
}
