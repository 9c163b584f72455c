//! A folder of results, as far as it is there.
//!
//! Every file may be missing: a run that was killed has no `summary.json`, one with `format = ["frd"]` no frames. What is
//! there but cannot be read gives a note in place of an error; only a folder with none of the files is refused.

use crate::error::ReportError;
use crate::table::Table;
use serde_json::Value;
use signorini_io::fs::Fs;
use signorini_io::vtk::{self, Vtu};
use signorini_io::writers::json::Summary;
use signorini_io::writers::pvd::Pvd;
use std::path::{Path, PathBuf};

/// Files any of which makes a folder one of results.
const SIGNS: [&str; 5] = [
    "summary.json",
    "results.pvd",
    "history.csv",
    "events.jsonl",
    "case.resolved.toml",
];

/// The files of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameFiles {
    /// Total time.
    pub time: f64,
    /// The file of the solids, relative to the folder.
    pub volume: Option<String>,
    /// The file of the secondary sides of contacts, relative to the folder.
    pub contact: Option<String>,
}

/// A frame, as read.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Total time.
    pub time: f64,
    /// The solids, or, where they are not written, the secondary sides of contacts.
    pub volume: Vtu,
    /// The secondary sides of contacts.
    pub contact: Option<Vtu>,
}

/// What a folder of results holds, besides the frames.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The folder.
    pub folder: PathBuf,
    /// How the run ended; nothing where it was killed or still runs.
    pub summary: Option<Summary>,
    /// `history.csv`.
    pub history: Table,
    /// `convergence.csv`.
    pub convergence: Table,
    /// The lines of `events.jsonl`; a torn last line is left out.
    pub events: Vec<Value>,
    /// The text of `case.resolved.toml`.
    pub resolved: Option<String>,
    /// `case.resolved.toml` as values; empty where there is none.
    pub case: toml::Table,
    /// All frames, in the order of time.
    pub frames: Vec<FrameFiles>,
    /// What could not be read, and why.
    pub notes: Vec<String>,
}

impl Results {
    /// Reads everything but the frames.
    ///
    /// # Errors
    /// [`ReportError::NotResults`] for a folder that holds none of the files of a run.
    pub fn read(fs: &dyn Fs, folder: &Path) -> Result<Self, ReportError> {
        let found = |name: &str| fs.exists(&folder.join(name)).unwrap_or(false);
        if !SIGNS.iter().any(|name| found(name)) {
            return Err(ReportError::NotResults {
                folder: folder.to_path_buf(),
                wanted: SIGNS.join(", "),
            });
        }
        let mut this = Self {
            folder: folder.to_path_buf(),
            ..Self::default()
        };
        if let Some(text) = this.text(fs, "summary.json") {
            match serde_json::from_str(&text) {
                Ok(summary) => this.summary = Some(summary),
                Err(error) => this.notes.push(format!("summary.json: {error}")),
            }
        }
        this.history = this.table(fs, "history.csv");
        this.convergence = this.table(fs, "convergence.csv");
        let events = this.text(fs, "events.jsonl").unwrap_or_default();
        let lines = events.lines();
        this.events = lines
            .filter_map(|line| serde_json::from_str(line).ok())
            .collect();
        this.resolved = this.text(fs, "case.resolved.toml");
        if let Some(text) = &this.resolved {
            match text.parse() {
                Ok(case) => this.case = case,
                Err(_) => this.notes.push("case.resolved.toml: not TOML".into()),
            }
        }
        this.frames = this.list(fs);
        Ok(this)
    }

    /// The text of a file; nothing where there is none. What cannot be read gives a note.
    fn text(&mut self, fs: &dyn Fs, name: &str) -> Option<String> {
        let path = self.folder.join(name);
        if !fs.exists(&path).unwrap_or(false) {
            return None;
        }
        match fs.read(&path) {
            Ok(bytes) => Some(String::from_utf8_lossy(&bytes).into_owned()),
            Err(error) => {
                self.notes.push(error.to_string());
                None
            }
        }
    }

    fn table(&mut self, fs: &dyn Fs, name: &str) -> Table {
        self.text(fs, name)
            .map_or_else(Table::default, |text| Table::read(&text))
    }

    /// The frames of both lists, joined by their times.
    fn list(&mut self, fs: &dyn Fs) -> Vec<FrameFiles> {
        let mut frames: Vec<FrameFiles> = Vec::new();
        for (name, of_contact) in [("results.pvd", false), ("contact.pvd", true)] {
            let path = self.folder.join(name);
            if !fs.exists(&path).unwrap_or(false) {
                continue;
            }
            let list = match Pvd::read(fs, &path) {
                Ok(list) => list,
                Err(error) => {
                    self.notes.push(error.to_string());
                    continue;
                }
            };
            for entry in list.entries() {
                let at = frames.partition_point(|frame| frame.time < entry.time);
                if frames.get(at).is_none_or(|frame| frame.time != entry.time) {
                    let frame = FrameFiles {
                        time: entry.time,
                        ..FrameFiles::default()
                    };
                    frames.insert(at, frame);
                }
                if let Some(frame) = frames.get_mut(at) {
                    let place = match of_contact {
                        true => &mut frame.contact,
                        false => &mut frame.volume,
                    };
                    place.get_or_insert_with(|| entry.file.clone());
                }
            }
        }
        frames
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`ReportError::NoFrame`] for a number that is too large, [`ReportError::Frame`], [`ReportError::Fs`].
    pub fn frame(&self, fs: &dyn Fs, number: usize) -> Result<Frame, ReportError> {
        let Some(files) = self.frames.get(number) else {
            return Err(match self.frames.len().checked_sub(1) {
                Some(last) => ReportError::NoFrame {
                    wanted: number,
                    last,
                },
                None => ReportError::NoFrames {
                    folder: self.folder.clone(),
                    why: String::new(),
                },
            });
        };
        let grid = |file: &String| -> Result<Vtu, ReportError> {
            let bytes = fs.read(&self.folder.join(file))?;
            vtk::read(&bytes).map_err(|source| ReportError::Frame {
                file: file.clone(),
                source,
            })
        };
        let contact = files.contact.as_ref().map(grid).transpose()?;
        let volume = match (&files.volume, &contact) {
            (Some(file), _) => grid(file)?,
            (None, Some(contact)) => contact.clone(),
            (None, None) => Vtu::default(),
        };
        Ok(Frame {
            time: files.time,
            volume,
            contact,
        })
    }

    /// The events of a kind, in the order of time.
    pub fn events_of(&self, kind: &str) -> impl Iterator<Item = &Value> {
        self.events.iter().filter(move |event| event["ev"] == kind)
    }

    /// The title of the case; the name of the folder where it has none.
    #[must_use]
    pub fn title(&self) -> String {
        let title = self.case.get("title").and_then(toml::Value::as_str);
        match title.filter(|title| !title.trim().is_empty()) {
            Some(title) => title.to_owned(),
            None => self.name(),
        }
    }

    /// The name of the folder.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.folder.file_name();
        name.map_or_else(
            || "results".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        )
    }

    /// Whether the model is a body of revolution: the only resultant that is not zero is the force along y.
    #[must_use]
    pub fn is_axisymmetric(&self) -> bool {
        let model = self.case.get("model").and_then(|model| model.get("space"));
        model.and_then(toml::Value::as_str) == Some("axisymmetric")
    }

    /// The label of the case's units, such as `mm-N-MPa`; empty where it is not known.
    #[must_use]
    pub fn units(&self) -> &str {
        let units = self.case.get("units").and_then(toml::Value::as_str);
        units.unwrap_or_default()
    }
}
