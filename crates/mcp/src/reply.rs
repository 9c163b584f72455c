//! What clients get back: a short text for people and models, and the same as structured content.

use rmcp::handler::server::tool::IntoCallToolResult;
use rmcp::model::{CallToolResponse, CallToolResult, ContentBlock};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What to do about a file that cannot be read or written.
pub const CHECK_DISK: &str = "check the path, the free space and the permissions";

/// A request that is not served: what, why, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// A path that may not be used, or leads to nothing.
    #[error("the path \"{path}\" is refused: {why}")]
    Path {
        /// The path, as it was named; long ones are cut.
        path: String,
        /// Why.
        why: String,
    },
    /// A value outside of its range.
    #[error("`{key}` is refused: {why}")]
    Value {
        /// The parameter.
        key: &'static str,
        /// Why.
        why: String,
    },
    /// More runs at once than the server allows.
    #[error("{running} runs are going on, as many as this server allows at once")]
    Busy {
        /// How many are going on.
        running: usize,
    },
    /// A file that could not be read or written.
    #[error("{path}: {why}")]
    Disk {
        /// The file.
        path: String,
        /// The system's reason.
        why: String,
    },
    /// The command could not be started, broke down, or printed what is not understood.
    #[error("signorini {command} failed: {why}")]
    Command {
        /// The subcommand.
        command: String,
        /// What happened.
        why: String,
        /// What to do.
        help: &'static str,
    },
}

impl Refusal {
    /// A refused path.
    pub fn path(path: &str, why: &str) -> Self {
        Self::Path {
            path: path.chars().take(200).collect(),
            why: why.to_owned(),
        }
    }

    /// A refused value.
    pub fn value(key: &'static str, why: impl Into<String>) -> Self {
        Self::Value {
            key,
            why: why.into(),
        }
    }

    /// A file that the system refused.
    pub fn disk(path: &str, error: &std::io::Error) -> Self {
        Self::Disk {
            path: path.to_owned(),
            why: error.to_string(),
        }
    }

    /// What to do about it.
    fn help(&self) -> &'static str {
        match self {
            Self::Path { .. } => {
                "name a path relative to the folder of the server; list_files shows what is there"
            }
            Self::Value { .. } => "change it and call again",
            Self::Busy { .. } => "wait for one of them, or cancel it",
            Self::Disk { .. } => CHECK_DISK,
            Self::Command { help, .. } => help,
        }
    }
}

impl IntoCallToolResult for Refusal {
    fn into_call_tool_result(self) -> Result<CallToolResponse, rmcp::ErrorData> {
        let (message, help) = (self.to_string(), self.help());
        let text = format!("{message}\nhelp: {help}");
        let value = json!({ "ok": false, "error": message, "help": help });
        let mut result = CallToolResult::structured_error(value);
        result.content = vec![ContentBlock::text(text)];
        Ok(result.into())
    }
}

/// An answer: a text, and an object with the same and more.
#[derive(Clone, Debug, PartialEq)]
pub struct Reply {
    /// For people, and for clients that pass on texts only: all that matters.
    pub text: String,
    /// For programs.
    pub value: Map<String, Value>,
}

impl Reply {
    /// An answer; a value that is no object becomes the member `value` of one.
    pub fn new(text: impl Into<String>, value: Value) -> Self {
        let value = match value {
            Value::Object(map) => map,
            other => Map::from_iter([("value".to_owned(), other)]),
        };
        Self {
            text: text.into(),
            value,
        }
    }
}

impl IntoCallToolResult for Reply {
    fn into_call_tool_result(self) -> Result<CallToolResponse, rmcp::ErrorData> {
        let mut result = CallToolResult::structured(Value::Object(self.value));
        result.content = vec![ContentBlock::text(self.text)];
        Ok(result.into())
    }
}

/// A message of the command in lines: where, what, and what to do.
pub fn diagnostic_lines(one: &Value, lines: &mut String) {
    let text = |key: &str| one.get(key).and_then(Value::as_str).unwrap_or_default();
    let number = |key: &str| one.get(key).and_then(Value::as_u64);
    let _ = write!(lines, "{}[{}]", text("severity"), text("code"));
    if !text("file").is_empty() {
        let _ = write!(lines, " {}", text("file"));
        for key in ["line", "column"] {
            if let Some(number) = number(key) {
                let _ = write!(lines, ":{number}");
            }
        }
    }
    let _ = write!(lines, ": {}", text("message"));
    if !text("label").is_empty() {
        let _ = write!(lines, " ({})", text("label"));
    }
    lines.push('\n');
    for (key, name) in [("notes", "note"), ("help", "help")] {
        for remark in texts(one.get(key)) {
            let _ = writeln!(lines, "  {name}: {remark}");
        }
    }
}

/// A text, or a list of them, as a list.
fn texts(value: Option<&Value>) -> Vec<&str> {
    match value {
        Some(Value::String(text)) => vec![text],
        Some(Value::Array(list)) => list.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    }
}

/// Messages in lines, the first `most` of them.
pub fn diagnostics_text(found: &[Value], most: usize) -> String {
    let mut lines = String::new();
    for one in found.iter().take(most) {
        diagnostic_lines(one, &mut lines);
    }
    if found.len() > most {
        let _ = writeln!(lines, "and {} more", found.len() - most);
    }
    lines
}

/// `1 error`, `2 errors`.
pub fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// The beginning of a text, of at most `most` bytes, and whether that is all of it.
pub fn cut(text: &str, most: usize) -> (&str, bool) {
    let end = (0..=most.min(text.len()))
        .rev()
        .find(|end| text.is_char_boundary(*end))
        .unwrap_or(0);
    (text.get(..end).unwrap_or_default(), end == text.len())
}
