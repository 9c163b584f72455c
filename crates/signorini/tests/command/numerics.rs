use crate::support::{BRICK, change, folder_with, read, result, run};
use signorini_io::writers::vtu;

#[test]
fn f55_divergence_keeps_every_converged_increment_and_the_last_try() {
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
fn f58_cut_backs_are_tried_and_told() {
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
fn f66_the_number_of_threads_does_not_change_a_bit() {
    let histories = ["1", "3"].map(|n| {
        let folder = folder_with(BRICK);
        run(folder.path(), &["run", "case.toml", "-q", "-j", n]).says(0, &[]);
        read(&result(&folder, "history.csv"))
    });
    assert_eq!(histories[0], histories[1]);
}
