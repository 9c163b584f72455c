//! Two blocks from plain data: a mesh, two bodies, a contact, a step.
//!
//! `cargo run --release -p signorini --example two_blocks`

mod common;

use common::{Brick, frames, moved};
use signorini::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (increment, force) in (1..).zip(press()?) {
        println!("increment {increment}: the base pushes with {:.4}", force.z);
    }
    Ok(())
}

/// The force on the secondary side after each increment.
fn press() -> Result<Vec<Vec3>, Box<dyn std::error::Error>> {
    let mut mesh = Mesh::default();
    let base = Brick::new(&mut mesh, Vec3::ZERO, Vec3::new(2.0, 2.0, 1.0), [4, 4, 2]);
    let low = Vec3::new(0.5, 0.5, 1.0);
    let punch = Brick::new(&mut mesh, low, low + Vec3::new(1.0, 1.0, 0.5), [3, 3, 2]);

    let mut press = StepPart::new("press", Increments::Fixed(4));
    press.changes = vec![
        moved(&base.at_height(&mesh, 0.0), None),
        moved(
            &punch.at_height(&mesh, 1.5),
            Some(Vec3::new(0.0, 0.0, -0.05)),
        ),
    ];
    let mut contact = ContactPart::new(
        "touch",
        SidePart::Faces(punch.faces_at(&mesh, 1.0)),
        PrimaryPart::Faces(base.faces_at(&mesh, 1.0)),
    );
    contact.friction = Some(FrictionPart::coulomb(0.2));
    let parts = Parts {
        bodies: vec![
            base.body("base", NeoHookean::new(100.0, 0.3)),
            punch.body("punch", SaintVenantKirchhoff::new(1000.0, 0.3)),
        ],
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
    fn forces_grow_and_are_symmetric() {
        let forces = press().unwrap();
        assert_eq!(forces.len(), 4);
        assert!(
            forces
                .windows(2)
                .all(|pair| pair[1].z > pair[0].z && pair[0].z > 0.0)
        );
        let across = |f: &Vec3| f.x.abs().max(f.y.abs());
        assert!(forces.iter().all(|f| across(f) < 1e-6 * f.z), "{forces:?}");
    }
}
