//! Surfaces that may touch themselves: what never touches is as without contact, what does is as between two bodies.
//!
//! SOURCE      Written for the purpose.
//! GOAL        one set over everything, with the automatic reach, is neither pressed with its own far side nor with the
//!             facets around it
//! MESH        rectangles of quad4 or quad8, thick and thinner than their facets; examples/two_blocks_2d
//! CONDITIONS  a rubber block squeezed by a fourth and bent; two blocks pressed and slid, their skins one set
//! EXPECTED    iterations and displacements of the same run without contact; forces of the pair
//! TOLERANCE   none; 1 % by nodes, 3.5 % by points: penalties yield (found 0.7 % and 3.0 %)

#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, model, run, text};
use std::fmt::Write;

/// A rectangle of elements, its lower end held and its upper end moved; its whole skin may touch itself.
fn block(quadratic: bool, [width, height]: [f64; 2], cells: [usize; 2], motion: &str) -> String {
    let per = if quadratic { 2 } else { 1 };
    let [nx, ny] = cells.map(|n| n * per);
    let node = |i: usize, j: usize| j * (nx + 1) + i + 1;
    let mut text = String::from("format = 1\n[mesh]\nnodes = [\n");
    for j in 0..=ny {
        for i in 0..=nx {
            let is_middle = quadratic && i % 2 == 1 && j % 2 == 1;
            let (x, y) = (width * i as f64 / nx as f64, height * j as f64 / ny as f64);
            if !is_middle {
                writeln!(text, "[{}, {x}, {y}],", node(i, j)).unwrap();
            }
        }
    }
    text.push_str("]\nelements = [\n");
    let (mut skin, mut id) = (Vec::new(), 0);
    for j in (0..ny).step_by(per) {
        for i in (0..nx).step_by(per) {
            id += 1;
            let (a, b) = (i + per, j + per);
            let mut nodes = vec![node(i, j), node(a, j), node(a, b), node(i, b)];
            if quadratic {
                nodes.extend([
                    node(i + 1, j),
                    node(a, j + 1),
                    node(i + 1, b),
                    node(i, j + 1),
                ]);
            }
            let kind = if quadratic { "quad8" } else { "quad4" };
            writeln!(
                text,
                "{{ id = {id}, type = \"{kind}\", group = \"block\", nodes = {nodes:?} }},"
            )
            .unwrap();
            let ends = [
                (j == 0, "-y"),
                (a == nx, "+x"),
                (b == ny, "+y"),
                (i == 0, "-x"),
            ];
            let outer = ends.iter().filter(|(outer, _)| *outer);
            skin.extend(outer.map(|(_, side)| format!("[{id}, \"{side}\"]")));
        }
    }
    let skin = skin.join(", ");
    write!(
        text,
        "]\n[model]\nspace = \"plane-strain\"\n[sets]\nskin = {{ faces = [{skin}] }}\n\
         bottom = {{ box = [[-1.0, -1e-6], [{0}, 1e-6]] }}\ntop = {{ box = [[-1.0, {1}], [{0}, {2}]] }}\n\
         [material.rubber]\nmodel = \"neo-hookean\"\nE = 10.0\nnu = 0.4\n\
         [[body]]\ngroup = \"block\"\nmaterial = \"rubber\"\n\
         [[contact]]\nname = \"itself\"\nsecondary = \"skin\"\nprimary = \"self\"\n\
         [[step]]\nname = \"press\"\ngeometry = \"nonlinear\"\nincrements = 6\n\
         [[step.fix]]\non = \"bottom\"\nu = \"all\"\n[[step.move]]\non = \"top\"\n{motion}\n",
        width + 1.0,
        height - 1e-6,
        height + 1e-6
    )
    .unwrap();
    text
}

fn iterations(run: &Run) -> usize {
    run.increments.iter().map(|i| i.iterations).sum()
}

#[test]
fn the_skin_of_a_body_that_does_not_touch_itself_is_as_without_contact() {
    let cases = [
        ([4.0, 4.0], [8, 8], "ux = 0.0\nuy = -1.0"),
        ([4.0, 4.0], [3, 2], "ux = 0.0\nuy = -1.2"),
        ([0.1, 4.0], [1, 8], "ux = 1.0\nuy = -0.2"),
        ([0.2, 4.0], [2, 5], "ux = 1.0\nuy = -0.2"),
    ];
    for quadratic in [false, true] {
        for (size, cells, motion) in cases {
            let text = block(quadratic, size, cells, motion);
            let [with, without] = ["true", "false"]
                .map(|active| run(&mut model("block", &text, &[("contact.0.active", active)])));
            let what = format!("{size:?} {cells:?} quadratic {quadratic}");
            assert!(
                with.error.is_none() && without.error.is_none(),
                "{what}: {:?}",
                with.error
            );
            assert_eq!(iterations(&with), iterations(&without), "{what}");
            for (a, b) in with.frames.iter().zip(&without.frames) {
                assert_eq!(a.displacement, b.displacement, "{what}");
                let pressed = a.contacts[0].force.iter().filter(|f| f.norm() > 0.0);
                assert_eq!(pressed.count(), 0, "{what}");
            }
        }
    }
}

#[test]
fn two_blocks_of_one_surface_are_pressed_as_the_pair() {
    let pair = text("two_blocks_2d");
    let start = pair.find("[[contact]]").unwrap();
    let end = pair.find("[[step]]").unwrap();
    let expect = pair.find("[[expect]]").unwrap_or(pair.len());
    let faces = "outer = { faces = [[1,\"-y\"],[2,\"-y\"],[3,\"-y\"],[4,\"-y\"],[4,\"+x\"],[8,\"+x\"],[1,\"-x\"],\
                 [5,\"-x\"],[5,\"+y\"],[6,\"+y\"],[7,\"+y\"],[8,\"+y\"],[9,\"-y\"],[10,\"-y\"],[10,\"+x\"],\
                 [12,\"+x\"],[9,\"-x\"],[11,\"-x\"],[11,\"+y\"],[12,\"+y\"]] }";
    let text = |contact: &str| {
        let before = pair[..start].replace("[sets]\n", &format!("[sets]\n{faces}\n"));
        format!(
            "{before}[[contact]]\nname = \"all\"\n{contact}\n{}",
            &pair[end..expect]
        )
    };
    let named = "secondary = \"foot\"\nprimary = \"lower_top\"\nmethod = \"node-to-segment\"\n\
                 enforcement = { penalty = 1e5, per = \"node\" }";
    let itself = "secondary = \"outer\"\nprimary = \"self\"";
    // points inside facets compare other places than nodes do
    let methods = [("node-to-segment", 0.01), ("gauss-point", 0.035)];
    let right = run(&mut model("two_blocks_2d", &text(named), &[]));
    for (method, tolerance) in methods {
        let contact = format!("{itself}\nmethod = \"{method}\"");
        let found = run(&mut model("two_blocks_2d", &text(&contact), &[]));
        assert!(found.error.is_none(), "{method}: {:?}", found.error);
        assert_eq!(found.frames.len(), right.frames.len());
        for (a, b) in found.frames.iter().zip(&right.frames).skip(1) {
            let of_top = |frame: &signorini_mechanics::system::Frame| -> f64 {
                let top = [21, 22, 23];
                top.iter().map(|&n: &usize| frame.reaction_force[n].y).sum()
            };
            let (a, b) = (of_top(a), of_top(b));
            assert!((a - b).abs() < tolerance * b.abs(), "{method}: {a} for {b}");
        }
    }
}
