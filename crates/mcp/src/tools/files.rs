//! Tools for the files in the folder.

use crate::Server;
use crate::reply::{Refusal, Reply, cut};
use crate::root::{Kind, LEFT_BY_RUNS, WRITABLE};
use rmcp::handler::server::wrapper::Parameters;
use rmcp::schemars::{self, JsonSchema};
use rmcp::{tool, tool_router};
use serde::Deserialize;
use serde_json::json;

/// How deep lists go where nothing is said.
const DEPTH: usize = 2;
/// How deep lists go at most.
const DEEPEST: usize = 8;

/// What to list.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ListFiles {
    /// The folder to list, relative to the folder of the server. Default: all of it.
    folder: Option<String>,
    /// How many levels of folders below it are listed, too: 0 to 8. Default: 2.
    depth: Option<usize>,
}

/// What to write.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WriteCase {
    /// The file, relative to the folder of the server, such as `block/case.toml`. Folders on the way are made; an existing file is
    /// replaced. Extensions: toml, inp, in, inc, msh, stl, csv, txt, md.
    path: String,
    /// The whole text of the file, UTF-8, at most 1 MiB.
    text: String,
}

/// What to read.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReadCase {
    /// The file, relative to the folder of the server.
    path: String,
    /// The first line to return, from 1. Default: 1.
    first_line: Option<usize>,
    /// How many lines to return. Default: as many as fit into 256 KiB.
    lines: Option<usize>,
}

#[tool_router(router = file_tools, vis = "pub(crate)")]
impl Server {
    /// Lists files and folders in the folder of the server: cases, meshes, and folders of results (`*.out`). Hidden files are left
    /// out, links are listed and not followed.
    #[tool(annotations(title = "List files", read_only_hint = true, open_world_hint = false))]
    async fn list_files(
        &self,
        Parameters(wanted): Parameters<ListFiles>,
    ) -> Result<Reply, Refusal> {
        let name = wanted.folder.as_deref().unwrap_or(".");
        let folder = self.root().folder(name)?;
        let depth = wanted.depth.unwrap_or(DEPTH).min(DEEPEST);
        let most = self.limits().files;
        let listed = self.root().list(&folder, depth, most);
        let (entries, is_all) = listed.map_err(|error| Refusal::disk(name, &error))?;
        let count = match entries.len() {
            1 => "1 entry".to_owned(),
            count => format!("{count} entries"),
        };
        let mut text = format!("{count} in {}", folder.shown());
        for entry in &entries {
            text.push('\n');
            text.push_str(&entry.path);
            match entry.kind {
                Kind::Folder => text.push('/'),
                Kind::File => text.push_str(&format!("  {} B", entry.size)),
                Kind::Other | Kind::Nothing => text.push_str("  (link or device)"),
            }
        }
        if !is_all {
            text.push_str(&format!(
                "\nonly the first {most} are listed: name a folder, or a smaller depth"
            ));
        }
        let kind = |kind| match kind {
            Kind::File => "file",
            Kind::Folder => "folder",
            Kind::Other | Kind::Nothing => "other",
        };
        let files: Vec<_> = entries
            .iter()
            .map(
                |entry| json!({ "path": entry.path, "kind": kind(entry.kind), "size": entry.size }),
            )
            .collect();
        Ok(Reply::new(
            text,
            json!({ "ok": true, "folder": folder.shown(), "files": files, "truncated": !is_all }),
        ))
    }

    /// Writes a text file into the folder of the server: a case (.toml), a deck of another program (.inp, .in), a mesh. To write a
    /// case and check it at once, use `check` with a text.
    #[tool(annotations(
        title = "Write a case",
        read_only_hint = false,
        destructive_hint = true,
        idempotent_hint = true,
        open_world_hint = false
    ))]
    async fn write_case(
        &self,
        Parameters(wanted): Parameters<WriteCase>,
    ) -> Result<Reply, Refusal> {
        let path = self.write_text(&wanted.path, &wanted.text)?;
        let size = wanted.text.len();
        Ok(Reply::new(
            format!("{path}: {size} bytes written"),
            json!({ "ok": true, "path": path, "size": size }),
        ))
    }

    /// Reads a text file in the folder of the server: a case, a deck, a table or log of a run. Large files are cut, and the answer
    /// says so; files of more than 8 MiB are refused. For numbers of a run, `results` is better.
    #[tool(annotations(title = "Read a case", read_only_hint = true, open_world_hint = false))]
    async fn read_case(&self, Parameters(wanted): Parameters<ReadCase>) -> Result<Reply, Refusal> {
        let place = self.root().file(&wanted.path)?;
        let readable = [WRITABLE.as_slice(), &LEFT_BY_RUNS].concat();
        if !readable.contains(&place.extension().as_str()) {
            let why = format!("texts to read end in {}", readable.join(", "));
            return Err(Refusal::path(&wanted.path, &why));
        }
        // the whole file, since its lines are counted; what is returned is far smaller
        let bytes = self
            .root()
            .read(&place, self.limits().printed)
            .map_err(|error| Refusal::disk(&wanted.path, &error))?;
        let whole = String::from_utf8_lossy(&bytes);
        let first = wanted.first_line.unwrap_or(1).max(1);
        let lines = wanted.lines.unwrap_or(usize::MAX);
        let total = whole.lines().count();
        let chosen: String = whole
            .split_inclusive('\n')
            .skip(first - 1)
            .take(lines)
            .collect();
        let (part, is_all) = cut(&chosen, self.limits().reply);
        let n = part.lines().count();
        let is_whole = is_all && first == 1 && n == total;
        let mut text = part.to_owned();
        if !is_whole {
            text.push_str(&format!(
                "\n[lines {first} to {} of {total}]",
                (first + n).saturating_sub(1)
            ));
        }
        Ok(Reply::new(
            text,
            json!({
                "ok": true, "path": place.shown(), "text": part, "first_line": first, "lines": n, "total_lines": total,
                "truncated": !is_whole,
            }),
        ))
    }
}

impl Server {
    /// Writes a text; returns its path as clients see it.
    ///
    /// # Errors
    /// A path that may not be written, a text that is too long, a disk that fails.
    pub(crate) fn write_text(&self, path: &str, text: &str) -> Result<String, Refusal> {
        let place = self.root().place(path)?;
        if !WRITABLE.contains(&place.extension().as_str()) {
            let why = format!("files to write end in {}", WRITABLE.join(", "));
            return Err(Refusal::path(path, &why));
        }
        if !matches!(self.root().kind(&place), Kind::File | Kind::Nothing) {
            return Err(Refusal::path(
                path,
                "something else than a file has this name",
            ));
        }
        if text.len() > self.limits().text {
            let why = format!(
                "it has {} bytes, and at most {} are written",
                text.len(),
                self.limits().text
            );
            return Err(Refusal::value("text", why));
        }
        self.root()
            .write(&place, text.as_bytes())
            .map_err(|error| Refusal::disk(path, &error))?;
        Ok(place.shown())
    }
}
