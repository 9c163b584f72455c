//! The folder that a client works in: paths that lead out of it are refused, and files are reached through it alone.
//!
//! ```text
//! text of the client ──▶ Root::place: relative, no "..", no hidden name ──▶ Place
//! Place ──▶ cap-std's Dir, an open folder: every part of a path is looked up below it, links included
//! Place ──▶ "./a/b.toml", an argument of the command, which is confined to the folder, too
//! ```
//!
//! The folder is opened once and files are opened relative to it (`openat2` where the system has it), so that nothing that is
//! renamed or replaced by a link meanwhile leads elsewhere. Hidden names, those with a dot in front, are not used at all: they
//! are the settings of other programs.

use crate::reply::Refusal;
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, Metadata};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// Bytes that a path may have.
const LONGEST: usize = 1024;

/// The extensions of texts that may be written: what the command reads, and tables and notes.
pub const WRITABLE: [&str; 9] = ["toml", "inp", "in", "inc", "msh", "stl", "csv", "txt", "md"];

/// The extensions of texts that runs leave, which may be read, too.
pub const LEFT_BY_RUNS: [&str; 4] = ["log", "sta", "dat", "json"];

/// A folder that is worked in.
#[derive(Debug)]
pub struct Root {
    dir: Dir,
    /// Where it is, with links resolved.
    path: PathBuf,
}

/// A path in the folder, whether or not there is something: names only, one at least unless it is the folder itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    names: PathBuf,
}

impl Place {
    /// As an argument of the command that runs in the folder. It starts with `./`, so that it is never an option.
    pub fn argument(&self) -> String {
        format!("./{}", self.shown())
    }

    /// As clients see it: relative to the folder, with slashes.
    pub fn shown(&self) -> String {
        let names = self.names.iter().map(|name| name.to_string_lossy());
        let shown = names.collect::<Vec<_>>().join("/");
        if shown.is_empty() { ".".into() } else { shown }
    }

    /// A file in this folder.
    pub fn join(&self, name: &str) -> Self {
        Self {
            names: self.names.join(name),
        }
    }

    /// The folder of results of a case that names none.
    pub fn results(&self) -> Self {
        Self {
            names: self.names.with_extension("out"),
        }
    }

    /// The extension, in lower case.
    pub fn extension(&self) -> String {
        let extension = self.names.extension().unwrap_or_default();
        extension.to_string_lossy().to_lowercase()
    }

    fn as_path(&self) -> &Path {
        if self.names.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &self.names
        }
    }
}

/// What is at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A file.
    File,
    /// A folder.
    Folder,
    /// Neither: a device, a socket.
    Other,
    /// Nothing.
    Nothing,
}

impl Kind {
    fn of(data: &Metadata) -> Self {
        if data.is_file() {
            Self::File
        } else if data.is_dir() {
            Self::Folder
        } else {
            Self::Other
        }
    }
}

/// A file or folder of a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its path, relative to the root.
    pub path: String,
    /// What it is; links are not followed and count as other things.
    pub kind: Kind,
    /// Bytes of a file.
    pub size: u64,
}

impl Root {
    /// Opens a folder.
    ///
    /// # Errors
    /// Those of the system.
    pub fn open(path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        let dir = Dir::open_ambient_dir(&path, ambient_authority())?;
        Ok(Self { dir, path })
    }

    /// Where it is, with links resolved.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The place that a text names: relative to the folder, or absolute and in it.
    ///
    /// # Errors
    /// Paths that lead out of the folder by their text or by links, hidden names, and texts that are no paths.
    pub fn place(&self, text: &str) -> Result<Place, Refusal> {
        let refused = |why: &str| Refusal::path(text, why);
        if text.len() > LONGEST {
            return Err(refused("it is longer than 1024 bytes"));
        }
        if text.is_empty() || text.chars().any(char::is_control) {
            return Err(refused("it is empty or has control characters"));
        }
        let given = Path::new(text);
        let given = given.strip_prefix(&self.path).unwrap_or(given);
        let mut names = PathBuf::new();
        for part in given.components() {
            match part {
                Component::CurDir => {}
                Component::Normal(name) if name.to_string_lossy().starts_with('.') => {
                    return Err(refused("names that start with a dot are not used"));
                }
                Component::Normal(name) => names.push(name),
                Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                    return Err(refused("it leads out of the folder of this server"));
                }
            }
        }
        let place = Place { names };
        self.follow(&place)?;
        Ok(place)
    }

    /// Whether all links on the way lead to places in the folder.
    fn follow(&self, place: &Place) -> Result<(), Refusal> {
        let mut way = PathBuf::new();
        for name in &place.names {
            way.push(name);
            match self.dir.metadata(&way) {
                Ok(_) => {}
                Err(e) if e.kind() == io::ErrorKind::NotFound => {
                    // a link that leads to nothing would become a file elsewhere
                    return match self.dir.symlink_metadata(&way) {
                        Ok(_) => Err(Refusal::path(
                            &place.shown(),
                            "a link in it leads to nothing",
                        )),
                        Err(_) => Ok(()),
                    };
                }
                Err(e) => {
                    let why = format!(
                        "it leads out of the folder of this server, or cannot be used: {e}"
                    );
                    return Err(Refusal::path(&place.shown(), &why));
                }
            }
        }
        Ok(())
    }

    /// What is at a place.
    pub fn kind(&self, place: &Place) -> Kind {
        let data = self.dir.metadata(place.as_path());
        data.map_or(Kind::Nothing, |data| Kind::of(&data))
    }

    /// The place of a file that must be there.
    ///
    /// # Errors
    /// As [`Root::place`]; no file there.
    pub fn file(&self, text: &str) -> Result<Place, Refusal> {
        self.expect(text, Kind::File, "there is no file of this name")
    }

    /// The place of a folder that must be there.
    ///
    /// # Errors
    /// As [`Root::place`]; no folder there.
    pub fn folder(&self, text: &str) -> Result<Place, Refusal> {
        self.expect(text, Kind::Folder, "there is no folder of this name")
    }

    fn expect(&self, text: &str, kind: Kind, why: &str) -> Result<Place, Refusal> {
        let place = self.place(text)?;
        if self.kind(&place) == kind {
            Ok(place)
        } else {
            Err(Refusal::path(text, why))
        }
    }

    /// Opens a file for reading.
    ///
    /// # Errors
    /// Those of the system; what is no plain file.
    pub fn reader(&self, place: &Place) -> io::Result<File> {
        // asked before: a pipe would wait for a writer
        if self.kind(place) != Kind::File {
            return Err(io::ErrorKind::NotFound.into());
        }
        self.dir.open(place.as_path())
    }

    /// Reads a file of at most `most` bytes.
    ///
    /// # Errors
    /// Those of the system; [`io::ErrorKind::FileTooLarge`] for a longer file.
    pub fn read(&self, place: &Place, most: usize) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let more = most as u64 + 1;
        self.reader(place)?.take(more).read_to_end(&mut bytes)?;
        if bytes.len() > most {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        Ok(bytes)
    }

    /// Replaces a file as a whole; folders on the way are made.
    ///
    /// # Errors
    /// Those of the system.
    pub fn write(&self, place: &Place, text: &[u8]) -> io::Result<()> {
        let path = place.as_path();
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            self.dir.create_dir_all(folder)?;
        }
        let mut draft = path.as_os_str().to_owned();
        draft.push(format!(".{}.tmp", std::process::id()));
        let draft = PathBuf::from(draft);
        let written = self
            .dir
            .write(&draft, text)
            .and_then(|()| self.dir.rename(&draft, &self.dir, path));
        if written.is_err() {
            let _ = self.dir.remove_file(&draft);
        }
        written
    }

    /// Lists a folder and those in it down to `depth` more levels, by name, at most `most` entries; whether that is all.
    ///
    /// # Errors
    /// Those of the system, for the folder itself.
    pub fn list(&self, place: &Place, depth: usize, most: usize) -> io::Result<(Vec<Entry>, bool)> {
        let mut found = Vec::new();
        let is_all = self.add(place, depth, most, &mut found)?;
        Ok((found, is_all))
    }

    fn add(
        &self,
        place: &Place,
        depth: usize,
        most: usize,
        found: &mut Vec<Entry>,
    ) -> io::Result<bool> {
        let mut names = Vec::new();
        for entry in self.dir.read_dir(place.as_path())? {
            let name = entry?.file_name();
            if let Some(name) = name.to_str().filter(|name| !name.starts_with('.')) {
                names.push(name.to_owned());
            }
        }
        names.sort();
        for name in names {
            if found.len() == most {
                return Ok(false);
            }
            let inner = place.join(&name);
            let Ok(data) = self.dir.symlink_metadata(inner.as_path()) else {
                continue;
            };
            let kind = Kind::of(&data);
            found.push(Entry {
                path: inner.shown(),
                kind,
                size: if kind == Kind::File { data.len() } else { 0 },
            });
            // a folder that may not be listed is listed as empty
            if kind == Kind::Folder
                && depth > 0
                && !self.add(&inner, depth - 1, most, found).unwrap_or(true)
            {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
