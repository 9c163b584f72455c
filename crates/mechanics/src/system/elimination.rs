//! Unknowns that follow others: the nodes of rigid bodies.

use super::{Dof, Layout, NO_DOF, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// A rigid body: its reference point, and the nodes that move with it.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Reference point at the start: forces and moments of the body are about it.
    pub reference: Vec3,
    /// Its nodes.
    pub nodes: Vec<NodeId>,
}

/// Which nodes follow which rigid body.
#[derive(Clone, Debug, Default)]
pub struct Elimination {
    bodies: Vec<RigidBody>,
    // body of each node, or NONE; empty where there is no rigid body
    body_of: Vec<RigidId>,
}

const NONE: RigidId = RigidId::MAX;

/// A local contribution after its dependent unknowns have been replaced.
#[derive(Debug, Default)]
pub(super) struct Expanded {
    pub dofs: Vec<Dof>,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    // transformation, one row for each local dof: columns and values
    rows: Vec<Row>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    // up to one translation and three rotations: place in `dofs`, coefficient
    terms: [(usize, f64); 4],
    n: usize,
}

impl Elimination {
    /// The elimination for these bodies in a mesh of `nnode` nodes.
    #[must_use]
    pub fn new(bodies: Vec<RigidBody>, nnode: usize) -> Self {
        let mut body_of = Vec::new();
        if !bodies.is_empty() {
            body_of.resize(nnode, NONE);
            for (id, body) in bodies.iter().enumerate() {
                for &node in &body.nodes {
                    if let Some(of) = body_of.get_mut(node as usize) {
                        *of = id as RigidId;
                    }
                }
            }
        }
        Self { bodies, body_of }
    }

    /// The rigid bodies.
    #[must_use]
    pub fn bodies(&self) -> &[RigidBody] {
        &self.bodies
    }

    /// The rigid body that a node follows.
    #[inline]
    #[must_use]
    pub fn body_of(&self, node: NodeId) -> Option<RigidId> {
        let body = self.body_of.get(node as usize).copied()?;
        (body != NONE).then_some(body)
    }

    /// Whether the displacement behind a raw dof follows a rigid body.
    #[inline]
    #[must_use]
    pub fn depends(&self, dof: Dof, layout: &Layout) -> bool {
        !self.body_of.is_empty()
            && dof != NO_DOF
            && self.body_of(dof / layout.ndim as u32).is_some()
    }

    /// Puts the displacements of dependent nodes where the poses say.
    pub(super) fn follow(&self, state: &mut State, layout: &Layout, reference: &[Vec3]) {
        for (body, pose) in self.bodies.iter().zip(&state.poses) {
            for &node in &body.nodes {
                let Some(&start) = reference.get(node as usize) else {
                    continue;
                };
                let arm = start - body.reference;
                // exact for a pure translation: the rotated arm is not subtracted from positions
                let turned = pose.rotation * arm - arm;
                let moved = pose.origin - body.reference + turned;
                for axis in 0..layout.ndim {
                    if let Some(u) = state.u.get_mut(layout.node(node, axis) as usize) {
                        *u = moved[axis];
                    }
                }
            }
        }
    }

    /// The raw dofs that take the place of these ones, appended to `out`.
    pub fn independent(&self, dofs: &[Dof], layout: &Layout, out: &mut Vec<Dof>) {
        let mut last = None;
        for &dof in dofs {
            if !self.depends(dof, layout) {
                out.push(dof);
                continue;
            }
            let body = self.body_of(dof / layout.ndim as u32);
            if body != last {
                out.extend(body.into_iter().flat_map(|b| rigid_dofs(layout, b)));
                last = body;
            }
        }
        out.retain(|&d| d != NO_DOF);
    }

    /// Replaces dependent unknowns in a local force and stiffness, equations (E1) and (E2). The stiffness, row-major,
    /// is empty when only the force is wanted.
    pub(super) fn expand(
        &self,
        dofs: &[Dof],
        force: &[f64],
        stiffness: &[f64],
        state: &State,
        layout: &Layout,
        out: &mut Expanded,
    ) {
        out.dofs.clear();
        out.rows.clear();
        for &dof in dofs {
            let mut row = Row {
                terms: [(0, 0.0); 4],
                n: 0,
            };
            if self.depends(dof, layout) {
                let node = dof / layout.ndim as u32;
                let axis = dof as usize % layout.ndim;
                if let Some(body) = self.body_of(node) {
                    let arm = arm(state, node, body);
                    row.push(place(&mut out.dofs, layout.translation(body, axis)), 1.0);
                    // dx = dθ × a = −[a]× dθ (E1)
                    let turn = Mat3::skew(arm).rows[axis];
                    for about in 0..3 {
                        let rotation = layout.rotation(body, about);
                        if rotation != NO_DOF {
                            row.push(place(&mut out.dofs, rotation), -turn[about]);
                        }
                    }
                }
            } else {
                out.dofs.push(dof);
                row.push(out.dofs.len() - 1, 1.0);
            }
            out.rows.push(row);
        }
        let (n, m) = (dofs.len(), out.dofs.len());
        out.force.clear();
        out.force.resize(m, 0.0);
        for (row, f) in out.rows.iter().zip(force) {
            for &(k, c) in &row.terms[..row.n] {
                out.force[k] += c * f;
            }
        }
        out.stiffness.clear();
        if stiffness.is_empty() {
            return;
        }
        out.stiffness.resize(m * m, 0.0);
        for (i, row) in out.rows.iter().enumerate() {
            for (j, column) in out.rows.iter().enumerate() {
                let value = stiffness[i * n + j];
                if value == 0.0 {
                    continue;
                }
                for &(p, a) in &row.terms[..row.n] {
                    for &(q, b) in &column.terms[..column.n] {
                        out.stiffness[p * m + q] += a * b * value;
                    }
                }
            }
        }
        self.turning(dofs, force, state, layout, out);
    }

    /// The change of the moments with the arms, (E2).
    fn turning(
        &self,
        dofs: &[Dof],
        force: &[f64],
        state: &State,
        layout: &Layout,
        out: &mut Expanded,
    ) {
        let m = out.dofs.len();
        for (&dof, &f) in dofs.iter().zip(force) {
            if !self.depends(dof, layout) {
                continue;
            }
            let node = dof / layout.ndim as u32;
            let Some(body) = self.body_of(node) else {
                continue;
            };
            let single = Vec3::unit(dof as usize % layout.ndim) * f;
            let term = Mat3::skew(single) * Mat3::skew(arm(state, node, body));
            for i in 0..3 {
                for j in 0..3 {
                    let (p, q) = (layout.rotation(body, i), layout.rotation(body, j));
                    if p != NO_DOF && q != NO_DOF {
                        let (p, q) = (place(&mut out.dofs, p), place(&mut out.dofs, q));
                        out.stiffness[p * m + q] += term.rows[i][j];
                    }
                }
            }
        }
    }
}

impl Row {
    fn push(&mut self, place: usize, coefficient: f64) {
        self.terms[self.n] = (place, coefficient);
        self.n += 1;
    }
}

fn arm(state: &State, node: NodeId, body: RigidId) -> Vec3 {
    let x = state.x.get(node as usize).copied().unwrap_or_default();
    let origin = state.poses.get(body as usize).map_or(x, |p| p.origin);
    x - origin
}

fn rigid_dofs(layout: &Layout, body: RigidId) -> impl Iterator<Item = Dof> + use<> {
    let layout = *layout;
    (0..3)
        .map(move |c| layout.translation(body, c))
        .chain((0..3).map(move |c| layout.rotation(body, c)))
}

/// The place of a dof in the list, appended where it is not yet there.
fn place(dofs: &mut Vec<Dof>, dof: Dof) -> usize {
    dofs.iter().position(|&d| d == dof).unwrap_or_else(|| {
        dofs.push(dof);
        dofs.len() - 1
    })
}
