//! Geometric stiffness of predicted stresses (E36).

use super::*;
use crate::system::GeometricStress;

/// A body whose geometric stiffness takes predicted stresses, whatever its shape.
fn mixed(mesh: &Mesh, law: &str, space: Idealisation) -> Option<Body> {
    let make = TABLE.iter().find(|l| l.name == law).unwrap().make;
    let material = make(&Constants::elastic(500.0, 0.3)).ok()?;
    let mut body = body(mesh, material, &Wish::plain(space, Kinematics::Finite)).ok()?;
    begin(&mut body, GeometricStress::Mixed);
    body.solid.predicts.then_some(body)
}

fn begin(body: &mut Body, geometric: GeometricStress) {
    let step = StepContext {
        geometric,
        ..StepContext::default()
    };
    let start = body.state(&vec![0.0; body.layout.ndof()]);
    body.solid.begin(&Phase::of_step(step), &start).unwrap();
}

fn assemble(body: &Body, u: &[f64], correction: &[f64]) -> Dense {
    let n = body.layout.ndof();
    let mut dense = Dense {
        force: vec![0.0; n],
        stiffness: vec![0.0; n * n],
    };
    let mut state = body.state(u);
    state.correction = correction.to_vec();
    let mut work = Work::default();
    for chunk in 0..body.solid.nchunk() {
        let outcome = body
            .solid
            .evaluate(chunk, &state, Order::Tangent, &mut work, &mut dense);
        outcome.unwrap();
    }
    dense
}

/// A motion with the same gradient everywhere, and this gradient as the strain sees it.
fn uniform(body: &Body, space: Idealisation, seed: usize, size: f64) -> (Vec<f64>, Mat3) {
    let mut h = Mat3::ZERO;
    for (k, row) in h.rows.iter_mut().enumerate() {
        *row = Vec3::new(
            noise(seed + 3 * k),
            noise(seed + 3 * k + 1),
            noise(seed + 3 * k + 2),
        ) * size;
    }
    if space != Idealisation::Space {
        h.rows[2] = Vec3::ZERO;
        h.rows[0].z = 0.0;
        h.rows[1].z = 0.0;
    }
    if space == Idealisation::Axisymmetric {
        // u_r = a r, so that u_r/r is a, too
        h.rows[0].y = 0.0;
        h.rows[2].z = h.rows[0].x;
    }
    let u = body.field(|x| h * x);
    (u, h)
}

#[test]
fn the_geometric_stiffness_is_that_of_the_predicted_stress() {
    let mut count = 0;
    for (element, space) in elements() {
        let mesh = one(element, space);
        for law in TABLE.iter().map(|l| l.name) {
            let Some(mut body) = mixed(&mesh, law, space) else {
                continue;
            };
            let (u, h) = uniform(&body, space, 5, 0.03);
            let (correction, change) = uniform(&body, space, 77, 0.2);
            let with = assemble(&body, &u, &correction);
            let without = assemble(&body, &u, &[]);
            assert_eq!(with.force, without.force, "{} {law}", element.name());
            // the same with the stress −C:Q at the start
            let strain = Strain {
                kinematics: Kinematics::Finite,
                value: Sym3::symmetric_part(h) + Sym3::gram(h) * 0.5,
                temperature: 0.0,
                temperature_at_start: 0.0,
                axes: None,
            };
            let mut response = Response::default();
            let material = body.solid.material();
            let mut new = vec![0.0; material.nhistory()];
            let old = new.clone();
            let order = MaterialOrder::Tangent;
            let answer = material.respond(&strain, &old, &mut new, order, &mut response);
            answer.unwrap();
            let mut stress = [0.0; 6];
            let q = (Sym3::gram(change) * 0.5).to_pairs();
            for (to, row) in stress.iter_mut().zip(&response.tangent) {
                let twice = |k: usize| if k < 3 { 1.0 } else { 2.0 };
                *to = -(0..6).map(|k| twice(k) * row[k] * q[k]).sum::<f64>();
            }
            let block = &mut body.solid.blocks[0];
            let at_start = (0..block.points.rule.npoint()).map(|point| AtStart {
                cell: block.ids[0],
                point,
                stress: Sym3::from_pairs(stress),
                strain: Sym3::default(),
            });
            let at_start: Vec<AtStart> = at_start.collect();
            block.begin("body", &at_start).unwrap();
            let other = assemble(&body, &u, &[]);
            let scale = with.scale();
            for (a, b) in with.stiffness.iter().zip(&other.stiffness) {
                let name = element.name();
                assert!(
                    (a - b).abs() < 1e-12 * scale,
                    "{name} {law} {space:?}: {a} {b}"
                );
            }
            let differs = with.stiffness.iter().zip(&without.stiffness);
            let most = differs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            assert!(most > 1e-4 * scale, "{} {law}", element.name());
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}

#[test]
fn several_cells_at_once_predict_as_one_does() {
    for element in of_dimension(3) {
        let one = one(element, Idealisation::Space);
        let nnode = element.nnode() as u32;
        // cells without common nodes, each of another shape
        let mut mesh = Mesh::default();
        for cell in 0..19u32 {
            for (k, x) in one.points.iter().enumerate() {
                let by = Vec3::new(noise(k), noise(k + 7), noise(k + 31)) * 0.002;
                mesh.points.push(*x + by * f64::from(cell));
                mesh.node_labels.push(mesh.points.len() as u64);
            }
            let nodes: Vec<u32> = (cell * nnode..(cell + 1) * nnode).collect();
            mesh.push_cell(element, &nodes, u64::from(cell));
        }
        for law in ["saint-venant-kirchhoff", "neo-hookean"] {
            let mut body = mixed(&mesh, law, Idealisation::Space).unwrap();
            let n = body.layout.ndof();
            let u: Vec<f64> = (0..n).map(|k| 0.02 * noise(k)).collect();
            let correction: Vec<f64> = (0..n).map(|k| 0.05 * noise(k + 1000)).collect();
            let together = assemble(&body, &u, &correction);
            body.solid.blocks[0].finite.batch = None;
            let alone = assemble(&body, &u, &correction);
            let scale = together.scale();
            for (a, b) in together.stiffness.iter().zip(&alone.stiffness) {
                assert!((a - b).abs() < 1e-13 * scale, "{} {law}", element.name());
            }
        }
    }
}

#[test]
fn without_a_correction_tangents_have_the_same_bits() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        let Some(mut body) = mixed(&mesh, "neo-hookean", space) else {
            continue;
        };
        let u: Vec<f64> = (0..body.layout.ndof()).map(|k| 0.02 * noise(k)).collect();
        let first = assemble(&body, &u, &[]).stiffness;
        let still = assemble(&body, &u, &vec![0.0; u.len()]).stiffness;
        begin(&mut body, GeometricStress::Current);
        let moved: Vec<f64> = u.iter().map(|u| 3.0 * u).collect();
        let current = assemble(&body, &u, &moved).stiffness;
        assert_eq!(first, current, "{}", element.name());
        assert_eq!(first, still, "{}", element.name());
    }
}

#[test]
fn bodies_with_a_flat_element_predict_by_themselves() {
    for (element, space) in elements() {
        for (ratio, is_thin) in [(1.0, false), (3.0, false), (20.0, true)] {
            let mut mesh = Mesh::default();
            let turn = match space {
                Idealisation::Space => Mat3::rotation(Vec3::new(0.4, -0.5, 1.1)),
                _ => Mat3::rotation(Vec3::new(0.0, 0.0, 0.3)),
            };
            for (k, xi) in element.nodes().iter().enumerate() {
                let flat = Vec3::new(xi.x * ratio, xi.y, xi.z) * 0.1;
                mesh.points.push(turn * flat + Vec3::new(10.0, 0.0, 0.0));
                mesh.node_labels.push(k as u64 + 1);
            }
            let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
            mesh.push_cell(element, &nodes, 1);
            let wish = Wish::plain(space, Kinematics::Finite);
            let mut body = body(&mesh, elastic("neo-hookean", 0.3), &wish).unwrap();
            begin(&mut body, GeometricStress::Auto);
            let predicts = body.solid.properties().predicts;
            assert_eq!(predicts, is_thin, "{} {space:?} {ratio}", element.name());
            // not in linear steps, nor in motions
            let step = StepContext {
                nonlinear: false,
                ..StepContext::default()
            };
            let start = body.state(&vec![0.0; body.layout.ndof()]);
            body.solid.begin(&Phase::of_step(step), &start).unwrap();
            assert!(!body.solid.properties().predicts);
        }
    }
}
