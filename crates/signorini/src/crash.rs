//! What is left of an error of the program itself: `crash-ID.zip`, a file to send with a report of the bug.
//!
//! ```text
//! crash.txt      the panic, its backtrace, the version, the machine, the command line
//! inputs/NAME    the case or the deck that was read; its mesh, if it is another file, is not among them
//! ```

use crate::VERSION;
use signorini_io::fs::{Fs, RealFs};
use std::backtrace::Backtrace;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// The exit code of an error of the program.
pub const EXIT_CODE: u8 = 70;

/// A larger input stays out of the file, which is sent by mail.
const LARGEST_INPUT: u64 = 16 << 20;

/// A panic, as a hook of the standard library sees it.
#[derive(Clone, Debug)]
pub struct Crash {
    /// The message and its place in the source.
    pub message: String,
    /// The functions that were active; without names where the program has no symbols.
    pub backtrace: String,
}

impl Crash {
    /// Records a panic in its hook.
    pub fn record(info: &std::panic::PanicHookInfo<'_>) -> Self {
        Self {
            message: info.to_string(),
            backtrace: Backtrace::force_capture().to_string(),
        }
    }

    /// Writes `crash-ID.zip` into the first of some folders that takes it, and returns its path.
    ///
    /// `arguments` is the command line, or what stands for it; `inputs` are files that were read. An input that is not a
    /// file, or is larger than 16 MiB, is listed in `crash.txt` instead.
    ///
    /// # Errors
    /// None of the folders takes the file: the error of the last one.
    pub fn save(
        &self,
        folders: &[PathBuf],
        arguments: &[String],
        inputs: &[PathBuf],
    ) -> io::Result<PathBuf> {
        let bytes = self.zip(arguments, inputs)?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let seconds = now.unwrap_or_default().as_secs();
        let name = format!("crash-{seconds:x}-{}.zip", std::process::id());
        let mut last = io::Error::from(io::ErrorKind::NotFound);
        for folder in folders {
            let path = folder.join(&name);
            match RealFs.write_atomic(&path, &bytes) {
                Ok(()) => return Ok(path),
                Err(error) => last = io::Error::other(error),
            }
        }
        Err(last)
    }

    fn zip(&self, arguments: &[String], inputs: &[PathBuf]) -> io::Result<Vec<u8>> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        let mut left_out = Vec::new();
        for (n, path) in inputs.iter().enumerate() {
            let Some(bytes) = input(path) else {
                left_out.push(path.display().to_string());
                continue;
            };
            // two folders may have files of one name
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let name = match n {
                0 => format!("inputs/{name}"),
                _ => format!("inputs/{n}-{name}"),
            };
            archive.start_file(name, SimpleFileOptions::default())?;
            archive.write_all(&bytes)?;
        }
        archive.start_file("crash.txt", SimpleFileOptions::default())?;
        archive.write_all(self.text(arguments, &left_out).as_bytes())?;
        Ok(archive.finish()?.into_inner())
    }

    fn text(&self, arguments: &[String], left_out: &[String]) -> String {
        let mut text = format!(
            "{}\n\nsignorini {VERSION} on {}-{}\narguments: {arguments:?}\n",
            self.message,
            std::env::consts::ARCH,
            std::env::consts::OS,
        );
        for path in left_out {
            text.push_str(&format!("not included: {path}\n"));
        }
        text.push_str(&format!("\n{}\n", self.backtrace));
        text
    }
}

/// The content of a file, unless it is none or too large.
fn input(path: &Path) -> Option<Vec<u8>> {
    let about = std::fs::metadata(path).ok()?;
    let is_fit = about.is_file() && about.len() <= LARGEST_INPUT;
    is_fit.then(|| RealFs.read(path).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use zip::ZipArchive;

    fn crash() -> Crash {
        Crash {
            message: "panicked at a.rs:1:2: index out of bounds".into(),
            backtrace: "0: main".into(),
        }
    }

    fn entry(archive: &mut ZipArchive<Cursor<Vec<u8>>>, name: &str) -> String {
        let mut text = String::new();
        let mut file = archive.by_name(name).unwrap();
        file.read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn a_crash_keeps_its_message_and_the_inputs() {
        let folder = tempfile::tempdir().unwrap();
        let case = folder.path().join("a case.toml");
        std::fs::write(&case, "format = 1\n").unwrap();
        let gone = folder.path().join("gone.inp");
        let arguments = ["run".to_owned(), "a case.toml".to_owned()];
        let folders = [folder.path().join("no such"), folder.path().into()];
        let path = crash()
            .save(&folders, &arguments, &[case, gone.clone()])
            .unwrap();
        assert_eq!(path.parent(), Some(folder.path()));

        let bytes = std::fs::read(path).unwrap();
        let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
        assert_eq!(entry(&mut archive, "inputs/a case.toml"), "format = 1\n");
        let text = entry(&mut archive, "crash.txt");
        for wanted in [
            "index out of bounds",
            VERSION,
            "a case.toml",
            "0: main",
            &format!("not included: {}", gone.display()),
        ] {
            assert!(text.contains(wanted), "{wanted} is not in {text}");
        }
    }

    #[test]
    fn a_crash_that_no_folder_takes_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let none = [folder.path().join("no such")];
        assert!(crash().save(&none, &[], &[]).is_err());
    }
}
