//! One HTML page of a folder of results, with everything in it: it works offline, from a disk or by mail.
//!
//! ```text
//! 1 verdict   2 what was run   3 contact   4 view   5 histories   6 convergence   7 health   8 provenance
//! ```
//!
//! Numbers in tables carry their exact decimal in `data-value` and where it comes from in `data-key`: a path in
//! `summary.json`, or `history.csv:ROW:COLUMN`. Plots and the view are drawn by plotly.js, which comes with the crate
//! `plotly` and is packed into the page; without scripts the tables are all there.

mod banner;
mod cell;
mod compare;
mod contacts;
mod convergence;
mod health;
mod model;
mod provenance;

use crate::error::ReportError;
use crate::pack::Chunk;
use crate::picture;
use crate::results::{Frame, Results};
use crate::text::unit;
use crate::view::{self, View};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::{Value, json};
use signorini_io::fs::Fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The style sheet and the script of pages.
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Characters that a page may have.
const BUDGET: usize = 7_800_000;

/// The least that is left for the view, however long the tables are.
const VIEW_LEAST: usize = 500_000;

/// More rows of a history than these are thinned for plots.
const ROWS_MOST: usize = 5_000;

/// Columns of a history that have no meaning for bodies of revolution, by their ends.
const NOT_AXISYMMETRIC: [&str; 10] = [
    ".force_x",
    ".force_z",
    ".moment_x",
    ".moment_y",
    ".moment_z",
    ".displacement_z",
    ".rotation_x",
    ".rotation_y",
    ".rotation_z",
    ".center_z",
];

/// What a page shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PageOptions {
    /// A second folder of results, to be compared with.
    pub compare: Option<PathBuf>,
    /// How many bytes the page may have. Above, the view shows less: fewer frames, then fewer facets, and says so.
    pub budget: usize,
}

impl Default for PageOptions {
    fn default() -> Self {
        Self {
            compare: None,
            budget: BUDGET,
        }
    }
}

/// The page of a folder of results, as bytes of UTF-8.
///
/// What the folder does not hold is left out, and the page says so: the folder of a run that was killed, that failed, or that
/// writes no frames gives a page, too. A frame that cannot be read gives a page without a view.
///
/// # Errors
/// A folder, or one to compare with, that holds no results.
///
/// # Limits
/// The page is smaller than [`PageOptions::budget`] where the tables and the resolved case leave room; frames are read one
/// at a time, the fields of all shown frames are in memory.
pub fn page(fs: &dyn Fs, folder: &Path, options: &PageOptions) -> Result<Vec<u8>, ReportError> {
    let results = Results::read(fs, folder)?;
    let other = options
        .compare
        .as_ref()
        .map(|folder| Results::read(fs, folder));
    let other = other.transpose()?;
    let mut notes = results.notes.clone();
    let mut frame = |number: usize| -> Result<Frame, String> {
        let read = results.frame(fs, number).map_err(|error| error.to_string());
        read.inspect_err(|why| notes.push(why.clone()))
    };
    let last = results.frames.len().checked_sub(1);
    let first = last.map(|_| frame(0));
    let last = match last {
        // it is the first one, too
        Some(0) => first.clone(),
        last => last.map(&mut frame),
    };
    let start = first.as_ref().and_then(|frame| frame.as_ref().ok());
    let end = last.as_ref().and_then(|frame| frame.as_ref().ok());
    let quality = health::shapes(start);
    let still = end.and_then(|frame| picture::still(frame, &results.title(), results.units()));
    let data = json!({
        "history": history(&results),
        "other": other.as_ref().map(history),
        "contacts": contacts::names(&results),
        "convergence": convergence::data(&results),
        "quality": health::data(quality.as_ref()),
    });
    let before = html! {
        (banner::section(&results, &notes))
        (model::section(&results))
        (contacts::section(&results, start, end))
    };
    let after = html! {
        (histories(&results))
        @if let Some(other) = &other { (compare::section(&results, other)) }
        (convergence::section(&results))
        (health::section(&results, quality.as_ref(), end))
        (provenance::section(&results))
    };
    drop(first);
    let script = plotly().text.len();
    let rest = before.0.len() + after.0.len() + data.to_string().len() + STYLE.len() + SCRIPT.len();
    let rest = rest + still.as_ref().map_or(0, String::len);
    let budget = options
        .budget
        .saturating_sub(script + rest + 20_000)
        .max(VIEW_LEAST);
    let view = last.map(|end| {
        let view = view::of_results(fs, &results, end?, &contacts::names(&results), budget);
        view.map_err(|error| error.to_string())
    });
    let mut view = match view.transpose() {
        Ok(view) => view.flatten().unwrap_or_else(|| missing(
            "The results hold no frames for a view: the case writes none in the format vtu, or no frame was reached.",
        )),
        Err(error) => missing(&format!("There is no view: {error}.")),
    };
    view.still = still;
    Ok(whole(&results.title(), &before, &view, &after, data))
}

/// A view of nothing.
fn missing(why: &str) -> View {
    View {
        notes: vec![why.to_owned()],
        ..View::default()
    }
}

/// The page of a model before anything is solved: `check.vtu` in colours, and all that `signorini check` says.
///
/// `grid` holds the bytes of `check.vtu`, `lines` what the command prints, `findings` its messages. A grid that cannot be
/// read gives a page without a view.
#[must_use]
pub fn check_page(
    title: &str,
    units: &str,
    grid: &[u8],
    lines: &[String],
    findings: &[String],
) -> Vec<u8> {
    let view = match signorini_io::vtk::read(grid) {
        Ok(grid) => view::of_grid(&grid, units)
            .unwrap_or_else(|| missing("The model has no cells that can be drawn.")),
        Err(error) => missing(&format!("check.vtu: {error}")),
    };
    let before = html! {
        section #verdict {
            div.banner.(if findings.is_empty() { "solved" } else { "missed" }) role="status" {
                strong { "Checked, nothing is solved yet" }
                span.code { (crate::text::plural(findings.len(), "finding")) }
            }
            @for finding in findings { pre.finding { (finding) } }
        }
        section #model {
            h2 { "The model" }
            ul.sentences { @for line in lines {
                li.(if line.starts_with(' ') { "inner" } else { "" }) { (line.trim()) }
            } }
            p.hint { "In the view: " code { "contact_gap" } " negative where bodies overlap, " code { "contact_normal" }
                " the outward normals of secondary sides, " code { "support_x" } " … and " code { "load" }
                " 1 where the first step holds, moves or loads, " code { "quality" } " 1 for ideal elements, 0 for flat ones." }
        }
    };
    let data = json!({"check": true});
    whole(title, &before, &view, &html! {}, data)
}

/// The page around its sections.
fn whole(title: &str, before: &Markup, view: &View, after: &Markup, mut data: Value) -> Vec<u8> {
    data["view"] = view.description.clone();
    let is_check = data["check"] == true;
    // "</script>" in a name must not end the script
    let data = data.to_string().replace('<', "\\u003c");
    let links = [
        ("verdict", "Verdict"),
        ("model", "Model"),
        ("contacts", "Contact"),
        ("view", "View"),
        ("histories", "Histories"),
        ("convergence", "Convergence"),
        ("health", "Health"),
        ("provenance", "Provenance"),
    ];
    let shown = |id: &str| !is_check || ["verdict", "model", "view"].contains(&id);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(concat!("signorini ", env!("CARGO_PKG_VERSION")));
                link rel="icon" href="data:,";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (title) }
                    nav { @for (id, name) in links { @if shown(id) { a href=(format!("#{id}")) { (name) } } } }
                }
                main {
                    (before)
                    (viewer(view))
                    (after)
                }
                footer { "Written by signorini " (env!("CARGO_PKG_VERSION")) ". Plots and view: plotly.js (MIT licence)." }
                script id="data" type="application/json" { (PreEscaped(data)) }
                @for (name, chunk) in &view.chunks {
                    script type="text/plain" data-chunk=(name) data-kind=(chunk.kind) { (PreEscaped(&chunk.text)) }
                }
                script type="text/plain" data-chunk="plotly" data-kind="text" { (PreEscaped(&plotly().text)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string().into_bytes()
}

/// plotly.js, packed.
fn plotly() -> &'static Chunk {
    static PACKED: OnceLock<Chunk> = OnceLock::new();
    PACKED.get_or_init(|| {
        // the first script is plotly.js, the second one sets formulas
        let sources = plotly::Plot::offline_js_sources();
        let start = sources.split_once('>').map_or("", |(_, rest)| rest);
        let script = start
            .split_once("</script>")
            .map_or(start, |(script, _)| script);
        Chunk::text(script)
    })
}

/// Section 4: the view, or why there is none.
fn viewer(view: &View) -> Markup {
    let is_empty = view.description.is_null();
    let number = |key: &str| view.description[key].as_u64().unwrap_or(0);
    html! {
        section #view {
            h2 { "View" }
            @if !is_empty {
                div.controls {
                    label { "field " select #field {} }
                    label { "frame " input #frame type="range" min="0" value="0" step="1"; output #time {} }
                    button #play type="button" title="play" { "▶" }
                    label { "warp " input #warp type="number" value="1" step="any"; }
                    label #label-show { "show " select #show {
                        option value="whole" { "whole model" }
                        option value="ghost" { "contact in the transparent model" }
                        option value="contact" { "contact alone" }
                    } }
                    label { "colours " select #range {
                        option value="all" { "of all frames" }
                        option value="frame" { "of this frame" }
                    } }
                    label { input #edges type="checkbox"; " edges" }
                    label { "node " input #pick type="number" min="0" step="1" placeholder="number"; }
                    button #reset type="button" { "reset view" }
                }
                div #parts.controls {}
                div.viewer {
                    div #stage {
                        @if let Some(still) = &view.still { img #still src=(still) alt="The model in the last frame"; }
                    }
                    aside #picked { p.hint { "Click a node, or type its number, to see its values." } }
                }
                p.hint { (crate::text::grouped(number("nnode") as usize)) " nodes on the surface, "
                    (crate::text::grouped(number("ntriangle") as usize)) " triangles. Drag to turn, scroll to zoom." }
                noscript { p.note { "The view and the plots need JavaScript; the tables do not." } }
            }
            @for note in &view.notes { p.note { (note) } }
        }
    }
}

/// Section 5.
fn histories(results: &Results) -> Markup {
    html! {
        section #histories {
            h2 { "Histories" }
            @if results.history.rows.is_empty() {
                p { "No increment has converged: history.csv has no rows." }
            } @else {
                div.controls {
                    label { "across " select #history-x {} }
                    label { "up " select #history-y multiple size="4" {} }
                }
                div #plot-history.plot.tall {}
                div #plot-contacts.plots {}
            }
        }
    }
}

/// The history for plots: columns of numbers, thinned where they are many.
fn history(results: &Results) -> Value {
    let table = &results.history;
    let stride = table.rows.len().div_ceil(ROWS_MOST).max(1);
    let last = table.rows.len().saturating_sub(1);
    let kept: Vec<usize> = (0..table.rows.len())
        .filter(|row| row % stride == 0 || *row == last)
        .collect();
    let axisymmetric = results.is_axisymmetric();
    let columns: Vec<Value> = (table.columns.iter().enumerate())
        .filter(|(_, name)| {
            !axisymmetric || !NOT_AXISYMMETRIC.iter().any(|end| name.ends_with(end))
        })
        .map(|(column, name)| {
            let values: Vec<Value> = kept
                .iter()
                .map(|row| match name.as_str() {
                    "step" => json!(table.text(*row, column)),
                    _ => json!(table.number(*row, column)),
                })
                .collect();
            json!({"name": name, "unit": unit(name, results.units()), "values": values})
        })
        .collect();
    json!({"name": results.name(), "columns": columns})
}
