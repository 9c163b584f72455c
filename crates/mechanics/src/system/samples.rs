use super::{Dof, DofName, Layout, Order, Role, Sink, State, Term, TermError, Work};
use rayon::prelude::*;
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Sym3, Vec3};

/// What is wanted of every accepted state besides what all frames have: nothing, unless someone asks.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Cells whose integration points are sampled; sorted.
    pub cells: Vec<CellId>,
    /// Whether internal forces are.
    pub forces: bool,
}

/// Values at the integration points of some cells.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    // a cell, its rule, and where its points begin
    cells: Vec<(CellId, &'static Rule, usize)>,
    points: Vec<PointSample>,
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
}

impl Samples {
    /// Adds a cell with the points of its rule.
    pub fn push(
        &mut self,
        cell: CellId,
        rule: &'static Rule,
        points: impl Iterator<Item = PointSample>,
    ) {
        self.cells.push((cell, rule, self.points.len()));
        self.points.extend(points);
    }

    /// The points of a cell and the values there; `None` of a cell that was not sampled.
    #[must_use]
    pub fn of(&self, cell: CellId) -> Option<(&'static Rule, &[PointSample])> {
        let at = self
            .cells
            .binary_search_by_key(&cell, |(id, ..)| *id)
            .ok()?;
        let (_, rule, first) = self.cells.get(at)?;
        Some((rule, self.points.get(*first..first + rule.npoint())?))
    }

    /// The samples of these cells, which are sorted, at an accepted state.
    ///
    /// # Errors
    /// A term that cannot evaluate the state.
    pub(super) fn take(
        terms: &[Box<dyn Term>],
        state: &State,
        cells: &[CellId],
    ) -> Result<Self, TermError> {
        let mut samples = Self::default();
        if !cells.is_empty() {
            let sampled = terms.iter().filter_map(|term| term.capabilities().sampled);
            for term in sampled {
                term.sample(state, cells, &mut samples)?;
            }
            samples.cells.sort_unstable_by_key(|(cell, ..)| *cell);
        }
        Ok(samples)
    }
}

/// Chunks whose forces are found before their nodes take them: bounds the memory.
const CHUNKS: usize = 256;

/// The forces of all terms within at the nodes, whatever follows whatever.
pub(super) fn internal_forces(
    terms: &[Box<dyn Term>],
    layout: &Layout,
    state: &State,
) -> Result<Vec<Vec3>, TermError> {
    let mut at_nodes = vec![Vec3::ZERO; layout.nnode()];
    let internal = terms
        .iter()
        .filter(|term| term.properties().role == Role::Internal);
    for term in internal {
        let chunks: Vec<usize> = (0..term.nchunk()).collect();
        for wave in chunks.chunks(CHUNKS) {
            // chunks in parallel, nodes in their order
            let evaluate = |work: &mut Work, &chunk: &usize| {
                let mut forces = Forces::default();
                term.evaluate(chunk, state, Order::Residual, work, &mut forces)?;
                Ok(forces)
            };
            let evaluated = wave.par_iter().map_init(Work::default, evaluate);
            let evaluated: Vec<Result<Forces, TermError>> = evaluated.collect();
            for forces in evaluated {
                for (dof, force) in forces?.0 {
                    let name = layout.name(dof).and_then(DofName::displacement);
                    if let Some((node, axis)) = name
                        && let Some(to) = at_nodes.get_mut(node as usize)
                    {
                        to[axis] += force;
                    }
                }
            }
        }
    }
    Ok(at_nodes)
}

/// Forces as they come.
#[derive(Default)]
struct Forces(Vec<(Dof, f64)>);

impl Sink for Forces {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        self.0
            .extend(dofs.iter().copied().zip(force.iter().copied()));
    }

    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], _: &[f64], _: usize) {
        self.add(dofs, force, &[]);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}
