//! From quadrature points to cells and nodes.

use super::dense;
use super::kernel::Sample;
use crate::system::Frame;
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::element::{self, ReferenceElement};
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::Sym3;

/// The matrix that carries values at the points of a rule to the nodes, `nnode` rows of `npoint`: the field of the linear
/// element of the same shape that comes closest to them (least squares), or their mean where there are too few points.
pub(super) fn extrapolation(element: &dyn ReferenceElement, rule: &Rule) -> Vec<f64> {
    let npoint = rule.npoint();
    let fitted = linear(element).and_then(|linear| {
        let n = linear.nnode();
        if n > npoint {
            return None;
        }
        let mut shape = vec![0.0; n];
        let mut at = |xi| {
            linear.shape(xi, &mut shape);
            shape.clone()
        };
        // (AᵀA) X = Aᵀ, with row p of A the shape functions at point p
        let a: Vec<f64> = rule.points.iter().flat_map(&mut at).collect();
        let column = |i: usize| a.iter().skip(i).step_by(n);
        let mut normal: Vec<f64> = (0..n * n)
            .map(|k| column(k / n).zip(column(k % n)).map(|(x, y)| x * y).sum())
            .collect();
        let mut x: Vec<f64> = (0..n).flat_map(|i| column(i).copied()).collect();
        dense::solve(&mut normal, n, &mut x, npoint)?;
        let nodes = element.nodes().iter().flat_map(|xi| {
            let shape = at(xi);
            let value = |p| (0..n).map(|i| shape[i] * x[i * npoint + p]).sum();
            (0..npoint).map(value).collect::<Vec<f64>>()
        });
        Some(nodes.collect())
    });
    fitted.unwrap_or_else(|| vec![1.0 / npoint as f64; element.nnode() * npoint])
}

/// The linear element of the same shape.
fn linear(of: &dyn ReferenceElement) -> Option<element::Element> {
    let same = |e: &&element::Element| {
        let shape = e.dim() == of.dim() && e.sides().len() == of.sides().len();
        shape && of.nodes().starts_with(e.nodes())
    };
    let candidates = element::TABLE.iter().copied().filter(|e| same(&e));
    candidates.min_by_key(|e| e.nnode())
}

/// Adds a cell's samples to a frame: its own means, and its share of those of its nodes.
pub(super) fn add(
    frame: &mut Frame,
    id: CellId,
    nodes: &[NodeId],
    extrapolation: &[f64],
    samples: &[Sample],
    has: Has,
) {
    let volume: f64 = samples.iter().map(|s| s.volume).sum();
    let mean = sum(samples, samples.iter().map(|s| s.volume / volume));
    let (block, cell) = (id.block as usize, id.index as usize);
    put(frame.cell_stress.get_mut(block), cell, mean.stress);
    put(frame.cell_strain.get_mut(block), cell, mean.strain);
    if has.plastic_strain {
        let cells = frame.cell_plastic_strain.get_mut(block);
        put(cells, cell, mean.plastic_strain);
    }
    for (&node, weights) in nodes.iter().zip(extrapolation.chunks_exact(samples.len())) {
        let value = sum(samples, weights.iter().copied());
        let node = node as usize;
        let Some(weight) = frame.stress_weight.get_mut(node) else {
            continue;
        };
        // running mean
        *weight += 1.0;
        let share = weight.recip();
        if let Some(to) = frame.stress.get_mut(node) {
            *to = *to + (value.stress - *to) * share;
        }
        if let Some(to) = frame.strain.get_mut(node) {
            *to = *to + (value.strain - *to) * share;
        }
        if has.plastic_strain
            && let Some(to) = frame.plastic_strain.get_mut(node)
        {
            // an equivalent strain is never negative, extrapolated or not
            *to += (value.plastic_strain.max(0.0) - *to) * share;
        }
    }
}

/// Which fields a body has.
#[derive(Clone, Copy)]
pub(super) struct Has {
    pub plastic_strain: bool,
}

/// Makes room in a frame for the fields that not every model has.
pub(super) fn make_room(frame: &mut Frame, has: Has) {
    if has.plastic_strain {
        frame.plastic_strain.resize(frame.stress.len(), 0.0);
        let cells = frame.cell_stress.iter().map(|c| vec![0.0; c.len()]);
        if frame.cell_plastic_strain.is_empty() {
            frame.cell_plastic_strain = cells.collect();
        }
    }
}

fn sum(samples: &[Sample], weights: impl Iterator<Item = f64>) -> Sample {
    let mut out = Sample::default();
    for (sample, w) in samples.iter().zip(weights) {
        out.stress = out.stress + sample.stress * w;
        out.strain = out.strain + sample.strain * w;
        out.plastic_strain += sample.plastic_strain * w;
    }
    out
}

fn put<T>(cells: Option<&mut Vec<T>>, cell: usize, value: T) {
    if let Some(to) = cells.and_then(|c| c.get_mut(cell)) {
        *to = value;
    }
}

impl Default for Sample {
    fn default() -> Self {
        Self {
            stress: Sym3::ZERO,
            strain: Sym3::ZERO,
            plastic_strain: 0.0,
            volume: 0.0,
        }
    }
}
