//! Decks as other programs write them, run as they are.
//!
//! | deck | in the manner of | reference |
//! |---|---|---|
//! | `gmsh.inp` | a user of Gmsh, around the mesh `gmsh_mesh.inp` that Gmsh 4.15 wrote from `gmsh.geo` | the same with the faces of both surfaces as elements and sides, for CalculiX knows no others |
//! | `prepomax.inp` | PrePoMax | the deck |
//! | `freecad.inp` | FreeCAD's workbench FEM | the deck |
//!
//! References are what CalculiX 2.20 prints.

use crate::{of_others, printed};
use signorini::Compat;
use signorini_io::compare::{Outcome, Tolerance};

/// The tables of a deck whose names start so are those of its reference; what vanishes there by symmetry is rounding here too.
fn agrees(deck: &str, tables: &str, compat: Compat, rel: f64) {
    let (_, mut findings) =
        printed(&of_others(deck), compat).unwrap_or_else(|e| panic!("{}", e.plain()));
    findings.retain(|one| one.name.starts_with(tables));
    assert!(!findings.is_empty(), "{deck} prints nothing");
    for one in &findings {
        let is_zero = match &one.outcome {
            Outcome::Both(both) => {
                println!("{deck} {compat:?}: {:.1e} {}", both.ratio(), one.name);
                both.norm < 1e-5 && both.difference < 1e-4
            }
            _ => false,
        };
        let agrees = is_zero || one.agrees(Tolerance { rel, abs: 0.0 });
        assert!(agrees, "{deck}: {one:?}");
    }
}

/// Where meshes do not match, CalculiX cuts facets by those opposite, and puts its points into the pieces; here 8 × 8
/// lie in each facet. That is what the last digits differ by.
#[test]
fn a_mesh_of_gmsh_is_used_as_it_is() {
    agrees("gmsh.inp", "", Compat::Ccx, 2e-3);
}

#[test]
fn a_deck_in_the_manner_of_prepomax_runs_as_it_is() {
    agrees("prepomax.inp", "", Compat::Ccx, 2e-3);
}

#[test]
fn a_deck_in_the_manner_of_freecad_runs_as_it_is() {
    agrees("freecad.inp", "", Compat::Ccx, 1e-3);
}

/// A penalty K gives way by p/K: 1 % of what the punch is pressed by, 1.4 % of what the boxes are.
#[test]
fn a_contact_that_does_not_give_way_is_a_little_stiffer() {
    agrees("gmsh.inp", "total force", Compat::None, 1e-2);
    agrees("freecad.inp", "", Compat::None, 3e-2);
}
