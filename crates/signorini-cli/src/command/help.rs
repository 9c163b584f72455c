//! `signorini help [TOPIC..]`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::explain::{self, Explained};
use clap::{Args, Command};
use signorini_io::diagnostic::closest;

/// Explain a command, a key of cases, or the code of a message.
#[derive(Debug, Args)]
pub struct Help {
    /// A command such as run, a key such as contact.friction, or a code such as S0501
    topic: Option<String>,
}

impl Help {
    pub fn execute(self, mut all: Command) -> u8 {
        let out = Console::stdout();
        let Some(topic) = self.topic else {
            out.text(&all.render_help().to_string());
            return 0;
        };
        all.build();
        if let Some(command) = all.find_subcommand_mut(&topic) {
            out.text(&command.render_long_help().to_string());
            return 0;
        }
        match explain::of(&topic) {
            Explained::Unknown(near) => {
                let names: Vec<&str> = all.get_subcommands().map(Command::get_name).collect();
                let near = closest(&topic, names.iter().copied())
                    .map(str::to_owned)
                    .or(near);
                let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
                Console::stderr().line(&format!(
                    "error: there is no command, key or code \"{topic}\"{near}\n  commands: {}",
                    names.join(", ")
                ));
                WRONG_COMMAND
            }
            known => explain::print(&topic, known),
        }
    }
}
