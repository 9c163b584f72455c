//! Who follows whom: rigid bodies, couplings, equations.
//!
//! Followers are found first, because steps must not prescribe them. Then come the steps, because an equation must not
//! make anything depend that a step prescribes. Then the equations are solved for what may depend.

use super::constraint_error::ConstraintError;
use super::label::label;
use super::reduction::{Column, Reduced, Row, reduce};
use super::satisfied::holds;
use super::{
    BodyKind, BodyPart, CarrierPart, ConstraintKind, ConstraintPart, ContactPart, ModelError,
    PrimaryPart, SpringPart, Unknown,
};
use crate::connector::{
    ConnectorError, Distance, DistanceParts, Distributing, DistributingParts, Line, Plane, Springs,
    SpringsParts, Twist, TwistParts,
};
use crate::solve::{Motion, Step};
use crate::system::{
    Directors, Dof, DofName, Elimination, FieldId, Idealisation, Layout, NO_DOF, Relation,
    RigidBody, Term, Turn,
};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::surface::{Carrier, RigidId};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// What constraints mean for carriers and for numbers of unknowns.
#[derive(Debug, Default)]
pub(super) struct Ties {
    /// Components of carriers that are free unless a step says otherwise.
    pub free: BTreeSet<Dof>,
    /// Whether something follows each carrier.
    pub followed: Vec<bool>,
    /// Whether each carrier has a place that nodes follow, or that follows them; the others are unknowns of equations.
    pub placed: Vec<bool>,
    /// Nodes of rigid bodies.
    pub rigid: BTreeSet<NodeId>,
    /// Nodes that a constraint or spring holds.
    pub nodes: BTreeSet<NodeId>,
    /// Whether a contact has friction.
    pub rubs: bool,
    /// The first multiplier of each constraint.
    first: Vec<usize>,
    /// The dof by which right-hand sides grow, and its value at the end of the first step.
    course: Option<(Dof, f64)>,
}

/// The mesh and the parts that say who follows whom.
#[derive(Clone, Copy)]
pub(super) struct Followers<'a> {
    pub mesh: &'a Mesh,
    pub space: Idealisation,
    pub bodies: &'a [BodyPart],
    pub carriers: &'a [CarrierPart],
    pub constraints: &'a [ConstraintPart],
    pub springs: &'a [SpringPart],
    pub contacts: &'a [ContactPart],
}

impl Followers<'_> {
    /// The unknowns of the model.
    pub fn layout(&self) -> Layout {
        let layout = Layout::new(self.space.ndim(), self.mesh.nnode(), self.carriers.len());
        let numbers = self
            .constraints
            .iter()
            .map(|c| self.nmultiplier(&layout, c));
        let course = usize::from(self.largest_rhs() > 0.0);
        layout.with_multipliers(numbers.sum::<usize>() + course)
    }

    fn nmultiplier(&self, layout: &Layout, constraint: &ConstraintPart) -> usize {
        match &constraint.kind {
            ConstraintKind::Plane { nodes } => Plane::nmultiplier(layout, distinct(nodes).len()),
            ConstraintKind::Line { nodes } => Line::nmultiplier(layout, distinct(nodes).len()),
            ConstraintKind::Distance { .. } | ConstraintKind::Twist { .. } => 1,
            ConstraintKind::Distributing { .. } => Distributing::nmultiplier(self.space),
            _ => 0,
        }
    }

    fn largest_rhs(&self) -> f64 {
        self.constraints.iter().fold(0.0, |m, c| match c.kind {
            ConstraintKind::Equation { rhs, .. } => rhs.abs().max(m),
            _ => m,
        })
    }

    /// The carriers with what follows them as rigid bodies do, and what else is tied.
    pub fn elimination(
        &self,
        layout: &Layout,
        directors: Directors,
    ) -> Result<(Elimination, Ties), ModelError> {
        let mut nodes = self.rigid_nodes()?;
        let on_rigid = nodes.iter().flatten().copied().collect();
        let mut rigid: Vec<bool> = nodes.iter().map(|n| !n.is_empty()).collect();
        // rigid surfaces are bodies without nodes
        for contact in self.contacts {
            if let PrimaryPart::Surface(surface) = &contact.primary
                && let Carrier::Rigid(carrier) = surface.carrier(0)
                && let Some(rigid) = rigid.get_mut(carrier as usize)
            {
                *rigid = true;
            }
        }
        let references = self.references(&nodes);
        let whole = |axes: &[bool; 3]| axes[..layout.ndim()].iter().all(|a| *a);
        // whole nodes first, single directions afterwards
        for constraint in self.constraints {
            if let ConstraintKind::Kinematic {
                nodes: on,
                carrier,
                axes,
            } = &constraint.kind
                && whole(axes)
                && let Some(of) = nodes.get_mut(*carrier as usize)
            {
                of.extend(on);
            }
        }
        let bodies = references
            .iter()
            .zip(nodes)
            .map(|(&reference, nodes)| RigidBody {
                reference,
                nodes: nodes.into_iter().collect(),
            });
        let mut elimination = Elimination::new(bodies.collect(), layout.nnode());
        elimination.take_directors(directors);
        let mut ties = self.ties(layout, &rigid);
        ties.rigid = on_rigid;
        for constraint in self.constraints {
            match &constraint.kind {
                ConstraintKind::Kinematic {
                    nodes,
                    carrier,
                    axes,
                } => {
                    if !whole(axes) {
                        let points = &self.mesh.points;
                        elimination.couple(layout, points, nodes, *axes, *carrier);
                    }
                    elimination.pull(*carrier);
                    let mut free = self.moved(layout, &references, nodes, *axes, *carrier);
                    free.retain(|_| !rigid.get(*carrier as usize).is_some_and(|r| *r));
                    ties.free.extend(free);
                }
                ConstraintKind::KinematicAlong { nodes, carrier } => {
                    elimination.guide(&self.mesh.points, nodes.iter().map(|n| n.0), *carrier);
                    elimination.pull(*carrier);
                    if !rigid.get(*carrier as usize).is_some_and(|r| *r) {
                        ties.free
                            .extend(self.moved_along(layout, &references, nodes, *carrier));
                    }
                }
                ConstraintKind::Directors { halves, carrier } => {
                    let to = (&mut elimination, &mut ties);
                    self.turn_directors((halves, *carrier), layout, to);
                }
                ConstraintKind::Distributing { carrier, .. }
                | ConstraintKind::Twist { carrier, .. } => elimination.pull(*carrier),
                _ => {}
            }
        }
        self.check_leaders(layout, &elimination)?;
        for constraint in self.constraints {
            if let ConstraintKind::Equation { terms, .. } = &constraint.kind {
                for &(unknown, _) in terms {
                    ties.free.extend(free_by(unknown, &elimination, layout));
                }
            }
        }
        if self.space == Idealisation::Axisymmetric {
            let placed = |carrier: RigidId| ties.placed.get(carrier as usize) == Some(&true);
            let mut free = std::mem::take(&mut ties.free);
            free.retain(|dof| {
                let name = layout.name(*dof).and_then(DofName::translation);
                name.is_some_and(|(carrier, axis)| axis == 1 || !placed(carrier))
            });
            ties.free = free;
        }
        Ok((elimination, ties))
    }

    /// Lets halves of directors turn with a carrier and stretch.
    fn turn_directors(
        &self,
        (halves, carrier): (&[(NodeId, RigidId)], RigidId),
        layout: &Layout,
        (elimination, ties): (&mut Elimination, &mut Ties),
    ) {
        elimination.guide(&self.mesh.points, halves.iter().map(|h| h.0), carrier);
        elimination.pull(carrier);
        for &(half, stretch) in halves {
            elimination.pull(stretch);
            elimination.stretch(carrier, half, layout.translation(stretch, 0));
            ties.free.insert(layout.translation(stretch, 0));
        }
        ties.free
            .extend((0..3).map(|axis| layout.rotation(carrier, axis)));
    }

    /// Nodes of the rigid bodies of each carrier.
    fn rigid_nodes(&self) -> Result<Vec<BTreeSet<NodeId>>, ModelError> {
        let mut nodes: Vec<BTreeSet<NodeId>> = vec![BTreeSet::new(); self.carriers.len()];
        let mut taken: HashMap<NodeId, (usize, &str)> = HashMap::new();
        for body in self.bodies {
            let BodyKind::Rigid { carrier, .. } = body.kind else {
                continue;
            };
            let carrier = carrier as usize;
            for &node in body.cells.iter().flat_map(|&c| self.mesh.cell(c)) {
                let (first, name) = *taken.entry(node).or_insert((carrier, &body.name));
                if first != carrier {
                    return Err(ModelError::RigidBodiesShare {
                        first: name.to_string(),
                        second: body.name.clone(),
                        node: label(self.mesh, node),
                    });
                }
                if let Some(of) = nodes.get_mut(carrier) {
                    of.insert(node);
                }
            }
        }
        Ok(nodes)
    }

    /// Where the carriers are at the start.
    fn references(&self, nodes: &[BTreeSet<NodeId>]) -> Vec<Vec3> {
        let mean = |nodes: &BTreeSet<NodeId>| {
            let points = nodes
                .iter()
                .filter_map(|&n| self.mesh.points.get(n as usize));
            points.copied().sum::<Vec3>() / nodes.len().max(1) as f64
        };
        let placed = self.carriers.iter().zip(nodes);
        let placed = placed.map(|(part, nodes)| part.at.is_some() || !nodes.is_empty());
        let followers = self.followers(&placed.collect::<Vec<_>>());
        let place = |((part, nodes), followers): ((&CarrierPart, _), &BTreeSet<NodeId>)| {
            let nodes: &BTreeSet<NodeId> = nodes;
            part.at.unwrap_or_else(|| match nodes.is_empty() {
                true => mean(followers),
                false => mean(nodes),
            })
        };
        let parts = self.carriers.iter().zip(nodes);
        parts.zip(&followers).map(place).collect()
    }

    /// The nodes that follow carriers by couplings, or that these follow; of those without a place alone.
    fn followers(&self, placed: &[bool]) -> Vec<BTreeSet<NodeId>> {
        let mut all = vec![BTreeSet::new(); placed.len()];
        for constraint in self.constraints {
            let (ConstraintKind::Kinematic { carrier, .. }
            | ConstraintKind::KinematicAlong { carrier, .. }
            | ConstraintKind::Distributing { carrier, .. }) = &constraint.kind
            else {
                continue;
            };
            let number = *carrier as usize;
            if let (Some(false), Some(nodes)) = (placed.get(number), all.get_mut(number)) {
                nodes.extend(constraint.kind.nodes());
            }
        }
        all
    }

    fn ties(&self, layout: &Layout, rigid: &[bool]) -> Ties {
        let mut ties = Ties {
            followed: rigid.to_vec(),
            placed: rigid.to_vec(),
            rubs: self
                .contacts
                .iter()
                .any(|contact| contact.friction.is_some()),
            ..Ties::default()
        };
        let mut next = 0;
        for constraint in self.constraints {
            ties.first.push(next);
            next += self.nmultiplier(layout, constraint);
            let mark = |flags: &mut Vec<bool>, carrier: RigidId| {
                if let Some(flag) = flags.get_mut(carrier as usize) {
                    *flag = true;
                }
            };
            match &constraint.kind {
                ConstraintKind::Kinematic { nodes, carrier, .. } => {
                    mark(&mut ties.followed, *carrier);
                    mark(&mut ties.placed, *carrier);
                    ties.nodes.extend(nodes);
                }
                ConstraintKind::KinematicAlong { nodes, carrier } => {
                    mark(&mut ties.followed, *carrier);
                    mark(&mut ties.placed, *carrier);
                    ties.nodes.extend(nodes.iter().map(|n| n.0));
                }
                ConstraintKind::Directors { halves, carrier } => {
                    mark(&mut ties.followed, *carrier);
                    mark(&mut ties.placed, *carrier);
                    for &(half, stretch) in halves {
                        mark(&mut ties.followed, stretch);
                        ties.nodes.insert(half);
                    }
                }
                ConstraintKind::Distributing { nodes, carrier } => {
                    mark(&mut ties.followed, *carrier);
                    mark(&mut ties.placed, *carrier);
                    ties.nodes.extend(nodes.iter().map(|n| n.0));
                    if !rigid.get(*carrier as usize).is_some_and(|r| *r) {
                        ties.free.extend(components(layout, *carrier));
                    }
                }
                ConstraintKind::Equation { terms, .. } => {
                    for (unknown, _) in terms {
                        match *unknown {
                            Unknown::Node(node, _) => drop(ties.nodes.insert(node)),
                            Unknown::Carrier(carrier, _) => mark(&mut ties.followed, carrier),
                        }
                    }
                }
                ConstraintKind::Twist { nodes, carrier, .. } => {
                    mark(&mut ties.followed, *carrier);
                    ties.nodes.extend(nodes);
                    ties.free.insert(layout.translation(*carrier, 0));
                }
                ConstraintKind::Equal { nodes, .. }
                | ConstraintKind::Plane { nodes }
                | ConstraintKind::Line { nodes } => {
                    ties.nodes.extend(nodes);
                }
                ConstraintKind::Distance { nodes, .. } => ties.nodes.extend(nodes),
            }
        }
        for &(a, b) in self.springs.iter().flat_map(|s| &s.ends) {
            ties.nodes.insert(a);
            ties.nodes.extend(b);
        }
        let rhs = self.largest_rhs();
        ties.course = (rhs > 0.0).then(|| (layout.multiplier(next), rhs));
        ties
    }

    /// The components of a carrier by which a coupling moves its nodes: others are nobody's unknowns.
    fn moved(
        &self,
        layout: &Layout,
        references: &[Vec3],
        nodes: &[NodeId],
        axes: [bool; 3],
        carrier: RigidId,
    ) -> Vec<Dof> {
        let at = references
            .get(carrier as usize)
            .copied()
            .unwrap_or_default();
        let arms = || {
            let points = nodes
                .iter()
                .filter_map(|&n| self.mesh.points.get(n as usize));
            points.map(|&x| x - at)
        };
        let extent = arms().fold(0.0, |m: f64, a| m.max(a.max_abs()));
        let along = (0..3)
            .filter(|&c| axes[c])
            .map(|c| layout.translation(carrier, c));
        let turns = |about: usize| {
            let moves = |a: Vec3| {
                let row = Mat3::skew(a).rows.map(|row| row[about].abs());
                (0..layout.ndim()).any(|c| axes[c] && row[c] > STILL * extent)
            };
            arms().any(moves)
        };
        let about = (0..3)
            .filter(|&c| turns(c))
            .map(|c| layout.rotation(carrier, c));
        along.chain(about).filter(|&d| d != NO_DOF).collect()
    }

    /// The components of a carrier that move a node along its direction.
    fn moved_along(
        &self,
        layout: &Layout,
        references: &[Vec3],
        nodes: &[(NodeId, Vec3)],
        carrier: RigidId,
    ) -> Vec<Dof> {
        let at = references.get(carrier as usize).copied();
        let at = at.unwrap_or_default();
        let arms = || {
            let arm = |&(node, along): &(NodeId, Vec3)| {
                Some((*self.mesh.points.get(node as usize)? - at, along))
            };
            nodes.iter().filter_map(arm)
        };
        let extent = arms().fold(0.0, |m: f64, (a, _)| m.max(a.max_abs()));
        let moves = |axis: usize| arms().any(|(_, along)| along[axis].abs() > STILL);
        // along · (θ × a) = θ · (a × along)
        let turns = |about: usize| arms().any(|(a, d)| a.cross(d)[about].abs() > STILL * extent);
        let along = (0..3)
            .filter(|&c| moves(c))
            .map(|c| layout.translation(carrier, c));
        let about = (0..3)
            .filter(|&c| turns(c))
            .map(|c| layout.rotation(carrier, c));
        along.chain(about).filter(|&d| d != NO_DOF).collect()
    }

    /// Nodes of couplings follow the carrier that their coupling names.
    fn check_leaders(&self, layout: &Layout, elimination: &Elimination) -> Result<(), ModelError> {
        for constraint in self.constraints {
            let ConstraintKind::Kinematic {
                nodes,
                carrier,
                axes,
            } = &constraint.kind
            else {
                continue;
            };
            for &node in nodes {
                for axis in (0..layout.ndim()).filter(|&c| axes[c]) {
                    let leader = elimination.leader(layout.node(node, axis), layout);
                    if let Some(turn) = leader.filter(|t| t.carrier != *carrier) {
                        return Err(ConstraintError::TwoLeaders {
                            constraint: constraint.name.clone(),
                            node: label(self.mesh, node),
                            carrier: self.carrier_name(turn.carrier),
                        }
                        .into());
                    }
                }
            }
        }
        Ok(())
    }

    fn carrier_name(&self, carrier: RigidId) -> String {
        let part = self.carriers.get(carrier as usize);
        part.map(|c| c.name.clone()).unwrap_or_default()
    }

    /// Solves the equations for what no step prescribes, and lets steps bring the right-hand sides.
    pub fn relate(
        &self,
        layout: &Layout,
        ties: &Ties,
        elimination: &mut Elimination,
        steps: &mut [Step],
    ) -> Result<(), ModelError> {
        if let Some((dof, to)) = ties.course {
            for (number, step) in steps.iter_mut().enumerate() {
                let motion = if number == 0 {
                    Motion::Ramp(to)
                } else {
                    Motion::Hold
                };
                step.prescriptions
                    .push(crate::solve::Prescription { dof, motion });
            }
        }
        let motions: Vec<BTreeMap<Dof, &Motion>> = steps
            .iter()
            .map(|s| s.prescriptions.iter().map(|p| (p.dof, &p.motion)).collect())
            .collect();
        let rows = self.rows(layout, ties, elimination, &motions);
        let prescribed: BTreeSet<Dof> = motions.iter().flat_map(|m| m.keys().copied()).collect();
        let rank = |dof: Dof| match layout.name(dof).map(|name| name.field) {
            _ if prescribed.contains(&dof) => None,
            Some(FieldId::DISPLACEMENT) => Some(0),
            Some(FieldId::TRANSLATION) => Some(1),
            Some(FieldId::ROTATION) => Some(2),
            _ => None,
        };
        let Reduced { solved, left } = reduce(rows, rank);
        let name = |owner: usize| {
            let part = self.constraints.get(owner);
            part.map(|c| c.name.clone()).unwrap_or_default()
        };
        let course = ties.course.map(|c| Column::Dof(c.0));
        for row in left {
            let durations = steps.iter().map(|s| s.duration);
            if holds(&row, &motions, durations) {
                continue;
            }
            let constraint = name(row.owner);
            let what = row.terms.keys().find(|c| Some(**c) != course);
            return Err(match what {
                None => ConstraintError::Contradictory { constraint },
                Some(column) => ConstraintError::OverConstrained {
                    constraint,
                    what: self.column_name(layout, *column),
                },
            }
            .into());
        }
        let mut relations: Vec<Relation> = Vec::new();
        for (dof, row) in &solved {
            let relation = row.relation(*dof);
            let turned = layout.name(*dof).and_then(DofName::rotation);
            if let (Some((carrier, _)), false) = (turned, relation.turns.is_empty()) {
                return Err(ConstraintError::Turning {
                    constraint: name(row.owner),
                    carrier: self.carrier_name(carrier),
                }
                .into());
            }
            relations.push(relation);
        }
        elimination.relate(layout, relations, ties.course.map(|c| c.0));
        elimination.follow_directors(layout);
        Ok(())
    }

    /// The equations, in terms of what follows no carrier, and of turns.
    fn rows(
        &self,
        layout: &Layout,
        ties: &Ties,
        elimination: &Elimination,
        motions: &[BTreeMap<Dof, &Motion>],
    ) -> Vec<Row> {
        let still = |carrier: RigidId| {
            let rotations = (0..3).map(|c| layout.rotation(carrier, c));
            let held = |dof: Dof| motions.iter().all(|m| m.get(&dof) == Some(&&Motion::Hold));
            rotations.filter(|&d| d != NO_DOF).all(held)
        };
        let add = |row: &mut Row, dof: Dof, coefficient: f64| {
            if dof == NO_DOF {
                return;
            }
            match elimination.leader(dof, layout) {
                None => row.add(Column::Dof(dof), coefficient),
                Some(turn) => {
                    let translation = layout.translation(turn.carrier, turn.axis);
                    row.add(Column::Dof(translation), coefficient);
                    if !still(turn.carrier) {
                        row.add(Column::Turn(turn), coefficient);
                    }
                }
            }
        };
        let mut rows = Vec::new();
        for (owner, constraint) in self.constraints.iter().enumerate() {
            let new = || Row {
                owner,
                ..Row::default()
            };
            match &constraint.kind {
                ConstraintKind::Equation { terms, rhs } => {
                    let largest = terms.iter().fold(0.0f64, |m, t| t.1.abs().max(m));
                    let scale = if largest > 0.0 { largest } else { 1.0 };
                    let mut row = new();
                    for &(unknown, coefficient) in terms {
                        add(&mut row, dof_of(unknown, layout), coefficient / scale);
                    }
                    if let Some((course, to)) = ties.course.filter(|_| *rhs != 0.0) {
                        row.add(Column::Dof(course), -rhs / (to * scale));
                    }
                    rows.push(row);
                }
                ConstraintKind::KinematicAlong { nodes, carrier } => {
                    for &(node, along) in nodes {
                        let mut row = new();
                        for axis in (0..layout.ndim()).filter(|&axis| along[axis] != 0.0) {
                            add(&mut row, layout.node(node, axis), along[axis]);
                            let translation = layout.translation(*carrier, axis);
                            row.add(Column::Dof(translation), -along[axis]);
                            if !still(*carrier) {
                                let turn = Turn {
                                    node,
                                    axis,
                                    carrier: *carrier,
                                };
                                row.add(Column::Turn(turn), -along[axis]);
                            }
                        }
                        rows.push(row);
                    }
                }
                ConstraintKind::Directors { halves, carrier } => {
                    for &(node, _) in halves {
                        for axis in 0..layout.ndim() {
                            let mut row = new();
                            add(&mut row, layout.node(node, axis), 1.0);
                            let turn = Turn {
                                node,
                                axis,
                                carrier: *carrier,
                            };
                            row.add(Column::Turn(turn), -1.0);
                            rows.push(row);
                        }
                    }
                }
                ConstraintKind::Equal { nodes, axes } => {
                    let nodes = distinct(nodes);
                    for axis in (0..layout.ndim()).filter(|&c| axes[c]) {
                        for pair in nodes.iter().skip(1).zip(nodes.iter().take(1).cycle()) {
                            let mut row = new();
                            add(&mut row, layout.node(*pair.0, axis), 1.0);
                            add(&mut row, layout.node(*pair.1, axis), -1.0);
                            rows.push(row);
                        }
                    }
                }
                _ => {}
            }
        }
        rows
    }

    fn column_name(&self, layout: &Layout, column: Column) -> String {
        let axis = |k: usize| ["x", "y", "z"].get(k).copied().unwrap_or("?");
        let dof = match column {
            Column::Turn(turn) => {
                return format!("the rotation of \"{}\"", self.carrier_name(turn.carrier));
            }
            Column::Dof(dof) => dof,
        };
        match layout.name(dof).map(DofName::parts) {
            Some((FieldId::DISPLACEMENT, node, k)) => {
                format!(
                    "displacement {} of node {}",
                    axis(k),
                    label(self.mesh, node)
                )
            }
            Some((FieldId::TRANSLATION, c, k)) => {
                format!("displacement {} of \"{}\"", axis(k), self.carrier_name(c))
            }
            Some((FieldId::ROTATION, c, k)) => {
                format!("rotation {} of \"{}\"", axis(k), self.carrier_name(c))
            }
            _ => "a right-hand side".to_owned(),
        }
    }

    /// Springs and couplings by multipliers, as terms.
    pub fn connectors(
        &self,
        layout: &Layout,
        ties: &Ties,
        elimination: &Elimination,
        reference: &Arc<[Vec3]>,
    ) -> Result<Vec<Box<dyn Term>>, ModelError> {
        let mut terms: Vec<Box<dyn Term>> = Vec::new();
        for spring in self.springs {
            let springs = Springs::new(SpringsParts {
                name: &spring.name,
                ends: &spring.ends,
                law: &spring.law,
                direction: spring.direction,
                reference,
                layout: *layout,
            });
            let spring = spring.name.clone();
            let failed = |source| ConstraintError::Spring { spring, source };
            terms.push(Box::new(springs.map_err(failed)?));
        }
        for (constraint, &first) in self.constraints.iter().zip(&ties.first) {
            let name = &constraint.name;
            let failed = |source| self.no_connector(name, source);
            match &constraint.kind {
                ConstraintKind::Line { nodes } => {
                    let nodes = distinct(nodes);
                    let line = Line::new(name, &nodes, reference.clone(), *layout, first);
                    terms.push(Box::new(line.map_err(failed)?));
                }
                ConstraintKind::Distance { nodes, most } => {
                    let rod = Distance::new(&DistanceParts {
                        name,
                        nodes: *nodes,
                        most: *most,
                        stiffness: self.stiffness(*nodes),
                        reference,
                        layout: *layout,
                        first,
                    });
                    terms.push(Box::new(rod.map_err(failed)?));
                }
                ConstraintKind::Twist {
                    nodes,
                    axis,
                    carrier,
                } => {
                    let twist = Twist::new(&TwistParts {
                        name,
                        nodes: &distinct(nodes),
                        axis: *axis,
                        angle: layout.translation(*carrier, 0),
                        reference,
                        layout: *layout,
                        first,
                    });
                    terms.push(Box::new(twist.map_err(failed)?));
                }
                ConstraintKind::Plane { nodes } => {
                    let nodes = distinct(nodes);
                    let plane = Plane::new(name, &nodes, reference.clone(), *layout, first);
                    terms.push(Box::new(plane.map_err(failed)?));
                }
                ConstraintKind::Distributing { nodes, carrier } => {
                    let body = elimination.bodies().get(*carrier as usize);
                    let coupling = Distributing::new(DistributingParts {
                        name,
                        nodes,
                        carrier: *carrier,
                        at: body.map(|b| b.reference).unwrap_or_default(),
                        reference,
                        layout: *layout,
                        space: self.space,
                        first,
                    });
                    terms.push(Box::new(coupling.map_err(failed)?));
                }
                _ => {}
            }
        }
        Ok(terms)
    }

    /// Why a constraint cannot be made, with the node as the input numbers it.
    fn no_connector(&self, constraint: &str, source: ConnectorError) -> ConstraintError {
        let constraint = constraint.to_owned();
        match source {
            ConnectorError::Uneven {
                node,
                what,
                distance,
            } => ConstraintError::Uneven {
                constraint,
                node: label(self.mesh, node),
                what,
                distance: distance.abs(),
            },
            source => ConstraintError::Connector { constraint, source },
        }
    }

    /// The largest modulus times the distance of two nodes: how stiff the model may be between them.
    fn stiffness(&self, nodes: [NodeId; 2]) -> f64 {
        let at = |node: NodeId| self.mesh.points.get(node as usize).copied();
        let [one, other] = nodes.map(|node| at(node).unwrap_or_default());
        let materials = self.bodies.iter().filter_map(|body| body.kind.material());
        let modulus = materials.map(|m| m.modulus()).fold(0.0, f64::max);
        let stiffness = modulus * (other - one).norm();
        if stiffness > 0.0 { stiffness } else { 1.0 }
    }
}

/// Part of a coupling's extent below which an arm turns nothing.
const STILL: f64 = 1e-9;
/// The nodes without repetitions, in their order.
fn distinct(nodes: &[NodeId]) -> Vec<NodeId> {
    let mut seen = BTreeSet::new();
    nodes.iter().copied().filter(|n| seen.insert(*n)).collect()
}

/// All components of a carrier.
pub(super) fn components(layout: &Layout, carrier: RigidId) -> impl Iterator<Item = Dof> + use<> {
    let dofs = layout.of_carrier(carrier).into_iter();
    dofs.filter(|&d| d != NO_DOF)
}

fn dof_of(unknown: Unknown, layout: &Layout) -> Dof {
    match unknown {
        Unknown::Node(node, axis) => layout.node(node, axis),
        Unknown::Carrier(carrier, k) => layout.carrier_motion(carrier, k),
    }
}

/// The component of a carrier that an equation frees by speaking of it.
fn free_by(unknown: Unknown, elimination: &Elimination, layout: &Layout) -> Option<Dof> {
    let dof = dof_of(unknown, layout);
    let of = match (unknown, elimination.leader(dof, layout)) {
        (Unknown::Carrier(..), _) => dof,
        (_, Some(turn)) => layout.translation(turn.carrier, turn.axis),
        (_, None) => NO_DOF,
    };
    (of != NO_DOF).then_some(of)
}

#[cfg(test)]
mod tests;
