//! The method that conserves energy and momenta.

use super::blocks::Blocks;
use super::{Table, common, energy, refusal, solved, stopped_after};
use std::collections::HashMap;
use std::fmt::Write;

/// How far the energy gets from that at the start, over it.
fn drift(of: &Table) -> f64 {
    let energies = energy(of);
    let first = energies[0];
    energies
        .iter()
        .fold(0.0, |most: f64, e| most.max((e / first - 1.0).abs()))
}

/// Blocks that hit each other off centre spin away with the energy and the momenta they came with: by points, in the plane and in space,
/// whichever has the secondary side. The usual method loses energy, and some angular momentum.
#[test]
fn blocks_keep_energy_and_momenta_in_an_impact() {
    for (ndim, method, first) in [
        (2, "node-to-segment", true),
        (2, "node-to-segment", false),
        (2, "gauss-point", true),
        (3, "node-to-segment", true),
        (3, "gauss-point", false),
    ] {
        let blocks = Blocks {
            ndim,
            method,
            first,
            ..Blocks::default()
        };
        let place = format!("{ndim} {method} {first}");
        let (got, [[_, turning], [momentum, after]]) = blocks.run();
        assert!(got["c.force_x"].iter().any(|f| f.abs() > 10.0), "{place}");
        // they bounce, and are apart at the end
        assert_eq!(*got["c.force_x"].last().unwrap(), 0.0, "{place}");
        assert!(drift(&got) < 1e-10, "{place}: {:e}", drift(&got));
        assert!(momentum.norm() < 2e-12, "{place}: {momentum:?}");
        let lost = (after - turning).norm() / turning.norm();
        assert!(lost < 1e-11, "{place}: {lost:e}");
        let usual = Blocks {
            dynamics: "rho_inf = 0.8",
            ..blocks
        };
        let (got, [[_, turning], [momentum, after]]) = usual.run();
        let energies = energy(&got);
        let last = energies[energies.len() - 1] / energies[0];
        assert!((0.8..0.95).contains(&last), "{place}: {last}");
        assert!(energies.iter().all(|e| *e < energies[0] * (1.0 + 1e-9)));
        assert!(momentum.norm() < 2e-12, "{place}");
        let lost = (after - turning).norm() / turning.norm();
        assert!((1e-7..1e-3).contains(&lost), "{place}: {lost:e}");
    }
}

/// A law that pushes at a distance has its energy there, too; and so has the body, of any law and in any idealisation of the plane.
#[test]
fn other_laws_keep_energy() {
    let curve = Blocks {
        enforcement: "{ exponential = { p0 = 1.0, c0 = 0.02 } }",
        ..Blocks::default()
    };
    let sheet = Blocks::default();
    let auto = Blocks {
        enforcement: "\"auto\"",
        ..Blocks::default()
    };
    for (text, place) in [
        (curve.text(), "exponential"),
        (
            sheet.text().replace("plane-strain", "plane-stress"),
            "plane stress",
        ),
        (auto.text(), "auto"),
    ] {
        let got = solved(&text);
        assert!(got["c.force_x"].iter().any(|f| f.abs() > 5.0), "{place}");
        assert!(drift(&got) < 1e-10, "{place}: {:e}", drift(&got));
    }
}

/// By mortar in the plane energy is kept, and angular momentum as far as weights balance moments.
#[test]
fn mortar_in_the_plane_keeps_energy() {
    for (first, dynamics) in [
        (true, "method = \"energy-momentum\""),
        (true, "rho_inf = 0.8"),
    ] {
        let blocks = Blocks {
            method: "mortar",
            first,
            dynamics,
            ..Blocks::default()
        };
        let text = blocks.text();
        // sides that face each other, without the corners behind
        let facing = text
            .replace(
                &set(&text, "sa"),
                "sa = { faces = [[3, \"+x\"], [4, \"+x\"]] }",
            )
            .replace(
                &set(&text, "sb"),
                "sb = { faces = [[5, \"-x\"], [6, \"-x\"], [7, \"-x\"]] }",
            );
        let got = solved(&facing);
        assert!(got["c.force_x"].iter().any(|f| f.abs() > 10.0));
        let energies = energy(&got);
        assert!(energies.iter().all(|e| *e < energies[0] * (1.0 + 1e-9)));
        assert_eq!(
            drift(&got) < 1e-10,
            dynamics.contains("momentum"),
            "{:e}",
            drift(&got)
        );
    }
}

/// The line of a set.
fn set(text: &str, name: &str) -> String {
    let mut lines = text.lines();
    let line = lines.find(|line| line.starts_with(&format!("{name} = ")));
    line.unwrap().to_owned()
}

/// Friction takes energy, and by the usual method never gives any. It is no secant: what sticks on facets that turn may give a little.
#[test]
fn friction_takes_energy() {
    for (dynamics, given) in [
        ("method = \"energy-momentum\"", 1e-3),
        ("rho_inf = 0.8", 1e-9),
    ] {
        let blocks = Blocks {
            friction: 0.3,
            dynamics,
            ..Blocks::default()
        };
        let (got, [_, [momentum, _]]) = blocks.run();
        let energies = energy(&got);
        assert!(energies.iter().all(|e| *e < energies[0] * (1.0 + given)));
        let spent = got["energy.friction"].last().unwrap();
        assert!(*spent > 0.003 * energies[0], "{spent}");
        assert!(momentum.norm() < 2e-12);
    }
}

/// Runs that stop while the bodies touch go on with the same bits: rows keep their gaps.
#[test]
fn an_impact_goes_on_with_the_same_bits() {
    let blocks = Blocks {
        increments: 30,
        // damping that takes energy, too
        enforcement: "{ penalty = 800.0, per = \"area\" }\ndamping = { normal = 1.0 }",
        more: "[checkpoint]\nevery = { increments = 1 }",
        friction: 0.2,
        ..Blocks::default()
    };
    let text = blocks.text();
    let got = solved(&text);
    assert!(*got["energy.damping"].last().unwrap() > 0.01);
    assert!(got["c.force_x"][6..12].iter().all(|f| *f != 0.0));
    let whole = stopped_after(&text, &[]);
    for stops in [&[45][..], &[60, 20]] {
        assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
    }
}

/// Two discs of tri3, node by node as in `reference/dynamics/discs_collision.json`: by both methods its positions, and by this one its
/// energy and momenta.
#[test]
fn discs_collide_as_the_reference_says() {
    let Some(reference) = common::reference("dynamics/discs_collision.json") else {
        return;
    };
    let list = |name: &str| -> Vec<Vec<f64>> {
        let rows = reference[name].as_array().unwrap();
        rows.iter().map(common::numbers).collect()
    };
    let (points, triangles, segments) = (list("nodes"), list("triangles"), list("segments"));
    let secondary = common::numbers(&reference["secondary"]);
    let mut nodes = String::new();
    for (k, x) in points.iter().enumerate() {
        write!(nodes, "[{}, {:?}, {:?}], ", k + 1, x[0], x[1]).unwrap();
    }
    let (mut elements, mut faces) = (String::new(), HashMap::new());
    for (k, corners) in triangles.iter().enumerate() {
        let mut of: Vec<usize> = corners.iter().map(|n| *n as usize).collect();
        let [a, b, c] = [0, 1, 2].map(|k| &points[of[k]]);
        if (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]) {
            of.swap(1, 2);
        }
        let group = if of[0] < points.len() / 2 { "a" } else { "b" };
        write!(
            elements,
            "{{ id = {}, type = \"tri3\", group = \"{group}\", nodes = [{}, {}, {}] }}, ",
            k + 1,
            of[0] + 1,
            of[1] + 1,
            of[2] + 1
        )
        .unwrap();
        for side in 0..3 {
            let ends = [of[side], of[(side + 1) % 3]];
            faces.insert(
                [ends[0].min(ends[1]), ends[0].max(ends[1])],
                (k + 1, side + 1),
            );
        }
    }
    let face = |one: f64, other: f64| {
        let (one, other) = (one as usize, other as usize);
        let (element, side) = faces[&[one.min(other), one.max(other)]];
        format!("[{element}, \"S{side}\"], ")
    };
    let around = secondary.iter().zip(secondary.iter().cycle().skip(1));
    let secondary: String = around.map(|(a, b)| face(*a, *b)).collect();
    let primary: String = segments.iter().map(|s| face(s[0], s[1])).collect();
    for (scheme, dynamics) in [
        ("em", "method = \"energy-momentum\""),
        ("gax", "rho_inf = 0.8"),
    ] {
        let wanted = &reference["results"][scheme];
        let probes = common::numbers(&wanted["nodes"]);
        let histories: String = probes
            .iter()
            .map(|n| format!("[[output.history]]\nname = \"n{n}\"\nnode = {}\nquantity = [\"displacement.x\", \"displacement.y\"]\n", n + 1.0))
            .collect();
        let got = solved(&format!(
            "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
             [material.m]\nmodel = \"neo-hookean\"\nE = 100.0\nnu = 0.3\ndensity = 1.0\n\
             [[body]]\ngroup = \"a\"\nmaterial = \"m\"\n[[body]]\ngroup = \"b\"\nmaterial = \"m\"\n\
             [sets]\nsa = {{ faces = [{secondary}] }}\nsb = {{ faces = [{primary}] }}\n\
             [[contact]]\nname = \"c\"\nsecondary = \"sa\"\nprimary = \"sb\"\nmethod = \"node-to-segment\"\n\
             enforcement = {{ penalty = 800.0, per = \"area\" }}\n\
             [initial]\nvelocity = [{{ on = \"a\", v = [2, 0] }}, {{ on = \"b\", v = [-2, 0] }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-10 }}\n{histories}\
             [[step]]\nname = \"go\"\nkind = \"dynamic\"\ngeometry = \"nonlinear\"\n\
             increments = {{ fixed = 100 }}\ndynamics = {{ {dynamics} }}\n",
        ));
        let positions = wanted["positions"].as_array().unwrap();
        for (probe, position) in probes.iter().zip(positions) {
            let start = &points[*probe as usize];
            for (axis, wanted) in common::numbers(position).into_iter().enumerate() {
                let name = format!("n{probe}.displacement.{}", ["x", "y"][axis]);
                let got = start[axis] + got[&name][99];
                assert!(
                    (got - wanted).abs() < 1e-7,
                    "{scheme} {name}: {got} {wanted}"
                );
            }
        }
        let start = wanted["table_t_kinetic_strain_contact"][0][1]
            .as_f64()
            .unwrap();
        let energies = energy(&got);
        if scheme == "em" {
            let off = energies.iter().map(|e| (e / start - 1.0).abs());
            let most = off.fold(0.0, f64::max);
            assert!(most < 1e-10, "{most:e}");
        } else {
            let last = energies[99] / start;
            assert!((0.97..0.99).contains(&last), "{last}");
        }
    }
}

/// Contact that damps takes energy in closing and opening, and no momentum; what multipliers and ties hold has nothing to damp.
#[test]
fn contact_that_damps_takes_energy() {
    for (dynamics, exact) in [
        ("method = \"energy-momentum\"", true),
        ("rho_inf = 0.8", false),
    ] {
        let blocks = Blocks {
            enforcement: "{ penalty = 800.0, per = \"area\" }\ndamping = { normal = 2.0 }",
            dynamics,
            ..Blocks::default()
        };
        let (got, [_, [momentum, _]]) = blocks.run();
        let spent = &got["energy.damping"];
        assert!(spent.windows(2).all(|two| two[1] >= two[0]));
        assert!(*spent.last().unwrap() > 0.1);
        let algorithmic = got["energy.algorithmic"].last().unwrap().abs();
        assert_eq!(algorithmic < 1e-9, exact, "{algorithmic:e}");
        assert!(momentum.norm() < 2e-12);
    }
    for enforcement in ["{ lagrange = {} }", "{ augmented = \"uzawa\" }"] {
        let held = format!("{enforcement}\ndamping = {{ normal = 2.0 }}");
        let text = Blocks::default().text();
        let refused = refusal(&text.replace("{ penalty = 800.0, per = \"area\" }", &held));
        assert!(refused.contains("`damping` goes with"), "{refused}");
    }
}

#[test]
fn what_has_no_form_that_conserves_energy_is_refused() {
    let blocks = Blocks::default();
    assert_eq!(refusal(&blocks.text()), "");
    let locking = blocks.text().replace(
        "mass_matrix = \"lumped\"\n[sets]",
        "mass_matrix = \"lumped\"\nlocking = \"f-bar\"\n[sets]",
    );
    let refused = refusal(&locking);
    assert!(
        refused.contains("no form of the quad4 of \"b\" with locking"),
        "{refused}"
    );
    let usual = locking.replace("method = \"energy-momentum\"", "rho_inf = 0.8");
    assert_eq!(refusal(&usual), "");
    for number in ["rho_inf = 1.0", "alpha = -0.05"] {
        let both = format!("method = \"energy-momentum\", {number}");
        let text = blocks.text().replace("method = \"energy-momentum\"", &both);
        let refused = refusal(&text);
        assert!(refused.contains("means nothing with  method"), "{refused}");
    }
}
