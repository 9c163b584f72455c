//! Lists of what belongs to each of some keys, made by counting.

/// A list for each key, in one memory.
pub(crate) struct Lists<T> {
    start: Vec<usize>,
    item: Vec<T>,
}

impl<T: Copy + Default> Lists<T> {
    /// The lists of `nkey` keys. `pairs` yields keys and what belongs to them, twice and the same each time; items stay in
    /// the order in which they are yielded.
    pub fn new<I: Iterator<Item = (usize, T)>>(nkey: usize, pairs: impl Fn() -> I) -> Self {
        let mut start = vec![0usize; nkey + 1];
        pairs().for_each(|(key, _)| start[key + 1] += 1);
        for key in 0..nkey {
            start[key + 1] += start[key];
        }
        let mut next = start.clone();
        let mut item = vec![T::default(); start[nkey]];
        pairs().for_each(|(key, of_key)| {
            item[next[key]] = of_key;
            next[key] += 1;
        });
        Self { start, item }
    }

    /// Where each list begins, and the last one ends.
    pub fn start(&self) -> &[usize] {
        &self.start
    }

    /// What belongs to a key.
    pub fn of(&self, key: usize) -> &[T] {
        &self.item[self.start[key]..self.start[key + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_belongs_to_a_key_is_there_in_order() {
        let pairs = [(2, 'a'), (0, 'b'), (2, 'c'), (0, 'd'), (2, 'e')];
        let lists = Lists::new(4, || pairs.iter().copied());
        let all: Vec<&[char]> = (0..4).map(|key| lists.of(key)).collect();
        assert_eq!(all, [&['b', 'd'][..], &[], &['a', 'c', 'e'], &[]]);
        assert_eq!(lists.start(), [0, 2, 2, 5, 5]);
    }
}
