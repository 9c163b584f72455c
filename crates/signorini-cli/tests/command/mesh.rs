use crate::support::{BRICK, change, folder_with, run, run_text};

#[test]
fn numbers_that_do_not_fit_are_named() {
    for (from, to, words) in [
        ("6, 7, 8] }", "6, 7, 99] }", &["99"][..]),
        ("[14, 0.3", "[13, 0.3", &["13"]),
        ("{ id = 2,", "{ id = 1,", &["1"]),
    ] {
        run_text(&change(BRICK, from, to)).says(3, words);
    }
}

#[test]
fn elements_without_volume_or_inside_out_make_no_model() {
    let flat = change(
        BRICK,
        "[5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1]",
        "[5, 0, 0, 0], [6, 1, 0, 0], [7, 1, 1, 0], [8, 0, 1, 0]",
    );
    run_text(&flat).says(4, &["S0211", "volume"]);
    let inverted = change(
        BRICK,
        "[1, 2, 3, 4, 5, 6, 7, 8] }",
        "[5, 6, 7, 8, 1, 2, 3, 4] }",
    );
    run_text(&inverted).says(4, &["S0211", "negative volume"]);
}

#[test]
fn a_node_twice_in_an_element_is_refused() {
    let text = change(BRICK, "6, 7, 8] }", "6, 7, 7] }");
    let ended = run_text(&text);
    assert!(matches!(ended.code, Some(3 | 4)), "{ended:?}");
    ended.says(ended.code.unwrap(), &["twice"]);
}

#[test]
fn nodes_without_elements_are_left_alone() {
    let text = change(
        BRICK,
        "[14, 0.3, 0.6, 1.8],",
        "[14, 0.3, 0.6, 1.8], [77, 5, 5, 5],",
    );
    run_text(&text).says(0, &["✓ solved"]);
}

#[test]
fn an_unknown_element_is_named() {
    let text = change(BRICK, "\"tet4\"", "\"pyramid5\"");
    run_text(&text).says(3, &["pyramid5"]);
}

#[test]
fn a_mesh_in_space_is_no_plane_model() {
    let text = change(BRICK, "[sets]", "[model]\nspace = \"plane-strain\"\n[sets]");
    let ended = run_text(&text);
    assert_eq!(ended.code, Some(3), "{ended:?}");
}

#[test]
fn groups_and_sides_that_are_not_there_are_told() {
    run_text(&change(BRICK, "\"+z\"", "\"S9\"")).says(3, &["S9"]);
    let text = change(BRICK, "primary = \"top\"", "primary = \"base\"");
    run_text(&text).says(4, &["S0312"]);
    let text = change(BRICK, "primary = \"top\"", "primary = \"tip_node\"");
    let ended = run_text(&text);
    assert!(matches!(ended.code, Some(3 | 4)), "{ended:?}");
}

#[test]
fn absurd_coordinates_are_refused() {
    let text = change(BRICK, "[7, 1, 1, 1]", "[7, 1e300, 1, 1]");
    let ended = run_text(&text);
    assert!(matches!(ended.code, Some(3 | 4)), "{ended:?}");
    ended.says(ended.code.unwrap(), &["other units"]);
}

#[test]
fn a_mesh_file_that_is_missing_cut_off_or_no_mesh_is_named() {
    let start = BRICK.find("[mesh]").unwrap();
    let end = BRICK.find("[sets]").unwrap();
    let text = format!(
        "{}[mesh]\nfile = \"part.msh\"\n{}",
        &BRICK[..start],
        &BRICK[end..]
    );
    let folder = folder_with(&text);
    let check = |words: &[&str]| {
        run(folder.path(), &["run", "case.toml"]).says(3, words);
        assert!(!folder.path().join("case.out").exists());
    };
    check(&["part.msh"]);
    for (content, word) in [
        ("", "empty"),
        ("solid part", "Gmsh"),
        (
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 99999999999 1 99999999999\n",
            "part.msh",
        ),
        ("$MeshFormat\n5.0 0 8\n$EndMeshFormat\n", "5"),
    ] {
        std::fs::write(folder.path().join("part.msh"), content).unwrap();
        check(&["part.msh", word]);
    }
}
