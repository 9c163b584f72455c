//! The rows of one group: constraints that act on the same participants.

use crate::system::{Dof, Layout, Work};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use std::ops::Range;

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
#[derive(Default)]
pub struct Rows {
    participants: Vec<Participant>,
    ncolumn: usize,
    rows: Vec<Row>,
    nrow: usize,
    /// The participants of the secondary side.
    secondary: Range<usize>,
    /// What those who fill rows keep from one to the next.
    pub(super) scratch: Work,
}

/// One constraint.
#[derive(Debug, Default)]
pub struct Row {
    /// Number of the row: the key of history and multipliers.
    pub number: usize,
    /// Gap, negative in penetration.
    pub gap: f64,
    /// The gap where the increment began, of a row whose pressure is a secant.
    pub from: Option<f64>,
    /// What damps the motion along the normal.
    pub viscous: Viscous,
    /// What wear puts in series with the law.
    pub worn: Option<Series>,
    /// Unit normal out of the primary side.
    pub normal: Vec3,
    /// The part of its measure that it acts on.
    pub coverage: f64,
    /// Derivative of the gap. One entry for each column.
    pub gradient: Vec<f64>,
    /// Weights with which a pressure acts on the columns.
    pub weights: Vec<f64>,
    /// Derivative of the weights, row-major, columns × columns; valid where the tangent was asked for.
    pub dweights: Vec<f64>,
    /// What tangential tractions need; valid where slip was asked for.
    pub sliding: Sliding,
}

/// The gap that a law sees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeenGap {
    /// Where it is asked for.
    pub now: f64,
    /// Where the increment began, if the pressure is the secant of the law's energy between both.
    pub from: Option<f64>,
    /// What damps its motion.
    pub viscous: Viscous,
    /// What wear puts in series with the law.
    pub worn: Option<Series>,
}

/// What an increment wears off both sides of a row: a compliance in series with its law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Series {
    /// Depth per pressure and way.
    pub coefficient: f64,
    /// The way, with what sticking yields.
    pub way: f64,
    /// Whether it may have such a part.
    pub eases: bool,
    /// The length of all slip before, which limits of friction depend on.
    pub path: f64,
    /// The limit of friction, where it is held.
    pub held: Option<f64>,
}

/// What resists the velocity of a gap, and of a slip, where the law acts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viscous {
    /// `−c ġ`: positive in closing.
    pub pressure: f64,
    /// `c/h`: what a smaller gap at the end of the increment adds to it.
    pub slope: f64,
    /// Whether it may pull.
    pub pulls: bool,
    /// `c_t/h`: shear over the slip in the increment.
    pub drag: f64,
}

impl Row {
    /// What the law sees.
    #[must_use]
    pub const fn seen(&self) -> SeenGap {
        SeenGap {
            now: self.gap,
            from: self.from,
            viscous: self.viscous,
            worn: self.worn,
        }
    }

    /// The part of a vector within the tangent plane.
    #[must_use]
    pub fn within(&self, v: Vec3) -> Vec3 {
        v - self.normal * self.normal.dot(v)
    }
}

/// The tangential part of a row. Vectors have one entry for each column.
#[derive(Debug, Default)]
pub struct Sliding {
    /// e: how far the point is from its anchor, within the tangent plane; of a bond, the whole way.
    pub slip: Vec3,
    /// `P Bᵀ Δd`: how far it slips in the increment, of rows that are carried on to its end.
    pub way: Vec3,
    /// Its derivative against the end of the increment, of rows whose slip is damped; valid where the tangent was asked for.
    pub dway: Vec<Vec3>,
    /// ∂e/∂d.
    pub dslip: Vec<Vec3>,
    /// ∂ν/∂d.
    pub dnormal: Vec<Vec3>,
    /// B: the force at a column is `B·t`.
    pub operator: Vec<Vec3>,
    /// Whether it slides without friction, for want of a place where it could stick; of a bond, whether its multiplier alone
    /// acts, since other rows say where it is.
    pub free: bool,
    /// Directions along which both sides are held, as by a plane of symmetry: nothing rubs there.
    pub held: [bool; 3],
    /// Of operators that are a number times the identity for each participant, the derivatives of these numbers: a line of
    /// one entry for each column; empty for others.
    pub dscale: Vec<f64>,
    /// ∂B/∂d, as a sum of products; valid where the tangent was asked for.
    turns: Vec<Turn>,
    nturn: usize,
}

/// A part of the derivative of an operator: `∂B_i/∂d_j = across_i along_j`.
#[derive(Debug, Default)]
pub struct Turn {
    /// One vector for each column.
    pub across: Vec<Vec3>,
    /// One number for each column.
    pub along: Vec<f64>,
}

impl Sliding {
    fn reset(&mut self, ncolumn: usize) {
        self.slip = Vec3::ZERO;
        self.way = Vec3::ZERO;
        self.dscale.clear();
        self.nturn = 0;
        for values in [&mut self.dslip, &mut self.dnormal, &mut self.operator] {
            values.clear();
            values.resize(ncolumn, Vec3::ZERO);
        }
    }

    /// A further product, zeroed.
    pub fn push_turn(&mut self) -> &mut Turn {
        let n = self.operator.len();
        if self.nturn == self.turns.len() {
            self.turns.push(Turn::default());
        }
        let turn = &mut self.turns[self.nturn];
        self.nturn += 1;
        turn.across.clear();
        turn.across.resize(n, Vec3::ZERO);
        turn.along.clear();
        turn.along.resize(n, 0.0);
        turn
    }

    /// A vector without its parts along which the sides are held.
    #[must_use]
    pub fn movable(&self, mut v: Vec3) -> Vec3 {
        for (axis, held) in self.held.iter().enumerate() {
            if *held {
                v[axis] = 0.0;
            }
        }
        v
    }

    /// The component and the derivatives of the number at a column, of operators that are numbers.
    #[must_use]
    pub fn scaled(&self, column: usize) -> Option<(usize, &[f64])> {
        let n = self.operator.len();
        let line = self.dscale.get(column / 3 * n..)?.get(..n)?;
        Some((column % 3, line))
    }

    /// Adds the derivatives of the number that the operator is for the participant whose columns begin at this one, one for each
    /// column.
    pub fn dnumber(&self, first: usize, out: &mut Vec<f64>) {
        let begin = out.len();
        match self.scaled(first) {
            Some((_, line)) => out.extend_from_slice(line),
            None => out.resize(begin + self.operator.len(), 0.0),
        }
        for turn in self.turns() {
            let across = turn.across.get(first).map_or(0.0, |across| across.x);
            let to = out.iter_mut().skip(begin);
            to.zip(&turn.along)
                .for_each(|(to, along)| *to += across * along);
        }
    }

    /// Multiplies the derivatives of normals and operators.
    pub fn scale_derivatives(&mut self, factor: f64) {
        self.dnormal.iter_mut().for_each(|d| *d *= factor);
        self.dscale.iter_mut().for_each(|d| *d *= factor);
        for turn in self.turns.iter_mut().take(self.nturn) {
            turn.along.iter_mut().for_each(|d| *d *= factor);
        }
    }

    /// ∂B/∂d, but for [`Sliding::dscale`].
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        &self.turns[..self.nturn]
    }
}

/// What is wanted of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// How far.
    pub order: RowOrder,
    /// Whether the tangential part too.
    pub slip: bool,
}

/// How far rows are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RowOrder {
    /// Gap and normal.
    Gap,
    /// And what a force needs.
    Gradient,
    /// And what a tangent needs.
    Tangent,
}

impl Rows {
    /// Starts a group with these participants.
    pub fn start(&mut self, participants: impl IntoIterator<Item = Participant>) {
        self.participants.clear();
        self.participants.extend(participants);
        self.ncolumn = self.participants.iter().map(|p| p.ncolumn()).sum();
        self.nrow = 0;
        self.secondary = 0..0;
    }

    /// Sets which participants are those of the secondary side.
    pub fn set_secondary(&mut self, places: Range<usize>) {
        self.secondary = places;
    }

    /// The places of the secondary side among the participants.
    #[must_use]
    pub fn secondary(&self) -> Range<usize> {
        self.secondary.clone()
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

    /// A further row, zeroed, with room for the wanted quantities.
    pub fn push(&mut self, number: usize, wanted: Wanted) -> &mut Row {
        let n = self.ncolumn;
        if self.nrow == self.rows.len() {
            self.rows.push(Row::default());
        }
        let row = &mut self.rows[self.nrow];
        self.nrow += 1;
        row.number = number;
        row.gap = 0.0;
        row.from = None;
        row.viscous = Viscous::default();
        row.worn = None;
        row.normal = Vec3::ZERO;
        row.coverage = 1.0;
        row.sliding.free = false;
        row.sliding.held = [false; 3];
        if wanted.order == RowOrder::Gap {
            return row;
        }
        let square = if wanted.order == RowOrder::Tangent {
            n * n
        } else {
            0
        };
        for (values, length) in [
            (&mut row.gradient, n),
            (&mut row.weights, n),
            (&mut row.dweights, square),
        ] {
            values.clear();
            values.resize(length, 0.0);
        }
        row.sliding.reset(n);
        row
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows[..self.nrow]
    }

    pub(super) fn rows_mut(&mut self) -> &mut [Row] {
        &mut self.rows[..self.nrow]
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
