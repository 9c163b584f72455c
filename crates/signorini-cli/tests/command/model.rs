use crate::support::{BRICK, change, folder_with, read, result, run, run_text};

#[test]
fn a_body_without_supports_is_named_with_its_motion() {
    let text = change(BRICK, "u = \"all\"", "u = [\"x\"]");
    run_text(&text).says(4, &["\"brick\"", "free", "S0302"]);
}

#[test]
fn two_motions_of_one_node_clash() {
    let more = "[[step.move]]\non = \"base\"\nux = 0.1\n[checkpoint]";
    run_text(&change(BRICK, "[checkpoint]", more)).says(4, &["S0305", "node 1", "case.toml:"]);
}

#[test]
fn a_surface_against_itself_is_refused() {
    let text = change(BRICK, "secondary = \"tip_node\"", "secondary = \"top\"");
    let ended = run_text(&text);
    assert!(matches!(ended.code, Some(3 | 4)), "{ended:?}");
    ended.says(ended.code.unwrap(), &["top"]);
}

#[test]
fn a_pair_in_two_contacts_is_warned_of() {
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
fn a_node_that_both_sides_have_is_left_out_unless_there_is_no_other() {
    let with = |nodes: &str| {
        let found = format!("tip_node = {{ nodes = {nodes} }}");
        run_text(&change(BRICK, "tip_node = { nodes = [11] }", &found))
    };
    with("[7]").says(4, &["S0303", "node 7"]);
    with("[7, 11]").says(0, &["both sides have node 7, left out"]);
}

#[test]
fn a_contact_that_never_closes_is_solved() {
    let text = change(BRICK, "uz = -0.02", "uz = 0.02");
    run_text(&text).says(0, &["✓ solved"]);
}

/// A coarse cell, and below it a strip of eight whose motion is prescribed as a whole.
fn prescribed_strip(more: &str) -> String {
    let mut nodes = String::from("[1, 0, 0], [2, 2, 0], [3, 2, 1], [4, 0, 1]");
    let mut faces = Vec::new();
    let mut elements =
        String::from("{ id = 1, type = \"quad4\", group = \"high\", nodes = [1, 2, 3, 4] }");
    for k in 0..=8 {
        let x = 0.5 + 0.125 * f64::from(k);
        let low = 10 + 2 * k;
        nodes += &format!(", [{low}, {x}, -0.2], [{}, {x}, 0]", low + 1);
        if k > 0 {
            let (a, b) = (low - 2, low);
            faces.push(format!("[{low}, \"S3\"]"));
            elements += &format!(
                ", {{ id = {low}, type = \"quad4\", group = \"strip\", nodes = [{a}, {b}, {}, {}] }}",
                b + 1,
                a + 1
            );
        }
    }
    let faces = faces.join(", ");
    format!(
        r#"format = 1
title = "a strip"
[mesh]
nodes = [{nodes}]
elements = [{elements}]
[model]
space = "plane-strain"
[sets]
head = {{ nodes = [3, 4] }}
top = {{ faces = [[1, "S1"]] }}
strip_top = {{ faces = [{faces}] }}
[material.steel]
model = "linear-elastic"
E = 1000.0
nu = 0.3
[[body]]
group = "high"
material = "steel"
[[body]]
group = "strip"
material = "steel"
[[contact]]
name = "touch"
secondary = "strip_top"
primary = "top"
{more}
[[step]]
name = "press"
geometry = "linear"
increments = 1
[[step.fix]]
on = "head"
u = "all"
[[step.move]]
on = "strip"
ux = 0.0
uy = 0.01
"#
    )
}

#[test]
fn a_prescribed_secondary_side_has_no_multipliers_by_auto_and_redundant_ones_by_mortar() {
    let folder = folder_with(&prescribed_strip(""));
    run(folder.path(), &["run", "case.toml"]).says(0, &["solved"]);
    let resolved = read(&result(&folder, "case.resolved.toml"));
    assert!(resolved.contains("\"node-to-segment\""), "{resolved}");
    // nine nodes that are prescribed on a facet of two
    run_text(&prescribed_strip("method = \"mortar\"")).says(0, &["solved", "0 cut-backs"]);
}

/// A block on another, with these faces of it as the secondary side.
fn resting(faces: &str) -> String {
    format!(
        r#"format = 1
title = "a block on another"
[mesh]
nodes = [
    [1, 0.0, 0.0], [2, 2.0, 0.0], [3, 2.0, 1.0], [4, 0.0, 1.0],
    [5, 0.5, 1.0], [6, 1.5, 1.0], [7, 1.5, 2.0], [8, 0.5, 2.0],
]
elements = [
    {{ id = 1, type = "quad4", group = "low", nodes = [1, 2, 3, 4] }},
    {{ id = 2, type = "quad4", group = "high", nodes = [5, 6, 7, 8] }},
]
[model]
space = "plane-strain"
[sets]
base = {{ nodes = [1, 2] }}
head = {{ nodes = [7, 8] }}
top = {{ faces = [[1, "S3"]] }}
foot = {{ faces = [{faces}] }}
[material.steel]
model = "linear-elastic"
E = 1000.0
nu = 0.3
[[body]]
group = "low"
material = "steel"
[[body]]
group = "high"
material = "steel"
[[contact]]
name = "touch"
secondary = "foot"
primary = "top"
[[step]]
name = "press"
geometry = "linear"
increments = 1
[[step.fix]]
on = "base"
u = "all"
[[step.fix]]
on = "head"
u = ["x"]
[[step.move]]
on = "head"
uy = -0.01
"#
    )
}

#[test]
fn auto_takes_mortar_with_flanks_in_the_secondary_side_and_without() {
    for faces in ["[2, \"S1\"]", "[2, \"S1\"], [2, \"S2\"]"] {
        let folder = folder_with(&resting(faces));
        run(folder.path(), &["run", "case.toml"]).says(0, &["solved"]);
        let resolved = read(&result(&folder, "case.resolved.toml"));
        assert!(resolved.contains("\"mortar\""), "{resolved}");
    }
}
