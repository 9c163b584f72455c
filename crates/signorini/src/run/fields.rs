//! Which fields are written, and into which files: the words of `[output]`.

use signorini_io::case::Output;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, closest, codes};

/// The fields asked for; displacements and reactions are always written.
///
/// A field that a model does not have (no plasticity, no temperatures) is left away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fields {
    /// Stresses.
    pub stress: bool,
    /// Strains.
    pub strain: bool,
    /// Principal stresses.
    pub principal_stress: bool,
    /// The equivalent stress.
    pub von_mises: bool,
    /// Equivalent plastic strains.
    pub plastic_strain: bool,
    /// Temperatures.
    pub temperature: bool,
    /// Pressures and forces of contact.
    pub contact: bool,
}

/// The files that frames go to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Formats {
    /// `frames/*.vtu`, with the lists of them.
    pub vtu: bool,
    /// `NAME.frd`.
    pub frd: bool,
}

impl Formats {
    /// What a case asks for.
    pub fn new(output: &Output) -> Self {
        let has = |name: &str| output.format.iter().any(|word| word.as_str() == name);
        Self {
            vtu: has("vtu"),
            frd: has("frd"),
        }
    }
}

/// A word of a case, and what it chooses.
type Word = (&'static str, fn(&mut Fields));

/// All words in the order in which messages list them. `stress` brings what follows from it.
const WORDS: [Word; 12] = [
    ("displacement", |_| {}),
    ("reaction_force", |_| {}),
    ("stress", all_of_stress),
    ("cauchy_stress", all_of_stress),
    ("strain", |f| f.strain = true),
    ("principal_stress", |f| f.principal_stress = true),
    ("principal", |f| f.principal_stress = true),
    ("von_mises", |f| f.von_mises = true),
    ("plastic_strain", |f| f.plastic_strain = true),
    ("temperature", |f| f.temperature = true),
    ("contact", |f| f.contact = true),
    ("contact_pressure", |f| f.contact = true),
];

fn all_of_stress(fields: &mut Fields) {
    fields.stress = true;
    fields.principal_stress = true;
    fields.von_mises = true;
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
            match WORDS.iter().find(|(name, _)| *name == word.as_str()) {
                Some((_, choose)) => choose(&mut fields),
                None => {
                    let names = WORDS.map(|(name, _)| name);
                    let remark = closest(word, names).map_or_else(
                        || "no such field".into(),
                        |w| format!("did you mean \"{w}\"?"),
                    );
                    found.push(
                        Diagnostic::error(
                            &codes::NOT_A_CHOICE,
                            format!("\"{}\" is not a field", word.value),
                        )
                        .at(&word.place, remark)
                        .note(format!("fields: {}", names.join(", "))),
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
