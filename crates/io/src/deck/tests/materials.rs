//! Materials and their constants.

use super::*;
use crate::case::{Thickness, Unstrained};

#[test]
fn stiffnesses_of_an_orthotropic_law_become_its_moduli() {
    // isotropic, E = 1000 and nu = 0.25: lambda = mu = 400
    let ortho = "*ELASTIC, TYPE=ORTHO\n1200.,400.,1200.,400.,400.,1200.,400.,400.\n400.\n";
    let text = cube("C3D8", STEP).replace("*ELASTIC\n1000., 0.3\n", ortho);
    let material = &case(&text).materials[0];
    for (name, value) in [
        ("E1", 1000.0),
        ("E3", 1000.0),
        ("nu13", 0.25),
        ("G23", 400.0),
    ] {
        let found = material.number(name).unwrap();
        assert!((found / value - 1.0).abs() < 1e-12, "{name}: {found}");
    }
}

/// The first material of a deck whose material has these cards in place of its elastic constants.
fn material(cards: &str) -> crate::case::Material {
    let deck = cube("C3D8", STEP).replace("*ELASTIC\n1000., 0.3\n", cards);
    case(&deck).materials[0].clone()
}

fn constant(material: &crate::case::Material, name: &str) -> Vec<f64> {
    let found = material.constants.iter().find(|one| one.name == name);
    found.unwrap().values.value.clone()
}

#[test]
fn constants_depend_on_temperature_where_their_rows_differ() {
    let hot = material(
        "*ELASTIC\n150., .31, 500.\n200., .3, 0.\n*EXPANSION, ZERO=20.\n1e-5, 0.\n2e-5, 500.\n",
    );
    assert_eq!(hot.model.value, "linear-elastic-by-temperature");
    assert_eq!(constant(&hot, "T"), [0.0, 500.0]);
    assert_eq!(constant(&hot, "E"), [200.0, 150.0]);
    assert_eq!(constant(&hot, "nu"), [0.3, 0.31]);
    let expansion = hot.expansion.unwrap();
    assert_eq!(expansion.alpha, [[0.0, 1e-5], [500.0, 2e-5]]);
    assert_eq!(expansion.reference, 20.0);
    assert_eq!(expansion.free.value, Unstrained::At(20.0));
    let same =
        material("*ELASTIC\n200., .3, 0.\n200., .3, 500.\n*EXPANSION\n1e-5, 0.\n1e-5, 500.\n");
    assert_eq!(same.model.value, "linear-elastic");
    assert_eq!(same.expansion.unwrap().alpha, [[0.0, 1e-5]]);
    let start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 100.\n*STEP";
    let deck = cube("C3D8", STEP).replace("1000., 0.3\n", "1000., 0.3\n*EXPANSION\n1e-5\n");
    let expansion = case(&deck.replace("*STEP", start)).materials[0]
        .expansion
        .clone();
    assert_eq!(expansion.unwrap().free.value, Unstrained::At(100.0));
    let text = refused(&cube("C3D8", STEP).replace(
        "1000., 0.3\n",
        "1000., 0.3, 0.\n900., 0.3, 100.\n*PLASTIC\n10., 0.\n",
    ));
    assert!(text.contains("*PLASTIC does not go with"), "{text}");
}

#[test]
fn anisotropic_constants_are_taken_in_their_order() {
    let numbers: Vec<f64> = (1..=21).map(f64::from).collect();
    let text: Vec<String> = numbers.iter().map(f64::to_string).collect();
    let rows: Vec<String> = text.chunks(8).map(|row| row.join(", ")).collect();
    let law = material(&format!("*ELASTIC, TYPE=ANISO\n{}\n", rows.join("\n")));
    assert_eq!(law.model.value, "anisotropic");
    assert_eq!(constant(&law, "D"), numbers);
}

#[test]
fn hyperelastic_laws_have_the_bulk_modulus_of_d() {
    let law = material("*HYPERELASTIC, NEO HOOKE\n3., 0.1\n");
    assert_eq!(law.model.value, "mooney-rivlin");
    assert_eq!(
        [constant(&law, "c10"), constant(&law, "bulk")],
        [[3.0], [20.0]]
    );
    let law = material("*HYPERELASTIC, MOONEY-RIVLIN\n3., 1., 0.1\n");
    assert_eq!(
        [constant(&law, "c10"), constant(&law, "c01")],
        [[3.0], [1.0]]
    );
    let law = material("*HYPERELASTIC, OGDEN, N=2\n3., 2., 1., -2., 0.1, 0.\n");
    assert_eq!(law.model.value, "ogden");
    assert_eq!(constant(&law, "mu"), [3.0, 1.0]);
    assert_eq!(constant(&law, "alpha"), [2.0, -2.0]);
    assert_eq!(constant(&law, "bulk"), [20.0]);
    // without D: a Poisson's ratio of 0.475
    let law = material("*HYPERELASTIC, OGDEN, N=1\n3., 2., 0.\n");
    assert!((constant(&law, "bulk")[0] - 3.0 * 2.0 * 1.475 / 0.15).abs() < 1e-12);
    let law = material("*HYPERFOAM, N=2\n3., 2., 1., -2., 0.1, 0.2\n");
    assert_eq!(law.model.value, "hyperfoam");
    assert_eq!(
        [constant(&law, "mu"), constant(&law, "nu")],
        [[3.0, 1.0], [0.1, 0.2]]
    );
}

/// The first material of a deck with this name and these cards.
fn named(name: &str, cards: &str) -> String {
    let deck = cube("C3D8", STEP).replace("*ELASTIC\n1000., 0.3\n", cards);
    let deck = deck.replace("NAME=M\n", &format!("NAME={name}\n"));
    deck.replace("MATERIAL=M\n", &format!("MATERIAL={name}\n"))
}

#[test]
fn the_start_of_a_name_chooses_the_law_of_a_user_material() {
    let card = "*USER MATERIAL, CONSTANTS=2\n1000., .3\n*DEPVAR\n5\n";
    for (name, model, second) in [
        ("LIN_ISO_EL", "saint-venant-kirchhoff", "nu"),
        ("lin_iso_el_of_the_foot", "saint-venant-kirchhoff", "nu"),
        ("UNDO_NLGEOM_LIN_ISO_EL", "rotated-linear", "nu"),
        ("Undo_Nlgeom_Lin_El7", "rotated-linear", "nu"),
        ("CIARLET_EL", "ciarlet", "nu"),
        ("COMPRESSION_ONLY", "no-tension", "residual"),
        ("TENSION_ONLY_2", "no-compression", "residual"),
    ] {
        let law = case(&named(name, card)).materials[0].clone();
        assert_eq!(law.model.value, model, "{name}");
        assert_eq!(constant(&law, "E"), [1000.0]);
        assert_eq!(constant(&law, second), [0.3], "{name}");
    }
    let hot = "*USER MATERIAL, CONSTANTS=2\n1000., .3, 0.\n900., .3, 100.\n";
    let law = case(&named("LIN_ISO_EL", hot)).materials[0].clone();
    assert_eq!(law.model.value, "linear-elastic-by-temperature");
    let same = hot.replace("900.", "1000.");
    let law = case(&named("CIARLET_EL", &same)).materials[0].clone();
    assert_eq!(law.model.value, "ciarlet");
    for (name, cards, expected) in [
        (
            "CIARLET_EL",
            hot,
            "constants of CIARLET_EL that depend on temperature",
        ),
        (
            "MYMAT",
            card,
            "the law MYMAT of *USER MATERIAL is a subroutine that this deck does not contain",
        ),
        (
            "ABAQUSNL_X",
            card,
            "the law ABAQUSNL_X of *USER MATERIAL is a subroutine",
        ),
        (
            "SINGLE_CRYSTAL",
            card,
            "the law SINGLE_CRYSTAL of *USER MATERIAL is not built",
        ),
        (
            "ELASTIC_FIBER1",
            card,
            "the law ELASTIC_FIBER of *USER MATERIAL is not built",
        ),
        (
            "CIARLET_EL",
            "*USER MATERIAL, CONSTANTS=3\n1000., .3, 1.\n",
            "CIARLET_EL has 2 constants, E and nu; CONSTANTS=3 is given",
        ),
        (
            "CIARLET_EL",
            "*USER MATERIAL\n1000., .3\n",
            "CONSTANTS is missing",
        ),
        (
            "CIARLET_EL",
            "*USER MATERIAL, CONSTANTS=2\n1000.\n",
            "takes 2 to 3 values",
        ),
        (
            "CIARLET_EL",
            "*USER MATERIAL, CONSTANTS=TWO\n1000., 1.\n",
            "no whole number",
        ),
        (
            "LIN_ISO_EL",
            "*USER MATERIAL, CONSTANTS=2\n1000.,.3\n*PLASTIC\n10., 0.\n",
            "*PLASTIC does not go with",
        ),
        (
            "CIARLET_EL",
            "*USER MATERIAL, CONSTANTS=2\n",
            "*USER MATERIAL has no data",
        ),
    ] {
        let text = refused(&named(name, cards));
        assert!(text.contains(expected), "{name}: {text}");
        assert!(
            !text.contains("has no elastic constants") || text.contains("no data"),
            "{text}"
        );
    }
}

#[test]
fn deformation_plasticity_has_its_five_constants_and_large_strains_with_calculix() {
    let deck = named("M", "*DEFORMATION PLASTICITY\n1000., .3, 10., 5., .5\n");
    let law = case(&deck).materials[0].clone();
    assert_eq!(law.model.value, "ramberg-osgood-eulerian");
    for (name, value) in [
        ("E", 1000.0),
        ("nu", 0.3),
        ("reference_stress", 10.0),
        ("exponent", 5.0),
        ("offset", 0.5),
    ] {
        assert_eq!(constant(&law, name), [value]);
    }
    let geometry = |compat| case_as(&deck, compat).steps[0].geometry;
    assert_eq!(geometry(Compat::None), crate::case::Geometry::Linear);
    assert_eq!(geometry(Compat::Ccx), crate::case::Geometry::Nonlinear);
    let note = translated(&deck, Compat::None).unwrap().found.plain();
    assert!(
        note.contains("strains are small in steps without NLGEOM"),
        "{note}"
    );
    let text = refused(&named("M", "*DEFORMATION PLASTICITY\n1000., .3, 10., 5.\n"));
    assert!(text.contains("takes 5 to 6 values"), "{text}");
    let two = "*DEFORMATION PLASTICITY\n1000., .3, 10., 5., .5, 0.\n900., .3, 10., 5., .5, 9.\n";
    let text = refused(&named("M", two));
    assert!(text.contains("depend on temperature"), "{text}");
}

#[test]
fn thicknesses_at_nodes_count_where_sections_ask_for_them() {
    let plane = "*NODE, NSET=N\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=CPS4, ELSET=E\n1,1,2,3,4\n\
                 *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
                 *NODAL THICKNESS\nN, .1\n1, .2\n*STEP\n*STATIC\n*BOUNDARY\n1,1,2\n*END STEP\n";
    let read = translated(plane, Compat::None).unwrap();
    let found = read.found.plain();
    assert!(
        found.contains("given for 4 nodes whose section does not ask for it"),
        "{found}"
    );
    assert_eq!(read.case.model.thickness, 1.0);
    let asked = plane.replace("MATERIAL=M\n1.", "MATERIAL=M, NODAL THICKNESS\n1.");
    let read = translated(&asked, Compat::None).unwrap();
    let found = read.found.plain();
    assert!(!found.contains("does not ask"), "{found}");
    let body = &read.case.bodies[0];
    let thickness = body.thickness.as_ref().map(|of| of.value);
    assert_eq!(thickness, Some(Thickness::Field));
    let values: Vec<f64> = read.case.thicknesses.iter().map(|one| one.value).collect();
    assert_eq!(values, [0.1, 0.2]);
    let other = asked.replace("*NODAL", "*NODE\n5, 2, 0\n*NODAL");
    let other = other.replace("1, .2\n", "1, .2\n5, .2\n");
    let found = translated(&other, Compat::None).unwrap().found.plain();
    assert!(found.contains("given for 1 node whose section"), "{found}");
    let text = refused(&asked.replace("1, .2", "1, 0."));
    assert!(text.contains("is 0"), "{text}");
    let text = refused(&plane.replace("N, .1", "N"));
    assert!(text.contains("takes 2 to 3 values"), "{text}");
    let text = refused(&plane.replace("N, .1", "N, -.1"));
    assert!(text.contains("is -0.1"), "{text}");
}

/// The case of a cube whose section has an orientation made by these cards.
fn oriented(cards: &str) -> String {
    let deck = cube("C3D8", STEP).replace("MATERIAL=M\n", "MATERIAL=M, ORIENTATION=C\n");
    deck.replace("*MATERIAL", &format!("{cards}*MATERIAL"))
}

#[test]
fn orientations_that_vary_get_a_name_in_the_case() {
    use crate::case::{BodyAxes, MaterialSystem};
    let cards = "*ORIENTATION, NAME=c, SYSTEM=CYLINDRICAL\n1.,2.,3.,1.,2.,5.\n3, 45.\n";
    let found = case(&oriented(cards));
    let Some(BodyAxes::Named(name)) = &found.bodies[0].orientation else {
        panic!("{:?}", found.bodies[0].orientation);
    };
    assert_eq!(
        (name.as_str(), found.orientations[0].name.as_str()),
        ("c", "c")
    );
    let expected = MaterialSystem::Cylindrical {
        origin: [1.0, 2.0, 3.0],
        axis: [0.0, 0.0, 2.0],
    };
    assert_eq!(found.orientations[0].system, expected);
    assert_eq!(found.orientations[0].turn, Some((2, 45.0)));
    let cards = "*ORIENTATION, NAME=C\nD\n2, 30.\n\
                 *DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T\n, 1.,0.,0.,0.,1.,0.\nCUBE, 0.,1.,0.,0.,0.,1.\n\
                 *DISTRIBUTION TABLE, NAME=T\nCOORD3D, COORD3D\n";
    let found = case(&oriented(cards));
    let MaterialSystem::Elements { x, y, rows } = &found.orientations[0].system else {
        panic!("{:?}", found.orientations);
    };
    assert_eq!((*x, *y), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert_eq!(rows.len(), 1);
    assert_eq!(
        (rows[0].element, rows[0].x, rows[0].y),
        (1, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    );
    assert_eq!(found.orientations[0].turn, Some((1, 30.0)));
    // rectangular ones stay with their body
    let found = case(&oriented("*ORIENTATION, NAME=C\n1.,0.,0.,0.,1.,0.\n"));
    assert!(matches!(
        found.bodies[0].orientation,
        Some(BodyAxes::Here(_))
    ));
    for (cards, expected) in [
        (
            "*ORIENTATION, NAME=C, SYSTEM=C\n1.,2.,3.,1.,2.,3.\n",
            "give no axes",
        ),
        (
            "*ORIENTATION, NAME=C, SYSTEM=C\n0.,0.,0.,0.,0.,1.\n4, 30.\n",
            "local axis 4",
        ),
        ("*ORIENTATION, NAME=C\nD\n", "there is no *DISTRIBUTION `D`"),
        (
            "*DISTRIBUTION, NAME=D\n1, 1.,0.,0.,0.,1.,0.\n*ORIENTATION, NAME=C\nD\n",
            "the first line of *DISTRIBUTION is the default",
        ),
        (
            "*DISTRIBUTION, NAME=D\n, 1.,0.,0.,2.,0.,0.\n*ORIENTATION, NAME=C\nD\n",
            "give no axes",
        ),
        (
            "*DISTRIBUTION, NAME=D\n, 1.,0.,0.,0.,1.,0.\n9, 1.,0.,0.,0.,1.,0.\n*ORIENTATION, NAME=C\nD\n",
            "there is no element 9",
        ),
        (
            "*DISTRIBUTION, NAME=D\n, 1.,0.,0.,0.,1.,0.\n*ORIENTATION, NAME=C, SYSTEM=C\nD\n",
            "of a *DISTRIBUTION is not supported",
        ),
    ] {
        let text = refused(&oriented(cards));
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

#[test]
fn tensors_of_materials_with_axes_are_printed_along_them_unless_global_is_asked_for() {
    let axes = "*ORIENTATION, NAME=C, SYSTEM=C\n0.,0.,9.,0.,1.,9.\n";
    for (cards, parameter, expected) in [
        (axes, "", true),
        (axes, ", GLOBAL=NO", true),
        (axes, ", GLOBAL=YES", false),
    ] {
        let print = format!("*EL PRINT, ELSET=CUBE{parameter}\nS\n*END STEP");
        let found = case(&oriented(cards).replace("*END STEP", &print));
        let prints = found.steps[0].prints.as_ref().unwrap();
        assert_eq!(prints[0].local, expected, "{parameter}");
    }
    let print = "*EL PRINT, ELSET=CUBE\nS\n*END STEP";
    let found = case(&cube("C3D8", STEP).replace("*END STEP", print));
    assert!(!found.steps[0].prints.as_ref().unwrap()[0].local);
}

#[test]
fn whole_sections_may_change_their_material() {
    let cards = "*MATERIAL, NAME=N\n*ELASTIC\n500., 0.3\n*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n\
                 *CHANGE SOLID SECTION, ELSET=CUBE, MATERIAL=N\n*END STEP\n";
    let changed = case(&cube("C3D8", cards));
    assert!(changed.steps[0].materials.is_empty());
    let [change] = &changed.steps[1].materials[..] else {
        panic!("{:?}", changed.steps[1])
    };
    assert_eq!(
        (change.group.as_str(), change.material.as_str()),
        ("CUBE", "N")
    );
    let message = refused(&cube(
        "C3D8",
        &cards.replace("MATERIAL=N\n*END", "MATERIAL=O\n*END"),
    ));
    assert!(message.contains("there is no material `O`"), "{message}");
    let two = "*ELEMENT, TYPE=C3D8, ELSET=CUBE\n2,1,2,3,4,5,6,7,8\n*ELSET, ELSET=ONE\n1\n";
    let part = cards.replace("ELSET=CUBE, MATERIAL=N", "ELSET=ONE, MATERIAL=N");
    let message = refused(&cube("C3D8", &format!("{two}{part}")));
    assert!(message.contains("a part of a section"), "{message}");
}
