//! A command in a pseudo terminal, and what stands on its screen.

use portable_pty::{CommandBuilder, PtySize, native_pty_system};
use std::io::Read;
use std::num::NonZero;
use std::path::Path;

/// Rows of the screen: more than any transcript has.
const ROWS: u16 = 400;

/// What a command left on the screen.
pub struct Screen {
    pub width: u16,
    pub code: u32,
    /// All that was written.
    pub raw: Vec<u8>,
    /// Whether the terminal had to wrap a line at any time.
    pub wrapped: bool,
    rows: Vec<String>,
}

/// Runs the command to its end in a terminal of this width.
pub fn shown(
    folder: &Path,
    arguments: &[&str],
    width: u16,
    environment: &[(&str, &str)],
) -> Screen {
    let size = PtySize {
        rows: ROWS,
        cols: width,
        pixel_width: 0,
        pixel_height: 0,
    };
    let pair = native_pty_system().openpty(size).unwrap();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_signorini"));
    command.args(arguments);
    command.cwd(folder);
    for name in [
        "SIGNORINI_THREADS",
        "OMP_NUM_THREADS",
        "NO_COLOR",
        "LC_CTYPE",
        "LANG",
    ] {
        command.env_remove(name);
    }
    command.env("TERM", "xterm-256color");
    command.env("LC_ALL", "C.UTF-8");
    for (name, value) in environment {
        command.env(name, value);
    }
    let mut child = pair.slave.spawn_command(command).unwrap();
    drop(pair.slave);
    let mut reader = pair.master.try_clone_reader().unwrap();
    let whole = |n: u16| NonZero::new(n).unwrap();
    let mut parser = vt100::Parser::new(whole(ROWS), whole(width), 0);
    let (mut raw, mut wrapped) = (Vec::new(), false);
    let mut chunk = [0; 4096];
    // the end of a pseudo terminal is an error on some systems
    while let Ok(n @ 1..) = reader.read(&mut chunk) {
        raw.extend_from_slice(&chunk[..n]);
        parser.process(&chunk[..n]);
        wrapped |= (0..ROWS).any(|row| parser.screen().row_wrapped(row));
    }
    let code = child.wait().unwrap().exit_code();
    let rows = parser
        .screen()
        .rows(0, width)
        .map(|row| row.trim_end().to_owned());
    Screen {
        width,
        code,
        raw,
        wrapped,
        rows: rows.collect(),
    }
}

impl Screen {
    /// The lines on the screen, with times and residuals replaced: they differ from machine to machine.
    pub fn text(&self) -> String {
        let rows = self.rows.iter().map(|row| masked(row));
        let text = rows.collect::<Vec<_>>().join("\n");
        text.trim_end().to_owned() + "\n"
    }
}

/// A line without seconds and residuals.
fn masked(line: &str) -> String {
    let mut out = String::new();
    let mut words = line.split(' ').peekable();
    while let Some(word) = words.next() {
        let is_seconds = matches!(words.peek(), Some(&"s" | &"s:"));
        let is_number = word.parse::<f64>().is_ok();
        let is_small = is_number && word.contains("e-");
        if is_number && is_seconds {
            out += "#";
        } else if is_small {
            out += &"#".repeat(word.len());
        } else {
            out += word;
        }
        out.push(' ');
    }
    out.trim_end().to_owned()
}
