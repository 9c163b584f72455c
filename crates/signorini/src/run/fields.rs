//! Which fields are written: the words of `[output] fields`.

use signorini_io::case::Output;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, closest, codes};

/// The words, in the order in which messages list them.
const WORDS: [&str; 8] = [
    "displacement",
    "reaction_force",
    "stress",
    "cauchy_stress",
    "von_mises",
    "principal",
    "contact",
    "contact_pressure",
];

/// The fields asked for; displacements and reactions are always written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fields {
    /// Stresses, with what follows from them.
    pub stress: bool,
    /// The equivalent stress.
    pub von_mises: bool,
    /// Pressures and forces of contact.
    pub contact: bool,
}

impl Fields {
    /// Reads the words of a case.
    ///
    /// # Errors
    /// Words that name no field.
    pub fn new(output: &Output) -> Result<Self, Diagnostics> {
        let mut fields = Self::default();
        let mut found = Diagnostics::new();
        for word in &output.fields {
            match word.as_str() {
                "displacement" | "reaction_force" => {}
                "stress" | "cauchy_stress" | "principal" => fields.stress = true,
                "von_mises" => fields.von_mises = true,
                "contact" | "contact_pressure" => fields.contact = true,
                unknown => {
                    let remark = closest(unknown, WORDS).map_or_else(
                        || "no such field".into(),
                        |w| format!("did you mean \"{w}\"?"),
                    );
                    found.push(
                        Diagnostic::error(
                            &codes::NOT_A_CHOICE,
                            format!("\"{unknown}\" is not a field"),
                        )
                        .at(&word.place, remark)
                        .note(format!("fields: {}", WORDS.join(", "))),
                    );
                }
            }
        }
        if found.is_empty() {
            Ok(fields)
        } else {
            Err(found)
        }
    }
}
