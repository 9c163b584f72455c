//! Natural modes of a state.

use std::f64::consts::TAU;

/// A natural mode.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalMode {
    /// ω² (1/time²); below zero where the state is not stable.
    pub eigenvalue: f64,
    /// ‖K φ − ω² M φ‖ over (ω² + |σ|) ‖M φ‖, with the shift σ of the method.
    pub residual: f64,
    /// Whether that is as small as it is to be.
    pub has_converged: bool,
    /// Γ of (E5) of `vibration`, for the three axes.
    pub participation: [f64; 3],
    /// The motion of every node, with φ·M φ = 1.
    pub shape: Vec<[f64; 3]>,
}

impl NaturalMode {
    /// ω (radian per time); below zero where the state is not stable: then small motions grow as exp(|ω| t).
    #[must_use]
    pub fn omega(&self) -> f64 {
        self.eigenvalue.abs().sqrt().copysign(self.eigenvalue)
    }

    /// The frequency (cycles per time), with the sign of ω.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        self.omega() / TAU
    }

    /// m of (E5) of `vibration`, for the three axes.
    #[must_use]
    pub fn effective_mass(&self) -> [f64; 3] {
        self.participation.map(|gamma| gamma * gamma)
    }
}

/// The natural modes at a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibrations {
    /// They, lowest frequency first.
    pub modes: Vec<NaturalMode>,
    /// Whether no mode between the first and the last is missing.
    pub is_counted: bool,
    /// The mass that moves along each axis, that at supports included.
    pub mass: [f64; 3],
    /// The largest entry of `½ (K − Kᵀ)` over that of `K`.
    pub asymmetry: f64,
    /// Vectors that were solved for, and factors that were made.
    pub effort: [usize; 2],
}

impl Vibrations {
    /// Frequencies below this part of the largest are those of rigid motions, within rounding.
    pub const RIGID: f64 = 1e-4;

    /// Whether all modes have converged.
    #[must_use]
    pub fn have_converged(&self) -> bool {
        self.modes.iter().all(|mode| mode.has_converged)
    }

    /// The modes whose frequencies are below zero by more than rounding.
    #[must_use]
    pub fn nunstable(&self) -> usize {
        let size = |mode: &NaturalMode| mode.eigenvalue.abs();
        let largest = self.modes.iter().map(size).fold(0.0, f64::max);
        let least = -Self::RIGID * Self::RIGID * largest;
        let modes = self.modes.iter();
        modes.filter(|mode| mode.eigenvalue < least).count()
    }
}
