//! Constant strain is reproduced, and nothing but rigid motion is free.

use super::locking::grid;
use super::*;

/// A displacement gradient.
fn affine() -> Mat3 {
    Mat3::from_rows([
        Vec3::new(0.02, 0.01, -0.015),
        Vec3::new(-0.03, -0.05, 0.02),
        Vec3::new(0.01, 0.025, 0.03),
    ])
}

/// A homogeneous state: `u = A X`; in axisymmetry `u_r = a r`, `u_z = b z`.
fn homogeneous(space: Idealisation, x: Vec3) -> Vec3 {
    match space {
        Idealisation::Axisymmetric => Vec3::new(0.03 * x.x, -0.05 * x.y, 0.0),
        Idealisation::Space => affine() * x,
        _ => affine() * Vec3::new(x.x, x.y, 0.0),
    }
}

/// 2 × 2 (× 2) boxes of cells over a square (cube) of length 2, every inner node off its place: corners by noise, the
/// others with them.
fn patch(element: Element, space: Idealisation) -> Mesh {
    let radius = match space {
        Idealisation::Axisymmetric => 1.0,
        _ => 0.0,
    };
    grid(element, [2, 2, 2], |x| {
        // products of tents: straight between the corners of the boxes, so that sides stay straight
        let tent = |x: f64| 1.0 - (2.0 * x - 1.0).abs();
        let depth = if element.dim() == 3 { tent(x.z) } else { 1.0 };
        let off = Vec3::new(0.3, -0.22, if element.dim() == 3 { 0.17 } else { 0.0 });
        x * 2.0 + off * (tent(x.x) * tent(x.y) * depth) + Vec3::new(radius, 0.0, 0.0)
    })
}

/// Whether a node lies on the boundary of the patch.
fn outside(space: Idealisation, x: Vec3) -> bool {
    let radius = match space {
        Idealisation::Axisymmetric => 1.0,
        _ => 0.0,
    };
    let ndim = space.ndim();
    let at = [x.x - radius, x.y, x.z];
    at[..ndim]
        .iter()
        .any(|x| x.abs() < 1e-9 || (x - 2.0).abs() < 1e-9)
}

#[test]
fn a_homogeneous_strain_gives_its_stress_everywhere_and_no_force_inside() {
    for (element, space) in elements() {
        let mesh = patch(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for locking in LOCKINGS {
                for integration in [Integration::Full, Integration::Reduced] {
                    let wish = Wish {
                        space,
                        kinematics,
                        locking,
                        integration,
                    };
                    let Ok(body) = body(&mesh, elastic("neo-hookean", 0.3), &wish) else {
                        continue;
                    };
                    let name = element.name();
                    let what = format!("{name} {space:?} {kinematics:?} {locking} {integration:?}");
                    let u = body.field(|x| homogeneous(space, x));
                    let mut work = Work::default();
                    let at = body.assemble(&u, Order::Tangent, &mut work);
                    let scale = at.scale();
                    let ndim = space.ndim();
                    let mut inner = 0;
                    for (node, x) in body.reference.iter().enumerate() {
                        if outside(space, *x) {
                            continue;
                        }
                        inner += 1;
                        for f in &at.force[node * ndim..(node + 1) * ndim] {
                            assert!(f.abs() < 1e-13 * scale, "{what}: {f:e}");
                        }
                    }
                    assert!(inner > 0 || name == "tri3", "{what}");
                    let mut frame = Frame::new(mesh.nnode(), &[mesh.ncell()]);
                    body.solid.report(&body.state(&u), &mut frame).unwrap();
                    let first = frame.cell_stress[0][0];
                    assert!(first.von_mises() > 1.0);
                    for stress in frame.cell_stress[0].iter().chain(&frame.stress) {
                        let off = (*stress - first).to_pairs();
                        assert!(
                            off.iter().all(|d| d.abs() < 1e-11 * 500.0),
                            "{what} {off:?}"
                        );
                    }
                    let strain = frame.cell_strain[0][0];
                    for other in frame.cell_strain[0].iter().chain(&frame.strain) {
                        let off = (*other - strain).to_pairs();
                        assert!(off.iter().all(|d| d.abs() < 1e-12), "{what} {off:?}");
                    }
                    if matches!(space, Idealisation::PlaneStress { .. }) {
                        assert!(first.zz().abs() < 1e-9 && strain.zz().abs() > 1e-3);
                    }
                    if space == Idealisation::Axisymmetric {
                        let hoop = match kinematics {
                            Kinematics::Small => 0.03,
                            Kinematics::Finite => 1.03f64.ln(),
                        };
                        assert!((strain.zz() - hoop).abs() < 1e-13, "{what}");
                    }
                }
            }
        }
    }
}

/// Rank of a symmetric matrix by elimination with full diagonal pivoting.
fn nullity(mut a: Vec<f64>, n: usize) -> usize {
    let size = a.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let mut left: Vec<usize> = (0..n).collect();
    while !left.is_empty() {
        let (place, &k) = left
            .iter()
            .enumerate()
            .max_by(|x, y| a[x.1 * n + x.1].total_cmp(&a[y.1 * n + y.1]))
            .unwrap();
        if a[k * n + k] < 1e-10 * size {
            break;
        }
        left.swap_remove(place);
        for &i in &left {
            let factor = a[i * n + k] / a[k * n + k];
            for &j in &left {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    left.len()
}

#[test]
fn nothing_but_rigid_motion_is_free() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        let rigid = match space {
            Idealisation::Space => 6,
            Idealisation::Axisymmetric => 1,
            _ => 3,
        };
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for locking in LOCKINGS {
                for integration in [Integration::Full, Integration::Reduced] {
                    let wish = Wish {
                        space,
                        kinematics,
                        locking,
                        integration,
                    };
                    let Ok(body) = body(&mesh, elastic("neo-hookean", 0.3), &wish) else {
                        continue;
                    };
                    let n = body.layout.ndof();
                    let u = vec![0.0; n];
                    let at = body.assemble(&u, Order::Tangent, &mut Work::default());
                    let name = element.name();
                    let reduced = integration == Integration::Reduced;
                    // the known modes of reduced integration: one of quad8 in the plane, six of hex20, which do not
                    // spread from one element to the next
                    let spurious = match (name, space) {
                        _ if !reduced => 0,
                        ("quad8", Idealisation::Axisymmetric) => 0,
                        ("quad8", _) => 1,
                        ("hex20", _) => 6,
                        _ => 0,
                    };
                    let free = nullity(at.stiffness, n);
                    let what = format!("{name} {space:?} {kinematics:?} {locking} {integration:?}");
                    assert_eq!(free, rigid + spurious, "{what}");
                }
            }
        }
    }
}
