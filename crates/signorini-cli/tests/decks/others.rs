//! Decks as other programs write them, run as they are.
//!
//! | deck | in the manner of | reference |
//! |---|---|---|
//! | `gmsh.inp` | a user of Gmsh, around the mesh `gmsh_mesh.inp` that Gmsh 4.15 wrote from `gmsh.geo` | the same with the faces of both surfaces as elements and sides, for CalculiX knows no others |
//! | `prepomax.inp` | PrePoMax | the deck |
//! | `freecad.inp` | FreeCAD's workbench FEM | the deck |
//! | `bars.inp` | a user of trusses and springs | the deck |
//! | `brick.inp` | a test of one element, with motions that its points do not see | the deck |
//! | `softened.inp` | bodies that change their material | the deck |
//!
//! References are what CalculiX 2.20 prints.

use crate::common::run;
use crate::{agrees, of_others, read};
use signorini::{Compat, build};
use std::path::Path;

/// Why a deck is not solved, if it is not.
fn solved_or_refused(path: &Path, compat: Compat) -> Option<String> {
    let loaded = read(path, compat);
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    run(&mut model).error.map(|error| format!("{error:?}"))
}

/// Where meshes do not match, CalculiX cuts facets by those opposite, and puts its points into the pieces; here 8 × 8
/// lie in each facet. That is what the last digits differ by.
#[test]
fn a_mesh_of_gmsh_is_used_as_it_is() {
    agrees(&of_others("gmsh.inp"), "", Compat::Ccx, 2e-3);
}

#[test]
fn a_deck_in_the_manner_of_prepomax_runs_as_it_is() {
    agrees(&of_others("prepomax.inp"), "", Compat::Ccx, 2e-3);
}

#[test]
fn a_deck_in_the_manner_of_freecad_runs_as_it_is() {
    agrees(&of_others("freecad.inp"), "", Compat::Ccx, 1e-3);
}

/// A penalty K gives way by p/K: 1 % of what the punch is pressed by, 1.4 % of what the boxes are.
#[test]
fn a_contact_that_does_not_give_way_is_a_little_stiffer() {
    agrees(&of_others("gmsh.inp"), "total force", Compat::None, 1e-2);
    agrees(&of_others("freecad.inp"), "", Compat::None, 3e-2);
}

#[test]
fn bars_and_springs_bear_what_they_bear_in_calculix() {
    agrees(&of_others("bars.inp"), "", Compat::None, 1e-4);
}

/// Its reduced integration leaves motions without stiffness on which no load acts: they are held where decks are taken
/// as CalculiX takes them, and an error elsewhere.
#[test]
fn motions_that_nothing_resists_and_no_load_moves_are_held() {
    agrees(&of_others("brick.inp"), "", Compat::Ccx, 1e-6);
    let refused = solved_or_refused(&of_others("brick.inp"), Compat::None);
    assert!(
        refused.is_some_and(|why| why.contains("Singular")),
        "solved"
    );
}

#[test]
fn bodies_take_another_material_from_a_step_on() {
    agrees(&of_others("softened.inp"), "", Compat::None, 1e-6);
}
