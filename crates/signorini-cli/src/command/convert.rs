//! `signorini convert DECK CASE`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::options::CaseOptions;
use clap::Args;
use signorini::load_case;
use signorini_io::case::{MeshSource, resolved};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{Fs, RealFs};
use std::path::{Path, PathBuf};

/// Write a deck as a case with the same result. The mesh stays where it is: the case names the deck.
#[derive(Debug, Args)]
pub struct Convert {
    /// The deck, .inp or .in
    deck: PathBuf,
    /// The case to be written, .toml
    case: PathBuf,
    #[command(flatten)]
    changes: CaseOptions,
}

impl Convert {
    pub fn execute(self) -> u8 {
        let is = |path: &Path, wanted: &str| {
            path.extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(wanted))
        };
        let is_deck = is(&self.deck, "inp") || is(&self.deck, "in");
        if !is_deck || !is(&self.case, "toml") {
            Console::stderr()
                .text("error: convert takes a deck, .inp or .in, and writes a case, .toml\n");
            return WRONG_COMMAND;
        }
        match self.convert() {
            Ok(found) => {
                Console::stderr().findings(&found);
                Console::stdout().line(&format!("→ {}", self.case.display()));
                0
            }
            Err(found) => {
                Console::stderr().findings(&found);
                found.exit_code().unwrap_or(3)
            }
        }
    }

    fn convert(&self) -> Result<Diagnostics, Diagnostics> {
        let opened = load_case(&self.deck, &self.changes.reading())?;
        let (mut case, found) = (opened.case, opened.warnings);
        case.mesh = MeshSource::File {
            path: self.mesh().into(),
        };
        let text = resolved(&case, signorini::vocabulary());
        RealFs
            .write_atomic(&self.case, text.as_bytes())
            .map_err(|error| Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()))?;
        Ok(found)
    }

    /// The path of the deck as the case sees it: by its name where both lie in one folder, else whole.
    fn mesh(&self) -> String {
        let folder = |path: &Path| {
            path.parent()
                .map(|p| p.canonicalize().unwrap_or_else(|_| p.into()))
        };
        let name = self.deck.file_name().map(Path::new).unwrap_or(&self.deck);
        if folder(&self.deck) == folder(&self.case) {
            return name.display().to_string();
        }
        let whole = self.deck.canonicalize();
        whole
            .unwrap_or_else(|_| self.deck.clone())
            .display()
            .to_string()
    }
}
