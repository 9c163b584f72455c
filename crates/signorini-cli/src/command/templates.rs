//! The cases to start from, each with its mesh where that is a file of its own.
//!
//! Meshes are written by `scripts/template_meshes.py`. Cases named after the paper are copies of examples, because a
//! package holds no file from outside its folder.

/// A case to start from.
pub struct Template {
    /// What users call it.
    pub name: &'static str,
    /// What it shows, in one line.
    pub about: &'static str,
    /// The file that `signorini run` takes.
    pub file: &'static str,
    /// Its text.
    pub text: &'static str,
    /// The mesh next to it: its name and its text.
    pub mesh: Option<(&'static str, &'static str)>,
}

/// A case without a file for its mesh.
macro_rules! whole {
    ($name:literal, $file:literal, $from:literal, $about:literal) => {
        Template {
            name: $name,
            about: $about,
            file: $file,
            text: include_str!(concat!("templates/", $from)),
            mesh: None,
        }
    };
}

/// A case with a mesh next to it.
macro_rules! with_mesh {
    ($name:literal, $stem:literal, $about:literal) => {
        Template {
            name: $name,
            about: $about,
            file: concat!($stem, ".toml"),
            text: include_str!(concat!("templates/", $stem, ".toml")),
            mesh: Some((
                concat!($stem, ".inp"),
                include_str!(concat!("templates/", $stem, ".inp")),
            )),
        }
    };
}

/// All of them; the first one is the default.
pub const TEMPLATES: [Template; 12] = [
    with_mesh!(
        "hertz",
        "hertz",
        "a sphere is pressed on a block: the pressure of Hertz"
    ),
    whole!(
        "paper-brick",
        "paper_brick.toml",
        "paper_brick_symmetric_3d.toml",
        "a rigid tip is pressed into one brick, on a symmetry axis of its top"
    ),
    whole!(
        "paper-wedge",
        "paper_wedge.toml",
        "paper_wedge_3d.toml",
        "a rigid tip is pressed into one wedge"
    ),
    whole!(
        "paper-brick-arbitrary",
        "paper_brick_arbitrary.toml",
        "paper_brick_arbitrary_3d.toml",
        "the same brick, the tip anywhere on its top"
    ),
    whole!(
        "two-blocks",
        "two_blocks.toml",
        "two_blocks_2d.toml",
        "one block is pressed on another, in the plane"
    ),
    with_mesh!(
        "sliding",
        "sliding",
        "a rubber block is pressed on a table and dragged over it with friction"
    ),
    with_mesh!(
        "press-fit",
        "press_fit",
        "a hub is shrunk onto a hollow shaft: Lamé's tubes"
    ),
    with_mesh!(
        "o-ring",
        "o_ring",
        "a rubber ring is squeezed between two plates, at large strain"
    ),
    with_mesh!(
        "slope",
        "slope",
        "a block rests on a slope, held by friction alone"
    ),
    with_mesh!(
        "belt",
        "belt",
        "a belt slips on a drum: the formula of Euler and Eytelwein"
    ),
    with_mesh!(
        "patch-test",
        "patch_test",
        "an even pressure goes through meshes that do not match"
    ),
    whole!(
        "deck",
        "deck.inp",
        "deck.inp",
        "a deck for CalculiX and Abaqus: one block on another"
    ),
];

/// The template of a name; hyphens and underscores are the same.
pub fn find(name: &str) -> Option<&'static Template> {
    let wanted = name.to_lowercase().replace('_', "-");
    TEMPLATES.iter().find(|template| template.name == wanted)
}

/// The smallest template that is solved at once, for trials.
pub fn smallest() -> Option<&'static Template> {
    find("paper-brick")
}

/// The message for a name that no template has.
pub fn unknown(name: &str) -> String {
    let names: Vec<&str> = TEMPLATES.iter().map(|t| t.name).collect();
    let near = signorini_io::diagnostic::closest(name, names.iter().copied());
    let hint = near.map_or_else(String::new, |n| format!("; did you mean {n}?"));
    format!(
        "there is no template \"{name}\"{hint}\n  there are: {}",
        names.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_template_is_a_case_without_warnings() {
        for template in TEMPLATES.iter().filter(|t| t.file.ends_with(".toml")) {
            let read = signorini_io::case::read_case(
                template.name,
                template.text.as_bytes(),
                &[],
                signorini::vocabulary(),
            );
            let (_, warnings) = read.unwrap();
            assert!(warnings.is_empty(), "{}: {warnings}", template.name);
        }
    }

    #[test]
    fn copies_of_examples_are_up_to_date() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for (name, example) in [
            ("paper-brick", "paper_brick_symmetric_3d"),
            ("paper-wedge", "paper_wedge_3d"),
            ("paper-brick-arbitrary", "paper_brick_arbitrary_3d"),
            ("two-blocks", "two_blocks_2d"),
        ] {
            let path = root.join("examples").join(example).join("case.toml");
            let case = std::fs::read_to_string(path).unwrap();
            // the schema lies elsewhere there
            let (schema, case) = case.split_once('\n').unwrap();
            assert!(schema.starts_with("#:schema "), "{example}");
            assert_eq!(find(name).unwrap().text, case, "{example}");
        }
    }

    #[test]
    fn templates_are_found_with_underscores_too() {
        assert_eq!(find("Paper_Brick").unwrap().name, "paper-brick");
        assert!(find("hertz-").is_none());
        assert!(unknown("paper-bric").contains("did you mean paper-brick?"));
        assert!(smallest().is_some());
    }
}
