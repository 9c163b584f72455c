//! `signorini completions SHELL`

use super::Cli;
use super::console::Console;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print completions for a shell.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn execute(self) -> u8 {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "signorini", &mut text);
        Console::stdout().text(&String::from_utf8_lossy(&text));
        0
    }
}
