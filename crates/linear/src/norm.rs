//! Norms of vectors.

/// The largest absolute value; NaN where there is one.
pub(crate) fn largest(values: &[f64]) -> f64 {
    // several at a time, which do not wait for one another
    let (chunks, rest) = values.as_chunks::<8>();
    let (mut most, mut strange) = ([0.0f64; 8], [false; 8]);
    for chunk in chunks {
        for ((most, strange), v) in most.iter_mut().zip(&mut strange).zip(chunk) {
            *most = most.max(v.abs());
            *strange |= v.is_nan();
        }
    }
    let is_strange = strange.contains(&true) || rest.iter().any(|v| v.is_nan());
    let all = most.iter().chain(rest);
    let most = all.fold(0.0, |most: f64, v| most.max(v.abs()));
    if is_strange { f64::NAN } else { most }
}
