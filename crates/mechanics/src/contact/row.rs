//! The rows of one group: constraints that act on the same participants.

use crate::system::{Dof, Layout};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;

/// Who takes part in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Participant {
    /// A node: three columns.
    Node(NodeId),
    /// A rigid body: three columns of translation, three of rotation.
    Rigid(RigidId),
}

impl Participant {
    /// The number of its columns.
    #[must_use]
    pub const fn ncolumn(self) -> usize {
        match self {
            Self::Node(_) => 3,
            Self::Rigid(_) => 6,
        }
    }
}

/// Rows with common participants. Streamed: the same buffers serve one group after the other.
#[derive(Debug, Default)]
pub struct Rows {
    participants: Vec<Participant>,
    ncolumn: usize,
    rows: Vec<Row>,
    nrow: usize,
}

/// One constraint.
#[derive(Debug, Default)]
pub struct Row {
    /// Number of the row: the key of history and multipliers.
    pub number: usize,
    /// Gap, negative in penetration.
    pub gap: f64,
    /// Unit normal out of the primary side.
    pub normal: Vec3,
    /// Derivative of the gap. One entry for each column.
    pub gradient: Vec<f64>,
    /// Weights with which a pressure acts on the columns.
    pub weights: Vec<f64>,
    /// Derivative of the weights, row-major, columns × columns; valid where the tangent was asked for.
    pub dweights: Vec<f64>,
}

impl Rows {
    /// Starts a group with these participants.
    pub fn start(&mut self, participants: impl IntoIterator<Item = Participant>) {
        self.participants.clear();
        self.participants.extend(participants);
        self.ncolumn = self.participants.iter().map(|p| p.ncolumn()).sum();
        self.nrow = 0;
    }

    /// Who takes part, in the order of the columns.
    #[must_use]
    pub fn participants(&self) -> &[Participant] {
        &self.participants
    }

    /// The number of columns.
    #[must_use]
    pub const fn ncolumn(&self) -> usize {
        self.ncolumn
    }

    /// A further row, zeroed; with room for `dweights` where `tangent`.
    pub fn push(&mut self, number: usize, tangent: bool) -> &mut Row {
        let n = self.ncolumn;
        if self.nrow == self.rows.len() {
            self.rows.push(Row::default());
        }
        let row = &mut self.rows[self.nrow];
        self.nrow += 1;
        row.number = number;
        row.gap = 0.0;
        row.normal = Vec3::ZERO;
        for (values, length) in [
            (&mut row.gradient, n),
            (&mut row.weights, n),
            (&mut row.dweights, if tangent { n * n } else { 0 }),
        ] {
            values.clear();
            values.resize(length, 0.0);
        }
        row
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows[..self.nrow]
    }

    /// The unknown behind each column.
    pub fn dofs(&self, layout: &Layout, out: &mut Vec<Dof>) {
        out.clear();
        for participant in &self.participants {
            match *participant {
                Participant::Node(node) => out.extend((0..3).map(|c| layout.node(node, c))),
                Participant::Rigid(body) => {
                    out.extend((0..3).map(|c| layout.translation(body, c)));
                    out.extend((0..3).map(|c| layout.rotation(body, c)));
                }
            }
        }
    }
}
