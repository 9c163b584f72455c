use super::*;
use crate::readers::parts;
use crate::readers::{InlineElement, build};

/// Unit cubes side by side along x, each with nodes of its own unless `merged`.
fn cubes(n: u64, merged: bool) -> Mesh {
    let mut nodes: Vec<(u64, [f64; 3])> = Vec::new();
    let mut cells: Vec<Vec<u64>> = Vec::new();
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for c in 0..n {
        let mut cell = Vec::new();
        for z in [0.0, 1.0] {
            for [x, y] in square {
                let at = [x + c as f64, y, z];
                let known = nodes.iter().find(|node| merged && node.1 == at);
                let label = known.map_or(nodes.len() as u64 + 1, |node| node.0);
                if known.is_none() {
                    nodes.push((label, at));
                }
                cell.push(label);
            }
        }
        cells.push(cell);
    }
    let elements: Vec<InlineElement<'_>> = (1..)
        .zip(&cells)
        .map(|(label, cell)| (label, "hex8", None, cell.as_slice()))
        .collect();
    build(&nodes, &elements).unwrap()
}

fn mirror(mesh: &mut Mesh) {
    mesh.points.iter_mut().for_each(|x| x.x = -x.x);
}

fn sample(labels: &[u64]) -> Sample {
    let mut sample = Sample::default();
    labels.iter().for_each(|&l| sample.push(l));
    sample
}

#[test]
fn a_sound_mesh_has_no_issues_at_any_size_and_place() {
    for scale in [1e-9, 1.0, 1e6] {
        for shift in [0.0, 1000.0] {
            let mut mesh = cubes(3, true);
            for x in &mut mesh.points {
                *x = (*x + Vec3::new(shift, shift, -shift)) * scale;
            }
            assert_eq!(validate(&mesh), [], "{scale} {shift}");
        }
    }
}

#[test]
fn every_element_of_the_table_has_a_good_reference_cell() {
    for element in signorini_geometry::element::TABLE {
        let plane = element.dim() == 2;
        assert!(
            judge(
                &Jacobian::new(element, plane),
                &mut element.nodes().to_vec()
            ) == Volume::Good
        );
        if element.dim() == 3 || plane {
            let mirrored: Vec<Vec3> = element
                .nodes()
                .iter()
                .map(|x| Vec3::new(-x.x, x.y, x.z))
                .collect();
            assert!(
                judge(&Jacobian::new(element, plane), &mut mirrored.clone()) == Volume::Inverted
            );
        }
        let point = vec![Vec3::unit(1); element.nnode()];
        assert!(judge(&Jacobian::new(element, plane), &mut point.clone()) == Volume::Flat);
    }
}

#[test]
fn a_mirrored_mesh_is_distinguished_from_inverted_elements() {
    let mut mesh = cubes(3, true);
    mirror(&mut mesh);
    assert_eq!(validate(&mesh), [MeshIssue::Mirrored { ncell: 3 }]);

    let mut mesh = cubes(3, true);
    let nodes = &mut mesh.blocks[0].nodes[8..16];
    nodes.swap(0, 4);
    nodes.swap(1, 5);
    nodes.swap(2, 6);
    nodes.swap(3, 7);
    assert_eq!(
        validate(&mesh),
        [MeshIssue::Inverted {
            elements: sample(&[2])
        }]
    );
}

#[test]
fn zero_volume_and_folds_are_named() {
    let mut flat = cubes(2, true);
    for &node in &flat.blocks[0].nodes[8..16].to_vec() {
        flat.points[node as usize].x = 1.0;
    }
    // the first cube is whole: the second one lies in the plane x = 1
    let issues = validate(&flat);
    assert_eq!(
        issues[0],
        MeshIssue::Flat {
            elements: sample(&[2])
        }
    );
    assert_eq!(issues[0].severity(), Severity::Error);
    assert_eq!(
        issues[0].to_string(),
        "zero volume: elements 2, in whole or at a corner"
    );

    let mut folded = cubes(1, true);
    folded.points[6] = Vec3::new(0.2, 0.2, 0.2); // a corner pushed far into the cube
    assert_eq!(
        validate(&folded),
        [MeshIssue::Folded {
            elements: sample(&[1])
        }]
    );
}

#[test]
fn a_clockwise_plane_mesh_is_mirrored_and_a_surface_in_space_is_not() {
    let square = |z: f64| {
        let nodes = [
            (1, [0.0, 0.0, 0.0]),
            (2, [0.0, 1.0, 0.0]),
            (3, [1.0, 1.0, z]),
            (4, [1.0, 0.0, z]),
        ];
        build(&nodes, &[(1, "quad4", None, &[1, 2, 3, 4])]).unwrap()
    };
    assert_eq!(validate(&square(0.0)), [MeshIssue::Mirrored { ncell: 1 }]);
    assert_eq!(validate(&square(1.0)), []);
}

#[test]
fn unmerged_nodes_are_counted() {
    let mesh = cubes(3, false);
    let issues = validate(&mesh);
    let [
        MeshIssue::Coincident {
            count,
            pair,
            tolerance,
        },
    ] = issues[..]
    else {
        panic!("{issues:?}")
    };
    assert_eq!((count, pair), (8, [2, 9]));
    assert!((tolerance - 11.0_f64.sqrt() * 1e-9).abs() < 1e-24);
    assert_eq!(issues[0].severity(), Severity::Warning);
}

#[test]
fn coincidence_ends_at_its_tolerance_in_every_direction() {
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            for (times, expected) in [(0.99, 8), (1.01, 4)] {
                let mut mesh = cubes(3, false);
                let tolerance = 11.0_f64.sqrt() * 1e-9;
                // the second cube moves off the first by a distance near the tolerance, the third stays on the second
                for x in &mut mesh.points[8..] {
                    x[axis] += sign * times * tolerance;
                }
                let count = validate(&mesh).iter().find_map(|issue| match issue {
                    MeshIssue::Coincident { count, .. } => Some(*count),
                    _ => None,
                });
                assert_eq!(count, Some(expected), "{axis} {sign} {times}");
            }
        }
    }
}

#[test]
fn coincidence_agrees_with_all_pairs() {
    let mut state = 7_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut mesh = cubes(1, true);
    // clusters a few tolerances wide, so that many pairs are near the limit
    for _ in 0..40 {
        let centre = Vec3::new(random(), random(), random());
        for _ in 0..8 {
            let off = Vec3::new(random(), random(), random()) * 4e-9;
            mesh.points.push(centre + off);
            mesh.node_labels.push(mesh.points.len() as u64);
        }
    }
    let all = (0..mesh.nnode() as u32).collect();
    mesh.sets.entry("all".into()).or_default().nodes = all;
    let tolerance = 3.0_f64.sqrt() * 1e-9;
    let mut kept: Vec<Vec3> = Vec::new();
    let mut expected = 0;
    for &x in &mesh.points {
        if kept.iter().any(|&y| (x - y).norm() <= tolerance) {
            expected += 1;
        } else {
            kept.push(x);
        }
    }
    assert!(expected > 20);
    let issues = validate(&mesh);
    assert!(
        issues
            .iter()
            .any(|i| matches!(i, MeshIssue::Coincident { count, .. } if *count == expected)),
        "{expected} {issues:?}"
    );
}

#[test]
fn coincidence_is_found_when_one_node_is_far_away() {
    let mut mesh = cubes(1, true);
    for i in 0..200_000 {
        mesh.points.push(Vec3::new(f64::from(i), 0.5, 0.5));
        mesh.node_labels.push(100 + i as u64);
    }
    mesh.points.push(Vec3::new(1e14, 0.0, 0.0));
    mesh.node_labels.push(99);
    mesh.sets.entry("all".into()).or_default().nodes = (0..mesh.nnode() as u32).collect();
    // the number of comparisons is a matter of `quality::coincident`
    let mut issues = Vec::new();
    let taken = allocation_counter::measure(|| issues = validate(&mesh));
    assert!(
        issues
            .iter()
            .any(|i| matches!(i, MeshIssue::Coincident { .. }))
    );
    let per_node = taken.bytes_total / mesh.nnode() as u64;
    assert!(per_node < 200, "{per_node} bytes per node");
}

#[test]
fn loose_repeated_and_doubled_things_are_found() {
    let mut mesh = cubes(2, true);
    mesh.points.push(Vec3::new(9.0, 0.0, 0.0));
    mesh.node_labels.push(1000);
    let hex = mesh.blocks[0].element;
    let mut again = mesh.blocks[0].nodes[..8].to_vec();
    again.rotate_left(4);
    mesh.push_cell(hex, &again, 3);
    let mut collapsed = mesh.blocks[0].nodes[..8].to_vec();
    collapsed[7] = collapsed[6];
    mesh.push_cell(hex, &collapsed, 4);
    let issues = validate(&mesh);
    let elements = |label| sample(&[label]);
    assert!(
        issues.contains(&MeshIssue::RepeatedNode {
            elements: elements(4)
        }),
        "{issues:?}"
    );
    assert!(
        issues.contains(&MeshIssue::Duplicate {
            elements: elements(3)
        }),
        "{issues:?}"
    );
    assert!(
        issues.contains(&MeshIssue::Unreferenced { count: 1 }),
        "{issues:?}"
    );
}

#[test]
fn absurd_coordinates_are_named_without_overflow() {
    let mut mesh = cubes(2, true);
    mesh.points[3].y = 1e300;
    mesh.points[4].z = f64::NAN;
    let issues = validate(&mesh);
    assert_eq!(
        issues,
        [
            MeshIssue::NotFinite {
                nodes: sample(&[5])
            },
            MeshIssue::TooLarge {
                nodes: sample(&[4])
            },
        ]
    );
    let mut tiny = cubes(2, true);
    tiny.points.iter_mut().for_each(|x| *x *= 1e-300);
    assert!(matches!(validate(&tiny)[..], [MeshIssue::TooSmall { .. }]));
    let mut far = cubes(2, true);
    far.points.iter_mut().for_each(|x| x.x += 1e9);
    assert!(matches!(validate(&far)[0], MeshIssue::FarAway { .. }));
}

#[test]
fn parts_are_the_cells_that_share_nodes() {
    let id = |index| CellId { block: 0, index };
    let mesh = cubes(4, true);
    let all: Vec<CellId> = mesh.cells(3).collect();
    assert_eq!(parts(&mesh, &all), std::slice::from_ref(&all));
    assert_eq!(
        parts(&mesh, &[id(3), id(0), id(1)]),
        [vec![id(0), id(1)], vec![id(3)]]
    );
    let loose = cubes(3, false);
    assert_eq!(parts(&loose, &all[..3]).len(), 3);
    assert_eq!(parts(&loose, &[]).len(), 0);
}

#[test]
fn ten_elements_are_named_and_the_others_counted() {
    let mut many = Sample::default();
    (1..=12).for_each(|label| many.push(label));
    assert_eq!(
        many.to_string(),
        "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, … (12 in all)"
    );
    assert_eq!(sample(&[4, 7]).to_string(), "4, 7");
}

#[test]
fn areas_of_shells_in_one_plane_have_no_sign() {
    let nodes: Vec<(u64, [f64; 3])> = (1..)
        .zip([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        .map(|(label, [x, y])| (label, [x, y, 0.0]))
        .collect();
    let turned = build(&nodes, &[(7, "quad4", None, &[1, 4, 3, 2])]).unwrap();
    assert_eq!(validate(&turned), [MeshIssue::Mirrored { ncell: 1 }]);
    assert_eq!(validate_as(&turned, false), []);
    let line: Vec<(u64, [f64; 3])> = (1..=4).map(|n| (n, [n as f64, 0.0, 0.0])).collect();
    let flat = build(&line, &[(7, "quad4", None, &[1, 2, 3, 4])]).unwrap();
    assert_eq!(
        validate_as(&flat, false),
        [MeshIssue::Flat {
            elements: sample(&[7])
        }]
    );
}
