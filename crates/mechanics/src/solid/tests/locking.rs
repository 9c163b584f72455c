//! What remedies are for.

use super::*;
use std::collections::{BTreeMap, BTreeSet};

/// A box of `n[0] × n[1] (× n[2])` cells of an element over the unit square (cube), mapped.
pub(super) fn grid(element: Element, n: [usize; 3], map: impl Fn(Vec3) -> Vec3) -> Mesh {
    let ndim = element.dim();
    let name = element.name();
    let parts: Vec<Vec<usize>> = if name.starts_with("tri") {
        vec![vec![0, 1, 2], vec![0, 2, 3]]
    } else if name.starts_with("tet") {
        let six = [
            [0, 1, 2, 6],
            [0, 2, 3, 6],
            [0, 3, 7, 6],
            [0, 7, 4, 6],
            [0, 4, 5, 6],
            [0, 5, 1, 6],
        ];
        six.iter().map(|t| t.to_vec()).collect()
    } else if name.starts_with("wedge") {
        vec![vec![0, 1, 2, 4, 5, 6], vec![0, 2, 3, 4, 6, 7]]
    } else {
        vec![(0..1 << ndim).collect()]
    };
    let linear = element::TABLE
        .iter()
        .find(|e| {
            let alike = e.sides().len() == element.sides().len();
            e.dim() == ndim && e.nnode() == parts[0].len() && alike
        })
        .unwrap();
    let mut shape = vec![0.0; linear.nnode()];
    let mut mesh = Mesh::default();
    let mut known: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let depth = if ndim == 3 { n[2] } else { 1 };
    for cell in 0..n[0] * n[1] * depth {
        let origin = [cell % n[0], cell / n[0] % n[1], cell / n[0] / n[1]];
        for part in &parts {
            let corner = |&k: &usize| {
                let ring = [[0, 0], [1, 0], [1, 1], [0, 1]][k % 4];
                let at = [ring[0], ring[1], k / 4];
                Vec3::from([0, 1, 2].map(|a| (origin[a] + at[a]) as f64 / n[a] as f64))
            };
            let corners: Vec<Vec3> = part.iter().map(corner).collect();
            let node = |xi: &Vec3| {
                linear.shape(xi, &mut shape);
                let at: Vec3 = corners.iter().zip(&shape).map(|(x, n)| *x * *n).sum();
                let key = at.to_array().map(|x| (x * 1e6).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    mesh.points.push(map(at));
                    mesh.node_labels.push(mesh.points.len() as u64);
                    mesh.points.len() as u32 - 1
                })
            };
            let nodes: Vec<u32> = element.nodes().iter().map(node).collect();
            let label = mesh.ncell() as u64 + 1;
            mesh.push_cell(element, &nodes, label);
        }
    }
    mesh
}

/// Solves a dense symmetric positive definite system in its band, as numbered.
fn solve(mut k: Vec<f64>, mut f: Vec<f64>) -> Vec<f64> {
    let n = f.len();
    let reach: Vec<usize> = (0..n)
        .map(|i| (i..n).rev().find(|&j| k[i * n + j] != 0.0).unwrap_or(i))
        .collect();
    let mut last = 0;
    for i in 0..n {
        last = reach[i].max(last);
        let (upper, lower) = k.split_at_mut((i + 1) * n);
        let pivot = &upper[i * n..];
        for j in i + 1..=last {
            let row = &mut lower[(j - i - 1) * n..][..n];
            let factor = row[i] / pivot[i];
            if factor != 0.0 {
                for c in i..=last {
                    row[c] -= factor * pivot[c];
                }
                f[j] -= factor * f[i];
            }
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| k[i * n + j] * f[j]).sum();
        f[i] = (f[i] - known) / k[i * n + i];
    }
    f
}

/// One Newton step from zero with some dofs prescribed: the linear solution.
fn linear_solution(body: &Body, prescribed: &[Option<f64>], load: &[f64]) -> Vec<f64> {
    let n = body.layout.ndof();
    let zero = vec![0.0; n];
    let at = body.assemble(&zero, Order::Tangent, &mut Work::default());
    let free: Vec<usize> = (0..n).filter(|&i| prescribed[i].is_none()).collect();
    let mut u: Vec<f64> = prescribed.iter().map(|p| p.unwrap_or(0.0)).collect();
    let k: Vec<f64> = free
        .iter()
        .flat_map(|&i| free.iter().map(move |&j| (i, j)))
        .map(|(i, j)| at.stiffness[i * n + j])
        .collect();
    let rhs = |&i: &usize| {
        let moved: f64 = (0..n).map(|j| at.stiffness[i * n + j] * u[j]).sum();
        load[i] - moved
    };
    let f: Vec<f64> = free.iter().map(rhs).collect();
    for (&i, value) in free.iter().zip(solve(k, f)) {
        u[i] = value;
    }
    u
}

/// Cook's membrane in plane strain, sheared by 1/16 per length along its right side: how far the upper right corner
/// rises.
fn cook(name: &str, locking: Locking, integration: Integration, n: usize, nu: f64) -> f64 {
    let element = element::by_name(name).unwrap();
    let mesh = grid(element, [n, n, 1], |x| {
        let (low, high) = (44.0 * x.x, 44.0 + 16.0 * x.x);
        Vec3::new(48.0 * x.x, low + (high - low) * x.y, 0.0)
    });
    let law = (TABLE[0].make)(&Constants::elastic(1.0, nu)).unwrap();
    let wish = Wish {
        locking,
        integration,
        ..Wish::plain(
            Idealisation::PlaneStrain { thickness: 1.0 },
            Kinematics::Small,
        )
    };
    let body = body(&mesh, law, &wish).unwrap();
    let ndof = body.layout.ndof();
    let mut prescribed = vec![None; ndof];
    let mut load = vec![0.0; ndof];
    let mut edge: Vec<usize> = Vec::new();
    for (node, x) in mesh.points.iter().enumerate() {
        if x.x.abs() < 1e-9 {
            prescribed[2 * node] = Some(0.0);
            prescribed[2 * node + 1] = Some(0.0);
        } else if (x.x - 48.0).abs() < 1e-9 {
            edge.push(node);
        }
    }
    edge.sort_by(|&a, &b| mesh.points[a].y.total_cmp(&mesh.points[b].y));
    // Simpson's weights where sides have mid nodes
    let quadratic = edge.len() == 2 * n + 1;
    for (k, &node) in edge.iter().enumerate() {
        let end = if k == 0 || k == edge.len() - 1 {
            0.5
        } else {
            1.0
        };
        let share = match (quadratic, k % 2) {
            (true, 1) => 4.0 / 6.0 / n as f64,
            (true, _) => 2.0 * end / 6.0 / n as f64,
            (false, _) => end / n as f64,
        };
        load[2 * node + 1] = share;
    }
    let u = linear_solution(&body, &prescribed, &load);
    u[2 * edge[edge.len() - 1] + 1]
}

#[test]
fn remedies_free_cooks_membrane_of_a_nearly_incompressible_material() {
    let nu = 0.4999;
    let reference = cook("quad9", Locking::BBar, Integration::Full, 12, nu);
    for (name, locking, integration, n) in [
        ("quad4", Locking::BBar, Integration::Full, 16),
        ("quad4", Locking::Incompatible, Integration::Full, 16),
        ("tri6", Locking::BBar, Integration::Full, 8),
        ("quad8", Locking::BBar, Integration::Full, 8),
        ("quad8", Locking::None, Integration::Reduced, 8),
        ("quad9", Locking::BBar, Integration::Full, 8),
    ] {
        let cured = cook(name, locking, integration, n, nu);
        let locked = cook(name, Locking::None, Integration::Full, n, nu);
        println!(
            "{name} {locking} {integration:?}: {cured:.4}, without {locked:.4}, {reference:.4}"
        );
        let (left, before) = ((cured - reference).abs(), (locked - reference).abs());
        assert!(
            left < 0.6 * before && left < 0.04 * reference,
            "{name} {locking}: {cured}"
        );
    }
    let locked = cook("quad4", Locking::None, Integration::Full, 16, nu);
    assert!(
        locked < 0.5 * reference,
        "a membrane that does not lock proves nothing: {locked}"
    );
}

/// u = (∂ψ/∂y, −∂ψ/∂x, 0), ψ = sin x sin y · cos z: div u = 0, and −μ Δu balances the body force.
fn flow(x: Vec3, ndim: usize) -> Vec3 {
    let depth = if ndim == 3 { x.z.cos() } else { 1.0 };
    Vec3::new(x.x.sin() * x.y.cos(), -x.x.cos() * x.y.sin(), 0.0) * depth
}

/// Errors against a smooth flow without divergence, `u = rot ψ`, with pressure `p` of its own:
/// displacement in the mean, pressure in the mean.
fn errors(name: &str, locking: Locking, integration: Integration, n: usize) -> [f64; 2] {
    let element = element::by_name(name).unwrap();
    let skew = |x: Vec3| x + Vec3::new(0.1 * x.y * (1.0 - x.y) * 2.0, 0.08 * x.x, 0.0);
    let mesh = grid(element, [n, n, n], |x| {
        if element.dim() == 3 { x } else { skew(x) }
    });
    let nu = 0.49999;
    let law = (TABLE[0].make)(&Constants::elastic(3.0, nu)).unwrap();
    let space = match element.dim() {
        2 => Idealisation::PlaneStrain { thickness: 1.0 },
        _ => Idealisation::Space,
    };
    let wish = Wish {
        locking,
        integration,
        ..Wish::plain(space, Kinematics::Small)
    };
    let body = body(&mesh, law, &wish).unwrap();
    let ndim = element.dim();
    let exact = |x: Vec3| flow(x, ndim);
    let pressure = |x: Vec3| x.x * x.x - x.y;
    let mu = 3.0 / (2.0 * (1.0 + nu));
    let force = |x: Vec3| {
        // −μ Δu − ∇p with σ = p I + 2 μ ε
        exact(x) * (mu * ndim as f64) - Vec3::new(2.0 * x.x, -1.0, 0.0)
    };
    let mut load = vec![0.0; body.layout.ndof()];
    let rule = fine_rule(element);
    let mut shape = vec![0.0; element.nnode()];
    let mut dshape = vec![Vec3::ZERO; element.nnode()];
    let mut integrate = |cell: &[u32], take: &mut dyn FnMut(f64, Vec3, &[f64])| {
        for (xi, weight) in rule.iter() {
            element.shape(xi, &mut shape);
            element.dshape(xi, &mut dshape);
            let mut rows = Mat3::ZERO;
            let mut at = Vec3::ZERO;
            for (&node, (n, dn)) in cell.iter().zip(shape.iter().zip(&dshape)) {
                let x = mesh.points[node as usize];
                at += x * *n;
                (0..3).for_each(|a| rows.rows[a] += x * dn[a]);
            }
            if ndim == 2 {
                rows.rows[2] = Vec3::unit(2);
            }
            take(weight * rows.determinant(), at, &shape);
        }
    };
    let cells: Vec<&[u32]> = mesh.blocks[0].nodes.chunks_exact(element.nnode()).collect();
    for cell in &cells {
        integrate(cell, &mut |w, x, shape| {
            let f = force(x);
            for (&node, n) in cell.iter().zip(shape) {
                for axis in 0..ndim {
                    load[node as usize * ndim + axis] += w * n * f[axis];
                }
            }
        });
    }
    let mut prescribed = vec![None; body.layout.ndof()];
    for node in on_boundary(element, &cells) {
        let u = exact(mesh.points[node as usize]);
        for axis in 0..ndim {
            prescribed[node as usize * ndim + axis] = Some(u[axis]);
        }
    }
    let u = linear_solution(&body, &prescribed, &load);
    let mut frame = Frame::new(mesh.nnode(), &[mesh.ncell()]);
    body.solid.report(&body.state(&u), &mut frame).unwrap();
    // with displacements given all round, the pressure is known but for a constant
    let mean: Vec<f64> = frame.cell_stress[0]
        .iter()
        .map(|s| s.trace() / 3.0)
        .collect();
    let (mut off, mut volumes, mut level) = (0.0, 0.0, 0.0);
    let mut exact_means = Vec::new();
    for (cell, p) in cells.iter().zip(&mean) {
        let (mut volume, mut sum) = (0.0, 0.0);
        integrate(cell, &mut |w, x, shape| {
            let mut value = Vec3::ZERO;
            for (&node, n) in cell.iter().zip(shape) {
                for axis in 0..ndim {
                    value[axis] += n * u[node as usize * ndim + axis];
                }
            }
            off += w * (value - exact(x)).norm_squared();
            volume += w;
            sum += w * pressure(x);
        });
        exact_means.push((sum / volume, volume));
        level += volume * p - sum;
        volumes += volume;
    }
    let level = level / volumes;
    let wrong: f64 = exact_means
        .iter()
        .zip(&mean)
        .map(|((e, v), p)| v * (p - level - e).powi(2))
        .sum();
    [(off / volumes).sqrt(), (wrong / volumes).sqrt()]
}

/// Nodes of sides that belong to one cell only.
fn on_boundary(element: Element, cells: &[&[u32]]) -> BTreeSet<u32> {
    let mut uses: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
    for cell in cells {
        for side in element.sides() {
            let mut nodes: Vec<u32> = side.nodes.iter().map(|&i| cell[i]).collect();
            nodes.sort_unstable();
            *uses.entry(nodes).or_default() += 1;
        }
    }
    let outer = uses.into_iter().filter(|(_, n)| *n == 1);
    outer.flat_map(|(nodes, _)| nodes).collect()
}

/// A rule that leaves no doubt about loads and norms.
fn fine_rule(element: Element) -> &'static element::quadrature::Rule {
    use element::quadrature as q;
    match (element.dim(), element.sides().len()) {
        (2, 3) => &q::TRI_6,
        (2, _) => &q::QUAD_9,
        (_, 4) => &q::TET_14,
        (_, 5) => &q::WEDGE_9,
        _ => &q::HEX_27,
    }
}

#[test]
#[ignore = "a survey: prints orders of convergence"]
fn measure_orders_of_convergence() {
    for (name, sizes) in [
        ("quad4", [4, 8, 16]),
        ("tri6", [4, 8, 16]),
        ("quad8", [4, 8, 16]),
        ("quad9", [4, 8, 14]),
        ("hex8", [2, 4, 6]),
        ("tet10", [1, 2, 3]),
        ("wedge15", [1, 2, 3]),
        ("hex20", [1, 2, 4]),
        ("hex27", [1, 2, 3]),
    ] {
        for (locking, integration) in [
            (Locking::None, Integration::Full),
            (Locking::BBar, Integration::Full),
            (Locking::None, Integration::Reduced),
        ] {
            if integration == Integration::Reduced && !["quad8", "hex20"].contains(&name) {
                continue;
            }
            let errors = sizes.map(|n| errors(name, locking, integration, n));
            let last = (sizes[2] as f64 / sizes[1] as f64).ln();
            let order = |k: usize| (errors[1][k] / errors[2][k]).ln() / last;
            println!(
                "{name:8} {locking:8} {integration:?}: u {:.2e} order {:.2}, p {:.2e} order {:.2}",
                errors[2][0],
                order(0),
                errors[2][1],
                order(1)
            );
        }
    }
}

/// A rectangle bent by `u = xy`, with `ν = 0`: its energy is that of `ε_xx = y`, and with the shear strains at all points
/// that of `ε_xy = x/2`, too.
#[test]
fn a_rectangle_bends_without_shear_where_that_is_the_one_of_the_centre() {
    let quad4 = element::by_name("quad4").unwrap();
    let (a, b, young) = (2.0, 0.5, 500.0);
    let mesh = grid(quad4, [1, 1, 1], |x| {
        Vec3::new(a * (2.0 * x.x - 1.0), b * (2.0 * x.y - 1.0), 0.0)
    });
    let energy = |locking| {
        let wish = Wish {
            locking,
            ..Wish::plain(
                Idealisation::PlaneStress { thickness: 1.0 },
                Kinematics::Small,
            )
        };
        let body = body(&mesh, elastic("linear-elastic", 0.0), &wish).unwrap();
        let u = body.field(|x| Vec3::new(x.x * x.y, 0.0, 0.0));
        body.energy(&u, &mut Work::default())
    };
    // ½ E ∫ y² dA, and ½ G ∫ x² dA
    let (bending, shear) = (
        0.5 * young * 2.0 * a * 2.0 * b * b * b / 3.0,
        0.25 * young * 2.0 * b * 2.0 * a * a * a / 3.0,
    );
    let close =
        |energy: f64, wanted: f64| assert!((energy / wanted - 1.0).abs() < 1e-12, "{energy}");
    close(energy(Locking::Shear), bending);
    close(energy(Locking::None), bending + shear);
}

#[test]
fn nine_points_of_a_wedge_are_those_of_six_where_it_is_a_prism() {
    let wedge6 = element::by_name("wedge6").unwrap();
    let stiffness = |twist: f64, integration| {
        let mut mesh = Mesh::default();
        for (k, xi) in wedge6.nodes().iter().enumerate() {
            let (sin, cos) = (twist * xi.z).sin_cos();
            let x = Vec3::new(cos * xi.x - sin * xi.y, sin * xi.x + cos * xi.y, xi.z);
            mesh.points.push(x);
            mesh.node_labels.push(k as u64 + 1);
        }
        mesh.push_cell(wedge6, &[0, 1, 2, 3, 4, 5], 1);
        let wish = Wish {
            integration,
            ..Wish::plain(Idealisation::Space, Kinematics::Small)
        };
        let body = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
        let u = vec![0.0; body.layout.ndof()];
        body.assemble(&u, Order::Tangent, &mut Work::default())
            .stiffness
    };
    let apart = |twist: f64| {
        let [six, nine] = [Integration::Full, Integration::Raised].map(|i| stiffness(twist, i));
        let largest = six.iter().fold(0.0f64, |m, k| m.max(k.abs()));
        let differences = six.iter().zip(&nine).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max) / largest
    };
    assert!(apart(0.0) < 1e-13);
    assert!(apart(0.3) > 1e-4);
}
