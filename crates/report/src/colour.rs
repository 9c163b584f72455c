//! Colours of numbers.

/// Nine colours of the map "viridis" at equal distances: from dark to light with even steps for the eye, and readable
/// without colour vision.
///
/// Source: S. van der Walt, N. Smith, *A better default colormap for Matplotlib*, SciPy 2015 (values in the public domain,
/// CC0).
pub const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

/// The colours of the statuses open, stick, slip.
pub const STATUSES: [[u8; 3]; 3] = [[158, 188, 218], [0, 114, 178], [213, 94, 0]];

/// The names of the statuses.
pub const STATUS_NAMES: [&str; 3] = ["open", "stick", "slip"];

/// What has no value.
pub const NONE: [u8; 3] = [200, 203, 208];

/// The colour of a part from 0 to 1 of the range, from dark to light.
#[must_use]
pub fn viridis(part: f64) -> [f64; 3] {
    let last = VIRIDIS.len() - 1;
    let place = part.clamp(0.0, 1.0) * last as f64;
    let below = (place as usize).min(last - 1);
    let t = place - below as f64;
    let colour = |k: usize| VIRIDIS.get(k).copied().unwrap_or(NONE).map(f64::from);
    let (low, high) = (colour(below), colour(below + 1));
    std::array::from_fn(|k| low[k] + t * (high[k] - low[k]))
}

/// The colour of a status of contact.
#[must_use]
pub fn status(value: f64) -> [f64; 3] {
    let at = value.round().clamp(0.0, 2.0) as usize;
    STATUSES.get(at).copied().unwrap_or(NONE).map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_gets_lighter_all_the_way() {
        let light = |part: f64| {
            let [r, g, b] = viridis(part);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let all: Vec<f64> = (0..=100).map(|k| light(f64::from(k) / 100.0)).collect();
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn values_out_of_range_have_the_colours_of_the_ends() {
        assert_eq!(viridis(-1.0), [68.0, 1.0, 84.0]);
        assert_eq!(viridis(7.0), [253.0, 231.0, 37.0]);
    }
}
