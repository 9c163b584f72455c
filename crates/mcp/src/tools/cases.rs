//! Tools for cases before they are solved.

use super::changes;
use crate::Server;
use crate::reply::{Refusal, Reply, counted, cut, diagnostics_text};
use crate::root::{Entry, Place};
use rmcp::handler::server::wrapper::Parameters;
use rmcp::schemars::{self, JsonSchema};
use rmcp::service::RequestContext;
use rmcp::{RoleServer, tool, tool_router};
use serde::Deserialize;
use serde_json::{Value, json};

/// Which part of the schema.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Schema {
    /// A table or key of a case, with dots between: `contact`, `contact.friction`, `material.steel.E`, `step.move`. Default: a list of the
    /// keys at the top.
    key: Option<String>,
}

/// What to check.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// The case (.toml) or deck (.inp, .in), relative to the folder of the server.
    path: String,
    /// A text to write to this path before it is checked, at most 1 MiB; what was there is replaced. Default: the file as it is.
    text: Option<String>,
    /// Changes for this check alone, as KEY=VALUE: `material.steel.E=2000`. The file stays as it is.
    #[serde(default)]
    set: Vec<String>,
}

/// What to explain.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Explain {
    /// The code of a message, such as `S0501`, or a key of a case, such as `contact.friction`.
    what: String,
}

/// Which case to start from.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Init {
    /// The name of a template. Default: none is written, and the templates are listed.
    template: Option<String>,
    /// The folder to write it to, relative to the folder of the server; it is made where it is missing. Default: the folder of the server.
    folder: Option<String>,
}

#[tool_router(router = case_tools, vis = "pub(crate)")]
impl Server {
    /// Describes the keys of a case: what they mean, their form and default, which are required. Without a key it lists the keys at the
    /// top; with one it returns the part of the JSON schema below it.
    #[tool(annotations(
        title = "Keys of a case",
        read_only_hint = true,
        open_world_hint = false
    ))]
    async fn schema(
        &self,
        Parameters(wanted): Parameters<Schema>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let schema = self.case_schema(&context).await?;
        super::schema::described(schema, wanted.key.as_deref().unwrap_or_default())
    }

    /// Finds what is wrong with a case without solving it: unknown keys, missing values, faults of the mesh, bodies that nothing holds.
    /// With a text, writes it to the path first. Returns all messages with code, file, line, column, message and help; `ok` is true where
    /// the case can be solved.
    #[tool(annotations(
        title = "Check a case",
        read_only_hint = false,
        destructive_hint = true,
        idempotent_hint = true,
        open_world_hint = false
    ))]
    async fn check(
        &self,
        Parameters(wanted): Parameters<Check>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let changes = changes(&wanted.set, self.limits())?;
        if let Some(text) = &wanted.text {
            self.write_text(&wanted.path, text)?;
        }
        let case = self.root().file(&wanted.path)?;
        let mut arguments = vec!["check".to_owned(), case.argument(), "--json".to_owned()];
        arguments.extend(changes);
        let mut value = self.ask(&arguments, &context).await?;
        let text = self.verdict(&mut value, &case.shown());
        Ok(Reply::new(text, value))
    }

    /// Explains the code of a message (what happened, possible reasons, what to do) or a key of a case (meaning, form, default).
    #[tool(annotations(
        title = "Explain a code or key",
        read_only_hint = true,
        open_world_hint = false
    ))]
    async fn explain(
        &self,
        Parameters(wanted): Parameters<Explain>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let what = wanted.what.trim();
        let is_name = |c: char| c.is_alphanumeric() || "._-[]".contains(c);
        let is_right = what.starts_with(char::is_alphanumeric) && what.chars().all(is_name);
        if !is_right || what.len() > 200 {
            let why = "name a code such as S0501, or a key such as contact.friction";
            return Err(Refusal::value("what", why));
        }
        let arguments = ["explain".to_owned(), what.to_owned(), "--json".to_owned()];
        let value = self.ask(&arguments, &context).await?;
        if let Some(error) = value.get("error").and_then(Value::as_str) {
            return Err(Refusal::value("what", error));
        }
        let text = explanation(&value);
        Ok(Reply::new(text, value))
    }

    /// Writes a case to start from, one that can be run as it is. Without a template it lists the templates with what they show.
    #[tool(annotations(
        title = "Start from a template",
        read_only_hint = false,
        destructive_hint = false,
        open_world_hint = false
    ))]
    async fn init(
        &self,
        Parameters(wanted): Parameters<Init>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let Some(template) = wanted.template else {
            return self.templates(&context).await;
        };
        let is_name = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
        if !template.starts_with(|c: char| c.is_ascii_alphanumeric())
            || !template.chars().all(is_name)
        {
            let why = "it is no name of a template; call init without it for a list";
            return Err(Refusal::value("template", why));
        }
        let folder = self.root().place(wanted.folder.as_deref().unwrap_or("."))?;
        let before = self.files_in(&folder);
        let arguments = ["init".to_owned(), template, folder.argument()];
        self.succeed(&arguments, &context).await?;
        let written: Vec<String> = self
            .files_in(&folder)
            .into_iter()
            .filter(|entry| !before.contains(entry))
            .map(|entry| entry.path)
            .collect();
        Ok(Reply::new(
            format!("written: {}", written.join(", ")),
            json!({ "ok": true, "folder": folder.shown(), "written": written }),
        ))
    }
}

impl Server {
    async fn templates(&self, context: &RequestContext<RoleServer>) -> Result<Reply, Refusal> {
        let arguments = ["init".to_owned(), "--list".to_owned()];
        let printed = self.succeed(&arguments, context).await?;
        let printed = String::from_utf8_lossy(&printed).trim_end().to_owned();
        let templates: Vec<Value> = printed
            .lines()
            .filter_map(|line| line.split_once(char::is_whitespace))
            .map(|(name, about)| json!({ "template": name, "about": about.trim() }))
            .collect();
        Ok(Reply::new(
            printed,
            json!({ "ok": true, "templates": templates }),
        ))
    }

    fn files_in(&self, folder: &Place) -> Vec<Entry> {
        let listed = self.root().list(folder, 2, self.limits().files);
        listed.map_or_else(|_| Vec::new(), |(entries, _)| entries)
    }

    /// What a check says, in lines; messages beyond the limit are taken out of its object.
    fn verdict(&self, value: &mut Value, path: &str) -> String {
        let most = self.limits().diagnostics;
        let found = value.get("diagnostics").and_then(Value::as_array);
        let found = found.cloned().unwrap_or_default();
        let ok = value.get("ok").and_then(Value::as_bool).unwrap_or(false);
        let errors = found
            .iter()
            .filter(|one| one["severity"] == "error")
            .count();
        let mut text = match (ok, found.len() - errors) {
            (true, 0) => format!("{path}: nothing wrong was found"),
            (true, others) => format!("{path} can be run; {}", counted(others, "remark")),
            (false, _) => format!("{path} cannot be run: {}", counted(errors, "error")),
        };
        text.push('\n');
        text.push_str(&diagnostics_text(&found, most));
        for line in value
            .get("lines")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
        {
            text.push_str(line.as_str().unwrap_or_default());
            text.push('\n');
        }
        if found.len() > most {
            value["diagnostics_left_out"] = (found.len() - most).into();
            value["diagnostics"] = found.into_iter().take(most).collect();
        }
        let (text, _) = cut(text.trim_end(), self.limits().reply);
        text.to_owned()
    }
}

/// An explanation in lines: the members that say something.
fn explanation(value: &Value) -> String {
    let mut text = String::new();
    let common = ["v", "command", "ok", "exit_code", "diagnostics"];
    for (name, value) in value.as_object().into_iter().flatten() {
        let line = match value {
            Value::Null => continue,
            _ if common.contains(&name.as_str()) => continue,
            Value::String(word) => word.clone(),
            Value::Array(list) if list.is_empty() => continue,
            Value::Array(list) => {
                let lines = list.iter().map(|one| match one {
                    Value::String(word) => format!("\n  {word}"),
                    other => format!("\n  {other}"),
                });
                lines.collect()
            }
            other => other.to_string(),
        };
        text.push_str(&format!("{name}: {line}\n"));
    }
    text.trim_end().to_owned()
}

/// An object as text.
pub(super) fn readable(value: &Value) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default()
}
