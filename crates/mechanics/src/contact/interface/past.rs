//! What the rows of a gasket remember: it has the place of the multiplier that such rows do without.
//!
//! It is frozen in an increment: which branch of the law a row is on depends on what was accepted, and not on the iterate before.

use super::means::mean;
use super::{Interface, Lambda, Rows, State, TermError};
use crate::contact::row::RowOrder;
use crate::system::ContactFrame;

impl Interface {
    /// A row moves on to what its law remembers of this state.
    pub(super) fn remember_gap(
        &self,
        row: usize,
        state: &State,
        lambda: &mut Lambda,
        rows: &mut Rows,
    ) -> Result<(), TermError> {
        let Some(gasket) = self.parts.gasket.as_ref().filter(|_| self.is_active()) else {
            return Ok(());
        };
        self.fill(row, state, RowOrder::Gap, rows)?;
        if let Some(filled) = rows.rows().first() {
            lambda.scalar = gasket.remember(filled.gap, lambda.scalar);
        }
        Ok(())
    }

    /// The closures of laws with a past, at the nodes: means over the rows around each.
    pub(super) fn describe_closures(
        &self,
        state: &State,
        report: &mut ContactFrame,
    ) -> Result<(), TermError> {
        let Some(gasket) = &self.parts.gasket else {
            return Ok(());
        };
        let n = report.nodes.len();
        let (mut now, mut most, mut shares) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut rows = Rows::default();
        for row in 0..self.parts.discretization.nrow() {
            self.fill(row, state, RowOrder::Gap, &mut rows)?;
            let Some(filled) = rows.rows().first() else {
                continue;
            };
            let largest = gasket.remember(filled.gap, self.history.lambda(row).scalar);
            for (k, share) in self.nodes_of(row) {
                now[k] -= share * filled.gap;
                most[k] += share * largest;
                shares[k] += share;
            }
        }
        let means = |sums: Vec<f64>| sums.into_iter().zip(shares.iter().copied()).map(mean);
        report.closure = means(now).collect();
        report.closure_max = means(most).collect();
        Ok(())
    }

    /// The entries of nodes that a row's area belongs to, each with its share of it.
    pub(super) fn nodes_of(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let point = self.parts.discretization.point(row);
        let squares: f64 = point.weights.iter().map(|w| w * w).sum();
        let area = self.area(row);
        let of_node = move |(node, shape): (&u32, &f64)| {
            let k = self.parts.pair.points.binary_search(node).ok()?;
            Some((k, area * shape * shape / squares))
        };
        point.nodes.iter().zip(point.weights).filter_map(of_node)
    }
}
