use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Mat3, Sym3};

/// What is wanted of every accepted state besides what all frames have: nothing, unless someone asks.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Cells whose integration points are sampled; sorted.
    pub cells: Vec<CellId>,
    /// Whether internal forces are, and heat that bodies conduct away from nodes.
    pub forces: bool,
}

/// Values at the integration points of some cells.
#[derive(Clone, Debug, Default)]
pub struct Samples<S = PointSample> {
    // a cell, its rule, and where its points begin
    cells: Vec<(CellId, &'static Rule, usize)>,
    points: Vec<S>,
}

/// What is known at an integration point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointSample {
    /// Cauchy stress.
    pub stress: Sym3,
    /// Strain as the material sees it: linearized at small strain, of Green and Lagrange at finite strain.
    pub strain: Sym3,
    /// The part of it that causes stress.
    pub mechanical_strain: Sym3,
    /// Equivalent plastic strain; 0 where the material has none.
    pub plastic_strain: f64,
    /// Energy per volume at the start; with plasticity stored and dissipated.
    pub energy: f64,
    /// Volume at the start that belongs to the point.
    pub volume: f64,
    /// Axes of the material there, undeformed, row by row; none: those of the frame.
    pub axes: Option<Mat3>,
}

impl<S> Samples<S> {
    /// Adds a cell with the points of its rule.
    pub fn push(&mut self, cell: CellId, rule: &'static Rule, points: impl Iterator<Item = S>) {
        self.cells.push((cell, rule, self.points.len()));
        self.points.extend(points);
    }

    /// The points of a cell and the values there; `None` of a cell that was not sampled.
    #[must_use]
    pub fn of(&self, cell: CellId) -> Option<(&'static Rule, &[S])> {
        let at = self
            .cells
            .binary_search_by_key(&cell, |(id, ..)| *id)
            .ok()?;
        let (_, rule, first) = self.cells.get(at)?;
        Some((rule, self.points.get(*first..first + rule.npoint())?))
    }

    /// Sorts the samples by cell, as [`Samples::of`] needs them.
    pub(super) fn sort(&mut self) {
        self.cells.sort_unstable_by_key(|(cell, ..)| *cell);
    }
}
