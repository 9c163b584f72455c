//! What holds the bodies: which rigid motions are left to each, and which of them contact alone can stop.
//!
//! A *unit* moves as a whole: the deformable cells that hang together by common nodes, or a carrier with its rigid
//! bodies. Its small motions are six numbers, the displacement `t` of its centre `c` and a rotation `θ`; three in the
//! plane, the displacement along the axis alone for a body of revolution.
//!
//! | symbol | meaning                                              |
//! |--------|------------------------------------------------------|
//! | `q`    | `(t, L θ)` of all units                               |
//! | `L`    | largest distance of a node of the unit from `c`       |
//! | `a`    | a row: what a support, equation or contact prevents   |
//! | `G`    | `Σ aᵀ a`                                              |
//!
//! ```text
//! u(x) = t + θ × (x − c)                                          (E1)
//! Σ k u_i(x) = 0   ──(E1)──▶   a q = 0                            (E2)
//! free motions: the null space of G                               (E3)
//! ```
//!
//! Supports, equations, couplings and springs are rows. A contact adds one row for each corner of each facet of its
//! primary side: there the two sides cannot approach along the normal of the facet. That is more than contact can do,
//! for it may be open; a motion that is free all the same is one that no contact stops.
//!
//! Limits: motions are small. Bars that hang together count as rigid, mechanisms among them are not seen.

mod null_space;
mod rows;
#[cfg(test)]
mod tests;
mod unheld;
mod words;

pub use unheld::Unheld;

use super::{BodyPart, CarrierPart, ModelError};
use crate::model::label::label;
use crate::system::{Directors, Elimination, Idealisation};
use null_space::null_space;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use unheld::{Motion, NCOMPONENT};

/// Units that are judged together; more are judged one by one, as if all others were held.
const NTOGETHER: usize = 100;

/// What moves as a whole.
struct Unit {
    /// The bodies it consists of.
    bodies: BTreeSet<usize>,
    /// Its name, where it is a carrier.
    carrier: Option<String>,
    /// The first of its nodes.
    node: Option<NodeId>,
    centre: Vec3,
    length: f64,
}

/// Rows of equations (E2).
#[derive(Clone, Default)]
struct Rows {
    /// `Σ aᵀ a` of the rows that speak of one unit only.
    own: Vec<[Motion; NCOMPONENT]>,
    /// The rows that speak of several.
    shared: Vec<Row>,
}

/// A row: units with their coefficients.
type Row = Vec<(usize, Motion)>;

/// The units of a model, and what holds them.
pub(super) struct Held<'a> {
    mesh: &'a Mesh,
    space: Idealisation,
    /// What each body stands for.
    spaces: Vec<Idealisation>,
    elimination: &'a Elimination,
    names: Vec<String>,
    units: Vec<Unit>,
    /// Unit of the deformable cells around each node.
    part_of: Vec<Option<usize>>,
    /// Unit of the first carrier; the others follow.
    first_carrier: usize,
    rows: Rows,
    by_contact: Rows,
    /// Whether carriers may move freely.
    bodies_alone: bool,
}

impl<'a> Held<'a> {
    /// The units of the cells of these bodies that take part, and of these carriers, which nothing holds yet.
    pub fn new(
        mesh: &'a Mesh,
        space: Idealisation,
        bodies: &[BodyPart],
        carriers: &[CarrierPart],
        elimination: &'a Elimination,
        is_active: &dyn Fn(CellId) -> bool,
    ) -> Self {
        let (mut units, part_of) = parts(mesh, bodies, elimination.directors(), is_active);
        let first_carrier = units.len();
        for (carrier, body) in carriers.iter().zip(elimination.bodies()) {
            let mut unit = Unit::of_nodes(mesh, body.reference, &body.nodes);
            unit.carrier = Some(carrier.name.clone());
            units.push(unit);
        }
        let rows = Rows {
            own: vec![Default::default(); units.len()],
            shared: Vec::new(),
        };
        let mut held = Self {
            mesh,
            space,
            spaces: bodies.iter().map(|b| b.kind.space(space)).collect(),
            elimination,
            names: bodies.iter().map(|b| b.name.clone()).collect(),
            units,
            part_of,
            first_carrier,
            by_contact: rows.clone(),
            rows,
            bodies_alone: false,
        };
        held.without_effect();
        held.common_nodes();
        held
    }

    /// Carriers may move freely: what they carry may take no part, and then they have no unknowns.
    pub fn judge_bodies_alone(&mut self) {
        self.bodies_alone = true;
    }

    /// Bodies that contact keeps from a motion.
    ///
    /// # Errors
    /// A body with a motion that nothing stops.
    pub fn judge(mut self) -> Result<Vec<Unheld>, ModelError> {
        let by_contact = self.unheld();
        let contact = std::mem::take(&mut self.by_contact);
        for (own, more) in self.rows.own.iter_mut().zip(&contact.own) {
            add(own, more);
        }
        self.rows.shared.extend(contact.shared);
        match self.unheld() {
            free if free.is_empty() => Ok(by_contact),
            free => Err(ModelError::FreeBodies(free)),
        }
    }

    /// Who can move, and how.
    fn unheld(&self) -> Vec<Unheld> {
        let mut together = vec![0; self.units.len()];
        for (number, group) in self.groups().iter().enumerate() {
            for &unit in group {
                together[unit] = number;
            }
        }
        let units = self.units.iter().zip(self.free()).zip(together);
        let of_unit = |((unit, motions), together): ((&Unit, Vec<Motion>), usize)| {
            if self.bodies_alone && unit.carrier.is_some() {
                return None;
            }
            let motion = words::describe(self.space, unit.centre, unit.length, &motions)?;
            let names = unit.bodies.iter().filter_map(|&b| self.names.get(b));
            let is_whole =
                |other: &Unit| std::ptr::eq(other, unit) || other.bodies.is_disjoint(&unit.bodies);
            let part = unit.node.filter(|_| !self.units.iter().all(is_whole));
            Some(Unheld {
                bodies: names.chain(&unit.carrier).cloned().collect(),
                node: part.map(|node| label(self.mesh, node)),
                together,
                motion,
            })
        };
        units.filter_map(of_unit).collect()
    }

    /// Components in which units move.
    fn components(&self) -> &'static [usize] {
        let mut all = self.spaces.iter().chain([&self.space]);
        match self.space {
            Idealisation::Space => &[0, 1, 2, 3, 4, 5],
            // what only equations speak of has a first component, too
            _ if all.all(|one| *one == Idealisation::Axisymmetric) => &[0, 1],
            _ => &[0, 1, 5],
        }
    }

    /// Whether a unit stays where its axis is: one with bodies of revolution, and what moves with a carrier of a model of
    /// revolution.
    fn revolves(&self, unit: &Unit) -> bool {
        let axisymmetric = |space: &Idealisation| *space == Idealisation::Axisymmetric;
        if unit.carrier.is_some() {
            return axisymmetric(&self.space);
        }
        let mut spaces = unit.bodies.iter().filter_map(|&b| self.spaces.get(b));
        spaces.any(axisymmetric)
    }

    /// A basis of the free motions of each unit (E3), of all together.
    fn free(&self) -> Vec<Vec<Motion>> {
        let mut free = vec![Vec::new(); self.units.len()];
        // the rows that speak of each unit
        let mut rows_of: Vec<Vec<&Row>> = vec![Vec::new(); self.units.len()];
        for row in &self.rows.shared {
            for (unit, _) in row {
                if let Some(rows) = rows_of.get_mut(*unit) {
                    rows.push(row);
                }
            }
        }
        let rows_of = |unit: usize| rows_of.get(unit).map_or(&[][..], Vec::as_slice);
        for group in self.groups() {
            if group.len() > NTOGETHER {
                for &unit in &group {
                    self.free_together(&[unit], rows_of(unit).iter().copied(), &mut free);
                }
            } else {
                // each row once: with the first of its units
                let begins =
                    |unit: usize| move |row: &&&Row| row.first().map(|r| r.0) == Some(unit);
                let rows = group
                    .iter()
                    .flat_map(|&u| rows_of(u).iter().filter(begins(u)));
                self.free_together(&group, rows.copied(), &mut free);
            }
        }
        free
    }

    fn free_together<'r>(
        &self,
        group: &[usize],
        shared: impl Iterator<Item = &'r Row>,
        free: &mut [Vec<Motion>],
    ) {
        let components = self.components();
        let n = components.len();
        let size = n * group.len();
        let mut gram = vec![0.0; size * size];
        for (k, &unit) in group.iter().enumerate() {
            for (i, &a) in components.iter().enumerate() {
                for (j, &b) in components.iter().enumerate() {
                    gram[(k * n + i) * size + k * n + j] = self.rows.own[unit][a][b];
                }
            }
        }
        let mut dense: Vec<(usize, f64)> = Vec::new();
        for row in shared {
            dense.clear();
            for (unit, motion) in row {
                let Ok(k) = group.binary_search(unit) else {
                    continue;
                };
                let pairs = components.iter().enumerate();
                dense.extend(pairs.map(|(i, &a)| (k * n + i, motion[a])));
            }
            for &(i, a) in &dense {
                for &(j, b) in &dense {
                    gram[i * size + j] += a * b;
                }
            }
        }
        for vector in null_space(gram, size) {
            for (part, &unit) in vector.chunks_exact(n).zip(group) {
                let mut motion = [0.0; NCOMPONENT];
                for (&component, value) in components.iter().zip(part) {
                    motion[component] = *value;
                }
                free[unit].push(motion);
            }
        }
    }

    /// Units that rows tie together, each group sorted.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut root: Vec<u32> = (0..self.units.len() as u32).collect();
        for row in &self.rows.shared {
            for pair in row.windows(2) {
                unite(&mut root, pair[0].0 as u32, pair[1].0 as u32);
            }
        }
        let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for unit in 0..self.units.len() {
            let group = find(&mut root, unit as u32);
            groups.entry(group).or_default().push(unit);
        }
        groups.into_values().collect()
    }
}

impl Unit {
    fn of_nodes(mesh: &Mesh, centre: Vec3, nodes: &[NodeId]) -> Self {
        let points = nodes.iter().filter_map(|&n| mesh.points.get(n as usize));
        let length = points.map(|&x| (x - centre).norm()).fold(0.0, f64::max);
        Self {
            bodies: BTreeSet::new(),
            carrier: None,
            node: nodes.first().copied(),
            centre,
            length: if length > 0.0 { length } else { 1.0 },
        }
    }
}

/// The deformable cells that hang together, and the unit of each node.
fn parts(
    mesh: &Mesh,
    bodies: &[BodyPart],
    directors: &Directors,
    is_active: &dyn Fn(CellId) -> bool,
) -> (Vec<Unit>, Vec<Option<usize>>) {
    let mut root: Vec<NodeId> = (0..mesh.nnode() as NodeId).collect();
    let mut body_of: BTreeMap<NodeId, BTreeSet<usize>> = BTreeMap::new();
    let deformable = || {
        let bodies = bodies.iter().enumerate();
        bodies.filter(|(_, body)| body.kind.material().is_some())
    };
    for (_, body) in deformable() {
        for &cell in body.cells.iter().filter(|cell| is_active(**cell)) {
            let nodes = mesh.cell(cell);
            for pair in nodes.windows(2) {
                unite(&mut root, pair[0], pair[1]);
            }
            let first = nodes.first().copied().unwrap_or_default();
            for node in directors.behind(nodes) {
                unite(&mut root, first, node);
            }
        }
    }
    let mut in_part = vec![false; mesh.nnode()];
    for (number, body) in deformable() {
        for &cell in body.cells.iter().filter(|cell| is_active(**cell)) {
            let nodes = mesh.cell(cell);
            for node in nodes.iter().copied().chain(directors.behind(nodes)) {
                in_part[node as usize] = true;
            }
            if let Some(&node) = mesh.cell(cell).first() {
                let part = find(&mut root, node);
                body_of.entry(part).or_default().insert(number);
            }
        }
    }
    let mut nodes: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
    for node in (0..mesh.nnode() as NodeId).filter(|&n| in_part[n as usize]) {
        let part = find(&mut root, node);
        nodes.entry(part).or_default().push(node);
    }
    let number: HashMap<NodeId, usize> = nodes.keys().copied().zip(0..).collect();
    let part_of = (0..mesh.nnode() as NodeId)
        .map(|node| number.get(&find(&mut root, node)).copied())
        .collect();
    let units = nodes.iter().map(|(root, nodes)| {
        let sum: Vec3 = nodes.iter().map(|&n| mesh.points[n as usize]).sum();
        let centre = sum / nodes.len() as f64;
        let mut unit = Unit::of_nodes(mesh, centre, nodes);
        unit.bodies = body_of.remove(root).unwrap_or_default();
        unit
    });
    (units.collect(), part_of)
}

fn add(to: &mut [Motion; NCOMPONENT], more: &[Motion; NCOMPONENT]) {
    for (row, more) in to.iter_mut().zip(more) {
        for (value, more) in row.iter_mut().zip(more) {
            *value += more;
        }
    }
}

fn find(root: &mut [u32], mut n: u32) -> u32 {
    while root[n as usize] != n {
        root[n as usize] = root[root[n as usize] as usize];
        n = root[n as usize];
    }
    n
}

fn unite(root: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(root, a), find(root, b));
    root[a.max(b) as usize] = a.min(b);
}
