//! The records of a deck, with those of its included files in their places.

use super::fault::{Fault, RecordError, shown};
use super::record::Record;
use crate::diagnostic::{Place, SourceFile};
use crate::fs::Fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How deep files may include each other.
const DEPTH: usize = 10;

/// How many bytes all files may come to, an included one as often as it is.
const MOST: usize = 1 << 30;

/// What stands in a deck.
pub(super) struct Text {
    /// Lines that are no comments, in order; a backslash at the end joins the next one.
    pub lines: Vec<Line>,
    /// Lines of the check block, without those around it; none where there is no block.
    pub checks: Option<Checks>,
}

/// A line, or several that belong together.
pub(super) struct Line {
    pub file: Arc<SourceFile>,
    pub stretches: Vec<Range<usize>>,
}

/// The check block.
#[derive(Clone, Debug)]
pub struct Checks {
    /// Its head, from the mark on.
    pub head: Record,
    /// Its records.
    pub records: Vec<Record>,
    /// Whether its end was found.
    pub closed: bool,
}

impl Line {
    pub fn record(&self) -> Record {
        Record::new(&self.file, &self.stretches)
    }

    /// As it stands there.
    pub fn raw(&self) -> &str {
        let range = self.stretches.first().cloned().unwrap_or_default();
        self.file.text().get(range).unwrap_or_default().trim()
    }
}

/// Walks through files.
struct Walk<'f> {
    fs: &'f dyn Fs,
    text: Text,
    open: Vec<PathBuf>,
    nbyte: usize,
}

/// Reads a deck and everything that it includes, relative to the folder of the file that names it.
pub(super) fn read(fs: &dyn Fs, name: &str, text: String) -> Result<Text, Fault> {
    let mut walk = Walk {
        fs,
        text: Text {
            lines: Vec::new(),
            checks: None,
        },
        open: Vec::new(),
        nbyte: 0,
    };
    walk.file(name, text, &Place::nowhere())?;
    Ok(walk.text)
}

impl Walk<'_> {
    /// Goes through a file. The depth of files in files is limited, and with it that of the calls.
    fn file(&mut self, name: &str, text: String, place: &Place) -> Result<(), Fault> {
        self.nbyte += text.len();
        if self.nbyte > MOST {
            let error = RecordError::Excess {
                what: "the included files",
            };
            return Err(Fault {
                place: place.clone(),
                error,
            });
        }
        let file = SourceFile::new(name, text);
        self.open.push(PathBuf::from(name));
        let mut goes_on = false;
        for range in lines(file.text()) {
            let line = file.text().get(range.clone()).unwrap_or_default();
            if !goes_on && line.starts_with('#') {
                self.comment(&file, range, line);
                continue;
            }
            if !goes_on && line.trim().is_empty() {
                continue;
            }
            if let Some(rest) = line.strip_prefix("@include").filter(|_| !goes_on) {
                let wanted = rest.trim().trim_matches('"').to_owned();
                self.include(&wanted, &Place::new(&file, range))?;
                continue;
            }
            let trimmed = line.trim_end();
            let kept = trimmed.strip_suffix('\\').unwrap_or(trimmed).len();
            let stretch = range.start..range.start + kept;
            match self.text.lines.last_mut().filter(|_| goes_on) {
                Some(last) => last.stretches.push(stretch),
                None => self.text.lines.push(Line {
                    file: Arc::clone(&file),
                    stretches: vec![stretch],
                }),
            }
            goes_on = kept < trimmed.len();
        }
        self.open.pop();
        Ok(())
    }

    fn comment(&mut self, file: &Arc<SourceFile>, range: Range<usize>, line: &str) {
        let record = || Record::new(file, std::slice::from_ref(&range));
        match &mut self.text.checks {
            None if line.starts_with("#%BEGIN_CHECK%") => {
                self.text.checks = Some(Checks {
                    head: record(),
                    records: Vec::new(),
                    closed: false,
                });
            }
            Some(block) if !block.closed => {
                if line.starts_with("#%END_CHECK%") {
                    block.closed = true;
                } else if !line.starts_with("##") && line.trim() != "#" {
                    block.records.push(record());
                }
            }
            _ => {}
        }
    }

    fn include(&mut self, wanted: &str, place: &Place) -> Result<(), Fault> {
        let refused = |why: String| Fault {
            place: place.clone(),
            error: RecordError::NotBuilt {
                what: format!("including `{}`", shown(wanted)),
                why,
            },
        };
        let folder = self.open.last().and_then(|path| path.parent());
        let path = folder.unwrap_or(Path::new("")).join(wanted);
        if self.open.contains(&path) {
            return Err(refused(
                "the file includes itself, directly or through others; remove this line".into(),
            ));
        }
        if self.open.len() >= DEPTH {
            let why = format!("files include each other more than {DEPTH} deep; put them into one");
            return Err(refused(why));
        }
        let bytes = self.fs.read(&path);
        let bytes = bytes.map_err(|error| refused(error.to_string()))?;
        if bytes.contains(&0) {
            return Err(refused("the file is not text: it holds zero bytes".into()));
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        self.file(&path.display().to_string(), text, place)
    }
}

/// The lines of a text, whatever they end with, without their ends.
fn lines(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = text.get(at..).filter(|rest| !rest.is_empty())?;
        let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let line = at..at + length;
        let end = rest.get(length..).unwrap_or_default();
        at += length
            + if end.starts_with("\r\n") {
                2
            } else {
                1.min(end.len())
            };
        Some(line)
    })
}
