//! `results.pvd` and `contact.pvd`: the list of frames that a viewer opens, rewritten as a whole after every frame.
//!
//! A frame is listed once its files are complete, so at any instant the list names only files that can be read.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::fs::{Fs, FsError};
use crate::vtk::xml::{Piece, Scanner, XmlError, escape};

/// One file of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Total time.
    pub time: f64,
    /// Which part of the frame the file holds, from 0.
    pub part: u32,
    /// The file, relative to the list's folder, with `/` between folders.
    pub file: String,
}

/// Why a list could not be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PvdError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// A file that was to be listed is not there.
    #[error("{} is not written yet and cannot be listed", path.display())]
    FrameMissing {
        /// The file.
        path: PathBuf,
    },
    /// The list is torn or not one of this program.
    #[error("{} is damaged ({why}); build it again from the frames of the checkpoint", path.display())]
    Damaged {
        /// The list.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
}

/// A list of frames, as it is on the disk.
#[derive(Clone, Debug, PartialEq)]
pub struct Pvd {
    path: PathBuf,
    entries: Vec<Entry>,
}

impl Pvd {
    /// An empty list that will be written to `path`; nothing is written before the first frame.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_path_buf(),
            entries: Vec::new(),
        }
    }

    /// Goes on with the list on the disk up to and including time `last`; later frames are no longer listed.
    ///
    /// # Errors
    /// [`PvdError::Damaged`] where the list is torn: use [`Pvd::with_entries`] with what the checkpoint knows;
    /// [`PvdError::FrameMissing`] where a kept frame is gone; [`PvdError::Fs`].
    pub fn resume(fs: &dyn Fs, path: &Path, last: f64) -> Result<Self, PvdError> {
        let mut entries = Self::read(fs, path)?.entries;
        entries.retain(|entry| entry.time <= last);
        Self::with_entries(fs, path, entries)
    }

    /// Writes a list of these entries.
    ///
    /// # Errors
    /// [`PvdError::FrameMissing`] where a file does not exist, [`PvdError::Fs`].
    pub fn with_entries(fs: &dyn Fs, path: &Path, entries: Vec<Entry>) -> Result<Self, PvdError> {
        let list = Self {
            path: path.to_path_buf(),
            entries,
        };
        list.require_files(fs, &list.entries)?;
        list.write(fs)?;
        Ok(list)
    }

    /// Reads a list.
    ///
    /// # Errors
    /// [`PvdError::Damaged`], [`PvdError::Fs`].
    pub fn read(fs: &dyn Fs, path: &Path) -> Result<Self, PvdError> {
        let damaged = |why: String| PvdError::Damaged {
            path: path.to_path_buf(),
            why,
        };
        let bytes = fs.read(path)?;
        let text = std::str::from_utf8(&bytes).map_err(|_| damaged("it is not text".into()))?;
        let entries = entries_of(text).map_err(|e| damaged(e.to_string()))?;
        Ok(Self {
            path: path.to_path_buf(),
            entries,
        })
    }

    /// Lists one more frame: its files, one per part, relative to the list's folder. They must be complete.
    ///
    /// # Errors
    /// [`PvdError::FrameMissing`], [`PvdError::Fs`]; the frame is then not in this list, and may be added again.
    pub fn add(&mut self, fs: &dyn Fs, time: f64, files: &[&str]) -> Result<(), PvdError> {
        let listed = self.entries.len();
        let parts = files.iter().zip(0..).map(|(file, part)| Entry {
            time,
            part,
            file: (*file).to_string(),
        });
        self.entries.extend(parts);
        let written = self
            .require_files(fs, self.entries.get(listed..).unwrap_or_default())
            .and_then(|()| self.write(fs));
        if written.is_err() {
            self.entries.truncate(listed);
        }
        written
    }

    /// What is listed, in the order of time.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The list as text.
    pub fn text(&self) -> String {
        let mut out = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n",
        );
        for Entry { time, part, file } in &self.entries {
            let file = escape(file);
            // Writing into a string cannot fail.
            let _ = writeln!(
                out,
                "    <DataSet timestep=\"{time:?}\" group=\"\" part=\"{part}\" file=\"{file}\"/>"
            );
        }
        out.push_str("  </Collection>\n</VTKFile>\n");
        out
    }

    fn write(&self, fs: &dyn Fs) -> Result<(), PvdError> {
        Ok(fs.write_atomic(&self.path, self.text().as_bytes())?)
    }

    fn require_files(&self, fs: &dyn Fs, entries: &[Entry]) -> Result<(), PvdError> {
        for entry in entries {
            let path = self
                .path
                .parent()
                .unwrap_or(Path::new(""))
                .join(&entry.file);
            if !fs.exists(&path)? {
                return Err(PvdError::FrameMissing { path });
            }
        }
        Ok(())
    }
}

fn entries_of(text: &str) -> Result<Vec<Entry>, XmlError> {
    let wrong = |what| XmlError { what, at: 0 };
    let mut scanner = Scanner::new(text);
    let mut entries = Vec::new();
    let mut is_collection = false;
    while let Some(piece) = scanner.piece()? {
        let Piece::Open(tag) = piece else { continue };
        match tag.name {
            "VTKFile" => is_collection = tag.get("type") == Some("Collection"),
            "DataSet" => {
                let time = tag
                    .get("timestep")
                    .and_then(|t| t.parse().ok())
                    .ok_or(wrong("a frame without time"))?;
                let part = tag
                    .get("part")
                    .unwrap_or("0")
                    .parse()
                    .map_err(|_| wrong("a frame with a wrong part"))?;
                let file = tag
                    .get("file")
                    .ok_or(wrong("a frame without file"))?
                    .to_string();
                entries.push(Entry { time, part, file });
            }
            _ => {}
        }
    }
    if is_collection {
        Ok(entries)
    } else {
        Err(wrong("it is not a collection"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fs::RealFs;
    use crate::vtk::xml::assert_well_formed;

    fn with_files(names: &[&str]) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        for name in names {
            let path = dir.path().join(name);
            RealFs.create_dir_all(path.parent().unwrap()).unwrap();
            RealFs.write_atomic(&path, b"x").unwrap();
        }
        dir
    }

    #[test]
    fn frames_are_listed_and_read_back_with_times_to_the_bit() {
        let names = ["frames/a 0.vtu", "frames/b&<1>.vtu", "frames/ü2.vtu"];
        let dir = with_files(&names);
        let path = dir.path().join("results.pvd");
        let mut list = Pvd::new(&path);
        list.add(&RealFs, 0.0, &names[..1]).unwrap();
        list.add(&RealFs, 0.1 + 0.2, &names[1..]).unwrap();
        assert_well_formed(&list.text());
        let back = Pvd::read(&RealFs, &path).unwrap();
        assert_eq!(back, list);
        assert_eq!(
            back.entries()[2],
            Entry {
                time: 0.1 + 0.2,
                part: 1,
                file: names[2].into()
            }
        );
    }

    #[test]
    fn a_frame_that_is_not_written_is_not_listed() {
        let dir = with_files(&["0.vtu"]);
        let path = dir.path().join("results.pvd");
        let mut list = Pvd::new(&path);
        list.add(&RealFs, 0.0, &["0.vtu"]).unwrap();
        assert!(matches!(
            list.add(&RealFs, 1.0, &["1.vtu"]),
            Err(PvdError::FrameMissing { .. })
        ));
        assert_eq!(list.entries().len(), 1);
        assert_eq!(Pvd::read(&RealFs, &path).unwrap(), list);
    }

    #[test]
    fn a_resumed_list_ends_with_the_frame_kept() {
        let dir = with_files(&["0.vtu", "1.vtu", "2.vtu"]);
        let path = dir.path().join("results.pvd");
        let mut list = Pvd::new(&path);
        for (time, name) in [(0.0, "0.vtu"), (0.1, "1.vtu"), (0.2, "2.vtu")] {
            list.add(&RealFs, time, &[name]).unwrap();
        }
        let resumed = Pvd::resume(&RealFs, &path, 0.1).unwrap();
        assert_eq!(resumed.entries(), &list.entries()[..2]);
        assert_eq!(Pvd::read(&RealFs, &path).unwrap(), resumed);
        RealFs.remove(&dir.path().join("1.vtu")).unwrap();
        assert!(matches!(
            Pvd::resume(&RealFs, &path, 0.1),
            Err(PvdError::FrameMissing { .. })
        ));
    }

    #[test]
    fn a_list_cut_at_any_length_is_refused() {
        let dir = with_files(&["0.vtu"]);
        let path = dir.path().join("results.pvd");
        let list = Pvd::with_entries(
            &RealFs,
            &path,
            vec![Entry {
                time: 0.5,
                part: 0,
                file: "0.vtu".into(),
            }],
        )
        .unwrap();
        let text = list.text();
        for length in 0..text.trim_end().len() {
            std::fs::write(&path, &text[..length]).unwrap();
            assert!(
                matches!(Pvd::read(&RealFs, &path), Err(PvdError::Damaged { .. })),
                "{length}"
            );
        }
    }
}
