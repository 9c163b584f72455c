//! `signorini explain CODE|KEY`, and `signorini help COMMAND|CODE|KEY`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::object::{self, Members};
use clap::Args;
use serde_json::json;
use signorini::Diagnostics;
use signorini_io::case::keys::{self, Found, KeyInfo};
use signorini_io::diagnostic::{Code, closest, codes};

/// Explain the code of a message, or a key of cases.
#[derive(Debug, Args)]
pub struct Explain {
    /// A code such as S0501, or a key such as contact.enforcement; all codes where absent
    topic: Option<String>,
    /// The answer as one object of JSON on standard output
    #[arg(long)]
    json: bool,
}

/// What there is to say on a topic.
pub enum Explained {
    /// A kind of message.
    Code(&'static Code),
    /// A key of cases.
    Key(Box<Found>),
    /// Nothing; the topic that was probably meant.
    Unknown(Option<String>),
}

impl Explain {
    pub fn execute(self) -> u8 {
        match (self.topic, self.json) {
            (Some(topic), false) => print(&topic, of(&topic)),
            (Some(topic), true) => answer(&topic, of(&topic)),
            (None, true) => {
                let all = codes::ALL.iter();
                let all = all.map(|code| json!({ "code": code.id, "title": code.title }));
                let members = Members::from_iter([("codes".to_owned(), all.collect())]);
                object::object("explain", 0, &Diagnostics::new(), members)
            }
            (None, false) => {
                let out = Console::stdout();
                for code in codes::ALL {
                    out.line(&format!("{}  {}", code.id, code.title));
                }
                0
            }
        }
    }
}

/// What there is to say on a topic.
pub fn of(topic: &str) -> Explained {
    if let Some(code) = Code::find(topic) {
        return Explained::Code(code);
    }
    match keys::find(signorini::vocabulary(), topic) {
        Ok(found) => Explained::Key(Box::new(found)),
        Err(near) => {
            let ids = codes::ALL.iter().map(|code| code.id);
            let near = near.or_else(|| closest(topic, ids).map(str::to_owned));
            Explained::Unknown(near)
        }
    }
}

/// Prints what there is to say on a topic, and returns the exit code.
pub fn print(topic: &str, explained: Explained) -> u8 {
    let out = Console::stdout();
    match explained {
        Explained::Code(code) => out.text(&code.explanation()),
        Explained::Key(found) => {
            out.text(&found.key.text());
            if !found.others.is_empty() {
                out.line(&format!("\nThere are also: {}", found.others.join(", ")));
            }
        }
        Explained::Unknown(near) => {
            Console::stderr().line(&format!("error: {}", unknown(topic, near.as_deref())));
            return WRONG_COMMAND;
        }
    }
    0
}

/// The message for a topic that nothing is known of.
pub fn unknown(topic: &str, near: Option<&str>) -> String {
    let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
    format!(
        "there is no code or key \"{topic}\"{near}\n  all codes: signorini explain; all keys: docs/keys.md, or signorini schema"
    )
}

fn answer(topic: &str, explained: Explained) -> u8 {
    let members = match explained {
        Explained::Code(code) => object::members(&json!({
            "code": code.id,
            "title": code.title,
            "class_exit_code": code.class.exit_code(),
            "meaning": code.meaning,
            "reasons": code.reasons,
            "remedies": code.remedies,
        })),
        Explained::Key(found) => {
            let mut members = of_key(&found.key);
            members.insert("others".into(), json!(found.others));
            members
        }
        Explained::Unknown(near) => {
            let members = object::members(&json!({
                "error": unknown(topic, near.as_deref()),
                "did_you_mean": near,
            }));
            return object::object("explain", WRONG_COMMAND, &Diagnostics::new(), members);
        }
    };
    object::object("explain", 0, &Diagnostics::new(), members)
}

fn of_key(key: &KeyInfo) -> Members {
    let inside = key
        .keys
        .iter()
        .map(|(name, doc)| json!({ "key": name, "meaning": doc }));
    let inside: Vec<_> = inside.collect();
    object::members(&json!({
        "key": key.path,
        "meaning": key.meaning,
        "values": key.form,
        "range": key.range,
        "unit": key.unit,
        "default": key.default,
        "required": key.required,
        "supported": key.later.is_none(),
        "keys": inside,
        "example": key.example,
    }))
}
