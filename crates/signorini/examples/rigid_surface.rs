//! An own rigid surface: a paraboloid `z = (x² + y²)/2R`, which stands on its tip and is pressed into a block.
//!
//! `cargo run --release -p signorini --example rigid_surface`

mod common;

use common::{Brick, frames, moved};
use signorini::prelude::*;
use std::sync::Arc;

/// The body above `z = tip + (x² + y²)/2R`; others are below.
#[derive(Debug)]
struct Paraboloid {
    /// R: the radius of curvature at the tip.
    radius: f64,
    tip: Vec3,
}

impl Shape for Paraboloid {
    /// The closest point at the distance s from the axis solves `s + (s²/2R − z) s/R = r`, by Newton's method.
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let at = point - self.tip;
        let r = at.x.hypot(at.y);
        let out = match r > 0.0 {
            true => Vec3::new(at.x, at.y, 0.0) / r,
            false => Vec3::unit(0),
        };
        let mut s = r;
        for _ in 0..50 {
            let f = s + (s * s / (2.0 * self.radius) - at.z) * s / self.radius - r;
            let slope = 1.0 + (1.5 * s * s / self.radius - at.z) / self.radius;
            s -= f / slope;
        }
        let height = Vec3::unit(2) * (s * s / (2.0 * self.radius));
        Ok(s.is_finite().then(|| self.tip + out * s + height))
    }

    /// Points down and out; `∇ν` is that of `ν = ∇φ/|∇φ|` with `φ = (x² + y²)/2R − z`.
    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let at = on - self.tip;
        let slope = Vec3::new(at.x / self.radius, at.y / self.radius, -1.0);
        let size = slope.norm();
        let normal = slope / size;
        let across = |i: usize| Vec3::unit(i) - normal * normal[i];
        // P (∇∇φ/|∇φ|) P, for the Hessian of φ has x and y alone
        let entry = |i: usize, j: usize| {
            let (a, b) = (across(i), across(j));
            (a.x * b.x + a.y * b.y) / (self.radius * size)
        };
        let pairs = Sym3::PAIRS.map(|(i, j)| entry(i, j));
        Ok(Patch::smooth(normal, Sym3::from_pairs(pairs)))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (increment, force) in (1..).zip(press()?) {
        println!(
            "increment {increment}: the indenter pushes with {:.4}",
            force.z
        );
    }
    Ok(())
}

/// The force on the secondary side after each increment.
fn press() -> Result<Vec<Vec3>, Box<dyn std::error::Error>> {
    let mut mesh = Mesh::default();
    let block = Brick::new(&mut mesh, Vec3::ZERO, Vec3::new(1.0, 1.0, 0.5), [8, 8, 4]);
    // the tip is in the middle of the upper face at first
    let tip = Vec3::new(0.5, 0.5, 0.5);
    let shape = Paraboloid { radius: 1.0, tip };
    let surface = Analytical::new(Mount::fixed(2), Box::new(shape))?;

    let contact = ContactPart::new(
        "indent",
        SidePart::Faces(block.faces_at(&mesh, 0.5)),
        PrimaryPart::Surface(Arc::new(surface)),
    );
    let mut press = StepPart::new("press", Increments::Fixed(4));
    let floor = block.at_height(&mesh, 0.0);
    press.changes = vec![moved(&floor, Some(Vec3::new(0.0, 0.0, 0.02)))];
    let parts = Parts {
        bodies: vec![block.body("block", NeoHookean::new(1000.0, 0.3))],
        contacts: vec![contact],
        steps: vec![press],
        ..Parts::new(&mesh, Idealisation::Space)
    };
    frames(Model::assemble(parts)?, |frame| {
        frame.contacts.iter().map(|c| c.secondary.force).sum()
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn closest_points_are_along_normals_whose_gradient_matches_differences() {
        let tip = Vec3::new(0.1, -0.2, 0.3);
        let shape = Paraboloid { radius: 1.5, tip };
        for point in [Vec3::new(0.6, 0.1, 0.2), Vec3::new(-0.3, 0.5, 0.4), tip] {
            let on = shape.closest(point).unwrap().unwrap();
            let patch = shape.patch(on).unwrap();
            let apart = point - on;
            assert!((apart - patch.normal * apart.dot(patch.normal)).norm() < 1e-12);
            for axis in 0..3 {
                // a step within the surface, to first order
                let unit = Vec3::unit(axis);
                let along = unit - patch.normal * unit.dot(patch.normal);
                let h = 1e-5;
                let normal_at = |by: f64| {
                    let on = shape.closest(on + along * by).unwrap().unwrap();
                    shape.patch(on).unwrap().normal
                };
                let slope = (normal_at(h) - normal_at(-h)) / (2.0 * h);
                let exact = patch.gradient.to_mat3() * along;
                assert!((slope - exact).norm() < 1e-7, "{slope:?} {exact:?}");
            }
        }
    }

    #[test]
    fn the_force_points_down_and_grows() {
        let forces = press().unwrap();
        assert!(
            forces
                .windows(2)
                .all(|pair| pair[1].z < pair[0].z && pair[0].z < 0.0)
        );
    }
}
