//! The mass of cells: between their nodes, or at these alone.

use super::Region;
use super::local::gather;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

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

/// The moments of a mass: `∫ ρ dV`, `∫ ρ y dV`, `∫ ρ y yᵀ dV` with `y = x − from`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    mass: f64,
    first: Vec3,
    second: Sym3,
}

impl Moments {
    /// Adds those of a point mass at `y`.
    pub fn push(&mut self, mass: f64, y: Vec3) {
        self.mass += mass;
        self.first += y * mass;
        self.second = self.second + Sym3::symmetric_part(Mat3::outer(y, y)) * mass;
    }

    /// Adds those of cells, at the start; the density is in the factors of the region.
    pub fn push_cells(&mut self, cells: &Region, reference: &[Vec3], from: Vec3) {
        let mut x = Vec::new();
        for (patch, piece) in cells.pieces() {
            gather(reference, piece.nodes, &mut x);
            for sample in patch.samples() {
                let places = x.iter().zip(sample.shape);
                let place: Vec3 = places.map(|(x, n)| *x * *n).sum();
                self.push(patch.volume(&piece, &sample, &x), place - from);
            }
        }
    }

    /// Adds those of a body with these moments of inertia about its centroid `y`.
    pub fn push_body(&mut self, mass: f64, y: Vec3, inertia: Sym3) {
        self.push(mass, y);
        // J = tr(S) 1 − S, so that S = ½ tr(J) 1 − J
        let half = 0.5 * inertia.trace();
        self.second = self.second + Sym3::diagonal(half, half, half) - inertia;
    }

    /// Mass, centroid and moments of inertia about it; none without a mass.
    pub fn body(&self) -> Option<(f64, Vec3, Sym3)> {
        if self.mass <= 0.0 {
            return None;
        }
        let arm = self.first / self.mass;
        let about = self.second - Sym3::symmetric_part(Mat3::outer(arm, arm)) * self.mass;
        let all = about.trace();
        Some((self.mass, arm, Sym3::diagonal(all, all, all) - about))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two balls on a bar, by Steiner's theorem.
    #[test]
    fn bodies_together_have_the_inertia_of_one() {
        let mut moments = Moments::default();
        let own = Sym3::diagonal(0.4, 0.4, 0.4);
        moments.push_body(1.0, Vec3::new(1.0, 0.0, 0.0), own);
        moments.push_body(1.0, Vec3::new(3.0, 0.0, 0.0), own);
        moments.push(2.0, Vec3::new(2.0, 0.0, 0.5));
        let (mass, arm, inertia) = moments.body().unwrap();
        assert!((mass - 4.0).abs() < 1e-15);
        assert!((arm - Vec3::new(2.0, 0.0, 0.25)).norm() < 1e-15);
        // 2 (m d²) along y and z, and ¼ (0.25)² 4 about x and y
        let wanted = Sym3::diagonal(0.8 + 0.25, 0.8 + 2.0 + 0.25, 0.8 + 2.0);
        let off = (inertia - wanted).to_mat3().rows;
        assert!(off.iter().all(|row| row.norm() < 1e-14), "{inertia:?}");
    }
}
