use crate::support::{BRICK, change, folder_with, read, result, run};
use signorini_io::writers::vtu;

#[test]
fn divergence_keeps_every_converged_increment_and_the_last_try() {
    let text = change(
        BRICK,
        "uz = -0.02",
        "uz = { table = [[0, 0], [0.5, -0.02], [0.75, -1.5]] }",
    );
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(
        5,
        &[
            "error[S0501]: increment 3 of step \"press\" did not converge",
            "saved: 2 converged increments",
            "signorini resume case.out",
            "help:",
        ],
    );
    assert_eq!(read(&result(&folder, "history.csv")).lines().count(), 3);
    let list = read(&result(&folder, "results.pvd"));
    assert_eq!(list.matches("volume_").count(), 3, "{list}");
    let failed = vtu::read(&std::fs::read(result(&folder, "frames/failed.vtu")).unwrap()).unwrap();
    assert!(failed.point_field("displacement").is_some());
    let summary: serde_json::Value =
        serde_json::from_str(&read(&result(&folder, "summary.json"))).unwrap();
    assert_eq!(summary["status"], "not converged");
    assert_eq!(summary["exit_code"], 5);
    assert_eq!(summary["diagnostics"][0]["code"], "S0501");
    let table = read(&result(&folder, "case.sta"));
    assert!(
        table.contains("3  1U") && table.ends_with("NOT BEEN COMPLETED\n"),
        "{table}"
    );
}

#[test]
fn cut_backs_are_tried_and_told() {
    let text = change(BRICK, "uz = -0.02", "uz = -1.5");
    let text = change(&text, "fixed = 4", "initial = 1.0, min = 0.2, max = 1.0");
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(5, &["cut to", "the limit is min = 2e-1"]);
}

#[test]
fn a_failed_expectation_ends_with_1_and_a_met_one_with_0() {
    let expect = |value: &str| {
        format!(
            "{BRICK}\n[[expect]]\nwhat = \"displacement.z @ node 11\"\nvalue = {value}\ntol = {{ rel = 1e-12 }}\n"
        )
    };
    let folder = folder_with(&expect("-0.02"));
    run(folder.path(), &["run", "case.toml"]).says(0, &["-0.02", "✓"]);
    let folder = folder_with(&expect("-0.03"));
    run(folder.path(), &["run", "case.toml"]).says(1, &["✗", "expectation failed"]);
    let table = read(&result(&folder, "case.sta"));
    assert!(table.ends_with("COMPLETED SUCCESSFULLY\n"));
}

#[test]
fn expectations_look_at_rows_times_and_sets() {
    let text = format!(
        "{BRICK}
[[output.history]]
name = \"tools\"
quantity = [\"displacement.z\", \"contact_force.z\"]
set = \"tool\"
[[output.history]]
name = \"again\"
quantity = \"force_z\"
contact = \"tip\"
[[expect]]
what = \"tools.displacement.z\"
at = 1
value = -0.005
tol = {{ abs = 1e-15 }}
[[expect]]
what = \"tool.displacement_z\"
time = 0.625
value = -0.0125
tol = {{ abs = 1e-15 }}
[[expect]]
what = \"displacement.z @ set base max\"
value = 0.0
tol = {{ abs = 0.0 }}
[[expect]]
what = \"time\"
at = 3
value = 0.75
tol = {{ abs = 0.0 }}
"
    );
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(0, &["✓ solved"]);
    let table = read(&result(&folder, "history.csv"));
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|c| *c == name).unwrap();
    for row in &rows[1..] {
        assert_eq!(row[column("again.force_z")], row[column("tip.force_z")]);
        assert_eq!(
            row[column("tools.contact_force.z")],
            row[column("tip.force_z")]
        );
        assert_eq!(row[column("tool.force_z")], row[column("tip.force_z")]);
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let histories = ["1", "3"].map(|n| {
        let folder = folder_with(BRICK);
        run(folder.path(), &["run", "case.toml", "-q", "-j", n]).says(0, &[]);
        read(&result(&folder, "history.csv"))
    });
    assert_eq!(histories[0], histories[1]);
}

/// Two blocks, the upper one pressed through the lower one: no method gets there. A node of no element is a warning of reading.
const TOO_FAR: &str = r#"
format = 1
units = "m-MN-MPa"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
  [11, 0, 0, 1], [12, 1, 0, 1], [13, 1, 1, 1], [14, 0, 1, 1],
  [15, 0, 0, 2], [16, 1, 0, 2], [17, 1, 1, 2], [18, 0, 1, 2],
  [99, 5, 5, 5],
]
elements = [
  { id = 1, type = "hex8", group = "lower", nodes = [1, 2, 3, 4, 5, 6, 7, 8] },
  { id = 2, type = "hex8", group = "upper", nodes = [11, 12, 13, 14, 15, 16, 17, 18] },
]
[sets]
base = { nodes = [1, 2, 3, 4] }
head = { nodes = [15, 16, 17, 18] }
top = { faces = [[1, "+z"]] }
foot = { faces = [[2, "-z"]] }
[material.soft]
model = "saint-venant-kirchhoff"
E = 500.0
nu = 0.0
[[body]]
group = ["lower", "upper"]
material = "soft"
[[contact]]
name = "joint"
secondary = "foot"
primary = "top"
[[step]]
name = "press"
geometry = "nonlinear"
increments = { initial = 1.0, min = 0.5, max = 1.0 }
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "head"
ux = 0.0
uy = 0.0
uz = -2.5
"#;

#[test]
fn a_case_that_is_solved_again_by_points_keeps_the_warnings_of_reading() {
    let folder = folder_with(TOO_FAR);
    run(folder.path(), &["run", "case.toml"]).says(5, &["S0502", "solved again by Gauss points"]);
    let summary: serde_json::Value =
        serde_json::from_str(&read(&result(&folder, "summary.json"))).unwrap();
    let found = summary["diagnostics"].as_array().unwrap();
    assert!(found.iter().any(|one| one["code"] == "S0502"), "{summary}");
    let lone = |one: &&serde_json::Value| {
        one["message"]
            .as_str()
            .unwrap()
            .contains("nodes without elements")
    };
    assert_eq!(found.iter().filter(lone).count(), 1, "{summary}");
}
