//! Shells: solids in their place, and what a case means by their nodes, elements and sides.
//!
//! ```text
//! Mesh with shells ──expand──▶ Mesh with solids, Shells ──▶ Names, Parts
//! ```
//!
//! Sets of a case keep the nodes that its mesh has: supports, loads and printed values are those of the middle. The nodes of solids
//! stand for these wherever a set of elements or faces brings them in.

mod joints;
mod loads;
mod mirrors;
mod rotations;
mod temperatures;

pub(super) use loads::{line_load, moments, no_rotations};
pub(super) use rotations::Rotations;

use joints::Joints;

use super::names::Names;
use super::quoted;
use signorini_geometry::expansion::{
    self, Expansion, ExpansionError, Joining, Place as Between, Section, ShellCell, ShellSide,
    expand,
};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Body, Case, ConstraintKind, DynamicMethod, Shell, Thickness};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::system::Director;
use std::collections::{BTreeMap, HashMap};

/// The shells of a model.
#[derive(Default)]
pub(super) struct Shells {
    /// What became of them; the mesh is empty.
    expansion: Option<Expansion>,
    /// The number of the shell behind each element of the input.
    by_label: HashMap<u64, usize>,
    /// Nodes before this one are those of the input.
    first: usize,
    /// The node of the surface behind each node from there on.
    behind: Vec<NodeId>,
    /// The nodes of the input that each of the first of these lies between.
    parents: Vec<Vec<NodeId>>,
    joints: Joints,
}

/// The shells of a body.
struct OfBody<'a> {
    shell: &'a Shell,
    cells: Vec<CellId>,
}

impl Shells {
    /// Puts solids in the place of shells.
    ///
    /// # Errors
    /// What makes no shells, as messages.
    pub fn expand(case: &Case, mesh: Mesh, found: &mut Diagnostics) -> Option<(Mesh, Self)> {
        let shells = case.bodies.iter();
        let shells = shells.filter_map(|body| Some((body, body.shell.as_ref()?)));
        let shells: Vec<_> = shells.collect();
        if shells.is_empty() {
            return Some((mesh, Self::default()));
        }
        not_built(case, found);
        let none = Self::default();
        let names = Names::of_surfaces(case, &mesh, &none, found);
        let thicknesses = names.thicknesses(case, found);
        // 0 where the case gives none
        let at_nodes: Vec<f64> = thicknesses
            .iter()
            .map(|&t| if t == 0.0 { f64::NAN } else { t })
            .collect();
        let of_bodies = shells.into_iter().filter_map(|(body, shell)| {
            let cells = surfaces(body, &names, &mesh, found)?;
            lacks_thickness(body, shell, (&names, &cells, &at_nodes), found)?;
            Some(OfBody { shell, cells })
        });
        let of_bodies: Vec<OfBody<'_>> = of_bodies.collect();
        if found.has_errors() {
            return None;
        }
        let expansion = solids((case, &names), &of_bodies, &mesh, &at_nodes, found)?;
        drop(names);
        Some(Self::of(expansion, &of_bodies, mesh))
    }

    fn of(mut expansion: Expansion, of_bodies: &[OfBody<'_>], given: Mesh) -> (Mesh, Self) {
        let cells = of_bodies.iter().flat_map(|of| &of.cells);
        let labels = cells
            .zip(0..)
            .filter_map(|(&cell, number)| Some((given.cell_label(cell)?, number)));
        let by_label = labels.collect();
        let mut mesh = std::mem::take(&mut expansion.mesh);
        let joints = Joints::new(&mut expansion, &mut mesh);
        let first = given.nnode();
        let cells: Vec<CellId> = of_bodies
            .iter()
            .flat_map(|of| of.cells.iter().copied())
            .collect();
        let parents = expansion.places.iter().map(|place| match place {
            Between::Edge(ends) => ends.to_vec(),
            Between::Cell(shell) => {
                let cell = cells.get(*shell).map_or(&[][..], |&cell| given.cell(cell));
                cell.to_vec()
            }
        });
        let parents = parents.collect();
        let mut behind: Vec<NodeId> = (first..mesh.nnode()).map(|node| node as NodeId).collect();
        for director in &expansion.directors {
            for node in [
                director.middle,
                director.half,
                director.negative,
                director.positive,
            ] {
                let place = (node as usize).checked_sub(first);
                if let Some(behind) = place.and_then(|place| behind.get_mut(place)) {
                    *behind = director.node;
                }
            }
        }
        let shells = Self {
            expansion: Some(expansion),
            by_label,
            first,
            behind,
            parents,
            joints,
        };
        (mesh, shells)
    }

    /// Where shells meet that have directors of their own.
    pub const fn joints(&self) -> &Joints {
        &self.joints
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.expansion.is_none()
    }

    /// All directors, in the order of the nodes that they stand on.
    pub fn directors(&self) -> &[expansion::Director] {
        self.expansion.as_ref().map_or(&[], |of| &of.directors)
    }

    /// The directors on a node of the surface.
    pub fn directors_at(&self, node: NodeId) -> &[expansion::Director] {
        self.expansion
            .as_ref()
            .map_or(&[], |of| of.directors_at(node))
    }

    /// All directors by their nodes.
    pub fn parts(&self) -> Vec<Director> {
        let of_nodes = |one: &expansion::Director| Director {
            middle: one.middle,
            half: one.half,
            ends: [one.negative, one.positive],
        };
        self.directors().iter().map(of_nodes).collect()
    }

    /// Puts the nodes of the surface in the place of those of solids, each once. Sorted.
    pub fn to_surface(&self, nodes: &mut Vec<NodeId>) {
        if self.is_empty() {
            return;
        }
        for node in nodes.iter_mut() {
            let place = (*node as usize).checked_sub(self.first);
            if let Some(&behind) = place.and_then(|place| self.behind.get(place)) {
                *node = behind;
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
    }

    /// New nodes of the surface, each with the nodes of the input that it lies between: on an edge, or in an element.
    fn between(&self) -> impl Iterator<Item = (NodeId, &[NodeId])> {
        let nodes = self.first..;
        let nodes = nodes.map(|node| node as NodeId);
        nodes.zip(self.parents.iter().map(Vec::as_slice))
    }

    /// Adds the nodes that lie between these, on edges and in elements all of whose nodes are among them. Sorted.
    pub fn add_between(&self, nodes: &mut Vec<NodeId>) {
        let has = |node: &NodeId| nodes.binary_search(node).is_ok();
        let more = self
            .between()
            .filter(|(_, parents)| parents.iter().all(has));
        let more: Vec<NodeId> = more.map(|(node, _)| node).collect();
        nodes.extend(more);
        nodes.sort_unstable();
        nodes.dedup();
    }

    /// The solids of an element of the input, where it is a shell.
    pub fn solids(&self, label: u64) -> Option<&[CellId]> {
        let number = *self.by_label.get(&label)?;
        self.expansion
            .as_ref()?
            .solids
            .get(number)
            .map(Vec::as_slice)
    }

    /// The faces of a side of an element of the input, where it is a shell: 1 negative, 2 positive, 3 and more its edges.
    pub fn side(&self, label: u64, side: u8) -> Option<Vec<Face>> {
        let number = *self.by_label.get(&label)?;
        let side = ShellSide::numbered(side.checked_sub(1)?);
        Some(self.expansion.as_ref()?.faces(number, side).collect())
    }
}

/// Refuses what shells do not do yet.
fn not_built(case: &Case, found: &mut Diagnostics) {
    let mut refuse = |text: &str, place: &Place, remark: &str| {
        found.push(Diagnostic::error(&codes::NOT_BUILT, text).at(place, remark));
    };
    for step in &case.steps {
        let method = step.dynamics.as_ref().map(|dynamics| dynamics.method);
        if let Some(DynamicMethod::Explicit { .. }) = method {
            let text = "shells have no masses at nodes for explicit steps yet";
            refuse(text, &step.place, "use an implicit method");
        }
    }
    for body in case.bodies.iter().filter(|body| body.shell.is_some()) {
        let named = body.material.as_ref();
        let material = case
            .materials
            .iter()
            .find(|one| named.is_some_and(|name| one.name.value == name.value));
        if material.is_some_and(|one| one.damping.stiffness > 0.0) {
            refuse(
                "stiffness damping of shells is not built yet",
                &body.place,
                "its material has some",
            );
        }
    }
    for one in &case.constraints {
        if let ConstraintKind::Pretension { on, .. } = &one.kind {
            refuse(
                "pretension does not cut models with shells yet",
                &on.place,
                "",
            );
        }
    }
}

/// The cells of a body of shells.
fn surfaces(
    body: &Body,
    names: &Names<'_>,
    mesh: &Mesh,
    found: &mut Diagnostics,
) -> Option<Vec<CellId>> {
    let mut cells = Vec::new();
    for group in &body.groups {
        let of_group = names.cells_of(group, found)?;
        let is_surface = |cell: &CellId| mesh.element(*cell).is_some_and(|e| e.dim() == 2);
        let before = cells.len();
        cells.extend(of_group.iter().copied().filter(is_surface));
        if cells.len() == before {
            let text = format!("{} has no triangles and no quadrilaterals", quoted(group));
            let one = Diagnostic::error(&codes::WRONG_KIND, text);
            found.push(one.at(&group.place, "a shell is made of elements of a surface"));
            return None;
        }
    }
    Some(cells)
}

/// Refuses a shell that takes its thickness from nodes where one has none.
fn lacks_thickness(
    body: &Body,
    shell: &Shell,
    (names, cells, at_nodes): (&Names<'_>, &[CellId], &[f64]),
    found: &mut Diagnostics,
) -> Option<()> {
    if shell.thickness.value != Thickness::Field {
        return Some(());
    }
    let has_none = |node: &NodeId| at_nodes.get(*node as usize).is_none_or(|t| t.is_nan());
    let around = names.nodes_around(cells.iter().copied());
    let Some(node) = around.into_iter().find(has_none) else {
        return Some(());
    };
    let text = format!(
        "{} takes its thickness from nodes, and node {} has none",
        quoted(body.groups.first()?),
        names.label(node)
    );
    let one = Diagnostic::error(&codes::MISSING, text).at(&shell.thickness.place, "");
    found.push(one.help("write  [[thickness]] on = , value =  for all of its nodes"));
    None
}

/// The solids of all shells.
fn solids(
    (case, names): (&Case, &Names<'_>),
    of_bodies: &[OfBody<'_>],
    mesh: &Mesh,
    at_nodes: &[f64],
    found: &mut Diagnostics,
) -> Option<Expansion> {
    let section = |of: &OfBody<'_>| match of.shell.thickness.value {
        Thickness::Uniform(thickness) => Section {
            thickness,
            at_nodes: None,
            offset: of.shell.offset,
        },
        Thickness::Field => Section {
            thickness: 0.0,
            at_nodes: Some(at_nodes),
            offset: of.shell.offset,
        },
    };
    let sections: Vec<Section<'_>> = of_bodies.iter().map(section).collect();
    let cells = of_bodies.iter().enumerate().flat_map(|(section, of)| {
        let cells = of.cells.iter();
        cells.map(move |&cell| ShellCell { cell, section })
    });
    let cells: Vec<ShellCell> = cells.collect();
    let angles = of_bodies
        .iter()
        .map(|of| of.shell.normals.value.to_radians());
    let angle = angles.fold(f64::INFINITY, f64::min);
    let expanded = |given: &BTreeMap<(CellId, NodeId), Vec3>| {
        let joining = Joining { angle, given };
        expand(mesh, &cells, &sections, &joining)
    };
    let expansion = expanded(&BTreeMap::new()).and_then(|expansion| {
        let mirrored = mirrors::normals(case, names, mesh, &cells, &expansion);
        match mirrored.is_empty() {
            true => Ok(expansion),
            false => expanded(&mirrored),
        }
    });
    match expansion {
        Ok(expansion) => Some(expansion),
        Err(error) => {
            found.push(refused(&error, of_bodies));
            None
        }
    }
}

fn refused(error: &ExpansionError, of_bodies: &[OfBody<'_>]) -> Diagnostic {
    let one = Diagnostic::error(&codes::BAD_ELEMENTS, error.to_string());
    match of_bodies.first() {
        Some(of) => one.at(&of.shell.place, "in the shells of this case"),
        None => one,
    }
}
