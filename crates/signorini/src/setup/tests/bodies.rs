//! Bodies: what they are made of and how they are integrated.

use super::*;
use signorini_io::case::read_case;
use signorini_mechanics::model::BodyKind;
use signorini_mechanics::solid::{Integration, Locking};
use std::path::Path;

#[test]
fn bodies_are_solids_bars_or_rigid_with_what_they_are_made_of() {
    let bar = "[[body]]\ngroup = 'bar'\nmaterial = 'steel'\narea = 2.5\n";
    let text = format!("{CUBES}{bar}{BASE}{STEP}").replace(
        "group = \"low\"\nmaterial = \"steel\"",
        "group = \"low\"\nmaterial = \"steel\"\nintegration = 'reduced'\nlocking = 'b-bar'\norientation = { x = [0, 1, 0], y = [0, 0, 1] }",
    );
    let text = text.replace(
        "nu = 0.3",
        "nu = 0.3\ndensity = 2.0\nplasticity = { table = [[250, 0], [300, 0.1]] }",
    );
    let built = parts_of(&text);
    let BodyKind::Solid {
        integration,
        locking,
        density,
        ..
    } = &built.bodies[0].kind
    else {
        panic!("a solid");
    };
    assert_eq!(
        (*integration, *locking, *density),
        (Integration::Reduced, Locking::BBar, Some(2.0))
    );
    let BodyKind::Truss { area, material, .. } = &built.bodies[1].kind else {
        panic!("bars");
    };
    assert!(*area == 2.5 && material.nhistory() > 0);
    for (from, to, code, word) in [
        ("area = 2.5", "", "S0106", "has no `area`"),
        (
            "integration = 'reduced'",
            "area = 1",
            "S0112",
            "which have no `area`",
        ),
        ("[300, 0.1]", "[300, 0.0]", "S0117", "do not increase"),
    ] {
        assert!(text.contains(from), "{from}");
        let all = try_parts(&text.replace(from, to)).err().unwrap();
        assert_eq!(all.iter().next().unwrap().code.id, code, "{all}");
        assert!(all.plain().contains(word), "{all}");
    }
}

#[test]
fn a_shell_has_a_solid_with_directors_in_its_place() {
    let sheet = "[mesh]\nnodes = [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0]]\n\
        elements = [{ id = 1, type = 'quad4', group = 'sheet', nodes = [1, 2, 3, 4] }]\n\
        [material.m]\nmodel = 'linear-elastic'\nE = 1\nnu = 0\n\
        [[body]]\ngroup = 'sheet'\nmaterial = 'm'\nshell = { thickness = 0.1 }\n[[step]]\nname = 's'\n";
    let held = "[[step.fix]]\non = 'sheet'\nu = 'all'\n";
    let (case, _) = read_case(
        "case.toml",
        format!("{sheet}{held}").as_bytes(),
        &[],
        crate::vocabulary(),
    )
    .unwrap();
    let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
    let model = build(case, mesh).unwrap();
    // 4 nodes, and for each half its director and both its ends
    assert_eq!((model.mesh.nnode(), model.mesh.ncell()), (16, 1));
    assert_eq!(model.system.elimination.directors().all().len(), 4);
    assert_eq!(model.nodes_of("sheet").unwrap(), [0, 1, 2, 3]);
    assert_eq!(model.remedies(), ["sheet: solid-shell"]);
    let of_step = &model.steps[0].prescriptions;
    assert!(of_step.len() == 12 && of_step.iter().all(|one| one.dof < 12));
}

#[test]
fn a_moment_on_a_solid_next_to_a_shell_is_that_of_a_solid() {
    let text = "[mesh]\nnodes = [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0], [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], \
        [8, 0, 1, 1], [9, 3, 0, 0], [10, 4, 0, 0], [11, 4, 1, 0], [12, 3, 1, 0]]\n\
        elements = [{ id = 1, type = 'hex8', group = 'cube', nodes = [1, 2, 3, 4, 5, 6, 7, 8] },\n\
        { id = 2, type = 'quad4', group = 'sheet', nodes = [9, 10, 11, 12] }]\n\
        [sets]\nbase = { nodes = [1, 2, 3, 4] }\ntop = { nodes = [5, 6, 7, 8] }\n\
        [material.m]\nmodel = 'linear-elastic'\nE = 1\nnu = 0\n\
        [[body]]\ngroup = 'cube'\nmaterial = 'm'\n\
        [[body]]\ngroup = 'sheet'\nmaterial = 'm'\nshell = { thickness = 0.1 }\n\
        [[step]]\nname = 's'\ngeometry = 'GEOMETRY'\n[[step.fix]]\non = 'base'\nu = 'all'\n\
        [[step.fix]]\non = 'sheet'\nu = 'all'\n[[step.load]]\non = 'ON'\nmoment = [0, 0, 1]\n";
    let built = |on: &str, geometry: &str| {
        let text = text.replace("ON", on).replace("GEOMETRY", geometry);
        let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
        let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
        build(case, mesh).map_err(|found| found.plain())
    };
    for geometry in ["linear", "nonlinear"] {
        assert!(
            built("top", geometry).is_ok(),
            "{:?}",
            built("top", geometry).err()
        );
    }
    let refused = built("sheet", "linear").err().unwrap();
    assert!(
        refused.contains("turns about the normal of the shell"),
        "{refused}"
    );
    let refused = built("sheet", "nonlinear").err().unwrap();
    assert!(refused.contains("do not turn with the shell"), "{refused}");
}

#[test]
fn bodies_start_without_thermal_strain_unless_the_case_says_otherwise() {
    let heated = format!("{STEP}[[step.temperature]]\non = 'base'\nvalue = 120\n");
    let text = format!("{CUBES}{BASE}{heated}");
    let expands = "nu = 0.3\nexpansion = { alpha = 1e-5, reference = 20 }";
    let built = parts_of(&text.replace("nu = 0.3", expands));
    assert!(built.temperature.len() == 19 && built.temperature.iter().all(|t| *t == 20.0));
    assert_eq!(built.case.initial_temperature, Some(20.0.into()));
    assert_eq!(built.steps[0].temperatures.len(), 4);
    let given = text.replace("[[body]]", "[initial]\ntemperature = 5\n[[body]]");
    let built = parts_of(&given.replace("nu = 0.3", expands));
    assert!(built.temperature.iter().all(|t| *t == 5.0));
    let built = parts_of(&text);
    let said = built.warnings.plain();
    assert!(
        said.contains("S0405") && said.contains("no material expands"),
        "{said}"
    );
    assert!(
        parts_of(&format!("{CUBES}{BASE}{STEP}"))
            .temperature
            .is_empty()
    );
}

/// A ring, in the plane of its section.
const RING: &str = r#"
[model]
space = "axisymmetric"
[mesh]
nodes = [[1, 0, 0], [2, 2, 0], [3, 2, 1], [4, 0, 1]]
elements = [{ id = 1, type = "quad4", group = "ring", nodes = [1, 2, 3, 4] }]
[material.steel]
model = "linear-elastic"
E = 210e3
nu = 0.3
density = 1.0
[[body]]
group = "ring"
material = "steel"
[[step]]
name = "one"
[[step.fix]]
on = "ring"
u = "all"
"#;

#[test]
fn a_body_of_revolution_lies_on_one_side_of_its_axis() {
    assert!(parts_of(RING).text.starts_with("Axisymmetric"));
    let all = try_parts(&RING.replace("[1, 0, 0]", "[1, -0.5, 0]"))
        .err()
        .unwrap();
    assert!(all.plain().contains("node 1 lies at x = -0.5"), "{all}");
    let gravity = |g: &str| {
        try_parts(&format!(
            "{RING}[[step.load]]\non = 'ring'\ngravity = {g}\n"
        ))
    };
    assert!(gravity("[0, -9.81]").is_ok());
    let all = gravity("[1, 0]").err().unwrap();
    assert!(all.plain().contains("is not axisymmetric"), "{all}");
    let stress = parts_of(&RING.replace("\"axisymmetric\"", "\"plane-stress\"\nthickness = 0.5"));
    assert!(stress.text.starts_with("PlaneStress { thickness: 0.5 }"));
}

#[test]
fn the_remedy_against_locking_is_reported_and_written_where_a_body_has_one() {
    let linear = STEP.replace("name = 'one'", "name = 'one'\ngeometry = 'linear'");
    let finite = "[[step]]\nname = 'two'\n[[step.move]]\non = 'base'\nuz = 0.1\n";
    for (nu, steps, told, locking) in [
        (
            "0.3",
            linear.clone(),
            "low: incompatible",
            Locking::Incompatible,
        ),
        ("0.49", linear.clone(), "low: b-bar", Locking::BBar),
        ("0.49", STEP.to_owned(), "low: f-bar", Locking::FBar),
        ("0.3", STEP.to_owned(), "", Locking::None),
        (
            "0.49",
            format!(
                "{linear}{}",
                finite.replace("'two'", "'two'\ngeometry = 'nonlinear'")
            ),
            "low: b-bar and f-bar",
            Locking::Auto,
        ),
    ] {
        let cubes = CUBES.replace("nu = 0.3", &format!("nu = {nu}"));
        let text = format!("{cubes}{BASE}{steps}");
        let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
        let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
        let model = build(case, mesh).unwrap_or_else(|all| panic!("{all}"));
        assert_eq!(model.remedies().concat(), told);
        assert_eq!(
            model.case.bodies[0].locking.value,
            crate::setup::bodies::locking_word(locking)
        );
    }
}
