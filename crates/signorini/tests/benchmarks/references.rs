//! What supports exert on a reference that nodes follow.
//!
//! SOURCE      Statics: a body at rest, and its end tractions.
//! GOAL        `history.csv` has the force and the moment that prescribe the motion of a reference
//! MESH        a bar of 4 quad4 or hex8, its right end following a reference a little off it
//! CONDITIONS  stretched, and turned, at small strain without lateral contraction
//! EXPECTED    E A ε stretched; turned, the force and the moment that balance those at the other end about any point
//! TOLERANCE   1e-9

use signorini::{Reading, RunOptions, build, open_text, run};
use signorini_io::fs::{Fs, MemoryFs};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

/// Where the reference is.
const AT: [f64; 3] = [4.5, 0.7, 0.2];

fn bar(ndim: usize, motion: &str) -> String {
    let (mut nodes, mut elements) = (String::new(), String::new());
    let ring: &[[f64; 2]] = match ndim {
        2 => &[[0.0, 0.0], [1.0, 0.0]],
        _ => &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    };
    let n = ring.len();
    for k in 0..5 {
        for (place, [y, z]) in ring.iter().enumerate() {
            let third = if ndim == 3 {
                format!(", {z}")
            } else {
                String::new()
            };
            write!(nodes, "[{}, {k}, {y}{third}], ", k * n + place + 1).unwrap();
        }
    }
    for k in 0..4 {
        let a = k * n + 1;
        let (kind, of) = match ndim {
            2 => ("quad4", vec![a, a + 2, a + 3, a + 1]),
            _ => ("hex8", (a..a + 8).collect()),
        };
        write!(
            elements,
            "{{ id = {}, type = \"{kind}\", group = \"bar\", nodes = {of:?} }}, ",
            k + 1
        )
        .unwrap();
    }
    let last: Vec<usize> = (4 * n + 1..=5 * n).collect();
    let first: Vec<usize> = (1..=n).collect();
    let space = if ndim == 2 { "plane-strain" } else { "3d" };
    let at = &AT[..ndim];
    format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"{space}\"\n\
         [sets]\nfirst = {{ nodes = {first:?} }}\nlast = {{ nodes = {last:?} }}\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\n[[body]]\ngroup = \"bar\"\nmaterial = \"m\"\n\
         [reference.pilot]\nat = {at:?}\n[[constraint]]\nkind = \"kinematic\"\non = \"last\"\nreference = \"pilot\"\n\
         [[output.history]]\nname = \"wall\"\nset = \"first\"\nquantity = \"reaction_force.x\"\n\
         [[step]]\nname = \"s\"\ngeometry = \"linear\"\nincrements = 1\nfix = [{{ on = \"first\", u = \"all\" }}]\n\
         [[step.move]]\non = \"pilot\"\n{motion}\n"
    )
}

/// The reactions on all nodes with their places, and the last row of `history.csv`.
fn solve(text: &str) -> BTreeMap<String, f64> {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut options = RunOptions::new(loaded.source);
    options.fs = Arc::clone(&fs);
    let mut model =
        build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()));
    let finished = run(&mut model, &options, &mut ());
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    let history = fs.read("case.out/history.csv".as_ref()).unwrap();
    let history = String::from_utf8(history).unwrap();
    let (head, last) = (history.lines().next(), history.lines().last());
    let named = head.unwrap().split(',').zip(last.unwrap().split(','));
    let value = |(name, text): (&str, &str)| Some((name.to_owned(), text.parse().ok()?));
    named.filter_map(value).collect()
}

#[test]
fn a_reference_is_held_by_what_balances_the_body() {
    for (ndim, held) in [(2, "uy = 0"), (3, "uy = 0\nuz = 0\nrx = 0\nry = 0")] {
        let row = solve(&bar(ndim, &format!("ux = 0.02\nrz = 0\n{held}")));
        let axial = 1000.0 * 0.02 / 4.0;
        let close = |name: &str, right: f64| {
            let got = row[name];
            assert!((got - right).abs() < 1e-9 * axial, "{name}: {got}, {right}");
        };
        close("pilot.reaction_force_x", axial);
        close("wall.reaction_force.x", -axial);
        close("pilot.reaction_force_y", 0.0);
        // the axial force acts along the middle of the bar, not through the reference
        close("pilot.reaction_moment_z", axial * (AT[1] - 0.5));
        if ndim == 3 {
            close("pilot.reaction_moment_y", axial * (0.5 - AT[2]));
        }
        // nothing touches
        close("pilot.force_x", 0.0);
        // turned about the reference: a constant curvature and a shear that its place makes
        let row = solve(&bar(ndim, &format!("ux = 0\nrz = 0.01\n{held}")));
        assert!(row["pilot.reaction_moment_z"] > 0.0);
        let axial = row["pilot.reaction_force_x"];
        let wall = row["wall.reaction_force.x"];
        assert!(
            axial.abs() > 0.1 && (axial + wall).abs() < 1e-9 * axial.abs(),
            "{axial} {wall}"
        );
    }
}
