//! Frequency steps among others.

use super::mesh::{Block, Mesh};
use super::{Done, bar, elastic, solve};

/// A block on a wall, pressed in two steps, with a frequency step between, or without it.
fn pressed(between: &str, kind: &str) -> String {
    let mesh = Mesh::of(&[Block {
        group: "block",
        element: "quad4",
        cells: [4, 4, 0],
        origin: [0.0; 3],
        size: [1.0, 1.0, 0.0],
    }]);
    format!(
        "{}[model]\nspace = \"plane-strain\"\n{}[sets]\n{}{}{}\
         [[surface]]\nname = \"wall\"\nshape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"wall\"\nfriction = 0.2\n\
         [checkpoint]\nevery = {{ increments = 1 }}\n\
         [[step]]\nname = \"press\"\nincrements = {{ fixed = 2 }}\nmove = [{{ on = \"head\", ux = 0.0, uy = -0.02 }}]\n{between}\
         [[step]]\nname = \"push\"\n{kind}increments = {{ fixed = 3 }}\nmove = [{{ on = \"head\", ux = 0.01, uy = -0.03 }}]\n",
        mesh.text(),
        elastic(900.0, 0.3, "\"block\"", ""),
        mesh.set("head", |x| x[1] == 1.0),
        mesh.faces("foot", "block -y"),
        mesh.set("unused", |x| x[0] == 0.0),
    )
}

const MODES: &str = "[[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = { modes = 4 }\n";

fn history(done: &Done) -> Vec<String> {
    assert_eq!(
        done.finished.exit_code,
        0,
        "{}",
        done.finished.diagnostics.plain()
    );
    let text = done.text("history.csv");
    text.lines().map(ToOwned::to_owned).collect()
}

/// Steps after it go on as if it were not there, bit by bit, and no time passes.
#[test]
fn a_frequency_step_changes_nothing() {
    let (with, without) = (solve(&pressed(MODES, "")), solve(&pressed("", "")));
    assert_eq!(history(&with), history(&without));
    assert_eq!(with.modes().modes.len(), 4);
    assert_eq!(with.modes().time, 1.0);
}

#[test]
fn a_frequency_step_may_come_first_and_last() {
    let text = pressed("", "");
    let first = text.replacen("[[step]]", &format!("{MODES}[[step]]"), 1);
    let last = format!("{text}{}", MODES.replace("\"modes\"", "\"after\""));
    let plain = solve(&text);
    assert_eq!(history(&solve(&first)), history(&plain));
    let last = solve(&last);
    assert_eq!(history(&last), history(&plain));
    assert_eq!(last.modes().step, "after");
}

/// One row for each mode of all steps, one file for each shape, a list of all, and expectations of frequencies.
#[test]
fn modes_are_written() {
    let more = MODES.replace("\"modes\"", "\"again\"");
    let expect = "[[expect]]\nwhat = \"modes.frequency.1\"\nvalue = 0.75\ntol = { rel = 1e-4 }\n";
    let text = format!("{}{more}{expect}", bar(50, "", "frequency = { modes = 3 }"));
    let done = solve(&text);
    assert_eq!(done.finished.summary.frequencies.len(), 2);
    let rows = done.text("frequencies.csv");
    assert_eq!(rows.lines().count(), 1 + 3 + 4);
    assert!(rows.lines().nth(4).unwrap().starts_with("again,0.0,1,"));
    let list = done.text("modes.pvd");
    for number in 1..=7 {
        let file = format!("frames/mode_{number:04}.vtu");
        assert!(list.contains(&file));
        let bytes = done.fs.read(&done.folder.join(&file)).unwrap();
        let grid = signorini_io::writers::vtu::read(&bytes).unwrap();
        let shape = grid.point_field("displacement").unwrap().numbers.to_f64();
        assert!(shape.iter().any(|u| *u != 0.0));
    }
    assert_eq!(
        done.finished.exit_code,
        0,
        "{}",
        done.finished.diagnostics.plain()
    );
    assert!(done.finished.summary.expectations[0].ok);
    let log = done.text("run.log");
    assert!(
        log.contains("3 natural modes") && log.contains("effective mass"),
        "{log}"
    );
}
