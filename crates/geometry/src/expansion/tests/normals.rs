//! Which cells have one director.

use super::*;

/// Facets that share an edge along y, at these angles about it in degrees, with these labels.
fn leaves(facets: &[(f64, u64)]) -> Mesh {
    let mut mesh = Mesh::default();
    let a = add_node(&mut mesh, Vec3::ZERO);
    let b = add_node(&mut mesh, Vec3::unit(1));
    for &(degrees, label) in facets {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let out = Vec3::new(cos, 0.0, sin);
        let c = add_node(&mut mesh, out);
        let d = add_node(&mut mesh, out + Vec3::unit(1));
        mesh.push_cell(by_name("quad4").unwrap(), &[a, c, d, b], label);
    }
    mesh
}

/// The angles of the normals at the first node, in degrees, from the vertical.
fn angles(expansion: &Expansion) -> Vec<f64> {
    let at = expansion.directors_at(0).iter();
    at.map(|d| (-d.normal.x).atan2(d.normal.z).to_degrees())
        .collect()
}

fn assert_angles(facets: &[(f64, u64)], expected: &[f64]) {
    let found = angles(&with(&leaves(facets), section(0.1, 0.0)));
    assert_eq!(found.len(), expected.len(), "{facets:?}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(is_close(*found, *expected, 1e-12), "{facets:?}: {found}");
    }
}

#[test]
fn the_order_of_labels_decides_which_normals_join() {
    assert_angles(&[(0.0, 1), (15.0, 2), (30.0, 3)], &[7.5, 30.0]);
    assert_angles(&[(0.0, 2), (15.0, 1), (30.0, 3)], &[15.0]);
    assert_angles(&[(0.0, 3), (15.0, 2), (30.0, 1)], &[22.5, 0.0]);
    // places in the mesh do not matter
    assert_angles(&[(30.0, 3), (0.0, 1), (15.0, 2)], &[7.5, 30.0]);
}

#[test]
fn the_reference_is_a_cell_and_not_the_mean() {
    // 25 is within 20 of the mean of 0 and 12, but not of 0
    assert_angles(&[(0.0, 1), (12.0, 2), (25.0, 3)], &[6.0, 25.0]);
    // the mean is that of unit normals: not weighted, normed
    assert_angles(
        &[(0.0, 1), (0.0, 2), (15.0, 3)],
        &[{
            let (sin, cos) = 15f64.to_radians().sin_cos();
            sin.atan2(2.0 + cos).to_degrees()
        }],
    );
}

#[test]
fn normals_at_the_very_limit_join() {
    for start in [0.0, 13.0, 47.0, 101.0, 250.0] {
        assert_angles(&[(start, 1), (start + 20.0, 2)], &[fold(start + 10.0)]);
        let apart = [fold(start), fold(start + 20.01)];
        assert_angles(&[(start, 1), (start + 20.01, 2)], &apart);
    }
}

fn fold(degrees: f64) -> f64 {
    if degrees > 180.0 {
        degrees - 360.0
    } else {
        degrees
    }
}

#[test]
fn the_angle_can_be_chosen() {
    let mesh = leaves(&[(0.0, 1), (30.0, 2), (75.0, 3)]);
    let given = BTreeMap::new();
    for (degrees, expected) in [(10.0f64, 3), (31.0, 2), (80.0, 1)] {
        let angle = degrees.to_radians();
        let joining = Joining {
            angle,
            given: &given,
        };
        let found = expand(&mesh, &all(&mesh), &[section(0.1, 0.0)], &joining).unwrap();
        assert_eq!(angles(&found).len(), expected);
    }
}

#[test]
fn a_reversed_neighbour_has_a_director_of_its_own() {
    let mut mesh = leaves(&[(0.0, 1), (180.0, 2)]);
    assert_eq!(angles(&with(&mesh, section(0.1, 0.0))).len(), 2);
    mesh.blocks[0].nodes[4..].reverse();
    let together = angles(&with(&mesh, section(0.1, 0.0)));
    assert!(together.len() == 1 && is_close(together[0], 0.0, 1e-12));
}

#[test]
fn thickness_and_offset_must_be_equal_to_join() {
    let mesh = leaves(&[(0.0, 1), (5.0, 2), (10.0, 3)]);
    let given = BTreeMap::new();
    let joining = Joining {
        angle: Joining::ANGLE,
        given: &given,
    };
    let of = |sections: [Section<'_>; 3]| {
        let mut cells = all(&mesh);
        (0..3).for_each(|k| cells[k].section = k);
        let found = expand(&mesh, &cells, &sections, &joining).unwrap();
        assert_is_consistent(&mesh, &found);
        (angles(&found).iter())
            .map(|a| a.round())
            .collect::<Vec<_>>()
    };
    let usual = section(0.1, 0.0);
    // equal values of different sections join
    assert_eq!(of([usual; 3]), [5.0]);
    assert_eq!(of([usual, section(0.2, 0.0), usual]), [5.0, 5.0]);
    assert_eq!(of([usual, section(0.1, 0.5), usual]), [5.0, 5.0]);
    assert_eq!(of([usual, usual, section(0.11, 0.0)]), [3.0, 10.0]);
    let at_nodes = vec![0.1; mesh.nnode()];
    let nodal = Section {
        thickness: 3.0,
        at_nodes: Some(&at_nodes),
        offset: 0.0,
    };
    assert_eq!(of([usual, nodal, usual]), [5.0]);
}

#[test]
fn prescribed_normals_come_first_and_join_within_half_a_degree() {
    let mesh = leaves(&[(0.0, 1), (5.0, 2), (10.0, 3)]);
    let normal = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vec3::new(-sin, 0.0, cos) * 3.0
    };
    let of = |given: &[(u32, f64)]| {
        let entry = |&(index, degrees): &(u32, f64)| {
            let cell = CellId { block: 0, index };
            ((cell, 0), normal(degrees))
        };
        let given = given.iter().map(entry).collect();
        let joining = Joining {
            angle: Joining::ANGLE,
            given: &given,
        };
        let found = expand(&mesh, &all(&mesh), &[section(0.1, 0.0)], &joining).unwrap();
        assert_is_consistent(&mesh, &found);
        assert_eq!(found.directors_at(1).len(), 1);
        angles(&found)
    };
    let assert_is = |given: &[(u32, f64)], expected: &[f64]| {
        let found = of(given);
        assert_eq!(found.len(), expected.len(), "{given:?}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(is_close(*found, *expected, 1e-12), "{given:?}: {found}");
        }
    };
    // the others join among themselves
    assert_is(&[(2, 40.0)], &[40.0, 2.5]);
    assert_is(&[(1, 8.0)], &[8.0, 5.0]);
    // two prescribed ones, together and apart
    assert_is(&[(0, 20.0), (2, 20.4)], &[20.2, 5.0]);
    assert_is(&[(0, 20.0), (2, 20.6)], &[20.0, 20.6, 5.0]);
    // a cell within half a degree joins a prescribed one
    assert_is(&[(0, 4.8)], &[4.9, 10.0]);
    assert_is(&[(0, 4.4)], &[4.4, 7.5]);
    assert_is(&[(0, 1.0), (1, 1.0), (2, 1.0)], &[1.0]);
}

#[test]
fn a_fold_has_knots_and_keeps_its_edges_closed() {
    for (element, _) in ELEMENTS {
        let mut mesh = grid(element, [3, 2], |u, v| Vec3::new(u, v, 0.0));
        let side = mesh.nnode();
        add_grid(&mut mesh, element, [3, 2], |u, v| Vec3::new(0.0, v, -u));
        let fold: Vec<usize> = (0..side).filter(|&n| mesh.points[n].x == 0.0).collect();
        let shell = with(&mesh, section(0.1, 0.0));
        // new nodes in the middles of edges on the fold are knots, too
        let new = if element == "tri3" { 2 } else { 0 };
        assert_eq!(shell.knots.len(), fold.len() + new, "{element}");
        for knot in &shell.knots {
            let directors = &shell.directors[knot.directors.clone()];
            assert_eq!(directors.len(), 2);
            let x = shell.mesh.points[knot.node as usize];
            assert!(is_close(x.x, 0.0, 1e-15) && is_close(x.z, 0.0, 1e-15));
            assert!(is_close(
                directors[0].normal.dot(directors[1].normal),
                0.0,
                1e-14
            ));
            assert_ne!(directors[0].middle, directors[1].middle);
        }
        // the fold is no free edge
        let free = (0..shell.solids.len()).map(|s| shell.free_edges(s).len());
        let per_edge = if element == "quad4" { 1 } else { 2 };
        assert_eq!(free.sum::<usize>(), per_edge * 2 * (3 + 2 + 3), "{element}");
    }
}

#[test]
fn a_wall_on_a_plate_has_one_director_and_the_plate_the_other() {
    for (element, _) in ELEMENTS {
        let mut mesh = grid(element, [4, 2], |u, v| Vec3::new(u - 0.5, v, 0.0));
        add_grid(&mut mesh, element, [2, 2], |u, v| Vec3::new(0.0, v, u));
        let shell = with(&mesh, section(0.05, 0.0));
        assert!(!shell.knots.is_empty());
        for knot in &shell.knots {
            let normals: Vec<f64> = shell.directors[knot.directors.clone()]
                .iter()
                .map(|d| d.normal.z.abs())
                .collect();
            assert_eq!(normals.len(), 2, "{element}");
            assert!(is_close(normals[0], 1.0, 1e-14) && is_close(normals[1], 0.0, 1e-14));
        }
        let exact = 0.05 * 2.0;
        assert!(is_close(total(&shell), exact, 1e-12), "{element}");
    }
}
