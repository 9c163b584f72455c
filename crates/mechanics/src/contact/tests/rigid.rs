//! Surfaces carried by rigid bodies: rows against differences under rotations that compose.

use super::super::discretization::{Pairing, PointToSegment, SurfacePair};
use super::super::row::Rows;
use super::{Random, first_rows, largest, pair_up};
use crate::system::{Dof, Elimination, Layout, NO_DOF, RigidBody, State};
use signorini_geometry::surface::{Analytical, Mount, Shape, Side, SignedDistance, Sphere, Torus};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;

/// `½ Σ (x_i / a_i)² − ½` around a centre in the plane.
fn ellipse(centre: Vec3, axes: [f64; 2]) -> SignedDistance {
    let stretch = Sym3::diagonal(axes[0].powi(-2), axes[1].powi(-2), 0.0);
    let gradient = move |x: Vec3| stretch.to_mat3() * (x - centre);
    SignedDistance::new(
        1.0,
        Box::new(move |x| Ok(0.5 * (x - centre).dot(gradient(x)) - 0.5)),
        Box::new(move |x| Ok(gradient(x))),
        Box::new(move |_| Ok(stretch)),
    )
    .unwrap()
}

/// A rigid body with a round surface, a node near it, and a state in which the body has been turned twice.
struct Scene {
    pair: SurfacePair,
    layout: Layout,
    reference: Vec<Vec3>,
    elimination: Elimination,
    state: State,
}

impl Scene {
    /// The shape around `centre` from the body's reference point, and a node at `offset` from there.
    fn new(
        ntan: usize,
        centre: Vec3,
        offset: Vec3,
        shape: impl FnOnce(Vec3) -> Box<dyn Shape>,
        random: &mut Random,
    ) -> Self {
        let ndim = ntan + 1;
        let layout = Layout::new(ndim, 1, 1);
        let flat = |v: Vec3| {
            if ndim == 2 {
                Vec3::new(v.x, v.y, 0.0)
            } else {
                v
            }
        };
        let origin = flat(random.vector());
        let body = RigidBody {
            reference: origin,
            nodes: Vec::new(),
        };
        let elimination = Elimination::new(vec![body], 1);
        let reference = vec![origin + centre + offset];
        let mut state = State::initial(&layout, &reference, &elimination);
        for _ in 0..2 {
            let base = state.clone();
            let mut du: Vec<f64> = (0..layout.ndof()).map(|_| random.signed()).collect();
            // the node goes with the body, more or less
            for axis in 0..ndim {
                du[axis] *= 0.1;
                du[layout.translation(0, axis) as usize] *= 0.1;
            }
            state.advance_from(&base, &du, 1.0, &layout, &reference, &elimination);
        }
        let pose = state.poses[0];
        let mut put = vec![0.0; layout.ndof()];
        let wanted = pose.origin + pose.rotation * (centre + offset);
        for axis in 0..ndim {
            put[axis] = wanted[axis] - state.x[0][axis];
        }
        let base = state.clone();
        state.advance_from(&base, &put, 1.0, &layout, &reference, &elimination);
        let surface = Analytical::new(Mount::on(ntan, 0, origin), shape(origin + centre)).unwrap();
        let pair = SurfacePair::new(vec![0], Arc::new(surface), 5.0);
        Self {
            pair,
            layout,
            reference,
            elimination,
            state,
        }
    }

    fn rows(&self, state: &State) -> (Rows, Pairing) {
        let at = state.placement();
        let method = PointToSegment::at_nodes(&self.pair.points);
        let pairing = pair_up(&method, &self.pair, &at, self.pair.reach);
        (first_rows(&method, &self.pair, &at, &pairing), pairing)
    }

    fn moved(&self, dof: Dof, by: f64) -> State {
        let mut du = vec![0.0; self.layout.ndof()];
        du[dof as usize] = by;
        let mut state = self.state.clone();
        state.advance_from(
            &self.state,
            &du,
            1.0,
            &self.layout,
            &self.reference,
            &self.elimination,
        );
        state
    }

    /// Compares the row with differences; the largest difference of `dweights` from its transpose.
    fn check(&self) -> f64 {
        let (rows, _) = self.rows(&self.state);
        let row = &rows.rows()[0];
        let n = rows.ncolumn();
        let mut dofs = Vec::new();
        rows.dofs(&self.layout, &mut dofs);
        let used: Vec<usize> = (0..n).filter(|&j| dofs[j] != NO_DOF).collect();
        let scale = largest(&row.dweights);
        let h = 2e-3;
        for &j in &used {
            let mut slope = 0.0;
            let mut bend = vec![0.0; n];
            for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let (there, _) = self.rows(&self.moved(dofs[j], step * h));
                let there = &there.rows()[0];
                slope += weight * there.gap / (12.0 * h);
                for (b, w) in bend.iter_mut().zip(&there.weights) {
                    *b += weight * w / (12.0 * h);
                }
            }
            let first = (slope - row.gradient[j]).abs();
            assert!(first < 1e-8, "column {j}: {first:e}");
            for &i in &used {
                let second = (bend[i] - row.dweights[i * n + j]).abs();
                assert!(second < 1e-7 * scale, "({i}, {j}): {second:e} of {scale}");
            }
        }
        self.balance(&row.weights);
        let odd = |&(i, j): &(usize, usize)| row.dweights[i * n + j] - row.dweights[j * n + i];
        let pairs = used.iter().flat_map(|&i| used.iter().map(move |&j| (i, j)));
        pairs.map(|p| odd(&p).abs()).fold(0.0, f64::max)
    }

    /// What acts on the body and on the node is in balance, moments about the reference point included.
    fn balance(&self, weights: &[f64]) {
        let part = |k: usize| Vec3::new(weights[k], weights[k + 1], weights[k + 2]);
        let (force, moment, node) = (part(0), part(3), part(6));
        assert!((force + node).max_abs() < 1e-13);
        let arm = self.state.x[0] - self.state.poses[0].origin;
        assert!((moment + arm.cross(node)).max_abs() < 1e-12);
    }
}

#[test]
fn rigid_carrier_rows_match_differences() {
    let mut random = Random::new(5);
    let (mut odd_in_space, mut inside) = (0.0f64, 0);
    for _ in 0..100 {
        let centre = random.vector();
        let direction = random.vector().normalized().unwrap();
        let sphere = |centre| -> Box<dyn Shape> {
            Box::new(Sphere::new(centre, 1.0, Side::Outside).unwrap())
        };
        let offset = direction * (1.0 + 0.4 * random.signed());
        let scene = Scene::new(2, centre, offset, sphere, &mut random);
        inside += usize::from(scene.rows(&scene.state).0.rows()[0].gap < 0.0);
        odd_in_space = odd_in_space.max(scene.check());

        let across = direction.cross(random.vector()).normalized().unwrap();
        let ring = |centre| -> Box<dyn Shape> {
            Box::new(Torus::new(centre, direction, 1.0, 0.4, Side::Outside).unwrap())
        };
        let (sin, cos) = (3.0 * random.signed()).sin_cos();
        let offset = across + (across * cos + direction * sin) * (0.4 + 0.1 * random.signed());
        Scene::new(2, centre, offset, ring, &mut random).check();

        let flat = |v: Vec3| Vec3::new(v.x, v.y, 0.0);
        let axes = [1.0 + 0.2 * random.signed(), 1.0 + 0.2 * random.signed()];
        // outside of its evolute the closest point is unique
        let size = axes[0].max(axes[1]) * (0.95 + 0.4 * random.signed().abs());
        let offset = flat(direction).normalized().unwrap() * size;
        let shape = |centre| -> Box<dyn Shape> { Box::new(ellipse(centre, axes)) };
        // a single rotation commutes with itself
        assert!(Scene::new(1, flat(centre), offset, shape, &mut random).check() < 1e-12);
    }
    assert!((20..80).contains(&inside));
    assert!(
        odd_in_space > 0.1,
        "the term of the rotation is unsymmetric"
    );
}
