//! How much of a stiffness changes between states, as bodies estimate it.

use super::*;

fn form(stiffness: &[f64], v: &[f64]) -> f64 {
    let rows = stiffness.chunks_exact(v.len()).zip(v);
    rows.map(|(row, v_i)| v_i * row.iter().zip(v).map(|(k, v_j)| k * v_j).sum::<f64>())
        .sum()
}

/// A field of displacements: a gradient, if need be without rotation, and noise on it.
fn displacements(mesh: &Mesh, ndim: usize, size: f64, seed: usize, turns: bool) -> Vec<f64> {
    let gradient = |i: usize, j: usize| {
        let (i, j) = if turns { (i, j) } else { (i.min(j), i.max(j)) };
        noise(seed + 17 * i + 5 * j)
    };
    let of_node = |(node, x): (usize, &Vec3)| -> Vec<f64> {
        let at = |i: usize| (0..ndim).map(|j| gradient(i, j) * x[j]).sum::<f64>();
        let noisy = |i: usize| at(i) + 0.1 * noise(seed + 31 * node + i);
        (0..ndim).map(|i| size * noisy(i)).collect()
    };
    mesh.points.iter().enumerate().flat_map(of_node).collect()
}

#[test]
fn the_stiffness_changes_by_no_more_than_is_estimated_and_not_much_less() {
    let plane = Idealisation::PlaneStrain { thickness: 1.0 };
    for (element, space, locking) in [
        ("hex8", Idealisation::Space, Locking::None),
        ("hex8", Idealisation::Space, Locking::FBar),
        ("tet10", Idealisation::Space, Locking::None),
        ("hex20", Idealisation::Space, Locking::None),
        ("quad4", plane, Locking::None),
        ("tri6", plane, Locking::None),
    ] {
        for (law, nu) in [
            ("linear-elastic", 0.3),
            ("linear-elastic", 0.0),
            ("neo-hookean", 0.3),
            ("neo-hookean", 0.45),
        ] {
            let mesh = one(element::by_name(element).unwrap(), space);
            let wish = Wish {
                locking,
                ..Wish::plain(space, Kinematics::Finite)
            };
            let body = body(&mesh, elastic(law, nu), &wish).unwrap();
            let (ndim, n) = (space.ndim(), body.layout.ndof());
            let mut work = Work::default();
            let start = body.assemble(&vec![0.0; n], Order::Tangent, &mut work);
            let mut largest = 0.0f64;
            for seed in 0..6 {
                let from = displacements(&mesh, ndim, 0.05, 100 * seed, true);
                let step = displacements(&mesh, ndim, 0.01, 100 * seed + 50, true);
                let to: Vec<f64> = from.iter().zip(&step).map(|(a, b)| a + b).collect();
                let [a, b] =
                    [&from, &to].map(|u| body.assemble(u, Order::Tangent, &mut work).stiffness);
                let (a_state, b_state) = (body.state(&from), body.state(&to));
                let estimate = body.solid.stiffness_change(&a_state, &b_state);
                assert!(estimate > 0.0);
                for direction in 0..20 {
                    let v = displacements(&mesh, ndim, 1.0, 7 * direction, false);
                    let change = (form(&b, &v) - form(&a, &v)).abs();
                    largest = largest.max(change / (estimate * form(&start.stiffness, &v)));
                }
            }
            assert!((0.02..1.0).contains(&largest), "{element} {law}: {largest}");
        }
    }
}

#[test]
fn what_cannot_be_told_is_not_estimated() {
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let change = |law: Box<dyn Material>, kinematics| {
        let body = body(&mesh, law, &Wish::plain(space, kinematics)).unwrap();
        let n = body.layout.ndof();
        let (from, to) = (body.state(&vec![0.0; n]), body.state(&vec![0.1; n]));
        body.solid.stiffness_change(&from, &to)
    };
    let elastic = || elastic("linear-elastic", 0.3);
    assert_eq!(
        change(derivatives::plastic(), Kinematics::Finite),
        f64::INFINITY
    );
    assert_eq!(
        change(derivatives::plastic(), Kinematics::Small),
        f64::INFINITY
    );
    assert_eq!(change(elastic(), Kinematics::Small), 0.0);
    // a translation
    assert!(change(elastic(), Kinematics::Finite) < 1e-15);
}
