//! Writing to standard output and standard error without ever failing: a closed pipe is no reason to stop a run.

mod letters;

pub use letters::ascii;

use super::ranks;
use signorini::Diagnostics;
use std::io::{IsTerminal, Write};

/// Width of a terminal that does not report its own.
const USUAL_WIDTH: usize = 80;

/// One of the two standard streams.
pub struct Console {
    stream: Stream,
    /// Whether it is a terminal.
    pub terminal: bool,
    /// Whether it is a terminal that moves its cursor and wants to be drawn on.
    pub draws: bool,
    /// Whether colours are wanted.
    pub colour: bool,
    /// Whether letters beyond ASCII cannot be shown.
    pub ascii: bool,
}

enum Stream {
    Out,
    Error,
    /// Of a process for which another one speaks.
    Nowhere,
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

    fn new(stream: Stream, is_terminal: bool) -> Self {
        let (stream, terminal) = match ranks::speaks() {
            true => (stream, is_terminal),
            false => (Stream::Nowhere, false),
        };
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|t| t == "dumb");
        Self {
            stream,
            terminal,
            draws: terminal && !dumb,
            colour: terminal && !refused && !dumb,
            ascii: letters::is_ascii(|name| std::env::var(name).ok()),
        }
    }

    /// Writes a text for people, in the letters that can be shown. What cannot be written is lost.
    pub fn text(&self, text: &str) {
        if self.ascii {
            self.raw(&ascii(text));
        } else {
            self.raw(text);
        }
    }

    /// Writes a text for machines, as it is.
    pub fn raw(&self, text: &str) {
        let written = |out: &mut dyn Write| {
            let _ = out.write_all(text.as_bytes());
            let _ = out.flush();
        };
        match self.stream {
            Stream::Out => written(&mut std::io::stdout().lock()),
            Stream::Error => written(&mut std::io::stderr().lock()),
            Stream::Nowhere => {}
        }
    }

    /// Writes a line.
    pub fn line(&self, line: &str) {
        self.text(&format!("{line}\n"));
    }

    /// Writes findings, broken where a terminal is narrower.
    pub fn findings(&self, findings: &Diagnostics) {
        if findings.is_empty() {
            return;
        }
        let text = if self.colour {
            findings.coloured()
        } else {
            findings.plain()
        };
        match self.width() {
            Some(width) => text
                .lines()
                .for_each(|line| self.line(&fitted(line, width))),
            None => self.text(&text),
        }
    }

    /// Characters in a line of the terminal now; none where it is none.
    pub fn width(&self) -> Option<usize> {
        if !self.terminal {
            return None;
        }
        let term = match self.stream {
            Stream::Out => console::Term::stdout(),
            Stream::Error => console::Term::stderr(),
            Stream::Nowhere => return None,
        };
        let asked = term.size_checked().map(|(_, columns)| usize::from(columns));
        Some(asked.filter(|width| *width > 0).unwrap_or(USUAL_WIDTH))
    }
}

/// A line broken between words where it is longer than a width; what follows is set in a little further.
pub fn fitted(line: &str, width: usize) -> String {
    if console::measure_text_width(line) < width {
        return line.to_owned();
    }
    let blanks = line.chars().take_while(|c| *c == ' ').count();
    let indent = " ".repeat((blanks + 4).min(width / 3));
    // the last column stays free: some terminals break a line behind it
    let options = textwrap::Options::new(width.saturating_sub(1).max(8))
        .subsequent_indent(&indent)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(line, options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_between_words_and_set_in() {
        let line = "  the quick brown fox jumps over the lazy dog";
        let fit = fitted(line, 24);
        for part in fit.lines() {
            assert!(part.chars().count() < 24, "{fit}");
        }
        assert!(fit.lines().skip(1).all(|part| part.starts_with("      ")));
        assert_eq!(fitted(line, 80), line);
        let word = "x".repeat(100);
        assert!(fitted(&word, 30).lines().all(|part| part.len() < 30));
    }
}
