//! Tools for results.

use super::cases::readable;
use crate::Server;
use crate::reply::{Refusal, Reply, cut, diagnostics_text};
use crate::root::{Kind, Place};
use crate::table::{Part, TableError, Wanted};
use rmcp::handler::server::wrapper::Parameters;
use rmcp::schemars::{self, JsonSchema};
use rmcp::service::RequestContext;
use rmcp::{RoleServer, tool, tool_router};
use serde::Deserialize;
use serde_json::{Value, json};

/// Rows of a table where nothing is said.
const ROWS: usize = 50;

/// A folder of results.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Folder {
    /// The folder of results, relative to the folder of the server, such as `block/case.out`.
    path: String,
}

/// A table of a run.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Table {
    /// One row per converged increment: time, forces, areas, pressures, gaps, chosen quantities.
    #[default]
    History,
    /// One row per iteration: residual, correction, changes of contact.
    Convergence,
    /// No table.
    None,
}

/// What to read of results.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// The folder of results, relative to the folder of the server, such as `block/case.out`.
    path: String,
    /// Which table: `history` (per increment), `convergence` (per iteration) or `none`. Default: history.
    #[serde(default)]
    table: Table,
    /// The columns of the table, such as `time` and `floor.force_z`. Default: all of them.
    #[serde(default)]
    columns: Vec<String>,
    /// Rows at most, up to 1000. Default: 50.
    rows: Option<usize>,
    /// The first row, from 0. Default: the last rows are given.
    first_row: Option<usize>,
    /// Whether the fields of the last frame are listed with their ranges. Default: true.
    fields: Option<bool>,
}

#[tool_router(router = result_tools, vis = "pub(crate)")]
impl Server {
    /// Says what a run has reached: going on, finished, stopped or killed; its last increment and how to go on.
    #[tool(annotations(
        title = "Status of a run",
        read_only_hint = true,
        open_world_hint = false
    ))]
    async fn status(
        &self,
        Parameters(wanted): Parameters<Folder>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let folder = self.root().folder(&wanted.path)?;
        let arguments = ["status".to_owned(), folder.argument(), "--json".to_owned()];
        let value = self.ask(&arguments, &context).await?;
        let text = status_text(&value);
        let (text, _) = cut(&text, self.limits().reply);
        Ok(Reply::new(text, value))
    }

    /// Reads results: the summary (status, forces, areas and largest pressures of contacts, expectations), a table of the history with
    /// chosen columns and rows, and the fields of the last frame with their smallest and largest values. Works while a run goes on.
    #[tool(annotations(title = "Read results", read_only_hint = true, open_world_hint = false))]
    async fn results(
        &self,
        Parameters(wanted): Parameters<Results>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let folder = self.root().folder(&wanted.path)?;
        let mut value = json!({ "ok": true, "path": folder.shown() });
        let mut text = String::new();
        if let Some(summary) = self.summary(&folder)? {
            text.push_str(&summary_text(&summary));
            value["summary"] = summary;
        } else {
            text.push_str("no summary: the run goes on, or was killed; see status\n");
            value["summary"] = Value::Null;
        }
        if let Some(part) = self.table(&folder, &wanted)? {
            text.push_str(&format!("{}\n{}\n", part.remark(), part.text()));
            value["table"] = part.value();
        }
        if wanted.fields.unwrap_or(true) {
            let arguments = ["info".to_owned(), folder.argument(), "--json".to_owned()];
            let info = self.ask(&arguments, &context).await?;
            for (member, name) in [
                ("fields", "fields of the last frame"),
                ("contact_fields", "fields of contact"),
            ] {
                if let Some(fields) = info.get(member).and_then(Value::as_array) {
                    text.push_str(&format!("{name}:\n{}", fields_text(fields)));
                }
            }
            for member in ["fields", "contact_fields", "times"] {
                value[member] = info.get(member).cloned().unwrap_or_default();
            }
        }
        let (text, is_all) = cut(text.trim_end(), self.limits().reply);
        let text = if is_all {
            text.to_owned()
        } else {
            format!("{text}\n[cut: choose columns and rows]")
        };
        Ok(Reply::new(text, value))
    }

    /// Writes the report of a run, one HTML page that works offline: verdict, what was run, a table of contacts, a 3-D view, plots of
    /// forces and convergence. Returns its path.
    #[tool(annotations(
        title = "Write a report",
        read_only_hint = false,
        destructive_hint = false,
        idempotent_hint = true,
        open_world_hint = false
    ))]
    async fn report(
        &self,
        Parameters(wanted): Parameters<Folder>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let folder = self.root().folder(&wanted.path)?;
        let page = self.root().place(&folder.join("report.html").shown())?;
        // the path starts with ./, so that it is never taken for an option
        let words = ["report", &folder.argument(), "-o", &page.argument()];
        let arguments = words.map(str::to_owned);
        self.succeed(&arguments, &context).await?;
        // a report without a page is a fault of the command
        let page = self.root().file(&page.shown())?;
        let absolute = self.root().path().join(page.shown());
        Ok(Reply::new(
            format!("{}: open it in a browser", page.shown()),
            json!({ "ok": true, "path": page.shown(), "absolute_path": absolute }),
        ))
    }
}

impl Server {
    /// The summary of a folder of results; none where there is no such file.
    pub(super) fn summary(&self, folder: &Place) -> Result<Option<Value>, Refusal> {
        let place = folder.join("summary.json");
        if self.root().kind(&place) == Kind::Nothing {
            return Ok(None);
        }
        let shown = place.shown();
        let bytes = self
            .root()
            .read(&place, self.limits().reply)
            .map_err(|error| Refusal::disk(&shown, &error))?;
        serde_json::from_slice(&bytes)
            .map(Some)
            .map_err(|error| Refusal::Disk {
                path: shown,
                why: error.to_string(),
            })
    }

    fn table(&self, folder: &Place, wanted: &Results) -> Result<Option<Part>, Refusal> {
        let name = match wanted.table {
            Table::History => "history.csv",
            Table::Convergence => "convergence.csv",
            Table::None => return Ok(None),
        };
        let place = folder.join(name);
        let reader = self
            .root()
            .reader(&place)
            .map_err(|error| Refusal::disk(&place.shown(), &error))?;
        let part = Wanted {
            columns: wanted.columns.clone(),
            first: wanted.first_row,
            rows: wanted.rows.unwrap_or(ROWS).min(self.limits().rows),
            cells: self.limits().cells,
        };
        match Part::read(std::io::BufReader::new(reader), &part) {
            Ok(part) => Ok(Some(part)),
            Err(error @ TableError::Unknown { .. }) => {
                let why = format!("{}: {error}", place.shown());
                Err(Refusal::value("columns", why))
            }
            Err(error @ TableError::Damaged(_)) => Err(Refusal::Disk {
                path: place.shown(),
                why: error.to_string(),
            }),
        }
    }
}

/// The heart of a summary in lines.
fn summary_text(summary: &Value) -> String {
    format!(
        "{} (exit code {})\n{}{}",
        summary["status"].as_str().unwrap_or("?"),
        summary["exit_code"],
        contacts_text(&summary["contacts"]),
        expectations_text(summary["expectations"].as_array().into_iter().flatten())
    )
}

/// Contacts with their numbers, a line each.
pub(super) fn contacts_text(contacts: &Value) -> String {
    let contacts = contacts.as_object().into_iter().flatten();
    let lines = contacts.map(|(name, contact)| format!("contact {name}: {contact}\n"));
    lines.collect()
}

/// Checked values, a line each.
pub(super) fn expectations_text<'a>(all: impl IntoIterator<Item = &'a Value>) -> String {
    let line = |one: &Value| {
        let what = one["what"].as_str().unwrap_or("?");
        let sign = if one["ok"] == true { "met" } else { "FAILED" };
        format!(
            "expect {what}: {} for {}, {sign}\n",
            one["got"], one["value"]
        )
    };
    all.into_iter().map(line).collect()
}

/// Fields with the ranges of their components, a line each.
fn fields_text(fields: &[Value]) -> String {
    let mut text = String::new();
    for field in fields {
        text.push_str(&format!(
            "{} ({})",
            field["name"].as_str().unwrap_or("?"),
            field["on"].as_str().unwrap_or("?")
        ));
        for one in field["components"].as_array().into_iter().flatten() {
            let name = one["name"].as_str().unwrap_or_default();
            match one["range"].as_array().map(Vec::as_slice) {
                Some([low, high]) => text.push_str(&format!(" {name}[{low}, {high}]")),
                _ => text.push_str(&format!(" {name}[no numbers]")),
            }
        }
        text.push('\n');
    }
    text
}

/// What a run has reached, in lines.
fn status_text(status: &Value) -> String {
    let found = status["diagnostics"]
        .as_array()
        .cloned()
        .unwrap_or_default();
    let mut text = match status["state"].as_str() {
        Some(state) => format!("{state}\n"),
        None => String::new(),
    };
    for member in ["process", "reason", "resume"] {
        if let Some(value) = status[member].as_str() {
            text.push_str(&format!("{member}: {value}\n"));
        }
    }
    if status["progress"].is_object() {
        text.push_str(&format!("progress: {}\n", readable(&status["progress"])));
    }
    if status["summary"].is_object() {
        text.push_str(&summary_text(&status["summary"]));
    }
    text.push_str(&diagnostics_text(&found, found.len()));
    text.trim_end().to_owned()
}
