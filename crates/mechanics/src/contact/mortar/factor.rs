//! The factor of an integral over a plane or a revolution.

use std::f64::consts::TAU;

/// By what areas are multiplied, at a place along the line.
#[derive(Clone, Copy, Debug)]
pub(super) enum Factor {
    /// 1.
    One,
    /// (E5), from places and radii of the ends.
    Circumference([(f64, f64); 2]),
}

impl Factor {
    /// Its degree as a polynomial of the place.
    pub(super) fn degree(self) -> usize {
        match self {
            Self::One => 0,
            Self::Circumference(_) => 1,
        }
    }

    pub(super) fn at(self, p: f64) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Circumference([(a, ra), (b, rb)]) => {
                TAU * ((b - p) * ra + (p - a) * rb) / (b - a)
            }
        }
    }

    /// Its derivatives by the place, and by places and radii of the ends.
    pub(super) fn slopes(self, p: f64) -> Option<[f64; 5]> {
        let Self::Circumference([(a, ra), (b, rb)]) = self else {
            return None;
        };
        let (slope, share) = (TAU * (rb - ra) / (b - a), (p - a) / (b - a));
        let of_ends = [-slope * (1.0 - share), -slope * share];
        let of_radii = [TAU * (1.0 - share), TAU * share];
        Some([slope, of_ends[0], of_ends[1], of_radii[0], of_radii[1]])
    }
}

/// As many zeros.
pub(super) fn zeros(v: &mut Vec<f64>, n: usize) {
    v.clear();
    v.resize(n, 0.0);
}
