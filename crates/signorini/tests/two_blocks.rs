//! Two blocks pressed and slid over each other, in the plane and in space.
//!
//! SOURCE      Independent programs written for the purpose: data/two_block_2d.json, two_block_2d_vertex.json,
//!             two_block_3d_nts.json (mesh, rules and path in their notes).
//! GOAL        Sliding across facets; a node that comes to rest in the concave corner between two of them, the trap for
//!             "closest segment with unclamped coordinates"; in space with faces, edges and vertices.
//! MESH        12 quad4; 13 hex8. Neo-Hookean or St. Venant-Kirchhoff, E = 1000 and 2000, nu = 0.3.
//! CONDITIONS  Base fixed, top moved; node-to-segment penalty without friction, 1e4 and 1e5 per node.
//! EXPECTED    Displacements of all nodes and forces of both ends after every increment.
//! TOLERANCE   1e-8: both programs iterate to round-off, the data has 12 digits.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, example, model, numbers, oracle, relative, run, text};
use serde_json::Value;
use std::fmt::Write;

/// Compares displacements and forces with a reference, to 1e-8.
fn check(key: &str, run: &Run, steps: &[Value], nodes_of_top: &[usize], ndim: usize) {
    let [displacement, force] = differences(key, run, steps, nodes_of_top, ndim);
    assert!(
        displacement < 1e-8,
        "{key}: displacements differ by {displacement:e}"
    );
    assert!(force < 1e-8, "{key}: forces differ by {force:e}");
    for frame in &run.frames[..steps.len()] {
        let contact = &frame.contacts[0];
        let balance = contact.secondary.force + contact.primary.force;
        assert!(balance.norm() < 1e-12 * contact.primary.force.norm());
        let moment = contact.secondary.moment + contact.primary.moment;
        assert!(moment.norm() < 1e-12 * contact.primary.moment.norm());
    }
}

/// How far displacements and forces are from a reference at most, over the largest.
fn differences(
    key: &str,
    run: &Run,
    steps: &[Value],
    nodes_of_top: &[usize],
    ndim: usize,
) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    assert!(run.error.is_none(), "{key}: {:?}", run.error);
    assert!(run.frames.len() >= steps.len(), "{key}");
    for (step, frame) in steps.iter().zip(&run.frames) {
        let expected: Vec<f64> = step["u"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(numbers)
            .collect();
        let got: Vec<f64> = frame
            .displacement
            .iter()
            .flat_map(|u| u.to_array().into_iter().take(ndim))
            .collect();
        worst[0] = worst[0].max(relative(&got, &expected));
        let mut top = vec![0.0; ndim];
        for &node in nodes_of_top {
            for (axis, sum) in top.iter_mut().enumerate() {
                *sum += frame.reaction_force[node][axis];
            }
        }
        worst[1] = worst[1].max(relative(&top, &numbers(&step["R_top"])));
    }
    worst
}

fn indices(value: &Value) -> Vec<usize> {
    numbers(value).into_iter().map(|n| n as usize).collect()
}

#[test]
fn plane_blocks_match_for_both_materials() {
    let data = oracle("two_block_2d.json");
    let top = indices(&data["mesh"]["top_nodes"]);
    for (key, law) in [
        ("nh_pen_mu0", "neo-hookean"),
        ("svk_pen_mu0", "saint-venant-kirchhoff"),
    ] {
        let law = format!("\"{law}\"");
        let set = [
            ("material.soft.model", &law[..]),
            ("material.stiff.model", &law[..]),
        ];
        let result = run(&mut example("two_blocks_2d", &set));
        let steps = data["runs"][key]["steps"].as_array().unwrap();
        check(key, &result, steps, &top, 2);
    }
}

/// Multipliers, and Uzawa's way to the same solution.
#[test]
fn plane_blocks_with_friction_match_by_multipliers() {
    let data = oracle("two_block_2d.json");
    let top = indices(&data["mesh"]["top_nodes"]);
    let steps = data["runs"]["nh_lm_mu0.3"]["steps"].as_array().unwrap();
    let path = path_of(&data["runs"]["nh_lm_mu0.3"], steps);
    for enforcement in [
        "{ lagrange = {} }",
        "{ augmented = \"newton\", penalty = 2e4, per = \"node\" }",
        "{ augmented = \"uzawa\", penalty = 1e5, per = \"node\" }",
    ] {
        let text = text("two_blocks_2d");
        let text = &text[..text.find("[[step]]").unwrap()];
        let text = format!("{text}{path}");
        let set = [
            ("material.soft.model", "\"neo-hookean\""),
            ("material.stiff.model", "\"neo-hookean\""),
            ("contact.0.enforcement", enforcement),
            ("contact.0.friction", "0.3"),
        ];
        let mut model = model("two_blocks_2d", &text, &set);
        let result = run(&mut model);
        check(enforcement, &result, steps, &top, 2);
        // what multipliers hold does not yield, however large the traction
        for contact in result.frames.iter().map(|frame| &frame.contacts[0]) {
            assert!(contact.traction.iter().any(|t| t.norm() > 0.0));
            assert!(contact.elastic_slip.iter().all(|slip| slip.norm() == 0.0));
        }
    }
}

/// The steps of a run that presses in 5 increments and slides in the others.
fn path_of(run: &Value, steps: &[Value]) -> String {
    let slide = run["slide_per_step"].as_f64().unwrap();
    let nslide = steps.len() - 5;
    let far = slide * nslide as f64;
    format!(
        "[[step]]\nname = \"press\"\nincrements = {{ fixed = 5 }}\n\
         [[step.fix]]\non = \"base\"\nu = \"all\"\n\
         [[step.move]]\non = \"head\"\nux = 0.0\nuy = -0.05\n\
         [[step]]\nname = \"slide\"\nincrements = {{ fixed = {nslide} }}\n\
         [[step.move]]\non = \"head\"\nux = {far}\n\
         [solver]\nnewton = {{ force_tol = 1e-11, gap_tol = 1e-13, max_iterations = 40 }}\n"
    )
}

#[test]
fn a_node_comes_to_rest_in_a_concave_corner() {
    let data = oracle("two_block_2d_vertex.json");
    let top = indices(&oracle("two_block_2d.json")["mesh"]["top_nodes"]);
    // the same mesh, slid by 0.02 in each of ten increments
    let slower = text("two_blocks_2d")
        .replace("[12.0, 0.21]", "[15.0, 0.2]")
        .replace("duration   = 12.0", "duration   = 15.0")
        .replace("fixed = 12", "fixed = 15");
    for penalty in ["1e4", "1e5"] {
        let set = [("contact.foot_on_block.enforcement.penalty", penalty)];
        let result = run(&mut model("vertex", &slower, &set));
        for kind in ["vertex0", "vertex1"] {
            let key = format!("p{}_{kind}", penalty.replace('e', "e+0"));
            let steps = data["runs"][&key].as_array().unwrap();
            check(&key, &result, steps, &top, 2);
        }
    }
}

/// The case of the two blocks in space, written from the mesh in the data.
fn blocks_in_space(data: &Value, penalty: Option<&str>) -> String {
    let mesh = &data["mesh"];
    let list = |value: &Value| {
        let labels = indices(value).into_iter().map(|n| (n + 1).to_string());
        labels.collect::<Vec<_>>().join(", ")
    };
    let mut text = String::from("format = 1\n[mesh]\nnodes = [\n");
    for (i, x) in mesh["nodes"].as_array().unwrap().iter().enumerate() {
        let x = numbers(x);
        writeln!(text, "[{}, {:?}, {:?}, {:?}],", i + 1, x[0], x[1], x[2]).unwrap();
    }
    text.push_str("]\nelements = [\n");
    let nlower = mesh["n_lower_elements"].as_u64().unwrap() as usize;
    let elements = mesh["hex8"].as_array().unwrap();
    for (i, nodes) in elements.iter().enumerate() {
        let group = if i < nlower { "lower" } else { "upper" };
        let nodes = list(nodes);
        let id = i + 1;
        writeln!(
            text,
            "{{ id = {id}, type = \"hex8\", group = \"{group}\", nodes = [{nodes}] }},"
        )
        .unwrap();
    }
    let upper = (nlower + 1..=elements.len()).take(4);
    let under = upper.map(|id| format!("[{id}, \"-z\"]"));
    let under = under.collect::<Vec<_>>().join(", ");
    let facets =
        (1..=mesh["primary_facets"].as_array().unwrap().len()).map(|id| format!("[{id}, \"+z\"]"));
    let facets = facets.collect::<Vec<_>>().join(", ");
    let contact = match penalty {
        Some(penalty) => format!("enforcement = {{ penalty = {penalty}, per = \"node\" }}"),
        None => "method = \"mortar\"".to_string(),
    };
    write!(
        text,
        r#"]
[sets]
base = {{ nodes = [{}] }}
head = {{ nodes = [{}] }}
foot = {{ {} }}
top  = {{ faces = [{facets}] }}
[amplitude]
press = {{ table = [[0, 0], [3, -0.06]], time = "total" }}
along = {{ table = [[3, 0], [8, 0.3]], time = "total" }}
aside = {{ table = [[3, 0], [8, 0.175]], time = "total" }}
[material.soft]
model = "neo-hookean"
E = 1000.0
nu = 0.3
[material.stiff]
model = "neo-hookean"
E = 2000.0
nu = 0.3
[[body]]
group = "lower"
material = "soft"
[[body]]
group = "upper"
material = "stiff"
[[contact]]
name = "blocks"
secondary = "foot"
primary = "top"
{contact}
[[step]]
name = "path"
duration = 8.0
increments = {{ fixed = 8 }}
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "head"
ux = {{ amplitude = "along", value = 1.0 }}
uy = {{ amplitude = "aside", value = 1.0 }}
uz = {{ amplitude = "press", value = 1.0 }}
[solver]
newton = {{ force_tol = 1e-10 }}
"#,
        list(&mesh["base"]),
        list(&mesh["top"]),
        if penalty.is_some() {
            format!("nodes = [{}]", list(&mesh["secondary_nodes"]))
        } else {
            format!("faces = [{under}]")
        },
    )
    .unwrap();
    text
}

#[test]
fn blocks_in_space_match_across_faces_edges_and_vertices() {
    let data = oracle("two_block_3d_nts.json");
    let top = indices(&data["mesh"]["top"]);
    for (key, penalty) in [("p1e+04", "1e4"), ("p1e+05", "1e5")] {
        let result = run(&mut model(
            "blocks",
            &blocks_in_space(&data, Some(penalty)),
            &[],
        ));
        let steps = data["runs"][key].as_array().unwrap();
        check(key, &result, steps, &top, 3);
        let got: Vec<usize> = result.increments.iter().map(|i| i.iterations).collect();
        println!("{key}: {got:?}");
    }
}

/// The part of the moment of all contact forces that is left over, at most, over their moment.
fn moment_left(run: &Run) -> f64 {
    let left = |frame: &signorini_mechanics::system::Frame| {
        let contact = &frame.contacts[0];
        let left = contact.secondary.moment + contact.primary.moment;
        left.norm() / contact.primary.moment.norm()
    };
    run.frames.iter().map(left).fold(0.0, f64::max)
}

/// Iterations of all increments.
fn iterations(run: &Run) -> Vec<usize> {
    run.increments.iter().map(|i| i.iterations).collect()
}

#[test]
fn plane_blocks_match_by_mortar() {
    let mesh = indices(&oracle("two_block_2d.json")["mesh"]["top_nodes"]);
    let data = oracle("two_block_2d_mortar_friction.json");
    let other = oracle("two_block_2d_mortar.json");
    for (data, key, normals, friction, tolerance) in [
        (&data, "facet_frictionless_facetnormal", "", "0", 1e-7),
        (&data, "facet_coulomb0.3_facetnormal", "", "0.3", 1e-7),
        (&data, "facet_frictionless", "nodal", "0", 1e-7),
        (&data, "facet_coulomb0.3", "nodal", "0.3", 1e-7),
        (&data, "facet_tresca15", "nodal", "{ tresca = 15 }", 1e-7),
        // projections of another kind
        (&data, "interp_frictionless", "nodal", "0", 1e-2),
        (&data, "interp_frictionless_facetnormal", "", "0", 1e-2),
        (&data, "interp_coulomb0.3", "nodal", "0.3", 1e-2),
        (&data, "interp_tresca15", "nodal", "{ tresca = 15 }", 1e-2),
        (&other, "nh_dual_slide0.03", "nodal", "0", 1e-2),
    ] {
        let of_run = &data["runs"][key];
        let steps = of_run.get("steps").unwrap_or(of_run).as_array().unwrap();
        let slide = match of_run.get("slide_per_step").or(data.get("slide_per_step")) {
            Some(slide) => slide.as_f64().unwrap(),
            None => 0.03,
        };
        let path = path_of(&serde_json::json!({ "slide_per_step": slide }), steps);
        let text = text("two_blocks_2d");
        let text = &text[..text.find("[[step]]").unwrap()];
        let normals = match normals {
            "" => String::from("normals = \"secondary\"\n"),
            word => format!("normals = \"{word}\"\n"),
        };
        let friction = format!("method = \"mortar\"\nfriction = {friction}\n{normals}");
        let text = text.replace("method      = \"node-to-segment\"\n", &friction);
        let text = text.replace("enforcement = {", "# enforcement = {");
        let set = [
            ("material.soft.model", "\"neo-hookean\""),
            ("material.stiff.model", "\"neo-hookean\""),
        ];
        let result = run(&mut model("two_blocks_2d", &format!("{text}{path}"), &set));
        let [displacement, force] = differences(key, &result, steps, &mesh, 2);
        let moment = moment_left(&result);
        println!(
            "{key}: u {displacement:.1e} R {force:.1e} moment {moment:.1e} {:?}",
            iterations(&result)
        );
        assert!(displacement < tolerance && force < tolerance, "{key}");
        let exact = normals.contains("secondary") && friction.contains("friction = 0\n");
        assert!(!exact || moment < 1e-12, "{key}: {moment:e}");
    }
}

#[test]
fn blocks_in_space_match_by_mortar() {
    let data = oracle("two_block_3d_mortar.json");
    let top = indices(&data["mesh"]["top"]);
    for (key, normals, friction) in [
        ("frictionless_facetnormal", "", "0"),
        ("coulomb0.3_facetnormal", "", "0.3"),
        ("frictionless", "nodal", "0"),
        ("coulomb0.3", "nodal", "0.3"),
    ] {
        let Some(steps) = data["runs"].get(key) else {
            println!("{key}: no such run");
            continue;
        };
        let normals = match normals {
            "" => String::from("normals = \"secondary\"\n"),
            word => format!("normals = \"{word}\"\n"),
        };
        let contact = format!("method = \"mortar\"\nfriction = {friction}\n{normals}");
        let text = blocks_in_space(&data, None).replace("method = \"mortar\"\n", &contact);
        let result = run(&mut model("blocks", &text, &[]));
        let [displacement, force] = differences(key, &result, steps.as_array().unwrap(), &top, 3);
        let moment = moment_left(&result);
        println!(
            "{key}: u {displacement:.1e} R {force:.1e} moment {moment:.1e} {:?}",
            iterations(&result)
        );
        assert!(displacement < 1e-7 && force < 1e-7, "{key}");
        let exact = normals.contains("secondary") && friction == "0";
        assert!(!exact || moment < 1e-12, "{key}: {moment:e}");
    }
}
