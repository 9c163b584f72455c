use super::StepContext;
use signorini_geometry::mesh::NodeId;
use std::fmt;
use std::sync::Arc;

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

/// A function of time that a program gives. It is known beforehand: at a time it has one value, whenever it is asked, so that
/// a resumed run finds the same bits.
///
/// # Example
/// ```
/// use signorini_mechanics::system::TimeFunction;
///
/// let wave = TimeFunction::new(|time| (3.0 * time).sin());
/// assert_eq!(wave.times(2.0).at(0.5), 2.0 * 1.5f64.sin());
/// ```
#[derive(Clone)]
pub struct TimeFunction(Arc<dyn Fn(f64) -> f64 + Send + Sync>);

impl TimeFunction {
    /// This function.
    #[must_use]
    pub fn new(function: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(function))
    }

    /// Its value at a time.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        (self.0)(time)
    }

    /// This many times the function.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let function = Arc::clone(&self.0);
        Self::new(move |time| function(time) * factor)
    }
}

impl From<Arc<dyn Fn(f64) -> f64 + Send + Sync>> for TimeFunction {
    fn from(function: Arc<dyn Fn(f64) -> f64 + Send + Sync>) -> Self {
        Self(function)
    }
}

impl fmt::Debug for TimeFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TimeFunction").finish_non_exhaustive()
    }
}

/// Whether they are one function; two that are written alike differ.
impl PartialEq for TimeFunction {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
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

    /// The value at a node when a step begins.
    #[must_use]
    pub fn at_begin(&self, step: usize, node: NodeId) -> f64 {
        let row = self.ends.get(step).or(self.ends.last());
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
