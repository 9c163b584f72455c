//! Surfaces carried by rigid bodies: rows against differences under rotations that compose.

use super::super::discretization::{Pairing, PointToSegment, SurfacePair};
use super::super::row::Rows;
use super::{Random, first_rows, largest, pair_up};
use crate::system::{Dof, Elimination, Layout, NO_DOF, RigidBody, State};
use signorini_geometry::element::Element;
use signorini_geometry::proximity::Aabb;
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Outward, Placement, Projection, SurfaceError, SurfaceJet,
};
use signorini_geometry::surface::{Feature, Pose};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// A sphere in space or an ellipse in the plane, off the reference point of rigid body 0. Points of the sphere are
/// kept in the body frame, points of the ellipse as its parameter φ.
pub(crate) enum Round {
    Sphere { centre: Vec3, radius: f64 },
    Ellipse { centre: Vec3, axes: [f64; 2] },
}

impl Round {
    fn pose(at: &Placement) -> Pose {
        at.poses[0]
    }

    fn centre(&self) -> Vec3 {
        match self {
            Self::Sphere { centre, .. } | Self::Ellipse { centre, .. } => *centre,
        }
    }

    /// The parameter of the point of an ellipse closest to `p`, a point in its own frame: the best of many, then
    /// Newton on `(p − ρ)·ρ' = 0`.
    fn parameter([a, b]: [f64; 2], p: Vec3) -> f64 {
        let rho = |f: f64| Vec3::new(a * f.cos(), b * f.sin(), 0.0);
        let tangent = |f: f64| Vec3::new(-a * f.sin(), b * f.cos(), 0.0);
        let many = (0..64).map(|k| f64::from(k) * std::f64::consts::TAU / 64.0);
        let nearer = |f: &f64, g: &f64| (p - rho(*f)).norm().total_cmp(&(p - rho(*g)).norm());
        let mut f = many.min_by(nearer).unwrap();
        for _ in 0..20 {
            let (w, t) = (p - rho(f), tangent(f));
            f += w.dot(t) / (t.dot(t) + w.dot(rho(f)));
        }
        f
    }
}

impl ContactSurface for Round {
    fn ntan(&self) -> usize {
        match self {
            Self::Sphere { .. } => 2,
            Self::Ellipse { .. } => 1,
        }
    }

    fn nfacet(&self) -> usize {
        1
    }

    fn carrier(&self, _: u32) -> Carrier<'_> {
        Carrier::Rigid(0)
    }

    fn aabb(&self, at: &Placement, facet: u32) -> Aabb {
        let pose = Self::pose(at);
        let centre = pose.origin + pose.rotation * self.centre();
        Aabb::around([centre]).inflated(self.size(at, facet))
    }

    fn size(&self, _: &Placement, _: u32) -> f64 {
        match self {
            Self::Sphere { radius, .. } => *radius,
            Self::Ellipse { axes, .. } => axes[0].max(axes[1]),
        }
    }

    fn jet(
        &self,
        at: &Placement,
        point: &Anchor,
        out: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        let pose = Self::pose(at);
        *out = SurfaceJet::default();
        match self {
            Self::Sphere { centre, radius } => {
                out.position = pose.origin + pose.rotation * point.local;
                out.normal = pose.rotation * (point.local - *centre) / *radius;
                let across = Vec3::unit(usize::from(out.normal.x.abs() > 0.5));
                let t = across.cross(out.normal).normalized().unwrap();
                // geodesics: orthonormal tangents and a curvature that is all normal; t1 is stretched for good measure
                out.tangent = [t * 2.0, out.normal.cross(t)];
                let bend = out.normal / -*radius;
                out.curvature = [bend * 4.0, bend, Vec3::ZERO];
                out.metric = [4.0, 1.0, 0.0];
            }
            Self::Ellipse {
                centre,
                axes: [a, b],
            } => {
                let (s, c) = point.local.x.sin_cos();
                let arm = Vec3::new(a * c, b * s, 0.0);
                let t = pose.rotation * Vec3::new(-a * s, b * c, 0.0);
                out.position = pose.origin + pose.rotation * (*centre + arm);
                out.tangent[0] = t;
                out.normal = t.cross(Vec3::unit(2)) / t.norm();
                out.curvature[0] = -(pose.rotation * arm);
                out.metric[0] = t.dot(t);
            }
        }
        Ok(())
    }

    fn domain(&self, _: u32) -> Option<Element> {
        None
    }

    fn neighbours(&self, _: u32) -> &[u32] {
        &[]
    }

    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        let mut jet = SurfaceJet::default();
        self.jet(at, &found.anchor, &mut jet)?;
        Ok(Outward {
            direction: jet.normal,
            rim: false,
        })
    }

    fn project(
        &self,
        at: &Placement,
        facet: u32,
        point: Vec3,
        _: Option<Anchor>,
        out: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        let pose = Self::pose(at);
        let body = pose.rotation.transpose() * (point - pose.origin);
        let away = body - self.centre();
        let local = match self {
            Self::Sphere { centre, radius } => {
                let Some(direction) = away.normalized() else {
                    return Ok(None);
                };
                *centre + direction * *radius
            }
            Self::Ellipse { axes, .. } => Vec3::new(Self::parameter(*axes, away), 0.0, 0.0),
        };
        let anchor = Anchor { facet, local };
        self.jet(at, &anchor, out)?;
        Ok(Some(Projection {
            anchor,
            feature: Feature::Face,
            distance: (point - out.position).norm(),
        }))
    }
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
    fn new(surface: Round, random: &mut Random) -> Self {
        let ndim = surface.ntan() + 1;
        let layout = Layout {
            ndim,
            nnode: 1,
            nrigid: 1,
            nmultiplier: 0,
        };
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
        let direction = flat(random.vector()).normalized().unwrap();
        let mut size = 1.0 + 0.4 * random.signed();
        if let Round::Ellipse { axes, .. } = &surface {
            // outside of its evolute the closest point is unique
            size = axes[0].max(axes[1]) * (0.95 + 0.4 * random.signed().abs());
        }
        let reference = vec![origin + surface.centre() + direction * size];
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
        let centre = state.poses[0].origin + state.poses[0].rotation * surface.centre();
        let mut put = vec![0.0; layout.ndof()];
        let wanted = centre + state.poses[0].rotation * direction * size;
        for axis in 0..ndim {
            put[axis] = wanted[axis] - state.x[0][axis];
        }
        let base = state.clone();
        state.advance_from(&base, &put, 1.0, &layout, &reference, &elimination);
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
        let sphere = Round::Sphere {
            centre: random.vector(),
            radius: 1.0,
        };
        let scene = Scene::new(sphere, &mut random);
        inside += usize::from(scene.rows(&scene.state).0.rows()[0].gap < 0.0);
        odd_in_space = odd_in_space.max(scene.check());

        let centre = random.vector();
        let ellipse = Round::Ellipse {
            centre: Vec3::new(centre.x, centre.y, 0.0),
            axes: [1.0 + 0.2 * random.signed(), 1.0 + 0.2 * random.signed()],
        };
        // a single rotation commutes with itself
        assert!(Scene::new(ellipse, &mut random).check() < 1e-12);
    }
    assert!((20..80).contains(&inside));
    assert!(
        odd_in_space > 0.1,
        "the term of the rotation is unsymmetric"
    );
}
