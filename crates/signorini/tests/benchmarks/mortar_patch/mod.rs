//! The patch test of two blocks in mortar contact, for every pairing of facets.
//!
//! SOURCE      Taylor, Papadopoulos 1991; Popp, Gitterle, Gee, Wall 2010; Cichosz, Bischoff 2011 (covered part); grids and
//!             runs of an independent program where the folder shared/reference is next to the repository.
//! GOAL        stresses, displacements, pressures and forces are exact: what docs/patch_test.md says of mortar contact
//! MESH        two unit blocks, 2 cells across below and 3 above, one up; corners moved within their planes by up to 0.12
//!             of a cell, edges straight; quad4, tri3, quad8, quad9, tri6 in the plane; hex8, tet4, wedge6, hex20, hex27,
//!             tet10, wedge15 in space
//! CONDITIONS  uniaxial stress: rollers below and at the beginnings, lid moved down. Weights of the start and moduli 1:2;
//!             present weights at small strain; Saint-Venant and Kirchhoff's law at 10 % of strain. Overhanging parts
//!             carry the pressure as loads, without lateral strain where weights move. Sticking: F = I + 0.25 e1 ⊗ e_up
//!             − 0.12 e_up ⊗ e_up, sides loaded with P N.
//! EXPECTED    u = H (X − O) in each block, its stress at all points of cells, pressures per area (present at finite strain), forces
//!             at nodes
//! TOLERANCE   relative to the largest: 1e-12 in the plane, 1e-11 in space. Pressures of nodes that are little covered
//!             are printed only; in space, where such nodes have no multiplier and nobody has theirs, 1e-8 of their force.
mod blocks;

use crate::common::{numbers, reference, relative};
use crate::scene::{Scene, finished};
use blocks::{Blocks, Errors, NEWTON, Strains};
use serde_json::Value;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::fmt::Write;

const PLANE: [&str; 5] = ["quad4", "tri3", "quad8", "quad9", "tri6"];
const SPACE: [&str; 7] = [
    "hex8", "tet4", "wedge6", "hex20", "hex27", "tet10", "wedge15",
];
/// One solid for each kind of facet: quad4, tri3, quad8, quad9, tri6.
const FACES: [&str; 5] = ["hex8", "tet4", "hex20", "hex27", "tet10"];

/// Distortion of the meshes, at which rules are exact.
const DISTORTION: f64 = 0.12;

fn pairings<const N: usize>(names: [&'static str; N]) -> Vec<[&'static str; 2]> {
    names.iter().flat_map(|a| names.map(|b| [*a, b])).collect()
}

/// One line: the largest errors of a pairing.
fn told(name: &str, elements: [&str; 2], errors: Errors) {
    let Errors {
        displacement,
        stress,
        pressure,
        force,
    } = errors;
    let [lower, upper] = elements;
    println!(
        "{name}: {lower} under {upper}: u {displacement:.1e} stress {stress:.1e} pressure {pressure:.1e} force {force:.1e}"
    );
}

/// Both sides as the secondary one.
fn either(blocks: &Blocks, strain: f64) -> Errors {
    let exact = blocks.pressed(strain);
    let with = |upper_is_secondary| {
        Blocks {
            upper_is_secondary,
            ..blocks.clone()
        }
        .errors(&exact)
    };
    with(true).or(with(false))
}

/// Every pairing in the plane.
fn in_the_plane(strains: Strains, young: [f64; 2], strain: f64) {
    for elements in pairings(PLANE) {
        let blocks = Blocks {
            strains,
            young,
            ..Blocks::new(elements, DISTORTION)
        };
        let errors = either(&blocks, strain);
        told(&format!("{strains:?}"), elements, errors);
        assert!(errors.most() < 1e-12, "{elements:?}: {errors:?}");
    }
}

#[test]
fn in_the_plane_every_pairing_passes() {
    in_the_plane(Strains::Held, [100.0, 200.0], -0.01);
    in_the_plane(Strains::Linear, [100.0; 2], -0.01);
    in_the_plane(Strains::Finite, [100.0; 2], -0.1);
}

/// Every pairing in space; with few names, only one side as the secondary one, which all pairings amount to.
fn in_space(strains: Strains, young: [f64; 2], strain: f64, all: bool) {
    let names = if all {
        pairings(SPACE)
    } else {
        pairings(FACES)
    };
    for elements in names {
        let blocks = Blocks {
            strains,
            young,
            ..Blocks::new(elements, DISTORTION)
        };
        let errors = if all {
            either(&blocks, strain)
        } else {
            blocks.errors(&blocks.pressed(strain))
        };
        told(&format!("{strains:?}"), elements, errors);
        assert!(errors.most() < 1e-11, "{elements:?}: {errors:?}");
    }
}

#[test]
fn in_space_every_pairing_passes_with_the_weights_of_the_start() {
    in_space(Strains::Held, [100.0, 200.0], -0.01, true);
}

#[test]
fn in_space_every_pairing_passes_with_present_weights() {
    in_space(Strains::Linear, [100.0; 2], -0.01, false);
}

#[test]
fn in_space_every_pairing_passes_at_finite_strain() {
    in_space(Strains::Finite, [100.0; 2], -0.1, false);
}

/// Blocks of which each overhangs the other on all sides or on none, as in partial_patch.json.
fn overhanging(elements: [&'static str; 2], distortion: f64) -> Blocks {
    let mut blocks = Blocks::new(elements, distortion);
    let below = [vec![0.0, 0.45, 1.0], vec![0.0, 0.6, 1.0]];
    let above = [vec![-0.35, 0.3, 0.7, 1.2], vec![-0.2, 0.35, 0.8, 1.15]];
    let n = blocks.ndim() - 1;
    blocks.across = [below[..n].to_vec(), above[..n].to_vec()];
    blocks
}

fn overhang(elements: [&'static str; 2], allowed: f64) {
    let mut worst = Errors::default();
    for (strains, young, nu, strain) in [
        (Strains::Held, [100.0, 200.0], 0.3, -0.01),
        (Strains::Linear, [100.0, 200.0], 0.0, -0.01),
        (Strains::Finite, [100.0; 2], 0.0, -0.1),
    ] {
        let blocks = Blocks {
            strains,
            young,
            nu,
            ..overhanging(elements, DISTORTION)
        };
        worst = worst.or(either(&blocks, strain));
    }
    told("overhang", elements, worst);
    assert!(worst.of_forces() < allowed, "{elements:?}: {worst:?}");
}

#[test]
fn in_the_plane_overhang_passes() {
    for elements in pairings(PLANE) {
        overhang(elements, 1e-12);
    }
}

#[test]
fn in_space_overhang_passes() {
    for elements in pairings(FACES) {
        overhang(elements, 1e-10);
    }
}

/// The last facet of the upper block is covered by so much at its edge, in space at its corner.
#[test]
fn little_coverage_costs_nothing() {
    for name in ["quad4", "quad8", "hex8", "hex20", "hex27", "tet4", "tet10"] {
        for little in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let mut blocks = Blocks::new([name, name], 0.0);
            for ends in &mut blocks.across[1] {
                *ends = vec![0.0, 0.4, 1.0 - little, 1.5];
            }
            let exact = blocks.pressed(-0.01);
            let (model, run) = blocks.solve(&exact);
            let errors = blocks.compare(&model, &run, &exact);
            let allowed = if blocks.ndim() == 2 { 1e-12 } else { 1e-11 };
            let name = [name, name];
            told(&format!("covered {little:.0e}"), name, errors);
            assert!(errors.of_forces() < allowed, "{name:?}: {errors:?}");
        }
    }
}

#[test]
fn overhanging_grids_are_solved_as_in_the_reference() {
    let Some(file) = reference("partial_patch.json") else {
        return;
    };
    let mut checked = 0;
    for row in file["rows"].as_array().unwrap() {
        let case = row["case"].as_str().unwrap();
        if row["kind"] != "dual" || row["mode"] != "consistent" || !matches!(case, "2d" | "3d") {
            continue;
        }
        let name = if case == "2d" { "quad4" } else { "hex8" };
        let mut blocks = Blocks {
            upper_is_secondary: row["secondary"] == "upper",
            ..overhanging([name, name], 0.0)
        };
        if case == "2d" {
            blocks.heights = [vec![0.0, 0.5, 1.0], vec![1.0, 1.6, 2.0]];
        }
        // pressure 1
        let strain = blocks.pressed(1.0).pressure.recip();
        let exact = blocks.pressed(strain);
        let errors = blocks.errors(&exact);
        told(case, [name, name], errors);
        let allowed = if case == "2d" { 1e-12 } else { 1e-11 };
        assert!(errors.most() < allowed, "{errors:?}");
        checked += 1;
    }
    assert_eq!(checked, 4);
}

#[test]
fn the_dual_run_of_the_reference_is_met() {
    let Some(file) = reference("mortar_patch_2d.json") else {
        return;
    };
    let data = &file["2d_upper_dual"];
    let list = |value: &Value| -> Vec<Vec<f64>> {
        value.as_array().unwrap().iter().map(numbers).collect()
    };
    let mut scene = Scene::default();
    for x in list(&data["X"]) {
        scene.node(&x);
    }
    let lower = data["n_lower_elements"].as_u64().unwrap() as usize;
    for (k, nodes) in list(&data["elements"]).iter().enumerate() {
        let group = if k < lower { "lower" } else { "upper" };
        let nodes = nodes.iter().map(|n| *n as usize + 1).collect();
        scene.cell("quad4", group, nodes);
    }
    let mut step = String::new();
    for dof in numbers(&data["fixed_dofs"]) {
        let (node, axis) = (dof as usize / 2 + 1, ["x", "y"][dof as usize % 2]);
        scene.set(&format!("fixed_{dof}"), &[node]);
        writeln!(step, "[[step.fix]]\non = \"fixed_{dof}\"\nu = [{axis:?}]").unwrap();
    }
    for (k, force) in numbers(&data["F"]).chunks(2).enumerate() {
        if force.iter().any(|f| *f != 0.0) {
            scene.set(&format!("loaded_{k}"), &[k + 1]);
            writeln!(
                step,
                "[[step.load]]\non = \"loaded_{k}\"\nper_node = {force:?}"
            )
            .unwrap();
        }
    }
    for (name, of) in [("roof", "lower"), ("foot", "upper")] {
        scene.place(name, &format!("plane = \"y\", at = 1.0, of = {of:?}"));
    }
    let blocks = Blocks::new(["quad4"; 2], 0.0);
    // what holds the upper block while it settles ends with the second step
    let case = blocks.begin(&scene).also(&blocks.step("press")).also(&step);
    let mut model = case.also(&blocks.step("hold")).newton(NEWTON).model(&[]);
    let run = finished(&mut model);
    let frame = run.frames.last().unwrap();
    let u: Vec<f64> = frame.displacement.iter().flat_map(|u| [u.x, u.y]).collect();
    let error = relative(&u, &list(&data["u"]).concat());
    let lambda = relative(&frame.contacts[0].pressure, &numbers(&data["lam"]));
    println!("reference: u {error:.1e} multipliers {lambda:.1e}");
    assert!(error < 1e-9 && lambda < 1e-9);
}

#[test]
fn what_sticks_deforms_as_one_body() {
    for elements in [
        ["quad4", "quad4"],
        ["quad8", "tri6"],
        ["quad9", "tri3"],
        ["hex8", "hex8"],
        ["tet10", "hex20"],
        ["hex27", "wedge6"],
    ] {
        let mut blocks = Blocks {
            strains: Strains::Finite,
            young: [100.0; 2],
            contact: "friction = 10.0",
            ..Blocks::new(elements, DISTORTION)
        };
        let up = blocks.ndim() - 1;
        if up == 2 {
            blocks.across = [
                vec![vec![0.0, 1.0]; 2],
                vec![vec![0.0, 0.45, 1.0], vec![0.0, 1.0]],
            ];
        }
        let mut rows = [Vec3::ZERO; 3];
        rows[up][up] = -0.12;
        rows[0][up] = 0.25;
        let gradient = Mat3::from_rows(rows);
        for steps in [1, 4] {
            for upper_is_secondary in [true, false] {
                blocks.upper_is_secondary = upper_is_secondary;
                let errors = blocks.deformed(gradient, steps);
                told(&format!("stick, {steps} steps"), elements, errors);
                assert!(errors.displacement < 1e-12, "{elements:?}: {errors:?}");
            }
        }
    }
}
