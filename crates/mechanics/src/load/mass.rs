//! The mass of cells: between their nodes, or at these alone.

use super::Region;
use super::local::gather;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// Hands the nodes of every cell and its matrix `∫ ρ N_I N_J dV` at the start (E7), row-major, to `take`; the density is in
/// the factors of the region.
pub fn matrices(cells: &Region, reference: &[Vec3], mut take: impl FnMut(&[NodeId], &[f64])) {
    let (mut x, mut matrix) = (Vec::new(), Vec::new());
    for (patch, piece) in cells.pieces() {
        gather(reference, piece.nodes, &mut x);
        let n = piece.nodes.len();
        matrix.clear();
        matrix.resize(n * n, 0.0);
        for sample in patch.samples() {
            let mass = patch.volume(&piece, &sample, &x);
            for (row, left) in matrix.chunks_exact_mut(n).zip(sample.shape) {
                let columns = row.iter_mut().zip(sample.shape);
                columns.for_each(|(m, right)| *m += mass * left * right);
            }
        }
        take(piece.nodes, &matrix);
    }
}

/// The masses that stand for a matrix at its nodes: its diagonal, scaled to the mass of the cell (E8).
pub fn lump(matrix: &[f64], masses: &mut Vec<f64>) {
    let n = matrix.len().isqrt();
    let all: f64 = matrix.iter().sum();
    masses.clear();
    masses.extend(matrix.iter().step_by(n + 1));
    let diagonal: f64 = masses.iter().sum();
    masses.iter_mut().for_each(|m| *m *= all / diagonal);
}
