//! The three examples of the paper.
//!
//! SOURCE      Faltus, Horák, "A modular extension of a finite element contact implementation", figure 2; values from
//!             an independent program (data/paper_examples.json: geometry and rules in its note).
//! GOAL        One node against a wedge's triangle, a brick's quadrilateral on an axis and anywhere.
//! MESH        One wedge6 or hex8, St. Venant-Kirchhoff, E = 500, nu = 0.
//! CONDITIONS  Base fixed, tip of a rigid tetrahedron pushed down by 0.3 in 60 increments; penalty 1e5 per node.
//! EXPECTED    Force, gap and displacements of all increments.
//! TOLERANCE   1e-8: both programs iterate to round-off, the data has 12 digits.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, example, model, numbers, oracle, relative, run, text};

/// Key of the data, example, place of the tip.
const CASES: [(&str, &str, &str); 3] = [
    (
        "A_p1e+05",
        "paper_wedge_3d",
        "0.333333333333,  0.333333333333",
    ),
    ("A2_p1e+05", "paper_wedge_3d", "0.25,  0.3"),
    ("B_p1e+05", "paper_brick_symmetric_3d", "0.5,  0.25"),
];

#[test]
fn wedge_and_symmetric_brick_match_the_independent_program() {
    let data = oracle("paper_examples.json");
    for (key, name, tip) in CASES {
        let text = text(name).replace("0.333333333333,  0.333333333333", tip);
        let mut model = model(name, &text, &[]);
        let result = run(&mut model);
        assert!(result.error.is_none(), "{key}: {:?}", result.error);
        assert_eq!(result.frames.len(), 60);
        let expected = &data["examples"][key];
        for row in expected["curve_step_fz_g_mineig"].as_array().unwrap() {
            let row = numbers(row);
            let increment = row[0] as usize;
            let contact = &result.frames[increment - 1].contacts[0];
            let force = contact.secondary.force.z;
            assert!(
                (force / row[1] - 1.0).abs() < 1e-8,
                "{key} {increment}: {force} {}",
                row[1]
            );
            assert!(
                (contact.gap_min / row[2] - 1.0).abs() < 1e-8,
                "{key} {increment}"
            );
        }
        for (increment, step) in expected["steps"].as_object().unwrap() {
            let increment: usize = increment.parse().unwrap();
            let frame = &result.frames[increment - 1];
            let force = frame.contacts[0].secondary.force.to_array();
            assert!(
                relative(&force, &numbers(&step["fnode"])) < 1e-8,
                "{key} {increment}"
            );
            let top = step["u_top"].as_array().unwrap();
            let u: Vec<f64> = top.iter().flat_map(numbers).collect();
            let n = top.len();
            let got: Vec<f64> = frame.displacement[n..2 * n]
                .iter()
                .flat_map(|u| u.to_array())
                .collect();
            assert!(relative(&got, &u) < 1e-8, "{key} {increment}");
            let base = frame.reaction_force[..n].iter().copied();
            let base: signorini_geometry::tensor::Vec3 = base.sum();
            assert!(relative(&base.to_array(), &numbers(&step["base_reaction"])) < 1e-8);
        }
        let listed = numbers(&expected["iters_ls"]);
        for (record, listed) in result.increments.iter().zip(listed) {
            assert!(
                record.iterations <= listed as usize + 1,
                "{key} {}: {} iterations, {listed} listed",
                record.increment,
                record.iterations
            );
        }
    }
}

fn arbitrary(penalty: &str) -> Run {
    // the tolerance of the example is that of a verification; here the default is to do
    let set = [
        ("contact.tip.enforcement.penalty", penalty),
        ("solver.newton.force_tol", "1e-6"),
    ];
    let run = run(&mut example("paper_brick_arbitrary_3d", &set));
    assert!(run.error.is_none(), "{penalty}: {:?}", run.error);
    assert_eq!(run.frames.len(), 60);
    run
}

/// The residual is measured in the energy norm, √|du·r|: in the largest component, stiff contact hides the residual in
/// soft directions, and reveals it one iteration later.
#[test]
fn arbitrary_brick_converges_quadratically_for_every_penalty() {
    for penalty in ["1e4", "1e5", "1e6"] {
        let run = arbitrary(penalty);
        let reference = run.decrements(1)[0];
        for increment in 1..=60 {
            let decrements = run.decrements(increment);
            for pair in decrements.windows(2) {
                if pair[1] > 1e-11 * reference {
                    assert!(
                        pair[1] <= 100.0 * pair[0] * pair[0] / reference,
                        "{penalty} {increment}: {decrements:?}"
                    );
                }
            }
        }
        let most = run.increments.iter().map(|i| i.iterations).max();
        assert!(most <= Some(6), "{penalty}: {most:?} iterations");
        assert!(run.cutbacks.is_empty());
    }
}

#[test]
fn distance_to_the_stiffest_solution_falls_as_one_over_the_penalty() {
    let runs: Vec<Run> = ["1e4", "1e5", "1e6", "1e7"].map(arbitrary).into();
    let displacements = |run: &Run, increment: usize| -> Vec<f64> {
        let frame = &run.frames[increment - 1];
        frame.displacement[4..8]
            .iter()
            .flat_map(|u| u.to_array())
            .collect()
    };
    for increment in [10, 30, 50] {
        let stiffest = displacements(&runs[3], increment);
        let distance: Vec<f64> = runs[..3]
            .iter()
            .map(|r| {
                let u = displacements(r, increment);
                let squares = u.iter().zip(&stiffest).map(|(a, b)| (a - b) * (a - b));
                squares.sum::<f64>().sqrt()
            })
            .collect();
        // against the solution at 1e7 the law is 1/p - 1/1e7
        for (pair, penalties) in distance.windows(2).zip([[1e4, 1e5], [1e5, 1e6]]) {
            let expected = (1.0 / penalties[0] - 1e-7) / (1.0 / penalties[1] - 1e-7);
            let ratio = pair[0] / pair[1];
            assert!(
                (ratio / expected - 1.0).abs() < 0.2,
                "{increment}: {ratio} {expected}"
            );
        }
    }
}

/// SOURCE      Closed form: the wedge under its centroid is in uniaxial stress, F = A ½ E (l − l³) with A = ½, and the
///             tip at depth d penetrates by d − (1 − l) = F/ε.
/// TOLERANCE   1e-10: both sides are solved to round-off.
#[test]
fn wedge_under_its_centroid_has_its_closed_form() {
    let result = run(&mut example("paper_wedge_3d", &[]));
    let (young, area, penalty) = (500.0, 0.5, 1e5);
    for (increment, frame) in result.frames.iter().enumerate() {
        let depth = 0.3 * (increment + 1) as f64 / 60.0;
        let force = |l: f64| area * 0.5 * young * (l - l.powi(3));
        let mut stretch = 1.0 - depth;
        for _ in 0..50 {
            // Newton on F(l)/ε = d − (1 − l)
            let slope = area * 0.5 * young * (1.0 - 3.0 * stretch * stretch) / penalty - 1.0;
            stretch -= (force(stretch) / penalty - depth + 1.0 - stretch) / slope;
        }
        let got = frame.contacts[0].secondary.force.z;
        assert!(
            (got / force(stretch) - 1.0).abs() < 1e-10,
            "{increment}: {got} {}",
            force(stretch)
        );
    }
}

/// GOAL        A rigid body that is loaded moves along the load and is held otherwise.
/// EXPECTED    Contact carries the load in every increment; at the force of the motion-driven run's last increment, the
///             tip has gone down as far as it was moved there.
#[test]
fn a_loaded_tip_goes_as_deep_as_the_moved_one_at_the_same_force() {
    let moved = run(&mut example("paper_wedge_3d", &[]));
    let force = moved.frames[59].contacts[0].secondary.force.z;
    let load = format!("force = [0.0, 0.0, -{force:?}]");
    let text = text("paper_wedge_3d")
        .replace("[[step.move]]", "[[step.load]]")
        .replace("uz = -0.3 ", &load)
        .replace("{ fixed = 60 }", "10");
    let loaded = run(&mut model("loaded", &text, &[]));
    assert!(loaded.error.is_none(), "{:?}", loaded.error);
    for (increment, frame) in loaded.frames.iter().enumerate() {
        let expected = force * (increment + 1) as f64 / 10.0;
        let got = frame.contacts[0].secondary.force.z;
        assert!(
            (got / expected - 1.0).abs() < 1e-9,
            "{increment}: {got} {expected}"
        );
    }
    let last = loaded.frames.last().map(|f| f.rigid[0].displacement.z);
    assert!(last.is_some_and(|z| (z + 0.3).abs() < 1e-9), "{last:?}");
}
