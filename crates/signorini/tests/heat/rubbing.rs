//! The heat of friction against closed forms: half-spaces, rings, and the instability that it drives.

use super::*;
use crate::common::reference;

const WAYS: [(&str, &str); 5] = [
    ("node-to-segment", "penalty = 1e7, per = \"area\""),
    ("node-to-segment", "lagrange = {}"),
    ("gauss-point", "penalty = 1e7"),
    ("mortar", "penalty = 1e7"),
    ("mortar", "lagrange = {}"),
];

/// Two columns of so many cells and this depth, one on the other, pressed by 10 and rubbed with a velocity of 2 for a time of 1.
fn rubbed(way: (&str, &str), k: [f64; 2], depth: f64, [n, increments]: [usize; 2]) -> [f64; 3] {
    let (method, enforcement) = way;
    let mut boxes = Boxes::new(2);
    boxes.add("upper", [0.0; 3], [1.0; 3], [1, n, 1]);
    boxes.add("lower", [0.0, -1.0, 0.0], [1.0, 0.0, 1.0], [1, n, 1]);
    // finer towards the contact
    for name in ["upper", "lower"] {
        boxes.bend(name, |[x, y, z]| [x, depth * y * y.abs(), z]);
    }
    // guided, but for the nodes that friction acts on
    for (name, side) in [("upper", "bottom"), ("lower", "top")] {
        let side = boxes.nodes(&format!("{name}_{side}")).to_vec();
        let all = boxes.nodes(&format!("{name}_all")).iter();
        let guided = all.copied().filter(|node| !side.contains(node)).collect();
        boxes.set(&format!("{name}_guided"), guided);
    }
    let law = |k: f64| {
        format!(
            "model = \"linear-elastic\"\nE = 1e6\nnu = 0.0\nconductivity = {k:?}\nspecific_heat = 2.0\ndensity = 0.5"
        )
    };
    let text = boxes.case(&format!(
        "[material.a]\n{}\n[material.b]\n{}\n[[body]]\ngroup = \"upper\"\nmaterial = \"a\"\n\
         [[body]]\ngroup = \"lower\"\nmaterial = \"b\"\n\
         [[contact]]\nname = \"c\"\nsecondary = \"upper_bottom\"\nprimary = \"lower_top\"\nmethod = \"{method}\"\n\
         enforcement = {{ {enforcement} }}\nfriction = 0.2\nconductance = 1e6\n\
         [[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
         fix = [{{ on = \"lower_guided\", u = \"all\" }}, {{ on = \"upper_guided\", u = [\"x\"] }}]\n\
         load = [{{ on = \"upper_top\", pressure = 10.0 }}]\n\
         [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\nduration = 1.0\nincrements = {{ fixed = {increments} }}\n\
         move = [{{ on = \"upper_guided\", ux = {{ table = [[0.0, 0.0], [1.0, 2.0]] }} }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-10 }}\n",
        law(k[0]),
        law(k[1])
    ));
    let (run, _) = solved(&text);
    let frame = run.frames.last().unwrap();
    // in the mean, for friction tilts the pressure a little
    let [upper, lower] = ["upper_bottom", "lower_top"].map(|side| {
        let rises = at(frame, &boxes, side);
        rises.iter().sum::<f64>() / rises.len() as f64
    });
    [upper, lower, frame.heat_stored]
}

/// `friction_heat_half_spaces.json`: rises to 0.1 % as the increments of backward Euler shrink, and all the heat in closed blocks.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes its time without optimization")]
fn half_spaces_that_rub_warm_as_the_closed_form_says() {
    let Some(exact) = reference("thermal/friction_heat_half_spaces.json") else {
        return;
    };
    let equal = exact["rise"].as_f64().unwrap();
    let unequal = exact["unequal"]["rise"].as_f64().unwrap();
    for way in WAYS {
        for (k, rise) in [([10.0, 10.0], equal), ([10.0, 6.0], unequal)] {
            let [coarse, fine] = [10, 20].map(|n| rubbed(way, k, 16.0, [32, n]));
            for side in 0..2 {
                let off = [coarse, fine].map(|rises| rises[side] / rise - 1.0);
                let limit = 2.0 * off[1] - off[0];
                assert!(limit.abs() < 1e-3, "{way:?} {k:?}: {off:?} {limit:e}");
            }
        }
        // all that the sides have yielded and not given back is at most the limit of friction over the penalty
        let [.., stored] = rubbed(way, [10.0; 2], 1.0, [2, 5]);
        assert!((stored - 4.0).abs() < 1e-4, "{way:?}: {stored}");
    }
}

/// `ring3_ccx.json`: two rings of quad8 pressed together by their overlap, rubbed along the axis; 30 % to the outer ring.
#[test]
fn rings_that_rub_warm_as_by_hand() {
    let Some(all) = reference("thermal/ring3_ccx.json") else {
        return;
    };
    let mut nodes = String::new();
    let radii = [[0.9501, 1.0001, 1.0501], [1.05, 1.1, 1.15]];
    for (k, [a, b, c]) in radii.into_iter().enumerate() {
        let places = [
            (a, 0.1),
            (a, 0.0),
            (c, 0.0),
            (c, 0.1),
            (a, 0.05),
            (b, 0.0),
            (c, 0.05),
            (b, 0.1),
        ];
        for (i, (x, y)) in places.into_iter().enumerate() {
            nodes += &format!("[{}, {x:?}, {y:?}], ", 8 * k + i + 1);
        }
    }
    for method in ["node-to-segment", "gauss-point", "mortar"] {
        let text = format!(
            "[mesh]\nnodes = [{nodes}]\nelements = [\n\
             {{ id = 1, type = \"quad8\", group = \"inner\", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }},\n\
             {{ id = 2, type = \"quad8\", group = \"outer\", nodes = [9, 10, 11, 12, 13, 14, 15, 16] }}]\n\
             [model]\nspace = \"axisymmetric\"\n\
             [sets]\nbore = {{ nodes = [1, 2, 5] }}\nrim = {{ nodes = [11, 12, 15] }}\n\
             inside = {{ faces = [[2, \"S1\"]] }}\noutside = {{ faces = [[1, \"S3\"]] }}\n\
             [initial]\ntemperature = 293.0\n\
             [material.m]\nmodel = \"linear-elastic\"\nE = 210e3\nnu = 0.0\n\
             conductivity = 5e-3\nspecific_heat = 446e6\ndensity = 7.8e-9\n\
             [[body]]\ngroup = [\"inner\", \"outer\"]\nmaterial = \"m\"\n\
             [[contact]]\nname = \"c\"\nsecondary = \"inside\"\nprimary = \"outside\"\nmethod = \"{method}\"\n\
             enforcement = {{ penalty = 1e7, per = \"area\" }}\nfriction = 0.3\nconductance = 0.0\n\
             friction_heat = {{ fraction = 0.9, to_secondary = 0.3 }}\n\
             [[step]]\nname = \"fit\"\ngeometry = \"linear\"\nincrements = 1\n\
             fix = [{{ on = \"inner\", u = [\"y\"] }}, {{ on = \"outer\", u = [\"y\"] }}]\n\
             [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\nincrements = {{ fixed = 1 }}\n\
             move = [{{ on = \"outer\", uy = 200.0 }}]\n\
             temperature = [{{ on = \"bore\", value = 293.0 }}, {{ on = \"rim\", value = 293.0 }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-11 }}\n"
        );
        let (run, _) = solved(&text);
        let frame = run.frames.last().unwrap();
        // Lamé, with the penalty in series: 0.949231, of rings that meet at 1.05 and at 1.0501
        let pressure = frame.contacts[0].pressure_max;
        assert!(
            (pressure / 0.949_231 - 1.0).abs() < 1e-4,
            "{method}: {pressure}"
        );
        let given = all["p"].as_f64().unwrap();
        for (ring, nodes) in [
            ("ring1", [[1, 5], [6, 8], [3, 7]]),
            ("ring2", [[9, 13], [14, 16], [11, 15]]),
        ] {
            let expected = common::numbers(&all["correct"][ring]).into_iter();
            for (nodes, expected) in nodes.iter().zip(expected) {
                for node in nodes {
                    let rise = frame.temperature[node - 1] - 293.0;
                    let expected = (expected - 293.0) * pressure / given;
                    let off = (rise - expected).abs();
                    assert!(off <= 1e-5 * expected, "{method} {node}: {rise} {expected}");
                }
            }
        }
    }
}

/// A block between guides on a surface that slides and has no temperature: as it takes nothing, the block takes all.
#[test]
fn what_rubs_a_surface_without_a_temperature_takes_all_the_heat() {
    for method in ["node-to-segment", "gauss-point"] {
        for to_secondary in ["", "to_secondary = 0.3, "] {
            let mut boxes = Boxes::new(2);
            boxes.add("block", [0.0; 3], [1.0; 3], [2, 2, 1]);
            let text = boxes.case(&format!(
                "[material.m]\nmodel = \"linear-elastic\"\nE = 1e4\nnu = 0.3\nconductivity = 3.0\nspecific_heat = 2.0\ndensity = 0.5\n\
                 [[body]]\ngroup = \"block\"\nmaterial = \"m\"\n[reference.tool]\nat = [0, 0]\n\
                 [[surface]]\nname = \"plane\"\nreference = \"tool\"\nshape = {{ plane = {{ point = [0, 0], normal = \"y\" }} }}\n\
                 [[contact]]\nname = \"c\"\nsecondary = \"block_bottom\"\nprimary = \"plane\"\nmethod = \"{method}\"\n\
                 enforcement = {{ penalty = 1e6, per = \"area\" }}\nfriction = 0.2\nconductance = 5.0\n\
                 friction_heat = {{ {to_secondary}fraction = 0.9 }}\n\
                 [[step]]\nname = \"press\"\nincrements = 1\n\
                 fix = [{{ on = \"tool\", u = \"all\", rot = \"all\" }}]\nmove = [{{ on = \"block_top\", ux = 0.0, uy = -1e-2 }}]\n\
                 [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\nincrements = {{ fixed = 3 }}\n\
                 move = [{{ on = \"tool\", ux = {{ table = [[0.0, 0.0], [1.0, 0.5]] }} }}]\n\
                 [solver]\nnewton = {{ force_tol = 1e-10 }}\n"
            ));
            let (run, _) = solved(&text);
            let frame = run.frames.last().unwrap();
            let work = |frame: &Frame| frame.contacts[0].work_friction;
            let work = work(frame) - work(&run.frames[0]);
            let off = (frame.heat_stored / (0.9 * work) - 1.0).abs();
            assert!(
                work > 1.0 && off < 1e-6,
                "{method} {to_secondary}: {work} {off:e}"
            );
        }
    }
}

/// How fast a wave of temperature grows where an elastic strip rubs a rigid insulator, out of the plane.
fn growth(method: &str, velocity: f64, [nx, ny, increments]: [usize; 3], dt: f64) -> f64 {
    let m = 2.0 * std::f64::consts::PI;
    let mut boxes = Boxes::new(3);
    boxes.add("strip", [0.0; 3], [0.5, 1.0, 0.1], [nx, ny, 1]);
    boxes.bend("strip", |[x, y, z]| [x, 1.25 * y * y, z]);
    let mut at_start = String::new();
    for node in boxes.nodes("strip_bottom").to_vec() {
        let value = 1e-6 * (m * boxes.place(node)[0]).cos();
        boxes.set(&format!("n{node}"), vec![node]);
        at_start += &format!("{{ on = \"n{node}\", temperature = {value:?} }}, ");
    }
    let duration = increments as f64 * dt;
    let text = boxes.case(&format!(
        "[initial]\ntemperature = 0.0\nat = [{at_start}]\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\nexpansion = {{ alpha = 1.0 }}\n\
         conductivity = 1.0\nspecific_heat = 1.0\ndensity = 1.0\n\
         [[body]]\ngroup = \"strip\"\nmaterial = \"m\"\n\
         [reference.tool]\nat = [0, 0, 0]\n\
         [[surface]]\nname = \"insulator\"\nreference = \"tool\"\nshape = {{ plane = {{ point = [0, 0, 0], normal = \"y\" }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"strip_bottom\"\nprimary = \"insulator\"\nmethod = \"{method}\"\n\
         enforcement = {{ penalty = 1e5, per = \"area\" }}\nfriction = 0.2\n\
         [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\ngeometry = \"linear\"\n\
         duration = {duration:?}\nincrements = {{ fixed = {increments} }}\n\
         fix = [{{ on = \"strip_left\", u = [\"x\"] }}, {{ on = \"strip_right\", u = [\"x\"] }}, {{ on = \"strip_all\", u = [\"z\"] }},\n\
         {{ on = \"tool\", u = [\"x\", \"y\"], rot = \"all\" }}]\n\
         load = [{{ on = \"strip_top\", pressure = 1.0 }}]\n\
         move = [{{ on = \"tool\", uz = {{ table = [[0.0, 0.0], [{duration:?}, {:?}]] }} }}]\n\
         temperature = [{{ on = \"strip_top\", value = 0.0 }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-12 }}\n",
        velocity * duration
    ));
    let (run, _) = solved(&text);
    let wave = |frame: &Frame| {
        let nodes = boxes.nodes("strip_bottom").iter();
        let of = |&node: &usize| {
            let x = boxes.place(node)[0];
            let is_inside = (1e-9..=0.5 - 1e-9).contains(&x);
            let share = if is_inside { 1.0 } else { 0.5 };
            share * (m * x).cos() * frame.temperature[node - 1]
        };
        nodes.map(of).sum::<f64>()
    };
    let n = run.frames.len();
    let growth = (wave(&run.frames[n - 1]) / wave(&run.frames[n - 6])).powf(0.2);
    // backward Euler: 1/(1 − b Δt) in each increment
    (1.0 - growth.recip()) / dt / (m * m)
}

/// `thermoelastic_instability.json`: to 1 % of κ m² z², z² = 1 + b/κ m², of which the mesh takes 0.4 %.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes its time without optimization")]
fn what_rubs_an_insulator_grows_hot_spots_beyond_the_critical_velocity() {
    let Some(all) = reference("thermal/thermoelastic_instability.json") else {
        return;
    };
    let critical = all["Vcr"].as_f64().unwrap();
    let expected = all["b_over_kappa_m2"]["1.1"].as_f64().unwrap();
    let found = growth("node-to-segment", 1.1 * critical, [20, 28, 24], 0.01);
    let off = (found - expected).abs();
    assert!(off < 1e-2 * (1.0 + expected), "{found} {expected}");
}
