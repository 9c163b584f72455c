//! The mesh of a case, from its text or from a file, and whether it can be used.

use super::quoted;
use signorini_geometry::mesh::Mesh;
use signorini_io::case::{Case, MeshSource, Name, Shape, Space};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_io::readers::{self, MeshIssue, Severity};
use std::path::Path;

/// Reads the triangles of all surfaces of a case that are given by files. `folder` is where the case lies: paths are
/// relative to it.
///
/// # Errors
/// Files that cannot be read, or hold no triangles.
pub fn read_surfaces_of(case: &mut Case, folder: &Path) -> Result<Diagnostics, Diagnostics> {
    let mut found = Diagnostics::new();
    for surface in &mut case.surfaces {
        let Shape::Stl { path } = &surface.shape else {
            continue;
        };
        let file = folder.join(&path.value);
        let name = file.display().to_string();
        let bytes = match signorini_io::fs::read(&file) {
            Ok(bytes) => bytes,
            Err(error) => {
                found.push(
                    Diagnostic::error(
                        &codes::UNREADABLE,
                        format!("{name} cannot be read: {error}"),
                    )
                    .at(&path.place, "named here")
                    .help("paths are relative to the case"),
                );
                continue;
            }
        };
        match readers::stl::read(&name, &bytes) {
            Ok((triangles, notes)) => {
                surface.triangles = Some((triangles.points, triangles.triangles));
                for note in notes {
                    let severity = signorini_io::diagnostic::Severity::Note;
                    found.push(Diagnostic::new(severity, &codes::MESH_NOTE, note));
                }
            }
            Err(error) => found.push(
                Diagnostic::error(&codes::BAD_MESH, error.to_string())
                    .at(&path.place, "these triangles"),
            ),
        }
    }
    if found.has_errors() {
        return Err(found);
    }
    Ok(found)
}

/// The mesh of a case. `folder` is where the case lies: paths of mesh files are relative to it.
///
/// # Errors
/// A file that cannot be read, a damaged mesh, elements that no solver can use.
pub fn read_mesh_of(case: &Case, folder: &Path) -> Result<(Mesh, Diagnostics), Diagnostics> {
    let mut found = Diagnostics::new();
    let mesh = match &case.mesh {
        MeshSource::File { path } => {
            let file = folder.join(&path.value);
            let bytes = signorini_io::fs::read(&file).map_err(|error| {
                Diagnostic::error(
                    &codes::UNREADABLE,
                    format!("{} cannot be read: {error}", file.display()),
                )
                .at(&path.place, "named here")
                .help("paths are relative to the case")
            })?;
            let name = file.display().to_string();
            let read = match has_shells(case) {
                true => readers::read_mesh_of_shells(&name, &bytes),
                false => readers::read_mesh(&name, &bytes),
            };
            let (mesh, notes) = read.map_err(|error| {
                Diagnostic::error(&codes::BAD_MESH, error.to_string()).at(&path.place, "this mesh")
            })?;
            for note in notes {
                found.push(Diagnostic::new(
                    signorini_io::diagnostic::Severity::Note,
                    &codes::MESH_NOTE,
                    note,
                ));
            }
            mesh
        }
        MeshSource::Inline {
            nodes, elements, ..
        } => inline(nodes, elements)?,
    };
    found.append(judge_mesh_of(case, &mesh)?);
    Ok((mesh, found))
}

/// What is unusual with the mesh of a case.
///
/// # Errors
/// Elements that no solver can use.
pub fn judge_mesh_of(case: &Case, mesh: &Mesh) -> Result<Diagnostics, Diagnostics> {
    let place = match &case.mesh {
        MeshSource::File { path } => &path.place,
        MeshSource::Inline { place, .. } => place,
    };
    let mut found = Diagnostics::new();
    let issues = match has_shells(case) {
        true => readers::validate_as(mesh, false),
        false => readers::validate(mesh),
    };
    for issue in issues {
        let mut one = judged(&issue, place).about_elements(issue.elements());
        let element = issue.elements().first();
        if let Some((element, body)) = element.and_then(|e| Some((e, body_of(*e, case, mesh)?))) {
            one = one.note(format!(
                "element {element} belongs to body {}",
                quoted(body)
            ));
        }
        found.push(issue.remedy().into_iter().fold(one, Diagnostic::help));
    }
    if found.has_errors() {
        return Err(found);
    }
    Ok(found)
}

fn has_shells(case: &Case) -> bool {
    case.bodies.iter().any(|body| body.shell.is_some())
}

/// The group of a body that an element belongs to.
pub(super) fn body_of<'a>(element: u64, case: &'a Case, mesh: &Mesh) -> Option<&'a Name> {
    let has = |group: &str| {
        let cells = mesh.sets.get(group).map(|set| set.cells.iter());
        let labels = cells.into_iter().flatten().map(|c| mesh.cell_label(*c));
        labels.flatten().any(|label| label == element)
    };
    let mut groups = case.bodies.iter().flat_map(|body| &body.groups);
    groups.find(|group| has(&group.value))
}

fn inline(
    nodes: &[(u64, [f64; 3])],
    elements: &[signorini_io::case::InlineElement],
) -> Result<Mesh, Diagnostics> {
    let plain: Vec<readers::InlineElement<'_>> = elements
        .iter()
        .map(|e| {
            let group = e.group.as_ref().map(|g| g.value.as_str());
            (e.id, e.element_type.value.as_str(), group, &e.nodes[..])
        })
        .collect();
    readers::build(nodes, &plain).map_err(|errors| {
        let mut found = Diagnostics::new();
        for error in errors {
            let message = Diagnostic::error(&codes::BAD_MESH, error.to_string());
            let of_element = elements.iter().find(|e| {
                error
                    .to_string()
                    .split(|c: char| !c.is_ascii_digit())
                    .any(|n| n == e.id.to_string())
            });
            found.push(match of_element {
                Some(element) => message.at(&element.place, ""),
                None => message,
            });
        }
        found
    })
}

fn judged(issue: &MeshIssue, place: &Place) -> Diagnostic {
    let code = match issue {
        MeshIssue::Mirrored { .. }
        | MeshIssue::Inverted { .. }
        | MeshIssue::Folded { .. }
        | MeshIssue::Flat { .. } => &codes::BAD_ELEMENTS,
        _ if issue.severity() == Severity::Error => &codes::BAD_MESH,
        _ => &codes::MESH_NOTE,
    };
    let severity = match issue.severity() {
        Severity::Error => signorini_io::diagnostic::Severity::Error,
        // bodies in contact have coincident nodes as a rule: worth a note, not a warning
        _ if matches!(issue, MeshIssue::Coincident { .. }) => {
            signorini_io::diagnostic::Severity::Note
        }
        Severity::Warning => signorini_io::diagnostic::Severity::Warning,
        Severity::Note => signorini_io::diagnostic::Severity::Note,
    };
    let message = Diagnostic::new(severity, code, issue.to_string());
    if severity == signorini_io::diagnostic::Severity::Error {
        message.at(place, "in this mesh")
    } else {
        message
    }
}

/// The message for a mesh that does not suit the dimension of the model.
pub(super) fn unfit(case: &Case, mesh: &Mesh) -> Option<Diagnostic> {
    let space = &case.model.space;
    let (found, wanted) = (mesh.dim(), space.ndim());
    let of_bars = || case.bodies.iter().any(|body| body.area.is_some());
    let of_points =
        || case.bodies.is_empty() && !(case.springs.is_empty() && case.masses.is_empty());
    let suits = match found {
        0 => of_points(),
        _ => found == wanted || found < wanted && of_bars(),
    };
    if !suits {
        let message = match (found, wanted) {
            (2, 3) => "the mesh has no volume elements; did you save only the surface?",
            (3, 2) => "the mesh has volume elements, the model is in the plane",
            _ => "the mesh has no solid elements",
        };
        let help = match wanted {
            3 => "export the volume elements, or choose  [model] space = \"plane-strain\"",
            _ => "choose  [model] space = \"3d\"",
        };
        let message = Diagnostic::error(&codes::BAD_MESH, message);
        let remark = format!("{wanted} dimensions here");
        return Some(message.at(&space.place, remark).help(help));
    }
    if space.value == Space::Axisymmetric {
        return off_axis(mesh).map(|message| message.at(&space.place, "x is the radius here"));
    }
    None
}

/// A node of an element on the wrong side of the axis, beyond what rounding explains.
fn off_axis(mesh: &Mesh) -> Option<Diagnostic> {
    let size = mesh.points.iter().map(|x| x.x.abs().max(x.y.abs()));
    let size = size.fold(0.0, f64::max);
    let nodes = mesh.blocks.iter().flat_map(|block| &block.nodes);
    let at = |node: &u32| mesh.points.get(*node as usize).map(|x| (*node, x.x));
    let (node, radius) = nodes.filter_map(at).min_by(|a, b| a.1.total_cmp(&b.1))?;
    let label = mesh.node_labels.get(node as usize)?;
    (radius < -1e-9 * size).then(|| {
        Diagnostic::error(
            &codes::BAD_MESH,
            format!("node {label} lies at x = {radius}, beyond the axis of revolution"),
        )
        .help("mesh the half with x >= 0; the axis is x = 0")
    })
}
