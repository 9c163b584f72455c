//! Two blocks whose sides are prescribed, at the nodes of the contact, too.
//!
//! SOURCE      Written for the purpose.
//! GOAL        multipliers whose nodes cannot follow do not make the equations singular, nor change what the others find
//! MESH        two unit squares or cubes, one upon the other, of every element: 3 cells along each edge above, 2 below
//! CONDITIONS  small strain, E = 1000, nu = 0.3; all sides move by 0.05 along their normals, each in the same direction, the
//!             base along with them; the head goes down by 0.02. Without friction and with mu = 0.3, sides swapped
//! EXPECTED    uniaxial strain: the force is M A u/L with M = E (1 − nu)/((1 + nu)(1 − 2 nu)), at the head, at the base
//! TOLERANCE   force 1e-9 of the whole, in 3 iterations without a cut
use crate::scene::Scene;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

const HEIGHT: f64 = 0.02;
const SHIFT: f64 = 0.05;

/// Blocks of this element, with keys of the contact: the reaction at the head, and the number of iterations.
fn pressed(element: &'static str, swapped: bool, keys: &str) -> (f64, usize) {
    let plane = element.starts_with("tri") || element.starts_with("quad");
    let up = if plane { 1 } else { 2 };
    let mut scene = Scene::default();
    for (group, n, floor) in [("lower", 2, -1.0), ("upper", 3, 0.0)] {
        let size = [n, n, if plane { 0 } else { n }];
        let corner = |at: [usize; 3]| {
            let mut x = Vec3::from(at.map(|k| k as f64 / n as f64));
            x[up] += floor;
            x
        };
        scene.straight(group, element, size, corner);
    }
    for (name, group) in [("roof", "lower"), ("foot", "upper")] {
        let facets = scene.facets(group, up, 0.0);
        let faces: Vec<String> = facets
            .iter()
            .map(|((cell, side), ..)| format!("[{cell}, \"S{side}\"]"))
            .collect();
        scene.place(name, &format!("faces = [{}]", faces.join(", ")));
    }
    let axis = if plane { "y" } else { "z" };
    scene.place("head", &format!("plane = \"{axis}\", at = 1.0"));
    scene.place("base", &format!("plane = \"{axis}\", at = -1.0"));
    for (name, at) in [("left", 0.0), ("right", 1.0)] {
        scene.place(name, &format!("plane = \"x\", at = {at:?}"));
    }
    for (name, at) in [("front", 0.0), ("back", 1.0)]
        .into_iter()
        .filter(|_| !plane)
    {
        scene.place(name, &format!("plane = \"y\", at = {at:?}"));
    }
    let [secondary, primary] = match swapped {
        true => ["roof", "foot"],
        false => ["foot", "roof"],
    };
    let space = if plane { "plane-strain" } else { "3d" };
    let mut case = scene
        .elastic(space, 1000.0, 0.3)
        .body(&["lower", "upper"], "locking = \"none\"")
        .contact(secondary, primary, keys)
        .step("press", 1)
        .fix("base", axis)
        .displace("head", &format!("u{axis} = {:?}", -HEIGHT));
    for side in ["left", "right"] {
        case = case.displace(side, &format!("ux = {SHIFT:?}"));
    }
    for side in ["front", "back"].into_iter().filter(|_| !plane) {
        case = case.displace(side, &format!("uy = {SHIFT:?}"));
    }
    let case = case.newton("force_tol = 1e-11");
    let mut model = case.model(&[]);
    let run = crate::scene::finished(&mut model);
    assert!(run.cutbacks.is_empty());
    // friction along directions prescribed on both sides acts on nothing
    let idle = run.frames[run.frames.len() - 1].contacts[0].idle;
    assert_eq!(idle.is_empty(), !keys.contains("friction"), "{idle:?}");
    let nodes: Vec<NodeId> = model.nodes_of("head").unwrap();
    let reactions = &run.frames[run.frames.len() - 1].reaction_force;
    let force = nodes.iter().map(|&n| reactions[n as usize][up]).sum();
    (force, run.increments.iter().map(|i| i.iterations).sum())
}

#[test]
fn blocks_whose_sides_are_prescribed_carry_uniaxial_strain() {
    let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
    let expected = -modulus * HEIGHT / 2.0;
    for element in ["tri3", "quad4", "tri6", "quad8", "tet4", "hex8", "hex20"] {
        for swapped in [false, true] {
            for keys in ["", "friction = 0.3"] {
                let (force, iterations) = pressed(element, swapped, keys);
                let off = force / expected - 1.0;
                assert!(off.abs() < 1e-9, "{element} {swapped} {keys}: {off:e}");
                assert!(iterations <= 3, "{element} {swapped} {keys}: {iterations}");
            }
        }
    }
}
