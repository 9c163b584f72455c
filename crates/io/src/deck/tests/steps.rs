//! What steps prescribe: supports, motions, loads and what holds at the start.

use super::*;
use crate::case::{
    AxesSystem, ConstraintKind, Factor, GlobalTime, Motion, SetContent, StrainAt, Unstrained,
};
use crate::deck::load::vector;
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Chosen, Value};
use std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn supports_in_the_first_step_hold_and_motions_ramp() {
    let cards = format!(
        "*BOUNDARY\nBASE, 1, 3\n{}",
        STEP.replace(
            "*CLOAD\nTOP, 3, 1.",
            "*BOUNDARY\n5,3,3,0.1\n6,3,3,0.1\n7,1,2"
        )
    );
    let case = case(&cube("C3D8", &cards));
    let step = &case.steps[0];
    assert_eq!(step.fixes.len(), 2);
    assert_eq!(step.fixes[0].on.value, "BASE");
    assert_eq!(step.fixes[0].u.xyz, [true; 3]);
    // lines of single nodes that say the same are one set
    assert_eq!(step.moves.len(), 1);
    assert_eq!(step.moves[0].u, [None, None, Some(Motion::Ramp(0.1))]);
    let set = case
        .sets
        .iter()
        .find(|set| set.name == step.moves[0].on)
        .unwrap();
    assert_eq!(set.content, SetContent::Nodes(vec![5, 6]));
}

#[test]
fn what_is_released_is_free_and_what_is_held_again_goes_back() {
    let steps = "*BOUNDARY\nBASE, 1, 3\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.1\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY, OP=NEW\nBASE, 1, 3\n*CLOAD\n5, 3, 1.\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3\n*END STEP\n";
    let case = case(&cube("C3D8", steps));
    let free: Vec<&str> = case.steps[1]
        .frees
        .iter()
        .map(|f| f.on.value.as_str())
        .collect();
    assert_eq!(free, ["BASE", "TOP"]);
    // BASE was set free and is taken back to zero
    assert_eq!(case.steps[1].moves.len(), 1);
    assert_eq!(case.steps[2].moves[0].u[2], Some(Motion::Ramp(0.0)));
}

#[test]
fn the_last_boundary_of_a_node_counts_of_the_model_or_the_step() {
    let held = "*BOUNDARY\nBASE, 1, 3\nTOP, 2, 3\n*STEP\n*STATIC\n*BOUNDARY\n";
    let moves_of = |lines: &str| {
        let case = case(&cube("C3D8", &format!("{held}{lines}\n*END STEP\n")));
        let nodes = |name: &str| {
            let set = case.sets.iter().find(|set| set.name.value == name);
            match set.map(|set| &set.content) {
                Some(SetContent::Nodes(nodes)) => nodes.clone(),
                _ => Vec::new(),
            }
        };
        let step = &case.steps[0];
        let fixes: Vec<_> = step
            .fixes
            .iter()
            .map(|f| (f.on.value.clone(), f.u))
            .collect();
        let moves = step.moves.iter();
        let moves: Vec<_> = moves
            .map(|m| (nodes(&m.on.value), m.u[2].clone()))
            .collect();
        (fixes, moves)
    };
    // all of what the model holds along an axis is moved by the step
    let (fixes, moves) = moves_of("TOP, 3, 3, -0.001");
    assert_eq!(fixes.len(), 2, "{fixes:?}");
    assert_eq!(moves.len(), 1);
    assert_eq!(moves[0].1, Some(Motion::Ramp(-0.001)));
    // one node of it: the others stay held
    let (_, moves) = moves_of("5, 3, 3, -0.001\n5, 3, 3, -0.002");
    assert_eq!(moves, [(vec![5], Some(Motion::Ramp(-0.002)))]);
    // the same again is no change
    let (fixes, moves) = moves_of("TOP, 3, 3");
    assert_eq!((fixes.len(), moves.len()), (3, 0), "{fixes:?}");
}

#[test]
fn loads_of_a_step_add_up_and_later_ones_replace_them() {
    let steps = "*STEP\n*STATIC\n*CLOAD\nTOP, 3, 1.\n5, 3, 10.\n*DLOAD\nCUBE, P2, 1.\nCUBE, P2, 2.\n*END STEP\n\
                 *STEP\n*STATIC\n*CLOAD\n5, 3, 2.\n*END STEP\n*STEP\n*STATIC\n*DLOAD, OP=NEW\n*END STEP\n";
    let case = case(&cube("C3D8", steps));
    let kinds = |step: usize| -> Vec<Chosen> {
        case.steps[step]
            .loads
            .iter()
            .map(|load| load.kind.clone())
            .collect()
    };
    let pressure = |p: f64| Chosen::bare("pressure", Value::Number(p));
    let up = |f: f64| vector("per_node", [0.0, 0.0, f]);
    assert_eq!(kinds(0), [up(11.0), up(1.0), pressure(3.0)]);
    assert_eq!(kinds(1), [up(2.0)]);
    assert_eq!(case.steps[1].loads[0].name, case.steps[0].loads[0].name);
    assert_eq!(kinds(2), [pressure(0.0)]);
}

#[test]
fn local_axes_turn_loads_and_make_equations() {
    let cards = "*TRANSFORM, NSET=TOP, TYPE=R\n0.,1.,0., -1.,0.,0.\n*STEP\n*STATIC\n\
                 *BOUNDARY\n5, 1, 1\n*CLOAD\n6, 1, 2.\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    assert_eq!(
        case.steps[0].loads[0].kind,
        vector("per_node", [0.0, 2.0, 0.0])
    );
    let ConstraintKind::Equation { terms, rhs } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints);
    };
    assert_eq!((terms.len(), *rhs), (1, 0.0));
    assert_eq!((terms[0].component.value, terms[0].coefficient), (1, 1.0));
}

#[test]
fn a_motion_along_a_local_axis_is_that_of_a_reference() {
    let cards = "*TRANSFORM, NSET=TOP, TYPE=R\n0.,1.,0., -1.,0.,0.\n*STEP\n*STATIC\n*BOUNDARY\n5, 1, 1, 0.1\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY\n5, 1, 1, 0.2\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    let ConstraintKind::Equation { terms, .. } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints);
    };
    // u_y − r_x = 0
    let of_terms: Vec<(usize, f64)> = (terms.iter())
        .map(|t| (t.component.value, t.coefficient))
        .collect();
    assert_eq!(of_terms, [(1, 1.0), (0, -1.0)]);
    for (step, value) in case.steps.iter().zip([0.1, 0.2]) {
        assert_eq!(step.moves[0].on, terms[1].on);
        assert_eq!(step.moves[0].u[0], Some(Motion::Ramp(value)));
    }
    assert_eq!(case.constraints.len(), 1);
}

#[test]
fn points_of_elements_have_stress_and_strain_at_the_start() {
    let cards = format!(
        "*INITIAL CONDITIONS, TYPE=STRESS\n1, 2, 1., 2., 3., 4., 5., 6.\n\
         *INITIAL CONDITIONS, TYPE=PLASTIC STRAIN\nCUBE, 1, .1\n{STEP}"
    );
    let case = case(&cube("C3D8", &cards));
    let [at] = &case.initial_stress[..] else {
        panic!("{:?}", case.initial_stress);
    };
    assert_eq!((at.element, at.point), (1, 2));
    assert_eq!(at.value, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(case.initial_strain[0].value, [0.1, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let text = refused(&cube("C3D8R", &cards));
    assert!(
        text.contains("values at the points of this element"),
        "{text}"
    );
    let text = refused(&cube("C3D8", &cards.replace("STRESS\n", "STRESS, USER\n")));
    assert!(
        text.contains("TYPE=STRESS, USER is not supported"),
        "{text}"
    );
}

#[test]
fn a_time_delay_is_an_amplitude_of_its_own() {
    let cards = "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP\n*STATIC\n*CLOAD, AMPLITUDE=A, TIME DELAY=0.5\nTOP, 3, 1.\n\
                 *CLOAD, AMPLITUDE=A\nTOP, 1, 1.\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    let tables: Vec<_> = case
        .amplitudes
        .iter()
        .map(|one| one.factor.clone())
        .collect();
    let rows = [[[0.0, 0.0], [1.0, 1.0]], [[0.5, 0.0], [1.5, 1.0]]];
    assert_eq!(tables, rows.map(|rows| Factor::Table(rows.to_vec())));
}

#[test]
fn temperatures_at_the_start_that_differ_are_those_of_sets_in_their_order() {
    let start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 100.\nTOP, 20.\n*STEP";
    let deck = cube("C3D8", STEP).replace("1000., 0.3\n", "1000., 0.3\n*EXPANSION\n1e-5\n");
    let case = case(&deck.replace("*STEP", start));
    let sets = case.initial_temperatures.iter();
    let sets: Vec<_> = sets.map(|one| (one.on.as_str(), one.temperature)).collect();
    assert_eq!(sets, [("ALL", 100.0), ("TOP", 20.0)]);
    let expansion = case.materials[0].expansion.as_ref().unwrap();
    assert_eq!(expansion.free.value, Unstrained::AtStart);
}

#[test]
fn cylindrical_axes_have_a_radius_on_their_axis_too() {
    let system = AxesSystem::Cylindrical {
        from: [1.0, 0.0, 0.0],
        to: [1.0, 0.0, 4.0],
    };
    let off = system.at([1.0, 2.0, 3.0].into()).unwrap();
    assert_eq!(
        off.map(Vec3::to_array),
        [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    );
    let on = system.at([1.0, 0.0, 9.0].into()).unwrap();
    assert_eq!(
        on.map(Vec3::to_array),
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    );
    // along which ccx 2.20 moves a node on these axes that is moved along its first local axis
    let printed = [
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]),
        ([1.0, 1.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0]),
        ([1.0, 2.0, 3.0], [-0.89443, 0.44721, 0.0]),
        ([1.0, 1.0, 0.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0]),
        ([1.0, 3.0, 2.0], [-0.94868, 0.31623, 0.0]),
    ];
    for (to, radial) in printed {
        let from = [0.0; 3];
        let system = AxesSystem::Cylindrical { from, to };
        let [first, ..] = system.at(Vec3::ZERO).unwrap();
        let off = (first - Vec3::from(radial)).norm();
        assert!(off < 1e-5, "{to:?}: {first:?}");
    }
}

#[test]
fn prints_without_a_set_print_nothing_and_say_so() {
    let with = |cards: &str| {
        let text = cube(
            "C3D8",
            &STEP.replace("*END STEP", &format!("{cards}*END STEP")),
        );
        let read =
            translated(&text, Compat::None).unwrap_or_else(|found| panic!("{}", found.plain()));
        let prints = read.case.steps[0].prints.clone().unwrap_or_default();
        (prints, read.found.plain())
    };
    let (prints, notes) = with("*Node Print\nU\n*EL PRINT\nS\n");
    assert!(prints.is_empty());
    for card in ["*NODE PRINT", "*EL PRINT"] {
        let note = format!("{card} names no set: it prints nothing");
        assert_eq!(notes.matches(&note).count(), 1, "{notes}");
    }
    // switched off, as Abaqus/CAE writes it
    for off in ["FREQUENCY=0", "FREQ=999999", "freq=0"] {
        let (prints, notes) = with(&format!("*NODE PRINT, {off}\nU\n"));
        assert!(
            prints.is_empty() && !notes.contains("names no set"),
            "{notes}"
        );
    }
    // none of a set is printed never, the others as before
    let (prints, _) = with("*NODE PRINT, NSET=TOP, FREQUENCY=0\nU\n*EL PRINT, ELSET=CUBE\nS\n");
    assert_eq!(prints.len(), 1);
    assert_eq!(prints[0].every, 1);
}

#[test]
fn a_mesh_that_should_be_refined_is_left_with_a_warning() {
    let text = cube(
        "C3D8",
        &STEP.replace("*END STEP", "*REFINE MESH, LIMIT=5.\nS\n*END STEP"),
    );
    let read = translated(&text, Compat::None).unwrap();
    let found = read.found.plain();
    assert!(found.contains("*REFINE MESH is left out"), "{found}");
    assert!(
        read.found
            .iter()
            .any(|one| one.severity == Severity::Warning)
    );
}

#[test]
fn amplitudes_are_shifted_and_words_are_read_whatever_their_letters() {
    let table = |card: &str| {
        let text = cube(
            "C3D8",
            &format!("*AMPLITUDE, NAME=A{card}\n0., 1., 2., 3.\n{STEP}"),
        );
        translated(&text, Compat::None).map(|read| match &read.case.amplitudes[0].factor {
            Factor::Table(rows) => rows.clone(),
            other => panic!("{other:?}"),
        })
    };
    let plain = [[0.0, 1.0], [2.0, 3.0]];
    assert_eq!(table("").unwrap(), plain);
    assert_eq!(
        table(", value=relative, definition=Tabular").unwrap(),
        plain
    );
    let shifted = table(", SHIFTX=0.5, SHIFTY=-1.").unwrap();
    assert_eq!(shifted, [[0.5, 0.0], [2.5, 2.0]]);
    for (card, message) in [
        (", USER", "*AMPLITUDE, USER is not supported"),
        (", VALUE=ABSOLUTE", "VALUE=ABSOLUTE is not supported"),
        (
            ", DEFINITION=PERIODIC",
            "DEFINITION=PERIODIC is not supported",
        ),
    ] {
        let found = table(card).unwrap_err().plain();
        assert!(found.contains(message), "{found}");
    }
}

/// A step that changes elements, after one that does not.
fn changed(card: &str) -> String {
    cube("C3D8", &format!("{STEP}*STEP\n*STATIC\n{card}*END STEP\n"))
}

#[test]
fn elements_are_removed_and_added_as_the_card_says() {
    let removed = changed("*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nCUBE\n");
    for (compat, ramp) in [(Compat::None, true), (Compat::Ccx, false)] {
        let case = case_as(&removed, compat);
        let one = &case.steps[1].deactivations[0];
        assert_eq!((one.group.value.as_str(), one.ramp), ("CUBE", ramp));
        assert!(case.steps[0].deactivations.is_empty() && case.steps[1].activations.is_empty());
    }
    for (word, strain) in [
        ("ADD", StrainAt::Free),
        ("ADD=STRAIN FREE", StrainAt::Free),
        ("add = with strain", StrainAt::Keep),
    ] {
        let case = case(&changed(&format!(
            "*MODEL CHANGE, TYPE=ELEMENT, {word}\n1\n"
        )));
        let one = &case.steps[1].activations[0];
        assert_eq!(one.strain, strain, "{word}");
        let set = case
            .sets
            .iter()
            .find(|set| set.name.value == one.group.value);
        assert_eq!(set.unwrap().content, SetContent::Elements(vec![1]));
    }
}

#[test]
fn changes_of_elements_that_are_not_built_or_not_clear_are_refused_by_name() {
    for (card, expected) in [
        (
            "*MODEL CHANGE, TYPE=ELEMENT, MECHSTRAINTORESIDUAL\n",
            "turns strain into residual strain; not built",
        ),
        (
            "*MODEL CHANGE, TYPE=ELEMENT\nCUBE\n",
            "neither adds nor removes",
        ),
        (
            "*MODEL CHANGE, TYPE=ELEMENT, ADD, REMOVE\nCUBE\n",
            "both adds and removes",
        ),
        ("*MODEL CHANGE, TYPE=ELEMENT, REMOVE\n", "has no data line"),
        (
            "*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nNONE\n",
            "there is no element set `NONE`",
        ),
        (
            "*MODEL CHANGE, TYPE=ELEMENT, ADD=STRAINED\nCUBE\n",
            "is not known",
        ),
        (
            "*MODEL CHANGE, TYPE=SHELL, REMOVE\nCUBE\n",
            "TYPE=SHELL is not supported",
        ),
    ] {
        let found = refused(&changed(card));
        assert!(found.contains(expected), "{card}{found}");
    }
}

/// A step with nodes that another model moves, after these cards.
fn submodel(cards: &str, step: &str) -> String {
    cube("C3D8", &format!("{cards}*STEP\n*STATIC\n{step}*END STEP\n"))
}

const CUT: &str = "*SUBMODEL, TYPE=NODE, INPUT=g.frd\nTOP, BASE\n";

#[test]
fn displacements_of_a_global_model_are_motions() {
    for (at, wanted) in [
        ("STEP=2", GlobalTime::Step(2)),
        ("DATA SET=3", GlobalTime::Set(3)),
    ] {
        let card = format!("*BOUNDARY, SUBMODEL, {at}\nTOP, 1, 2\n1, 3\n");
        let case = case(&submodel(CUT, &card));
        let [top, node] = &case.steps[0].moves[..] else {
            panic!("{:?}", case.steps[0].moves)
        };
        let from = top.from.as_ref().unwrap();
        assert_eq!(
            (from.at, from.u.xyz, from.ramp),
            (wanted, [true, true, false], true)
        );
        assert_eq!(from.file.value.to_str(), Some("g.frd"));
        assert_eq!(top.on.value, "TOP");
        assert_eq!(node.from.as_ref().unwrap().u.xyz, [false, false, true]);
        assert!(case.steps[0].fixes.is_empty());
    }
    let all = CUT.replace("g.frd", "g.frd, GLOBAL ELSET=CUBE");
    let case = case(&submodel(&all, "*BOUNDARY, SUBMODEL, STEP=1\nTOP, 1, 3\n"));
    assert_eq!(case.steps[0].moves[0].from.as_ref().unwrap().elements, [1]);
}

#[test]
fn what_a_global_model_does_not_give_is_refused_by_name() {
    let of_surface = CUT.replace("TYPE=NODE", "TYPE=SURFACE");
    let top = "*BOUNDARY, SUBMODEL, STEP=1\nTOP, 1, 3\n";
    for (cards, step, expected) in [
        (
            &of_surface[..],
            top,
            "only displacements of a global model are built",
        ),
        (
            CUT,
            "*DSLOAD, SUBMODEL, STEP=1\nLID, P, 1.\n",
            "only displacements of a global model are built",
        ),
        (
            CUT,
            "*TEMPERATURE, SUBMODEL, STEP=1\nTOP, 1.\n",
            "only displacements of a global model are built",
        ),
        (
            CUT,
            "*BOUNDARY, SUBMODEL\nTOP, 1, 3\n",
            "neither STEP nor DATA SET",
        ),
        (
            CUT,
            "*BOUNDARY, SUBMODEL, STEP=1, DATA SET=1\nTOP, 1, 3\n",
            "both STEP and DATA SET",
        ),
        (
            CUT,
            "*BOUNDARY, SUBMODEL, STEP=1\nTOP, 4, 6\n",
            "there are no displacements 4 to 6",
        ),
        ("", top, "is named by no *SUBMODEL card"),
        ("*SUBMODEL, TYPE=NODE\nTOP\n", top, "*SUBMODEL has no INPUT"),
        (
            "*SUBMODEL, TYPE=NODE, INPUT=g.frd\n",
            top,
            "has no data line",
        ),
    ] {
        let found = refused(&submodel(cards, step));
        assert!(found.contains(expected), "{cards}{step}{found}");
    }
}
