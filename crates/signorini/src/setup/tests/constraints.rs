//! References, equations, couplings, cuts and sectors.

use super::*;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::load::Place;
use signorini_mechanics::model::{BodyKind, Change, ConstraintKind, Target, Unknown};

#[test]
fn references_carry_rigid_bodies_and_nodes() {
    let text = "[reference.pilot]\nat = [0, 0, 5]\n[reference.corner]\nnode = 18\n\
        [[body]]\ngroup = 'high'\nrigid = true\nreference = 'pilot'\n[[body]]\ngroup = 'bar'\nrigid = true\n\
        [[constraint]]\nkind = 'kinematic'\non = 'base'\nreference = 'corner'\ndofs = ['x', 'z']\n\
        [[constraint]]\nkind = 'distributing'\non = 'top'\nreference = 'corner'\n\
        [[step]]\nname = 'one'\n[[step.fix]]\non = 'corner'\nrot = ['x']\n[[step.move]]\non = 'high'\nrz = 1.0\n\
        [[step.load]]\non = 'pilot'\nmoment = [1, 0, 0]\n";
    let built = cubes(&format!(
        "top = {{ plane = 'z', at = 1, of = 'low' }}\n{text}"
    ));
    let names: Vec<&str> = built.carriers.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["pilot", "corner", "bar"]);
    assert_eq!(built.carriers[1].at, Some(Vec3::new(0.0, 1.0, 2.0)));
    assert_eq!(built.carriers[2].at, None);
    let rigid = |n: usize| matches!(built.bodies[n].kind, BodyKind::Rigid { carrier: c, .. } if c == [9, 0, 2][n]);
    assert!(rigid(1) && rigid(2));
    assert!(matches!(
        &built.constraints[0].kind,
        ConstraintKind::Kinematic { carrier: 1, axes: [true, false, true], nodes } if labels(nodes) == [1, 2, 3, 4]
    ));
    let ConstraintKind::Distributing { nodes, .. } = &built.constraints[1].kind else {
        panic!("distributing");
    };
    assert!(nodes.iter().all(|(_, share)| (share - 0.25).abs() < 1e-15));
    assert!(
        matches!(&built.steps[0].changes[0], Change::Prescribe(Target::Rigid(1), m) if m[0].0 == 3)
    );
    assert!(
        matches!(&built.steps[0].changes[1], Change::Prescribe(Target::Rigid(0), m) if m[0].0 == 5)
    );
    let load = &built.steps[0].loads[0].load;
    assert_eq!(load.place, Place::Carrier(0));
    assert_eq!(load.load.resultant(0.0), Some([Vec3::ZERO, Vec3::unit(0)]));
}

#[test]
fn equations_and_springs_pair_nodes_in_the_order_they_are_listed() {
    let sets = "a = { nodes = [8, 5] }\nb = { nodes = [11, 14] }\none = { nodes = [21] }\n";
    let text = format!(
        "{sets}[[constraint]]\nequation = [['a', 'x', 1.0], ['b', 'y', -2.0], ['one', 'z', 0.5]]\nrhs = 0.25\n\
         [[constraint]]\nkind = 'equal'\non = 'a'\ndofs = ['y']\n[[constraint]]\nkind = 'plane'\non = 'base'\n\
         [[spring]]\nname = 's'\nbetween = ['a', 'b']\nstiffness = 3\n[[spring]]\nname = 'g'\non = 'a'\nstiffness = 4\n\
         direction = [0, 3, 4]\n{STEP}"
    );
    let built = cubes(&text);
    let node = |label: u64, axis| {
        let at = (0..19).find(|&n| labels(&[n]) == [label]).unwrap();
        Unknown::Node(at, axis)
    };
    let equations: Vec<_> = built
        .constraints
        .iter()
        .take(2)
        .map(|c| c.kind.clone())
        .collect();
    let equation = |a, b| ConstraintKind::Equation {
        terms: vec![(node(a, 0), 1.0), (node(b, 1), -2.0), (node(21, 2), 0.5)],
        rhs: 0.25,
    };
    assert_eq!(equations, [equation(8, 11), equation(5, 14)]);
    assert!(matches!(
        &built.constraints[2].kind,
        ConstraintKind::Equal {
            axes: [false, true, false],
            ..
        }
    ));
    assert!(
        matches!(&built.constraints[3].kind, ConstraintKind::Plane { nodes } if nodes.len() == 4)
    );
    let ends = |n: usize| {
        let ends = built.springs[n].ends.iter();
        ends.map(|(a, b)| (labels(&[*a])[0], b.map(|b| labels(&[b])[0])))
            .collect::<Vec<_>>()
    };
    assert_eq!(ends(0), [(8, Some(11)), (5, Some(14))]);
    assert_eq!(ends(1), [(8, None), (5, None)]);
    assert_eq!(built.springs[1].direction, Some(Vec3::new(0.0, 0.6, 0.8)));
}

#[test]
fn couplings_become_constraints_of_the_whole_run() {
    let load = "[[step.load]]\non = 'top'\nforce = [0, 0, -1]\ncoupling = 'rigid-z'\n";
    let top = "top = { plane = 'z', at = 1, of = 'low' }\n";
    let built = cubes(&format!("{top}{STEP}{load}[[step]]\nname = 'two'\n{load}"));
    assert_eq!(built.constraints.len(), 1);
    assert!(matches!(
        &built.constraints[0].kind,
        ConstraintKind::Equal { nodes, axes: [false, false, true] } if labels(nodes) == [5, 6, 7, 8]
    ));
    let (code, text) = refused(&format!("{top}{STEP}[[step]]\nname = 'two'\n{load}"));
    assert!(
        code == "S0112" && text.contains("from the first step on"),
        "{text}"
    );
}

/// Two cubes that share a face, cut between them.
#[test]
fn a_cut_gives_its_side_nodes_of_its_own() {
    let mesh = "[mesh]\nnodes = [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],\n\
                [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],\n\
                [15, 0, 0, 2], [16, 1, 0, 2], [17, 1, 1, 2], [18, 0, 1, 2]]\n\
                elements = [{ id = 1, type = 'hex8', group = 'low', nodes = [1, 2, 3, 4, 5, 6, 7, 8] },\n\
                { id = 2, type = 'hex8', group = 'high', nodes = [5, 6, 7, 8, 15, 16, 17, 18] }]\n\
                [material.steel]\nmodel = 'linear-elastic'\nE = 1\nnu = 0\n[[body]]\ngroup = ['low', 'high']\n\
                material = 'steel'\n[reference]\nbolt = { at = [0, 0, 0] }\n[sets]\n\
                base = { plane = 'z', at = 0 }\n";
    let text = |faces: &str, more: &str| {
        format!(
            "{mesh}cut = {{ faces = {faces} }}\n[[constraint]]\nkind = 'pretension'\non = 'cut'\n\
             reference = 'bolt'\n{more}{STEP}"
        )
    };
    let built = parts_of(&text("[[1, '+z']]", ""));
    let equations: Vec<_> = built
        .constraints
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } => terms.clone(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(equations.len(), 12);
    // the side below gets the copies: its normal points up
    let overlap = (Unknown::Carrier(0, 0), -1.0);
    assert_eq!(equations[2].last(), Some(&overlap));
    assert!(equations[0].len() == 2 && equations[1].len() == 2);
    assert!(matches!(
        equations[2][..2],
        [(Unknown::Node(12, 2), 1.0), (Unknown::Node(4..8, 2), -1.0)]
    ));
    let turned = parts_of(&text("[[2, '-z']]", "normal = [0, 3, -4]\n"));
    let along: Vec<f64> = turned.constraints[..3]
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } if terms.len() == 3 => terms[2].1,
            _ => 0.0,
        })
        .collect();
    assert_eq!(along, [0.0, -0.6, 0.8]);
    for (faces, more, wanted) in [
        ("[[1, '-z']]", "", "lies on the outside"),
        (
            "[[1, '+z']]",
            "[[constraint]]\nkind = 'pretension'\non = 'cut'\nreference = 'bolt'\n",
            "nodes of another pretension",
        ),
        (
            "[[1, '+z'], [2, '-z']]",
            "normal = 'z'\n",
            "does not cut the body",
        ),
    ] {
        let all = try_parts(&text(faces, more)).err().unwrap().plain();
        assert!(all.contains(wanted), "{all}");
    }
}

/// A quarter of a square about the z axis: the side y = 0 leads the side x = 0.
#[test]
fn nodes_of_a_sector_follow_those_of_its_other_side() {
    let sides = "lead = { plane = 'y', at = 0, of = 'low' }\nfollow = { plane = 'x', at = 0, of = 'low' }\n";
    let sector = |sectors: u32| {
        format!(
            "{sides}[[constraint]]\nkind = 'cyclic'\non = 'follow'\nwith = 'lead'\nsectors = {sectors}\n{STEP}"
        )
    };
    let built = cubes(&sector(4));
    assert_eq!(built.constraints.len(), 12);
    let rows: Vec<Vec<(Unknown, f64)>> = built
        .constraints
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } => terms.clone(),
            other => panic!("{other:?}"),
        })
        .collect();
    // u_x of (0, 1, z) is −u_y of (1, 0, z)
    let node = |unknown: Unknown| match unknown {
        Unknown::Node(node, axis) => (labels(&[node])[0], axis),
        other => panic!("{other:?}"),
    };
    let of = |label: u64, axis: usize| {
        let row = rows.iter().find(|row| node(row[0].0) == (label, axis));
        let row = row.unwrap();
        (node(row[1].0), row[1].1)
    };
    assert_eq!(of(4, 0), ((2, 1), 1.0));
    assert_eq!(of(4, 1), ((2, 0), -1.0));
    assert_eq!(of(8, 2), ((6, 2), -1.0));
    let (code, text) = refused(&sector(5));
    assert!(
        code == "S0308" && text.contains("turned by a sector of 5"),
        "{text}"
    );
}
