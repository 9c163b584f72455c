/// Squared singular values below this part of the largest count as zero: a resistance a million times smaller than
/// another is one of rounding.
const RANK: f64 = 1e-12;

/// A basis of the null space of a positive semidefinite matrix, row-major, by elimination with diagonal pivots.
///
/// Each vector has one free component of 1 and a zero in the free components of the others.
pub(super) fn null_space(mut gram: Vec<f64>, n: usize) -> Vec<Vec<f64>> {
    let largest = (0..n).map(|i| gram[i * n + i]).fold(0.0, f64::max);
    let mut pivots: Vec<usize> = Vec::new();
    let mut free: Vec<usize> = (0..n).collect();
    while let Some((at, pivot)) = largest_diagonal(&gram, &free, n)
        && gram[pivot * n + pivot] > RANK * largest
    {
        free.remove(at);
        pivots.push(pivot);
        let row: Vec<f64> = (0..n)
            .map(|j| gram[pivot * n + j] / gram[pivot * n + pivot])
            .collect();
        for i in (0..n).filter(|&i| i != pivot) {
            let factor = gram[i * n + pivot];
            if factor != 0.0 {
                for (value, r) in gram[i * n..(i + 1) * n].iter_mut().zip(&row) {
                    *value -= factor * r;
                }
                gram[i * n + pivot] = 0.0;
            }
        }
        gram[pivot * n..(pivot + 1) * n].copy_from_slice(&row);
    }
    let vector = |&f: &usize| {
        let mut vector = vec![0.0; n];
        vector[f] = 1.0;
        for &p in &pivots {
            vector[p] = -gram[p * n + f];
        }
        vector
    };
    free.iter().map(vector).collect()
}

fn largest_diagonal(gram: &[f64], free: &[usize], n: usize) -> Option<(usize, usize)> {
    let diagonal = free.iter().copied().enumerate();
    diagonal.max_by(|a, b| gram[a.1 * n + a.1].total_cmp(&gram[b.1 * n + b.1]))
}
