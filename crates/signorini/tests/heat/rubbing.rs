//! The heat of friction on rings, and on surfaces that take none.

use super::*;
use crate::common::reference;

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
