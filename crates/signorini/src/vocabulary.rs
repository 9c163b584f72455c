//! Every key of a case, those of materials, surfaces, laws and loads among them.

use signorini_geometry::surface;
use signorini_io::case::vocabulary::{Kinds, Vocabulary};
use signorini_mechanics::contact::{friction, law};
use signorini_mechanics::{load, material};
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
            surfaces: surface::descriptions(),
            laws: law::descriptions(),
            frictions: friction::descriptions(),
            loads: load::descriptions(),
        })
    });
    &VOCABULARY
}
