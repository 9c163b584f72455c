//! The heat of friction on surfaces that take none.

use super::*;

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
