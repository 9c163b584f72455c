//! Which cells take part in which step.

use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use std::collections::{BTreeMap, BTreeSet};

/// What becomes of a cell when a step begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellChange {
    /// It takes no part from now on.
    Removed {
        /// Whether the forces that it exerts fall to zero over the step; else they are gone at once.
        ramp: bool,
    },
    /// It takes part again.
    Added {
        /// Whether it is free of strain where it is now, of virgin material; else strain and history go on.
        strain_free: bool,
    },
}

/// Which cells take part in which step. It is known beforehand: a function of the step alone, so that a resumed run finds
/// the same.
///
/// # Example
/// ```
/// use signorini_geometry::mesh::CellId;
/// use signorini_mechanics::system::{Activity, CellChange};
///
/// let cell = CellId { block: 0, index: 7 };
/// let removed = CellChange::Removed { ramp: true };
/// let added = CellChange::Added { strain_free: true };
/// let activity = Activity::new(4, vec![(cell, 1, removed), (cell, 3, added)]);
/// let active = [0, 1, 2, 3].map(|step| activity.is_active(cell, step));
/// assert_eq!(active, [true, false, false, true]);
/// assert_eq!(activity.change(cell, 3), Some(added));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Activity {
    nstep: usize,
    /// The changes of each cell that ever changes, in the order of steps.
    changes: BTreeMap<CellId, Vec<(usize, CellChange)>>,
    /// Steps in which some cell changes.
    steps: BTreeSet<usize>,
    /// Nodes of which no cell takes part, step by step, sorted.
    idle: Vec<Vec<NodeId>>,
}

impl Activity {
    /// Of so many steps, with the changes of cells at the beginning of steps; of two in one step the last counts.
    #[must_use]
    pub fn new(
        nstep: usize,
        changes: impl IntoIterator<Item = (CellId, usize, CellChange)>,
    ) -> Self {
        let mut activity = Self {
            nstep,
            ..Self::default()
        };
        for (cell, step, change) in changes {
            activity.steps.insert(step);
            let of_cell = activity.changes.entry(cell).or_default();
            of_cell.retain(|(at, _)| *at != step);
            of_cell.push((step, change));
            of_cell.sort_by_key(|(at, _)| *at);
        }
        activity
    }

    /// The same with the nodes of which none of these cells takes part.
    #[must_use]
    pub fn with_nodes(mut self, mesh: &Mesh, cells: &[CellId]) -> Self {
        let of_changing = self.changes.keys().flat_map(|&cell| mesh.cell(cell));
        let changing: BTreeSet<NodeId> = of_changing.copied().collect();
        let mut around: BTreeMap<NodeId, Vec<CellId>> = BTreeMap::new();
        for &cell in cells {
            for node in mesh.cell(cell).iter().filter(|n| changing.contains(n)) {
                around.entry(*node).or_default().push(cell);
            }
        }
        self.idle = (0..self.nstep)
            .map(|step| {
                let none = |cells: &[CellId]| !cells.iter().any(|&c| self.is_active(c, step));
                let idle = around.iter().filter(|(_, cells)| none(cells));
                idle.map(|(&node, _)| node).collect()
            })
            .collect();
        self
    }

    /// Whether all cells take part in all steps.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }

    /// The number of steps.
    #[must_use]
    pub const fn nstep(&self) -> usize {
        self.nstep
    }

    /// Whether a cell ever changes.
    #[must_use]
    pub fn names(&self, cell: CellId) -> bool {
        self.changes.contains_key(&cell)
    }

    /// What becomes of a cell when a step begins.
    #[must_use]
    pub fn change(&self, cell: CellId, step: usize) -> Option<CellChange> {
        let of_cell = self.changes.get(&cell)?;
        let at = of_cell.binary_search_by_key(&step, |(at, _)| *at).ok()?;
        of_cell.get(at).map(|(_, change)| *change)
    }

    /// Whether a cell is added when a step begins.
    #[must_use]
    pub fn adds(&self, cell: CellId, step: usize) -> bool {
        matches!(self.change(cell, step), Some(CellChange::Added { .. }))
    }

    /// Whether a cell takes part in a step.
    #[must_use]
    pub fn is_active(&self, cell: CellId, step: usize) -> bool {
        let Some(of_cell) = self.changes.get(&cell) else {
            return true;
        };
        let before = of_cell.partition_point(|(at, _)| *at <= step);
        let last = before.checked_sub(1).and_then(|k| of_cell.get(k));
        !matches!(last, Some((_, CellChange::Removed { .. })))
    }

    /// In which steps a cell takes part.
    #[must_use]
    pub fn course(&self, cell: CellId) -> Vec<bool> {
        (0..self.nstep)
            .map(|step| self.is_active(cell, step))
            .collect()
    }

    /// Whether some cell changes when a step begins.
    #[must_use]
    pub fn changes_at(&self, step: usize) -> bool {
        self.steps.contains(&step)
    }

    /// The number of steps up to this one at whose beginning cells change. Steps of equal numbers have the same cells.
    #[must_use]
    pub fn epoch(&self, step: usize) -> usize {
        self.steps.range(..=step).count()
    }

    /// Whether a node has cells, of which none takes part in a step.
    #[must_use]
    pub fn is_idle(&self, node: NodeId, step: usize) -> bool {
        let idle = self.idle.get(step).or(self.idle.last());
        idle.is_some_and(|idle| idle.binary_search(&node).is_ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::by_name;
    use signorini_geometry::tensor::Vec3;

    const REMOVED: CellChange = CellChange::Removed { ramp: true };
    const ADDED: CellChange = CellChange::Added { strain_free: false };

    #[test]
    fn nodes_are_idle_while_none_of_their_cells_takes_part() {
        let mut mesh = Mesh::default();
        for k in 0..4 {
            mesh.points.push(Vec3::new(f64::from(k), 0.0, 0.0));
            mesh.node_labels.push(k as u64 + 1);
        }
        let line = by_name("line2").unwrap();
        let cells: Vec<CellId> = [[0, 1], [1, 2], [2, 3]]
            .iter()
            .zip(1..)
            .map(|(nodes, label)| mesh.push_cell(line, nodes, label))
            .collect();
        let changes = [
            (cells[2], 1, REMOVED),
            (cells[1], 2, REMOVED),
            (cells[1], 3, ADDED),
        ];
        let activity = Activity::new(4, changes).with_nodes(&mesh, &cells);
        let idle = |step| -> Vec<u32> { (0..4).filter(|&n| activity.is_idle(n, step)).collect() };
        assert_eq!(
            [0, 1, 2, 3].map(idle),
            [vec![], vec![3], vec![2, 3], vec![3]]
        );
        assert_eq!(activity.course(cells[1]), [true, true, false, true]);
        assert_eq!([0, 1, 2, 3].map(|s| activity.epoch(s)), [0, 1, 2, 3]);
        assert!(!activity.changes_at(0) && activity.changes_at(2));
    }
}
