//! A file of a fixed head and rows that end with a newline, grown row by row and cut back by rows.

use std::path::{Path, PathBuf};

use crate::fs::{Fs, FsError, Log};

/// Why a growing file could not be written or gone on with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RowsError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// The file starts differently: it belongs to another case or version.
    #[error("{} does not start with the columns of this run; start again with --fresh", path.display())]
    OtherHead {
        /// The file.
        path: PathBuf,
    },
    /// The file has lost rows that the checkpoint counts on.
    #[error("{} has {have} complete rows where {keep} were to be kept; start again with --fresh", path.display())]
    MissingRows {
        /// The file.
        path: PathBuf,
        /// Complete rows in the file.
        have: u64,
        /// Rows that the checkpoint counts.
        keep: u64,
    },
    /// A row has not as many cells as the table has columns; nothing was written.
    #[error("a row of {} has {got} cells for {expected} columns", path.display())]
    WrongWidth {
        /// The file.
        path: PathBuf,
        /// Number of columns.
        expected: usize,
        /// Number of cells given.
        got: usize,
    },
}

/// Whether a newline inside double quotes belongs to a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Newlines {
    /// Every newline ends a row.
    Plain,
    /// RFC 4180: newlines between double quotes do not.
    Quoted,
}

/// An open file of rows.
pub(super) struct RowFile {
    log: Box<dyn Log>,
    path: PathBuf,
    /// Complete rows so far, the head not counted.
    nrow: u64,
    /// Length of the head and the complete rows, in bytes.
    length: u64,
    /// An append failed: what follows `length` is to be cut before the next row.
    torn: bool,
}

impl RowFile {
    /// Starts the file again with `head`, which ends with a newline or is empty.
    pub fn create(fs: &dyn Fs, path: &Path, head: &str) -> Result<Self, RowsError> {
        let log = fs.open_log(path, 0)?;
        let mut file = Self {
            log,
            path: path.to_path_buf(),
            nrow: 0,
            length: 0,
            torn: false,
        };
        if !head.is_empty() {
            file.write(head)?;
        }
        Ok(file)
    }

    /// Goes on with a file that starts with `head`, after its first `keep` rows; later ones are cut off.
    pub fn resume(
        fs: &dyn Fs,
        path: &Path,
        head: &str,
        keep: u64,
        newlines: Newlines,
    ) -> Result<Self, RowsError> {
        let bytes = fs.read(path)?;
        let path_buf = path.to_path_buf();
        let Some(body) = bytes.strip_prefix(head.as_bytes()) else {
            return Err(RowsError::OtherHead { path: path_buf });
        };
        let (mut have, mut end, mut quoted) = (0, 0, false);
        for (i, byte) in body.iter().enumerate() {
            if have == keep {
                break;
            }
            quoted ^= *byte == b'"' && newlines == Newlines::Quoted;
            if *byte == b'\n' && !quoted {
                have += 1;
                end = i + 1;
            }
        }
        if have < keep {
            return Err(RowsError::MissingRows {
                path: path_buf,
                have,
                keep,
            });
        }
        let length = (head.len() + end) as u64;
        Ok(Self {
            log: fs.open_log(path, length)?,
            path: path_buf,
            nrow: keep,
            length,
            torn: false,
        })
    }

    /// Appends a row, which ends with a newline. After an error the row is not there, and the next one may be tried.
    pub fn append(&mut self, row: &str) -> Result<(), RowsError> {
        self.write(row)?;
        self.nrow += 1;
        Ok(())
    }

    /// Appends rows that are lines, all of them or none.
    pub fn append_lines(&mut self, lines: &str) -> Result<(), RowsError> {
        self.write(lines)?;
        self.nrow += lines.bytes().filter(|byte| *byte == b'\n').count() as u64;
        Ok(())
    }

    fn write(&mut self, text: &str) -> Result<(), RowsError> {
        if self.torn {
            self.log.cut(self.length)?;
            self.torn = false;
        }
        self.torn = true;
        self.log.append(text.as_bytes())?;
        self.torn = false;
        self.length += text.len() as u64;
        Ok(())
    }

    /// Makes all rows durable.
    pub fn sync(&mut self) -> Result<(), RowsError> {
        Ok(self.log.sync()?)
    }

    pub fn nrow(&self) -> u64 {
        self.nrow
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl std::fmt::Debug for RowFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RowFile")
            .field("path", &self.path)
            .field("nrow", &self.nrow)
            .finish_non_exhaustive()
    }
}
