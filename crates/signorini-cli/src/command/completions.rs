//! `signorini completions SHELL`

use super::console::Console;
use clap::{Args, Command};
use clap_complete::Shell;

/// Print completions for a shell.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn execute(self, mut command: Command) -> u8 {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut command, "signorini", &mut text);
        Console::stdout().raw(&String::from_utf8_lossy(&text));
        0
    }
}
