//! Cook's membrane of a nearly incompressible material.
//!
//! SOURCE      Cook 1974; nearly incompressible as in Simo and Armero 1992
//! GOAL        no element that has a remedy against locking locks, at small and at finite strain
//! MESH        16 cells along each side; in space one layer between two planes that stay where they are
//! CONDITIONS  plane strain, clamped on the left, a total shear force of 100 on the right; E = 250, ν = 0.4999
//! EXPECTED    the displacement of the upper right corner on meshes of quad9 with 16 and 32 cells a side, extrapolated
//! TOLERANCE   1 % for quadratic elements; quad4 and hex8 2.5 %, whatever ν; in the original problem (plane stress, ν = 1/3) 1 %
//!             for all of them; elements without a remedy (tri3, tet4, wedge6) are far off, which is why `check` warns of them
#![allow(clippy::unwrap_used)]

mod common;

use common::Grid;
use signorini_geometry::element::by_name;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::load::{Course, Force, Load, Place};
use signorini_mechanics::material::NeoHookean;
use signorini_mechanics::model::{
    BodyKind, BodyPart, Change, LoadPart, Model, Parts, StepPart, Target,
};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::Idealisation;

/// The panel: 48 wide, 44 high at the wall, 16 at the end; one layer of thickness 1 in space.
fn panel(x: Vec3) -> Vec3 {
    let low = 44.0 * x.x;
    let high = 44.0 + 16.0 * x.x;
    Vec3::new(48.0 * x.x, low + (high - low) * x.y, x.z)
}

/// One version of the problem.
struct Panel {
    space: Idealisation,
    material: NeoHookean,
    force: f64,
    /// In space: whether the layer is between two planes, or free on one side.
    between: bool,
    /// Where at the end its motion is measured, relative to the height.
    at: f64,
}

/// In the plane, or in space.
fn space(name: &str, plane: Idealisation) -> Idealisation {
    match by_name(name).unwrap().dim() {
        2 => plane,
        _ => Idealisation::Space,
    }
}

/// How far the corner of the nearly incompressible panel moves upwards.
fn corner(name: &str, n: usize, locking: Locking, nonlinear: bool) -> f64 {
    corner_of(name, n, 0.4999, locking, nonlinear)
}

fn corner_of(name: &str, n: usize, nu: f64, locking: Locking, nonlinear: bool) -> f64 {
    let problem = Panel {
        space: space(name, Idealisation::PlaneStrain { thickness: 1.0 }),
        material: NeoHookean::new(250.0, nu),
        force: 100.0,
        between: true,
        at: 1.0,
    };
    moved(name, n, problem, locking, nonlinear)
}

/// How far the middle of the end of the original panel moves upwards.
fn original(name: &str, n: usize) -> f64 {
    let problem = Panel {
        space: space(name, Idealisation::PlaneStress { thickness: 1.0 }),
        material: NeoHookean::new(1.0, 1.0 / 3.0),
        force: 1.0,
        between: false,
        at: 0.5,
    };
    moved(name, n, problem, Locking::Auto, false)
}

fn moved(name: &str, n: usize, problem: Panel, locking: Locking, nonlinear: bool) -> f64 {
    let Panel {
        space,
        material,
        force,
        between,
        at,
    } = problem;
    let grid = Grid::new(name, n, 1, panel);
    let dim = space.ndim();
    let hold = |nodes, axes: &[usize]| {
        let motions = axes.iter().map(|&axis| (axis, Motion::Hold));
        Change::Prescribe(Target::Nodes(nodes), motions.collect())
    };
    let mut changes = vec![hold(grid.nodes(|x| x.x < 1e-9), &[0, 1])];
    if dim == 3 {
        changes.push(hold(grid.nodes(|x| between || x.z < 1e-9), &[2]));
    }
    let parts = Parts {
        bodies: vec![BodyPart {
            name: "membrane".into(),
            cells: grid.cells.clone(),
            kind: BodyKind::Solid {
                material: Box::new(material),
                later: Vec::new(),
                density: None,
                mass: Default::default(),
                integration: Integration::Full,
                locking,
                space: None,
                profile: None,
                linear_temperatures: false,
                at_nodes: Default::default(),
                initial: Vec::new(),
                axes: None,
                heat: None,
            },
        }],
        steps: vec![StepPart {
            name: "shear".into(),
            duration: 1.0,
            increments: Increments::Adaptive {
                initial: if nonlinear { 0.2 } else { 1.0 },
                min: 1e-3,
                max: 1.0,
                count_max: 100,
            },
            nonlinear,
            scheme: None,
            control: None,
            vibration: None,
            physics: signorini_mechanics::system::Physics::default(),
            changes,
            loads: vec![LoadPart {
                name: "shear".into(),
                load: Force(Vec3::new(0.0, force, 0.0))
                    .on(Place::Faces(grid.faces(|x| x.x > 1.0 - 1e-9))),
                course: Course::Ramp,
            }],
            contacts: Vec::new(),
            temperatures: Vec::new(),
            freed_temperatures: Vec::new(),
            activity: Vec::new(),
        }],
        ..Parts::new(&grid.mesh, space)
    };
    let mut model = Model::assemble(parts).unwrap();
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut quiet = |_: &Event<'_>| Flow::Continue;
    let outcome = stepper.run(&mut model.system, &model.steps, &mut quiet);
    assert_eq!(outcome.unwrap(), Outcome::Finished, "{name}");
    let end = grid.nodes(|x| x.x > 1.0 - 1e-9 && (x.y - at).abs() < 1e-9 && x.z < 1e-9)[0];
    stepper.state().u[end as usize * dim + 1]
}

/// The converged value: the upper corner of the wall is singular, and errors there fall linearly with the size of cells.
fn converged(nonlinear: bool) -> f64 {
    let [coarse, fine] = [16, 32].map(|n| corner("quad9", n, Locking::Auto, nonlinear));
    2.0 * fine - coarse
}

/// How far a value is off, printed.
fn error(name: &str, n: usize, value: f64, expected: f64) -> f64 {
    let error = value / expected - 1.0;
    println!(
        "{name:8} n = {n}: {value:.4}, converged {expected:.4}, error {:+.2} %",
        100.0 * error
    );
    error.abs()
}

fn cured(names: &[&str], n: usize, nonlinear: bool, expected: f64) {
    for name in names {
        let value = corner(name, n, Locking::Auto, nonlinear);
        assert!(error(name, n, value, expected) < 0.01, "{name}");
    }
}

#[test]
fn quadratic_elements_are_within_a_percent_at_16_cells_a_side() {
    cured(
        &[
            "tri6", "quad8", "quad9", "tet10", "wedge15", "hex20", "hex27",
        ],
        16,
        false,
        converged(false),
    );
}

#[test]
fn bilinear_elements_do_not_lock() {
    // they follow the singular corners more slowly: 2.3 % at 16 cells a side, as published for elements of their kind
    let expected = converged(false);
    cured(&["quad4"], 40, false, expected);
    for name in ["quad4", "hex8"] {
        let value = corner(name, 16, Locking::Auto, false);
        assert!(error(name, 16, value, expected) < 0.025, "{name}");
        let harder = corner_of(name, 16, 0.499_999, Locking::Auto, false);
        assert!((harder / value - 1.0).abs() < 1e-3, "{name}: {harder}");
        let plain = corner(name, 16, Locking::None, false);
        assert!(error(name, 16, plain, expected) > 0.5, "{name}");
    }
}

#[test]
fn the_original_membrane_bends_within_a_percent_at_16_cells_a_side() {
    // plane stress, E = 1, ν = 1/3, force 1: 23.96 is the published converged value
    // in space one layer, free on one side
    for name in [
        "quad4", "quad8", "quad9", "tri6", "hex8", "hex20", "hex27", "tet10", "wedge15",
    ] {
        let value = original(name, 16);
        assert!(error(name, 16, value, 23.96) < 0.01, "{name}");
    }
}

#[test]
fn elements_without_a_remedy_lock() {
    let expected = converged(false);
    for name in ["tri3", "tet4", "wedge6"] {
        let value = corner(name, 16, Locking::Auto, false);
        assert!(error(name, 16, value, expected) > 0.3, "{name}");
    }
}

#[test]
fn plane_elements_do_not_lock_at_finite_strain() {
    let expected = converged(true);
    cured(&["tri6", "quad8", "quad9"], 16, true, expected);
    let value = corner("quad4", 16, Locking::Auto, true);
    assert!(error("quad4", 16, value, expected) < 0.02);
}

#[test]
#[ignore = "takes a minute: run by .ci/run"]
fn elements_in_space_do_not_lock_at_finite_strain() {
    let expected = converged(true);
    cured(&["tet10", "wedge15", "hex20", "hex27"], 16, true, expected);
    let value = corner("hex8", 16, Locking::Auto, true);
    assert!(error("hex8", 16, value, expected) < 0.02);
}
