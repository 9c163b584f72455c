//! What one thread needs to run the kernel over cells, and what is wanted of them.

use super::cells::Cells;
use super::kernel::Sample;
use crate::material::Order as MaterialOrder;
use crate::system::Dof;
use signorini_geometry::tensor::Vec3;

/// Scratch of one thread.
#[derive(Default)]
pub(super) struct Scratch {
    pub x: Vec<Vec3>,
    pub u: Vec<f64>,
    pub correction: Vec<f64>,
    pub way: Vec<f64>,
    pub rate: Vec<f64>,
    pub profile: Vec<f64>,
    pub temperature: Vec<f64>,
    pub temperature_at_start: Vec<f64>,
    pub dofs: Vec<Dof>,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// Against temperatures of the nodes, where these are unknown.
    pub thermal: Vec<f64>,
    pub heat: Vec<Dof>,
    pub samples: Vec<Sample>,
    pub new: Vec<f64>,
    pub inner: Vec<f64>,
    /// Where the stiffness is symmetric: see [`Sink::add_symmetric`].
    pub blocks: Vec<f64>,
    pub lanes: InLanes,
    pub viscous: OfRates,
}

/// What follows from rates of strain.
#[derive(Default)]
pub(super) struct OfRates {
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub new: Vec<f64>,
}

/// The same of several cells, lane by lane.
#[derive(Default)]
pub(super) struct InLanes {
    pub x: Vec<f64>,
    pub u: Vec<f64>,
    pub correction: Vec<f64>,
    pub force: Vec<f64>,
    pub blocks: Vec<f64>,
    pub energy: Vec<f64>,
}

/// What is wanted of the cells.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    Forces,
    Stiffness,
    Samples,
}

impl Wanted {
    pub const fn order(self) -> MaterialOrder {
        match self {
            Self::Stiffness => MaterialOrder::Tangent,
            Self::Forces | Self::Samples => MaterialOrder::Stress,
        }
    }
}

impl Scratch {
    pub fn size(&mut self, block: &Cells, ndim: usize, wanted: Wanted) {
        let n = block.nnode * ndim;
        let stiff = wanted == Wanted::Stiffness;
        let npoint = block.points.rule.npoint();
        self.force.resize(n, 0.0);
        self.stiffness.resize(if stiff { n * n } else { 0 }, 0.0);
        let npair = block.nnode * (block.nnode + 1) / 2;
        let nblocks = if stiff { npair * ndim * ndim } else { 0 };
        self.blocks.resize(nblocks, 0.0);
        self.new.resize(block.nhistory, 0.0);
        let sampled = wanted == Wanted::Samples;
        self.samples
            .resize(if sampled { npoint } else { 0 }, Sample::default());
    }

    /// Takes the blocks of a stiffness that is symmetric.
    pub fn pack(&mut self, nnode: usize, ndim: usize) {
        let n = nnode * ndim;
        let pairs = (0..nnode).flat_map(|j| (0..=j).map(move |i| (i, j)));
        for ((i, j), block) in pairs.zip(self.blocks.chunks_exact_mut(ndim * ndim)) {
            for (k, row) in block.chunks_exact_mut(ndim).enumerate() {
                let at = (i * ndim + k) * n + j * ndim;
                row.copy_from_slice(&self.stiffness[at..at + ndim]);
            }
        }
    }
}
