//! Shells: their sections, surfaces, supports, loads and temperatures.

use super::*;
use crate::case::vocabulary::{Kinds, Vocabulary};
use crate::case::{
    ConstraintKind, Integration, Locking, Motion, SetContent, Side, Space, Thickness, Unstrained,
    resolved,
};
use crate::deck::load::vector;
use signorini_geometry::mesh::Set;
use signorini_vocabulary::{Chosen, Value};
use std::f64::consts::FRAC_1_SQRT_2;
use std::path::Path;

const SECTION: &str = "*SHELL SECTION, ELSET=SHEET, MATERIAL=M\n0.1\n";
const LAST: &str = "*STEP\n*STATIC\n*END STEP\n";

/// A deck of one square shell, with this section and these cards.
fn sheet_of(kind: &str, section: &str, cards: &str) -> String {
    let nodes = match kind {
        "S6" | "STRI65" => "1,2,3,5,6,9",
        "S8" | "S8R" | "S8R5" => "1,2,3,4,5,6,7,8",
        "S9R5" => "1,2,3,4,5,6,7,8,9",
        "S3" | "S3R" | "STRI3" => "1,2,3",
        _ => "1,2,3,4",
    };
    format!(
        "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,.5,0,0\n6,1,.5,0\n7,.5,1,0\n8,0,.5,0\n9,.5,.5,0\n\
         *ELEMENT, TYPE={kind}, ELSET=SHEET\n1,{nodes}\n*NSET, NSET=LEFT\n1,4\n*NSET, NSET=RIGHT\n2,3\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*EXPANSION\n1e-5\n{section}{cards}"
    )
}

fn sheet(cards: &str) -> String {
    sheet_of("S4", SECTION, cards)
}

/// The same next to a cube, on the nodes of its lid, and on two others.
fn on_cube(cards: &str) -> String {
    let more = "*NODE\n11,2,0,1\n12,2,1,1\n*ELEMENT, TYPE=S4, ELSET=SHEET\n11,6,11,12,7\n*NSET, NSET=SIDE\n6,7,11,12\n";
    cube("C3D8", &format!("{more}{SECTION}{cards}"))
}

/// A step with these cards.
fn step(cards: &str) -> String {
    format!("*STEP\n*STATIC\n{cards}*END STEP\n")
}

fn text_of(case: &Case) -> String {
    let vocabulary = Vocabulary::new(Kinds {
        loads: signorini_mechanics::load::descriptions(),
        materials: signorini_mechanics::material::descriptions(),
        ..Kinds::default()
    });
    resolved(case, &vocabulary)
}

fn has(text: &str, lines: &[&str]) {
    for line in lines {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
}

fn refuses(decks: &[(String, &str)]) {
    for (deck, words) in decks {
        let found = translated(deck, Compat::None);
        let found = found
            .err()
            .unwrap_or_else(|| panic!("{words}: taken\n{deck}"));
        assert!(found.plain().contains(words), "{words}: {}", found.plain());
        assert_eq!(found.exit_code(), Some(3));
    }
}

#[test]
fn shells_of_every_type_are_bodies_with_a_thickness() {
    for kind in [
        "S3", "S3R", "STRI3", "S4", "S4R", "S4R5", "S6", "STRI65", "S8", "S8R", "S8R5",
    ] {
        let read = translated(&sheet_of(kind, SECTION, LAST), Compat::None);
        let read = read.unwrap_or_else(|found| panic!("{kind}: {}", found.plain()));
        let case = &read.case;
        assert_eq!(case.model.space.value, Space::ThreeD);
        let [body] = &case.bodies[..] else {
            panic!("{kind}: {:?}", case.bodies);
        };
        let shell = body.shell.as_ref().unwrap();
        assert_eq!(body.groups[0].as_str(), "SHEET");
        assert_eq!(
            (body.integration, *body.locking),
            (Integration::Full, Locking::Auto)
        );
        assert_eq!(*shell.thickness, Thickness::Uniform(0.1));
        assert_eq!((shell.offset, *shell.normals, shell.points), (0.0, 20.0, 2));
        let notes = read.found.plain();
        assert_eq!(notes.matches("solid-shells").count(), 1, "{notes}");
        assert!(notes.contains(&format!("shells ({kind})")), "{notes}");
        assert!(!notes.contains("only the mesh is read"), "{notes}");
    }
    has(
        &text_of(&case(&sheet(LAST))),
        &[
            "shell = { thickness = 0.1, offset = 0.0, normals = 20.0, points = 2 }",
            "group = [\"SHEET\"]",
        ],
    );
}

#[test]
fn sections_say_thickness_offset_and_points() {
    let shell = |head: &str, line: &str| {
        let section = format!("*SHELL SECTION, ELSET=SHEET, MATERIAL=M{head}\n{line}\n");
        case(&sheet_of("S4", &section, LAST)).bodies[0]
            .shell
            .clone()
            .unwrap()
    };
    for (given, offset) in [("0.25", 0.25), ("-1.", -1.0), ("SPOS", 0.5), ("SNEG", -0.5)] {
        assert_eq!(shell(&format!(", OFFSET={given}"), "0.2").offset, offset);
    }
    assert_eq!(shell("", "0.2, 7").points, 7);
    assert_eq!(shell("", "0.2, 25").points, 9);
    let plastic = sheet(LAST).replace("*EXPANSION", "*PLASTIC\n5., 0.\n6., 0.1\n*EXPANSION");
    let points = |compat| {
        case_as(&plastic, compat).bodies[0]
            .shell
            .as_ref()
            .unwrap()
            .points
    };
    assert_eq!((points(Compat::None), points(Compat::Ccx)), (5, 2));
}

#[test]
fn thickness_at_nodes_counts_where_the_section_asks_for_it() {
    let cards = format!("*NODAL THICKNESS\nALL, 0.3\nRIGHT, 0.2\n{LAST}");
    let asking = SECTION.replace("=M\n", "=M, NODAL THICKNESS\n");
    let read = translated(&sheet_of("S4", &asking, &cards), Compat::None).unwrap();
    let case = read.case;
    assert_eq!(
        *case.bodies[0].shell.as_ref().unwrap().thickness,
        Thickness::Field
    );
    let given: Vec<_> = case
        .thicknesses
        .iter()
        .map(|one| (one.on.as_str(), one.value))
        .collect();
    assert_eq!(given, [("ALL", 0.3), ("RIGHT", 0.2)]);
    let read = translated(&sheet(&cards), Compat::None).unwrap();
    assert!(read.case.thicknesses.is_empty());
    let notes = read.found.plain();
    assert!(
        notes.contains("whose section does not ask for it"),
        "{notes}"
    );
}

#[test]
fn the_last_shell_section_of_an_element_holds() {
    let cards =
        format!("*ELSET, ELSET=SOME\n1\n*SHELL SECTION, ELSET=SOME, MATERIAL=M\n0.5\n{LAST}");
    let case = case(&sheet(&cards));
    let [body] = &case.bodies[..] else {
        panic!("{:?}", case.bodies);
    };
    assert_eq!(
        *body.shell.as_ref().unwrap().thickness,
        Thickness::Uniform(0.5)
    );
}

#[test]
fn sections_of_parts_hold_for_their_instances() {
    let deck = "*PART, NAME=P\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT, TYPE=S4R, ELSET=E\n1,1,2,3,4\n\
                *SHELL SECTION, ELSET=E, MATERIAL=M\n0.1\n*END PART\n*ASSEMBLY, NAME=A\n\
                *INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n0,0,2\n*END INSTANCE\n\
                *SURFACE, NAME=UP\nI.E, SPOS\n*SURFACE, NAME=DOWN\nJ.E, SNEG\n*END ASSEMBLY\n\
                *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*STEP\n*STATIC\n*END STEP\n";
    let read = translated(deck, Compat::None).unwrap_or_else(|found| panic!("{}", found.plain()));
    assert_eq!(read.case.bodies.len(), 2);
    assert!(read.case.bodies.iter().all(|body| body.shell.is_some()));
    assert_eq!(
        (sides(&read, "UP"), sides(&read, "DOWN")),
        (vec![1], vec![0])
    );
}

#[test]
fn what_is_no_shell_or_none_that_is_built_is_refused_by_name() {
    let with = |card: &str| sheet(&format!("{card}{LAST}"));
    let section = |head: &str, line: &str| {
        let section = format!("*SHELL SECTION, ELSET=SHEET{head}\n{line}\n");
        sheet_of("S4", &section, LAST)
    };
    let mixed =
        "*ELEMENT, TYPE=CPS4, ELSET=P\n2,1,2,3,4\n*SOLID SECTION, ELSET=P, MATERIAL=M\n1.\n";
    let membrane =
        "*ELEMENT, TYPE=M3D4, ELSET=P\n2,1,2,3,4\n*MEMBRANE SECTION, ELSET=P, MATERIAL=M\n1.\n";
    let beam = "*ELEMENT, TYPE=B31, ELSET=P\n2,1,2\n*BEAM SECTION, ELSET=P, MATERIAL=M, SECTION=RECT\n1.,1.\n";
    let solid = "*SOLID SECTION, ELSET=SHEET, MATERIAL=M\n";
    refuses(&[
        (
            section(", COMPOSITE", ".1,,M"),
            "COMPOSITE of *SHELL SECTION is not supported",
        ),
        (
            section(", MATERIAL=M, ORIENTATION=O", "0.1"),
            "ORIENTATION of *SHELL SECTION is not supported",
        ),
        (section("", "0.1"), "*SHELL SECTION has no MATERIAL"),
        (section(", MATERIAL=N", "0.1"), "there is no material `N`"),
        (
            section(", MATERIAL=M", "0."),
            "the thickness of *SHELL SECTION is 0",
        ),
        (
            section(", MATERIAL=M", ""),
            "*SHELL SECTION has no thickness",
        ),
        (
            section(", MATERIAL=M, OFFSET=FIELD", "0.1"),
            "OFFSET=FIELD of *SHELL SECTION is no number",
        ),
        (
            sheet_of("S4T", SECTION, LAST),
            "of type S4T: shells that conduct heat are not built",
        ),
        (
            sheet_of("S9R5", SECTION, LAST),
            "of type S9R5: shells of nine nodes are not built",
        ),
        (
            sheet_of(
                "M3D4",
                SECTION,
                &format!("*ELEMENT, TYPE=S4, ELSET=SHEET\n2,1,2,3,4\n{LAST}"),
            ),
            "of type M3D4: it is no shell",
        ),
        (
            sheet_of("S4", solid, LAST),
            "element 1, which is no solid: S4 (shell)",
        ),
        (
            sheet_of("S4", "", LAST),
            "element 1 of `SHEET` has no section",
        ),
        (
            sheet_of("S4", "", LAST),
            "write *SHELL SECTION, ELSET=SHEET, MATERIAL=…",
        ),
        (
            with(mixed),
            "shells (S4) and elements of the plane (CPS4) in one deck",
        ),
        (with(membrane), "*MEMBRANE SECTION is not supported"),
        (with(beam), "*BEAM SECTION is not supported"),
        (with("*NORMAL\n1,1,0.,0.,1.\n"), "*NORMAL is not supported"),
        (
            with("*SHELL GENERAL SECTION, ELSET=SHEET\n0.1\n"),
            "*SHELL GENERAL SECTION is not supported",
        ),
        (
            cube(
                "C3D8",
                &format!("{}{STEP}", SECTION.replace("SHEET", "CUBE")),
            ),
            "of type C3D8: it is no shell",
        ),
        (
            sheet("*STEP\n*HEAT TRANSFER, STEADY STATE\n*END STEP\n"),
            "heat in shells is not built",
        ),
    ]);
}

/// The sides of the shells of a surface, from 0.
fn sides(read: &Read, surface: &str) -> Vec<u8> {
    let of = |set: &Set| set.faces.iter().map(|face| face.side).collect();
    read.mesh.sets.get(surface).map_or_else(Vec::new, of)
}

#[test]
fn surfaces_name_sides_and_edges_of_shells() {
    for (kind, edges) in [("S4", 4), ("S3", 3), ("S8R", 4)] {
        let mut cases: Vec<(String, Vec<u8>)> = vec![
            ("SNEG".into(), vec![0]),
            ("SPOS".into(), vec![1]),
            (String::new(), vec![0, 1]),
        ];
        cases.extend((1..=edges + 2).map(|side| (format!("S{side}"), vec![side - 1])));
        cases.extend((1..=edges).map(|edge| (format!("E{edge}"), vec![edge + 1])));
        for (label, expected) in cases {
            for (what, deck) in [
                ("alone", sheet_of(kind, SECTION, "")),
                (
                    "by number",
                    sheet_of(kind, SECTION, "").replace("ELSET=SHEET\n1,", "ELSET=SHEET\n1, "),
                ),
            ] {
                let on = if what == "alone" { "SHEET" } else { "1" };
                let deck = format!("{deck}*SURFACE, NAME=A\n{on}, {label}\n{LAST}");
                let read = translated(&deck, Compat::None);
                let read = read.unwrap_or_else(|found| panic!("{label}: {}", found.plain()));
                assert_eq!(sides(&read, "A"), expected, "{kind} {label} {what}");
            }
        }
        let wrong = format!("S{}", edges + 3);
        let deck = sheet_of(
            kind,
            SECTION,
            &format!("*SURFACE, NAME=A\nSHEET, {wrong}\n{LAST}"),
        );
        refuses(&[(deck, "SNEG or S1, SPOS or S2, and its edges S3 to S")]);
    }
}

#[test]
fn next_to_solids_a_section_makes_the_shell() {
    let surfaces = "*SURFACE, NAME=A\nSHEET, SNEG\n*SURFACE, NAME=B\nCUBE, S2\nSHEET, SPOS\n*SURFACE, NAME=C\nCUBE\n";
    let deck = on_cube(&format!("{surfaces}{LAST}"));
    let read = translated(&deck, Compat::None).unwrap_or_else(|found| panic!("{}", found.plain()));
    assert_eq!(read.case.bodies.len(), 2);
    assert_eq!(sides(&read, "A"), [0]);
    assert_eq!(sides(&read, "B"), [1, 1]);
    assert_eq!(sides(&read, "C").len(), 6);
    // without a section it is a face of the solid, as before
    let bare = deck.replace(SECTION, "");
    let read = translated(&bare, Compat::None).unwrap_or_else(|found| panic!("{}", found.plain()));
    assert_eq!(read.case.bodies.len(), 1);
    let set = &read.mesh.sets["A"];
    assert_eq!((set.faces.len(), set.cells.len()), (0, 1));
    assert!(!read.found.plain().contains("solid-shells"));
}

#[test]
fn a_mesh_alone_has_sides_of_shells_where_a_case_has_shells() {
    use crate::readers::{read_mesh, read_mesh_of_shells};
    let surfaces = "*SURFACE, NAME=A\nSHEET, SNEG\n*SURFACE, NAME=B\nSHEET, S2\n";
    let faces = |deck: &str, name: &str| -> Vec<u8> {
        let (mesh, _) = read_mesh_of_shells("job.inp", deck.as_bytes()).unwrap();
        mesh.sets[name].faces.iter().map(|face| face.side).collect()
    };
    for deck in [
        on_cube(surfaces),
        sheet(surfaces),
        sheet_of("S4R", "", surfaces),
    ] {
        assert_eq!((faces(&deck, "A"), faces(&deck, "B")), (vec![0], vec![1]));
    }
    // next to solids and without a section, and in cases without shells, they are faces of solids
    let bare = on_cube(surfaces).replace(SECTION, "");
    assert!(faces(&bare, "A").is_empty());
    let (mesh, _) = read_mesh("job.inp", on_cube(surfaces).as_bytes()).unwrap();
    assert_eq!(
        (mesh.sets["A"].faces.len(), mesh.sets["A"].cells.len()),
        (0, 1)
    );
    assert!(read_mesh("job.inp", sheet(surfaces).as_bytes()).is_err());
}

#[test]
fn rotations_of_shells_are_held_and_not_moved() {
    let cards = step("*BOUNDARY\nLEFT, ENCASTRE\nRIGHT, 4, 5\n2, 3, 6\n5, YSYMM\n");
    let case = case(&sheet(&cards));
    let held: Vec<_> = case.steps[0]
        .fixes
        .iter()
        .map(|fix| (fix.on.as_str(), fix.u.xyz, fix.rot.xyz))
        .collect();
    let no = [false; 3];
    let all = [true; 3];
    assert!(held.contains(&("LEFT", all, all)), "{held:?}");
    assert!(
        held.contains(&("RIGHT", no, [true, true, false])),
        "{held:?}"
    );
    assert!(
        held.contains(&("node-2", [false, false, true], all)),
        "{held:?}"
    );
    // a node of no element has no rotations
    assert!(
        held.contains(&("node-5", [false, true, false], no)),
        "{held:?}"
    );
    has(&text_of(&case), &["rot = \"all\"", "rot = [\"x\", \"y\"]"]);
    let turned = "*TRANSFORM, NSET=LEFT, TYPE=R\n1,1,0,-1,1,0\n";
    refuses(&[
        (
            sheet(&step("*BOUNDARY\nRIGHT, 5, 5, 0.1\n")),
            "rotations of shells can be held, not yet moved",
        ),
        (
            sheet(&format!("{turned}{}", step("*BOUNDARY\n1, 1, 6\n"))),
            "rotations of node 1, of a shell, along local axes",
        ),
    ]);
    let shifted = crate::deck::tests::case(&sheet(&format!(
        "{turned}{}",
        step("*BOUNDARY\n1, 1, 3\n2, 4, 6\n")
    )));
    assert_eq!(shifted.steps[0].fixes.len(), 2);
}

#[test]
fn rotations_are_of_the_nodes_of_shells_alone() {
    let case = case(&on_cube(&step(
        "*BOUNDARY\nSIDE, 1, 6\nALL, 1, 6\nBASE, 4, 6\n",
    )));
    let step = &case.steps[0];
    let nodes = |name: &str| -> Vec<u64> {
        let set = case.sets.iter().find(|set| set.name.as_str() == name);
        match set.map(|set| &set.content) {
            Some(SetContent::Nodes(nodes)) => nodes.clone(),
            _ => Vec::new(),
        }
    };
    let [side, shells, others] = &step.fixes[..] else {
        panic!("{:?}", step.fixes);
    };
    assert_eq!((side.on.as_str(), side.rot.xyz), ("SIDE", [true; 3]));
    assert_eq!((nodes(&shells.on), shells.rot.xyz), (vec![6, 7], [true; 3]));
    assert_eq!(
        (nodes(&others.on), others.rot.xyz),
        (vec![1, 2, 3, 4, 5, 8], [false; 3])
    );
}

#[test]
fn what_is_released_sets_rotations_free() {
    let cards = format!(
        "*BOUNDARY\nLEFT, 1, 6\n{LAST}{}",
        step("*BOUNDARY, OP=NEW\nLEFT, 1, 3\n")
    );
    let case = case(&sheet(&cards));
    let free = &case.steps[1].frees[0];
    assert_eq!(
        (free.on.as_str(), free.u.xyz, free.rot.xyz),
        ("LEFT", [true; 3], [true; 3])
    );
    // what stays held goes back to where it was
    let back = Some(Motion::Ramp(0.0));
    let one = &case.steps[1].moves[0];
    assert_eq!(one.u, [back.clone(), back.clone(), back]);
    assert_eq!(one.rot, [None, None, None]);
}

#[test]
fn moments_act_at_each_node_of_a_shell() {
    let case = case(&sheet(&step(
        "*CLOAD\nRIGHT, 5, 0.5\nRIGHT, 3, 2.\nLEFT, 4, 1.\n",
    )));
    let loads = &case.steps[0].loads;
    let of = |kind: Chosen| loads.iter().filter(|load| load.kind == kind).count();
    assert_eq!(loads.len(), 3);
    assert_eq!(of(vector("moment", [0.0, 0.5, 0.0])), 1);
    assert_eq!(of(vector("moment", [1.0, 0.0, 0.0])), 1);
    assert_eq!(of(vector("per_node", [0.0, 0.0, 2.0])), 1);
    has(&text_of(&case), &["moment = [0.0, 0.5, 0.0]"]);
    let turned = "*TRANSFORM, NSET=RIGHT, TYPE=R\n1,1,0,-1,1,0\n";
    let local =
        crate::deck::tests::case(&sheet(&format!("{turned}{}", step("*CLOAD\n2, 4, 1.\n"))));
    let Some(Value::Numbers(along)) = local.steps[0].loads[0].kind.bare_value() else {
        panic!("{:?}", local.steps[0].loads);
    };
    assert!((along[0] - FRAC_1_SQRT_2).abs() < 1e-15 && (along[1] - FRAC_1_SQRT_2).abs() < 1e-15);
    refuses(&[(
        on_cube(&step("*CLOAD\n1, 5, 1.\n")),
        "node 1 bears no moment",
    )]);
}

#[test]
fn pressures_push_along_the_normal_and_edges_inwards() {
    let on = |load: &crate::case::Load, case: &Case| {
        let set = case.sets.iter().find(|set| set.name == load.on);
        match set.map(|set| &set.content) {
            Some(SetContent::Faces(faces)) => faces.clone(),
            _ => Vec::new(),
        }
    };
    for (label, name, side) in [
        ("P", "pressure", 1),
        ("P1", "pressure", 1),
        ("P4", "pressure", 1),
        ("EDNOR1", "line", 3),
        ("EDNOR4", "line", 6),
    ] {
        let case = case(&sheet(&step(&format!("*DLOAD\nSHEET, {label}, 1.5\n"))));
        let [load] = &case.steps[0].loads[..] else {
            panic!("{label}");
        };
        assert_eq!(load.kind, Chosen::bare(name, Value::Number(1.5)));
        assert_eq!(on(load, &case), [(1, Side::Numbered(side))], "{label}");
    }
    // sides of solids keep their numbers; a load that ends is one of nothing
    let two = "*DLOAD\nCUBE, P2, 3.\nSHEET, P, 4.\nSHEET, EDNOR2, 5.\n*END STEP\n*STEP\n*STATIC\n*DLOAD, OP=NEW\n";
    let both = case(&on_cube(&step(two)));
    let sides: Vec<_> = both.steps[0]
        .loads
        .iter()
        .map(|load| on(load, &both))
        .collect();
    let side = |element, side| vec![(element, Side::Numbered(side))];
    assert_eq!(sides.len(), 3);
    for wanted in [side(1, 2), side(11, 1), side(11, 4)] {
        assert!(sides.contains(&wanted), "{sides:?}");
    }
    assert_eq!(both.steps[1].loads.len(), 3);
    let by_mass = case(&sheet(&step(
        "*DLOAD\nSHEET, GRAV, 9.81, 0., 0., -1.\nSHEET, CENTRIF, 4., 0.,0.,0., 0.,0.,1.\n",
    )));
    let names: Vec<&str> = by_mass.steps[0]
        .loads
        .iter()
        .map(|load| load.kind.name)
        .collect();
    assert_eq!(names.len(), 2);
    assert!(names.contains(&"gravity") && names.contains(&"centrifugal"));
    let on_surface = sheet(&format!(
        "*SURFACE, NAME=A\nSHEET, SPOS\n{}",
        step("*DSLOAD\nA, P, 2.\n")
    ));
    let load = &case(&on_surface).steps[0].loads[0];
    assert_eq!((load.on.as_str(), load.kind.name), ("A", "pressure"));
    refuses(&[
        (
            sheet(&step("*DLOAD\nSHEET, PNOR, 1.\n")),
            "*DLOAD has no load `PNOR` here",
        ),
        (
            sheet(&step("*DLOAD\nSHEET, EDNOR5, 1.\n")),
            "*DLOAD has no load `EDNOR5` here",
        ),
        (
            on_cube(&step("*DLOAD\nCUBE, EDNOR1, 1.\n")),
            "EDNOR1 does not act on element 1, which is no shell",
        ),
        (
            on_cube(&step("*DLOAD\nCUBE, P, 1.\n")),
            "P does not act on element 1, which is no shell",
        ),
        (
            cube("C3D8", &step("*DLOAD\nCUBE, P, 1.\n")),
            "*DLOAD has no load `P` here",
        ),
    ]);
}

#[test]
fn temperatures_of_shells_have_a_gradient() {
    let cards = format!(
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20., 3.\n{}",
        step("*TEMPERATURE\nALL, 100., -5.\n")
    );
    let case = case(&sheet(&cards));
    let one = &case.steps[0].temperatures[0];
    assert_eq!((one.on.as_str(), &one.value), ("ALL", &Motion::Ramp(100.0)));
    assert_eq!(
        one.gradient.as_ref().map(|gradient| gradient.value),
        Some(-5.0)
    );
    assert_eq!(
        case.initial_temperature.as_ref().map(|one| one.value),
        Some(20.0)
    );
    let start = &case.initial_temperatures[0];
    assert_eq!((start.temperature, start.gradient), (20.0, Some(3.0)));
    let expansion = case.materials[0].expansion.as_ref().unwrap();
    assert_eq!(expansion.free.value, Unstrained::AtStart);
    has(&text_of(&case), &["gradient = -5.0", "gradient = 3.0"]);
    // without one, as for solids
    let even = sheet(&cards.replace(", 3.", "").replace(", -5.", ", 0."));
    let even = crate::deck::tests::case(&even);
    assert!(
        even.initial_temperatures.is_empty() && even.steps[0].temperatures[0].gradient.is_none()
    );
    let of_solids = "*TEMPERATURE\nBASE, 100., -5.\n";
    refuses(&[
        (
            cube("C3D8", &step(of_solids)),
            "*TEMPERATURE takes 2 values on a line, found 3",
        ),
        (
            on_cube(&step(of_solids)),
            "a gradient of temperature at nodes that belong to no shell",
        ),
        (
            sheet(&step("*TEMPERATURE\nALL, 1., 2., 3.\n")),
            "takes 2 to 3 values",
        ),
    ]);
}

#[test]
fn constraints_take_the_displacements_of_shells() {
    let rigid =
        "*NODE\n20,0,0,3\n*RIGID BODY, ELSET=SHEET, REF NODE=20\n*EQUATION\n2\n1,1,1.,2,1,-1.\n";
    let case = case(&sheet(&format!("{rigid}{}", step("*BOUNDARY\n20, 1, 6\n"))));
    assert!(case.bodies[0].shell.is_some() && !case.bodies[0].rigid);
    let [
        ConstraintKind::Kinematic { on, .. },
        ConstraintKind::Equation { terms, .. },
    ] = [&case.constraints[0].kind, &case.constraints[1].kind]
    else {
        panic!("{:?}", case.constraints);
    };
    assert_eq!((on.as_str(), terms.len()), ("SHEET", 2));
    assert_eq!(case.steps[0].fixes[0].rot.xyz, [true; 3]);
    let both =
        "*NODE\n20,0,0,3\n*ELSET, ELSET=BOTH\nCUBE, SHEET\n*RIGID BODY, ELSET=BOTH, REF NODE=20\n";
    let cyclic = "*SURFACE, NAME=A\nSHEET, S3\n*SURFACE, NAME=B\nSHEET, S5\n*TIE, CYCLIC SYMMETRY, NAME=T\nA, B\n\
                  *CYCLIC SYMMETRY MODEL, N=4, TIE=T\n0,0,0,0,0,1\n";
    refuses(&[
        (
            sheet(&format!("*EQUATION\n2\n1,5,1.,2,5,-1.\n{LAST}")),
            "*EQUATION of degree of freedom 5 is not supported",
        ),
        (
            on_cube(&format!("{both}{LAST}")),
            "*RIGID BODY of shells and other elements together",
        ),
        (
            sheet(&format!("{cyclic}{LAST}")),
            "*CYCLIC SYMMETRY MODEL of shells is not supported",
        ),
    ]);
}

#[test]
fn contact_and_ties_name_faces_and_nodes_of_shells() {
    let surfaces = "*SURFACE, NAME=A\nSHEET, SNEG\n*SURFACE, NAME=N, TYPE=NODE\nSIDE\n*SURFACE INTERACTION, NAME=I\n\
                    *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n100.\n";
    let pair = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nA, SOLE\n*TIE, NAME=T\nN, SOLE\n*TIE, NAME=U\nLID, A\n";
    let contacts = case(&on_cube(&format!("{surfaces}{pair}{LAST}"))).contacts;
    let named: Vec<_> = contacts
        .iter()
        .map(|one| (one.secondary.as_str(), one.primary.as_str()))
        .collect();
    assert!(
        named.contains(&("A", "SOLE")) && named.contains(&("LID", "A")),
        "{named:?}"
    );
    assert!(named.contains(&("N", "SOLE")), "{named:?}");
    // its tolerance is positive, though the shell is flat
    let tie = contacts
        .iter()
        .find(|one| one.secondary.as_str() == "LID")
        .unwrap();
    assert!(
        tie.tied
            .as_ref()
            .is_some_and(|tied| tied.within.as_ref().is_some_and(|within| *within > 0.0))
    );
}

#[test]
fn results_in_two_dimensions_are_left_out_with_a_note() {
    let cards = step(
        "*NODE FILE, OUTPUT=2D\nU\n*EL FILE, OUTPUT=2D\nS\n*NODE PRINT, NSET=ALL\nU\n*EL PRINT, ELSET=SHEET\nS\n",
    );
    let read = translated(&sheet(&cards), Compat::None).unwrap();
    let notes = read.found.plain();
    assert_eq!(notes.matches("OUTPUT=2D is left out").count(), 1, "{notes}");
    assert_eq!(read.case.steps[0].prints.as_ref().map(Vec::len), Some(2));
    let read = translated(&sheet(&cards.replace("2D", "3D")), Compat::None).unwrap();
    assert!(!read.found.plain().contains("OUTPUT=2D"));
}

#[test]
fn decks_of_shells_with_answers_translate() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/cards");
    let Ok(files) = std::fs::read_dir(&folder) else {
        eprintln!("SKIPPED: no shared/cases/cards next to the repository");
        return;
    };
    let mut count = 0;
    for file in files {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let is_of_shells = name.starts_with("shell_") || name == "nodal_thickness_shell.inp";
        if !is_of_shells || !name.ends_with(".inp") {
            continue;
        }
        let text = std::fs::read(&path).unwrap();
        let found = read(&RealFs, &name, &text, Compat::None);
        match found {
            Err(found) if name == "shell_composite_axial.inp" => {
                assert!(
                    found.plain().contains("COMPOSITE of *SHELL SECTION"),
                    "{}",
                    found.plain()
                );
            }
            Err(found) => panic!("{name}: {}", found.plain()),
            Ok(read) => assert!(
                read.case.bodies.iter().any(|body| body.shell.is_some()),
                "{name}"
            ),
        }
        count += 1;
    }
    assert!(count >= 15, "{count}");
}
