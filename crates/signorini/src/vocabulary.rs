//! Every key of a case, those of materials and laws among them.

use signorini_io::case::vocabulary::{Kinds, Vocabulary};
use signorini_mechanics::contact::{friction, law};
use signorini_mechanics::material;
use std::sync::LazyLock;

/// The vocabulary of this program.
///
/// # Example
/// ```
/// use signorini::vocabulary;
/// use signorini_io::case::read_case;
///
/// let wrong = b"mesh = { file = \"a.msh\" }\nbody = [{ group = \"a\", materiel = \"steel\" }]\n";
/// let faults = read_case("case.toml", wrong, &[], vocabulary()).unwrap_err();
/// assert!(faults.plain().contains("did you mean `material`?"));
/// ```
pub fn vocabulary() -> &'static Vocabulary {
    static VOCABULARY: LazyLock<Vocabulary> = LazyLock::new(|| {
        Vocabulary::new(Kinds {
            materials: material::descriptions(),
            laws: law::descriptions(),
            frictions: friction::descriptions(),
        })
    });
    &VOCABULARY
}
