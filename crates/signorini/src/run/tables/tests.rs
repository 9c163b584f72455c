//! Runs whose tables are known in closed form.

use crate::load::Source;
use crate::run::{Listener, News, RunOptions, run};
use crate::setup::build;
use signorini_io::case::read_case;
use signorini_mechanics::solve::Flow;
use std::path::Path;

/// What a case prints.
fn dat(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
    let (mesh, _) = crate::setup::read_mesh_of(&case, Path::new(".")).unwrap();
    let mut model = build(case, mesh).unwrap();
    let mut options = RunOptions::new(Source::default());
    options.folder = folder.path().join("out");
    let mut listener = |_: &News<'_>| Flow::Continue;
    let listener: &mut dyn Listener = &mut listener;
    let finished = run(&mut model, &options, listener);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics);
    std::fs::read_to_string(options.folder.join("case.dat")).unwrap_or_default()
}

/// The numbers of the tables whose heading starts so.
fn tables(text: &str, heading: &str) -> Vec<Vec<Vec<f64>>> {
    let lines: Vec<&str> = text.lines().collect();
    let starts = lines
        .iter()
        .enumerate()
        .filter(|(_, l)| l.trim_start().starts_with(heading));
    let rows = |(at, _): (usize, &&str)| {
        let rows = lines[at + 2..].iter().take_while(|line| !line.is_empty());
        rows.map(|row| row.split_whitespace().map(|w| w.parse().unwrap()).collect())
            .collect()
    };
    starts.map(rows).collect()
}

fn table(text: &str, heading: &str) -> Vec<Vec<f64>> {
    tables(text, heading)
        .pop()
        .unwrap_or_else(|| panic!("no {heading} in {text}"))
}

fn assert_close(got: &[f64], wanted: &[f64], size: f64) {
    assert_eq!(got.len(), wanted.len(), "{got:?} {wanted:?}");
    for (a, b) in got.iter().zip(wanted) {
        assert!((a - b).abs() < 2e-6 * size, "{got:?} {wanted:?}");
    }
}

/// A unit cube free to contract, pulled by 10 along z in three increments; then held, then silent.
const PULLED: &str = r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
]
elements = [{ id = 7, type = "hex8", group = "brick", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
[sets]
base = { nodes = [4, 1, 2, 3] }
left = { nodes = [1, 4, 5, 8] }
front = { nodes = [1, 2, 5, 6] }
top = { faces = [[7, "+z"]] }
[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.3
expansion = { alpha = 1e-3, reference = 0.0 }
[[body]]
group = "brick"
material = "m"
[initial]
temperature = 0.0
[[step]]
name = "pull"
geometry = "linear"
increments = { fixed = 3 }
fix = [{ on = "base", u = ["z"] }, { on = "left", u = ["x"] }, { on = "front", u = ["y"] }]
load = [{ on = "top", traction = [0, 0, 10] }]
temperature = [{ on = "all", value = 2.0 }]
print = [
  { on = "base", nodes = ["displacement", "reaction", "temperature"], totals = "yes", every = 2 },
  { on = "top", nodes = ["reaction"], totals = "only", every = 2 },
  { on = "brick", elements = ["stress", "strain", "mechanical-strain", "plastic-strain", "energy-density", "energy", "volume"], totals = "yes", every = 2 },
]
[[step]]
name = "hold"
increments = 1
load = [{ name = "more", on = "top", traction = [0, 0, 10] }]
[[step]]
name = "silent"
increments = 1
print = []
load = [{ name = "more", on = "top", traction = [0, 0, 0] }]
"#;

#[test]
fn tensors_are_printed_along_the_axes_of_the_material_where_that_is_asked_for() {
    let plain = "[[body]]\ngroup = \"brick\"\nmaterial = \"m\"\n";
    let axes = "[orientation.C]\nkind = \"cylindrical\"\norigin = [-1, -1, 0]\naxis = \"y\"\n";
    assert!(PULLED.contains(plain));
    let text = PULLED.replace(plain, &format!("{axes}{plain}orientation = \"C\"\n"));
    let global = table(&dat(&text), "stresses");
    for row in &global {
        assert_close(&row[2..], &[0.0, 0.0, 20.0, 0.0, 0.0, 0.0], 20.0);
    }
    let local = dat(&text.replace("{ on = \"brick\",", "{ on = \"brick\", local = true,"));
    // a row that is along axes of its own ends with an L
    let rows: Vec<&str> = local.lines().filter(|line| line.ends_with(" L")).collect();
    assert_eq!(
        rows.len() % 24,
        0,
        "stress, strain and mechanical strain of eight points"
    );
    let last = local.rfind("stresses (").unwrap();
    let rows = local[last..].lines().filter(|line| line.ends_with(" L"));
    for (k, row) in rows.take(8).enumerate() {
        let words = row.split_whitespace().take(8);
        let numbers: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
        let at = |bit: usize| 0.5 + (((k >> bit) & 1) as f64 - 0.5) / 3.0_f64.sqrt();
        // radial from the line along y through (−1, −1, 0), and circumferential
        let (x, z) = (at(0) + 1.0, at(2));
        let (a, b) = (x / x.hypot(z), z / x.hypot(z));
        let wanted = [20.0 * b * b, 20.0 * a * a, 0.0, -20.0 * a * b, 0.0, 0.0];
        assert_close(&numbers[2..], &wanted, 20.0);
    }
}

#[test]
fn a_pulled_cube_prints_its_closed_form() {
    let text = dat(PULLED);
    let heads: Vec<&str> = text
        .lines()
        .filter(|l| l.contains("S T E P") || l.contains("INCREMENT"))
        .collect();
    let words: Vec<String> = heads
        .iter()
        .map(|l| l.split_whitespace().collect())
        .collect();
    let due = [
        "STEP1",
        "INCREMENT2",
        "STEP1",
        "INCREMENT3",
        "STEP2",
        "INCREMENT1",
    ];
    assert_eq!(words, due);
    assert!(text.contains(" stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set BRICK and time  0.6666667E+00\n"));
    assert!(text.contains(" displacements (vx,vy,vz) for set BASE and time  0.2000000E+01\n"));

    // at the end of the first step
    let at = |heading| tables(&text, heading)[1].clone();
    let (stress, strain) = (10.0, 0.01);
    let reactions = at("forces (");
    let labels: Vec<f64> = reactions.iter().map(|row| row[0]).collect();
    assert_eq!(labels, [4.0, 1.0, 2.0, 3.0], "as the set lists them");
    for row in &reactions {
        assert_close(&row[1..], &[0.0, 0.0, -stress / 4.0], stress);
    }
    // of both sets: the loads are in it
    let totals = tables(&text, "total force (");
    assert_close(&totals[2][0], &[0.0, 0.0, -stress], stress);
    assert_close(&totals[3][0], &[0.0, 0.0, stress], stress);
    assert_close(&at("temperatures")[0], &[4.0, 2.0], 1.0);
    for (k, row) in at("stresses").iter().enumerate() {
        assert_close(
            row,
            &[7.0, k as f64 + 1.0, 0.0, 0.0, stress, 0.0, 0.0, 0.0],
            stress,
        );
    }
    let mechanical = [-0.3 * strain, -0.3 * strain, strain, 0.0, 0.0, 0.0];
    for (heading, grown) in [("strains", 2e-3), ("mechanical strains", 0.0)] {
        let wanted = [0, 1, 2, 3, 4, 5].map(|i| mechanical[i] + if i < 3 { grown } else { 0.0 });
        for row in at(heading) {
            assert_close(&row[2..], &wanted, strain);
        }
    }
    assert!(
        at("equivalent plastic strain")
            .iter()
            .all(|row| row[2] == 0.0)
    );
    let energy = 0.5 * stress * strain;
    assert_close(&at("internal energy density")[7], &[7.0, 8.0, energy], 1.0);
    assert_close(&at("internal energy (")[0], &[7.0, energy], 1.0);
    assert_close(&at("total internal energy")[0], &[energy], energy);
    assert_close(&at("volume")[0], &[7.0, 1.0], 1.0);
    assert_close(&at("total volume")[0], &[1.0], 1.0);
}

#[test]
fn where_no_step_prints_there_is_no_file() {
    let silent: String = PULLED.split("print = [\n").next().unwrap().to_owned();
    assert_eq!(dat(&silent), "");
}

/// A ring between the radii 1 and 2, of height 1, kept flat and pressed inside: Lamé's thick tube.
#[test]
fn a_ring_prints_calculix_s_wedge_of_two_degrees() {
    let text = dat(r#"
[mesh]
nodes = [
  [1, 1, 0], [2, 2, 0], [3, 2, 1], [4, 1, 1],
  [5, 1.5, 0], [6, 2, 0.5], [7, 1.5, 1], [8, 1, 0.5],
]
elements = [{ id = 1, type = "quad8", group = "ring", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
[model]
space = "axisymmetric"
[sets]
bottom = { nodes = [1, 5, 2] }
top = { nodes = [4, 7, 3] }
[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.3
[[body]]
group = "ring"
material = "m"
integration = "reduced"
[[step]]
name = "lift"
geometry = "linear"
increments = 1
fix = [{ on = "bottom", u = ["y"] }]
move = [{ on = "top", uy = 0.01 }]
print = [
  { on = "top", nodes = ["reaction"], totals = "only" },
  { on = "ring", elements = ["stress", "energy", "volume"] },
]
"#);
    // uniaxial stress 10 over the cross-section 3π, of which a hundred and eightieth is printed
    let share = 3.0 * std::f64::consts::PI / 180.0;
    assert_close(
        &table(&text, "total force")[0],
        &[0.0, 10.0 * share, 0.0],
        1.0,
    );
    assert_close(&table(&text, "volume")[0], &[1.0, share], 1.0);
    assert_close(
        &table(&text, "internal energy")[0],
        &[1.0, 0.05 * share],
        0.01,
    );
    let stresses = table(&text, "stresses");
    assert_eq!(stresses.len(), 8);
    for (k, row) in stresses.iter().enumerate() {
        assert_close(
            row,
            &[1.0, k as f64 + 1.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0],
            10.0,
        );
    }
}

/// A ring swollen by a hundredth, at small and at large strain: `σ_rr = σ_θθ = s` everywhere.
#[test]
fn forces_along_x_of_a_ring_are_those_of_radial_stresses_alone() {
    let (mu, lambda) = (1000.0 / 2.6, 300.0 / (1.3 * 0.4));
    let e = 0.01;
    for (geometry, nominal) in [
        ("linear", 2.0 * (lambda + mu) * e),
        // first Piola-Kirchhoff, of the strain e + ½ e²
        (
            "nonlinear",
            2.0 * (lambda + mu) * (e + 0.5 * e * e) * (1.0 + e),
        ),
    ] {
        let text = dat(&format!(
            r#"
[mesh]
nodes = [
  [1, 1, 0], [2, 2, 0], [3, 2, 1], [4, 1, 1],
  [5, 1.5, 0], [6, 2, 0.5], [7, 1.5, 1], [8, 1, 0.5],
]
elements = [{{ id = 1, type = "quad8", group = "ring", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }}]
[model]
space = "axisymmetric"
[sets]
every = {{ nodes = [1, 2, 3, 4, 5, 6, 7, 8] }}
inner = {{ nodes = [1, 8, 4] }}
middle = {{ nodes = [5, 7] }}
outer = {{ nodes = [2, 6, 3] }}
[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.3
[[body]]
group = "ring"
material = "m"
[[step]]
name = "swell"
geometry = "{geometry}"
increments = 1
fix = [{{ on = "every", u = ["y"] }}]
move = [{{ on = "inner", ux = {e} }}, {{ on = "middle", ux = {} }}, {{ on = "outer", ux = {} }}]
print = [
  {{ on = "inner", nodes = ["reaction"], totals = "only" }},
  {{ on = "middle", nodes = ["reaction"], totals = "only" }},
  {{ on = "outer", nodes = ["reaction"], totals = "only" }},
]
"#,
            1.5 * e,
            2.0 * e
        ));
        // ∫ r N' dr of the three quadratic functions
        let shares = [-7.0 / 6.0, -2.0 / 3.0, 11.0 / 6.0];
        let size = nominal * 2.0 * std::f64::consts::PI / 180.0;
        for (total, share) in tables(&text, "total force").iter().zip(shares) {
            assert_close(&total[0][..1], &[share * size], size);
        }
    }
}

#[test]
fn a_node_that_is_a_reference_prints_its_motion() {
    let head = PULLED.split("[[step]]").next().unwrap();
    let text = dat(&format!(
        r#"{}
[[constraint]]
kind = "kinematic"
on = "top"
reference = "pilot"
dofs = ["x", "y", "z"]
[[step]]
name = "press"
increments = 1
fix = [{{ on = "base", u = "all" }}]
move = [{{ on = "pilot", ux = 0, uy = 0, uz = -0.01, rx = 0, ry = 0, rz = 0 }}]
print = [{{ on = "pilots", nodes = ["displacement", "reaction"] }}]
"#,
        head.replace("[5, 0, 0, 1]", "[20, 0.5, 0.5, 2], [21, 0, 0, 0], [5, 0, 0, 1]")
            .replace(
                "[sets]",
                "[reference]\npilot = { node = 20, rotations = 21 }\n[sets]\npilots = { nodes = [20, 5, 21, 7] }"
            )
    ));
    let rows = table(&text, "displacements");
    assert_close(&rows[0], &[20.0, 0.0, 0.0, -0.01], 0.01);
    assert_close(&rows[1], &[5.0, 0.0, 0.0, -0.01], 0.01);
    assert_close(&rows[2], &[21.0, 0.0, 0.0, 0.0], 0.01);
    // the reference bears what its four nodes do, and no moment by symmetry
    let forces = table(&text, "forces");
    let [pilot, corner, moment, _] = forces.as_slice() else {
        panic!("{forces:?}");
    };
    assert!(corner[3] < -1e-3, "{corner:?}");
    assert_close(&pilot[3..], &[4.0 * corner[3]], corner[3].abs());
    assert_close(&moment[1..], &[0.0; 3], corner[3].abs());
}

/// A cube pressed by 8 on a rigid plane, penalty 1000 per area.
#[test]
fn a_pressed_cube_prints_its_contact() {
    let text = dat(r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
]
elements = [{ id = 7, type = "hex8", group = "brick", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
[sets]
base = { faces = [[7, "-z"]] }
top = { faces = [[7, "+z"]] }
all_nodes = { nodes = [1, 2, 3, 4, 5, 6, 7, 8] }
[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.0
[[body]]
group = "brick"
material = "m"
[[surface]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
[[contact]]
name = "rest"
secondary = "base"
primary = "floor"
method = "node-to-segment"
enforcement = { penalty = 1000.0, per = "area" }
[[step]]
name = "press"
increments = 1
geometry = "linear"
fix = [{ on = "all_nodes", u = ["x", "y"] }]
load = [{ on = "top", traction = [0, 0, -8] }]
print = [
  { contact = ["gap", "traction", "energy", "count", "force"], totals = "yes" },
  { on = "rest", contact = ["shear-force"] },
  { on = "base", nodes = ["reaction"] },
]
"#);
    let gaps = table(&text, "relative contact displacement");
    assert_eq!(gaps.len(), 4);
    for row in gaps {
        assert_close(&row[1..], &[-8e-3, 0.0, 0.0], 8e-3);
    }
    for row in table(&text, "contact stress") {
        assert_close(&row[1..], &[8.0, 0.0, 0.0], 8.0);
    }
    let energy = 0.5 * 8.0 * 8e-3;
    for row in table(&text, "contact print energy") {
        assert_close(&row[1..], &[energy / 4.0], energy);
    }
    assert_close(
        &table(&text, "total contact spring energy")[0],
        &[energy],
        energy,
    );
    assert_eq!(table(&text, "total number of contact elements"), [[4.0]]);
    let head = " statistics for slave set BASE, master set FLOOR and time  0.1000000E+01\n";
    assert_eq!(text.matches(head).count(), 2);
    let forces = tables(&text, "total surface force");
    assert_close(&forces[0][0], &[0.0, 0.0, 8.0, 4.0, -4.0, 0.0], 8.0);
    assert_close(&forces[1][0], &[0.0; 6], 8.0);
    let centre = table(&text, "center of gravity");
    assert_close(&centre[0], &[0.5, 0.5, -8e-3, 0.0, 0.0, -1.0], 1.0);
    let sums = tables(&text, "area,  normal force");
    assert_close(&sums[0][0], &[1.0, -8.0, 0.0], 8.0);
    // the forces of the body and of contact balance
    for row in table(&text, "forces") {
        assert_close(&row[1..], &[0.0; 3], 8.0);
    }
}

#[test]
fn what_cannot_be_printed_is_refused_with_its_place() {
    for (from, to, said) in [
        (
            "{ on = \"base\", nodes",
            "{ on = \"bse\", nodes",
            "no set or group called \"bse\"",
        ),
        (
            "{ on = \"brick\", elements",
            "{ on = \"base\", elements",
            "\"base\" has no elements",
        ),
        (
            "{ on = \"top\", nodes = [\"reaction\"]",
            "{ on = \"tap\", contact = [\"gap\"]",
            "no contact called \"tap\"",
        ),
    ] {
        let text = PULLED.replacen(from, to, 1);
        let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
        let (mesh, _) = crate::setup::read_mesh_of(&case, Path::new(".")).unwrap();
        let found = build(case, mesh).err().unwrap();
        assert!(found.plain().contains(said), "{}", found.plain());
        assert!(found.plain().contains("case.toml:"), "{}", found.plain());
    }
}

/// A quarter of a square prism is pulled evenly on its outside: it widens as a whole, its axis stays.
#[test]
fn a_sector_moves_as_the_whole_does() {
    let text = dat(r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
]
elements = [{ id = 7, type = "hex8", group = "brick", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
[sets]
lead = { plane = "y", at = 0 }
follow = { plane = "x", at = 0 }
base = { plane = "z", at = 0 }
one = { nodes = [2] }
rim = { nodes = [1, 3, 4, 7] }
outside = { faces = [[7, "+x"], [7, "+y"]] }
[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.25
[[body]]
group = "brick"
material = "m"
[[constraint]]
kind = "cyclic"
on = "follow"
with = "lead"
sectors = 4
[[step]]
name = "pull"
geometry = "linear"
increments = 1
fix = [{ on = "base", u = ["z"] }, { on = "one", u = ["y"] }]
load = [{ on = "outside", pressure = -8.0 }]
print = [{ on = "rim", nodes = ["displacement"] }]
"#);
    // σ = 8 in the plane
    let (wide, high) = (8.0 * 0.75 / 1000.0, -2.0 * 0.25 * 8.0 / 1000.0);
    let rows = table(&text, "displacements");
    assert_close(&rows[0], &[1.0, 0.0, 0.0, 0.0], wide);
    assert_close(&rows[1], &[3.0, wide, wide, 0.0], wide);
    assert_close(&rows[2], &[4.0, 0.0, wide, 0.0], wide);
    assert_close(&rows[3], &[7.0, wide, wide, high], wide);
}
