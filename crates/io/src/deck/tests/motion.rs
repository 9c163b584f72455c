//! *DYNAMIC and velocities at the start.

use super::*;
use crate::case::{DynamicMethod, Increments, SetContent};

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

#[test]
fn what_dynamic_decks_cannot_have_is_refused() {
    for (cards, parameters, expected) in [
        ("", ", EXPLICIT", "EXPLICIT of *DYNAMIC is not supported"),
        ("", ", ALPHA=much", "ALPHA of *DYNAMIC is no number"),
        (
            "*DAMPING, ALPHA=2.\n",
            "",
            "damping of decks is not supported",
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
