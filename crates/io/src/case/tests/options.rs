//! Options replace values of a case.

use super::*;

/// The options of `--set` that name nothing, or give a wrong value.
pub(super) const WRONG_OPTIONS: &[(&str, &str)] = &[
    ("material.sotf.E", "2000"),
    ("contact.tap.reach", "1.0"),
    ("solver.newton.max_iteratons", "30"),
    ("solver.newton.max_iterations", "many"),
    ("step.5.duration", "1.0"),
    ("step..duration", "1.0"),
    ("material.soft.E", "0,3"),
    ("contact.tip.enforcement.penalty", "-1"),
];

#[test]
fn options_change_the_case() {
    let changed = |path: &str, value: &str| {
        read_with(PAPER_BRICK, path, value)
            .unwrap_or_else(|all| panic!("{all}"))
            .0
    };
    assert_eq!(
        changed("material.soft.E", "2000").materials[0].number("E"),
        Some(2000.0)
    );
    assert_eq!(changed("title", "two words").title, "two words");
    assert_eq!(changed("title", "\"two words\"").title, "two words");
    assert_eq!(
        changed("contact.tip.reach", "0.5").contacts[0].reach,
        Some(0.5)
    );
    assert_eq!(
        changed("step.press.increments", "20").steps[0].increments,
        Increments::Count(20)
    );
    assert_eq!(
        changed("step.press.increments.fixed", "20").steps[0].increments,
        Increments::Fixed(20)
    );
    assert_eq!(changed("step.0.duration", "2").steps[0].duration, 2.0);
    assert_eq!(
        changed("step.press.move.tool.uz", "-0.5").steps[0].moves[0].u[2],
        Some(Motion::Ramp(-0.5))
    );
    assert_eq!(
        changed("solver.newton.force_tol", "1e-10")
            .solver
            .newton
            .force_tol,
        1e-10
    );
    assert_eq!(
        changed("output.every.time", "0.1").output.every,
        Every::Time(0.1)
    );
    assert_eq!(
        changed("sets.base.nodes.0", "7").sets[0].content,
        SetContent::Nodes(vec![7, 2, 3, 4])
    );
    let young = changed("material.\"soft\".E", " 7.5 ").materials[0].constants[0]
        .values
        .clone();
    assert_eq!(young.place.line().unwrap(), "line 1 of --set");
    assert_eq!(young.place.text(), Some("7.5"));
}

#[test]
fn later_options_win() {
    let set = [
        ("material.soft.E", "1"),
        (
            "material.soft",
            "{ model = \"neo-hookean\", E = 2, nu = 0.1 }",
        ),
        ("material.soft.E", "3"),
    ]
    .map(|(path, value)| (path.to_owned(), value.to_owned()));
    let (case, _) = read_case("case.toml", PAPER_BRICK.as_bytes(), &set, vocabulary()).unwrap();
    assert_eq!(case.materials[0].number("E"), Some(3.0));
    assert_eq!(case.materials[0].model.value, "neo-hookean");
}
