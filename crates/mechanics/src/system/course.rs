use super::StepContext;
use signorini_geometry::mesh::NodeId;

/// Linear between the rows `[time, value]` of a table, constant outside; 0 for a table without rows.
#[must_use]
pub fn interpolate(table: &[[f64; 2]], at: f64) -> f64 {
    let next = table.partition_point(|row| row[0] <= at);
    match (
        next.checked_sub(1).and_then(|k| table.get(k)),
        table.get(next),
    ) {
        (None, Some(first)) => first[1],
        (Some(last), None) => last[1],
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (at - a[0]) / (b[0] - a[0]),
        (None, None) => 0.0,
    }
}

/// A field over the nodes that is known beforehand, such as temperature: given at the start and at the end of every
/// step, linear in time between.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalField {
    /// Values at the start, then at the end of each step; one for each node.
    pub ends: Vec<Vec<f64>>,
}

impl NodalField {
    /// The value at a node at the start of the run.
    #[must_use]
    pub fn at_start(&self, node: NodeId) -> f64 {
        let row = self.ends.first();
        let value = row.and_then(|row| row.get(node as usize));
        value.copied().unwrap_or(0.0)
    }

    /// The value at a node at a time within a step.
    #[must_use]
    pub fn at(&self, step: &StepContext, time: f64, node: NodeId) -> f64 {
        let value = |row: usize| {
            let row = self.ends.get(row).or(self.ends.last());
            row.and_then(|r| r.get(node as usize))
                .copied()
                .unwrap_or(0.0)
        };
        let fraction = ((time - step.start) / step.duration).clamp(0.0, 1.0);
        let (from, to) = (value(step.number), value(step.number + 1));
        from + (to - from) * fraction
    }
}
