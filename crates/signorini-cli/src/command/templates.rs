//! The cases to start from: copies of examples, because a package holds no file from outside its folder.

/// A case to start from.
pub struct Template {
    /// What users call it.
    pub name: &'static str,
    /// What it shows, in one line.
    pub about: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// All of them; the first one is the default.
pub const TEMPLATES: [Template; 4] = [
    Template {
        name: "paper-brick",
        about: "a rigid tip is pressed into one brick, on a symmetry axis of its top",
        text: include_str!("templates/paper_brick_symmetric_3d.toml"),
    },
    Template {
        name: "paper-wedge",
        about: "a rigid tip is pressed into one wedge",
        text: include_str!("templates/paper_wedge_3d.toml"),
    },
    Template {
        name: "paper-brick-arbitrary",
        about: "the same brick, the tip anywhere on its top",
        text: include_str!("templates/paper_brick_arbitrary_3d.toml"),
    },
    Template {
        name: "two-blocks",
        about: "one block is pressed on another, in the plane",
        text: include_str!("templates/two_blocks_2d.toml"),
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
    fn every_template_is_the_case_of_an_example() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folders = std::fs::read_dir(root.join("examples")).unwrap();
        // the first line of an example names a schema that lies in the repository
        let own = |case: String| case.split_inclusive('\n').skip(1).collect::<String>();
        let read = |entry: std::fs::DirEntry| {
            std::fs::read_to_string(entry.path().join("case.toml")).map(own)
        };
        // scripts in Python have no case
        let cases: Vec<String> = folders.flat_map(|entry| read(entry.unwrap())).collect();
        for template in &TEMPLATES {
            assert!(
                cases.iter().any(|case| case == template.text),
                "{} is not the case of any example",
                template.name
            );
        }
    }

    #[test]
    fn templates_are_found_with_underscores_too() {
        assert_eq!(find("Paper_Brick").unwrap().name, "paper-brick");
        assert!(find("hertz-").is_none());
        assert!(unknown("paper-bric").contains("did you mean paper-brick?"));
    }
}
