//! The answer of commands that answer once: lines for people or, by `--json`, one object on standard output.
//!
//! ```text
//! {"v":1,"command":"check","ok":true,"exit_code":0,"diagnostics":[…], members of the command}
//! ```
//!
//! Diagnostics are the objects of the event `diagnostic` of `run --json`. The exit code is the one without `--json`.

use super::console::Console;
use super::ranks;
use serde_json::{Map, Value, json};
use signorini::Diagnostics;
use signorini::run::event_of;
use signorini_io::writers::json::EVENT_VERSION;

/// The members of an object besides those that all have.
pub type Members = Map<String, Value>;

/// What a command answers: what it found, lines for people, members for machines.
#[derive(Debug, Default)]
pub struct Answer {
    pub found: Diagnostics,
    pub lines: Vec<String>,
    pub members: Members,
}

impl Answer {
    /// Adds a member.
    pub fn put(&mut self, name: &str, value: &impl serde::Serialize) {
        self.members.insert(name.into(), json!(value));
    }
}

/// Prints the answer of a command, or what kept it from one, and returns the exit code.
pub fn print(command: &str, answer: Result<Answer, Diagnostics>, as_object: bool) -> u8 {
    match answer {
        Ok(answer) if as_object => object(command, 0, &answer.found, answer.members),
        Ok(answer) => {
            Console::stderr().findings(&answer.found);
            let out = Console::stdout();
            answer.lines.iter().for_each(|line| out.line(line));
            0
        }
        Err(found) => {
            let code = found.exit_code().unwrap_or(3);
            if as_object {
                return object(command, code, &found, Members::new());
            }
            ranks::say(&found);
            code
        }
    }
}

/// The members of a value that is written as an object; none of any other value.
pub fn members(value: &impl serde::Serialize) -> Members {
    match serde_json::to_value(value) {
        Ok(Value::Object(members)) => members,
        _ => Members::new(),
    }
}

/// Prints one object, and returns the exit code.
pub fn object(command: &str, exit_code: u8, found: &Diagnostics, members: Members) -> u8 {
    let mut object = Members::new();
    object.insert("v".into(), EVENT_VERSION.into());
    object.insert("command".into(), command.into());
    object.insert("ok".into(), (exit_code == 0).into());
    object.insert("exit_code".into(), exit_code.into());
    let all = found.iter().map(|one| json!(event_of(one)));
    object.insert("diagnostics".into(), all.collect());
    object.extend(members);
    Console::stdout().raw(&format!("{}\n", Value::Object(object)));
    exit_code
}
