//! Cells of several elements next to each other.

use super::super::Place;
use super::*;
use std::f64::consts::TAU;

/// Halves one cell of four nodes.
fn halve(mesh: &mut Mesh, index: usize) {
    let block = &mut mesh.blocks[0];
    let cell: Vec<NodeId> = block.nodes.drain(4 * index..4 * index + 4).collect();
    let label = block.labels.remove(index);
    let tri3 = by_name("tri3").unwrap();
    mesh.push_cell(tri3, &cell[..3], label);
    mesh.push_cell(tri3, &[cell[0], cell[2], cell[3]], 1000 + label);
}

#[test]
fn triangles_among_quadrilaterals_divide_only_their_strips() {
    let mut mesh = grid("quad4", [7, 5], |u, v| Vec3::new(7.0 * u, 5.0 * v, 0.0));
    halve(&mut mesh, 7 * 2 + 3);
    let shell = with(&mesh, section(0.2, 0.0));
    assert!(is_close(total(&shell), 35.0 * 0.2, 1e-12));
    let parts: Vec<usize> = shell.solids.iter().map(Vec::len).collect();
    let count = |n: usize| parts.iter().filter(|&&p| p == n).count();
    // the row and the column of the halved cell in two, its halves in three
    assert_eq!((count(1), count(2), count(3)), (24, 10, 2));
}

#[test]
fn strips_that_cross_divide_a_quadrilateral_in_four() {
    let mut mesh = grid("quad4", [5, 5], |u, v| Vec3::new(5.0 * u, 5.0 * v, u * v));
    halve(&mut mesh, 18);
    halve(&mut mesh, 6);
    let shell = with(&mesh, section(0.02, 0.1));
    let parts: Vec<usize> = shell.solids.iter().map(Vec::len).collect();
    let count = |n: usize| parts.iter().filter(|&&p| p == n).count();
    assert_eq!((count(1), count(2), count(3), count(4)), (9, 12, 4, 2));
}

#[test]
fn a_cell_of_four_nodes_takes_the_middles_of_its_quadratic_neighbours() {
    for (element, per_cell) in [("quad8", 2), ("quad9", 2), ("tri6", 2)] {
        let mut mesh = grid(element, [2, 3], |u, v| Vec3::new(u, v, 0.1 * v * v));
        let before = mesh.nnode();
        add_grid(&mut mesh, "quad4", [4, 3], |u, v| {
            Vec3::new(1.0 + u, v, 0.1 * v * v)
        });
        let shell = with(&mesh, section(0.02, 0.0));
        assert!(shell.knots.is_empty(), "{element}");
        let cells: Vec<CellId> = mesh.cells(2).collect();
        for (cell, solids) in cells.iter().zip(&shell.solids) {
            if mesh.element(*cell).unwrap().nnode() == 4 {
                assert_eq!(solids.len(), per_cell, "{element}");
            }
        }
        // the middles on the common edge are the given ones
        let middle = (0..before).find(|&n| {
            let x = mesh.points[n];
            is_close(x.x, 1.0, 1e-12) && is_close(x.y, 0.5, 1e-12)
        });
        let middle = middle.unwrap() as NodeId;
        let user = |c: &[u32; 4]| {
            c.iter()
                .any(|&d| shell.directors[d as usize].node == middle)
        };
        let on_quad4 = shell.corners.iter().filter(|c| user(c)).count();
        assert!(on_quad4 >= 4, "{element}: {on_quad4}");
    }
}

#[test]
fn middles_on_the_rim_of_a_lid_follow_its_circle() {
    // a cylinder with a flat lid, both of triangles
    let n = 24;
    let mut mesh = grid("tri3", [n, 4], |u, v| {
        Vec3::new((TAU * u).cos(), (TAU * u).sin(), v - 1.0)
    });
    let tri3 = by_name("tri3").unwrap();
    let rim = |mesh: &Mesh, k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        let at = |x: &Vec3| (*x - Vec3::new(cos, sin, 0.0)).norm() < 1e-9;
        mesh.points.iter().position(at).unwrap() as NodeId
    };
    let centre = add_node(&mut mesh, Vec3::ZERO);
    for k in 0..n {
        let nodes = [centre, rim(&mesh, k), rim(&mesh, (k + 1) % n)];
        let label = mesh.ncell() as u64 + 1;
        mesh.push_cell(tri3, &nodes, label);
    }
    let shell = with(&mesh, section(0.02, 0.0));
    assert_eq!(shell.knots.len(), 2 * n as usize);
    let mut worst = 0.0f64;
    for knot in &shell.knots {
        let x = shell.mesh.points[knot.node as usize];
        assert!(is_close(x.z, 0.0, 1e-14));
        worst = worst.max((x.norm() - 1.0).abs());
    }
    let half = TAU / f64::from(2 * n);
    // (E3) on a circle misses it by α⁴/8, a chord by α²/2
    assert!(
        is_close(worst, half.powi(4) / 8.0, 0.1 * half.powi(4)),
        "{worst}"
    );
    for d in &shell.directors {
        let x = shell.mesh.points[d.node as usize];
        if is_close(x.z, 0.0, 1e-14) && x.norm() < 0.9 {
            assert!((d.normal - Vec3::unit(2)).norm() < 1e-12);
        }
    }
}

#[test]
fn flat_triangles_keep_their_edges_straight() {
    let mesh = grid("tri3", [3, 3], |u, v| Vec3::new(u + 0.3 * v, v, 0.0));
    let shell = with(&mesh, section(0.1, 0.0));
    for corners in &shell.corners {
        let [a, middle, centre, other] = corners.map(|d| {
            let node = shell.directors[d as usize].node;
            shell.mesh.points[node as usize]
        });
        // in the parallelogram of a corner the centre is at two thirds of both halves of edges
        let expected = a + ((middle - a) + (other - a)) * (2.0 / 3.0);
        assert!((centre - expected).norm() < 1e-15);
    }
}

#[test]
fn a_jump_of_thickness_or_a_reversed_half_does_not_change_the_surface() {
    let n = 12;
    let mesh = grid("tri3", [n, n], |u, v| {
        let (a, b) = (1.2 * (u - 0.5), v - 0.5);
        Vec3::new(a.sin() * b.cos(), b.sin(), a.cos() * b.cos())
    });
    let plain = with(&mesh, section(0.02, 0.1));
    let nsurface = mesh.nnode() + plain.places.len();
    let given = BTreeMap::new();
    let joining = Joining {
        angle: Joining::ANGLE,
        given: &given,
    };
    let mut cells = all(&mesh);
    let half = cells.len() / 2;
    cells[half..].iter_mut().for_each(|cell| cell.section = 1);
    let sections = [section(0.02, 0.1), section(0.03, 0.1)];
    let jump = expand(&mesh, &cells, &sections, &joining).unwrap();
    assert_is_consistent(&mesh, &jump);
    let mut reversed = mesh.clone();
    reversed.blocks[0].nodes[3 * half..]
        .chunks_mut(3)
        .for_each(|cell| cell.swap(1, 2));
    let reversed = with(&reversed, section(0.02, 0.1));
    for other in [jump, reversed] {
        // one knot for each node on the line, new ones with them
        assert_eq!(other.knots.len(), 2 * n as usize + 1);
        let surfaces = [&plain, &other].map(|e| &e.mesh.points[mesh.nnode()..nsurface]);
        let (mut a, mut b) = (surfaces[0].to_vec(), surfaces[1].to_vec());
        let order = |x: &Vec3, y: &Vec3| {
            let key = |x: &Vec3| x.to_array().map(|x| (x * 1e9).round() as i64);
            key(x).cmp(&key(y))
        };
        a.sort_by(order);
        b.sort_by(order);
        for (a, b) in a.iter().zip(&b) {
            assert!((*a - *b).norm() < 1e-12);
        }
    }
}

#[test]
fn new_nodes_of_the_surface_are_known_by_their_place() {
    for (element, _) in ELEMENTS {
        let mesh = grid(element, [3, 2], |u, v| Vec3::new(u, v + 0.2 * u, 0.0));
        let shell = with(&mesh, section(0.1, 0.0));
        let expected = match element {
            // edges, and centres
            "tri3" => 3 * 3 + 4 * 2 + 6 + 12,
            "tri6" => 12,
            "quad8" => 6,
            _ => 0,
        };
        assert_eq!(shell.places.len(), expected, "{element}");
        let at = |n: usize| shell.mesh.points[n];
        for (k, &place) in shell.places.iter().enumerate() {
            let middle = match place {
                Place::Edge(ends) => {
                    let [a, b] = ends.map(|n| at(n as usize));
                    (a + b) * 0.5
                }
                Place::Cell(shell) => {
                    let cell = mesh.cell(all(&mesh)[shell].cell);
                    let n = mesh.blocks[0].element.ncorner();
                    let corners = cell[..n].iter().map(|&n| at(n as usize));
                    corners.sum::<Vec3>() / n as f64
                }
            };
            assert!((at(mesh.nnode() + k) - middle).norm() < 1e-14, "{element}");
        }
    }
}
