use crate::support::{BRICK, change, run_text};

#[test]
fn f41_a_body_without_supports_is_named_with_its_motion() {
    let text = change(BRICK, "u = \"all\"", "u = [\"x\"]");
    run_text(&text).says(4, &["\"brick\"", "free", "S0302"]);
}

#[test]
fn f44_two_motions_of_one_node_clash() {
    let more = "[[step.move]]\non = \"base\"\nux = 0.1\n[checkpoint]";
    run_text(&change(BRICK, "[checkpoint]", more)).says(4, &["S0305", "node 1", "case.toml:"]);
}

#[test]
fn f45_a_surface_against_itself_is_refused() {
    let text = change(BRICK, "secondary = \"tip_node\"", "secondary = \"top\"");
    let ended = run_text(&text);
    assert!(matches!(ended.code, Some(3 | 4)), "{ended:?}");
    ended.says(ended.code.unwrap(), &["top"]);
}

#[test]
fn f45_a_pair_in_two_contacts_is_warned_of() {
    let second =
        "[[contact]]\nname = \"again\"\nsecondary = \"tip_node\"\nprimary = \"top\"\n[[step]]";
    let text = change(BRICK, "[[step]]", second);
    run_text(&text).says(0, &["warning[S0407]", "are of one pair", "case.toml:"]);
    let silenced = run_text(&format!("allow = [\"S0407\"]\n{text}"));
    assert!(!silenced.says(0, &[]).err.contains("S0407"));
}

#[test]
fn what_a_contact_says_reaches_the_solver() {
    let per_node = "enforcement = { penalty = 1e5, per = \"node\" }";
    let force = |enforcement: &str, keys: &str| {
        let text = change(BRICK, per_node, &format!("{enforcement}\n{keys}"));
        let folder = crate::support::folder_with(&text);
        crate::support::run(folder.path(), &["run", "case.toml"]).says(0, &["✓ solved"]);
        let history = crate::support::read(&crate::support::result(&folder, "history.csv"));
        let rows: Vec<Vec<&str>> = history
            .lines()
            .map(|row| row.split(',').collect())
            .collect();
        let column = rows[0].iter().position(|name| *name == "tip.force_z");
        rows.last().unwrap()[column.unwrap()]
            .parse::<f64>()
            .unwrap()
    };
    let soft = force(per_node, "");
    let table = "enforcement = { penalty = [[-1, 1e5], [0, 0]], per = \"node\" }";
    let same = force(table, "");
    assert!((same / soft - 1.0).abs() < 1e-9, "{soft} {same}");
    let hard = force("enforcement = { lagrange = {} }", "");
    assert!(hard > soft && hard < 1.1 * soft, "{soft} {hard}");
}

#[test]
fn f46_sides_that_share_nodes_are_glued() {
    let text = change(
        BRICK,
        "tip_node = { nodes = [11] }",
        "tip_node = { nodes = [7, 11] }",
    );
    run_text(&text).says(4, &["S0303"]);
}

#[test]
fn f49_a_contact_that_never_closes_is_solved() {
    let text = change(BRICK, "uz = -0.02", "uz = 0.02");
    run_text(&text).says(0, &["✓ solved"]);
}
