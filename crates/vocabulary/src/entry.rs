//! Entries of a table of things that a case may name.

use crate::table::{Key, Rule};
use crate::values::{Fault, Value, Values};

/// What a thing is called, and the keys that it is made from.
#[derive(Clone, Copy, Debug)]
pub struct Description {
    /// Its name in a case.
    pub name: &'static str,
    /// What it is, in one line.
    pub doc: &'static str,
    /// Other words people use for it; they are proposed, never read.
    pub hints: &'static [&'static str],
    /// Its keys.
    pub keys: &'static [Key],
    /// Which keys exclude or need each other.
    pub rules: &'static [Rule],
    /// The models that have it.
    pub models: Models,
}

impl Description {
    /// Of a thing that every model has, without hints and rules.
    #[must_use]
    pub const fn new(name: &'static str, doc: &'static str, keys: &'static [Key]) -> Self {
        Self {
            name,
            doc,
            hints: &[],
            keys,
            rules: &[],
            models: Models::All,
        }
    }

    /// Of a thing with one key only, which is called as the thing is: a case gives its value in place of a table.
    #[must_use]
    pub const fn bare(key: &'static [Key; 1]) -> Self {
        let [only] = key;
        Self::new(only.name, only.doc, key).hints(only.hints)
    }

    /// The only key of a thing whose value a case gives in place of a table.
    #[must_use]
    pub fn bare_key(&self) -> Option<&'static Key> {
        match self.keys {
            [only] if only.name == self.name => Some(only),
            _ => None,
        }
    }

    /// The same with other words that people use for it.
    #[must_use]
    pub const fn hints(mut self, hints: &'static [&'static str]) -> Self {
        self.hints = hints;
        self
    }

    /// The same with rules that its keys keep.
    #[must_use]
    pub const fn rules(mut self, rules: &'static [Rule]) -> Self {
        self.rules = rules;
        self
    }

    /// The same for models in space only: what to write in the plane instead.
    #[must_use]
    pub const fn in_space(mut self, instead: &'static str) -> Self {
        self.models = Models::Space { instead };
        self
    }

    /// The same for models in the plane only: what to write in space instead.
    #[must_use]
    pub const fn in_the_plane(mut self, instead: &'static str) -> Self {
        self.models = Models::Plane { instead };
        self
    }
}

/// The models that have a thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Models {
    /// Those in space and those in the plane.
    All,
    /// Those in space.
    Space {
        /// What to write in the plane.
        instead: &'static str,
    },
    /// Those in the plane.
    Plane {
        /// What to write in space.
        instead: &'static str,
    },
}

/// A thing that a case may name, and the error of making it.
#[derive(Debug)]
pub struct Entry<T: 'static, E: 'static = Fault> {
    /// Its name and keys.
    pub description: Description,
    /// Makes it.
    pub make: fn(&Values) -> Result<T, E>,
}

impl<T, E: From<Fault>> Entry<T, E> {
    /// Makes the thing that a case has chosen from these entries.
    ///
    /// # Errors
    /// No entry has this name; those of its `make`.
    pub fn make(entries: &[Self], chosen: &Chosen) -> Result<T, E> {
        let mut entries = entries.iter();
        let entry = entries.find(|entry| entry.description.name == chosen.name);
        let entry = entry.ok_or_else(|| Fault::Unfit {
            what: format!("nothing is called \"{}\"", chosen.name),
        })?;
        (entry.make)(&chosen.values)
    }
}

/// The entry that a case has chosen, with the values of its keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The name of the entry.
    pub name: &'static str,
    /// The values of its keys.
    pub values: Values,
}

impl Chosen {
    /// An entry whose keys have numbers as values.
    #[must_use]
    pub fn new<const N: usize>(name: &'static str, numbers: [(&'static str, f64); N]) -> Self {
        Self {
            name,
            values: Values::numbers(numbers),
        }
    }

    /// An entry with one key only, which is called as the entry is.
    #[must_use]
    pub fn bare(name: &'static str, value: Value) -> Self {
        Self {
            name,
            values: Values::new().with(name, value),
        }
    }

    /// The value of an entry with one key only, which is called as the entry is.
    #[must_use]
    pub fn bare_value(&self) -> Option<&Value> {
        let mut values = self.values.iter();
        match (values.next(), values.next()) {
            (Some((key, value)), None) if key == self.name => Some(value),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{POSITIVE, key};

    static HALVES: [Entry<f64>; 1] = [Entry {
        description: Description::new(
            "half",
            "half a number",
            &[key("of", POSITIVE, "the number").required()],
        ),
        make: |values| Ok(0.5 * values.number("of")?),
    }];

    #[test]
    fn an_entry_is_made_from_the_values_of_its_keys() {
        let made = |name, key| Entry::make(&HALVES, &Chosen::new(name, [(key, 3.0)]));
        assert_eq!(made("half", "of"), Ok(1.5));
        assert_eq!(made("half", "off"), Err(Fault::Missing { key: "of" }));
        assert!(matches!(made("third", "of"), Err(Fault::Unfit { .. })));
    }
}
