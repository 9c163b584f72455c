//! Bars that steps remove and add.

use super::*;

#[test]
fn trusses_are_removed_and_added_as_solids_are() {
    for nonlinear in [false, true] {
        for (added, free) in [(FREE, true), (KEPT, false)] {
            let mut mesh = Mesh::default();
            for k in 0..4 {
                let at = Vec3::new(f64::from(k / 2) * 2.0, f64::from(k % 2), 0.0);
                mesh.points.push(at);
                mesh.node_labels.push(k as u64 + 1);
            }
            let line = by_name("line2").unwrap();
            let cells = [
                mesh.push_cell(line, &[0, 1], 1),
                mesh.push_cell(line, &[2, 3], 2),
            ];
            let truss = |name: &str, cell| BodyPart {
                name: name.into(),
                cells: vec![cell],
                kind: BodyKind::Truss {
                    material: Box::new(SaintVenantKirchhoff::new(E, 0.0)),
                    density: None,
                    mass: Default::default(),
                    area: 1.0,
                    small: false,
                },
            };
            let loads = [
                (20.0, None),
                (20.0, Some(GONE)),
                (20.0, Some(added)),
                (50.0, None),
            ];
            let steps = loads.iter().enumerate().map(|(k, &(load, change))| {
                let mut step = StepPart::new(format!("{k}"), Increments::Fixed(2));
                step.nonlinear = nonlinear;
                let hold = |nodes: Vec<NodeId>, axes: &[usize]| {
                    let motions = axes.iter().map(|&a| (a, Motion::Hold)).collect();
                    Change::Prescribe(Target::Nodes(nodes), motions)
                };
                if k == 0 {
                    step.changes = vec![hold(vec![0, 2], &[0, 1]), hold(vec![1, 3], &[0])];
                }
                step.loads = vec![LoadPart {
                    name: "load".into(),
                    load: PerNode(Vec3::new(0.0, load, 0.0)).on(Place::Nodes(vec![1])),
                    course: Course::Ramp,
                }];
                let cells = vec![cells[1]];
                step.activity
                    .extend(change.map(|change| ActivityPart { cells, change }));
                step
            });
            let terms = vec![(Unknown::Node(1, 1), 1.0), (Unknown::Node(3, 1), -1.0)];
            let mut model = Model::assemble(Parts {
                bodies: vec![truss("first", cells[0]), truss("second", cells[1])],
                constraints: vec![ConstraintPart {
                    name: "plate".into(),
                    kind: ConstraintKind::Equation { terms, rhs: 0.0 },
                }],
                steps: steps.collect(),
                ..Parts::new(&mesh, Idealisation::PlaneStress { thickness: 1.0 })
            })
            .unwrap();
            let frames = run(&mut model);
            let strain = |u: f64| if nonlinear { u + 0.5 * u * u } else { u };
            let bears = |u: f64, at: f64| {
                E * (strain(u) - strain(at)) * if nonlinear { 1.0 + u } else { 1.0 }
            };
            let alone = root(|u| bears(u, 0.0), 20.0);
            let at = if free { alone } else { 0.0 };
            let both = |load| root(|u| bears(u, 0.0) + bears(u, at), load);
            let shared = root(|u| 2.0 * bears(u, 0.0), 20.0);
            for (k, wanted) in [shared, alone, both(20.0), both(50.0)].iter().enumerate() {
                near(frames[2 * k + 1].displacement[1].y, *wanted, "truss");
            }
        }
    }
}
