//! Constant strain is reproduced, and nothing but rigid motion is free.

use super::*;

/// The patch: an element's own reference domain, cut into a few distorted cells around inner nodes. Here one element is
/// split by moving its nodes, all but the corners, off their places: what remains of a patch test for a single cell is
/// that the forces of a homogeneous stress are those of its boundary.
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

/// A grid of cells with every inner node off its place: 2 × 2 (× 2) boxes, each one hexahedron or quadrilateral, or cut
/// into simplices or wedges.
fn patch(element: Element, space: Idealisation) -> Mesh {
    let ndim = element.dim();
    let mut mesh = Mesh::default();
    let radius = match space {
        Idealisation::Axisymmetric => 1.0,
        _ => 0.0,
    };
    let simplex = [
        vec![[0, 1, 2, 9], [0, 2, 3, 9]],
        // six tetrahedra round the diagonal 0-6 of a box
        vec![
            [0, 1, 2, 6],
            [0, 2, 3, 6],
            [0, 3, 7, 6],
            [0, 7, 4, 6],
            [0, 4, 5, 6],
            [0, 5, 1, 6],
        ],
    ];
    let corner_of = |k: usize| {
        let ring = [[0, 0], [1, 0], [1, 1], [0, 1]][k % 4];
        [ring[0], ring[1], k / 4]
    };
    // corners of the sub-cells of a box
    let name = element.name();
    let parts: Vec<Vec<usize>> = if name.starts_with("tri") {
        simplex[0].iter().map(|t| t[..3].to_vec()).collect()
    } else if name.starts_with("tet") {
        simplex[1].iter().map(|t| t.to_vec()).collect()
    } else if name.starts_with("wedge") {
        vec![vec![0, 1, 2, 4, 5, 6], vec![0, 2, 3, 4, 6, 7]]
    } else {
        vec![(0..1 << ndim).collect()]
    };
    let linear = element::TABLE.iter().find(|e| {
        e.dim() == ndim && e.nnode() == parts[0].len() && e.sides().len() == element.sides().len()
    });
    let linear = linear.unwrap();
    let mut shape = vec![0.0; linear.nnode()];
    let depth = if ndim == 3 { 2 } else { 1 };
    for cell in 0..4 * depth {
        let origin = [cell % 2, cell / 2 % 2, cell / 4];
        for part in &parts {
            let corners: Vec<Vec3> = part
                .iter()
                .map(|&k| {
                    let at = corner_of(k);
                    let grid = [0, 1, 2].map(|a| origin[a] + at[a]);
                    let mut x = Vec3::from(grid.map(|g| g as f64));
                    let code = grid[0] + 3 * grid[1] + 9 * grid[2];
                    for axis in 0..ndim {
                        if grid[axis] == 1 {
                            x[axis] += 0.15 * noise(3 * code + axis);
                        }
                    }
                    x + Vec3::new(radius, 0.0, 0.0)
                })
                .collect();
            let nodes: Vec<u32> = element
                .nodes()
                .iter()
                .map(|xi| {
                    linear.shape(xi, &mut shape);
                    let at: Vec3 = corners.iter().zip(&shape).map(|(x, n)| *x * *n).sum();
                    let found = mesh.points.iter().position(|x| (*x - at).norm() < 1e-9);
                    found.unwrap_or_else(|| {
                        mesh.points.push(at);
                        mesh.node_labels.push(mesh.points.len() as u64);
                        mesh.points.len() - 1
                    }) as u32
                })
                .collect();
            let label = mesh.ncell() as u64 + 1;
            mesh.push_cell(element, &nodes, label);
        }
    }
    mesh
}

/// Whether a node lies on the boundary of the patch.
fn outside(space: Idealisation, x: Vec3) -> bool {
    let radius = match space {
        Idealisation::Axisymmetric => 1.0,
        _ => 0.0,
    };
    let ndim = space.ndim();
    let at = [x.x - radius, x.y, x.z];
    at[..ndim].iter().any(|x| x.abs() < 1e-9 || (x - 2.0).abs() < 1e-9)
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
                        assert!(off.iter().all(|d| d.abs() < 1e-11 * 500.0), "{what} {off:?}");
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
