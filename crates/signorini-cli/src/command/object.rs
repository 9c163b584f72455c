//! `--json` of commands that answer once: one object on standard output.
//!
//! ```text
//! {"v":1,"command":"check","ok":true,"exit_code":0,"diagnostics":[…], members of the command}
//! ```
//!
//! Diagnostics are the objects of the event `diagnostic` of `run --json`. The exit code is the one without `--json`.

use super::console::Console;
use serde_json::{Map, Value, json};
use signorini::Diagnostics;
use signorini::run::event_of;
use signorini_io::writers::json::EVENT_VERSION;

/// The members of an object besides those that all have.
pub type Members = Map<String, Value>;

/// The members of a value that is written as an object; none of any other value.
pub fn members(value: &impl serde::Serialize) -> Members {
    match serde_json::to_value(value) {
        Ok(Value::Object(members)) => members,
        _ => Members::new(),
    }
}

/// Prints the answer of a command, and returns the exit code.
pub fn answer(command: &str, exit_code: u8, found: &Diagnostics, members: Members) -> u8 {
    let mut object = Members::new();
    object.insert("v".into(), EVENT_VERSION.into());
    object.insert("command".into(), command.into());
    object.insert("ok".into(), (exit_code == 0).into());
    object.insert("exit_code".into(), exit_code.into());
    let all = found.iter().map(|one| json!(event_of(one)));
    object.insert("diagnostics".into(), all.collect());
    object.extend(members);
    Console::stdout().line(&Value::Object(object).to_string());
    exit_code
}

/// Prints that a command ended with what it found, and returns the exit code.
pub fn refused(command: &str, found: &Diagnostics) -> u8 {
    let code = found.exit_code().unwrap_or(3);
    answer(command, code, found, Members::new())
}
