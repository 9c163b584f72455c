//! The lines of a deck, with those of its included files in their places.

use super::card;
use crate::fs::Fs;
use crate::readers::MeshError;
use crate::readers::error::{Place, excerpt};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// How deep files may include each other; Abaqus allows 5, CalculiX 9.
const DEPTH: usize = 10;

/// How many bytes files that are included again may come to.
const REPEATED: usize = 1 << 28;

/// A line of one of the files.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spot {
    file: u32,
    line: u32,
}

impl Spot {
    /// Whether another line is the one after it.
    pub const fn precedes(self, other: Self) -> bool {
        self.file == other.file && self.line + 1 == other.line
    }
}

/// Lines of one file that follow each other.
struct Stretch {
    file: u32,
    bytes: Range<usize>,
    line: u32,
}

/// The deck and what it includes.
pub(super) struct Files<'a> {
    files: Vec<(String, Cow<'a, [u8]>)>,
    stretches: Vec<Stretch>,
}

/// A file that is being walked through.
struct Open {
    file: usize,
    at: usize,
    line: u32,
}

impl<'a> Files<'a> {
    /// Reads everything that the deck includes. Paths are relative to the folder of the file that names them, as in
    /// Abaqus, else to the one of the deck, else to the working folder, as in CalculiX.
    pub fn open(fs: &dyn Fs, name: &str, bytes: &'a [u8]) -> Result<Self, MeshError> {
        let mut this = Self {
            files: vec![(name.to_owned(), Cow::Borrowed(bytes))],
            stretches: Vec::new(),
        };
        is_text(name, bytes)?;
        let mut known = HashMap::from([(PathBuf::from(name), 0)]);
        let mut open = vec![Open {
            file: 0,
            at: 0,
            line: 1,
        }];
        let mut left = REPEATED;
        while let Some(Open { file, at, line }) = open.pop() {
            let text = this.text(file);
            let Some(Inclusion {
                kept,
                end,
                path: wanted,
            }) = next_inclusion(text, at)
            else {
                this.push(file, at..text.len(), line);
                continue;
            };
            let next = line + count_lines(text.get(at..end).unwrap_or_default());
            let spot = Spot {
                file: file as u32,
                line: next.saturating_sub(1),
            };
            this.push(file, at..kept, line);
            open.push(Open {
                file,
                at: end,
                line: next,
            });
            let nfile = this.files.len();
            let included = this.include(fs, &wanted, spot, &mut known)?;
            if included < nfile {
                let nbyte = 256 + this.text(included).len();
                left = left.checked_sub(nbyte).ok_or_else(|| MeshError::Excess {
                    place: this.place(spot),
                    what: "the included files",
                })?;
            }
            if open.iter().any(|o| o.file == included) {
                return Err(MeshError::IncludeCycle {
                    place: this.place(spot),
                    path: wanted,
                });
            }
            if open.len() >= DEPTH {
                return Err(MeshError::IncludeDepth {
                    place: this.place(spot),
                    limit: DEPTH,
                });
            }
            open.push(Open {
                file: included,
                at: 0,
                line: 1,
            });
        }
        Ok(this)
    }

    /// Reads a file that another one names, once.
    fn include(
        &mut self,
        fs: &dyn Fs,
        wanted: &str,
        spot: Spot,
        known: &mut HashMap<PathBuf, usize>,
    ) -> Result<usize, MeshError> {
        let folder = |file: u32| {
            let name = self.files.get(file as usize).map_or("", |(name, _)| name);
            Path::new(name).parent().unwrap_or(Path::new("")).to_owned()
        };
        let tried = [folder(spot.file), folder(0), PathBuf::new()].map(|f| f.join(wanted));
        if let Some(file) = tried.iter().find_map(|path| known.get(path)) {
            return Ok(*file);
        }
        let mut first = None;
        for path in tried {
            match fs.read(&path) {
                Ok(bytes) => {
                    let name = path.display().to_string();
                    is_text(&name, &bytes)?;
                    self.files.push((name, Cow::Owned(bytes)));
                    known.insert(path, self.files.len() - 1);
                    return Ok(self.files.len() - 1);
                }
                Err(error) => first = first.or(Some(error.to_string())),
            }
        }
        Err(MeshError::Include {
            place: self.place(spot),
            path: excerpt(wanted.as_bytes()),
            why: first.unwrap_or_default(),
        })
    }

    fn text(&self, file: usize) -> &[u8] {
        self.files.get(file).map_or(&[], |(_, bytes)| bytes)
    }

    fn push(&mut self, file: usize, bytes: Range<usize>, line: u32) {
        self.stretches.push(Stretch {
            file: file as u32,
            bytes,
            line,
        });
    }

    /// The place of a line, for messages.
    pub fn place(&self, spot: Spot) -> Place {
        let file = self.files.get(spot.file as usize);
        Place::Line {
            file: file.map_or(String::new(), |(name, _)| name.clone()),
            line: spot.line as usize,
        }
    }

    /// The deck as a whole.
    pub fn whole(&self) -> Place {
        let file = self.files.first();
        Place::File(file.map_or(String::new(), |(name, _)| name.clone()))
    }

    /// How many bytes there are in all files together, each once.
    pub fn nbyte(&self) -> usize {
        self.files.iter().map(|(_, bytes)| bytes.len()).sum()
    }

    /// All lines in order.
    pub fn lines(&self) -> Lines<'_> {
        Lines {
            files: self,
            next: 0,
            rest: &[],
            spot: Spot::default(),
            pending: None,
        }
    }
}

/// Whether a file is text in one byte per character, or UTF-8.
fn is_text(name: &str, bytes: &[u8]) -> Result<(), MeshError> {
    let place = Place::File(name.to_owned());
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(MeshError::Utf16 { place });
    }
    if bytes.contains(&0) {
        return Err(MeshError::NotText { place });
    }
    Ok(())
}

/// A card that names a file.
struct Inclusion {
    /// Up to where the text stands before the file: *INCLUDE itself goes, other cards take the file as their data.
    kept: usize,
    /// Where the text goes on behind it.
    end: usize,
    path: String,
}

/// The next card that names a file to be read.
fn next_inclusion(text: &[u8], from: usize) -> Option<Inclusion> {
    let mut at = from;
    loop {
        let rest = text.get(at..)?;
        let star = at + rest.iter().position(|&b| b == b'*')?;
        let before = text.get(..star)?.iter().rev();
        let starts_line = before
            .take_while(|&&b| b != b'\n' && b != b'\r')
            .all(|&b| b == b' ' || b == b'\t' || !b.is_ascii());
        let mut end = star;
        let line = split_line(text, &mut end);
        if starts_line && line.get(..2) != Some(b"**") {
            // a card goes on on the next line where it ends with a comma
            let mut whole = line.trim_ascii_end().to_vec();
            let mut after = end;
            while whole.ends_with(b",") && after < text.len() {
                let more = split_line(text, &mut after).trim_ascii();
                if more.starts_with(b"*") {
                    break;
                }
                whole.extend_from_slice(more);
                end = after;
                if more.is_empty() {
                    break;
                }
            }
            if let Some((path, is_data)) = card::included(&whole) {
                let kept = if is_data { end } else { star };
                return Some(Inclusion { kept, end, path });
            }
        }
        at = end;
    }
}

/// The line that starts at `at`, without its end; moves `at` behind it.
fn split_line<'t>(text: &'t [u8], at: &mut usize) -> &'t [u8] {
    let rest = text.get(*at..).unwrap_or_default();
    let end = rest.iter().position(|&b| b == b'\n' || b == b'\r');
    let end = end.unwrap_or(rest.len());
    let (line, after) = rest.split_at(end);
    let newline = if after.starts_with(b"\r\n") { 2 } else { 1 };
    *at += end + newline.min(after.len());
    #[cfg(test)]
    SCANNED.set(SCANNED.get() + end as u64);
    line
}

#[cfg(test)]
thread_local! {
    /// Bytes in which ends of lines have been searched for on this thread.
    pub(super) static SCANNED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

fn count_lines(text: &[u8]) -> u32 {
    let mut at = 0;
    let mut count = 0;
    while at < text.len() {
        split_line(text, &mut at);
        count += 1;
    }
    count
}

/// A walk through all lines but comments and empty ones.
pub(super) struct Lines<'f> {
    files: &'f Files<'f>,
    next: usize,
    rest: &'f [u8],
    /// The line that was given last.
    pub spot: Spot,
    pending: Option<&'f [u8]>,
}

impl<'f> Lines<'f> {
    /// The next line, without white space at its ends.
    pub fn line(&mut self) -> Option<&'f [u8]> {
        if let Some(line) = self.pending.take() {
            return Some(line);
        }
        loop {
            while self.rest.is_empty() {
                let stretch = self.files.stretches.get(self.next)?;
                self.next += 1;
                let text = self.files.text(stretch.file as usize);
                self.rest = text.get(stretch.bytes.clone()).unwrap_or_default();
                self.spot = Spot {
                    file: stretch.file,
                    line: stretch.line.saturating_sub(1),
                };
                if stretch.bytes.start == 0 {
                    self.rest = self.rest.strip_prefix(b"\xef\xbb\xbf").unwrap_or(self.rest);
                }
            }
            let mut at = 0;
            let line = split_line(self.rest, &mut at).trim_ascii();
            self.rest = self.rest.get(at..).unwrap_or_default();
            self.spot.line = self.spot.line.saturating_add(1);
            if !line.is_empty() && !line.starts_with(b"**") {
                return Some(line);
            }
        }
    }

    /// The next data line of a card; nothing where another card or the end follows.
    pub fn data(&mut self) -> Option<&'f [u8]> {
        let line = self.line()?;
        if line.starts_with(b"*") {
            self.pending = Some(line);
            return None;
        }
        Some(line)
    }

    /// Whether nothing follows: no card waits where data ended.
    pub const fn is_at_end(&self) -> bool {
        self.pending.is_none()
    }

    /// The place of the line that was given last.
    pub fn place(&self) -> Place {
        self.files.place(self.spot)
    }

    /// The file and the number of a line.
    pub fn source(&self, spot: Spot) -> (&'f str, usize) {
        let file = self.files.files.get(spot.file as usize);
        (file.map_or("", |(name, _)| name), spot.line as usize)
    }

    /// The place of an earlier line.
    pub fn place_of(&self, spot: Spot) -> Place {
        self.files.place(spot)
    }
}
