//! Pairs of sides, as they are found and stored.

/// Two sides that may touch: regions, sorted. Those of one side are of one body, and next to one another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    /// The secondary and the primary one.
    pub(super) sides: [Vec<u32>; 2],
    pub(super) touch: Touch,
}

/// By what two sides meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Touch {
    /// Faces.
    Faces,
    /// An edge or a corner of the secondary side.
    Edge,
    /// Edges or corners of both.
    Edges,
}

impl Touch {
    const ALL: [Self; 3] = [Self::Faces, Self::Edge, Self::Edges];
}

impl Pair {
    /// The first region of each side.
    pub(super) fn first(&self) -> [u32; 2] {
        let first = |side: &Vec<u32>| side.first().copied().unwrap_or(u32::MAX);
        self.sides.each_ref().map(first)
    }

    /// Numbers of pairs, for a checkpoint: of each side how many regions it has, and these; then by what they meet.
    pub fn to_numbers(pairs: &[Self]) -> Vec<u64> {
        let mut numbers = Vec::new();
        for pair in pairs {
            for side in &pair.sides {
                numbers.push(side.len() as u64);
                numbers.extend(side.iter().map(|region| u64::from(*region)));
            }
            numbers.push(pair.touch as u64);
        }
        numbers
    }

    /// The pairs of such numbers; nothing where they are none.
    pub fn from_numbers(mut numbers: &[u64]) -> Option<Vec<Self>> {
        let mut pairs = Vec::new();
        while !numbers.is_empty() {
            let sides = [side(&mut numbers)?, side(&mut numbers)?];
            let (touch, rest) = numbers.split_first()?;
            numbers = rest;
            let touch = Touch::ALL.get(usize::try_from(*touch).ok()?).copied()?;
            pairs.push(Self { sides, touch });
        }
        Some(pairs)
    }
}

/// Takes the regions of a side off the front of numbers.
fn side(numbers: &mut &[u64]) -> Option<Vec<u32>> {
    let (count, rest) = numbers.split_first()?;
    let (regions, rest) = rest.split_at_checked(usize::try_from(*count).ok()?)?;
    *numbers = rest;
    let regions = regions.iter().map(|region| u32::try_from(*region).ok());
    regions.collect()
}

/// Two numbers, the lower one first.
pub(super) fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
