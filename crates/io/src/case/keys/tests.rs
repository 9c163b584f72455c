use super::*;
use crate::case::read_case;
use crate::case::tests::vocabulary;
use crate::diagnostic::codes;

fn found(query: &str) -> Found {
    find(vocabulary(), query).unwrap_or_else(|near| panic!("{query}: {near:?}"))
}

#[test]
fn keys_are_found_by_their_path_its_end_and_their_words() {
    for (query, path) in [
        ("contact.enforcement", "contact.enforcement"),
        ("[[contact]]", "contact"),
        ("enforcement.penalty", "contact.enforcement.penalty"),
        ("friction", "contact.friction"),
        ("material.steel.density", "material.NAME.density"),
        ("material.NAME.density", "material.NAME.density"),
        ("step.move.UZ", "step.move.uz"),
        ("mortar", "contact.method"),
    ] {
        assert_eq!(found(query).key.path, path, "{query}");
    }
    let friction = found("friction");
    assert_eq!(
        friction.others,
        ["contact.pair.friction", "step.contact.friction"]
    );
    assert_eq!(friction.key.default.as_deref(), Some("0.0"));
    assert!(
        friction
            .key
            .keys
            .iter()
            .any(|(name, _)| *name == "stiffness")
    );
}

#[test]
fn unknown_keys_are_answered_by_the_nearest_one() {
    let near = |query: &str| find(vocabulary(), query).unwrap_err();
    assert_eq!(
        near("contact.enforcment").as_deref(),
        Some("contact.enforcement")
    );
    assert_eq!(near("secundary").as_deref(), Some("secondary"));
    assert_eq!(near("no such thing at all"), None);
    assert_eq!(near(""), None);
}

#[test]
fn every_key_is_explained_with_an_example_that_reads() {
    let all = paths(vocabulary());
    assert!(all.len() > 200, "{}", all.len());
    let mut wrong = Vec::new();
    for path in all {
        let info = found(&path).key;
        assert_eq!(info.path, path);
        let text = info.text();
        assert!(
            text.contains(&info.meaning) && text.contains("Example"),
            "{path}"
        );
        if info.later.is_some() || info.form == "nothing yet" {
            continue;
        }
        let of_text = |id: &str| {
            [
                codes::SYNTAX.id,
                codes::UNKNOWN_KEY.id,
                codes::WRONG_TYPE.id,
                codes::OUT_OF_RANGE.id,
                codes::NOT_A_CHOICE.id,
                codes::WRONG_LENGTH.id,
                codes::NOT_BUILT.id,
                codes::NOT_FINITE.id,
            ]
            .contains(&id)
        };
        if let Err(faults) = read_case("example.toml", info.example.as_bytes(), &[], vocabulary()) {
            let faults: Vec<String> = faults
                .iter()
                .filter(|one| of_text(one.code.id))
                .map(|one| one.message.clone())
                .collect();
            if !faults.is_empty() {
                wrong.push(format!("{path}: {faults:?}\n{}", info.example));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
