/// What damps the motion of closed rows in dynamic steps, of laws without a multiplier.
///
/// # Units
/// Pressure over velocity; force over velocity where the law gives forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Along the normal.
    pub normal: f64,
    /// Across it, with friction and without.
    pub tangential: f64,
    /// Whether the damper may pull more than the law presses; else rows that open are free from then on.
    pub pulls: bool,
}

impl Damping {
    /// Whether it damps anything.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.normal > 0.0 || self.tangential > 0.0
    }
}
