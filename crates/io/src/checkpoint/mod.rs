//! What a run needs to go on after it was stopped, in two files that take turns.
//!
//! ```text
//!  a.sgc  ■ increment 5 ─────────────▶ ■ increment 15          the newer good one is resumed from;
//!  b.sgc               ■ increment 10 ───────────▶ ■ 20 …      a torn or damaged one falls back to the other
//!
//!  byte   0  "SGNCHKPT"                  the head proves itself, so that a newer
//!         8  format version     u32      format distinguished from a damaged file
//!        12  CRC-32 of 0..12    u32
//!        16  length of the file u64
//!        24  sequence number    u64      grows with every checkpoint of a run
//!        32  hash of the case   32 bytes
//!        64  step, increment    u64, u64
//!        80  time               f64
//!        88  number of arrays   u64
//!        96  per array: kind u8, length of its name u16, number of values u64, name, values
//!       end  CRC-32 of all before it     u32
//! ```
//!
//! All numbers are little-endian, so `f64` values come back to the bit. A file whose length, checksum or case is not
//! right is never read further: the answer is the other file or an error, not other numbers.
//!
//! Limits: the content is held in memory once more while it is written or read. Two runs must not write into one folder
//! (take [`Fs::lock`]).
//!
//! One more kind of values: a variant of `Values`, its number, and a put and get pair.

mod archive;

use std::path::{Path, PathBuf};

pub use archive::{Archive, ArchiveError};

use crate::fs::bytes::crc32;
use crate::fs::{Fs, FsError};

/// The version of the files that this program writes; it reads no other.
pub const FORMAT_VERSION: u32 = 2;

const MAGIC: &[u8; 8] = b"SGNCHKPT";
/// Length of everything before the arrays, in bytes.
const HEAD: usize = 96;
/// The two files, in the order in which they are first written.
const SLOTS: [&str; 2] = ["a.sgc", "b.sgc"];

/// Whether a folder of checkpoints holds one, good or not.
#[must_use]
pub fn has_checkpoint(fs: &dyn Fs, folder: &Path) -> bool {
    let is_there = |slot: &&str| fs.exists(&folder.join(slot)).unwrap_or(false);
    SLOTS.iter().any(is_there)
}

/// Where in a run a checkpoint stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stamp {
    /// Number of the step, as the caller counts.
    pub step: u64,
    /// Number of the increment, as the caller counts.
    pub increment: u64,
    /// Total time.
    pub time: f64,
}

/// A checkpoint as read.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The file it comes from.
    pub path: PathBuf,
    /// Grows with every checkpoint of a run.
    pub sequence: u64,
    /// Where in the run it stands.
    pub stamp: Stamp,
    /// What was saved.
    pub archive: Archive,
    /// Why the other file was passed over, where it was there and not good: worth a warning.
    pub passed_over: Option<String>,
}

/// Why a run cannot go on from its checkpoints.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// There is no checkpoint.
    #[error("{} holds no checkpoint: the run stopped before its first one; start again with --fresh", folder.display())]
    Missing {
        /// The folder of the checkpoints.
        folder: PathBuf,
    },
    /// A file cannot be read.
    #[error("the checkpoint cannot be read: {0}")]
    Unreadable(#[from] FsError),
    /// A file is torn or changed, and the other one is of no use either.
    #[error("{} is damaged: {what}; there is no other good checkpoint, start again with --fresh", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        what: &'static str,
    },
    /// The checkpoint belongs to another case or mesh.
    #[error("{} belongs to another case or mesh; undo the change, or start again with --fresh", path.display())]
    OtherCase {
        /// The file.
        path: PathBuf,
    },
    /// The checkpoint was written by another version of the program.
    #[error("{} has format {found}, this program reads {FORMAT_VERSION}; resume with the version that wrote it, or start again with --fresh", path.display())]
    OtherFormat {
        /// The file.
        path: PathBuf,
        /// Its format version.
        found: u32,
    },
}

impl CheckpointError {
    /// The exit code of a program that ends because of this error.
    pub const EXIT_CODE: u8 = 7;
}

/// The two checkpoint files of a run.
#[derive(Clone, Debug)]
pub struct Checkpoints {
    folder: PathBuf,
    case_hash: [u8; 32],
    /// Which file is written next, and its sequence number; unknown before the first write.
    next: Option<(usize, u64)>,
}

impl Checkpoints {
    /// The checkpoints in `folder` of the case with this SHA-256; nothing is read or written yet.
    pub fn new(folder: &Path, case_hash: [u8; 32]) -> Self {
        Self {
            folder: folder.to_path_buf(),
            case_hash,
            next: None,
        }
    }

    /// Writes a checkpoint over the older or unusable file and returns its path; the other one is not touched.
    ///
    /// # Errors
    /// [`FsError`]; the last good checkpoint is then still there.
    pub fn write(
        &mut self,
        fs: &dyn Fs,
        stamp: Stamp,
        archive: &Archive,
    ) -> Result<PathBuf, FsError> {
        let (slot, sequence) = match self.next {
            Some(next) => next,
            None => self.find_next(fs)?,
        };
        self.next = Some((slot, sequence));
        let path = self.path(slot);
        fs.write_atomic(&path, &encode(sequence, &self.case_hash, stamp, archive))?;
        self.next = Some((1 - slot, sequence + 1));
        Ok(path)
    }

    /// Reads the newest good checkpoint of this case; where one file is not good, the other one is taken.
    ///
    /// # Errors
    /// [`CheckpointError`]
    pub fn latest_good(&self, fs: &dyn Fs) -> Result<Checkpoint, CheckpointError> {
        let (mut best, mut problem): (Option<Checkpoint>, Option<CheckpointError>) = (None, None);
        for slot in 0..SLOTS.len() {
            match self.read(fs, slot) {
                Ok(Some(found)) if best.as_ref().is_none_or(|b| b.sequence < found.sequence) => {
                    best = Some(found)
                }
                Ok(_) => {}
                Err(error) => problem = Some(graver(problem, error)),
            }
        }
        match (best, problem) {
            (Some(best), problem) => Ok(Checkpoint {
                passed_over: problem.map(|p| p.to_string()),
                ..best
            }),
            (None, Some(problem)) => Err(problem),
            (None, None) => Err(CheckpointError::Missing {
                folder: self.folder.clone(),
            }),
        }
    }

    /// Removes both files: a fresh run must not fall back to a checkpoint of an earlier one.
    ///
    /// # Errors
    /// [`FsError`]
    pub fn clear(&mut self, fs: &dyn Fs) -> Result<(), FsError> {
        for slot in 0..SLOTS.len() {
            let path = self.path(slot);
            if fs.exists(&path)? {
                fs.remove(&path)?;
            }
        }
        self.next = None;
        Ok(())
    }

    fn path(&self, slot: usize) -> PathBuf {
        self.folder
            .join(SLOTS.get(slot).copied().unwrap_or_default())
    }

    /// The file to write next: one that is not good, else the older one.
    fn find_next(&self, fs: &dyn Fs) -> Result<(usize, u64), FsError> {
        let sequences = [0, 1].map(|slot| match self.read(fs, slot) {
            Ok(found) => Ok(found.map_or(0, |checkpoint| checkpoint.sequence)),
            Err(CheckpointError::Unreadable(error)) => Err(error),
            Err(_) => Ok(0),
        });
        let [a, b] = sequences;
        let (a, b) = (a?, b?);
        Ok((usize::from(b < a), a.max(b) + 1))
    }

    /// One of the files, where it exists.
    fn read(&self, fs: &dyn Fs, slot: usize) -> Result<Option<Checkpoint>, CheckpointError> {
        let path = self.path(slot);
        if !fs.exists(&path)? {
            return Ok(None);
        }
        let bytes = fs.read(&path)?;
        decode(&bytes, &self.case_hash, path).map(Some)
    }
}

/// The error that says more to the user, when neither file is good.
fn graver(one: Option<CheckpointError>, other: CheckpointError) -> CheckpointError {
    let rank = |error: &CheckpointError| match error {
        CheckpointError::Missing { .. } => 0,
        CheckpointError::Corrupt { .. } => 1,
        CheckpointError::OtherCase { .. } => 2,
        CheckpointError::OtherFormat { .. } => 3,
        CheckpointError::Unreadable(_) => 4,
    };
    match one {
        Some(one) if rank(&one) >= rank(&other) => one,
        _ => other,
    }
}

/// A checkpoint as bytes, for who keeps it elsewhere than in the folder of a run.
#[must_use]
pub fn to_bytes(case_hash: &[u8; 32], stamp: Stamp, archive: &Archive) -> Vec<u8> {
    encode(1, case_hash, stamp, archive)
}

/// A checkpoint from the bytes of [`to_bytes`].
///
/// # Errors
/// [`CheckpointError`]: bytes that are none, or of another case.
pub fn from_bytes(bytes: &[u8], case_hash: &[u8; 32]) -> Result<Checkpoint, CheckpointError> {
    decode(bytes, case_hash, PathBuf::from("the state"))
}

/// The bytes of a checkpoint file.
fn encode(sequence: u64, case_hash: &[u8; 32], stamp: Stamp, archive: &Archive) -> Vec<u8> {
    let length = HEAD + archive.encoded_length() + 4;
    let mut out = Vec::with_capacity(length);
    out.extend_from_slice(MAGIC);
    out.extend_from_slice(&FORMAT_VERSION.to_le_bytes());
    out.extend_from_slice(&crc32(&out).to_le_bytes());
    out.extend_from_slice(&(length as u64).to_le_bytes());
    out.extend_from_slice(&sequence.to_le_bytes());
    out.extend_from_slice(case_hash);
    out.extend_from_slice(&stamp.step.to_le_bytes());
    out.extend_from_slice(&stamp.increment.to_le_bytes());
    out.extend_from_slice(&stamp.time.to_le_bytes());
    out.extend_from_slice(&(archive.narray() as u64).to_le_bytes());
    archive.encode_into(&mut out);
    out.extend_from_slice(&crc32(&out).to_le_bytes());
    out
}

/// The checkpoint in the bytes of a file; everything is checked before it is believed.
fn decode(
    bytes: &[u8],
    case_hash: &[u8; 32],
    path: PathBuf,
) -> Result<Checkpoint, CheckpointError> {
    let corrupt = |what| CheckpointError::Corrupt {
        path: path.clone(),
        what,
    };
    let mut input = archive::Input(bytes);
    let torn = || corrupt("it ends too early");
    if &input.array::<8>().ok_or_else(torn)? != MAGIC {
        return Err(corrupt("it does not start like a checkpoint"));
    }
    let version = input.u32().ok_or_else(torn)?;
    let head_crc = input.u32().ok_or_else(torn)?;
    if Some(head_crc) != bytes.get(..12).map(crc32) {
        return Err(corrupt("the checksum of its head is wrong"));
    }
    if version != FORMAT_VERSION {
        return Err(CheckpointError::OtherFormat {
            path,
            found: version,
        });
    }
    if input.u64() != Some(bytes.len() as u64) {
        return Err(corrupt("its length is wrong"));
    }
    let (body, crc) = bytes.split_last_chunk::<4>().ok_or_else(torn)?;
    if crc32(body) != u32::from_le_bytes(*crc) {
        return Err(corrupt("its checksum is wrong"));
    }
    let mut input = archive::Input(body.get(24..).ok_or_else(torn)?);
    let sequence = input.u64().ok_or_else(torn)?;
    if &input.array::<32>().ok_or_else(torn)? != case_hash {
        return Err(CheckpointError::OtherCase { path });
    }
    let stamp = Stamp {
        step: input.u64().ok_or_else(torn)?,
        increment: input.u64().ok_or_else(torn)?,
        time: f64::from_bits(input.u64().ok_or_else(torn)?),
    };
    let narray = input.u64().ok_or_else(torn)?;
    let archive = Archive::decode(&mut input, narray).map_err(corrupt)?;
    Ok(Checkpoint {
        path,
        sequence,
        stamp,
        archive,
        passed_over: None,
    })
}

#[cfg(test)]
mod tests;
