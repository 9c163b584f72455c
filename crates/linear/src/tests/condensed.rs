//! Condensed systems against the whole ones, over families of what contact and couplings assemble.

use super::*;

/// What a contact does at the moment.
#[derive(Clone, Copy, PartialEq)]
enum Status {
    Open,
    Stick,
    Slip,
}

/// What a family of contacts is like.
#[derive(Clone, Copy, Debug)]
struct Kind {
    block: usize,
    /// Multipliers of a point: 1, or one for each direction.
    width: usize,
    symmetry: Symmetry,
    /// Multipliers of some points act on the partners of others.
    quadratic: bool,
    /// Some secondary nodes are prescribed, whole or in one direction.
    prescribed: bool,
}

/// Points of the secondary side in contact.
const POINTS: usize = 12;

/// Two bodies and contacts between them, in a status each; patterns do not depend on the statuses, nor on `seed` does
/// anything but them.
fn contacts(kind: Kind, statuses: &[Status]) -> System {
    let Kind {
        block,
        width,
        symmetry,
        ..
    } = kind;
    let mut random = Random(7 + block as u64);
    let (secondary, primary) = (2 * POINTS, 14);
    let nnode = secondary + primary;
    let mut system = System::new(nnode, block, width * POINTS, symmetry);
    let bulk = match symmetry {
        Symmetry::Unsymmetric => Symmetry::Unsymmetric,
        _ => Symmetry::Definite,
    };
    for (first, count) in [(0, secondary), (secondary, primary)] {
        for node in 0..count {
            let mut nodes = vec![node as u32, ((node + 1) % count) as u32];
            nodes.push(random.below(count) as u32);
            nodes.iter_mut().for_each(|n| *n += first as u32);
            nodes.sort_unstable();
            nodes.dedup();
            let mut matrix = random_matrix(nodes.len() * block, bulk, &mut random);
            let n = nodes.len() * block;
            (0..n).for_each(|i| matrix[i * n + i] += 3.0);
            system.bulk.push((nodes, matrix));
        }
    }
    system.multiplier_from = nnode * block;
    for (point, &status) in statuses.iter().enumerate() {
        let mut nodes = vec![point];
        let facet = secondary + random.below(primary - 3);
        nodes.extend(facet..facet + 3);
        if kind.quadratic && point % 2 == 1 {
            // of an edge, on a corner next to it
            nodes.push((point + 1) % POINTS);
        }
        let ndisplacement = nodes.len() * block;
        let dof = |&node: &usize| (0..block).map(move |i| (node * block + i) as u32);
        let mut dofs: Vec<u32> = nodes.iter().flat_map(dof).collect();
        dofs.extend((0..width).map(|c| (system.multiplier_from + width * point + c) as u32));
        let n = dofs.len();
        let mut matrix = vec![0.0; n * n];
        let mut normal = random.vector(block);
        let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        normal.iter_mut().for_each(|x| *x /= size);
        let weights: Vec<f64> = (0..nodes.len())
            .map(|_| 0.3 + 0.2 * random.next())
            .collect();
        let noise: Vec<f64> = random.vector(3 * n * n);
        for c in 0..width {
            let row = ndisplacement + c;
            if status == Status::Open {
                matrix[row * n + row] = -0.3;
                continue;
            }
            for (a, weight) in weights.iter().enumerate() {
                let weight = if a == 0 { 1.0 } else { -weight };
                for (i, normal) in normal.iter().enumerate() {
                    let k = a * block + i;
                    // S is a general block
                    let tilt = 0.15 * noise[(c * n + k) % noise.len()];
                    let b = if width == 1 {
                        weight * normal
                    } else {
                        weight * (f64::from(u8::from(i == c)) + tilt)
                    };
                    let turned = if symmetry == Symmetry::Unsymmetric {
                        b + 0.1 * weight * noise[n * n + c * n + k]
                    } else {
                        b
                    };
                    matrix[k * n + row] = b;
                    matrix[row * n + k] = turned;
                }
            }
            if status == Status::Slip && symmetry == Symmetry::Unsymmetric {
                for d in 0..width {
                    let change = 0.2 * noise[2 * n * n + c * n + d];
                    matrix[row * n + ndisplacement + d] = change - if c == d { 0.5 } else { 0.0 };
                }
            }
        }
        system.interface.push((dofs, matrix));
    }
    if kind.prescribed {
        let whole = 2 * block..3 * block;
        system.held.extend(whole.map(|d| d as u32));
        system.held.extend([5 * block as u32, 8 * block as u32]);
    }
    system
}

fn kinds() -> impl Iterator<Item = Kind> {
    let forms = [
        (2, 1, Symmetry::Symmetric),
        (3, 1, Symmetry::Symmetric),
        (3, 3, Symmetry::Symmetric),
        (3, 1, Symmetry::Unsymmetric),
        (2, 2, Symmetry::Unsymmetric),
        (3, 3, Symmetry::Unsymmetric),
    ];
    let flags = [(false, false), (true, false), (false, true), (true, true)];
    forms.into_iter().flat_map(move |(block, width, symmetry)| {
        flags.into_iter().map(move |(quadratic, prescribed)| Kind {
            block,
            width,
            symmetry,
            quadratic,
            prescribed,
        })
    })
}

fn mix(random: &mut Random) -> Vec<Status> {
    let statuses = [Status::Open, Status::Stick, Status::Slip];
    (0..POINTS).map(|_| statuses[random.below(3)]).collect()
}

#[test]
fn condensed_solutions_are_those_of_the_whole_system() {
    for kind in kinds() {
        let mut solver = Condensed::new(Direct::new);
        let mut random = Random(11);
        for seed in 0..6 {
            let system = contacts(kind, &mix(&mut random));
            check(&system, &mut solver, seed, 1e-12);
        }
        // a prescribed node has no equation for its multipliers
        let most = kind.width * POINTS;
        let stay = if kind.prescribed { 4 * kind.width } else { 0 };
        let n = solver.neliminated();
        assert!(n + stay >= most, "{kind:?}: {n} of {most}");
    }
}

#[test]
fn statuses_change_numbers_and_no_analysis() {
    for kind in kinds().filter(|k| !k.prescribed) {
        let mut solver = Condensed::new(Direct::new);
        let mut random = Random(5);
        check(
            &contacts(kind, &[Status::Stick; POINTS]),
            &mut solver,
            1,
            1e-12,
        );
        let address = solver.inner().address();
        for _ in 0..5 {
            check(&contacts(kind, &mix(&mut random)), &mut solver, 1, 1e-12);
            assert_eq!(solver.inner().address(), address, "{kind:?}");
        }
        check(
            &contacts(kind, &[Status::Open; POINTS]),
            &mut solver,
            1,
            1e-12,
        );
        assert_eq!(solver.inner().address(), address, "{kind:?}");
    }
}

#[test]
fn partners_chosen_blindly_are_chosen_again() {
    for kind in kinds() {
        let mut solver = Condensed::new(Direct::new);
        check(
            &contacts(kind, &[Status::Open; POINTS]),
            &mut solver,
            1,
            1e-12,
        );
        check(
            &contacts(kind, &[Status::Stick; POINTS]),
            &mut solver,
            1,
            1e-12,
        );
    }
}

#[test]
fn symmetric_condensed_systems_are_positive_definite() {
    for kind in kinds().filter(|k| k.symmetry == Symmetry::Symmetric && !k.prescribed) {
        let mut random = Random(3);
        for seed in 0..4 {
            let mut solver = Condensed::new(Direct::new);
            let report = check(&contacts(kind, &mix(&mut random)), &mut solver, seed, 1e-12);
            assert!(solver.inner().is_definite(), "{kind:?}");
            assert_eq!(report.negative_pivots, kind.width * POINTS);
        }
    }
}

#[test]
fn a_body_held_only_by_multipliers_is_solved_by_cholesky() {
    for young in [[1.0, 1.0], [2.1e5, 70.0], [70.0, 2.1e5], [1e-9, 1e-9]] {
        let system = tied_blocks([3, 2, 2], young);
        let mut solver = Condensed::new(Direct::new);
        let report = check(&system, &mut solver, 3, 1e-9);
        assert!(solver.inner().is_definite());
        assert_eq!(solver.neliminated(), system.ndof - system.multiplier_from);
        assert_eq!(report.negative_pivots, solver.neliminated());
    }
}

#[test]
fn multipliers_on_each_others_partners_stay_in_part() {
    // contact of both sides with each other: every node has a multiplier that acts on nodes of the other side
    for symmetry in [Symmetry::Symmetric, Symmetry::Unsymmetric] {
        let (side, ndim) = (6, 2);
        let mut random = Random(9);
        let mut system = System::new(2 * side, ndim, 2 * side, symmetry);
        for node in 0..2 * side as u32 {
            let next = (node + 1) % side as u32 + node / side as u32 * side as u32;
            let mut nodes = vec![node, next];
            nodes.sort_unstable();
            let matrix = random_matrix(4, Symmetry::Definite, &mut random);
            system.bulk.push((nodes, matrix));
        }
        system.multiplier_from = 2 * side * ndim;
        for node in 0..2 * side {
            let other = if node < side { side } else { 0 };
            let nodes = [node, other + node % side, other + (node + 1) % side];
            let mut dofs: Vec<u32> = nodes.iter().map(|n| (n * ndim + 1) as u32).collect();
            dofs.push((system.multiplier_from + node) as u32);
            let along = [1.0, -0.7 + 0.1 * random.next(), -0.3];
            let mut matrix = vec![0.0; 16];
            for (k, b) in along.into_iter().enumerate() {
                (matrix[4 * k + 3], matrix[12 + k]) = (b, b);
            }
            // as many constraints as there are motions: some of them yield
            matrix[15] = if node % 3 == 0 { -0.1 } else { 0.0 };
            system.interface.push((dofs, matrix));
        }
        let mut solver = Condensed::new(Direct::new);
        check(&system, &mut solver, 1, 1e-9);
        assert!((1..2 * side).contains(&solver.neliminated()));
    }
}

#[test]
fn a_multiplier_on_a_shared_node_finds_a_partner_elsewhere() {
    // two multipliers at one node, as where two pairs meet; the second leans on its primary node
    let mut system = System::new(4, 2, 4, Symmetry::Symmetric);
    let mut random = Random(1);
    for nodes in [[0, 1], [1, 2], [2, 3]] {
        let matrix = random_matrix(4, Symmetry::Definite, &mut random);
        system.bulk.push((nodes.to_vec(), matrix));
    }
    system.multiplier_from = 8;
    for (point, primary) in [(0u32, 1u32), (1, 3)] {
        for c in 0..2 {
            let row = vec![0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 1.0, -1.0, 0.0];
            let dofs = vec![c, 2 * primary + c, 8 + 2 * point + c];
            system.interface.push((dofs, row));
        }
    }
    system.held = vec![4];
    let mut solver = Condensed::new(Direct::new);
    check(&system, &mut solver, 1, 1e-12);
    assert!(solver.inner().is_definite());
    assert_eq!(solver.neliminated(), 4);
}

#[test]
fn an_old_factor_serves_new_values() {
    for kind in kinds().filter(|k| !k.prescribed) {
        let system = contacts(kind, &[Status::Stick; POINTS]);
        let old = system.assemble();
        let mut new = system.assemble();
        new.bulk_values.iter_mut().for_each(|a| *a *= 1.0 + 1e-5);
        let mut solver = Condensed::new(Direct::new);
        solver.analyze(&old.problem()).unwrap();
        solver.factorize(&old.values()).unwrap();
        let rhs = Random(2).vector(old.nequation);
        let (mut kept, mut fresh) = (rhs.clone(), rhs.clone());
        let report = solver.solve(&new.values(), &rhs, &mut kept, 1e-12).unwrap();
        assert!(report.refinements > 0, "{kind:?}");
        let mut direct = Direct::new();
        direct.analyze(&new.problem()).unwrap();
        direct.factorize(&new.values()).unwrap();
        direct
            .solve(&new.values(), &rhs, &mut fresh, 1e-12)
            .unwrap();
        let size = largest(&fresh);
        for (a, b) in kept.iter().zip(&fresh) {
            assert!((a - b).abs() < 1e-9 * size);
        }
    }
}

#[test]
fn a_free_motion_is_named_in_the_equations_of_the_whole_system() {
    // the upper block is tied in one direction only, at nodes whose multipliers come before it in no order
    let mut system = tied_blocks([2, 2, 2], [1.0, 1.0]);
    let from = system.multiplier_from as u32;
    let tied = |dofs: &[u32]| dofs.last().is_some_and(|m| (m - from) % 3 == 2);
    system.interface.retain(|(dofs, _)| tied(dofs));
    let multipliers = from..system.ndof as u32;
    system
        .held
        .extend(multipliers.filter(|m| (m - from) % 3 != 2));
    let assembled = system.assemble();
    let mut solver = Condensed::new(Direct::new);
    solver.analyze(&assembled.problem()).unwrap();
    let Err(LinearError::Singular { equation: Some(e) }) = solver.factorize(&assembled.values())
    else {
        panic!("it slides");
    };
    let dof = assembled
        .equation
        .iter()
        .position(|&other| other == e as u32);
    let upper = 3 * nnode([2, 2, 2])..system.multiplier_from;
    assert!(upper.contains(&dof.unwrap()), "{dof:?}");
}
