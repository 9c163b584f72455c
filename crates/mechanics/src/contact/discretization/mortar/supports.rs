//! Nodes that are held on both sides.
//!
//! Where a node of the secondary side is held along the normal, its row determines nothing but the motion of the primary
//! side. Where that is held there, too, as at the common end of two beams, all that is left of the row are small weights of
//! both signs, since the dual function has no mean over the motion of the facet. They make a gap that is open everywhere
//! negative, and only a pressure hundreds of times the load closes it, most of which goes from support to support. Such a
//! row hands its function over to adjacent rows, as those of joints do; a uniform pressure still acts everywhere.
//!
//! Source: Wohlmuth, *SIAM J. Numer. Anal.* 38 (2000) 989–1012 (multipliers at Dirichlet boundaries).

use super::{Guests, HeldAxes, Mortar, NodeId, SurfacePair, WEAK};
use crate::contact::mortar::Weights;
use signorini_geometry::surface::{Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;

/// The square of the part of a normal along which a node may move and still be held.
const SLANTED: f64 = 0.01;
/// The part of a row's weights on the primary side, by their sizes, that is held where it is held.
const HELD: f64 = 0.1;

impl Mortar {
    /// Takes note of the axes along which nodes are held. Where weights for good are others because of that: the areas of rows
    /// over those without supports.
    pub(super) fn take_supports(
        &mut self,
        pair: &SurfacePair,
        supports: HeldAxes,
    ) -> Result<Option<Vec<f64>>, SurfaceError> {
        if self.form.joined || supports == self.supports {
            return Ok(None);
        }
        self.supports = supports;
        let (Some(mut held), Some(facets)) = (self.held.take(), &pair.secondary) else {
            return Ok(None);
        };
        let mut guests = held.guests.clone();
        let parts = self.covered_parts(&held.weights);
        self.free_supports(facets, &held.weights, &parts, &mut guests);
        let mut factors = None;
        if guests != held.weights.guests {
            held.weights.guests = guests;
            let at = Placement {
                x: &held.x,
                poses: &[],
            };
            self.add_up_all(facets, &at, &mut held.weights)?;
            if held.weights.facets.iter().any(|of| !of.vectors.is_empty()) {
                self.along_normals(facets, &mut held.weights);
            }
            self.area.clone_from(&held.area);
            self.cover(&held.weights);
            let areas = self.area.iter().zip(&held.area);
            let over = |(now, whole): (&f64, &f64)| if *whole > 0.0 { now / whole } else { 1.0 };
            factors = Some(areas.map(over).collect());
        }
        self.held = Some(held);
        Ok(factors)
    }

    /// Lets rows of nodes that are held on both sides, or that other contacts have, hand over their functions to rows of which
    /// enough is covered.
    pub(super) fn free_supports(
        &self,
        facets: &Facets,
        weights: &Weights,
        parts: &[f64],
        found: &mut Guests,
    ) {
        if self.supports.is_empty() && self.yields.is_empty() {
            return;
        }
        let yields = |row: usize| {
            self.yields.contains(&self.nodes[row])
                || (!self.supports.is_empty() && self.is_held(row, weights))
        };
        let is_held: Vec<bool> = (0..self.nodes.len())
            .map(|row| !found.left[row] && !found.is_pointwise(row) && yields(row))
            .collect();
        for row in (0..self.nodes.len()).filter(|&row| is_held[row]) {
            self.hand_over(
                row,
                facets,
                weights,
                |r| !is_held[r] && parts[r] >= WEAK,
                found,
            );
        }
    }

    /// Whether a node is held along a unit normal.
    fn holds(&self, node: NodeId, normal: Vec3) -> bool {
        self.supports.get(&node).is_some_and(|axes| {
            let free = (0..3).filter(|&axis| !axes[axis]);
            free.map(|axis| normal[axis] * normal[axis]).sum::<f64>() < SLANTED
        })
    }

    /// Whether the node of a row is held along its normal, and so is what it meets.
    fn is_held(&self, row: usize, weights: &Weights) -> bool {
        let around = || {
            let of =
                |&(facet, place): &(u32, usize)| Some((weights.facets.get(facet as usize)?, place));
            self.around[row].iter().filter_map(of)
        };
        let normal = around()
            .map(|(of, place)| of.normal * of.d[place])
            .sum::<Vec3>();
        let Some(normal) = normal.normalized() else {
            return false;
        };
        if !self.holds(self.nodes[row], normal) {
            return false;
        }
        let (mut held, mut all) = (0.0, 0.0);
        for (of, place) in around() {
            let m = of.m.iter().skip(place * of.nodes.len());
            for (&node, m) in of.nodes.iter().zip(m) {
                all += m.abs();
                if self.holds(node, normal) {
                    held += m.abs();
                }
            }
        }
        all > 0.0 && held > HELD * all
    }
}
