use crate::support::{BRICK, change, folder_with, read, result, run, run_text};
use signorini_io::writers::vtu::{self, Vtu};

fn check(text: &str) -> crate::support::Ended {
    run(folder_with(text).path(), &["check", "case.toml"])
}

fn numbers(file: &Vtu, name: &str) -> Vec<f64> {
    let field = file.point_field(name).or_else(|| file.cell_field(name));
    field.unwrap().numbers.to_f64()
}

#[test]
fn a_check_draws_shapes_bodies_supports_loads_and_gaps() {
    let load = "[[step.load]]\non = \"top\"\nforce = [0, 0, -1]\n[checkpoint]";
    let text = change(BRICK, "[checkpoint]", load);
    let text = change(&text, "[11, 0.3, 0.2, 1]", "[11, 0.3, 0.2, 1.25]");
    let folder = folder_with(&text);
    run(folder.path(), &["check", "case.toml", "-o", "seen"]).says(0, &["check.vtu"]);
    let file = vtu::read(&std::fs::read(folder.path().join("seen/check.vtu")).unwrap()).unwrap();
    let quality = numbers(&file, "quality");
    assert!((quality[0] - 1.0).abs() < 1e-12, "a cube: {quality:?}");
    assert!(quality[1] > 0.5 && quality[1] < 1.0);
    let edges = numbers(&file, "edge_ratio");
    assert!((edges[0] - 1.0).abs() < 1e-12 && edges[1] < 1.0);
    assert_eq!(numbers(&file, "body"), [0.0, 1.0]);
    let (base, top, tool) = (0..4, 4..8, 8..12);
    for name in ["support_x", "support_y", "support_z"] {
        let marks = numbers(&file, name);
        let wanted = |n| f64::from(u8::from(base.contains(&n) || tool.contains(&n)));
        assert!((0..12).all(|n| marks[n] == wanted(n)), "{name}: {marks:?}");
    }
    let loads = numbers(&file, "load");
    assert!((0..12).all(|n| (loads[n] == 1.0) == top.contains(&n)));
    let gaps = numbers(&file, "contact_gap");
    assert!((gaps[8] - 0.25).abs() < 1e-12 && gaps[0].is_nan());
}

#[test]
fn a_check_tells_shapes_and_cost() {
    check(BRICK).says(
        0,
        &[
            "quality (1 ideal, 0 flat): worst 0.59, tet4 at element 2",
            "elements by tenths",
            "shortest over longest edge: worst 0.67",
            "supports hold every body",
            "of memory",
            "for each iteration",
        ],
    );
    let lines = check(BRICK).out.lines().count();
    assert!(lines <= 24, "more than a screen: {lines}");
}

#[test]
fn an_element_with_a_corner_turned_inside_out_is_named() {
    let text = change(BRICK, "[7, 1, 1, 1]", "[7, 0.53, 0.53, 0.88]");
    check(&text).says(4, &["S0211", "elements 1"]);
}

#[test]
fn a_motion_that_nothing_stops_is_told() {
    let text = change(BRICK, "u = \"all\"", "u = [\"x\"]");
    for ended in [check(&text), run_text(&text)] {
        ended.says(4, &["S0302", "body \"brick\" is free to slide along y:"]);
    }
}

#[test]
fn a_motion_that_only_contact_stops_is_a_warning() {
    let more = "[[step.fix]]\non = \"top\"\nu = [\"x\", \"y\"]\n[checkpoint]";
    let text = change(BRICK, "u = \"all\"", "u = [\"x\", \"y\"]");
    let text = change(&text, "[checkpoint]", more);
    let words = [
        "warning[S0301]",
        "body \"brick\" is held only by contact",
        "without contact it is free to slide along z",
    ];
    let ended = check(&text);
    ended.says(0, &words);
    assert!(!ended.out.contains("supports hold every body"));
    let silenced = check(&format!("allow = [\"S0301\"]\n{text}"));
    assert!(!silenced.says(0, &[]).err.contains("S0301"));
}

#[test]
fn linear_tetrahedra_in_a_solid_are_warned_of_and_those_of_a_tool_are_not() {
    assert!(!check(BRICK).says(0, &[]).err.contains("S0404"));
    let text = change(
        BRICK,
        "group = \"tool\"\nrigid = true",
        "group = \"tool\"\nmaterial = \"soft\"",
    );
    let text = change(
        &text,
        "[checkpoint]",
        "[[step.fix]]\non = \"tool\"\nu = [\"x\", \"y\"]\n[checkpoint]",
    );
    check(&text).says(0, &["warning[S0404]", "body \"tool\" has 1 tet4", "stiff"]);
    let silenced = check(&format!("allow = [\"S0404\"]\n{text}"));
    assert!(!silenced.says(0, &[]).err.contains("S0404"));
}

#[test]
fn fields_are_written_as_chosen_and_principal_stresses_descend() {
    let fields = "[output]\nfields = [\"strain\", \"principal_stress\", \"plastic_strain\", \"temperature\"]\n[checkpoint]";
    let folder = folder_with(&change(BRICK, "[checkpoint]", fields));
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let bytes = std::fs::read(result(&folder, "frames/volume_0004.vtu")).unwrap();
    let file = vtu::read(&bytes).unwrap();
    for field in [
        file.point_field("principal_stress"),
        file.cell_field("principal_stress"),
    ] {
        let values = field.unwrap().numbers.to_f64();
        assert!(values.chunks(3).all(|p| p[0] >= p[1] && p[1] >= p[2]));
        assert!(values.iter().any(|v| *v < -1.0), "the brick is pressed");
    }
    assert_eq!(file.point_field("strain").unwrap().ncomponent, 6);
    assert_eq!(file.cell_field("strain").unwrap().ncomponent, 6);
    for absent in [
        "stress",
        "von_mises",
        "plastic_strain",
        "temperature",
        "contact_pressure",
    ] {
        assert!(file.point_field(absent).is_none(), "{absent}");
    }
}

#[test]
fn components_in_the_history_belong_to_one_tensor() {
    let history = "[[output.history]]\nname = \"corner\"\nnode = 5\nquantity = [\"principal_stress.1\", \
                   \"principal_stress.2\", \"principal_stress.3\", \"von_mises\", \"stress.xx\", \"stress.yy\", \
                   \"stress.zz\", \"strain.xy\", \"plastic_strain\"]\n[checkpoint]";
    let folder = folder_with(&change(BRICK, "[checkpoint]", history));
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let table = read(&result(&folder, "history.csv"));
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    let value = |name: &str| -> f64 {
        let name = format!("corner.{name}");
        let at = rows[0].iter().position(|c| *c == name).unwrap();
        rows.last().unwrap()[at].parse().unwrap()
    };
    let [a, b, c] = ["1", "2", "3"].map(|k| value(&format!("principal_stress.{k}")));
    let mises = value("von_mises");
    let of_principal = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
    assert!(mises > 0.1 && (mises - of_principal).abs() < 1e-12 * mises);
    let trace: f64 = ["xx", "yy", "zz"]
        .map(|k| value(&format!("stress.{k}")))
        .iter()
        .sum();
    assert!((a + b + c - trace).abs() < 1e-12 * mises);
    assert_eq!(value("plastic_strain"), 0.0);
}
