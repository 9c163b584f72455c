//! What a run says of joints that broke with viscosity.

use crate::text::short;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// The part of the energy of damage that viscosity may take.
const VISCOUS: f64 = 0.01;

/// A warning for each joint whose viscosity took too much: its name, and the energies that damage and viscosity took.
pub(super) fn warnings(torn: &[(String, [f64; 2])]) -> Diagnostics {
    let mut found = Diagnostics::new();
    for (name, [damage, viscous]) in torn {
        if *viscous <= VISCOUS * damage {
            continue;
        }
        let text = format!(
            "contact \"{name}\": the viscosity of its joint took {}, and damage {}",
            short(*viscous),
            short(*damage)
        );
        let one = Diagnostic::warning(&codes::VISCOUS_JOINT, text)
            .note("more than 1 %: forces are those of a tougher joint")
            .help(format!(
                "a smaller `viscosity` in  cohesive = {{ .. }}  of contact \"{name}\", or smaller facets and none"
            ));
        found.push(one);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::warnings;

    #[test]
    fn viscosity_may_take_one_percent() {
        let torn = |viscous| vec![("glue".to_owned(), [2.0, viscous])];
        assert!(warnings(&torn(0.019)).is_empty());
        let text = format!("{:?}", warnings(&torn(0.03)));
        assert!(text.contains("glue") && text.contains("0.03"), "{text}");
    }
}
