//! The program of README.md.

use signorini::prelude::*;
use signorini::{Diagnostics, Reading, build, load};

/// The force on the tip of a brick for several moduli, without a file written.
fn main() -> Result<(), Diagnostics> {
    for modulus in ["250", "500"] {
        let set = vec![("material.soft.E".to_owned(), modulus.to_owned())];
        let reading = Reading {
            set,
            ..Reading::default()
        };
        let path = "examples/paper_brick_symmetric_3d/case.toml";
        let loaded = load(path.as_ref(), &reading)?;
        let mut model = build(loaded.case, loaded.mesh)?;
        let mut stepper = Stepper::new(&model.system, model.settings);
        let mut force = 0.0;
        let mut watch = |event: &Event<'_>| {
            if let Event::Increment { frame, .. } = event {
                force = frame.contacts.iter().map(|c| c.secondary.force.z).sum();
            }
            Flow::Continue
        };
        match stepper.run(&mut model.system, &model.steps, &mut watch) {
            Ok(_) => println!("E = {modulus} MPa: {force:.4} MN"),
            Err(error) => println!("E = {modulus} MPa: {error}"),
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    #[test]
    fn the_program_of_the_front_page_runs() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        std::env::set_current_dir(root).unwrap();
        super::main().unwrap();
    }
}
