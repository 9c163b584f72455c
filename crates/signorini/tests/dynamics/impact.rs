//! Two bodies that meet in flight: momentum stays, and energy does not grow.

use super::common::{model, run};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::load::{Region, mass};
use signorini_mechanics::system::{Frame, Idealisation};
use std::fmt::Write;

/// Two blocks, which fly towards each other, the upper one aside.
pub fn blocks(ndim: usize, nonlinear: bool, contact: &str) -> String {
    let z = |v: &str| {
        if ndim == 3 {
            format!(", {v}")
        } else {
            String::new()
        }
    };
    let lower = format!("{{ on = \"lower\", v = [0, 0.5{}] }}", z("0"));
    let upper = format!("{{ on = \"upper\", v = [0.3, -1.0{}] }}", z("0.2"));
    let initial = format!("[initial]\nvelocity = [{lower}, {upper}]\n[[step]]");
    apart(ndim, nonlinear, contact, 0.02).replacen("[[step]]", &initial, 1)
        + "duration = 0.6\nincrements = { fixed = 60 }\n"
}

/// Two blocks with a gap between them, in a step without a duration.
pub fn apart(ndim: usize, nonlinear: bool, contact: &str, gap: f64) -> String {
    let (mut nodes, mut elements) = (String::new(), String::new());
    let (mut nnode, mut nelement) = (0, 0);
    let mut faces = Vec::new();
    for (name, n, low, size) in [
        ("lower", [4, 3, 2], [0.0, 0.0, 0.0], [2.0, 1.0, 1.0]),
        ("upper", [3, 4, 3], [0.35, 1.0 + gap, 0.1], [1.2, 1.0, 0.7]),
    ] {
        let layers = if ndim == 3 { n[2] } else { 0 };
        let node = |i, j, k| nnode + 1 + i + (n[0] + 1) * (j + (n[1] + 1) * k);
        let mut side = Vec::new();
        for k in 0..=layers {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    let at = |c: usize, i: usize| low[c] + size[c] * i as f64 / n[c] as f64;
                    let [x, y, z] = [at(0, i), at(1, j), at(2, k)];
                    write!(nodes, "[{}, {x:?}, {y:?}", node(i, j, k)).unwrap();
                    nodes += &if ndim == 3 {
                        format!(", {z:?}], ")
                    } else {
                        "], ".into()
                    };
                }
            }
        }
        for k in 0..layers.max(1) {
            for j in 0..n[1] {
                for i in 0..n[0] {
                    nelement += 1;
                    let around = |k| {
                        [
                            node(i, j, k),
                            node(i + 1, j, k),
                            node(i + 1, j + 1, k),
                            node(i, j + 1, k),
                        ]
                    };
                    let (kind, of) = match ndim {
                        3 => ("hex8", [around(k), around(k + 1)].concat()),
                        _ => ("quad4", around(0).to_vec()),
                    };
                    write!(
                        elements,
                        "{{ id = {nelement}, type = \"{kind}\", group = \"{name}\", nodes = {of:?} }}, "
                    )
                    .unwrap();
                    if name == "lower" && j + 1 == n[1] {
                        side.push(format!("[{nelement}, \"+y\"]"));
                    } else if name == "upper" && j == 0 {
                        side.push(format!("[{nelement}, \"-y\"]"));
                    }
                }
            }
        }
        faces.push(side.join(", "));
        nnode += (n[0] + 1) * (n[1] + 1) * (layers + 1);
    }
    let space = if ndim == 3 { "3d" } else { "plane-strain" };
    let geometry = if nonlinear { "nonlinear" } else { "linear" };
    format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"{space}\"\n\
         [material.soft]\nmodel = \"neo-hookean\"\nE = 100.0\nnu = 0.3\ndensity = 1.0\n\
         [[body]]\ngroup = [\"lower\", \"upper\"]\nmaterial = \"soft\"\n\
         [sets]\ntop = {{ faces = [{}] }}\nfoot = {{ faces = [{}] }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"top\"\n{contact}\n\
         [solver]\nnewton = {{ force_tol = 1e-11 }}\n\
         [[step]]\nname = \"fly\"\nkind = \"dynamic\"\ngeometry = \"{geometry}\"\n",
        faces[0], faces[1],
    )
}

/// Momentum of a frame, and the size of the momentum of its parts.
fn momentum(masses: &[(Vec<NodeId>, Vec<f64>)], frame: &Frame) -> (Vec3, f64) {
    let (mut sum, mut size) = (Vec3::ZERO, 0.0);
    for (nodes, matrix) in masses {
        for row in matrix.chunks_exact(nodes.len()) {
            for (m, &node) in row.iter().zip(nodes) {
                let part = frame.velocity[node as usize] * *m;
                sum += part;
                size += part.norm();
            }
        }
    }
    (sum, size)
}

#[test]
fn bodies_that_meet_keep_their_momentum_and_gain_no_energy() {
    let penalty = "enforcement = { penalty = 2e3, per = \"area\" }";
    let lagrange = "enforcement = { lagrange = {} }";
    for ndim in [2, 3] {
        for nonlinear in [true, false] {
            for (method, law) in [
                ("mortar", lagrange),
                ("mortar", penalty),
                ("node-to-segment", lagrange),
                ("node-to-segment", penalty),
                ("gauss-point", penalty),
            ] {
                for friction in ["", "friction = 0.3"] {
                    let contact = format!("method = \"{method}\"\n{law}\n{friction}");
                    let place = format!("{ndim} {nonlinear} {contact}");
                    meet(&blocks(ndim, nonlinear, &contact), ndim, -2e-3, &place);
                }
            }
        }
    }
}

/// Two blocks meet; their energy changes by no less than `least` of that at the start, and comes back.
pub fn meet(text: &str, ndim: usize, least: f64, place: &str) -> f64 {
    let mut model = model("blocks", text, &[]);
    let mesh = model.mesh.clone();
    let space = match ndim {
        3 => Idealisation::Space,
        _ => Idealisation::PlaneStrain { thickness: 1.0 },
    };
    let mut region = Region::default();
    for cell in mesh.cells(ndim) {
        let element = mesh.element(cell).unwrap();
        let rule = element.rules().mass;
        region.push_by((element, rule), (space, None), mesh.cell(cell), 1.0);
    }
    let mut masses = Vec::new();
    mass::matrices(&region, &mesh.points, |nodes, matrix| {
        masses.push((nodes.to_vec(), matrix.to_vec()));
    });
    let done = run(&mut model);
    assert!(done.error.is_none(), "{place}: {:?}", done.error);
    let pressed = done.frames.iter().filter(|f| f.contacts[0].nclosed() > 0);
    assert!(pressed.count() > 5, "{place}: they hardly meet");
    let (first, size) = momentum(&masses, &done.frames[0]);
    let start = done.frames[0].energies.unwrap().kinetic_at_start;
    let mut lost = 0.0;
    for frame in &done.frames {
        let (now, _) = momentum(&masses, frame);
        assert!(
            (now - first).norm() < 1e-10 * size,
            "{place}: {now:?} {first:?}"
        );
        let energies = frame.energies.unwrap();
        assert!(energies.external.abs() < 1e-12 * start, "{place}");
        lost = energies.algorithmic() / start;
        assert!(lost > least, "{place}: energy grows by {}", -lost);
    }
    // nodes that meet lose what they had: with few elements, that is much
    assert!(lost < 0.2, "{place}: {lost}");
    lost
}

/// A block that slides on a floor with friction of 0.5, at a velocity of 1 under a gravity of 10.
pub fn sliding(contact: &str, step: &str) -> String {
    let n = 3;
    let (mut nodes, mut elements) = (String::new(), String::new());
    for k in 0..(n + 1) * (n + 1) {
        let at = |k: usize| k as f64 / n as f64;
        let (x, y) = (at(k % (n + 1)), at(k / (n + 1)));
        write!(nodes, "[{}, {x:?}, {y:?}], ", k + 1).unwrap();
    }
    for k in 0..n * n {
        let a = k / n * (n + 1) + k % n + 1;
        let around = [a, a + 1, a + n + 2, a + n + 1];
        write!(
            elements,
            "{{ id = {}, type = \"quad4\", group = \"b\", nodes = {around:?} }}, ",
            k + 1
        )
        .unwrap();
    }
    let faces: Vec<String> = (1..=n).map(|k| format!("[{k}, \"-y\"]")).collect();
    format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1e5\nnu = 0.3\ndensity = 1.0\n\
         [[body]]\ngroup = \"b\"\nmaterial = \"m\"\n[sets]\nfoot = {{ faces = [{}] }}\n\
         [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"floor\"\n{contact}\n\
         friction = 0.5\n[initial]\nvelocity = [{{ on = \"b\", v = [1.0, 0.0] }}]\n\
         [[step]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = 0.3\nincrements = {{ fixed = 300 }}\n\
         load = [{{ on = \"b\", gravity = [0, -10.0] }}]\n{step}\n",
        faces.join(", ")
    )
}

/// A block slides on a floor until friction has stopped it: after v²/(2 μ g), and its energy is spent in friction, but for what
/// nodes lose that bounce as gravity begins at once.
#[test]
fn a_block_that_friction_stops_goes_as_far_as_its_energy_says() {
    for (method, law) in [
        ("node-to-segment", "enforcement = { lagrange = {} }"),
        (
            "node-to-segment",
            "enforcement = { penalty = 1e6, per = \"area\" }",
        ),
        (
            "gauss-point",
            "enforcement = { penalty = 1e6, per = \"area\" }",
        ),
    ] {
        let text = sliding(&format!("method = \"{method}\"\n{law}"), "");
        let done = run(&mut model("slide", &text, &[]));
        assert!(done.error.is_none(), "{method} {law}: {:?}", done.error);
        let last = done.frames.last().unwrap();
        let way = last.displacement[0].x;
        assert!((way / 0.1 - 1.0).abs() < 0.02, "{method} {law}: {way}");
        // never a gain, but for what contact that is there from the start does to the first increments
        let all = done.frames.iter().map(|frame| frame.energies.unwrap());
        let gains = all.map(|energies| -energies.algorithmic());
        let most = gains.fold(0.0, f64::max);
        assert!(most < 5e-4, "{method} {law}: {most}");
        let energies = last.energies.unwrap();
        assert!(
            (energies.friction / 0.5 - 1.0).abs() < 0.05,
            "{method} {law}: {energies:?}"
        );
        assert!(
            energies.algorithmic().abs() < 0.03,
            "{method} {law}: {energies:?}"
        );
    }
}
