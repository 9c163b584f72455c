//! The pattern that fronts are made from.

use crate::lists::Lists;
use crate::matrix::Matrix;

/// The columns of each row of a matrix, sorted, with the places of their entries.
pub(super) fn by_row(matrix: &Matrix) -> Lists<[u32; 2]> {
    let n = matrix.nequation();
    Lists::new(n, || {
        (0..n).flat_map(|e| {
            let places = matrix.start[e]..;
            let entries = matrix.column(e).iter().zip(places);
            entries.map(move |(&row, at)| (row as usize, [e as u32, at]))
        })
    })
}

/// The lower half of the pattern of A + Aᵀ.
pub(super) fn lower_half(matrix: &Matrix, by_row: &Lists<[u32; 2]>) -> (Vec<u32>, Vec<u32>) {
    let n = matrix.nequation();
    let mut row = Vec::with_capacity(matrix.row.len() / 2 + n);
    let mut begin = Vec::with_capacity(n + 1);
    begin.push(0);
    for e in 0..n {
        let is_above = |&f: &u32| (f as usize) < e;
        let (one, two) = (matrix.column(e), by_row.of(e));
        let mut one = &one[one.partition_point(is_above)..];
        let mut two = &two[two.partition_point(|[f, _]| is_above(f))..];
        if one.iter().eq(two.iter().map(|[f, _]| f)) {
            row.extend_from_slice(one);
            (one, two) = (&[], &[]);
        }
        while let Some(&least) = match (one.first(), two.first()) {
            (Some(a), Some([b, _])) => Some(a.min(b)),
            (a, b) => a.or(b.map(|[f, _]| f)),
        } {
            row.push(least);
            if one.first() == Some(&least) {
                one = &one[1..];
            }
            if two.first().is_some_and(|[f, _]| *f == least) {
                two = &two[1..];
            }
        }
        begin.push(row.len() as u32);
    }
    (begin, row)
}
