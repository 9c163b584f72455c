use crate::support::{BRICK, change, folder_with, run, run_text};

#[test]
fn an_empty_file_is_called_empty() {
    run_text("").says(3, &["is empty", "signorini init"]);
    run_text("# only a comment\n\n").says(3, &["is empty"]);
}

#[test]
fn a_missing_file_and_a_directory_are_named() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "other.toml"]).says(3, &["other.toml", "the current directory is"]);
    run(folder.path(), &["run", "."]).says(3, &["is a directory"]);
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let folder = folder_with("");
    std::fs::write(folder.path().join("case.toml"), b"title = \"a\0b\"").unwrap();
    run(folder.path(), &["run", "case.toml"]).says(3, &["is not text"]);
}

#[test]
fn other_encodings_are_read_or_named() {
    let folder = folder_with("");
    let path = folder.path().join("case.toml");
    let wide: Vec<u8> = BRICK.encode_utf16().flat_map(u16::to_le_bytes).collect();
    std::fs::write(&path, wide).unwrap();
    run(folder.path(), &["run", "case.toml"]).says(3, &["UTF-16"]);
    std::fs::write(&path, format!("\u{feff}{}", BRICK.replace('\n', "\r\n"))).unwrap();
    run(folder.path(), &["check", "case.toml"]).says(0, &[]);
}

#[test]
fn an_unknown_key_is_met_with_a_proposal() {
    let text = change(BRICK, "secondary =", "secundary =");
    run_text(&text).says(
        3,
        &["error[S0102]", "did you mean `secondary`?", "case.toml:"],
    );
}

#[test]
fn wrong_values_are_shown_where_they_stand() {
    for (from, to, words) in [
        ("E = 500.0", "E = \"five\"", &["S0107", "case.toml:"][..]),
        ("E = 500.0", "E = nan", &["S0108", "finite"]),
        ("E = 500.0", "E = 500,0", &["S01"]),
        ("nu = 0.0", "nu = 0.0\nnu = 0.1", &["S0105", "nu"]),
        ("E = 500.0\n", "", &["S0106", "`E`"]),
    ] {
        run_text(&change(BRICK, from, to)).says(3, words);
    }
}

#[test]
fn a_reference_to_nothing_is_met_with_what_there_is() {
    let text = change(BRICK, "primary = \"top\"", "primary = \"topp\"");
    run_text(&text).says(3, &["\"topp\"", "did you mean"]);
    let text = change(BRICK, "material = \"soft\"", "material = \"softt\"");
    run_text(&text).says(3, &["softt", "soft"]);
    let other = "[[step.contact]]\nname = \"tap\"\nactive = false\n[checkpoint]";
    let text = change(BRICK, "[checkpoint]", other);
    run_text(&text).says(3, &["S0114", "did you mean \"tip\"?"]);
}

#[test]
fn two_things_of_one_name_are_refused() {
    let text = change(BRICK, "[[body]]", "[[step]]\nname = \"press\"\n[[body]]");
    run_text(&text).says(3, &["S0113"]);
}

#[test]
fn a_case_cut_off_anywhere_is_never_solved() {
    let at: Vec<usize> = BRICK
        .match_indices(['[', '=', '"'])
        .map(|(at, _)| at)
        .collect();
    let end = BRICK.find("[[step.move]]").unwrap();
    for at in at.iter().filter(|at| **at < end).step_by(17) {
        let ended = run_text(&BRICK[..*at]);
        assert!(matches!(ended.code, Some(3 | 4)), "{at}: {ended:?}");
    }
}

#[test]
fn nesting_without_end_is_refused_at_once() {
    let text = format!("{BRICK}\nx = {}", "[".repeat(1000));
    run_text(&text).says(3, &["S0118"]);
}

#[test]
fn spaces_and_letters_of_all_languages_work() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("Größe 漢字");
    std::fs::create_dir(&inner).unwrap();
    let text = BRICK.replace("\"brick\"", "\"Klötzchen 1\"");
    std::fs::write(inner.join("mein Fall.toml"), text).unwrap();
    run(folder.path(), &["run", "Größe 漢字/mein Fall.toml"])
        .says(0, &["mein Fall.out/results.pvd"]);
    assert!(inner.join("mein Fall.out/frames/volume_0004.vtu").exists());
}

#[test]
fn values_out_of_range_are_told_their_range() {
    for (from, to, words) in [
        ("fixed = 4", "fixed = 0", &["S0109", "at least 1"][..]),
        ("fixed = 4", "initial = 0.1, min = 0.5, max = 0.2", &["min"]),
        ("E = 500.0", "E = -1.0", &["S0109", "greater than 0"]),
        ("nu = 0.0", "nu = 0.5", &["S0109", "less than 0.5"]),
        (
            "penalty = 1e5",
            "penalty = 0.0",
            &["S0109", "greater than 0"],
        ),
        (
            "primary = \"top\"",
            "primary = \"top\"\nfriction = -0.1",
            &["S0109", "at least 0"],
        ),
        (
            "penalty = 1e5",
            "penalty = [[-1, 5], [-1, 0]]",
            &["S0117", "-1 comes after -1"],
        ),
    ] {
        run_text(&change(BRICK, from, to)).says(3, words);
    }
}

#[test]
fn what_is_asked_to_be_written_is_checked_before_anything_is_solved() {
    for (asked, words) in [
        (
            "[output]\nfields = [\"stres\"]",
            &["did you mean \"stress\"?"][..],
        ),
        (
            "[[output.history]]\nname = \"a\"\nquantity = \"force_q\"\ncontact = \"tip\"",
            &["is not a quantity", "force_x"],
        ),
        (
            "[[output.history]]\nname = \"a\"\nquantity = \"displacement.z\"\nnode = 99",
            &["the mesh has no node 99"],
        ),
        (
            "[[expect]]\nwhat = \"tip.force_w\"\nvalue = 1.0\ntol = { rel = 0.1 }",
            &["there is no column \"tip.force_w\""],
        ),
        (
            "[[expect]]\nwhat = \"displacement.z @ knot 5\"\nvalue = 1.0\ntol = { rel = 0.1 }",
            &["@ node 5"],
        ),
    ] {
        run_text(&format!("{BRICK}\n{asked}\n")).says(3, words);
    }
}

#[test]
fn set_changes_a_value_and_says_when_it_names_nothing() {
    let folder = folder_with(BRICK);
    run(
        folder.path(),
        &["run", "case.toml", "--set", "step.press.increments.fixed=2"],
    )
    .says(0, &["2 increments"]);
    run(
        folder.path(),
        &["run", "case.toml", "--set", "step.press.incremnts=2"],
    )
    .says(3, &["S0120", "did you mean"]);
}
