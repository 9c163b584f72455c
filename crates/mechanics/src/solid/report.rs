//! From quadrature points to cells and nodes.

use super::kernel::Sample;
use crate::material::dense;
use crate::system::Frame;
use signorini_geometry::element;
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::Sym3;

/// The field that comes closest to values at points (least squares), and carries them to the nodes of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtNodes {
    /// The linear one.
    #[default]
    Linear,
    /// That of the element's own shape functions, where there are as many points; else the linear one.
    Element,
}

/// The matrix that carries values at the points of a rule to the nodes, `nnode` rows of `npoint`: that of the field
/// which comes closest to them, or their mean where there are too few points.
pub(super) fn extrapolation(element: element::Element, rule: &Rule, at_nodes: AtNodes) -> Vec<f64> {
    let npoint = rule.npoint();
    let own = at_nodes == AtNodes::Element && element.nnode() <= npoint;
    let field = if own {
        element
    } else {
        element.family().linear()
    };
    let fitted = || {
        let n = field.nnode();
        if n > npoint {
            return None;
        }
        let mut shape = vec![0.0; n];
        let mut at = |xi| {
            field.shape(xi, &mut shape);
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
    };
    fitted().unwrap_or_else(|| vec![1.0 / npoint as f64; element.nnode() * npoint])
}

/// The means over a cell.
#[derive(Default)]
pub(super) struct CellMeans {
    volume: f64,
    stress: Sym3,
    strain: Sym3,
    plastic_strain: Option<f64>,
}

impl CellMeans {
    /// Takes a point into the means.
    pub fn add(&mut self, volume: f64, stress: Sym3, strain: Sym3, plastic_strain: Option<f64>) {
        self.volume += volume;
        let share = volume / self.volume;
        self.stress = self.stress + (stress - self.stress) * share;
        self.strain = self.strain + (strain - self.strain) * share;
        if let Some(value) = plastic_strain {
            let mean = self.plastic_strain.unwrap_or(0.0);
            self.plastic_strain = Some(mean + (value - mean) * share);
        }
    }

    /// Writes them into a frame.
    pub fn put(&self, frame: &mut Frame, id: CellId) {
        let (block, cell) = (id.block as usize, id.index as usize);
        put(frame.cell_stress.get_mut(block), cell, self.stress);
        put(frame.cell_strain.get_mut(block), cell, self.strain);
        if let Some(value) = self.plastic_strain {
            if frame.cell_plastic_strain.is_empty() {
                let cells = frame.cell_stress.iter().map(|c| vec![0.0; c.len()]);
                frame.cell_plastic_strain = cells.collect();
            }
            put(frame.cell_plastic_strain.get_mut(block), cell, value);
        }
    }
}

/// Adds a cell's samples to a frame: its own means, and its share of those of its nodes.
pub(super) fn add(
    frame: &mut Frame,
    id: CellId,
    nodes: &[NodeId],
    extrapolation: &[f64],
    samples: &[Sample],
) {
    let mut means = CellMeans::default();
    for s in samples {
        means.add(s.volume, s.stress, s.strain, s.plastic_strain);
    }
    means.put(frame, id);
    let plastic = means.plastic_strain.is_some();
    if plastic {
        frame.plastic_strain.resize(frame.stress.len(), 0.0);
    }
    for (&node, weights) in nodes.iter().zip(extrapolation.chunks_exact(samples.len())) {
        let node = node as usize;
        let Some(weight) = frame.stress_weight.get_mut(node) else {
            continue;
        };
        // running mean
        *weight += 1.0;
        let share = weight.recip();
        let pairs = || samples.iter().zip(weights);
        if let Some(to) = frame.stress.get_mut(node) {
            let value = pairs().fold(Sym3::ZERO, |sum, (s, w)| sum + s.stress * *w);
            *to = *to + (value - *to) * share;
        }
        if let Some(to) = frame.strain.get_mut(node) {
            let value = pairs().fold(Sym3::ZERO, |sum, (s, w)| sum + s.strain * *w);
            *to = *to + (value - *to) * share;
        }
        if plastic && let Some(to) = frame.plastic_strain.get_mut(node) {
            let value: f64 = pairs()
                .map(|(s, w)| s.plastic_strain.unwrap_or(0.0) * w)
                .sum();
            // an equivalent strain is never negative, extrapolated or not
            *to += (value.max(0.0) - *to) * share;
        }
    }
}

fn put<T>(cells: Option<&mut Vec<T>>, cell: usize, value: T) {
    if let Some(to) = cells.and_then(|c| c.get_mut(cell)) {
        *to = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::tensor::Vec3;

    /// The largest error at the nodes of a field that is known at the points.
    fn error(name: &str, at_nodes: AtNodes, field: impl Fn(Vec3) -> f64) -> f64 {
        let element = element::by_name(name).unwrap();
        let rule = element.full_rule();
        let matrix = extrapolation(element, rule, at_nodes);
        let rows = matrix.chunks_exact(rule.npoint()).zip(element.nodes());
        let error = |(row, xi): (&[f64], &Vec3)| {
            let values = rule.points.iter().map(|p| field(*p));
            let carried: f64 = row.iter().zip(values).map(|(w, value)| w * value).sum();
            (carried - field(*xi)).abs()
        };
        rows.map(error).fold(0.0, f64::max)
    }

    #[test]
    fn fields_of_the_element_are_kept() {
        let linear = |x: Vec3| 2.0 + x.x - 3.0 * x.y + 0.5 * x.z;
        let quadratic = |x: Vec3| linear(x) + x.x * x.x * x.y - 4.0 * x.y * x.y;
        for name in ["quad8", "quad9", "hex20", "hex27"] {
            assert!(error(name, AtNodes::Element, quadratic) < 1e-12, "{name}");
            assert!(error(name, AtNodes::Linear, quadratic) > 0.1, "{name}");
        }
        for name in ["tri6", "tet10", "wedge15", "quad4", "hex8", "hex20"] {
            for at_nodes in [AtNodes::Linear, AtNodes::Element] {
                assert!(error(name, at_nodes, linear) < 1e-12, "{name}");
            }
        }
    }

    #[test]
    fn what_a_serendipity_element_lacks_is_left_out() {
        let product = |x: Vec3| (x.x * x.x - 0.4) * (x.y * x.y - 0.4);
        let (eight, nine) = ("quad8", "quad9");
        assert!(error(nine, AtNodes::Element, product) < 1e-12);
        // orthogonal at the points to all that eight nodes have: nothing of it is left, at corners (1 − 0.4)²
        assert!((error(eight, AtNodes::Element, product) - 0.36).abs() < 1e-12);
    }
}
