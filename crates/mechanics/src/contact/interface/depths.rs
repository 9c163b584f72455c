//! Depths that the sides of a contact have lost.

use super::parts::WearParts;

/// What the sides have lost.
#[derive(Debug, Default)]
pub(super) struct Worn {
    /// Depth of each row, where the increment began and at the accepted state: reports of that are of the forces that acted in it.
    pub rows: [Vec<f64>; 2],
    /// The same of the nodes of the primary side, in the order of their areas.
    pub nodes: [Vec<f64>; 2],
    /// Depth opposite each row, at the present iterate.
    pub opposite: Vec<f64>,
    /// Volume of each side, the secondary one first.
    pub volume: [f64; 2],
}

impl Worn {
    pub fn new(parts: Option<&WearParts>, nrow: usize) -> Self {
        let Some(parts) = parts else {
            return Self::default();
        };
        Self {
            rows: [vec![0.0; nrow], vec![0.0; nrow]],
            nodes: [vec![0.0; parts.areas.len()], vec![0.0; parts.areas.len()]],
            opposite: vec![0.0; nrow],
            volume: [0.0; 2],
        }
    }

    /// The present increment begins where the last one ended.
    pub fn begin(&mut self) {
        for [start, accepted] in [&mut self.rows, &mut self.nodes] {
            start.clone_from(accepted);
        }
    }

    /// All depths at the accepted state.
    pub fn depths(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(&self.rows[1]);
        out.extend_from_slice(&self.nodes[1]);
    }

    /// What the law of a row sees more of a gap.
    pub fn depth(&self, row: usize) -> f64 {
        let of = |depths: &[f64]| depths.get(row).copied().unwrap_or_default();
        of(&self.rows[0]) + of(&self.opposite)
    }
}
