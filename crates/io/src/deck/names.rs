//! Names that nothing has yet.

use std::collections::{BTreeMap, BTreeSet};

/// The names that are taken.
pub(super) struct Names {
    taken: BTreeSet<String>,
    /// The last number behind each name that was wanted more than once.
    last: BTreeMap<String, usize>,
    /// How many names were looked up.
    #[cfg(test)]
    tried: usize,
}

impl Names {
    /// These are taken.
    pub fn new(taken: impl IntoIterator<Item = String>) -> Self {
        Self {
            taken: taken.into_iter().collect(),
            last: BTreeMap::new(),
            #[cfg(test)]
            tried: 0,
        }
    }

    /// A name that nothing has, and that is taken from now on: `wanted`, or with a number behind.
    pub fn fresh(&mut self, wanted: &str) -> String {
        if self.take(wanted.to_owned()) {
            return wanted.to_owned();
        }
        let mut number = self.last.get(wanted).copied().unwrap_or(1);
        loop {
            number += 1;
            let name = format!("{wanted}-{number}");
            if self.take(name.clone()) {
                self.last.insert(wanted.to_owned(), number);
                return name;
            }
        }
    }

    fn take(&mut self, name: String) -> bool {
        #[cfg(test)]
        {
            self.tried += 1;
        }
        self.taken.insert(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_get_the_first_number_that_is_free() {
        let mut names = Names::new(["load".to_owned(), "load-3".to_owned()]);
        let found = ["load", "load", "other", "load", "load-2", "other"].map(|n| names.fresh(n));
        let expected = ["load-2", "load-4", "other", "load-5", "load-2-2", "other-2"];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_name_that_is_wanted_often_is_found_at_once() {
        let mut names = Names::new([]);
        for _ in 0..1000 {
            names.fresh("load");
        }
        assert!(names.tried <= 2000, "{}", names.tried);
    }
}
