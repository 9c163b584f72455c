//! *DYNAMIC and velocities at the start.

use super::*;
use crate::case::{DynamicMethod, Enforcement, Increments, SetContent};

fn dynamic(cards: &str, parameters: &str) -> String {
    let step =
        format!("*STEP, INC=500\n*DYNAMIC{parameters}\n0.1, 2.\n*CLOAD\nTOP, 3, 1.\n*END STEP\n");
    cube("C3D8", &format!("*DENSITY\n2.\n{cards}{step}"))
        .replace("*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n", "")
        .replace(
            "*DENSITY\n2.\n",
            "*DENSITY\n2.\n*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n",
        )
}

#[test]
fn dynamic_steps_have_their_damping_and_increments() {
    for (parameters, alpha) in [
        ("", -0.05),
        (", ALPHA=-0.2", -0.2),
        (", ALPHA=0.", 0.0),
        (", ALPHA=-1.", -1.0 / 3.0),
        (", ALPHA=0.3", 0.0),
    ] {
        let case = case(&dynamic("", parameters));
        let step = &case.steps[0];
        let dynamics = step.dynamics.as_ref().unwrap();
        assert_eq!(dynamics.method, DynamicMethod::HilberHughesTaylor(alpha));
        assert_eq!(step.duration, 2.0);
        assert!(matches!(
            step.increments,
            Increments::Adaptive { initial: 0.1, .. }
        ));
    }
    let direct = case(&dynamic("", ", DIRECT"));
    assert_eq!(direct.steps[0].increments, Increments::Fixed(20));
}

/// By ALPHA contact flickers: the method of the same damping takes its place, and the deck says so.
#[test]
fn with_contact_alpha_becomes_a_spectral_radius() {
    let contact = "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4\n\
                   *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nLID, SOLE\n";
    let read = translated(&dynamic(contact, ", ALPHA=-0.1"), Compat::None).unwrap();
    let dynamics = read.case.steps[0].dynamics.as_ref().unwrap();
    let DynamicMethod::GeneralizedAlpha(radius) = dynamics.method else {
        panic!("{dynamics:?}");
    };
    assert!((radius - 0.9 / 1.1).abs() < 1e-15);
    let said = read.found.plain();
    assert!(
        said.contains("ALPHA = -0.1 becomes rho_inf = 0.8182"),
        "{said}"
    );
    // by the laws of CalculiX it stays
    let read = translated(&dynamic(contact, ", ALPHA=-0.1"), Compat::Ccx).unwrap();
    let dynamics = read.case.steps[0].dynamics.as_ref().unwrap();
    assert_eq!(dynamics.method, DynamicMethod::HilberHughesTaylor(-0.1));
    assert!(dynamics.weighted);
}

#[test]
fn velocities_at_the_start_add_up_component_by_component() {
    let cards = "*INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 3, -5.\nTOP, 1, 2.\n7, 3, 1.\n";
    let case = case(&dynamic(cards, ""));
    let of = |node: u64| {
        let holds = |one: &&crate::case::VelocityAt| {
            let set = case.sets.iter().find(|set| set.name.value == one.on.value);
            let content = set.map(|set| &set.content);
            matches!(content, Some(SetContent::Nodes(nodes)) if nodes.contains(&node))
        };
        let mut found = case.initial_velocities.iter().filter(holds);
        let velocity = found.next().unwrap().velocity;
        assert!(found.next().is_none(), "{node} twice");
        velocity
    };
    assert_eq!(of(1), [0.0, 0.0, -5.0]);
    assert_eq!(of(5), [2.0, 0.0, -5.0]);
    assert_eq!(of(7), [2.0, 0.0, 1.0]);
}

/// An explicit step writes results where its first increment says, else twenty times; BETA is left out in it.
#[test]
fn explicit_steps_have_intervals() {
    let of = |time: &str| {
        let deck = dynamic("*DAMPING, ALPHA=2., BETA=1E-3\n", ", EXPLICIT");
        let read = translated(&deck.replace("0.1, 2.", time), Compat::None).unwrap();
        let said = read.found.plain();
        assert!(said.contains("BETA of *DAMPING is left out"), "{said}");
        let step = read.case.steps.into_iter().next().unwrap();
        let method = step.dynamics.unwrap().method;
        assert!(matches!(
            method,
            DynamicMethod::Explicit { scaling: None, .. }
        ));
        let damping = read.case.materials[0].damping;
        assert_eq!([damping.mass, damping.stiffness], [2.0, 0.0]);
        (step.duration, step.increments)
    };
    assert_eq!(of("0.1, 2."), (2.0, Increments::Fixed(20)));
    assert_eq!(of("0.3, 2."), (2.0, Increments::Fixed(7)));
    assert_eq!(of(", 2."), (2.0, Increments::Fixed(20)));
}

/// Damping is that of the material in which it stands; with `--compat ccx` of all.
#[test]
fn damping_is_that_of_its_material() {
    const BOTH: [f64; 2] = [3.0, 1e-3];
    let deck = dynamic("", "").replace(
        "*DENSITY\n2.\n",
        "*DENSITY\n2.\n*MATERIAL, NAME=N\n*ELASTIC\n1., 0.\n*DAMPING, ALPHA=3., BETA=1E-3\n",
    );
    for (compat, wanted) in [(Compat::None, [[0.0; 2], BOTH]), (Compat::Ccx, [BOTH; 2])] {
        let read = translated(&deck, compat).unwrap();
        let damping = read.case.materials.iter().map(|m| m.damping);
        let damping: Vec<[f64; 2]> = damping.map(|of| [of.mass, of.stiffness]).collect();
        assert_eq!(damping, wanted);
    }
}

#[test]
fn contacts_that_damp_have_a_penalty() {
    let contact = "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4\n\
                   *CONTACT DAMPING, TANGENT FRACTION=0.5\n2.5e-4\n\
                   *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nLID, SOLE\n";
    for (compat, pulls) in [(Compat::None, false), (Compat::Ccx, true)] {
        let read = translated(&dynamic(contact, ""), compat).unwrap();
        let one = &read.case.contacts[0];
        assert_eq!(
            (one.damping.normal, one.damping.tangential),
            (2.5e-4, 1.25e-4)
        );
        assert_eq!(one.damping.pulls, pulls);
        let Enforcement::Penalty(Some(penalty)) = &one.enforcement else {
            panic!("{:?}", one.enforcement);
        };
        assert_eq!(**penalty, 1e4);
    }
}

#[test]
fn what_dynamic_decks_cannot_have_is_refused() {
    for (cards, parameters, expected) in [
        ("", ", ALPHA=much", "ALPHA of *DYNAMIC is no number"),
        (
            "*DAMPING, ALPHA=-2.\n",
            "",
            "ALPHA of *DAMPING is no number from 0 on",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=VELOCITY\nTOP, 4, 1.\n",
            "",
            "a velocity has no component 4",
        ),
    ] {
        let said = refused(&dynamic(cards, parameters));
        assert!(said.contains(expected), "{said}");
    }
    let reversed = dynamic("", "").replace("0.1, 2.", "3., 2.");
    assert!(refused(&reversed).contains("initial increment of *DYNAMIC"));
}
