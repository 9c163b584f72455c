//! Decks as other programs write them, run as they are.
//!
//! | deck | in the manner of | reference |
//! |---|---|---|
//! | `gmsh.inp` | a user of Gmsh, around the mesh `gmsh_mesh.inp` that Gmsh 4.15 wrote from `gmsh.geo` | the same with the faces of both surfaces as elements and sides, for CalculiX knows no others |
//! | `prepomax.inp` | PrePoMax | the deck |
//! | `freecad.inp` | FreeCAD's workbench FEM | the deck |
//!
//! References are what CalculiX 2.20 prints.

use crate::{agrees, of_others};
use signorini::Compat;

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
