//! An own term: an elastic foundation under a face that stiffens as it is pressed, `p = k w + c w³` per area.
//!
//! `cargo run --release -p signorini --example own_term`

mod common;

use common::{Brick, frames, moved};
use signorini::prelude::*;

/// Springs between the ground and the facets of a face, along z. They push and pull.
struct Foundation {
    /// k: force per area and displacement.
    linear: f64,
    /// c: force per area and cube of the displacement.
    cubic: f64,
    facets: Vec<Facet>,
}

/// A facet on the foundation.
struct Facet {
    /// The displacements of its nodes along z.
    dofs: Vec<Dof>,
    /// At each integration point, the shape functions and the area.
    points: Vec<(Vec<f64>, f64)>,
}

impl Facet {
    fn new(mesh: &Mesh, face: Face, layout: &Layout) -> Option<Self> {
        let (element, nodes) = mesh.face(face)?;
        let (mut shape, mut slope) = (
            vec![0.0; element.nnode()],
            vec![Vec3::ZERO; element.nnode()],
        );
        let mut points = Vec::new();
        for (xi, weight) in element.surface_rule().iter() {
            element.shape(xi, &mut shape);
            element.dshape(xi, &mut slope);
            let along = |axis: usize| -> Vec3 {
                let of_nodes = nodes.iter().zip(&slope);
                of_nodes
                    .map(|(n, dn)| mesh.points[*n as usize] * dn[axis])
                    .sum()
            };
            points.push((shape.clone(), along(0).cross(along(1)).norm() * weight));
        }
        let dofs = nodes.iter().map(|n| layout.node(*n, 2)).collect();
        Some(Self { dofs, points })
    }

    /// Shape functions, area and displacement at the integration points.
    fn states(&self, trial: &State) -> impl Iterator<Item = (&[f64], f64, f64)> {
        let at = |dof: &Dof| trial.u.get(*dof as usize).copied().unwrap_or(0.0);
        let nodal: Vec<f64> = self.dofs.iter().map(at).collect();
        self.points.iter().map(move |(shape, area)| {
            let w = shape.iter().zip(&nodal).map(|(n, u)| n * u).sum();
            (&shape[..], *area, w)
        })
    }
}

impl Term for Foundation {
    fn name(&self) -> &str {
        "foundation"
    }

    fn properties(&self) -> Properties {
        // its stiffness is symmetric and positive, and no part of the blocks of solids
        Properties::new(Symmetry::Definite, Part::Interface).with_role(Role::Support)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        self.facets
            .iter()
            .for_each(|facet| out.interface(&facet.dofs));
    }

    fn begin(&mut self, _: &Phase, _: &State) -> Result<(), TermError> {
        Ok(())
    }

    /// One facet is a chunk: chunks are evaluated in parallel.
    fn nchunk(&self) -> usize {
        self.facets.len()
    }

    /// `f_i = ∫ N_i p dA`, `K_ij = ∫ N_i N_j ∂p/∂w dA`.
    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let facet = &self.facets[chunk];
        let n = facet.dofs.len();
        let mut force = vec![0.0; n];
        let mut stiffness = match order {
            Order::Residual => Vec::new(),
            Order::Tangent => vec![0.0; n * n],
        };
        for (shape, area, w) in facet.states(trial) {
            let pressure = w * (self.linear + self.cubic * w * w);
            let slope = self.linear + 3.0 * self.cubic * w * w;
            for (f, ni) in force.iter_mut().zip(shape) {
                *f += ni * pressure * area;
            }
            for (row, ni) in stiffness.chunks_mut(n).zip(shape) {
                for (k, nj) in row.iter_mut().zip(shape) {
                    *k += ni * nj * slope * area;
                }
            }
        }
        out.add(&facet.dofs, &force, &stiffness);
        Ok(())
    }

    fn energy(&self, chunk: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        let density = |w: f64| w * w * (0.5 * self.linear + 0.25 * self.cubic * w * w);
        let states = self.facets[chunk].states(trial);
        Ok(Some(states.map(|(_, area, w)| area * density(w)).sum()))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (increment, force) in (1..).zip(press()?) {
        println!("increment {increment}: the column is pushed with {force:.4}");
    }
    Ok(())
}

/// A column of height 2 and section 1, whose foot stands on the foundation.
fn column() -> Result<(Mesh, Model, Foundation), Box<dyn std::error::Error>> {
    let mut mesh = Mesh::default();
    let column = Brick::new(&mut mesh, Vec3::ZERO, Vec3::new(1.0, 1.0, 2.0), [2, 2, 4]);
    let mut press = StepPart::new("press", Increments::Fixed(4));
    press.nonlinear = false;
    let top = column.at_height(&mesh, 2.0);
    press.changes = vec![moved(&top, Some(Vec3::new(0.0, 0.0, -0.08)))];
    let parts = Parts {
        bodies: vec![column.body("column", SaintVenantKirchhoff::new(1000.0, 0.0))],
        steps: vec![press],
        ..Parts::new(&mesh, Idealisation::Space)
    };
    let model = Model::assemble(parts)?;
    let foot = column.faces_at(&mesh, 0.0);
    let on_it = |face: &Face| Facet::new(&mesh, *face, &model.system.layout);
    let foundation = Foundation {
        linear: 300.0,
        cubic: 4e5,
        facets: foot.iter().filter_map(on_it).collect(),
    };
    Ok((mesh, model, foundation))
}

/// The force on the column after each increment, positive in compression.
fn press() -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let (_, mut model, foundation) = column()?;
    model.system.terms.push(Box::new(foundation));
    frames(model, |frame| {
        -frame.reaction_force.iter().map(|r| r.z).sum::<f64>()
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_those_of_a_bar_on_a_spring() {
        for (increment, force) in (1..).zip(press().unwrap()) {
            // E (u - w)/L = k w + c w^3 with E = 1000, L = 2
            let u = 0.02 * f64::from(increment);
            let mut w = u;
            for _ in 0..50 {
                let f = 800.0 * w + 4e5 * w * w * w - 500.0 * u;
                w -= f / (800.0 + 1.2e6 * w * w);
            }
            let exact = 500.0 * (u - w);
            assert!((force / exact - 1.0).abs() < 1e-6, "{force}, not {exact}");
        }
    }

    /// Adds up what a term exerts on all dofs.
    struct Sum {
        force: Vec<f64>,
        stiffness: Vec<Vec<f64>>,
    }

    impl Sink for Sum {
        fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
            for (i, (row, f)) in dofs.iter().zip(force).enumerate() {
                self.force[*row as usize] += f;
                for (j, column) in dofs.iter().enumerate() {
                    self.stiffness[*row as usize][*column as usize] +=
                        stiffness[i * dofs.len() + j];
                }
            }
        }

        fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

        fn uncertain(&mut self, _: &[Dof], _: f64) {}
    }

    #[test]
    fn force_is_the_slope_of_the_energy_and_stiffness_that_of_the_force() {
        let (_, model, foundation) = column().unwrap();
        let mut state = model.system.initial_state();
        let ndof = state.u.len();
        for (dof, u) in state.u.iter_mut().enumerate() {
            *u = 0.03 * (1.7 * dof as f64).sin();
        }
        let evaluate = |state: &State| {
            let mut sum = Sum {
                force: vec![0.0; ndof],
                stiffness: vec![vec![0.0; ndof]; ndof],
            };
            let (mut energy, mut work) = (0.0, Work::default());
            for chunk in 0..foundation.nchunk() {
                let found = foundation.energy(chunk, state, &mut work);
                energy += found.unwrap().unwrap();
                let order = Order::Tangent;
                foundation
                    .evaluate(chunk, state, order, &mut work, &mut sum)
                    .unwrap();
            }
            (energy, sum)
        };
        let (_, at) = evaluate(&state);
        let foot = foundation.facets.iter().flat_map(|facet| &facet.dofs);
        for dof in foot.map(|dof| *dof as usize) {
            let h = 1e-5;
            let moved = |by: f64| {
                let mut moved = state.clone();
                moved.u[dof] += by;
                evaluate(&moved)
            };
            let ((more, ahead), (less, behind)) = (moved(h), moved(-h));
            assert!((at.force[dof] - (more - less) / (2.0 * h)).abs() < 1e-6);
            for row in 0..ndof {
                let slope = (ahead.force[row] - behind.force[row]) / (2.0 * h);
                assert!((at.stiffness[row][dof] - slope).abs() < 1e-5);
            }
        }
    }
}
