//! Three ways to one solution: multipliers by the active set, by Uzawa's updates, and by Alart and Curnier's.
//!
//! SOURCE      Written for the purpose.
//! GOAL        a contact without penetration is the same whoever finds it
//! MESH        two blocks of examples/two_blocks_2d, 4 × 2 and 2 × 2 quad4; two half discs, elements of 0.15 and 0.18
//! CONDITIONS  blocks: finite strain, pressed and slid within a facet and across edges, without friction and with mu = 0.3;
//!             cylinders: pressed and sheared with mu = 0.3, so that some of the contact sticks and some slips; small sliding.
//!             Residuals to 1e-13 of the mean force, gaps to 1e-14 of a facet
//! EXPECTED    displacements and contact forces of the nodes in every increment, relative to the largest one
//! TOLERANCE   1e-10; found are some 1e-13
//!
//! Where points slide over facets, equilibrium need not be unique: on a polygon a node may rest on either side of a vertex,
//! and Uzawa's way, which lets it penetrate to begin with, may end on the other one (cylinders with finite sliding: 2e-3 in
//! displacement; Alart and Curnier's way stays with the active set's). Increments that are done with limits of friction held
//! are exact to 1e-7 of the largest limit only; there is none here.
use crate::common::{Run, example, run};
use crate::slip::cylinders;
use signorini_geometry::tensor::Vec3;

const WAYS: [&str; 3] = [
    "{ lagrange = {} }",
    "{ augmented = \"uzawa\" }",
    "{ augmented = \"newton\" }",
];
const TIGHT: &str = "{ force_tol = 1e-13, gap_tol = 1e-14, max_iterations = 60 }";

/// Largest difference over the largest vector.
fn apart(found: &[Vec3], expected: &[Vec3]) -> f64 {
    let largest = expected.iter().map(|v| v.max_abs()).fold(0.0, f64::max);
    let pairs = found.iter().zip(expected);
    pairs.map(|(f, e)| (*f - *e).max_abs()).fold(0.0, f64::max) / largest
}

/// Compares the ways in every increment.
fn agree(name: &str, solve: impl Fn(&str) -> Run) {
    let [first, others @ ..] = WAYS.map(solve);
    for (run, way) in others.iter().zip(&WAYS[1..]) {
        assert_eq!(run.frames.len(), first.frames.len());
        let (mut moved, mut pushed) = (0.0f64, 0.0f64);
        for (frame, expected) in run.frames.iter().zip(&first.frames) {
            moved = moved.max(apart(&frame.displacement, &expected.displacement));
            let (frame, expected) = (&frame.contacts[0], &expected.contacts[0]);
            pushed = pushed.max(apart(&frame.force, &expected.force));
        }
        let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
        println!(
            "{name} by {way}: {moved:.1e} in displacement, {pushed:.1e} in force, {iterations} iterations"
        );
        assert!(moved < 1e-10 && pushed < 1e-10, "{name} by {way}");
    }
}

#[test]
fn blocks_that_slide_far_are_the_same_by_every_way() {
    for friction in ["0.0", "0.3"] {
        for far in ["0.05", "0.195"] {
            let course = format!("[[5.0, 0.0], [12.0, {far}]]");
            agree(&format!("blocks, mu = {friction}, slid by {far}"), |way| {
                let set = [
                    ("contact.0.enforcement", way),
                    ("contact.0.friction", friction),
                    ("amplitude.slide.table", &course),
                    ("solver.newton", TIGHT),
                ];
                let run = run(&mut example("two_blocks_2d", &set));
                assert!(run.error.is_none(), "{way}: {:?}", run.error);
                run
            });
        }
    }
}

#[test]
fn cylinders_that_stick_in_the_middle_are_the_same_by_every_way() {
    agree("cylinders", |way| {
        let by = format!("method = \"node-to-segment\"\nsliding = \"small\"\nenforcement = {way}");
        let set = [("solver.newton", TIGHT), ("contact.0.friction", "0.3")];
        cylinders([0.15, 0.18], &by, &set)
    });
}
