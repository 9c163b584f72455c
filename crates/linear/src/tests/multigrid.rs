//! Multigrid against the direct solver, and against itself: iterations do not grow with stiffness of contact or size.

use super::super::{Iterative, Multigrid};
use super::*;

#[test]
fn iterations_do_not_grow_with_the_stiffness_of_contact() {
    for sticks in [false, true] {
        let counts = [1.0, 1e2, 1e4, 1e6].map(|penalty| {
            let placed = pressed([10, 9, 8], penalty, sticks, false);
            let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
            assert!(multigrid, "{penalty}");
            report.iterations
        });
        println!("sticks {sticks}: {counts:?}");
        let most = counts.into_iter().max().unwrap() as f64;
        assert!(most <= 1.2 * counts[0] as f64 && most <= 25.0, "{counts:?}");
    }
}

#[test]
fn iterations_grow_slowly_with_size() {
    let count = |n: usize, penalty: f64| {
        let placed = pressed([n, n, n], penalty, false, false);
        let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
        assert!(multigrid);
        report.iterations
    };
    // measured: 10, 10, 13 without contact; 15, 20, 30 with a wide flat one, of which the block knows one layer
    for (penalty, most) in [(0.0, [11, 11, 14]), (10.0, [16, 21, 31])] {
        let counts = [6, 10, 18].map(|n| count(n, penalty));
        println!("{penalty}: {counts:?}");
        let within = counts.iter().zip(most).all(|(count, most)| *count <= most);
        assert!(within, "{penalty}: {counts:?}");
    }
}

#[test]
fn viscous_forces_on_a_body_are_no_part_of_the_block() {
    let n = [10, 9, 8];
    let held = pressed(n, 10.0, true, true);
    let mut solver = Multigrid::new();
    let (multigrid, bare, _) = solve(&held, &mut solver);
    let block = solver.nblock();
    assert!(multigrid && block > 0);
    for stiffness in [1e-5, 1e-3, 3e-2] {
        let mut placed = pressed(n, 10.0, true, true);
        damp(&mut placed, n, stiffness);
        let (multigrid, report, _) = solve(&placed, &mut solver);
        println!("{stiffness:e}: {block} equations, {bare:?}, {report:?}");
        assert!(multigrid && solver.nblock() == block, "{stiffness:e}");
        assert!(report.iterations <= bare.iterations + 5, "{stiffness:e}");
    }
}

#[test]
fn a_body_that_nothing_but_viscous_forces_hold_takes_few_iterations() {
    let n = [10, 9, 8];
    // one solver for all: the hierarchy follows the strength of the forces
    let mut solver = Multigrid::new();
    for stiffness in [1e-3, 3e-2, 1e-4, 1e-6] {
        let mut placed = pressed(n, 0.0, false, true);
        damp(&mut placed, n, stiffness);
        let (multigrid, report, _) = solve(&placed, &mut solver);
        println!("{stiffness:e}: {report:?}");
        assert!(multigrid && solver.nblock() == 0, "{stiffness:e}");
        assert!(report.iterations <= 30, "{stiffness:e}: {report:?}");
    }
}

#[test]
fn a_round_contact_takes_few_iterations_whatever_its_stiffness_and_axes() {
    let counts = [1.0, 10.0, 1e3, 1e6].map(|penalty| {
        let placed = round_contact(20, penalty, false);
        count(&placed, |assembled| head_moved(&placed, assembled))
    });
    assert!(counts.iter().all(|count| *count <= 20), "{counts:?}");
    let most = counts.iter().max().unwrap();
    assert!(*most as f64 <= 1.15 * counts[0] as f64, "{counts:?}");
    let mut placed = round_contact(20, 10.0, true);
    let scattered = |assembled: &Assembled| Random(3).vector(assembled.nequation);
    let along = count(&placed, scattered);
    let (s, c) = 0.7f64.sin_cos();
    let about_z = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    let about_x = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]];
    let by = [0, 1, 2]
        .map(|i| [0, 1, 2].map(|j| (0..3).map(|k| about_x[i][k] * about_z[k][j]).sum::<f64>()));
    turn(&mut placed, by);
    let across = count(&placed, scattered);
    assert!(across as f64 <= 1.3 * along as f64, "{along} {across}");
}

#[test]
#[ignore = "takes 10 seconds and 1 GB: run by .ci/run"]
fn a_round_contact_takes_few_iterations_at_every_size() {
    for (n, most) in [(20, 20), (30, 26), (38, 30)] {
        let placed = round_contact(n, 10.0, false);
        let count = count(&placed, |assembled| head_moved(&placed, assembled));
        assert!(count <= most, "{n}: {count}");
    }
}

#[test]
fn a_body_held_by_contact_alone_takes_hardly_more() {
    for (n, penalty) in [([8, 8, 8], 1.0), ([8, 8, 8], 1e3), ([14, 12, 9], 10.0)] {
        let [held, floats] = [false, true].map(|floats| {
            let placed = pressed(n, penalty, true, floats);
            let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
            assert!(multigrid, "{penalty} {floats}");
            report.iterations
        });
        println!("{n:?}, {penalty:e}: {held} where it is held, {floats} where it floats");
        assert!(floats as f64 <= 1.8 * held as f64, "{held} {floats}");
    }
}

#[test]
fn friction_is_solved_by_minimal_residuals() {
    for mu in [0.3, 1.0] {
        let n = [9, 8, 7];
        let placed = Placed {
            system: slipping_blocks(n, 100.0, mu),
            coordinates: places(n, 2),
        };
        let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
        println!("{mu}: {report:?}");
        assert!(multigrid && report.iterations <= 20, "{mu}: {report:?}");
    }
}

#[test]
fn bits_do_not_depend_on_threads() {
    // enough nodes for two parts
    let placed = pressed([21, 20, 11], 10.0, false, false);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| solve(&placed, &mut Multigrid::new()).2)
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_hierarchy_serves_changed_values_and_is_made_anew_where_it_is_worn() {
    let placed = pressed([10, 10, 10], 10.0, false, false);
    let mut solver = Multigrid::new();
    let first = solve(&placed, &mut solver).1.iterations;
    // the same body, half of it much stiffer: worse at first, as good as new at last
    let mut changed = pressed([10, 10, 10], 10.0, false, false);
    for (nodes, matrix) in &mut changed.system.bulk {
        if changed.coordinates[nodes[0] as usize][0] >= 5.0 {
            matrix.iter_mut().for_each(|v| *v *= 100.0);
        }
    }
    let counts: Vec<usize> = (0..4)
        .map(|_| solve(&changed, &mut solver).1.iterations)
        .collect();
    println!("{first}, then {counts:?}");
    assert!(
        counts[0] > counts[3] && counts[3] <= first + 4,
        "{first} {counts:?}"
    );
}

#[test]
fn hierarchies_outlive_contact_and_increments_but_not_the_bodies() {
    let mut solver = Multigrid::new();
    let mut made = |placed: &Placed, forget: bool| {
        if forget {
            solver.forget();
        }
        assert!(solve(placed, &mut solver).0);
        let notes = solver.notes();
        let is_hierarchy = |note: &&Note| matches!(note, Note::Hierarchy { worn: None, .. });
        assert_eq!(notes.iter().filter(is_hierarchy).count(), notes.len());
        notes.len()
    };
    let placed = pressed([8, 8, 8], 10.0, false, false);
    assert_eq!(made(&placed, false), 1);
    assert_eq!(made(&placed, false), 0);
    // contact of another pattern, another increment
    let sticks = pressed([8, 8, 8], 10.0, true, false);
    assert_eq!(made(&sticks, false), 0);
    assert_eq!(made(&sticks, true), 0);
    // other bodies: as long as the increment lasts, the hierarchy serves
    let mut stiffer = pressed([8, 8, 8], 10.0, true, false);
    for (_, matrix) in &mut stiffer.system.bulk {
        matrix.iter_mut().for_each(|v| *v *= 1.1);
    }
    assert_eq!(made(&stiffer, false), 0);
    assert_eq!(made(&stiffer, true), 1);
}

#[test]
fn a_hierarchy_of_the_start_serves_bodies_that_turn_a_little() {
    let start = pressed([12, 12, 12], 10.0, false, false);
    let mut solver = Multigrid::new();
    solve_from(0, &start, &start, &mut solver);
    assert_eq!(solver.notes().len(), 1);
    let turns = [
        (0.05, true, 0),
        (0.2, true, 0),
        (0.5, false, 1),
        (0.6, false, 1),
        (0.1, true, 1),
        (0.0, true, 0),
    ];
    for (angle, is_of_start, made) in turns {
        let now = turned_above(&start, angle);
        let (count, x) = solve_from(0, &start, &now, &mut solver);
        let (new, _) = solve_from(0, &now, &now, &mut Multigrid::new());
        println!("turned by {angle}: {count} iterations, {new} with a hierarchy of its own");
        assert!(count as f64 <= 1.35 * new as f64, "{angle}: {count} {new}");
        assert_eq!(solver.is_of_start(), is_of_start, "{angle}");
        assert_eq!(solver.notes().len(), made, "{angle}");
        // a run that goes on from here knows nothing but the start
        let mut resumed = Multigrid::new();
        let (_, again) = solve_from(0, &start, &now, &mut resumed);
        assert!(x == again, "{angle}");
    }
    // a step in which the bodies are of another material
    let mut other = start.clone();
    for (_, matrix) in &mut other.system.bulk {
        matrix.iter_mut().for_each(|k| *k *= 1.1);
    }
    let (_, x) = solve_from(1, &other, &other, &mut solver);
    assert_eq!(solver.notes().len(), 1);
    let (_, again) = solve_from(1, &other, &other, &mut Multigrid::new());
    assert!(x == again);
}

#[test]
fn a_hierarchy_of_the_start_that_is_slow_gives_way_to_a_new_one() {
    let start = pressed([12, 12, 12], 10.0, false, false);
    // hardly any change in the norm: in the lower block, the softer of the two, some cells lose their strength
    let weakened = |of: &dyn Fn(usize, [f64; 3]) -> f64| {
        let mut now = start.clone();
        for (cell, (nodes, matrix)) in now.system.bulk.iter_mut().enumerate() {
            let factor = of(cell, start.coordinates[nodes[0] as usize]);
            matrix.iter_mut().for_each(|k| *k *= factor);
        }
        now
    };
    let corner = weakened(&|_, x| {
        if x.iter().all(|x| *x < 3.5) {
            1e-5
        } else {
            1.0
        }
    });
    let scattered = weakened(&|cell, [x, _, z]| {
        if x < 3.5 && z < 11.5 {
            0.1f64.powi((cell * cell % 7) as i32)
        } else {
            1.0
        }
    });
    // after a solution that takes long, and within one that would come to no end, as 60 iterations show
    for (now, solutions, most) in [(corner, 2, 40), (scattered, 1, 60 + 40)] {
        let mut solver = Multigrid::new();
        solve_from(0, &start, &start, &mut solver);
        solver.notes();
        let (first, _) = solve_from(0, &start, &now, &mut solver);
        let mut count = first;
        if solutions == 2 {
            assert!(solver.is_of_start());
            count = solve(&now, &mut solver).1.iterations;
        }
        let notes = solver.notes();
        println!("{first}, then {count} iterations, {notes:?}");
        assert!(matches!(notes[..], [Note::Hierarchy { .. }]) && !solver.is_of_start());
        assert!(count <= most);
    }
}

#[test]
fn a_rough_solution_is_less_work() {
    for mu in [0.0, 0.5] {
        let n = [9, 8, 7];
        let system = if mu > 0.0 {
            slipping_blocks(n, 100.0, mu)
        } else {
            pressed(n, 100.0, false, false).system
        };
        let placed = Placed {
            system,
            coordinates: places(n, 2),
        };
        let assembled = placed.system.assemble();
        let rhs = Random(3).vector(assembled.nequation);
        let ([rough, full], off) = roughly(&placed, &assembled, &rhs);
        println!("{mu}: {rough} and {full}");
        assert!(0 < rough && 3 * rough <= full);
        assert!(off > 1e-9 && off < 0.3, "{off:e}");
    }
}

#[test]
fn a_rough_solution_is_near_where_a_stiff_body_moves_a_soft_one() {
    let n = [8, 7, 6];
    for contrast in [1e2, 1e4, 1e6] {
        for (mu, young) in [
            (0.2, [1.0, contrast]),
            (0.0, [1.0, contrast]),
            (0.2, [contrast, 1.0]),
        ] {
            let placed = Placed {
                system: slipping_blocks_of(young, n, 10.0, mu),
                coordinates: places(n, 2),
            };
            let assembled = placed.system.assemble();
            let rhs = head_moved_at(12.0, &placed, &assembled);
            let ([rough, _], off) = roughly(&placed, &assembled, &rhs);
            println!("{young:?} {mu}: {rough} iterations, off by {off:.1e}");
            assert!(off < 0.2, "{young:?} {mu}: {off:e}");
        }
    }
}

#[test]
fn multipliers_are_condensed_or_in_the_block() {
    let n = [8, 8, 8];
    let mut tied = Placed {
        system: tied_blocks(n, [1.0, 5.0]),
        coordinates: places(n, 2),
    };
    // the upper block hangs on them alone, or is held at its top as well
    compare(&tied, &mut Condensed::new(Multigrid::new));
    let end = 6 * nnode(n) as u32;
    tied.system.held.extend(end - 3 * 81..end);
    let mut solver = Condensed::new(Multigrid::new);
    let (report, _) = compare(&tied, &mut solver);
    println!("condensed: {report:?}");
    assert!(
        solver.inner().is_multigrid() && report.iterations <= 40,
        "{report:?}"
    );
    let (multigrid, report, _) = solve(&tied, &mut Multigrid::new());
    println!("in the block: {report:?}");
    assert!(multigrid && report.iterations <= 40, "{report:?}");
}

#[test]
fn blocks_that_multipliers_join_over_a_whole_face_take_few_iterations() {
    // so large a face that nothing around it is in the block: 35 iterations where levels know nothing of it, 23 where they do
    let n = [20, 20, 6];
    let mut tied = Placed {
        system: tied_blocks(n, [1.0, 5.0]),
        coordinates: places(n, 2),
    };
    let end = 6 * nnode(n) as u32;
    tied.system.held.extend(end - 3 * 441..end);
    let (multigrid, report, _) = solve(&tied, &mut Multigrid::new());
    println!("{report:?}");
    assert!(multigrid && report.iterations <= 30, "{report:?}");
}

#[test]
fn thin_plates_are_solved_by_a_factor_of_the_bodies_for_good() {
    let placed = plates([36, 24, 2], 1);
    let mut solver = Multigrid::new();
    let (multigrid, first, _) = solve(&placed, &mut solver);
    let notes = solver.notes();
    println!("{first:?} {notes:?}");
    let is_factor = |note: &Note| matches!(note, Note::Factor { .. });
    assert!(multigrid && notes.iter().filter(|n| is_factor(n)).count() == 1);
    // no more are lost than it takes to foresee that there would be too many
    assert!(first.iterations <= 60 + 25, "{first:?}");
    for _ in 0..2 {
        let (multigrid, report, _) = solve(&placed, &mut solver);
        assert!(multigrid && report.iterations <= 25, "{report:?}");
        solver.forget();
    }
    assert!(solver.notes().is_empty());
    // a run that is resumed goes on like that
    let mut resumed = Multigrid::new();
    resumed.recall(solver.experience());
    let report = solve(&placed, &mut resumed).1;
    assert_eq!(report, solve(&placed, &mut solver).1);
    assert!(report.iterations <= 25 && resumed.notes().is_empty());
}

#[test]
#[cfg(feature = "mpi")]
fn a_forecast_for_ranks_counts_the_part_of_each() {
    let placed = plates([36, 24, 2], 1);
    let assembled = placed.system.assemble();
    let problem = placed.problem(&assembled);
    let forecast = Forecast::new(&problem, LinearKind::Petsc).unwrap();
    let alone = Forecast::new(&problem, LinearKind::Multigrid).unwrap();
    let (Path::Ranks { nrank, block, .. }, Path::Multigrid { block: same, .. }) =
        (forecast.path, alone.path)
    else {
        panic!("{forecast:?}");
    };
    assert!(nrank == 1 && forecast.nrank() == 1 && block == same);
    assert!(forecast.bytes() > alone.bytes() && forecast.seconds() > alone.seconds());
    let part = |nrank| {
        let path = Path::Ranks {
            nrank,
            nbulk: problem.bulk.nvalue(),
            block: Factor::default(),
        };
        Forecast { path, ..forecast }
    };
    assert_eq!(part(1).bytes(), 4.0 * part(4).bytes());
}

#[test]
fn a_forecast_counts_the_interface_and_what_takes_over() {
    let placed = plates([36, 24, 2], 1);
    let assembled = placed.system.assemble();
    let problem = placed.problem(&assembled);
    let forecast = Forecast::new(&problem, LinearKind::Multigrid).unwrap();
    let Path::Multigrid { nbulk, block } = forecast.path else {
        panic!("{forecast:?}");
    };
    assert_eq!(nbulk, problem.bulk.nvalue());
    let mut solver = Multigrid::new();
    solve(&placed, &mut solver);
    // the block takes in nodes around where these are not too many
    assert!(block.nequation <= solver.nblock() && 3 * block.nequation > solver.nblock());
    let numbers = solver.notes().into_iter().find_map(|note| match note {
        Note::Factor { numbers, .. } => Some(numbers as f64),
        _ => None,
    });
    let foreseen = forecast.fallback.unwrap().nfactor as f64;
    assert!(
        (foreseen / numbers.unwrap() - 1.0).abs() < 0.3,
        "{foreseen} {numbers:?}"
    );
    assert!(forecast.bytes_of_fallback().unwrap() > 8.0 * foreseen);
    let direct = Forecast::new(&problem, LinearKind::Direct).unwrap();
    // multipliers are condensed
    assert!(matches!(direct.path, Path::Direct(factor) if factor.nequation < forecast.nequation));
    assert!(direct.fallback.is_none() && direct.bytes() > 0.0);
}

#[test]
fn a_factor_of_the_bodies_follows_what_multipliers_hold_together() {
    let mut solver = Multigrid::new();
    solver.recall(1);
    for every in [1, 2, 3, 1] {
        let (multigrid, report, _) = solve(&plates([36, 24, 2], every), &mut solver);
        println!("{every}: {report:?}");
        assert!(multigrid && report.iterations <= 30, "{every}: {report:?}");
    }
}

#[test]
fn what_does_not_suit_is_solved_directly() {
    // in the plane
    let n = [6, 6, 0];
    let mut plane = Placed {
        system: System::new(nnode(n), 2, 0, Symmetry::Definite),
        coordinates: places(n, 1),
    };
    let spring = |row: usize, column: usize| match (row % 2 == column % 2, row == column) {
        (true, true) => 1.0,
        (true, false) => -1.0,
        _ => 0.0,
    };
    let matrix: Vec<f64> = (0..16).map(|k| spring(k / 4, k % 4)).collect();
    let bars = (1..nnode(n) as u32).map(|node| (vec![node - 1, node], matrix.clone()));
    plane.system.bulk.extend(bars);
    plane.system.held = vec![0, 1];
    assert!(!solve(&plane, &mut Multigrid::new()).0);
    // a tangent that is indefinite
    let mut buckled = pressed([6, 6, 6], 10.0, false, false);
    let ndof = buckled.system.ndof as u32;
    let push = (0..ndof).map(|dof| (vec![dof], vec![-0.5]));
    buckled.system.interface.extend(push);
    solve(&buckled, &mut Multigrid::new());
}

#[test]
fn a_free_body_is_singular_at_last() {
    let mut placed = pressed([4, 4, 4], 1.0, false, true);
    placed.system.held.truncate(0);
    let assembled = placed.system.assemble();
    let mut solver = Multigrid::new();
    solver.analyze(&placed.problem(&assembled)).unwrap();
    let rhs = Random(3).vector(assembled.nequation);
    let mut x = vec![0.0; rhs.len()];
    let factor = solver.factorize(&assembled.values());
    let outcome = factor.and_then(|()| solver.solve(&assembled.values(), &rhs, &mut x, 1e-10));
    assert!(
        matches!(outcome, Err(LinearError::Singular { .. })),
        "{outcome:?}"
    );
}

/// Conduction through a grid of n × n × n points of which one face is held, heated along the way: `ΔT = 1` of unit spacing.
#[test]
fn a_field_alone_has_a_hierarchy_of_its_own() {
    for (n, most) in [(12, 14), (24, 18)] {
        let number = |x: usize, y: usize, z: usize| x + n * (y + n * z);
        let nnode = n * n * n;
        let first = 3 * nnode as u32;
        let (mut dofs, mut offsets) = (Vec::new(), vec![0]);
        let mut coordinates = Vec::new();
        for z in 0..n {
            for y in 0..n {
                for x in 0..n {
                    coordinates.push([x as f64, y as f64, z as f64]);
                    for (a, b, c) in [(1, 0, 0), (0, 1, 0), (0, 0, 1)] {
                        if x + a < n && y + b < n && z + c < n {
                            let ends = [number(x, y, z), number(x + a, y + b, z + c)];
                            dofs.extend(ends.map(|end| first + end as u32));
                            offsets.push(dofs.len());
                        }
                    }
                }
            }
        }
        let ndof = 4 * nnode;
        let interface = Pattern::from_cliques(ndof, &dofs, &offsets);
        let mut conduction = vec![0.0; interface.column.len()];
        for pair in dofs.chunks(2) {
            for (row, column, k) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
                conduction[interface.position(pair[row], pair[column]).unwrap()] += k;
            }
        }
        let mut equation = vec![NONE; ndof];
        let free = (0..nnode).filter(|node| node % n != 0);
        let mut nequation = 0;
        for node in free {
            equation[first as usize + node] = nequation;
            nequation += 1;
        }
        let bulk = BlockPattern::from_cliques(nnode, 3, &[], &[0]);
        let problem = Problem {
            ndof,
            bulk: &bulk,
            interface: &interface,
            fields: &[crate::FieldBlock { first, width: 1 }],
            equation: &equation,
            nequation: nequation as usize,
            symmetry: Symmetry::Definite,
            sign: &vec![1; nequation as usize],
            coordinates: &coordinates,
            between: &[],
        };
        let values = Values {
            bulk: &vec![0.0; bulk.nvalue()],
            interface: &conduction,
        };
        let mut solver = Multigrid::new();
        solver.analyze(&problem).unwrap();
        solver.factorize(&values).unwrap();
        // the heat of x = n − 1, all of which goes to x = 0
        let at_end = |node: usize| node % n == n - 1;
        let rhs: Vec<f64> = (0..nnode)
            .filter(|node| node % n != 0)
            .map(|node| if at_end(node) { 1.0 } else { 0.0 })
            .collect();
        let mut x = vec![0.0; rhs.len()];
        let report = solver.solve(&values, &rhs, &mut x, 1e-10).unwrap();
        assert!(
            solver.is_multigrid() && report.iterations <= most,
            "{n}: {report:?}"
        );
        for (node, &e) in (0..nnode).zip(&equation[first as usize..]) {
            if e != NONE {
                let expected = (node % n) as f64;
                assert!(
                    (x[e as usize] - expected).abs() < 1e-6 * n as f64,
                    "{n} {node}"
                );
            }
        }
    }
}
