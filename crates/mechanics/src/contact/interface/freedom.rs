//! What of a row can move: multipliers act on unknowns alone.
//!
//! A multiplier whose forces act on nothing but what is prescribed, or follows what is, belongs to an equation that no unknown
//! can satisfy: either it holds, or it contradicts what is prescribed. Its row is left out, as is friction along directions
//! in which both sides are prescribed. Forces at prescribed unknowns are then without what such rows would have carried.

use super::{Interface, Participant, Rows, State, TermError};
use crate::contact::row::RowOrder;
use crate::system::{Dof, IdleRows, NO_DOF};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, RigidId};

/// Weights of a row over the largest one below which they are rounding.
const NOTHING: f64 = 1e-9;

impl Interface {
    /// Whether an unknown moves as the solution wants.
    fn is_free(&self, dof: Dof) -> bool {
        dof != NO_DOF && !self.lents.is_prescribed(dof)
    }

    /// Whether a rigid body moves along an axis, as a whole or because it turns.
    fn carries(&self, body: RigidId, axis: usize) -> bool {
        let turns = (0..3).any(|c| self.is_free(self.layout.rotation(body, c)));
        turns || self.is_free(self.layout.translation(body, axis))
    }

    /// Whether a node moves along an axis, by an unknown of its own or with what it follows.
    fn moves(&self, node: NodeId, axis: usize) -> bool {
        let dof = self.layout.node(node, axis);
        if dof == NO_DOF {
            return false;
        }
        if let Some(turn) = self.elimination.leader(dof, &self.layout) {
            return self.carries(turn.carrier, turn.axis);
        }
        let mut moves = false;
        self.elimination.combination(dof, &mut |of, coefficient| {
            moves |= coefficient != 0.0 && self.is_free(of);
        });
        moves
    }

    /// Lets the discretization know of the axes along which nodes of both sides are held, where these may be others. Says
    /// whether that changes weights that stay as they are.
    pub(super) fn support(&mut self) -> Result<bool, TermError> {
        if !self.lents.is_stale() {
            return Ok(false);
        }
        let pair = &self.parts.pair;
        let mut nodes = pair.points.clone();
        for facet in 0..pair.primary.nfacet() as u32 {
            if let Carrier::Nodes(of) = pair.primary.carrier(facet) {
                nodes.extend_from_slice(of);
            }
        }
        let axes = |&node: &NodeId| [0, 1, 2].map(|axis| !self.moves(node, axis));
        let all = nodes.iter().map(|node| (*node, axes(node)));
        let held = all.filter(|(_, axes)| *axes != [false; 3]).collect();
        let parts = &mut self.parts;
        let averaged = parts.discretization.averaged_mut();
        let factors = averaged.map_or(Ok(None), |of| of.support(&parts.pair, held));
        let Some(factors) = factors.map_err(|e| self.failed(&e))? else {
            return Ok(false);
        };
        let areas = self.area_without_supports.iter().zip(factors);
        self.parts.area = areas.map(|(area, factor)| area * factor).collect();
        Ok(true)
    }

    /// Whether a column of a participant, of three or six, moves.
    fn moves_along(&self, participant: Participant, column: usize) -> bool {
        match participant {
            Participant::Node(node) => self.moves(node, column),
            Participant::Rigid(body) if column < 3 => {
                self.is_free(self.layout.translation(body, column))
            }
            Participant::Rigid(body) => self.is_free(self.layout.rotation(body, column - 3)),
        }
    }

    /// The rows that touch in a state and whose multipliers are left out.
    pub(super) fn idle_rows(&self, state: &State) -> Result<IdleRows, TermError> {
        let mut idle = IdleRows::default();
        if self.nmultiplier() == 0 || !self.is_active() || self.parts.bond.is_some() {
            return Ok(idle);
        }
        let discretization = self.parts.discretization.as_ref();
        let axes = 0..self.layout.ndim();
        let mut rows = Rows::default();
        for row in 0..discretization.nrow() {
            let nodes = discretization.point(row).nodes;
            // what is free itself acts on itself
            if nodes
                .iter()
                .all(|&n| axes.clone().all(|axis| self.moves(n, axis)))
            {
                continue;
            }
            self.fill(row, state, RowOrder::Gradient, &mut rows)?;
            let Some(filled) = rows.rows().first() else {
                continue;
            };
            if filled.gap > self.parts.gap_tolerance {
                continue;
            }
            let held = filled.sliding.held;
            let is_idle = self.acts_on_nothing(&rows);
            if is_idle {
                idle.whole += 1;
            } else {
                for (count, held) in idle.friction.iter_mut().zip(held) {
                    *count += usize::from(held);
                }
            }
            if is_idle || held != [false; 3] {
                idle.node = idle.node.or(nodes.first().copied());
            }
        }
        Ok(idle)
    }

    /// Whether the pressure of a filled row acts on nothing that moves.
    pub(super) fn acts_on_nothing(&self, rows: &Rows) -> bool {
        let Some(row) = rows.rows().first() else {
            return false;
        };
        let largest = row.weights.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
        let all = rows.participants().iter();
        let columns = all.flat_map(|&p| (0..p.ncolumn()).map(move |c| (p, c)));
        let mut acting = columns
            .zip(&row.weights)
            .filter(|(_, w)| w.abs() > NOTHING * largest);
        !acting.any(|((participant, column), _)| self.moves_along(participant, column))
    }

    /// Along which directions the point of a row does not move, nor something of the other side. Friction has nothing to
    /// act on there, or, of half a model, only half of it.
    pub(super) fn held_directions(&self, row: usize, rows: &Rows) -> [bool; 3] {
        let discretization = self.parts.discretization.as_ref();
        let point = discretization.point(row).nodes;
        let mut directions = [0, 1, 2].map(|axis| point.iter().all(|&n| !self.moves(n, axis)));
        if directions == [false; 3] {
            return directions;
        }
        let secondary = rows.secondary();
        for (axis, held) in directions.iter_mut().enumerate().filter(|(_, h)| **h) {
            let others = rows.participants().iter().enumerate();
            let others = others.filter(|(place, _)| !secondary.contains(place));
            let mut others = others.map(|(_, p)| *p).peekable();
            // a surface that is fixed in space has nothing that moves
            let is_fixed = others.peek().is_none();
            *held = is_fixed || others.any(|p| !self.moves_along(p, axis));
        }
        directions
    }
}
