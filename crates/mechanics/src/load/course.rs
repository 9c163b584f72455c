/// How a load goes over its step, as a factor of its full size.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Course {
    /// Linearly, from what it was before the step.
    #[default]
    Ramp,
    /// Rows of time of the step and factor, linear between, constant outside.
    Table(Vec<[f64; 2]>),
    /// Rows of total time and factor; it goes on through later steps.
    TotalTable(Vec<[f64; 2]>),
}
