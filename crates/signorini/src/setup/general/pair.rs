//! Pairs of sides, as they are found and stored.

/// A secondary and a primary side: regions, sorted. Those of one side are of one body, and next to one another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pair(pub(super) [Vec<u32>; 2]);

impl Pair {
    /// Numbers of pairs, for a checkpoint: how many regions are on each side, and these.
    pub fn to_numbers(pairs: &[Self]) -> Vec<u64> {
        let of_side = |side: &Vec<u32>| {
            let regions = side.iter().map(|region| u64::from(*region));
            std::iter::once(side.len() as u64)
                .chain(regions)
                .collect::<Vec<u64>>()
        };
        pairs
            .iter()
            .flat_map(|pair| pair.0.iter().flat_map(of_side))
            .collect()
    }

    /// The pairs of such numbers; nothing where they are none.
    pub fn from_numbers(mut numbers: &[u64]) -> Option<Vec<Self>> {
        let mut sides = Vec::new();
        while let Some((count, rest)) = numbers.split_first() {
            let (regions, rest) = rest.split_at_checked(usize::try_from(*count).ok()?)?;
            let regions = regions.iter().map(|region| u32::try_from(*region).ok());
            sides.push(regions.collect::<Option<Vec<u32>>>()?);
            numbers = rest;
        }
        let (pairs, rest) = sides.as_chunks::<2>();
        rest.is_empty()
            .then(|| pairs.iter().cloned().map(Self).collect())
    }
}

/// Two numbers, the lower one first.
pub(super) fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
