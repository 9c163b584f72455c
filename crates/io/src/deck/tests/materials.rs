//! Materials and their constants.

use super::*;
use crate::case::Unstrained;

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
