//! The values of keys.

use thiserror::Error;

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A list of numbers.
    Numbers(Vec<f64>),
    /// A text, or one of the words of a choice.
    Text(String),
}

/// The values of the keys of a table, in the order of the table.
///
/// # Example
/// ```
/// use signorini_vocabulary::{Fault, Value, Values};
///
/// let values = Values::numbers([("p0", 5.0)]).with("at", Value::Numbers(vec![1.0, 2.0]));
/// assert_eq!(values.number("p0"), Ok(5.0));
/// // vectors of the plane have two entries
/// assert_eq!(values.vector("at"), Ok([1.0, 2.0, 0.0]));
/// assert_eq!(values.number("c0"), Err(Fault::Missing { key: "c0" }));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(Vec<(&'static str, Value)>);

/// Why values make nothing.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Fault {
    /// A key has no value.
    #[error("`{key}` is missing")]
    Missing {
        /// The key.
        key: &'static str,
    },
    /// Values that do not go together.
    #[error("{what}")]
    Unfit {
        /// What is wrong, in words.
        what: String,
    },
}

impl Values {
    /// No values.
    #[must_use]
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// The same with one value more.
    #[must_use]
    pub fn with(mut self, key: &'static str, value: Value) -> Self {
        self.0.push((key, value));
        self
    }

    /// The values of these numbers.
    #[must_use]
    pub fn numbers<const N: usize>(numbers: [(&'static str, f64); N]) -> Self {
        Self(
            numbers
                .map(|(key, number)| (key, Value::Number(number)))
                .into(),
        )
    }

    /// All keys with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }

    /// The value of a key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Value> {
        let mut all = self.0.iter();
        all.find(|(name, _)| *name == key).map(|(_, value)| value)
    }

    /// The number of a key that may be absent.
    #[must_use]
    pub fn number_if(&self, key: &str) -> Option<f64> {
        match self.get(key)? {
            Value::Number(number) => Some(*number),
            Value::Numbers(_) | Value::Text(_) => None,
        }
    }

    /// The number of a key.
    ///
    /// # Errors
    /// The key is missing, or its value is no number.
    pub fn number(&self, key: &'static str) -> Result<f64, Fault> {
        self.number_if(key).ok_or(Fault::Missing { key })
    }

    /// The numbers of a key; a number is a list of one.
    ///
    /// # Errors
    /// The key is missing, or its value is a text.
    pub fn list(&self, key: &'static str) -> Result<&[f64], Fault> {
        match self.get(key) {
            Some(Value::Numbers(numbers)) => Ok(numbers),
            Some(Value::Number(number)) => Ok(std::slice::from_ref(number)),
            Some(Value::Text(_)) | None => Err(Fault::Missing { key }),
        }
    }

    /// Three numbers of a key; a third that is absent is zero.
    ///
    /// # Errors
    /// The key is missing, or has fewer than two numbers or more than three.
    pub fn vector(&self, key: &'static str) -> Result<[f64; 3], Fault> {
        match *self.list(key)? {
            [x, y] => Ok([x, y, 0.0]),
            [x, y, z] => Ok([x, y, z]),
            _ => Err(Fault::Missing { key }),
        }
    }

    /// The text of a key.
    #[must_use]
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.get(key)? {
            Value::Text(text) => Some(text),
            Value::Number(_) | Value::Numbers(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_their_keys_and_forms() {
        let values = Values::numbers([("a", 2.0)])
            .with("b", Value::Numbers(vec![1.0, 3.0]))
            .with("c", Value::Text("word".to_owned()));
        assert_eq!(values.number("a"), Ok(2.0));
        assert_eq!(values.number("b"), Err(Fault::Missing { key: "b" }));
        assert_eq!(values.number_if("d"), None);
        assert_eq!(values.list("a"), Ok(&[2.0][..]));
        assert_eq!(values.vector("b"), Ok([1.0, 3.0, 0.0]));
        assert_eq!(values.vector("a"), Err(Fault::Missing { key: "a" }));
        assert_eq!((values.text("c"), values.text("a")), (Some("word"), None));
        let keys: Vec<&str> = values.iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["a", "b", "c"]);
    }
}
