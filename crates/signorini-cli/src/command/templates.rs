//! The cases to start from.

/// A case to start from.
pub struct Template {
    /// What users call it.
    pub name: &'static str,
    /// What it shows, in one line.
    pub about: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! example {
    ($folder:literal) => {
        include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../examples/",
            $folder,
            "/case.toml"
        ))
    };
}

/// All of them; the first one is the default.
pub const TEMPLATES: [Template; 4] = [
    Template {
        name: "paper-brick",
        about: "a rigid tip is pressed into one brick, on a symmetry axis of its top",
        text: example!("paper_brick_symmetric_3d"),
    },
    Template {
        name: "paper-wedge",
        about: "a rigid tip is pressed into one wedge",
        text: example!("paper_wedge_3d"),
    },
    Template {
        name: "paper-brick-arbitrary",
        about: "the same brick, the tip anywhere on its top",
        text: example!("paper_brick_arbitrary_3d"),
    },
    Template {
        name: "two-blocks",
        about: "one block is pressed on another, in the plane",
        text: example!("two_blocks_2d"),
    },
];

/// The template of a name; hyphens and underscores are the same.
pub fn find(name: &str) -> Option<&'static Template> {
    let wanted = name.to_lowercase().replace('_', "-");
    TEMPLATES.iter().find(|template| template.name == wanted)
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

    #[test]
    fn every_template_is_a_case_without_warnings() {
        for template in &TEMPLATES {
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
    fn templates_are_found_with_underscores_too() {
        assert_eq!(find("Paper_Brick").unwrap().name, "paper-brick");
        assert!(find("hertz-").is_none());
        assert!(unknown("paper-bric").contains("did you mean paper-brick?"));
    }
}
