//! Damping over stiffness: closed forms, the balance of energy, bodies that turn.

use super::{Table, dampings, energy, oscillator, refusal, solved};
use std::f64::consts::TAU;

/// `u` of a mass on a spring that was let go at 1 with the frequency 1, and this part of the critical damping.
fn exact(t: f64, xi: f64) -> f64 {
    let root = (1.0 - xi * xi).sqrt();
    (-xi * TAU * t).exp() * ((root * TAU * t).cos() + xi / root * (root * TAU * t).sin())
}

/// One element of a kind between a base at x = 0 and nodes at x = 1 that move alike along x, by `size` at the start.
fn element(kind: &str, body: &str, space: &str, geometry: &str, size: f64) -> String {
    let flat = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let of = |nodes: &[[i32; 3]], pick: &[usize]| -> (String, String, String) {
        let at = pick.iter().map(|k| nodes[*k]);
        let written = at
            .enumerate()
            .map(|(k, [x, y, z])| format!("[{}, {x}, {y}, {z}]", k + 1));
        let ends = |end: i32| {
            let here = pick
                .iter()
                .enumerate()
                .filter(|(_, k)| nodes[**k][0] == end);
            here.map(|(k, _)| (k + 1).to_string())
                .collect::<Vec<_>>()
                .join(", ")
        };
        (written.collect::<Vec<_>>().join(", "), ends(0), ends(1))
    };
    let solid: Vec<[i32; 3]> = flat
        .into_iter()
        .chain(flat.map(|[x, y, _]| [x, y, 1]))
        .collect();
    let pick: &[usize] = match kind {
        "quad4" => &[0, 1, 2, 3],
        "hex8" => &[0, 1, 2, 3, 4, 5, 6, 7],
        _ => &[0, 1],
    };
    let (nodes, base, tip) = of(&solid, pick);
    let numbers: Vec<String> = (1..=pick.len()).map(|k| k.to_string()).collect();
    let axes = if space == "3d" {
        "\"y\", \"z\""
    } else {
        "\"y\""
    };
    format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{{ id = 1, type = \"{kind}\", group = \"e\", nodes = [{}] }}]\n\
         [model]\nspace = \"{space}\"\n\
         [material.m]\nmodel = \"MODEL\"\nE = {:?}\nnu = 0.0\ndensity = 2.0\ndamping = {{ DAMPING }}\n\
         [[body]]\ngroup = \"e\"\nmaterial = \"m\"\nmass_matrix = \"lumped\"\n{body}\n\
         [sets]\nbase = {{ nodes = [{base}] }}\ntip = {{ nodes = [{tip}] }}\n\
         [[output.history]]\nname = \"tip\"\nset = \"tip\"\nquantity = [\"displacement.x\"]\n\
         [[step]]\nname = \"pull\"\ngeometry = \"{geometry}\"\nincrements = 1\n\
         fix = [{{ on = \"base\", u = \"all\" }}, {{ on = \"tip\", u = [{axes}] }}]\nmove = [{{ on = \"tip\", ux = {size:?} }}]\n\
         [[step]]\nname = \"let go\"\nkind = \"dynamic\"\nduration = 1.0\nincrements = {{ fixed = COUNT }}\n\
         dynamics = {{ DYNAMICS }}\nfree = [{{ on = \"tip\", u = [\"x\"] }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-11 }}\n",
        numbers.join(", "),
        TAU * TAU,
    )
}

fn with(text: &str, model: &str, damping: [f64; 2], dynamics: &str, count: usize) -> String {
    let [mass, stiffness] = damping;
    text.replace("MODEL", model)
        .replace(
            "DAMPING",
            &format!("mass = {mass:?}, stiffness = {stiffness:?}"),
        )
        .replace("DYNAMICS", dynamics)
        .replace("COUNT", &count.to_string())
}

/// Whatever the element, the remedy, the space and the size of strains: `ξ = ½ (a/ω + b ω)`, to second order in the increment, and what
/// is lost is counted.
#[test]
fn elements_vibrate_as_a_damped_spring_does() {
    for (kind, body, space, geometry) in [
        ("quad4", "locking = \"none\"", "plane-strain", "linear"),
        ("quad4", "locking = \"b-bar\"", "plane-strain", "linear"),
        (
            "quad4",
            "locking = \"incompatible\"",
            "plane-stress",
            "linear",
        ),
        (
            "quad4",
            "locking = \"selective-shear\"",
            "plane-strain",
            "linear",
        ),
        ("quad4", "locking = \"none\"", "plane-stress", "nonlinear"),
        ("quad4", "locking = \"f-bar\"", "plane-strain", "nonlinear"),
        ("hex8", "locking = \"incompatible\"", "3d", "linear"),
        ("hex8", "locking = \"b-bar\"", "3d", "linear"),
        ("hex8", "locking = \"f-bar\"", "3d", "nonlinear"),
        ("line2", "area = 1.0", "3d", "linear"),
        ("line2", "area = 1.0", "plane-strain", "nonlinear"),
    ] {
        // large strains have another frequency
        let size = if geometry == "linear" { 1.0 } else { 1e-7 };
        let text = element(kind, body, space, geometry, size);
        for [mass, stiffness] in dampings() {
            let damping = [10.0 * mass, 10.0 * stiffness];
            let run = |count| {
                let got = solved(&with(&text, "neo-hookean", damping, "rho_inf = 0.8", count));
                let last = *got["tip.displacement.x"].last().unwrap() / size;
                (got, (last - exact(1.0, 0.2)).abs())
            };
            let ((got, coarse), (_, fine)) = (run(40), run(80));
            let place = format!("{kind} {body} {space} {geometry} {damping:?}");
            let slope = (coarse / fine).log2();
            assert!(fine < 2e-3 && slope > 1.9, "{place}: {coarse:e} {fine:e}");
            let spent = &got["energy.damping"];
            assert!(spent.windows(2).all(|w| w[1] >= w[0]), "{place}");
            // the method itself takes little
            let own = got["energy.algorithmic"].last().unwrap();
            let start = 0.5 * (TAU * size).powi(2);
            assert!(own.abs() < 2e-3 * start, "{place}: {own:e} {start:e}");
        }
    }
}

/// At large strains, with each remedy and with plastic flow: second order in the increment, and the balance of energy.
#[test]
fn large_strains_are_damped_to_second_order() {
    for (kind, body, space) in [
        ("quad4", "locking = \"none\"", "plane-strain"),
        ("quad4", "locking = \"f-bar\"", "axisymmetric"),
        ("hex8", "locking = \"f-bar\"", "3d"),
        ("line2", "area = 1.0", "plane-strain"),
    ] {
        let text = element(kind, body, space, "nonlinear", 0.4).replace("nu = 0.0", "nu = 0.3");
        let text = text.replace("u = \"all\"", "u = [\"x\"]");
        let text = match kind {
            "line2" => text.replace("u = [\"x\"]", "u = \"all\""),
            _ => text,
        };
        let at_end = |count| {
            let damping = [0.0, 0.03];
            let got = solved(&with(&text, "neo-hookean", damping, "rho_inf = 0.8", count));
            let last = *got["tip.displacement.x"].last().unwrap();
            (got, last)
        };
        let (got, exact) = at_end(640);
        let [coarse, fine] = [40, 80].map(|count| at_end(count).1 - exact);
        let slope = (coarse / fine).abs().log2();
        assert!(slope > 1.9, "{kind} {body} {space}: {slope}");
        // the static step before it counts work at its ends alone, which the first increment finds
        let since = |name: &str| got[name].last().unwrap() - got[name][1];
        let (spent, own) = (since("energy.damping"), since("energy.algorithmic"));
        assert!(spent > 0.0 && own.abs() < 0.02 * spent, "{own} {spent}");
    }
}

/// An element that is free and spins, without strain at the start.
fn spinning(kind: &str, law: &str, dynamics: &str, count: usize) -> String {
    let (space, omega) = match kind {
        "hex8" => ("3d", "omega = [0.0, 0.0, 3.0], about = [0.5, 0.5, 0.5]"),
        _ => ("plane-strain", "omega = 3.0, about = [0.5, 0.5]"),
    };
    let text = element(kind, "locking = \"none\"", space, "nonlinear", 0.0);
    let (head, _) = text.split_once("[[step]]").unwrap();
    let head = with(head, law, [0.0, 0.02], "", 0);
    format!(
        "{head}[initial]\nvelocity = [{{ on = \"e\", {omega} }}]\n\
         [[step]]\nname = \"fly\"\nkind = \"dynamic\"\ngeometry = \"nonlinear\"\nduration = 1.0\n\
         increments = {{ fixed = {count} }}\ndynamics = {{ {dynamics} }}\n[solver]\nnewton = {{ force_tol = 1e-12 }}\n"
    )
}

/// What spins and vibrates loses the energy of vibrations, and all of that is counted; no more, and nothing of momenta.
#[test]
fn spinning_bodies_lose_their_vibrations_alone() {
    let conserving = "method = \"energy-momentum\"";
    for kind in ["quad4", "hex8"] {
        for law in ["neo-hookean", "saint-venant-kirchhoff"] {
            let got = solved(&spinning(kind, law, conserving, 200));
            let energies = energy(&got);
            let spent = &got["energy.damping"];
            assert!(spent.windows(2).all(|w| w[1] >= w[0]));
            let last = spent.last().unwrap() - spent[0];
            let lost = energies[0] - energies.last().unwrap();
            assert!(last > 1e-3 * energies[0], "{kind} {law}: {last}");
            assert!(
                (last / lost - 1.0).abs() < 1e-7,
                "{kind} {law}: {last} {lost}"
            );
            let own = got["energy.algorithmic"].last().unwrap();
            assert!(own.abs() < 1e-8 * energies[0], "{kind} {law}: {own:e}");
        }
    }
}

/// Explicit steps take the forces of the increment before, and increments that are as short as these ask for.
#[test]
fn explicit_steps_are_damped_and_stay_stable() {
    let text = element("quad4", "locking = \"none\"", "plane-strain", "linear", 1.0);
    let explicit = "method = \"explicit\", safety = 0.01";
    let got = solved(&with(&text, "neo-hookean", [0.0, 0.4 / TAU], explicit, 40));
    for (t, u) in got["time"].iter().zip(&got["tip.displacement.x"]).skip(1) {
        let wanted = exact(t - 1.0, 0.2);
        assert!((u - wanted).abs() < 5e-3, "{t}: {u} {wanted}");
    }
    // far beyond critical damping: as stable as without, with shorter increments
    let counts = |stiffness: f64, geometry: &str| -> (f64, Table) {
        let text = element("hex8", "locking = \"none\"", "3d", geometry, 0.2);
        let usual = "method = \"explicit\"";
        let got = solved(&with(&text, "neo-hookean", [0.0, stiffness], usual, 4));
        (got["iterations"].iter().skip(1).sum(), got)
    };
    for geometry in ["linear", "nonlinear"] {
        let (few, _) = counts(0.0, geometry);
        let (many, got) = counts(2.0, geometry);
        assert!(many > 2.0 * few, "{few} {many}");
        let last = got["tip.displacement.x"].last().unwrap();
        assert!((0.0..0.2).contains(last), "{last}");
    }
}

/// Static steps know of no damping: all bits are the same.
#[test]
fn static_steps_are_not_damped() {
    let pulled = |stiffness: f64| {
        let text = oscillator("rho_inf = 0.8", [0.0, stiffness], 20, 0.05);
        let (text, _) = text.rsplit_once("[[step]]").unwrap();
        let got = solved(text);
        got["tip.displacement.x"].clone()
    };
    assert_eq!(pulled(0.0), pulled(0.1));
}

#[test]
fn rigid_bodies_are_not_damped() {
    let text = oscillator("rho_inf = 0.8", [0.0, 0.1], 20, 0.05);
    let text = text.replace(
        "material = \"m\"\nmass_matrix = \"lumped\"",
        "material = \"m\"\nrigid = true",
    );
    let said = refusal(&text);
    assert!(
        said.contains("damping of a rigid body is not built"),
        "{said}"
    );
}
