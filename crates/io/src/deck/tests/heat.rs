//! Steps that solve for temperatures, what acts in them, and what crosses contacts.

use super::*;
use crate::case::{
    Body, Conductance, Conduction, Conductivity, Constants, FrictionHeat, Load, Motion, Thermal,
};
use signorini_vocabulary::Value;

const HEAT: &str = "*STEP\n*HEAT TRANSFER, STEADY STATE\n*BOUNDARY\nBASE, 11, 11, 20.\n*END STEP\n";
const CONDUCTS: &str = "*CONDUCTIVITY\n50.\n*DENSITY\n7.8e-9\n*SPECIFIC HEAT\n4.6e8\n";

/// The cube of a material that conducts and stores heat, with more cards.
fn warm(cards: &str) -> String {
    cube("C3D8", cards).replace("1000., 0.3\n", &format!("1000., 0.3\n{CONDUCTS}"))
}

/// One step with these cards in it.
fn step(procedure: &str, cards: &str) -> String {
    format!("*STEP\n{procedure}\n{cards}*END STEP\n")
}

#[test]
fn procedures_say_what_is_unknown_and_whether_bodies_store_heat() {
    for (procedure, coupled, transient) in [
        ("*HEAT TRANSFER", false, true),
        ("*HEAT TRANSFER, STEADY STATE", false, false),
        ("*COUPLED TEMPERATURE-DISPLACEMENT", true, true),
        (
            "*Coupled temperature-displacement, steady state",
            true,
            false,
        ),
        ("*UNCOUPLED TEMPERATURE-DISPLACEMENT", true, true),
    ] {
        let found = case(&warm(&step(procedure, "*BOUNDARY\nBASE, 11, 11, 20.\n")));
        let expected = Thermal { coupled, transient };
        assert_eq!(found.steps[0].thermal, Some(expected), "{procedure}");
    }
    assert_eq!(case(&warm(STEP)).steps[0].thermal, None);
}

#[test]
fn materials_conduct_by_temperature_and_direction_and_store_by_mass() {
    let heat = |cards: &str| -> Conduction {
        let text = warm(HEAT).replace(CONDUCTS, cards);
        case(&text).materials.remove(0).heat.unwrap()
    };
    let found = heat(CONDUCTS);
    assert_eq!(
        found.conductivity,
        Conductivity::Isotropic(vec![[0.0, 50.0]])
    );
    assert_eq!(found.specific_heat, [[0.0, 4.6e8]]);
    // rows come in any order; without a density nothing is stored
    let found = heat("*CONDUCTIVITY\n40., 300.\n50., 20.\n*SPECIFIC HEAT\n4.6e8\n");
    let rows = vec![[20.0, 50.0], [300.0, 40.0]];
    assert_eq!(found.conductivity, Conductivity::Isotropic(rows));
    assert!(found.specific_heat.is_empty());
    let found = heat("*CONDUCTIVITY, TYPE=ORTHO\n1., 2., 3.\n");
    assert_eq!(found.conductivity, Conductivity::Along([1.0, 2.0, 3.0]));
    // 11, 12, 22, 13, 23, 33 in a deck; 11, 22, 33, 12, 23, 13 in a case
    let found = heat("*CONDUCTIVITY, TYPE=ANISO\n1., 4., 2., 6., 5., 3., 20.\n");
    let row = [20.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(found.conductivity, Conductivity::Full(vec![row]));
    let found = heat(&format!("{CONDUCTS}*LATENT HEAT\n1e11, 600., 650.\n"));
    assert_eq!(found.latent_heat, [[1e11, 600.0, 650.0]]);
    let found = refused(&warm(HEAT).replace("50.\n", "50., 20.\n60., 20.\n"));
    assert!(found.contains("two lines of one temperature"), "{found}");
}

#[test]
fn what_only_conducts_needs_no_elastic_constants_unless_a_step_deforms_it() {
    let bare = warm(HEAT).replace("*ELASTIC\n1000., 0.3\n", "");
    let material = case(&bare).materials.remove(0);
    assert_eq!(material.model.value, "");
    let both = bare.replace("*HEAT TRANSFER", "*COUPLED TEMPERATURE-DISPLACEMENT");
    assert!(refused(&both).contains("has no elastic constants"));
    let then = format!("{bare}{STEP}");
    assert!(refused(&then).contains("has no elastic constants"));
    // elements of heat are those of their shape
    let of_heat = bare.replace("TYPE=C3D8,", "TYPE=DC3D8,");
    let bodies: Vec<Body> = case(&of_heat).bodies;
    assert_eq!(bodies.len(), 1);
}

/// The loads of a case by their names, with a number of each.
fn sizes(loads: &[Load]) -> Vec<(&str, &str, f64)> {
    let of_load = |load: &Load| -> (String, f64) {
        let keys = ["h", "emissivity", load.kind.name];
        let mut found = keys.iter().filter_map(|key| load.kind.values.get(key));
        match found.next() {
            Some(Value::Number(number)) => (load.on.value.clone(), *number),
            _ => (load.on.value.clone(), f64::NAN),
        }
    };
    let all = loads.iter().map(|load| (load.kind.name, of_load(load)));
    let leaked = all.map(|(name, (on, size))| (name, &*on.leak(), size));
    leaked.collect()
}

#[test]
fn loads_of_heat_are_those_of_their_cards() {
    let cards = "*CFLUX\nTOP, 11, 2.\n*DFLUX\nCUBE, S2, 5.\nCUBE, BF, 7.\n*FILM\nCUBE, F2, 30., 0.2\n*RADIATE\nCUBE, R1, 25., 0.8\n";
    let text = warm(&step("*HEAT TRANSFER", cards));
    let found = case(&text);
    let loads = sizes(&found.steps[0].loads);
    let size = |name: &str| {
        let mut of_name = loads.iter().filter(|(one, ..)| *one == name);
        let found = of_name
            .next()
            .unwrap_or_else(|| panic!("{name}: {loads:?}"));
        assert!(of_name.next().is_none(), "{name} twice");
        found.2
    };
    // four nodes together
    assert_eq!(size("heat_power"), 8.0);
    assert_eq!(size("heat_flux"), 5.0);
    assert_eq!(size("heat_source"), 7.0);
    assert_eq!(size("film"), 0.2);
    assert_eq!(size("radiation"), 0.8);
    // on surfaces as on sides
    let cards = "*DSFLUX\nLID, S, 5.\n*SFILM\nLID, F, 30., 0.2\n*SRADIATE\nSOLE, R, 25., 0.8\n";
    let found = case(&warm(&step("*HEAT TRANSFER", cards)));
    let loads = sizes(&found.steps[0].loads);
    let on = |name| loads.iter().find(|(one, ..)| *one == name).unwrap().1;
    assert_eq!(
        [on("heat_flux"), on("film"), on("radiation")],
        ["LID", "LID", "SOLE"]
    );
}

#[test]
fn a_pressure_and_a_film_on_one_side_do_not_take_each_others_place() {
    let procedure = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE";
    let first = step(
        procedure,
        "*BOUNDARY\nBASE, 11, 11, 20.\n*DLOAD\nCUBE, P2, 3.\n*FILM\nCUBE, F2, 30., 0.2\n",
    );
    let second = step(procedure, "*FILM, OP=NEW\n");
    let found = case(&warm(&format!("{first}{second}")));
    assert_eq!(found.steps[0].loads.len(), 2);
    // the film ends, and nothing else changes
    let loads = sizes(&found.steps[1].loads);
    assert_eq!(loads.len(), 1);
    assert_eq!((loads[0].0, loads[0].2), ("film", 0.0));
    let film = found.steps[0]
        .loads
        .iter()
        .find(|load| load.kind.name == "film");
    assert_eq!(found.steps[1].loads[0].name, film.unwrap().name);
}

#[test]
fn temperatures_are_held_by_their_degree_of_freedom_until_they_are_free() {
    for dof in ["11", "0"] {
        let first = step(
            "*HEAT TRANSFER",
            &format!("*BOUNDARY\nBASE, {dof}, {dof}, 80.\n"),
        );
        let then = step("*HEAT TRANSFER", "*BOUNDARY, OP=NEW\nTOP, 11, 11, 30.\n");
        let found = case(&warm(&format!("{first}{then}")));
        let held = &found.steps[0].temperatures;
        assert_eq!((held.len(), held[0].on.as_str()), (1, "BASE"));
        assert_eq!(held[0].value, Motion::Ramp(80.0));
        let free = &found.steps[1].frees;
        assert!(
            free.iter()
                .any(|one| one.temperature && one.on.as_str() == "BASE")
        );
        assert_eq!(found.steps[1].temperatures[0].on.as_str(), "TOP");
    }
    // by an amplitude
    let amplitude = "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n";
    let first = step(
        "*HEAT TRANSFER",
        "*BOUNDARY, AMPLITUDE=A\nBASE, 11, 11, 80.\n",
    );
    let found = case(&warm(&format!("{amplitude}{first}")));
    let Motion::Amplitude { name, value } = &found.steps[0].temperatures[0].value else {
        panic!("{:?}", found.steps[0].temperatures);
    };
    assert_eq!((name.as_str(), *value), ("A", 80.0));
    // those of a static step are free where temperatures are unknown
    let cards = "*STEP\n*STATIC\n*TEMPERATURE\nALL, 100.\n*END STEP\n";
    let found = case(&warm(&format!("{cards}{HEAT}")));
    let free = &found.steps[1].frees;
    assert!(
        free.iter()
            .any(|one| one.temperature && one.on.as_str() == "ALL")
    );
}

#[test]
fn calculix_starts_with_what_a_transient_step_holds() {
    let text = warm(&format!(
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n{}",
        step("*HEAT TRANSFER", "*BOUNDARY\nBASE, 11, 11, 80.\n")
    ));
    assert!(case(&text).initial_temperatures.is_empty());
    let found = case_as(&text, Compat::Ccx);
    assert_eq!(found.initial_temperature.as_deref(), Some(&20.0));
    let at = &found.initial_temperatures;
    assert_eq!(
        (at.len(), at[0].on.as_str(), at[0].temperature),
        (1, "BASE", 80.0)
    );
    let steady = text.replace("*HEAT TRANSFER", "*HEAT TRANSFER, STEADY STATE");
    assert!(
        case_as(&steady, Compat::Ccx)
            .initial_temperatures
            .is_empty()
    );
}

#[test]
fn constants_of_radiation_are_those_of_their_card() {
    let card = "*PHYSICAL CONSTANTS, ABSOLUTE ZERO=-273.15, STEFAN BOLTZMANN=5.67E-11\n";
    let expected = Constants {
        stefan_boltzmann: 5.67e-11,
        absolute_zero: -273.15,
    };
    assert_eq!(
        case(&warm(&format!("{card}{HEAT}"))).constants,
        Some(expected)
    );
    assert_eq!(case(&warm(HEAT)).constants, None);
}

#[test]
fn gaps_conduct_over_the_gap_or_over_the_pressure_and_friction_heats() {
    let contact = |cards: &str, kind: &str, compat| {
        let text = format!(
            "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n{cards}*CONTACT PAIR, INTERACTION=I, TYPE={kind}\nLID, SOLE\n{HEAT}"
        );
        case_as(&warm(&text), compat).contacts.remove(0)
    };
    let faces = "SURFACE TO SURFACE";
    let table = "*GAP CONDUCTANCE\n9., 0.\n0., 0.1\n";
    let found = contact(table, faces, Compat::None).conductance;
    assert_eq!(found, [Conductance::OverGap(vec![[0.0, 9.0], [0.1, 0.0]])]);
    let pressed = table.replace("CONDUCTANCE", "CONDUCTANCE, PRESSURE");
    let over = [Conductance::OverPressure(vec![[0.0, 9.0], [0.1, 0.0]])];
    assert_eq!(contact(&pressed, faces, Compat::None).conductance, over);
    assert_eq!(contact(table, faces, Compat::Ccx).conductance, over);
    let one = contact("*GAP CONDUCTANCE\n9.\n", faces, Compat::None);
    assert_eq!(one.conductance, [Conductance::Constant(9.0)]);
    // all of the work of friction, in halves, unless a card says otherwise; CalculiX needs the card, and faces
    assert_eq!(one.friction_heat, Some(FrictionHeat::default()));
    let card = "*GAP HEAT GENERATION\n0.9, 0.3\n";
    let given = Some(FrictionHeat {
        fraction: 0.9,
        to_secondary: 0.3,
    });
    for compat in [Compat::None, Compat::Ccx] {
        assert_eq!(contact(card, faces, compat).friction_heat, given);
    }
    assert_eq!(
        contact(card, "NODE TO SURFACE", Compat::Ccx).friction_heat,
        None
    );
    assert_eq!(contact("", faces, Compat::Ccx).friction_heat, None);
}

#[test]
fn what_is_not_built_is_refused_by_name() {
    let heat = |cards: &str| refused(&warm(&step("*HEAT TRANSFER", cards)));
    for (cards, expected) in [
        ("*FILM\nCUBE, F2FC, 3, 0.2\n", "*FILM has no `F2FC` here"),
        (
            "*RADIATE\nCUBE, R1CR, 3., 0.2\n",
            "*RADIATE has no `R1CR` here",
        ),
        ("*DFLUX\nCUBE, S2NU, 3.\n", "*DFLUX has no `S2NU` here"),
        ("*CFLUX\nTOP, 1, 3.\n", "no heat along degree of freedom 1"),
        (
            "*FILM, AMPLITUDE=A\nCUBE, F2, 3., 0.2\n",
            "AMPLITUDE of *FILM is not supported",
        ),
        ("*FILM\nCUBE, F2, 3.\n", "*FILM takes 4 values on a line"),
        (
            "*TEMPERATURE\nALL, 3.\n",
            "*TEMPERATURE in a step that solves for temperatures",
        ),
        (
            "*BOUNDARY, FIXED\nBASE, 11, 11\n",
            "FIXED of temperatures is not supported",
        ),
    ] {
        let found = heat(cards);
        assert!(found.contains(expected), "{expected}: {found}");
        assert!(found.contains("job.inp:"), "{found}");
    }
    for (procedure, expected) in [
        ("*HEAT TRANSFER, FREQUENCY", "FREQUENCY of *HEAT TRANSFER"),
        (
            "*HEAT TRANSFER, MODAL DYNAMIC",
            "MODAL DYNAMIC of *HEAT TRANSFER",
        ),
    ] {
        let found = refused(&warm(&step(procedure, "")));
        assert!(found.contains(expected), "{expected}: {found}");
    }
    let ramp = HEAT
        .replace("*STEP", "*STEP, AMPLITUDE=RAMP")
        .replace(", STEADY STATE", "");
    assert!(refused(&warm(&ramp)).contains("AMPLITUDE=RAMP"));
    let by_temperature = "*SURFACE INTERACTION, NAME=I\n*GAP CONDUCTANCE\n9., 0., 20.\n3., 0.1, 80.\n\
         *CONTACT PAIR, INTERACTION=I, TYPE=MORTAR\nLID, SOLE\n";
    let found = refused(&warm(&format!("{by_temperature}{HEAT}")));
    assert!(found.contains("depends on temperature"), "{found}");
}
