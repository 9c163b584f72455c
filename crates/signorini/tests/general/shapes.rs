//! Bodies that meet by corners and edges, and one that is wound.

use super::scene::Scene;
use super::{carried, close, solve};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// The image of the unit cube that stands on an edge, or on a corner, with its lowest place at `low`.
fn tilted(at: [f64; 3], on_corner: bool, low: [f64; 3]) -> [f64; 3] {
    let s = FRAC_1_SQRT_2;
    let [u, v, w] = at;
    // about the y axis by 45 degrees: its edge along y is the lowest
    let (x, y, z) = ((u - w) * s, v, (u + w) * s);
    let (y, z) = match on_corner {
        false => (y, z),
        // and about the x axis, until the diagonal from a corner stands upright
        true => {
            let (cos, sin) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
            (y * cos - z * sin, y * sin + z * cos)
        }
    };
    [low[0] + x, low[1] + y, low[2] + z]
}

/// Sides of a hexahedron by number: those that face along an axis are none where it is turned.
fn by_number(faces: &str) -> String {
    let named = [
        ("-x", "S6"),
        ("+x", "S4"),
        ("-y", "S3"),
        ("+y", "S5"),
        ("-z", "S1"),
        ("+z", "S2"),
    ];
    named.iter().fold(faces.to_owned(), |text, (axis, number)| {
        text.replace(&format!("\"{axis}\""), &format!("\"{number}\""))
    })
}

/// A cube of `n` elements along each side, which stands on an edge or a corner `gap` above a plate of `m` by `m`, pushed down.
fn on_edge(n: usize, m: usize, on_corner: bool, gap: f64, contact: &str) -> String {
    let mut scene = Scene::new(3);
    scene.block("plate", [m, m, 2], [-1.5, -1.5, -1.0], [1.5, 1.5, 0.0]);
    let low = [0.03, if on_corner { 0.02 } else { -0.48 }, gap];
    let sides = scene.bent("cube", [n; 3], |at| tilted(at, on_corner, low));
    let faces = |names: &[&str]| -> String {
        let of = |name: &str| {
            let side = sides.iter().find(|side| side.0 == format!("cube{name}"));
            by_number(&side.unwrap().1.join(", "))
        };
        names
            .iter()
            .map(|name| of(name))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let lower = faces(match on_corner {
        true => &["-x", "-y", "-z"],
        false => &["-x", "-z"],
    });
    let rest = format!(
        "{contact}\n[[step]]\nname = \"push\"\nincrements = 8\n\
         fix = [{{ on = \"plate-z\", u = \"all\" }}]\n\
         move = [{{ on = \"upper\", ux = 0.0, uy = 0.0, uz = {} }}]\n",
        -0.05 - gap
    );
    let upper = faces(&["+x", "+z"]);
    let text = scene.case(&rest);
    let sets =
        format!("[sets]\nlower = {{ faces = [{lower}] }}\nupper = {{ faces = [{upper}] }}\n");
    text.replacen("[sets]\n", &sets, 1)
}

/// By nodes of the cube on faces and edges of the plate.
const BY_POINTS: &str = "[[contact]]\nname = \"named\"\nsecondary = \"lower\"\nprimary = \"plate+z\"\n\
    method = \"node-to-segment\"\nfeatures = \"edges\"\n";

#[test]
fn corners_and_edges_are_felt_wherever_they_are_between_the_nodes_of_the_other_side() {
    for on_corner in [true, false] {
        for (n, m) in [(1, 9), (2, 8), (4, 5), (6, 3)] {
            // from afar, faces of smaller facets join one increment after the other: that is not the same
            let afar = (n <= 2).then_some([(0.7, 0.0), (0.7, 0.2)]);
            for (gap, friction) in [(0.01, 0.2)].into_iter().chain(afar.into_iter().flatten()) {
                let place = format!("corner {on_corner}, {n} on {m}, {gap}");
                let all = format!("[[contact]]\nall = true\nfriction = {friction}\n");
                let (found, model, _) = solve(&on_edge(n, m, on_corner, gap, &all), |_| {});
                let said = found.diagnostics.plain();
                assert!(
                    found.exit_code == 0 && !said.contains("warning"),
                    "{place}\n{said}"
                );
                assert!(model.contacts.iter().all(|one| one.is_found));
                let by_name = format!("{BY_POINTS}friction = {friction}\n");
                let (right, ..) = solve(&on_edge(n, m, on_corner, gap, &by_name), |_| {});
                let right = carried(&right, "named");
                assert!(right[2] > 1.0, "{place}: {right:?}");
                let mut got = carried(&found, "plate-cube");
                got[..3].iter_mut().for_each(|force| *force = -*force);
                close(got, right, 1e-7);
            }
        }
    }
}

/// Means over facets do not feel a corner between their nodes: the result says so.
#[test]
fn a_corner_that_means_do_not_feel_causes_a_warning() {
    let contact = "[[contact]]\nname = \"named\"\nsecondary = \"plate+z\"\nprimary = \"lower\"\nmethod = \"mortar\"\n";
    let (finished, ..) = solve(&on_edge(2, 4, true, 0.01, contact), |_| {});
    assert!(carried(&finished, "named")[3] == 0.0, "felt after all");
    let said = finished.diagnostics.plain();
    assert!(said.contains("warning[S0422]"), "{said}");
}

/// Two bars of square section that meet by an edge of each, at an angle, both nodes of the edges away from where they cross.
fn crossing(angle: f64, elements: usize, down: f64, contact: &str) -> String {
    let s = FRAC_1_SQRT_2;
    let (cos, sin) = (angle.cos(), angle.sin());
    let mut scene = Scene::new(3);
    let on_edge = |[u, v, w]: [f64; 3]| [3.0 * u - 1.5, (v - w) * s, (v + w) * s];
    let lower = scene.bent("lower", [elements, 2, 2], |at| {
        let [x, y, z] = on_edge(at);
        [x, y, z - 2.0 * s]
    });
    let upper = scene.bent("upper", [elements + 2, 2, 2], |at| {
        let [x, y, z] = on_edge(at);
        [0.02 + x * cos - y * sin, 0.03 + x * sin + y * cos, z + 0.01]
    });
    let faces = |sides: &[(String, Vec<String>)], names: [&str; 2]| {
        let of = |name: &str| {
            let side = sides.iter().find(|side| side.0.ends_with(name));
            by_number(&side.unwrap().1.join(", "))
        };
        names.map(of).join(", ")
    };
    let sets = [
        ("base", faces(&lower, ["-y", "-z"])),
        ("under", faces(&lower, ["+y", "+z"])),
        ("over", faces(&upper, ["-y", "-z"])),
        ("head", faces(&upper, ["+y", "+z"])),
    ];
    let rest = format!(
        "{contact}\n[[step]]\nname = \"push\"\nincrements = 10\n\
         fix = [{{ on = \"base\", u = \"all\" }}]\n\
         move = [{{ on = \"head\", ux = 0.0, uy = 0.0, uz = {} }}]\n",
        -0.01 - down
    );
    let named = sets.map(|(name, faces)| format!("{name} = {{ faces = [{faces}] }}\n"));
    let sets = format!("[sets]\n{}", named.concat());
    scene.case(&rest).replacen("[sets]\n", &sets, 1)
}

/// Nodes do not feel edges that cross between them: the result says so, whichever side is which.
#[test]
fn edges_that_cross_with_no_node_inside_cause_a_warning() {
    let by_name = |secondary: &str, primary: &str, method: &str| {
        format!(
            "[[contact]]\nname = \"named\"\nsecondary = \"{secondary}\"\nprimary = \"{primary}\"\nmethod = \"{method}\"\n"
        )
    };
    let contacts = [
        "[[contact]]\nall = true\n".to_owned(),
        by_name("over", "under", "node-to-segment"),
        by_name("under", "over", "node-to-segment"),
    ];
    let mut inside_said = 0;
    for angle in [TAU / 4.0, TAU / 6.0] {
        for elements in [3, 5] {
            for contact in &contacts {
                let place = format!("{angle}, {elements}, {contact}");
                let (apart, ..) = solve(&crossing(angle, elements, -0.005, contact), |_| {});
                let said = apart.diagnostics.plain();
                assert!(!said.contains("S0422"), "{place}\n{said}");
                let (inside, ..) = solve(&crossing(angle, elements, 0.15, contact), |_| {});
                let said = inside.diagnostics.plain();
                // where nodes are inside, they push aside, too
                let doubted = ["S0422", "S0423"].map(|code| said.contains(code));
                assert!(
                    inside.exit_code != 0 || doubted.contains(&true),
                    "{place}\n{said}"
                );
                inside_said += usize::from(doubted[0]);
            }
        }
    }
    assert!(inside_said >= 6, "{inside_said}");
}

/// A strip of square section that is wound in two turns and a half, which come closer from turn to turn, its end pushed down
/// by `down`. It is thinner than a facet is long, and the turns are closer than it is thick.
fn wound(down: f64, contact: &str) -> String {
    let (turns, width, radius) = (2.5, 0.5, 2.0);
    let mut scene = Scene::new(3);
    let sides = scene.bent("coil", [40, 1, 1], |[along, out, up]| {
        let turn = turns * along;
        let at = radius + width * (0.5 - out);
        let height = 0.55 * turn + 0.06 * turn * turn;
        let angle = TAU * turn;
        [
            at * angle.cos(),
            at * angle.sin(),
            height + width * (up - 0.5),
        ]
    });
    let rest = format!(
        "{contact}\n[[step]]\nname = \"push\"\nincrements = 8\n\
         fix = [{{ on = \"coil-x\", u = \"all\" }}, {{ on = \"coil+x\", u = [\"x\", \"y\"] }}]\n\
         move = [{{ on = \"coil+x\", uz = {} }}]\n",
        -down
    );
    let named = sides.iter().map(|(name, faces)| {
        let faces = by_number(&faces.join(", "));
        format!("\"{name}\" = {{ faces = [{faces}] }}\n")
    });
    let sets = format!("[sets]\n{}", named.collect::<String>());
    scene.case(&rest).replacen("[sets]\n", &sets, 1)
}

/// The upper face of a turn faces the lower one of the next, and that of its own at the depth of the strip.
#[test]
fn turns_that_are_wound_meet_each_other_and_not_themselves_through_the_strip() {
    let by_name = ["mortar", "node-to-segment", "gauss-point"].map(|method| {
        format!(
            "[[contact]]\nname = \"coil-coil\"\nsecondary = \"coil+z\"\nprimary = \"coil-z\"\nmethod = \"{method}\"\n"
        )
    });
    let all = "[[contact]]\nall = true\nself = true\n".to_owned();
    let mut pressures = Vec::new();
    for contact in by_name.iter().chain([&all]) {
        for (down, closes) in [(0.1, false), (0.35, true)] {
            let (finished, ..) = solve(&wound(down, contact), |_| {});
            let said = finished.diagnostics.plain();
            let is_right = finished.exit_code == 0 && !said.contains("warning");
            assert!(is_right, "{contact}{down}\n{said}");
            let [.., pressure] = carried(&finished, "coil-coil");
            assert_eq!(pressure > 0.0, closes, "{contact}{down}: {pressure}");
            pressures.extend(closes.then_some(pressure));
        }
    }
    let [least, largest] = [f64::min, f64::max]
        .map(|of: fn(f64, f64) -> f64| pressures.iter().copied().reduce(of).unwrap());
    assert!(largest < 1.05 * least, "{pressures:?}");
}
