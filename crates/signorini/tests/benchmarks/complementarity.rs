//! Parameters of complementarity change the way to a solution, not the solution.
//!
//! SOURCE      Written for the purpose; Hüeber, Stadler, Wohlmuth, *SIAM J. Sci. Comput.* 30 (2008) 572–596: the equations have
//!             the same roots for every positive parameter
//! GOAL        the converged state does not depend on the parameters c and c_t of laws that solve for multipliers
//! MESH        a block of 4 × 2 quad4 on a base of 7 × 3, which do not match
//! CONDITIONS  plane strain, small strain, E = 1000 and 2000, nu = 0.3, friction 0.3; the block is pressed, then pushed
//!             sideways so far that some rows stick and some slip; force_tol 1e-11; c a hundredth of the automatic one, and ten
//!             times as much, and with it c_t
//! EXPECTED    the displacements with the automatic c
//! TOLERANCE   1e-9 of the largest displacement
use crate::common::run;
use crate::scene::{Scene, Side, equal};
use std::collections::BTreeSet;

/// The displacements at the end, for a parameter of complementarity.
fn displacements(method: &str, c: Option<f64>) -> Vec<f64> {
    let mut scene = Scene::default();
    let base = scene.grid(
        "base",
        [&equal(-0.5, 1.5, 7), &equal(-1.0, 0.0, 3)],
        |x, y| [x, y],
    );
    let block = scene.grid(
        "block",
        [&equal(0.0, 1.0, 4), &equal(0.0, 0.5, 2)],
        |x, y| [x, y],
    );
    scene.faces("under", &base.faces(Side::Top));
    scene.faces("over", &block.faces(Side::Bottom));
    scene.set("bottom", &base.along(Side::Bottom));
    scene.set("top", &block.along(Side::Top));
    let penalty = c.map_or_else(String::new, |c| format!(", penalty = {c:?}"));
    let keys = format!(
        "method = \"{method}\"\nenforcement = {{ augmented = \"newton\"{penalty} }}\nfriction = 0.3"
    );
    let case = scene
        .elastic("plane-strain", 1000.0, 0.3)
        .body(&["base", "block"], "")
        .contact("over", "under", &keys)
        .step("press", 1)
        .fix("bottom", "xy")
        .displace("top", "ux = 0.0\nuy = -0.01")
        .step("push", 4)
        .displace("top", "ux = 0.003\nuy = -0.01")
        .newton("force_tol = 1e-11");
    let run = run(&mut case.model(&[]));
    assert!(run.error.is_none(), "{method} {c:?}: {:?}", run.error);
    let last = &run.frames[run.frames.len() - 1];
    let rows = last.contacts[0].status.iter();
    let states: BTreeSet<String> = rows.map(|s| format!("{s:?}")).collect();
    assert!(states.len() > 1, "{method} {c:?}: all rows {states:?}");
    last.displacement
        .iter()
        .flat_map(|u| u.to_array())
        .collect()
}

#[test]
fn the_parameter_of_complementarity_does_not_change_the_solution() {
    // c = M/h of the block, with M of compression
    let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
    for (method, per) in [("mortar", 4.0), ("node-to-segment", 1.0)] {
        let expected = displacements(method, None);
        let largest = expected.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        for factor in [0.01, 10.0] {
            let got = displacements(method, Some(factor * modulus * per));
            let off = got.iter().zip(&expected).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-9 * largest, "{method}, {factor}: {off:e}");
        }
    }
}
