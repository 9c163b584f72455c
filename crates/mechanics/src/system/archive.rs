//! What terms store between runs.

use std::collections::BTreeMap;
use thiserror::Error;

/// What an archive lacks.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ArchiveError {
    /// A name that is not there.
    #[error("the checkpoint has no \"{name}\"")]
    Missing {
        /// The name.
        name: String,
    },
    /// Data of another model.
    #[error("\"{name}\" in the checkpoint has {found} values, this model has {expected}")]
    Length {
        /// The name.
        name: String,
        /// Values in the checkpoint.
        found: usize,
        /// Values in the model.
        expected: usize,
    },
}

/// Named arrays: what a term needs to go on bit by bit where it stopped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Archive {
    /// The arrays.
    pub arrays: BTreeMap<String, Vec<f64>>,
}

impl Archive {
    /// Stores an array.
    pub fn put(&mut self, name: impl Into<String>, values: &[f64]) {
        self.arrays.insert(name.into(), values.to_vec());
    }

    /// The length of a stored array.
    ///
    /// # Errors
    /// No such array.
    pub fn length(&self, name: &str) -> Result<usize, ArchiveError> {
        let found = self.arrays.get(name).map(Vec::len);
        found.ok_or_else(|| ArchiveError::Missing {
            name: name.to_string(),
        })
    }

    /// Copies a stored array into `out`.
    ///
    /// # Errors
    /// No such array, or one of another length.
    pub fn get(&self, name: &str, out: &mut [f64]) -> Result<(), ArchiveError> {
        let values = self.arrays.get(name).ok_or_else(|| ArchiveError::Missing {
            name: name.to_string(),
        })?;
        if values.len() != out.len() {
            return Err(ArchiveError::Length {
                name: name.to_string(),
                found: values.len(),
                expected: out.len(),
            });
        }
        out.copy_from_slice(values);
        Ok(())
    }
}
