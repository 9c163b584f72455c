//! Bodies that are shells, and what acts on them.

use super::*;
use signorini_vocabulary::{Chosen, Value};

/// A sheet of one element; `body` are keys of its body, `more` tables in and behind its step.
fn sheet(body: &str, more: &str) -> String {
    format!(
        "[mesh]\nnodes = [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0]]\n\
         elements = [{{ id = 1, type = 'quad4', group = 'sheet', nodes = [1, 2, 3, 4] }}]\n\
         [sets]\nrim = {{ faces = [[1, 'S3']] }}\ntop = {{ faces = [[1, 'S2']] }}\n\
         [material.m]\nmodel = 'linear-elastic'\nE = 1\nnu = 0\n\
         [[body]]\ngroup = 'sheet'\nmaterial = 'm'\n{body}\n[[step]]\nname = 's'\n{more}\n"
    )
}

const SHELL: &str = "shell = { thickness = 0.8 }";

fn case_of(text: &str) -> Case {
    let (case, warnings) = read(text).unwrap_or_else(|all| panic!("{all}"));
    assert!(warnings.is_empty(), "{warnings}");
    assert_eq!(read(&resolved(&case, vocabulary())).unwrap().0, case);
    case
}

#[test]
fn a_shell_has_a_thickness_and_defaults() {
    let case = case_of(&sheet(SHELL, ""));
    let shell = case.bodies[0].shell.as_ref().unwrap();
    assert_eq!(shell.thickness.value, Thickness::Uniform(0.8));
    assert_eq!(
        (shell.offset, shell.normals.value, shell.points),
        (0.0, 20.0, 2)
    );
    assert_eq!(shell.thickness.place.text(), Some("0.8"));
    let given = "shell = { thickness = 'field', offset = -0.5, normals = 0, points = 9 }";
    let case = case_of(&sheet(given, "[[thickness]]\non = 'sheet'\nvalue = 2"));
    let shell = case.bodies[0].shell.as_ref().unwrap();
    assert_eq!(shell.thickness.value, Thickness::Field);
    assert_eq!(
        (shell.offset, shell.normals.value, shell.points),
        (-0.5, 0.0, 9)
    );
    assert_eq!(case.thicknesses[0].value, 2.0);
}

#[test]
fn values_that_no_shell_has_are_refused() {
    for (keys, code) in [
        ("{}", "S0106"),
        ("{ thickness = 0 }", "S0109"),
        ("{ thickness = 'auto' }", "S0110"),
        ("{ thickness = 1, normals = 180.5 }", "S0109"),
        ("{ thickness = 1, normals = -1 }", "S0109"),
        ("{ thickness = 1, points = 1 }", "S0109"),
        ("{ thickness = 1, points = 10 }", "S0109"),
        ("{ thickness = 1, layers = 2 }", "S0102"),
        ("0.8", "S0107"),
    ] {
        assert_eq!(
            codes_of(&sheet(&format!("shell = {keys}"), "")),
            [code],
            "{keys}"
        );
    }
}

#[test]
fn keys_of_solids_and_bars_do_not_go_with_a_shell() {
    for key in [
        "area = 1",
        "space = 'plane-stress'",
        "thickness = 1",
        "integration = 'reduced'",
        "locking = 'none'",
        "temperatures = 'linear'",
        "at_nodes = 'element'",
        "strain = 'small'",
    ] {
        let text = sheet(&format!("{SHELL}\n{key}"), "");
        assert_eq!(codes_of(&text), ["S0112"], "{key}");
    }
    let usual =
        "integration = 'full'\nlocking = 'auto'\ntemperatures = 'full'\nat_nodes = 'linear'";
    case_of(&sheet(&format!("{SHELL}\n{usual}"), ""));
    let rigid = sheet(&format!("{SHELL}\nrigid = true"), "");
    let all = read(&rigid).unwrap_err();
    assert!(
        all.plain()
            .contains("`shell` means nothing for a rigid body"),
        "{all}"
    );
    let plane = format!("[model]\nspace = 'plane-strain'\n{}", sheet(SHELL, ""));
    let all = read(&plane).unwrap_err();
    let message = "body \"sheet\" is a shell in a model that is plane-strain";
    assert_eq!(all.iter().next().unwrap().message, message);
}

#[test]
fn shells_have_rotations_moments_line_loads_and_gradients() {
    let more = "fix = [{ on = 'rim', u = 'all', rot = ['x', 'z'] }]\n\
        [[step.load]]\non = 'sheet'\nmoment = [0, 1, 0]\n\
        [[step.load]]\non = 'rim'\nline = 2.5\nfollows = false\n\
        [[step.temperature]]\non = 'sheet'\nvalue = 100\ngradient = -3\n\
        [initial]\nat = [{ on = 'sheet', temperature = 20, gradient = 5 }]";
    let case = case_of(&sheet(SHELL, more));
    let step = &case.steps[0];
    assert_eq!(step.fixes[0].rot.xyz, [true, false, true]);
    assert_eq!(step.loads[0].kind.name, "moment");
    assert_eq!(step.loads[1].kind, Chosen::bare("line", Value::Number(2.5)));
    assert_eq!(step.temperatures[0].gradient, Some((-3.0).into()));
    assert_eq!(case.initial_temperatures[0].gradient, Some(5.0));
    // the same without a shell
    let text = sheet("thickness = 1", more);
    let text = format!("[model]\nspace = 'plane-stress'\n{text}");
    let all = read(&text).unwrap_err();
    let messages: Vec<&str> = all.iter().map(|one| one.message.as_str()).collect();
    let lacking = |key: &str| {
        let wanted = format!("`{key}` acts on shells, and no body is one");
        messages
            .iter()
            .filter(|message| **message == wanted)
            .count()
    };
    assert_eq!((lacking("gradient"), lacking("line")), (2, 1), "{all}");
}

#[test]
fn a_gradient_has_the_course_of_its_temperature() {
    let text = |value: &str| {
        let more = format!(
            "[[step.temperature]]\non = 'sheet'\nvalue = {value}\ngradient = 1\n\
             [amplitude.saw]\ntable = [[0, 0], [1, 1]]"
        );
        sheet(SHELL, &more)
    };
    case_of(&text("{ amplitude = 'saw', value = 5 }"));
    assert_eq!(codes_of(&text("{ table = [[0, 0], [1, 1]] }")), ["S0112"]);
}
