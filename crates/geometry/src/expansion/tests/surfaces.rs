//! Plates, cylinders and spheres against closed forms.

use super::*;
use crate::mesh::Face;
use crate::random::Random;
use std::f64::consts::{PI, TAU};
use std::time::Instant;

/// A plate of 3 by 2 whose cells are distorted.
fn plate(u: f64, v: f64) -> Vec3 {
    let bump = u * (1.0 - u) * v * (1.0 - v);
    Vec3::new(3.0 * u + 1.1 * bump, 2.0 * v - 0.7 * bump, 0.0)
}

/// A cylinder of radius 2 and length 3, without ends: there the normal is that of the last facet.
fn cylinder(u: f64, v: f64) -> Vec3 {
    let angle = TAU * u;
    Vec3::new(2.0 * angle.sin(), 3.0 * v, 2.0 * angle.cos())
}

/// A part of the unit sphere, without a pole.
fn sphere(u: f64, v: f64) -> Vec3 {
    let (a, b) = (1.2 * (u - 0.5), 1.0 * (v - 0.5));
    Vec3::new(a.sin() * b.cos(), b.sin(), a.cos() * b.cos())
}

#[test]
fn a_plate_has_its_volume_and_flat_faces_whatever_the_element() {
    for (element, parts) in ELEMENTS {
        let mesh = grid(element, [4, 3], plate);
        for offset in [0.0, 0.5, -0.5, 0.2] {
            let plate = with(&mesh, section(0.3, offset));
            assert!(plate.solids.iter().all(|s| s.len() == parts), "{element}");
            assert!(plate.knots.is_empty());
            assert!(is_close(total(&plate), 3.0 * 2.0 * 0.3, 1e-12), "{element}");
            for d in &plate.directors {
                assert!((d.normal - Vec3::unit(2)).norm() < 1e-14);
                let height = |node: NodeId| plate.mesh.points[node as usize].z;
                // at +0.5 the nodes lie on the positive face
                assert!(is_close(height(d.positive), 0.3 * (0.5 - offset), 1e-15));
                assert!(is_close(height(d.negative), -0.3 * (0.5 + offset), 1e-15));
            }
            for (shell, solids) in plate.solids.iter().enumerate() {
                let label = mesh.cell_label(all(&mesh)[shell].cell);
                assert!(solids.iter().all(|&s| plate.mesh.cell_label(s) == label));
            }
        }
    }
}

#[test]
fn volumes_of_cylinders_approach_the_closed_form_by_their_order() {
    for (element, _) in ELEMENTS {
        for offset in [0.0, 0.5, -0.5] {
            // the middle surface moves against the normal, which points outwards
            let radius = 2.0 - 0.4 * offset;
            let exact = TAU * radius * 0.4 * 3.0;
            let error = [24, 48].map(|n| {
                let mesh = grid(element, [n, 2], cylinder);
                let shell = with(&mesh, section(0.4, offset));
                assert!(shell.knots.is_empty());
                (total(&shell) - exact).abs() / exact
            });
            assert!(error[1] < 4e-3, "{element}: {error:?}");
            // O(h²)
            assert!(error[1] < 0.3 * error[0], "{element}: {error:?}");
        }
    }
}

#[test]
fn a_closed_sphere_of_triangles_has_its_positive_face_outside() {
    for element in ["tri3", "tri6"] {
        let mut mesh = Mesh::default();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                add_grid(&mut mesh, element, [8, 8], |u, v| {
                    let mut x = Vec3::ZERO;
                    x[axis] = side;
                    // tangents of equal angles
                    x[(axis + 1) % 3] = (0.25 * PI * (2.0 * u - 1.0)).tan() * side;
                    x[(axis + 2) % 3] = (0.25 * PI * (2.0 * v - 1.0)).tan();
                    x.normalized().unwrap()
                });
            }
        }
        let shell = with(&mesh, section(0.1, 0.0));
        assert!(shell.knots.is_empty());
        for d in &shell.directors {
            let radius = |node: NodeId| shell.mesh.points[node as usize].norm();
            assert!(radius(d.positive) > 1.045 && radius(d.negative) < 0.955);
        }
        let exact = 4.0 / 3.0 * PI * (1.05f64.powi(3) - 0.95f64.powi(3));
        let error = (total(&shell) / exact - 1.0).abs();
        assert!(error < 4e-3, "{element}: {error}");
        assert!((0..shell.solids.len()).all(|s| shell.free_edges(s).is_empty()));
    }
}

#[test]
fn edge_middles_of_triangles_lie_closer_to_a_sphere_by_an_order() {
    // edges inside: on the boundary normals are one-sided
    let error = |n: u32| {
        let mesh = grid("tri3", [n, n], sphere);
        let shell = with(&mesh, section(0.01, 0.0));
        let off = |x: Vec3| (x.norm() - 1.0).abs();
        let is_inside = |x: Vec3| {
            let (a, b) = (x.x.atan2(x.z), x.y.asin());
            a.abs() < 0.3 && b.abs() < 0.25
        };
        let (mut bent, mut centre, mut flat) = (0.0f64, 0.0f64, 0.0f64);
        for (solids, cell) in shell.solids.iter().zip(mesh.cells(2)) {
            let corners = [0, 1, 2].map(|k| mesh.points[mesh.cell(cell)[k] as usize]);
            if !corners.into_iter().all(is_inside) {
                continue;
            }
            for (k, &solid) in solids.iter().enumerate() {
                let from = shell.solids[..cell.index as usize].iter().flatten().count();
                let at = shell.corners[from + k].map(|d| shell.directors[d as usize].node);
                let [_, middle, inside, _] = at.map(|n| shell.mesh.points[n as usize]);
                bent = bent.max(off(middle));
                centre = centre.max(off(inside));
                flat = flat.max(off((corners[k] + corners[(k + 1) % 3]) * 0.5));
                assert!(volume(&shell.mesh, solid) > 0.0);
            }
        }
        [bent, centre, flat]
    };
    let errors = [8, 16, 32].map(error);
    for pair in errors.windows(2) {
        let ratio = [0, 1, 2].map(|k| pair[0][k] / pair[1][k]);
        assert!(ratio[2] < 5.0, "flat: {errors:?}");
        assert!(ratio[0] > 8.0 && ratio[1] > 8.0, "{errors:?}");
    }
    assert!(errors[2][0] < 0.02 * errors[2][2], "{errors:?}");
}

#[test]
fn quadratic_surfaces_keep_their_shape_and_normals() {
    let height = |x: f64, y: f64| 0.3 * x * x - 0.2 * x * y + 0.15 * y * y + 0.1 * x;
    for element in ["tri6", "quad8", "quad9"] {
        let mesh = grid(element, [3, 2], |u, v| Vec3::new(u, v, height(u, v)));
        let shell = with(&mesh, section(0.02, 0.0));
        assert!(shell.directors.len() >= 35);
        for d in &shell.directors {
            let x = shell.mesh.points[d.node as usize];
            assert!(is_close(x.z, height(x.x, x.y), 1e-14), "{element}");
            let slope = [
                0.6 * x.x - 0.2 * x.y + 0.1, //
                -0.2 * x.x + 0.3 * x.y,
            ];
            let normal = Vec3::new(-slope[0], -slope[1], 1.0).normalized().unwrap();
            assert!((d.normal - normal).norm() < 1e-13, "{element}");
        }
    }
}

#[test]
fn a_rotated_model_has_the_rotated_expansion() {
    let mut random = Random(5);
    for (element, _) in ELEMENTS {
        let mut mesh = grid(element, [5, 4], sphere);
        // a wall that stands on it
        add_grid(&mut mesh, element, [5, 2], |u, v| {
            sphere(u, 0.5) * (1.0 + 0.5 * v)
        });
        let section = section(0.05, 0.3);
        let still = with(&mesh, section);
        assert!(!still.knots.is_empty());
        let rotation = Mat3::rotation(random.vector() * 2.0);
        let shift = random.vector();
        let mut turned = mesh.clone();
        turned
            .points
            .iter_mut()
            .for_each(|x| *x = rotation * *x + shift);
        let turned = with(&turned, section);
        assert_eq!(still.corners, turned.corners);
        assert_eq!(still.knots, turned.knots);
        assert_eq!(still.mesh.blocks, turned.mesh.blocks);
        for (a, b) in still.mesh.points.iter().zip(&turned.mesh.points) {
            assert!((rotation * *a + shift - *b).norm() < 1e-13, "{element}");
        }
    }
}

#[test]
fn a_reversed_shell_has_both_faces_exchanged() {
    for element in ["tri3", "quad4"] {
        let mesh = grid(element, [5, 4], sphere);
        let mut back = mesh.clone();
        let block = &mut back.blocks[0];
        let n = block.element.nnode();
        block.nodes.chunks_mut(n).for_each(<[NodeId]>::reverse);
        let [front, back] = [(&mesh, 0.2), (&back, -0.2)].map(|(m, o)| with(m, section(0.1, o)));
        for d in &front.directors {
            let x = |e: &Expansion, n: NodeId| e.mesh.points[n as usize];
            let at = x(&front, d.node);
            let same = |b: &&super::super::Director| (x(&back, b.node) - at).norm() < 1e-12;
            let other = back.directors.iter().find(same).unwrap();
            assert!((x(&front, d.positive) - x(&back, other.negative)).norm() < 1e-12);
            assert!((x(&front, d.negative) - x(&back, other.positive)).norm() < 1e-12);
        }
    }
}

#[test]
fn thickness_at_nodes_replaces_the_number_where_it_is_given() {
    for (element, _) in ELEMENTS {
        let mesh = grid(element, [4, 3], plate);
        let at = |x: Vec3| 0.1 + 0.02 * x.x + 0.03 * x.y;
        let thickness: Vec<f64> = mesh.points.iter().map(|&x| at(x)).collect();
        let linear = Section {
            thickness: -1.0,
            at_nodes: Some(&thickness),
            offset: 0.5,
        };
        let shell = with(&mesh, linear);
        assert!(shell.knots.is_empty(), "{element}");
        for d in &shell.directors {
            let x = shell.mesh.points[d.node as usize];
            // inside distorted cells positions are interpolated as thicknesses are
            let expected = if (d.node as usize) < mesh.nnode() {
                thickness[d.node as usize]
            } else {
                at(x)
            };
            assert!(is_close(d.thickness, expected, 1e-14), "{element}");
        }
        // where there is none the number stays
        let mut thickness = thickness;
        thickness.truncate(3);
        thickness[1] = f64::NAN;
        let some = Section {
            thickness: 0.4,
            at_nodes: Some(&thickness),
            offset: 0.0,
        };
        let shell = with(&mesh, some);
        let found: Vec<f64> = (0..mesh.nnode() as NodeId)
            .map(|n| shell.directors_at(n)[0].thickness)
            .collect();
        assert_eq!(found[..3], [thickness[0], 0.4, thickness[2]]);
        assert!(found[3..].iter().all(|&t| t == 0.4));
    }
}

#[test]
fn a_wedge_of_linear_thickness_has_its_volume() {
    // over rectangles the volume between the faces is that under a plane
    for (element, _) in ELEMENTS {
        let mesh = grid(element, [4, 3], |u, v| Vec3::new(3.0 * u, 2.0 * v, 0.0));
        let at = |x: Vec3| 0.1 + 0.02 * x.x + 0.03 * x.y;
        let thickness: Vec<f64> = mesh.points.iter().map(|&x| at(x)).collect();
        let linear = Section {
            thickness: 1.0,
            at_nodes: Some(&thickness),
            offset: 0.0,
        };
        let exact = 6.0 * at(Vec3::new(1.5, 1.0, 0.0));
        assert!(
            is_close(total(&with(&mesh, linear)), exact, 1e-12),
            "{element}"
        );
    }
}

#[test]
fn faces_of_a_side_cover_it() {
    for (element, _) in ELEMENTS {
        let mesh = grid(element, [4, 3], plate);
        let shell = with(&mesh, section(0.3, 0.0));
        let on = |face: Face| {
            let (_, nodes) = shell.mesh.face(face).unwrap();
            nodes
                .into_iter()
                .map(|n| shell.mesh.points[n as usize])
                .collect::<Vec<_>>()
        };
        for (number, cell) in mesh.cells(2).enumerate() {
            use super::super::ShellSide::{Edge, Negative, Positive};
            for (side, z) in [(Negative, -0.15), (Positive, 0.15)] {
                let faces: Vec<Face> = shell.faces(number, side).collect();
                assert_eq!(faces.len(), shell.solids[number].len());
                assert!(
                    faces
                        .into_iter()
                        .flat_map(on)
                        .all(|x| is_close(x.z, z, 1e-15))
                );
            }
            let edges = mesh.element(cell).unwrap().edges();
            for (k, ends) in edges.iter().enumerate() {
                let [a, b] = ends.map(|i| mesh.points[mesh.cell(cell)[i] as usize]);
                let faces: Vec<Face> = shell.faces(number, Edge(k)).collect();
                // in order from start to end, each outwards
                let starts = faces.iter().map(|&f| on(f)[0] + Vec3::unit(2) * 0.15);
                let ends = faces.iter().map(|&f| on(f)[1] + Vec3::unit(2) * 0.15);
                let starts: Vec<Vec3> = starts.chain([b]).collect();
                let ends: Vec<Vec3> = [a].into_iter().chain(ends).collect();
                assert_eq!(starts.len(), 1 + faces.len());
                for (x, y) in starts.iter().zip(&ends) {
                    assert!((*x - *y).norm() < 1e-14, "{element}, edge {k}");
                }
            }
            assert_eq!(shell.faces(number, Edge(edges.len())).count(), 0);
        }
    }
}

#[test]
#[ignore = "prints times"]
fn measure_expansions_of_100_000_cells() {
    for (element, _) in ELEMENTS {
        let n = if element.starts_with("tri") { 224 } else { 316 };
        let mesh = grid(element, [n, n], sphere);
        let start = Instant::now();
        let expansion = try_with(&mesh, section(1e-4, 0.0)).unwrap();
        let time = start.elapsed();
        let nsolid = expansion.corners.len();
        println!(
            "{element}: {} cells, {nsolid} solids in {time:?}",
            mesh.ncell()
        );
    }
}
