//! From the numbers of a file to places in a list.

/// Finds nodes or elements by the numbers that a file gives them.
pub(crate) enum Lookup {
    /// By the distance from the smallest number, for numbers with few gaps.
    Dense { first: u64, places: Vec<u32> },
    /// By bisection.
    Sparse(Vec<(u64, u32)>),
}

impl Lookup {
    const NONE: u32 = u32::MAX;

    /// Indexes labels by their places in the list; of equal labels the first counts.
    pub fn new(labels: &[u64]) -> Self {
        let first = labels.iter().copied().min().unwrap_or(0);
        let last = labels.iter().copied().max().unwrap_or(0);
        let span = (last - first) as usize;
        let mut pairs = (0..).zip(labels).map(|(place, &label)| (label, place));
        if span < 4 * labels.len() {
            let mut places = vec![Self::NONE; span + 1];
            for (label, place) in pairs {
                match places.get_mut((label - first) as usize) {
                    Some(entry) if *entry == Self::NONE => *entry = place,
                    _ => {}
                }
            }
            return Self::Dense { first, places };
        }
        let mut sorted: Vec<(u64, u32)> = pairs.by_ref().collect();
        sorted.sort_unstable();
        sorted.dedup_by_key(|pair| pair.0);
        Self::Sparse(sorted)
    }

    /// The place of a label.
    pub fn find(&self, label: u64) -> Option<u32> {
        match self {
            Self::Dense { first, places } => {
                let at = usize::try_from(label.checked_sub(*first)?).ok()?;
                places.get(at).copied().filter(|&p| p != Self::NONE)
            }
            Self::Sparse(sorted) => {
                let at = sorted.binary_search_by_key(&label, |pair| pair.0).ok()?;
                sorted.get(at).map(|pair| pair.1)
            }
        }
    }

    /// Appends the places of the labels `first`, `first + step`, … up to `last` that exist.
    pub fn range(&self, first: u64, last: u64, step: u64, out: &mut Vec<u32>) {
        let is_meant = |label: u64| (label - first).is_multiple_of(step);
        match self {
            Self::Dense { first: low, places } => {
                let high = low + (places.len() as u64).saturating_sub(1);
                let skipped = low.saturating_sub(first).div_ceil(step);
                let mut next = skipped.checked_mul(step).and_then(|n| n.checked_add(first));
                while let Some(label) = next.filter(|&label| label <= last.min(high)) {
                    out.extend(self.find(label));
                    next = label.checked_add(step);
                }
            }
            Self::Sparse(sorted) => {
                let start = sorted.partition_point(|pair| pair.0 < first);
                let end = sorted.partition_point(|pair| pair.0 <= last);
                let inside = sorted.get(start..end).unwrap_or_default().iter();
                out.extend(inside.filter(|pair| is_meant(pair.0)).map(|pair| pair.1));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_found_whether_they_have_gaps_or_not() {
        for labels in [
            vec![7, 5, 6, 9],
            vec![1_000_000_000_000, 3, 50, u64::MAX],
            vec![],
        ] {
            let lookup = Lookup::new(&labels);
            for (place, label) in labels.iter().enumerate() {
                assert_eq!(lookup.find(*label), Some(place as u32));
            }
            for absent in [0, 8, 1 << 60] {
                assert_eq!(lookup.find(absent), None);
            }
        }
        assert_eq!(Lookup::new(&[4, 4, 5]).find(4), Some(0));
    }

    #[test]
    fn ranges_hold_the_labels_that_exist() {
        let range = |labels: &[u64], first, last, step| {
            let mut out = Vec::new();
            Lookup::new(labels).range(first, last, step, &mut out);
            out
        };
        for far in [6, 1 << 40] {
            let labels = [2, 3, 4, 5, far];
            assert_eq!(range(&labels, 0, u64::MAX, 1), [0, 1, 2, 3, 4]);
            assert_eq!(range(&labels, 0, 5, 2), [0, 2]);
            assert_eq!(range(&labels, 1, 5, 2), [1, 3]);
            assert_eq!(range(&labels, 3, 4, u64::MAX), [1]);
            assert_eq!(range(&labels, 9, 3, 1), [0; 0]);
            assert_eq!(range(&labels, 1, u64::MAX, u64::MAX), [0; 0]);
        }
        assert_eq!(range(&[], 0, u64::MAX, 1), [0; 0]);
    }
}
