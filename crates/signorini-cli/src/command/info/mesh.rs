//! The content of a mesh.

use crate::command::check::shapes;
use serde::Serialize;
use serde_json::Value;
use signorini::preview;
use signorini::text::{count, plural, short};
use signorini_geometry::mesh::Mesh;
use signorini_geometry::mesh::quality::{Quality, quality};
use signorini_io::readers::{self, Severity};
use std::collections::BTreeMap;

/// Nodes, cells, groups and faults of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Content {
    nodes: usize,
    /// Cells by type.
    cells: BTreeMap<&'static str, usize>,
    /// Smallest and largest coordinates along x, y and z.
    bounds: [Option<[f64; 2]>; 3],
    /// The shapes of the elements, as `check` has them.
    quality: Option<Value>,
    groups: Vec<Group>,
    issues: Vec<Issue>,
    notes: Vec<String>,
    #[serde(skip)]
    blocks: Vec<(&'static str, usize)>,
    #[serde(skip)]
    shapes: Vec<String>,
}

/// What a group has.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
struct Group {
    name: String,
    volume_cells: usize,
    surface_cells: usize,
    lines: usize,
    points: usize,
    /// Faces of solids.
    faces: usize,
    /// Nodes that are named one by one.
    nodes: usize,
}

/// A fault, or something unusual.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Issue {
    severity: &'static str,
    message: String,
    help: Option<String>,
}

impl Content {
    /// The content of a mesh, with what its reader noted.
    pub fn new(mesh: &Mesh, notes: Vec<String>) -> Self {
        let blocks = mesh.blocks.iter();
        let blocks: Vec<_> = blocks.map(|b| (b.element.name(), b.ncell())).collect();
        let mut cells = BTreeMap::new();
        for (name, n) in &blocks {
            *cells.entry(*name).or_insert(0) += n;
        }
        let bounds = [0, 1, 2].map(|axis: usize| {
            let values = mesh.points.iter();
            let values = values.filter_map(|x| x.to_array().get(axis).copied());
            values.fold(None, |range: Option<[f64; 2]>, x| {
                let [low, high] = range.unwrap_or([x; 2]);
                Some([low.min(x), high.max(x)])
            })
        });
        let quality = quality(mesh, mesh.cells(mesh.dim()));
        let in_words = |quality: &Quality| preview::shapes(mesh, quality);
        Self {
            nodes: mesh.nnode(),
            cells,
            bounds,
            shapes: quality.as_ref().map(in_words).unwrap_or_default(),
            quality: quality.as_ref().map(shapes),
            groups: groups(mesh),
            issues: issues(mesh),
            notes,
            blocks,
        }
    }

    /// What there is to say, line by line.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![plural(self.nodes, "node")];
        for (name, n) in &self.blocks {
            lines.push(format!("{} {name}", count(*n)));
        }
        for (name, range) in ["x", "y", "z"].iter().zip(self.bounds) {
            if let Some([low, high]) = range
                && low < high
            {
                lines.push(format!("{name} from {} to {}", short(low), short(high)));
            }
        }
        lines.extend(self.shapes.iter().cloned());
        lines.extend(self.groups.iter().map(Group::line));
        for issue in &self.issues {
            let help = issue.help.as_ref();
            let help = help.map_or_else(String::new, |help| format!("; {help}"));
            lines.push(format!("{}: {}{help}", issue.severity, issue.message));
        }
        lines.extend(self.notes.iter().map(|note| format!("note: {note}")));
        lines
    }
}

impl Group {
    fn line(&self) -> String {
        let parts = [
            (self.volume_cells, "volume cell"),
            (self.surface_cells, "surface cell"),
            (self.lines, "line"),
            (self.points, "point"),
            (self.faces, "face"),
            (self.nodes, "node"),
        ];
        let parts = parts.iter().filter(|(n, _)| *n > 0);
        let parts: Vec<String> = parts.map(|(n, noun)| plural(*n, noun)).collect();
        format!("group {}: {}", self.name, parts.join(", "))
    }
}

fn groups(mesh: &Mesh) -> Vec<Group> {
    let of = |(name, set): (&String, &signorini_geometry::mesh::Set)| {
        let ncell = |dim: usize| {
            let cells = set.cells.iter();
            let of_dim = |cell: &&_| mesh.element(**cell).is_some_and(|e| e.dim() == dim);
            cells.filter(of_dim).count()
        };
        Group {
            name: name.clone(),
            volume_cells: ncell(3),
            surface_cells: ncell(2),
            lines: ncell(1),
            points: ncell(0),
            faces: set.faces.len(),
            nodes: set.nodes.len(),
        }
    };
    mesh.sets.iter().map(of).collect()
}

fn issues(mesh: &Mesh) -> Vec<Issue> {
    let all = readers::validate(mesh).into_iter();
    all.map(|issue| Issue {
        severity: match issue.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        },
        message: issue.to_string(),
        help: issue.remedy().map(|remedy| remedy.to_string()),
    })
    .collect()
}
