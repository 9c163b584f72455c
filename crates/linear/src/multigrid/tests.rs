//! The parts of multigrid, each against what it stands for.

use super::aggregation::Aggregates;
use super::blocks::{Blocks, add_product, inverse};
use super::hierarchy::Hierarchy;
use super::incomplete::Incomplete;
use super::packed::Packed;

/// A generator with a fixed seed: uniform in [-½, ½).
fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
}

/// Blocks that couple each row with some others, positive definite.
fn definite<const N: usize>(pairs: &[(usize, usize)], nrow: usize) -> Blocks<N, N> {
    let mut state = 7;
    let mut dense = vec![vec![None; nrow]; nrow];
    for (row, blocks) in dense.iter_mut().enumerate() {
        blocks[row] = Some([[0.0; N]; N]);
    }
    for &(a, b) in pairs {
        let block: [[f64; N]; N] =
            std::array::from_fn(|_| std::array::from_fn(|_| random(&mut state)));
        dense[a][b] = Some(block);
        dense[b][a] = Some(std::array::from_fn(|i| {
            std::array::from_fn(|j| block[j][i])
        }));
    }
    for (row, blocks) in dense.iter_mut().enumerate() {
        let sum: f64 = blocks
            .iter()
            .flatten()
            .flatten()
            .flatten()
            .map(|v: &f64| v.abs())
            .sum();
        let own = blocks[row].as_mut().unwrap();
        (0..N).for_each(|i| own[i][i] = 1.0 + sum);
    }
    let mut matrix = Blocks {
        ncolumn: nrow,
        start: vec![0],
        column: Vec::new(),
        value: Vec::new(),
    };
    for row in &dense {
        for (column, block) in row.iter().enumerate() {
            if let Some(block) = block {
                matrix.column.push(column as u32);
                matrix.value.push(*block);
            }
        }
        matrix.start.push(matrix.column.len());
    }
    matrix
}

#[test]
fn inverses_are_inverses_and_there_is_none_of_what_is_not_positive() {
    let matrix = definite::<6>(&[], 1);
    let mut block = matrix.value[0];
    for (i, row) in block.iter_mut().enumerate() {
        for (j, v) in row.iter_mut().enumerate() {
            *v += 0.1 * ((i * j) as f64).sin();
        }
    }
    let found = inverse(&block).unwrap();
    for (i, row) in block.iter().enumerate() {
        for j in 0..6 {
            let sum: f64 = row.iter().zip(&found).map(|(a, b)| a * b[j]).sum();
            let wanted = f64::from(u8::from(i == j));
            assert!((sum - wanted).abs() < 1e-14);
        }
    }
    block[3][3] = -1.0;
    assert!(inverse(&block).is_none());
    assert!(inverse(&[[0.0; 3]; 3]).is_none());
}

/// A x
fn applied(matrix: &Blocks<3, 3>, x: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let of_row = |row| {
        let mut sum = [0.0; 3];
        for (column, block) in matrix.row(row) {
            add_product(block, &x[column], &mut sum);
        }
        sum
    };
    (0..matrix.nrow()).map(of_row).collect()
}

#[test]
fn products_and_transposes_are_those_of_dense_matrices() {
    let pairs = [(0, 1), (0, 4), (1, 3), (2, 5), (3, 4), (4, 6)];
    let a = definite::<3>(&pairs, 7);
    let product = a.times(&a.transpose(), |_, _, _| {});
    let x: Vec<[f64; 3]> = (0..7).map(|k| [1.0, k as f64, (k * k) as f64]).collect();
    let (twice, at_once) = (applied(&a, &applied(&a, &x)), applied(&product, &x));
    let pairs = twice.iter().flatten().zip(at_once.iter().flatten());
    let left = pairs.fold(0.0f64, |m, (x, y)| m.max((x - y).abs()));
    assert!(left < 1e-10, "{left:e}");
    assert!((0..7).all(|row| product.column[product.range(row)].is_sorted()));
}

#[test]
fn projections_are_products() {
    // a chain of more rows than a strip has
    let n = 20_000;
    let near = |row: usize| row.saturating_sub(1)..(row + 2).min(n);
    let block = |row: usize, column: usize| -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| ((row + column) % 7 + i + j) as f64 - 3.0))
    };
    let mut a = Blocks {
        ncolumn: n,
        start: vec![0],
        column: Vec::new(),
        value: Vec::new(),
    };
    for row in 0..n {
        a.column.extend(near(row).map(|column| column as u32));
        a.value.extend(near(row).map(|column| block(row, column)));
        a.start.push(a.column.len());
    }
    let motions: Vec<[[f64; 6]; 3]> = (0..n)
        .map(|k| std::array::from_fn(|i| std::array::from_fn(|j| ((k + 7 * i + j) % 5) as f64)))
        .collect();
    let onto = Blocks {
        ncolumn: n / 100,
        start: (0..=n).collect(),
        column: (0..n).map(|k| (k / 100) as u32).collect(),
        value: motions,
    };
    let found = a.projected(&onto);
    let expected = onto
        .transpose()
        .times(&a.times(&onto, |_, _, _| {}), |_, _, _| {});
    assert_eq!(
        (&found.start, &found.column),
        (&expected.start, &expected.column)
    );
    let pairs = found.value.iter().zip(&expected.value);
    for (x, y) in pairs.flat_map(|(x, y)| x.as_flattened().iter().zip(y.as_flattened())) {
        assert!((x - y).abs() <= 1e-12 * (1.0 + y.abs()), "{x} {y}");
    }
}

#[test]
fn a_factor_without_fill_to_leave_out_is_exact() {
    // a chain, whole and in two parts with a row between them
    let chain: Vec<(usize, usize)> = (0..8).map(|k| (k, k + 1)).collect();
    let parted = [
        (0, 1),
        (1, 2),
        (2, 3),
        (4, 5),
        (5, 6),
        (6, 7),
        (3, 8),
        (7, 8),
    ];
    for (pairs, parts) in [(chain.as_slice(), vec![]), (&parted, vec![0..4, 4..8])] {
        let matrix = definite::<3>(pairs, 9);
        let factor = Incomplete::new(&matrix, &parts, 0.0).unwrap();
        let x: Vec<[f64; 3]> = (0..9).map(|k| [1.0, -(k as f64), 0.5]).collect();
        let b = applied(&matrix, &x);
        let mut single: Vec<[f32; 3]> = b.iter().map(|b| b.map(|v| v as f32)).collect();
        factor.solve(&mut single);
        for (x, y) in x.iter().flatten().zip(single.iter().flatten()) {
            assert!((x - f64::from(*y)).abs() < 1e-4, "{x} {y}");
        }
    }
    let mut negative = definite::<3>(&chain, 9);
    negative.value[0][1][1] = -1.0;
    assert!(Incomplete::new(&negative, &[], 0.0).is_none());
}

/// A cube of `n` nodes a side: springs to all neighbours, which do not mind motions of a rigid body, and these.
fn lattice(n: usize) -> (Blocks<3, 3>, Vec<[[f64; 6]; 3]>) {
    let place = |k: usize| [k % n, k / n % n, k / n / n].map(|x| x as f64);
    let count = n * n * n;
    let mut matrix = Blocks {
        ncolumn: count,
        start: vec![0],
        column: Vec::new(),
        value: Vec::new(),
    };
    for row in 0..count {
        let mut own = [[0.0; 3]; 3];
        let mut blocks = Vec::new();
        for column in 0..count {
            let (a, b) = (place(row), place(column));
            let d: [f64; 3] = std::array::from_fn(|i| a[i] - b[i]);
            if row == column || d.iter().any(|d| d.abs() > 1.0) {
                continue;
            }
            let square: f64 = d.iter().map(|d| d * d).sum();
            let block: [[f64; 3]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|j| -d[i] * d[j] / square));
            for (own, row) in own.iter_mut().flatten().zip(block.iter().flatten()) {
                *own -= row;
            }
            blocks.push((column as u32, block));
        }
        blocks.push((row as u32, own));
        blocks.sort_by_key(|b| b.0);
        for (column, block) in blocks {
            matrix.column.push(column);
            matrix.value.push(block);
        }
        matrix.start.push(matrix.column.len());
    }
    let modes = (0..count).map(|k| {
        let r = place(k).map(|x| x / n as f64 - 0.5);
        [
            [1.0, 0.0, 0.0, 0.0, r[2], -r[1]],
            [0.0, 1.0, 0.0, -r[2], 0.0, r[0]],
            [0.0, 0.0, 1.0, r[1], -r[0], 0.0],
        ]
    });
    (matrix, modes.collect())
}

#[test]
fn aggregates_cover_all_nodes_and_their_motions_give_the_modes_back() {
    let (matrix, modes) = lattice(6);
    let aggregates = Aggregates::new(&matrix);
    assert!(
        aggregates
            .of
            .iter()
            .all(|&a| (a as usize) < aggregates.count)
    );
    assert!((8..=30).contains(&aggregates.count), "{}", aggregates.count);
    let (motions, coarse) = aggregates.motions(&modes);
    for (row, mode) in modes.iter().enumerate() {
        let [(at, block)] = motions.row(row).collect::<Vec<_>>()[..] else {
            panic!("a node moves with one aggregate");
        };
        for (block, mode) in block.iter().zip(mode) {
            for (m, mode) in mode.iter().enumerate() {
                let sum: f64 = block.iter().zip(&coarse[at]).map(|(b, r)| b * r[m]).sum();
                assert!((sum - mode).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_cycle_is_symmetric_positive_and_reduces_what_is_smooth() {
    let (mut matrix, modes) = lattice(9);
    // held softly everywhere: nearly free
    for row in 0..matrix.nrow() {
        let range = matrix.range(row);
        let at = matrix.column[range.clone()]
            .binary_search(&(row as u32))
            .unwrap();
        (0..3).for_each(|i| matrix.value[range.start + at][i][i] += 1e-4);
    }
    let n = matrix.nrow();
    let mut hierarchy = Hierarchy::new(&matrix, &modes, &[], None).unwrap();
    let mut state = 3;
    let mut vector = || -> Vec<[f32; 3]> {
        (0..n)
            .map(|_| std::array::from_fn(|_| random(&mut state) as f32))
            .collect()
    };
    let dot = |a: &[[f32; 3]], b: &[[f32; 3]]| -> f64 {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    };
    let (a, b) = (vector(), vector());
    let (mut va, mut vb) = (a.clone(), b.clone());
    hierarchy.cycle(&a, &mut va);
    hierarchy.cycle(&b, &mut vb);
    let (one, two) = (dot(&va, &b), dot(&a, &vb));
    let size = (dot(&va, &a) * dot(&vb, &b)).sqrt();
    assert!(
        size > 0.0 && (one - two).abs() < 1e-4 * size,
        "{one} {two} {size}"
    );
    // the residual of a motion that is nearly rigid
    let smooth: Vec<[f32; 3]> = modes
        .iter()
        .map(|m| m.map(|r| (r[2] + r[4]) as f32))
        .collect();
    let single: Packed<3, 3> = Packed::new(&matrix);
    let mut load = vec![[0.0; 3]; n];
    single.multiply::<false>(&smooth, &mut load);
    let mut answer = load.clone();
    hierarchy.cycle(&load, &mut answer);
    let off = smooth.iter().flatten().zip(answer.iter().flatten());
    let off = off.fold(0.0f32, |m, (x, y)| m.max((x - y).abs()));
    assert!(off < 0.2, "{off}");
}
