//! Writing to standard output and standard error without ever failing: a closed pipe is no reason to stop a run.

use signorini::Diagnostics;
use std::io::{IsTerminal, Write};

/// One of the two standard streams.
pub struct Console {
    stream: Stream,
    /// Whether it is a terminal.
    pub terminal: bool,
    /// Whether colours are wanted.
    pub colour: bool,
}

enum Stream {
    Out,
    Error,
}

impl Console {
    /// Standard output.
    pub fn stdout() -> Self {
        Self::new(Stream::Out, std::io::stdout().is_terminal())
    }

    /// Standard error.
    pub fn stderr() -> Self {
        Self::new(Stream::Error, std::io::stderr().is_terminal())
    }

    fn new(stream: Stream, terminal: bool) -> Self {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|t| t == "dumb");
        Self {
            stream,
            terminal,
            colour: terminal && !refused && !dumb,
        }
    }

    /// Writes a text as it is. What cannot be written is lost.
    pub fn text(&self, text: &str) {
        let written = |out: &mut dyn Write| {
            let _ = out.write_all(text.as_bytes());
            let _ = out.flush();
        };
        match self.stream {
            Stream::Out => written(&mut std::io::stdout().lock()),
            Stream::Error => written(&mut std::io::stderr().lock()),
        }
    }

    /// Writes a line.
    pub fn line(&self, line: &str) {
        self.text(&format!("{line}\n"));
    }

    /// Writes findings.
    pub fn findings(&self, findings: &Diagnostics) {
        if findings.is_empty() {
            return;
        }
        self.text(&if self.colour {
            findings.coloured()
        } else {
            findings.plain()
        });
    }
}
