//! Changes of elements that are refused.

use super::*;

#[test]
fn what_cannot_be_removed_or_added_is_refused_by_name() {
    let bars = bars("hex8", [1.0, 1.0]);
    let of = |steps: &[(f64, Option<CellChange>)]| {
        bars.try_model(&hooke(0.0), false, steps, 1, None).err()
    };
    let already = |step: &str, adds, active| {
        Some(ModelError::Activity(ActivityError::Already {
            step: step.into(),
            element: bars.mesh.cell_label(bars.bars[1].cells[0]).unwrap(),
            adds,
            active,
        }))
    };
    assert_eq!(
        of(&[(1.0, Some(FREE))]),
        already("step 0", "adds", "active")
    );
    let twice = [(1.0, Some(GONE)), (1.0, Some(AT_ONCE))];
    assert_eq!(of(&twice), already("step 1", "removes", "inactive"));
}

#[test]
fn a_body_that_only_removed_elements_held_is_free_in_that_step() {
    let grid = Grid::of("hex8", [1, 1, 3], |x| Vec3::new(x.x, x.y, 3.0 * x.z));
    let cells = &grid.cells;
    let bottom = grid.nodes(|x| x.z.abs() < 1e-9);
    let mut steps = vec![
        StepPart::new("hold", Increments::Fixed(1)),
        StepPart::new("cut", Increments::Fixed(1)),
    ];
    let motions = (0..3).map(|a| (a, Motion::Hold)).collect();
    steps[0].changes = vec![Change::Prescribe(Target::Nodes(bottom), motions)];
    let middle = grid.cells.iter().filter(|&&c| {
        let z: f64 = grid
            .mesh
            .cell(c)
            .iter()
            .map(|&n| grid.mesh.points[n as usize].z)
            .sum();
        (z / 8.0 - 1.5).abs() < 1e-9
    });
    steps[1].activity = vec![ActivityPart {
        cells: middle.copied().collect(),
        change: GONE,
    }];
    let error = Model::assemble(Parts {
        bodies: vec![solid("column", cells, SaintVenantKirchhoff::new(E, 0.0))],
        steps,
        ..Parts::new(&grid.mesh, Idealisation::Space)
    })
    .err();
    match error {
        Some(ModelError::FreeLater { step, free }) => {
            assert_eq!((step.as_str(), free.len()), ("cut", 1))
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn elements_that_would_be_turned_inside_out_are_named() {
    // the upper of two cells is removed, and the lower pulled beyond its head
    let grid = Grid::of("hex8", [1, 1, 2], |x| Vec3::new(x.x, x.y, 2.0 * x.z));
    let at = |z: f64| grid.nodes(|x| (2.0 * x.z - z).abs() < 1e-9);
    let hold = |nodes, motions| Change::Prescribe(Target::Nodes(nodes), motions);
    let mut steps = vec![
        StepPart::new("pull", Increments::Fixed(6)),
        StepPart::new("add", Increments::Fixed(1)),
    ];
    let sideways = [(0, Motion::Hold), (1, Motion::Hold)];
    let with = |z| sideways.iter().cloned().chain([(2, z)]).collect();
    steps[0].changes = vec![
        hold(at(0.0), with(Motion::Hold)),
        hold(at(1.0), with(Motion::Ramp(1.2))),
    ];
    let upper = vec![grid.cells[1]];
    steps[0].activity = vec![ActivityPart {
        cells: upper.clone(),
        change: GONE,
    }];
    steps[1].activity = vec![ActivityPart {
        cells: upper,
        change: FREE,
    }];
    for law in [0, 1] {
        let body = match law {
            0 => solid("column", &grid.cells, SaintVenantKirchhoff::new(E, 0.0)),
            _ => solid("column", &grid.cells, NeoHookean::new(E, 0.0)),
        };
        let mut model = Model::assemble(Parts {
            bodies: vec![body],
            steps: steps.clone(),
            ..Parts::new(&grid.mesh, Idealisation::Space)
        })
        .unwrap();
        let mut stepper = Stepper::new(&model.system, settings(LinearKind::Direct));
        let error = stepper.run(&mut model.system, &model.steps, &mut |_: &Event<'_>| {
            Flow::Continue
        });
        let text = error.unwrap_err().to_string();
        assert!(
            text.starts_with(
                "element 2 of body \"column\" is turned inside out where this step adds"
            ),
            "{text}"
        );
    }
}
