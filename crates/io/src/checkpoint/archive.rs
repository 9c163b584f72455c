//! Named arrays of numbers.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use crate::fs::bytes::{decode_le, extend_le};

/// The values of one array.
#[derive(Clone, Debug, PartialEq)]
enum Values {
    F64(Vec<f64>),
    U64(Vec<u64>),
    U8(Vec<u8>),
}

impl Values {
    fn kind(&self) -> u8 {
        match self {
            Values::F64(_) => 1,
            Values::U64(_) => 2,
            Values::U8(_) => 3,
        }
    }

    fn len(&self) -> usize {
        match self {
            Values::F64(v) => v.len(),
            Values::U64(v) => v.len(),
            Values::U8(v) => v.len(),
        }
    }

    fn nbyte(&self) -> usize {
        self.len() * if matches!(self, Values::U8(_)) { 1 } else { 8 }
    }

    fn type_name(&self) -> &'static str {
        match self {
            Values::F64(_) => "f64",
            Values::U64(_) => "u64",
            Values::U8(_) => "u8",
        }
    }
}

/// Why an array could not be put or taken.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ArchiveError {
    /// There is no array of that name.
    #[error("the checkpoint has no array \"{name}\"; start again with --fresh")]
    Missing {
        /// The name.
        name: String,
    },
    /// The array has another type.
    #[error(
        "array \"{name}\" of the checkpoint is {found}, not {expected}; start again with --fresh"
    )]
    WrongType {
        /// The name.
        name: String,
        /// The type asked for.
        expected: &'static str,
        /// The type it has.
        found: &'static str,
    },
    /// The array has another length.
    #[error(
        "array \"{name}\" of the checkpoint has {found} values, not {expected}; start again with --fresh"
    )]
    WrongLength {
        /// The name.
        name: String,
        /// The length asked for.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// Two arrays were to be put under one name, or the name is longer than 65 535 bytes: an error of the program.
    #[error("the array name \"{name}\" is already used or too long")]
    BadName {
        /// The name.
        name: String,
    },
}

/// Named arrays of numbers, kept in the order of their names.
///
/// Names are the caller's; a path like `contact/ball-block/multiplier` keeps terms apart.
///
/// # Example
/// ```
/// use signorini_io::checkpoint::Archive;
///
/// let mut archive = Archive::new();
/// archive.put_f64("state.u", &[0.0, 0.25])?;
/// assert_eq!(archive.get_f64("state.u")?, [0.0, 0.25]);
/// assert!(archive.get_u64("state.u").is_err());
/// # Ok::<(), signorini_io::checkpoint::ArchiveError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Archive {
    arrays: BTreeMap<String, Values>,
}

/// The pair of methods that put and get one type of values.
macro_rules! put_and_get {
    ($put:ident, $get:ident, $copy:ident, $variant:ident, $type:ty, $name:literal) => {
        #[doc = concat!("Puts an array of ", $name, " under a name of its own.")]
        ///
        /// # Errors
        /// [`ArchiveError::BadName`]
        pub fn $put(&mut self, name: &str, values: &[$type]) -> Result<(), ArchiveError> {
            self.put(name, Values::$variant(values.to_vec()))
        }

        #[doc = concat!("The array of ", $name, " under a name, of any length.")]
        ///
        /// # Errors
        /// [`ArchiveError::Missing`], [`ArchiveError::WrongType`]
        pub fn $get(&self, name: &str) -> Result<&[$type], ArchiveError> {
            match self.get(name)? {
                Values::$variant(values) => Ok(values),
                other => Err(ArchiveError::WrongType { name: name.into(), expected: $name, found: other.type_name() }),
            }
        }

        #[doc = concat!("Copies the array of ", $name, " under a name into `out`, whose length it must have.")]
        ///
        /// # Errors
        /// [`ArchiveError::Missing`], [`ArchiveError::WrongType`], [`ArchiveError::WrongLength`]; `out` is then unchanged.
        pub fn $copy(&self, name: &str, out: &mut [$type]) -> Result<(), ArchiveError> {
            let values = self.$get(name)?;
            if values.len() != out.len() {
                return Err(ArchiveError::WrongLength { name: name.into(), expected: out.len(), found: values.len() });
            }
            out.copy_from_slice(values);
            Ok(())
        }
    };
}

impl Archive {
    /// An empty archive.
    pub fn new() -> Self {
        Self::default()
    }

    put_and_get!(put_f64, get_f64, copy_f64, F64, f64, "f64");
    put_and_get!(put_u64, get_u64, copy_u64, U64, u64, "u64");
    put_and_get!(put_u8, get_u8, copy_u8, U8, u8, "u8");

    /// The number of arrays.
    pub fn narray(&self) -> usize {
        self.arrays.len()
    }

    /// The names of all arrays, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.arrays.keys().map(String::as_str)
    }

    fn put(&mut self, name: &str, values: Values) -> Result<(), ArchiveError> {
        match self.arrays.entry(name.to_string()) {
            Entry::Vacant(place) if u16::try_from(name.len()).is_ok() => {
                place.insert(values);
                Ok(())
            }
            _ => Err(ArchiveError::BadName { name: name.into() }),
        }
    }

    fn get(&self, name: &str) -> Result<&Values, ArchiveError> {
        self.arrays
            .get(name)
            .ok_or_else(|| ArchiveError::Missing { name: name.into() })
    }

    /// The number of bytes that [`Archive::encode_into`] appends.
    pub(super) fn encoded_length(&self) -> usize {
        self.arrays
            .iter()
            .map(|(name, values)| 1 + 2 + 8 + name.len() + values.nbyte())
            .sum()
    }

    pub(super) fn encode_into(&self, out: &mut Vec<u8>) {
        for (name, values) in &self.arrays {
            out.push(values.kind());
            out.extend_from_slice(&(name.len() as u16).to_le_bytes());
            out.extend_from_slice(&(values.len() as u64).to_le_bytes());
            out.extend_from_slice(name.as_bytes());
            match values {
                Values::F64(v) => extend_le(out, v, f64::to_le_bytes),
                Values::U64(v) => extend_le(out, v, u64::to_le_bytes),
                Values::U8(v) => out.extend_from_slice(v),
            }
        }
    }

    /// Reads `narray` arrays, after which the input must end; the error states what does not fit.
    pub(super) fn decode(input: &mut Input<'_>, narray: u64) -> Result<Self, &'static str> {
        const TORN: &str = "an array ends behind the end of the file";
        let mut archive = Self::new();
        for _ in 0..narray {
            let kind = input.array::<1>().ok_or(TORN)?[0];
            let name_length = input.array::<2>().map(u16::from_le_bytes).ok_or(TORN)?;
            let nvalue = input
                .u64()
                .and_then(|n| usize::try_from(n).ok())
                .ok_or(TORN)?;
            let name = input.take(usize::from(name_length)).ok_or(TORN)?;
            let name = std::str::from_utf8(name).map_err(|_| "the name of an array is not text")?;
            let width = if kind == 3 { 1 } else { 8 };
            let bytes = nvalue
                .checked_mul(width)
                .and_then(|n| input.take(n))
                .ok_or(TORN)?;
            let values = match kind {
                1 => Values::F64(decode_le(bytes, f64::from_le_bytes)),
                2 => Values::U64(decode_le(bytes, u64::from_le_bytes)),
                3 => Values::U8(bytes.to_vec()),
                _ => return Err("an array has an unknown type"),
            };
            archive
                .put(name, values)
                .map_err(|_| "two arrays have one name")?;
        }
        if input.0.is_empty() {
            Ok(archive)
        } else {
            Err("bytes are left over")
        }
    }
}

/// Bytes that are read from the front.
pub(super) struct Input<'a>(pub &'a [u8]);

impl<'a> Input<'a> {
    pub fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (front, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(front)
    }

    pub fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (front, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*front)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }
}
