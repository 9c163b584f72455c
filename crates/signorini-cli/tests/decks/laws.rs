//! CalculiX's ways of holding surfaces apart, on own decks; references are what CalculiX 2.20 prints.

use crate::{agrees, own};
use signorini::Compat;

/// The law is rounded by an arctangent, nodes stand for their parts of all faces around them, sticking yields, and vectors
/// are printed along cylindrical axes, one of whose nodes is on the axis. CalculiX takes areas as they are in every
/// iteration, ours are those of the start: 0.06 % more after so much bulging.
#[test]
fn nodes_stick_and_slip_on_faces_as_in_calculix() {
    agrees(&own("nodes.inp"), "", Compat::Ccx, 1e-3);
}

/// A gap is closed by moving nodes, and another penalty takes over in the second step.
#[test]
fn a_law_that_changes_takes_over_where_things_are() {
    agrees(&own("swap.inp"), "", Compat::Ccx, 1e-3);
}

/// What is TIED pulls a gap closed by its penalty; along the surface it has the slope of sticking, and no limit.
#[test]
fn what_is_tied_has_another_stiffness_along_the_surface() {
    agrees(&own("tied.inp"), "", Compat::Ccx, 1e-6);
}

/// *TIE of quadratic elements in the plane.
#[test]
fn in_the_plane_only_corners_are_tied_as_in_calculix() {
    agrees(&own("tied_plane.inp"), "", Compat::Ccx, 1e-6);
}

/// Gaps, tractions and energies of faces, which CalculiX prints at each of its points.
#[test]
fn what_happens_at_points_inside_faces_is_printed_of_faces() {
    agrees(&own("faces.inp"), "", Compat::Ccx, 1e-6);
}

/// What overlaps, and what closes within the first step, is allowed for again in every increment of that step, also in
/// the frames between; then the foot slides over the plane that each increment begins with, turns back and sticks.
#[test]
fn overlaps_fade_and_feet_turn_back_as_in_calculix() {
    agrees(&own("overlaps.inp"), "", Compat::Ccx, 1e-3);
}

/// Contact at nodes takes the surface of nodes where one of faces has the same name; open nodes that feel a tension are
/// printed and counted, and rub.
#[test]
fn nodes_near_a_surface_are_printed_as_in_calculix() {
    agrees(&own("names.inp"), "", Compat::Ccx, 1e-3);
}

/// Resultants of stresses on faces inside a body, from either side.
#[test]
fn sections_are_printed_as_in_calculix() {
    agrees(&own("section.inp"), "", Compat::Ccx, 1e-4);
}
