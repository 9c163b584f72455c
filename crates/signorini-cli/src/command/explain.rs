//! `signorini explain CODE`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use clap::Args;
use signorini_io::diagnostic::{Code, codes};

/// Explain the code of a message.
#[derive(Debug, Args)]
pub struct Explain {
    /// A code such as S0501; all of them where absent
    code: Option<String>,
}

impl Explain {
    pub fn execute(self) -> u8 {
        let out = Console::stdout();
        let Some(code) = self.code else {
            for code in codes::ALL {
                out.line(&format!("{}  {}", code.id, code.title));
            }
            return 0;
        };
        match Code::find(&code) {
            Some(code) => {
                out.text(&code.explanation());
                0
            }
            None => {
                Console::stderr().line(&format!(
                    "error: there is no code \"{code}\"; list them: signorini explain"
                ));
                WRONG_COMMAND
            }
        }
    }
}
