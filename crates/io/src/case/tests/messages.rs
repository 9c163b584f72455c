//! What is wrong with a text is reported with its place, its cause and a remedy.

use super::faults::faults;
use super::options::WRONG_OPTIONS;
use super::*;
use std::fmt::Write as _;

const MESSAGES: &str = include_str!("../cases/messages.txt");

#[test]
fn sets_that_contain_themselves_are_found_however_long_the_way() {
    let sets = |text: &str| brick("[sets]", &format!("[sets]\n{text}"));
    assert_eq!(
        codes_of(&sets("a = { union = [\"base\", \"a\"] }")),
        ["S0112"]
    );
    let chain: String = (0..20_000)
        .map(|n| format!("a{n} = {{ union = [\"top\", \"a{}\"] }}\n", n + 1))
        .collect();
    assert!(read(&sets(&chain)).is_ok());
    assert_eq!(
        codes_of(&sets(&format!("{chain}a20000 = {{ union = [\"a7\"] }}"))),
        ["S0112"]
    );
    let all = read(&sets(
        "d = { union = [\"b\"] }\nb = { union = [\"base\", \"c\"] }\nc = { union = [\"b\"] }",
    ))
    .unwrap_err();
    assert!(all.plain().contains("the last the first: c, b"), "{all}");
}

fn messages() -> String {
    let mut text = String::new();
    let mut write_down = |name: &str, result: Result<(Case, Diagnostics), Diagnostics>| {
        let (head, all) = match result {
            Ok((_, warnings)) => ("read, with warnings", warnings),
            Err(all) => ("exit code 3", all),
        };
        assert_eq!(
            all.exit_code(),
            (head == "exit code 3").then_some(3),
            "{name}"
        );
        assert!(!all.is_empty(), "{name} says nothing");
        let _ = write!(text, "==== {name}: {head}\n\n{}", all.plain());
    };
    for (name, bytes) in faults() {
        write_down(name, read_case("case.toml", &bytes, &[], vocabulary()));
    }
    for (path, value) in WRONG_OPTIONS {
        write_down(
            &format!("--set {path}={value}"),
            read_with(PAPER_BRICK, path, value),
        );
    }
    text
}

/// Compares with `cases/messages.txt`; with `SIGNORINI_BLESS=1` in the environment that file is written again.
#[test]
fn messages_say_what_where_and_what_to_do() {
    let found = messages();
    if std::env::var_os("SIGNORINI_BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/case/cases/messages.txt");
        std::fs::write(path, &found).unwrap();
        return;
    }
    let sections = |text: &str| text.split("==== ").map(str::to_owned).collect::<Vec<_>>();
    for (found, expected) in sections(&found).iter().zip(&sections(MESSAGES)) {
        assert_eq!(found, expected);
    }
    assert_eq!(found, MESSAGES);
}

#[test]
fn every_code_about_text_is_provoked() {
    for code in codes::ALL
        .iter()
        .filter(|code| code.id.starts_with("S01") || code.id.starts_with("S04"))
    {
        let of_runs = [
            "S0411", "S0412", "S0413", "S0414", "S0415", "S0416", "S0418", "S0419", "S0421",
            "S0422", "S0423", "S0424", "S0425", "S0426", "S0427", "S0428", "S0429", "S0430",
            "S0431", "S0432", "S0436", "S0437", "S0438", "S0439",
        ];
        let elsewhere =
            ["S0121", "S0122", "S0404", "S0405"].contains(&code.id) || of_runs.contains(&code.id);
        assert!(
            elsewhere || MESSAGES.contains(&format!("[{}]", code.id)),
            "{}",
            code.id
        );
    }
}

#[test]
fn a_fault_does_not_draw_others_after_it() {
    assert_eq!(codes_of(&brick("[[contact]]", "[contact]")), ["S0107"]);
    assert_eq!(
        codes_of(&brick("[1, 2, 3, 4] }", "[1, 2, 3, 4 }")),
        ["S0104"]
    );
    assert_eq!(
        codes_of(&brick("material = \"soft\"", "material = soft")),
        ["S0104"]
    );
    assert_eq!(codes_of(&brick("nu    = 0.0", "nu = 0,3")), ["S0115"]);
    assert_eq!(codes_of(&brick("tip_node = {", "brick = {")), ["S0113"]);
    assert_eq!(codes_of(&brick("nu    = 0.0", "nuu   = 0.0")), ["S0102"]);
    assert_eq!(
        codes_of(&brick("rigid    = true", "rigit    = true")),
        ["S0102"]
    );
}

#[test]
fn errors_of_all_stages_come_together_in_the_order_of_the_text() {
    let text = brick("nu    = 0.0", "nu = 0,3\nrho = 1.0")
        .replace("\"soft\"", "\"sotf\"")
        .replace("fixed = 60", "fixed = 0")
        .replace("node = 5", "node = 5.5");
    assert_eq!(
        codes_of(&text),
        ["S0115", "S0102", "S0114", "S0109", "S0107"]
    );
}
