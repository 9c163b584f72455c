//! `signorini report DIR`

use super::console::Console;
use super::findings::not_written;
use clap::Args;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{Fs, RealFs};
use signorini_report::{PageOptions, PictureOptions, ReportError, main_fields, page, picture};
use std::path::{Path, PathBuf};

/// The page in a folder of results.
const PAGE: &str = "report.html";

/// Exit codes of runs that did not start, whose folder is not theirs: command line, input, restart.
const NOT_STARTED: [u8; 3] = [2, 3, 7];

/// Write results as one page that works offline, or as pictures.
#[derive(Debug, Args)]
pub struct Report {
    /// A folder of results
    folder: PathBuf,
    /// The page; DIR/report.html where absent. With --png: the folder of the pictures; DIR/pictures where absent
    #[arg(short = 'o', long = "output", value_name = "FILE")]
    output: Option<PathBuf>,
    /// A second folder of results, to be compared with
    #[arg(long, value_name = "DIR", conflicts_with = "png")]
    compare: Option<PathBuf>,
    /// Pictures only, in the format PNG; they need no browser and no graphics card
    #[arg(long)]
    png: bool,
    /// The fields of the pictures, such as von_mises or stress.XX; the main ones where absent
    #[arg(long = "field", value_name = "NAME", requires = "png")]
    fields: Vec<String>,
    /// The number of the frame of the pictures, from 0; the last one where absent
    #[arg(long, value_name = "N", requires = "png")]
    frame: Option<usize>,
    /// The factor on displacements in pictures
    #[arg(
        long,
        value_name = "FACTOR",
        requires = "png",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    warp: f64,
}

impl Report {
    pub fn execute(self) -> u8 {
        let written = match self.png {
            true => self.pictures(),
            false => self.page().map(|path| vec![path]),
        };
        match written {
            Ok(paths) => {
                for path in paths {
                    Console::stdout().line(&format!("→ {}", path.display()));
                }
                0
            }
            Err(one) => {
                let found = Diagnostics::from(one);
                Console::stderr().findings(&found);
                found.exit_code().unwrap_or(3)
            }
        }
    }

    fn page(&self) -> Result<PathBuf, Diagnostic> {
        let options = PageOptions {
            compare: self.compare.clone(),
            ..PageOptions::default()
        };
        let bytes = page(&RealFs, &self.folder, &options).map_err(|e| unreadable(&e))?;
        let path = self
            .output
            .clone()
            .unwrap_or_else(|| self.folder.join(PAGE));
        write(&path, &bytes)?;
        Ok(path)
    }

    fn pictures(&self) -> Result<Vec<PathBuf>, Diagnostic> {
        let fields = match self.fields.is_empty() {
            true => main_fields(&RealFs, &self.folder, self.frame).map_err(|e| unreadable(&e))?,
            false => self.fields.clone(),
        };
        let folder = self
            .output
            .clone()
            .unwrap_or_else(|| self.folder.join("pictures"));
        let mut paths = Vec::new();
        for field in fields {
            let options = PictureOptions {
                field: Some(field.clone()),
                frame: self.frame,
                warp: self.warp,
                ..PictureOptions::default()
            };
            let bytes = picture(&RealFs, &self.folder, &options).map_err(|e| unreadable(&e))?;
            let path = folder.join(format!("{}.png", field.replace(['/', '\\'], "_")));
            write(&path, &bytes)?;
            paths.push(path);
        }
        Ok(paths)
    }
}

/// Writes the page of a run that has just ended with this exit code, also of one that failed; returns the exit code of both.
pub fn after_run(folder: &Path, code: u8, quiet: bool) -> u8 {
    if NOT_STARTED.contains(&code) {
        return code;
    }
    match page_of(folder) {
        Ok(_) if quiet => code,
        Ok(path) => {
            Console::stderr().line(&format!("→ {}", path.display()));
            code
        }
        Err(one) => {
            let found = Diagnostics::from(one);
            Console::stderr().findings(&found);
            // how the run ended counts more than its page
            if code == 0 {
                found.exit_code().unwrap_or(6)
            } else {
                code
            }
        }
    }
}

/// Writes the page of a folder of results into it, and returns its path.
pub fn page_of(folder: &Path) -> Result<PathBuf, Diagnostic> {
    let bytes = page(&RealFs, folder, &PageOptions::default()).map_err(|e| unreadable(&e))?;
    let path = folder.join(PAGE);
    write(&path, &bytes)?;
    Ok(path)
}

/// Draws the last frame of a folder of results, coloured by its main field, and returns the path of the picture.
pub fn main_picture(folder: &Path, path: &Path) -> Result<PathBuf, Diagnostic> {
    let bytes = picture(&RealFs, folder, &PictureOptions::default()).map_err(|e| unreadable(&e))?;
    write(path, &bytes)?;
    Ok(path.to_owned())
}

/// Writes a file, and the folder that it is in.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    write_on(&RealFs, path, bytes)
}

/// As [`write`], on a disk.
pub fn write_on(disk: &dyn Fs, path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    disk.create_dir_all(folder)
        .and_then(|()| disk.write_atomic(path, bytes))
        .map_err(|error| not_written(&error))
}

fn unreadable(error: &ReportError) -> Diagnostic {
    Diagnostic::error(&codes::UNREADABLE, error.to_string()).help(error.help())
}
