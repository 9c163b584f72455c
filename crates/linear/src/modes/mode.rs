//! Modes, and which of them are wanted.

/// Which modes are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// How many, at most.
    pub count: usize,
    /// The eigenvalue above which they begin; none: with the lowest.
    pub from: Option<f64>,
}

/// A mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// λ.
    pub eigenvalue: f64,
    /// φ, one entry per equation, with φᵀ M φ = 1.
    pub shape: Vec<f64>,
    /// ‖K φ − λ M φ‖ over (|λ| + |σ|) ‖M φ‖, in Euclid's norm.
    pub residual: f64,
    /// What rounding leaves of the residual, at most: as far as it is larger than [`Modes::TOLERANCE`], a residual may be so, too.
    pub rounding: f64,
}

impl Mode {
    /// Whether the residual is as small as it is to be.
    #[must_use]
    pub fn has_converged(&self) -> bool {
        self.residual <= Modes::TOLERANCE.max(self.rounding)
    }
}

/// The modes that were found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modes {
    /// They, lowest eigenvalue first.
    pub modes: Vec<Mode>,
    /// The shift with which they were found.
    pub shift: f64,
    /// Whether a factor has counted them, so that none between the first and the last is missing. Where there is none that can,
    /// new directions were searched without finding another.
    pub is_counted: bool,
    /// How many vectors were solved for.
    pub solves: usize,
    /// How many factors were made.
    pub factors: usize,
}

impl Modes {
    /// The residual of a mode that has converged, or what rounding leaves.
    pub const TOLERANCE: f64 = 1e-7;
}
