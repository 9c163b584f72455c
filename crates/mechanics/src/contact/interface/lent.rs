//! Multipliers of joints whose secondary nodes cannot follow.
//!
//! A row of a joint determines where its node of the secondary side is. Along directions in which a support, a plane of
//! symmetry or an equation determines that already, the row would constrain the primary side alone, which the rows around
//! it constrain, too: the joint locks, or its multipliers have no unique value. Along these directions, the row lends its
//! function to the rows of adjacent nodes that are free, so that a uniform traction still acts on all of the surface.
//!
//! | symbol | name in code | |
//! |---|---|---|
//! | F_j | `free` | projector onto directions along which row j keeps its multiplier |
//! | H_j = I − F_j | | directions along which it lends its function |
//! | S_a = Σ_b F_b | | over the borrowers b adjacent to row a |
//! | R_a | | projector onto the range of S_a |
//! | X_ab | `Lent::borrowers` | the part of row a that borrower b takes over |
//! | μ_a | [`Lents::effective`] | the traction that acts with the function of row a |
//! | r_a | | the weighted way of row a |
//!
//! ```text
//! X_ab = F_b S_a⁺ H_a,  S_a⁺ = (S_a + I − R_a)⁻¹ − (I − R_a)                  (E1)
//! μ_a = F_a λ_a + Σ_b X_abᵀ λ_b                                              (E2)
//! row of λ_j:  F_j r_j + Σ_a X_aj r_a − A_j/ε H_j λ_j = 0                    (E3)
//! ```
//!
//! (E3) is the transpose of (E2), so that the tangent stays symmetric; its last part sets to zero multipliers that act on
//! nothing. With `Σ_b X_ab = H_a` a uniform traction has `μ_a = λ` at every row, and the patch test stays exact. Among all X with that
//! property, (E1) has the smallest sum of squares; between free borrowers it shares evenly.
//!
//! *Rows without borrowers.* Where no adjacent node is free, a row stays, if the larger part of the nodes it meets on the primary
//! side is free and has a node that follows no such row yet: then that node follows it. Otherwise it is lent if it finds a
//! borrower among such rows, or has no effect: both sides are held.
//!
//! Source: Wohlmuth, SIAM J. Numer. Anal. 38, 2000, 989–1012 (multipliers at Dirichlet boundaries and cross points).

use super::Interface;
use super::lents::Lent;
use crate::contact::row::{Participant, RowOrder, Rows};
use crate::system::{NO_DOF, State, TermError};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::collections::HashMap;

/// What counts as zero of a projection, over the largest.
const RANK: f64 = 1e-6;

/// The part of the nodes a row meets that has to be free for the row to stay without borrowers.
const MAJORITY: f64 = 0.5;

/// Columns of a matrix.
fn columns(m: Mat3) -> [Vec3; 3] {
    m.transpose().rows
}

/// The sum of squares of a matrix.
fn squared(m: Mat3) -> f64 {
    m.rows.iter().map(|row| row.norm_squared()).sum()
}

/// The projector onto the range of a matrix whose singular values are zero or of the size of 1.
fn range(m: Mat3) -> Mat3 {
    let mut left = columns(m);
    let mut projector = Mat3::ZERO;
    for _ in 0..3 {
        let longest = left
            .iter()
            .copied()
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let Some(direction) = longest.filter(|v| v.norm() > RANK) else {
            break;
        };
        let Some(unit) = direction.normalized() else {
            break;
        };
        projector = projector + Mat3::outer(unit, unit);
        for column in &mut left {
            *column = *column - unit * unit.dot(*column);
        }
    }
    projector
}

/// S⁺ and R of (E1).
fn pseudo_inverse(s: Mat3) -> (Mat3, Mat3) {
    let onto = range(s);
    let rest = Mat3::IDENTITY - onto;
    let inverse = (s + rest)
        .inverse()
        .map_or(Mat3::ZERO, |(inverse, _)| inverse - rest);
    (inverse, onto)
}

impl Interface {
    /// Settles which rows lend their functions in the step that begins; returns whether that changes the nodes that rows see.
    pub(super) fn lend(&mut self, from: &State) -> Result<bool, TermError> {
        if !std::mem::take(&mut self.lents.stale) {
            return Ok(false);
        }
        let applies = self.parts.bond.is_some() && self.nmultiplier() > 0;
        let of = if applies {
            self.lent(from)?
        } else {
            Vec::new()
        };
        let changes = of != self.lents.of;
        self.lents.of = of;
        Ok(changes)
    }

    /// What becomes of all rows; empty where all keep their multipliers.
    fn lent(&self, from: &State) -> Result<Vec<Option<Lent>>, TermError> {
        let nrow = self.now.pairs.len();
        let mut free: Vec<Option<Mat3>> = (0..nrow).map(|row| self.own_directions(row)).collect();
        let whole = self.directions();
        let lends = |free: &Option<Mat3>| free.filter(|f| squared(whole - *f) > 0.0).is_some();
        let lending: Vec<usize> = (0..nrow).filter(|&row| lends(&free[row])).collect();
        if lending.is_empty() {
            return Ok(Vec::new());
        }
        self.keep_without_borrowers(&lending, &mut free, from)?;
        let mut all = vec![None; nrow];
        for &row in &lending {
            let Some(own) = free[row] else { continue };
            let held = whole - own;
            let mut borrowers = self.adjacent(row);
            borrowers.retain(|&borrower| free[borrower].is_some());
            let s = borrowers.iter().filter_map(|&borrower| free[borrower]);
            let (inverse, _) = pseudo_inverse(s.fold(Mat3::ZERO, |sum, f| sum + f));
            let takes = |borrower: usize| Some((borrower, free[borrower]? * inverse * held));
            let shares = borrowers.into_iter().filter_map(takes);
            all[row] = Some(Lent {
                free: own,
                held,
                borrowers: shares.filter(|(_, x)| squared(*x) > 0.0).collect(),
            });
        }
        Ok(all)
    }

    /// The rows of the nodes around that of a row.
    fn adjacent(&self, row: usize) -> Vec<usize> {
        let mut borrowers = Vec::new();
        let parts = &self.parts;
        if let Some(averaged) = parts.discretization.capabilities().averaged {
            averaged.adjacent(row, &parts.pair, &mut borrowers);
        }
        borrowers
    }

    /// I, in the plane without the direction across it.
    fn directions(&self) -> Mat3 {
        let axes = (0..self.layout.ndim()).map(Vec3::unit);
        axes.fold(Mat3::ZERO, |sum, e| sum + Mat3::outer(e, e))
    }

    /// F of the node of a row that is joined.
    fn own_directions(&self, row: usize) -> Option<Mat3> {
        self.now.pairs.get(row).copied().flatten()?;
        match self.parts.discretization.point(row).nodes {
            &[node] => Some(self.free_directions(node)),
            _ => Some(self.directions()),
        }
    }

    /// The projector onto directions along which a node has unknowns of its own that are not prescribed; ends of directors
    /// have those of the middle and of the half difference.
    fn free_directions(&self, node: NodeId) -> Mat3 {
        match self.elimination.directors().at_end(node) {
            Some(director) => {
                let [middle, half] = [director.middle, director.half].map(|of| self.own_free(of));
                range(middle + half)
            }
            None => self.own_free(node),
        }
    }

    /// The same of a node that ends no director.
    fn own_free(&self, node: NodeId) -> Mat3 {
        let own = [0, 1, 2].map(|axis| self.layout.node(node, axis));
        let moves = own.map(|dof| {
            let mut along = Vec3::ZERO;
            if dof == NO_DOF || self.elimination.leader(dof, &self.layout).is_some() {
                return along;
            }
            self.elimination.combination(dof, &mut |of, coefficient| {
                let is_free = !self.lents.is_prescribed(of);
                if let Some(axis) = own.iter().position(|d| *d == of).filter(|_| is_free) {
                    along[axis] += coefficient;
                }
            });
            along
        });
        range(Mat3::from_rows(moves))
    }

    /// Rows that find no borrower keep the directions in which nodes of the primary side can follow, a node for each row.
    fn keep_without_borrowers(
        &self,
        lending: &[usize],
        free: &mut [Option<Mat3>],
        from: &State,
    ) -> Result<(), TermError> {
        let whole = self.directions();
        let mut without = Vec::new();
        for &row in lending {
            let Some(own) = free[row] else { continue };
            let borrowers = self
                .adjacent(row)
                .into_iter()
                .filter_map(|borrower| free[borrower]);
            let (_, onto) = pseudo_inverse(borrowers.fold(Mat3::ZERO, |sum, f| sum + f));
            let left = range((whole - own) * (whole - onto * whole));
            if squared(left) > 0.0 {
                without.push((row, left));
            }
        }
        let mut rows = Rows::default();
        let mut followed: HashMap<NodeId, Mat3> = HashMap::new();
        for (row, left) in without {
            self.fill(row, from, RowOrder::Gradient, &mut rows)?;
            if let Some(kept) = self.follower(&rows, left, &mut followed)
                && let Some(Some(of)) = free.get_mut(row)
            {
                *of = *of + kept;
            }
        }
        Ok(())
    }

    /// The directions of these that a node of the primary side follows from now on, `followed` by no other row.
    fn follower(
        &self,
        rows: &Rows,
        left: Mat3,
        followed: &mut HashMap<NodeId, Mat3>,
    ) -> Option<Mat3> {
        let operator = &rows.rows().first()?.sliding.operator;
        let secondary = rows.secondary();
        let [mut all, mut moves] = [0.0; 2];
        let mut best: Option<(f64, NodeId, Mat3)> = None;
        let mut column = 0;
        for (place, participant) in rows.participants().iter().enumerate() {
            let at = column;
            column += participant.ncolumn();
            if secondary.contains(&place) {
                continue;
            }
            let weight = operator.get(at).map_or(0.0, |b| b.norm());
            all += weight;
            let Participant::Node(node) = *participant else {
                continue;
            };
            let can = self.free_directions(node);
            moves += weight * squared(can * left) / squared(left);
            let still = followed.get(&node).copied().unwrap_or(can);
            let follows = range(left * still * left);
            if squared(follows) > 0.0 && best.is_none_or(|(most, ..)| weight > most) {
                best = Some((weight, node, follows));
            }
        }
        let (_, node, follows) = best.filter(|_| moves > MAJORITY * all)?;
        let still = followed
            .entry(node)
            .or_insert_with(|| self.free_directions(node));
        *still = range(*still - *still * follows);
        Some(follows)
    }

    /// Spreads the columns of the multiplier of a row that the scratch holds over those of its borrowers: (E3). `lambda` is
    /// its own.
    pub(super) fn spread(
        &self,
        row: usize,
        lent: &Lent,
        lambda: Vec3,
        scratch: &mut super::Scratch,
    ) {
        const N: usize = 3;
        let own = scratch.rows.ncolumn();
        let (from, to) = (own + N, own + N * (1 + lent.borrowers.len()));
        let parts = || std::iter::once(lent.free).chain(lent.borrowers.iter().map(|(_, x)| *x));
        let super::Scratch {
            force,
            stiffness,
            spread,
            ..
        } = scratch;
        let way = |values: &[f64]| match values {
            &[x, y, z, ..] => Vec3::new(x, y, z),
            _ => Vec3::ZERO,
        };
        let rest = -self.measure(row) / self.parts.scale.penalty;
        let r = way(&force[own..]);
        force.truncate(own);
        for x in parts() {
            force.extend((x * r).to_array());
        }
        let resists = (lent.held * lambda * rest).to_array();
        for (f, resists) in force[own..].iter_mut().zip(resists) {
            *f += resists;
        }
        if stiffness.is_empty() {
            return;
        }
        spread.clear();
        spread.resize(to * to, 0.0);
        for i in 0..own {
            let line = &stiffness[i * from..(i + 1) * from];
            spread[i * to..i * to + own].copy_from_slice(&line[..own]);
            let b = way(&line[own..]);
            for (block, x) in parts().enumerate() {
                let forces = x * b;
                for c in 0..N {
                    spread[i * to + own + N * block + c] = forces[c];
                }
            }
        }
        for j in 0..own {
            let moved = Vec3::new(
                stiffness[own * from + j],
                stiffness[(own + 1) * from + j],
                stiffness[(own + 2) * from + j],
            );
            for (block, x) in parts().enumerate() {
                let ways = x * moved;
                for c in 0..N {
                    spread[(own + N * block + c) * to + j] = ways[c];
                }
            }
        }
        for (i, held) in lent.held.rows.iter().enumerate() {
            for j in 0..N {
                spread[(own + i) * to + own + j] += rest * held[j];
            }
        }
        std::mem::swap(stiffness, spread);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projector(v: Vec3) -> Mat3 {
        let v = v.normalized().unwrap();
        Mat3::outer(v, v)
    }

    #[test]
    fn borrowers_take_over_all_that_is_lent_wherever_together_they_are_free() {
        let skew = [
            Vec3::new(1.0, 0.2, 0.0),
            Vec3::new(0.3, -1.0, 0.1),
            Vec3::new(0.0, 0.4, 1.0),
        ];
        let borrowers = [
            Mat3::IDENTITY,
            projector(skew[0]),
            Mat3::IDENTITY - projector(skew[1]),
        ];
        for held in [
            projector(skew[2]),
            Mat3::IDENTITY - projector(skew[0]),
            Mat3::IDENTITY,
        ] {
            let s = borrowers.iter().fold(Mat3::ZERO, |sum, f| sum + *f);
            let (inverse, _) = pseudo_inverse(s);
            let taken = borrowers.iter().map(|f| *f * inverse * held * 1.0);
            let sum = taken
                .zip(&borrowers)
                .fold(Mat3::ZERO, |sum, (x, f)| sum + *f * x);
            assert!(squared(sum - held) < 1e-28);
        }
    }

    #[test]
    fn two_borrowers_on_planes_that_meet_at_an_angle_take_over_the_whole_plane() {
        // each is free along its own plane of symmetry only
        let borrowers = [
            projector(Vec3::unit(0)),
            projector(Vec3::new(0.5, 0.8, 0.0)),
        ];
        let held = projector(Vec3::unit(0)) + projector(Vec3::unit(1));
        let (inverse, onto) = pseudo_inverse(borrowers[0] + borrowers[1]);
        assert!(squared(onto - held) < 1e-28);
        let sum = borrowers[0] * inverse * held + borrowers[1] * inverse * held;
        assert!(squared(sum - held) < 1e-28);
    }

    #[test]
    fn what_no_borrower_is_free_along_is_left() {
        let (inverse, onto) = pseudo_inverse(Mat3::outer(Vec3::unit(0), Vec3::unit(0)) * 3.0);
        assert_eq!(squared(onto - projector(Vec3::unit(0))), 0.0);
        let third = projector(Vec3::unit(0)) * (1.0 / 3.0);
        assert!(squared(inverse - third) < 1e-30);
    }
}
