//! Rigid bodies that meet without penetration: impulses at the ends of increments.

use super::rigid::block;
use super::{Table, solved, stopped_after};

/// A rigid block on a floor without penetration.
fn hard(velocity: &str, duration: f64, increments: usize, keys: &str, extra: &str) -> String {
    block(1.0, velocity, duration, increments, extra)
        .replace("penalty = 1.0, per = \"node\"", "lagrange = {}")
        .replace("friction = 0.3\n", keys)
}

/// A rigid block that falls flat leaves with its coefficient of restitution, with friction and without, and rests in the end.
#[test]
fn a_hard_block_leaves_an_impact_as_restitution_says() {
    let weight = "load = [{ on = \"block\", gravity = [0, -10] }]";
    for friction in ["", "friction = 0.3\n"] {
        for restitution in [0.0, 0.5, 1.0] {
            let keys = format!("{friction}restitution = {restitution:?}\n");
            let got = solved(&hard("v = [0, -3]", 0.02, 4, &keys, ""));
            let place = format!("{friction} {restitution}");
            let velocity = &got["block.velocity_y"];
            assert!(
                (velocity[0] - 3.0 * restitution).abs() < 1e-9,
                "{place}: {velocity:?}"
            );
            assert!(
                (velocity[3] - 3.0 * restitution).abs() < 1e-9,
                "{place}: {velocity:?}"
            );
        }
        let keys = format!("{friction}restitution = 0.5\n");
        let text = hard("v = [0, 3]", 2.4, 480, &keys, weight);
        let got = solved(&text);
        // up and down, then half of that again and again: v/g (1 + e)/(1 − e) + v/g
        let (velocity, time) = (&got["block.velocity_y"], &got["time"]);
        let moves = |v: &&f64| v.abs() > 1e-6;
        let last = velocity.iter().rposition(|v| moves(&v)).unwrap();
        assert!(
            (time[last] - 1.2).abs() < 0.05,
            "{friction}: {}",
            time[last]
        );
        let force = *got["c.force_y"].last().unwrap();
        assert!(
            (force.abs() / 20.0 - 1.0).abs() < 1e-5,
            "{friction}: {force}"
        );
        let lost: Vec<f64> = got["energy.algorithmic"].clone();
        let gained = lost.windows(2).map(|pair| pair[0] - pair[1]);
        // an impact within an increment is one at its start
        assert!(gained.fold(0.0, f64::max) < 1e-2 * 9.0, "{friction}");
    }
}

/// A rigid block that is thrown tumbles, slides, and comes to rest on a side; nothing gives it energy.
#[test]
fn a_hard_block_that_is_thrown_comes_to_rest() {
    let weight = "load = [{ on = \"block\", gravity = [0, -10] }]";
    for velocity in ["v = [2, 1], omega = -6.0", "v = [0, 0], omega = 2.0"] {
        let text = hard(velocity, 3.0, 600, "friction = 0.4\n", weight);
        let got = solved(&text);
        for name in [
            "block.velocity_x",
            "block.velocity_y",
            "block.angular_velocity_z",
        ] {
            let last = *got[name].last().unwrap();
            assert!(last.abs() < 1e-5, "{velocity}: {name} {last}");
        }
        let force = *got["c.force_y"].last().unwrap();
        assert!(
            (force.abs() / 20.0 - 1.0).abs() < 1e-4,
            "{velocity}: {force}"
        );
        let turned = *got["block.rotation_z"].last().unwrap() / std::f64::consts::FRAC_PI_2;
        assert!(
            (turned - turned.round()).abs() < 1e-4,
            "{velocity}: {turned}"
        );
        let start = got["energy.kinetic"][0];
        let lost = &got["energy.algorithmic"];
        let gained = lost.windows(2).map(|pair| pair[0] - pair[1]);
        let most = gained.fold(0.0, f64::max);
        assert!(most < 1e-2 * start, "{velocity}: {most}");
    }
    let text = hard(
        "v = [2, 1], omega = -6.0",
        0.5,
        100,
        "friction = 0.4\n",
        weight,
    ) + "[checkpoint]\nevery = { increments = 1 }\n";
    let whole = stopped_after(&text, &[]);
    for stops in [&[9][..], &[40, 61]] {
        assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
    }
}

/// A rigid cube of mass 2 that is thrown above a floor, by its elements.
fn cube(velocity: &str, keys: &str) -> String {
    let nodes: Vec<String> = (0..8)
        .map(|k| format!("[{}, {}, {}, {}]", k + 1, k & 1, k >> 1 & 1, k >> 2 & 1))
        .collect();
    let faces: Vec<String> = (1..=6).map(|side| format!("[1, \"S{side}\"]")).collect();
    format!(
        "[mesh]\nnodes = [{}]\nelements = [{{ id = 1, type = \"hex8\", group = \"c\", nodes = [1, 2, 4, 3, 5, 6, 8, 7] }}]\n\
         [model]\nspace = \"3d\"\n[material.m]\nmodel = \"linear-elastic\"\nE = 1e3\nnu = 0.3\ndensity = 2.0\n\
         [[body]]\ngroup = \"c\"\nrigid = true\nmaterial = \"m\"\n[sets]\nsides = {{ faces = [{}] }}\n\
         [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }} }}\n\
         [[contact]]\nname = \"k\"\nsecondary = \"sides\"\nprimary = \"floor\"\nmethod = \"node-to-segment\"\n\
         enforcement = {{ lagrange = {{}} }}\n{keys}\n[initial]\nvelocity = [{{ on = \"c\", {velocity} }}]\n\
         [[step]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 1.75\nincrements = 350\n\
         load = [{{ on = \"c\", gravity = [0, 0, -10] }}]\n",
        nodes.join(", "),
        faces.join(", ")
    )
}

/// A rigid cube that is thrown comes to rest on a face, on more nodes than it takes, and nothing gives it energy.
#[test]
fn a_hard_cube_that_is_thrown_comes_to_rest() {
    for (velocity, keys) in [
        ("v = [1, 0, 4], omega = [1, 1, 0]", "friction = 0.3"),
        ("v = [0, 0, 2], omega = [2, 1, 0]", "friction = 0.5"),
    ] {
        let got = solved(&cube(velocity, keys));
        let last = |name: &str| *got[name].last().unwrap();
        for axis in ["x", "y", "z"] {
            for what in ["velocity", "angular_velocity"] {
                let rate = last(&format!("c.{what}_{axis}"));
                assert!(rate.abs() < 1e-4, "{velocity}: {what} {axis} {rate}");
            }
        }
        assert!((last("k.force_z").abs() / 20.0 - 1.0).abs() < 1e-4);
        gains_nothing(&got, 1e-2, velocity);
    }
}

/// The largest energy that an increment adds, over that at the start and what gravity may give.
fn gains_nothing(got: &Table, most: f64, place: &str) {
    let lost = &got["energy.algorithmic"];
    let gained = lost.windows(2).map(|pair| pair[0] - pair[1]);
    let gained = gained.fold(0.0, f64::max);
    let start = got["energy.kinetic"][0].max(1.0);
    assert!(gained < most * start, "{place}: {gained} of {start}");
}

/// Two rigid blocks that meet off their centres keep momentum and angular momentum, and part as restitution says.
#[test]
fn hard_blocks_that_meet_keep_their_momenta() {
    for restitution in [0.0, 0.4, 1.0] {
        for friction in ["", "friction = 0.4"] {
            let text = format!(
                "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1], [5, 0.4, 1.05], [6, 1.4, 1.05], [7, 1.4, 2.05], [8, 0.4, 2.05]]\n\
                 elements = [{{ id = 1, type = \"quad4\", group = \"a\", nodes = [1, 2, 3, 4] }}, \
                 {{ id = 2, type = \"quad4\", group = \"b\", nodes = [5, 6, 7, 8] }}]\n\
                 [model]\nspace = \"plane-strain\"\n[material.m]\nmodel = \"linear-elastic\"\nE = 1e3\nnu = 0.3\ndensity = 2.0\n\
                 [[body]]\ngroup = \"a\"\nrigid = true\nmaterial = \"m\"\n[[body]]\ngroup = \"b\"\nrigid = true\nmaterial = \"m\"\n\
                 [sets]\ns = {{ faces = [[2, \"-y\"]] }}\np = {{ faces = [[1, \"+y\"]] }}\n\
                 [[contact]]\nname = \"k\"\nsecondary = \"s\"\nprimary = \"p\"\nmethod = \"node-to-segment\"\n\
                 enforcement = {{ lagrange = {{}} }}\nrestitution = {restitution:?}\n{friction}\n\
                 [initial]\nvelocity = [{{ on = \"b\", v = [0, -1] }}]\n\
                 [[step]]\nname = \"meet\"\nkind = \"dynamic\"\nduration = 0.055\nincrements = {{ fixed = 11 }}\n"
            );
            let got = solved(&text);
            let place = format!("{restitution} {friction}");
            let last = |name: &str| *got[name].last().unwrap();
            // both have a mass of 2 and a moment of inertia of 1/3, and hardly move until then
            let [a, b] = ["a", "b"].map(|body| {
                let rate = |axis: &str| last(&format!("{body}.velocity_{axis}"));
                [
                    rate("x"),
                    rate("y"),
                    last(&format!("{body}.angular_velocity_z")),
                ]
            });
            assert!((a[0] + b[0]).abs() < 1e-9, "{place}: {a:?} {b:?}");
            assert!((a[1] + b[1] + 1.0).abs() < 1e-9, "{place}: {a:?} {b:?}");
            let turning =
                (a[2] + b[2]) / 3.0 + 2.0 * (0.5 * a[1] + 0.9 * b[1] - 0.5 * a[0] - 1.5 * b[0]);
            assert!((turning + 1.8).abs() < 5e-3, "{place}: {turning}");
            let parts = (b[1] - 0.5 * b[2]) - (a[1] - 0.1 * a[2]);
            assert!((parts - restitution).abs() < 1e-2, "{place}: {parts}");
            gains_nothing(&got, 1e-9, &place);
        }
    }
}
