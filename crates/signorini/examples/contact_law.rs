//! An own contact law: asperities that stiffen as they are pressed flat, `p = k ⟨−g⟩ + c ⟨−g⟩³`.
//!
//! `cargo run --release -p signorini --example contact_law`

mod common;

use common::{Brick, frames, moved};
use signorini::prelude::*;
use std::sync::Arc;

/// A pressure with a linear and a cubic part in the penetration.
#[derive(Debug)]
struct Asperities {
    /// k: pressure per penetration.
    linear: f64,
    /// c: pressure per cube of the penetration.
    cubic: f64,
}

impl ContactLaw for Asperities {
    fn name(&self) -> &str {
        "asperities"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            let d = (-gap).max(0.0);
            Eval {
                value: d * (self.linear + self.cubic * d * d),
                dgap: -(self.linear + 3.0 * self.cubic * d * d) * f64::from(d > 0.0),
                dlambda: 0.0,
            }
        });
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let d = (-gap).max(0.0);
        Some(d * d * (0.5 * self.linear + 0.25 * self.cubic * d * d))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (increment, force) in (1..).zip(press()?) {
        println!(
            "increment {increment}: the floor pushes with {:.4}",
            force.z
        );
    }
    Ok(())
}

/// The force on the secondary side after each increment.
fn press() -> Result<Vec<Vec3>, Box<dyn std::error::Error>> {
    let mut mesh = Mesh::default();
    let block = Brick::new(&mut mesh, Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0), [2, 2, 2]);
    let floor = Plane::new(Vec3::ZERO, Vec3::unit(2))?;
    let floor = Analytical::new(Mount::fixed(2), Box::new(floor))?;

    let mut contact = ContactPart::new(
        "rest",
        SidePart::Faces(block.faces_at(&mesh, 0.0)),
        PrimaryPart::Surface(Arc::new(floor)),
    );
    let law = Asperities {
        linear: 100.0,
        cubic: 1e7,
    };
    contact.enforcement = Enforcement::Law(Arc::new(law));
    let mut press = StepPart::new("press", Increments::Fixed(4));
    let top = block.at_height(&mesh, 1.0);
    press.changes = vec![moved(&top, Some(Vec3::new(0.0, 0.0, -0.04)))];
    let parts = Parts {
        bodies: vec![block.body("block", NeoHookean::new(1000.0, 0.0))],
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
    fn the_first_force_is_that_of_a_bar_on_a_spring() {
        // small strain: E (u - d) = k d + c d^3 with E = 1000, u = 0.01 at the end of the first increment
        let mut d = 0.01;
        for _ in 0..50 {
            let f = 1100.0 * d + 1e7 * d * d * d - 10.0;
            d -= f / (1100.0 + 3e7 * d * d);
        }
        let exact = 100.0 * d + 1e7 * d * d * d;
        let first = press().unwrap()[0].z;
        assert!(
            (first / exact - 1.0).abs() < 0.01,
            "{first} in place of {exact}"
        );
    }

    #[test]
    fn the_pressure_is_the_slope_of_the_energy() {
        let law = Asperities {
            linear: 3.0,
            cubic: 50.0,
        };
        let scale = Scale {
            penalty: 1.0,
            shear: 1.0,
            length: 1.0,
        };
        for gap in [-0.4, -0.1, 0.2] {
            let (h, energy) = (1e-5, |gap| law.energy(gap, 0.0, &scale).unwrap());
            let at = law.pressure(gap, 0.0, &scale);
            let slope = (energy(gap - h) - energy(gap + h)) / (2.0 * h);
            assert!((at.value - slope).abs() < 1e-7);
            let pressure = |gap| law.pressure(gap, 0.0, &scale).value;
            let slope = (pressure(gap + h) - pressure(gap - h)) / (2.0 * h);
            assert!((at.dgap - slope).abs() < 1e-5);
        }
    }
}
