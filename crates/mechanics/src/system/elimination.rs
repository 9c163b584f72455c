//! Unknowns that follow others: rigid bodies and couplings (E1), equations (E3).

use super::director::Directors;
use super::{Dof, Layout, NO_DOF, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Pose, RigidId};
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_linear::sparsity::NONE;

/// What nodes move with: a reference point, and the nodes that follow it in all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Reference point at the start: forces and moments of the body are about it.
    pub reference: Vec3,
    /// Its nodes.
    pub nodes: Vec<NodeId>,
}

/// A displacement of a node that follows a carrier, without the translation: `(R a_0 − a_0)` along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Turn {
    /// The node.
    pub node: NodeId,
    /// The direction.
    pub axis: usize,
    /// What it follows.
    pub carrier: RigidId,
}

/// A raw dof that is a combination of others (E3). What stands on the right depends on nothing itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Relation {
    /// The dependent dof.
    pub dof: Dof,
    /// Dofs with their coefficients.
    pub terms: Vec<(Dof, f64)>,
    /// What turning carriers contribute; none where `dof` is a rotation.
    pub turns: Vec<(Turn, f64)>,
}

/// Which unknowns follow which.
#[derive(Clone, Debug, Default)]
pub struct Elimination {
    bodies: Vec<RigidBody>,
    /// Whether a carrier moves nodes of deformable bodies.
    pulls: Vec<bool>,
    /// What each node follows along each axis, or `NONE`; empty where nothing follows a carrier.
    leader: Vec<[RigidId; 3]>,
    /// Single directions that follow a carrier, besides the nodes of `bodies`, with their arms at the start; sorted.
    coupled: Vec<(Turn, Vec3)>,
    /// Nodes in relations that turn with a carrier and do not follow it along any axis, with their arms at the start;
    /// sorted.
    guided: Vec<((RigidId, NodeId), Vec3)>,
    /// Those of them whose arms stretch, `R (a_0 + s a_0/|a_0|) − a_0`, with the dof of `s`; sorted.
    stretching: Vec<((RigidId, NodeId), Dof)>,
    /// Relation of each raw dof, or `NONE`; empty where there is none.
    relation_of: Vec<u32>,
    relations: Vec<Relation>,
    /// The unknown by which right-hand sides grow.
    course: Option<Dof>,
    /// The directors of thin bodies.
    pub(super) directors: Directors,
}

/// A local contribution after its dependent unknowns have been replaced.
#[derive(Debug, Default)]
pub(super) struct Expanded {
    pub dofs: Vec<Dof>,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// Transformation, one row for each local dof: `terms[start[i]..start[i + 1]]`, place in `dofs` and coefficient.
    start: Vec<usize>,
    terms: Vec<(usize, f64)>,
    /// Turns with the forces on them.
    turns: Vec<(Turn, f64)>,
    /// Place of each raw dof in `dofs`, or `NONE`.
    place: Vec<u32>,
}

impl Expanded {
    fn clear(&mut self, ndof: usize) {
        for &dof in &self.dofs {
            self.place[dof as usize] = NONE;
        }
        self.place.resize(ndof, NONE);
        self.dofs.clear();
        self.start.clear();
        self.start.push(0);
        self.terms.clear();
        self.turns.clear();
        self.force.clear();
        self.stiffness.clear();
    }

    /// The place of a dof, appended where it is not yet there.
    fn place(&mut self, dof: Dof) -> usize {
        let place = &mut self.place[dof as usize];
        if *place == NONE {
            *place = self.dofs.len() as u32;
            self.dofs.push(dof);
        }
        *place as usize
    }
}

/// Takes the terms of a dependent dof.
trait Resolve {
    fn term(&mut self, dof: Dof, coefficient: f64);
    fn turn(&mut self, turn: Turn, coefficient: f64);
}

impl<F: FnMut(Dof, f64)> Resolve for F {
    fn term(&mut self, dof: Dof, coefficient: f64) {
        self(dof, coefficient);
    }

    fn turn(&mut self, _: Turn, _: f64) {}
}

/// Writes the row of a local dof.
struct Row<'a> {
    out: &'a mut Expanded,
    force: f64,
}

impl Resolve for Row<'_> {
    fn term(&mut self, dof: Dof, coefficient: f64) {
        let place = self.out.place(dof);
        self.out.terms.push((place, coefficient));
    }

    fn turn(&mut self, turn: Turn, coefficient: f64) {
        self.out.turns.push((turn, coefficient * self.force));
    }
}

impl Elimination {
    /// The elimination for these bodies in a mesh of `nnode` nodes.
    #[must_use]
    pub fn new(bodies: Vec<RigidBody>, nnode: usize) -> Self {
        let mut leader = Vec::new();
        if bodies.iter().any(|b| !b.nodes.is_empty()) {
            leader.resize(nnode, [NONE; 3]);
            for (id, body) in bodies.iter().enumerate() {
                for &node in &body.nodes {
                    if let Some(of) = leader.get_mut(node as usize) {
                        *of = [id as RigidId; 3];
                    }
                }
            }
        }
        Self {
            pulls: vec![false; bodies.len()],
            bodies,
            leader,
            ..Self::default()
        }
    }

    /// Lets nodes follow a carrier along some axes only. Directions that follow one already keep it.
    pub fn couple(
        &mut self,
        layout: &Layout,
        reference: &[Vec3],
        nodes: &[NodeId],
        axes: [bool; 3],
        carrier: RigidId,
    ) {
        self.leader.resize(layout.nnode(), [NONE; 3]);
        let Some(body) = self.bodies.get(carrier as usize) else {
            return;
        };
        for &node in nodes {
            let leader = self.leader.get_mut(node as usize);
            let (Some(leader), Some(&start)) = (leader, reference.get(node as usize)) else {
                continue;
            };
            for axis in (0..layout.ndim()).filter(|&axis| axes[axis]) {
                if leader[axis] == NONE {
                    leader[axis] = carrier;
                    let turn = Turn {
                        node,
                        axis,
                        carrier,
                    };
                    self.coupled.push((turn, start - body.reference));
                }
            }
        }
        self.coupled.sort_unstable_by_key(|c| c.0);
    }

    /// Takes the arms of nodes whose relations have turns of a carrier that they do not follow.
    pub fn guide(
        &mut self,
        reference: &[Vec3],
        nodes: impl Iterator<Item = NodeId>,
        carrier: RigidId,
    ) {
        let Some(body) = self.bodies.get(carrier as usize) else {
            return;
        };
        let arm = |node: NodeId| {
            let start = reference.get(node as usize)?;
            Some(((carrier, node), *start - body.reference))
        };
        self.guided.extend(nodes.filter_map(arm));
        self.guided.sort_unstable_by_key(|one| one.0);
        self.guided.dedup_by_key(|one| one.0);
    }

    /// Lets the arm of a guided node stretch by a dof (length).
    pub fn stretch(&mut self, carrier: RigidId, node: NodeId, by: Dof) {
        let of = (carrier, node);
        let at = self.stretching.partition_point(|one| one.0 < of);
        self.stretching.insert(at, (of, by));
    }

    /// The dof by which the arm of a node stretches.
    fn stretching(&self, carrier: RigidId, node: NodeId) -> Option<Dof> {
        let of = (carrier, node);
        let at = self
            .stretching
            .binary_search_by_key(&of, |one| one.0)
            .ok()?;
        self.stretching.get(at).map(|one| one.1)
    }

    /// An arm at the start with what it has been stretched by, and its direction at the start with the dof of the stretch.
    fn stretched(&self, start: Vec3, turn: Turn, state: &State) -> (Vec3, Option<(Vec3, Dof)>) {
        let by = self.stretching(turn.carrier, turn.node);
        let along = by.and_then(|by| Some((start.normalized()?, by)));
        let Some((unit, by)) = along else {
            return (start, None);
        };
        (start + unit * at(&state.u, by), Some((unit, by)))
    }

    /// Says that a carrier moves nodes of deformable bodies: its prescribed motion is felt by elements.
    pub fn pull(&mut self, carrier: RigidId) {
        if let Some(pulls) = self.pulls.get_mut(carrier as usize) {
            *pulls = true;
        }
    }

    /// Makes dofs depend on others. Right-hand sides are multiples of a prescribed dof, their `course`: its motion goes
    /// the way of every prescribed motion, but it is no unknown whose forces say how large forces are.
    pub fn relate(&mut self, layout: &Layout, relations: Vec<Relation>, course: Option<Dof>) {
        self.course = course;
        self.relation_of.clear();
        if !relations.is_empty() {
            self.relation_of.resize(layout.ndof(), NONE);
        }
        for (number, relation) in relations.iter().enumerate() {
            if let Some(of) = self.relation_of.get_mut(relation.dof as usize) {
                *of = number as u32;
            }
            let carriers = relation.terms.iter().filter_map(|t| layout.carrier(t.0));
            let turning = relation.turns.iter().map(|t| t.0.carrier);
            for carrier in carriers.chain(turning).chain(layout.carrier(relation.dof)) {
                if let Some(pulls) = self.pulls.get_mut(carrier as usize) {
                    *pulls = true;
                }
            }
        }
        self.relations = relations;
    }

    /// Adds relations to those there are.
    pub(super) fn relate_more(&mut self, layout: &Layout, mut more: Vec<Relation>) {
        let mut relations = std::mem::take(&mut self.relations);
        relations.append(&mut more);
        self.relate(layout, relations, self.course);
    }

    /// Adds what a dof follows to a relation, the dof itself where it follows nothing.
    pub(super) fn add_terms(&self, dof: Dof, weight: f64, layout: &Layout, to: &mut Relation) {
        let mut of = dof;
        if let Some(turn) = self.leader(dof, layout) {
            of = layout.translation(turn.carrier, turn.axis);
            to.turns.push((turn, weight));
        }
        self.linear(of, weight, &mut |d: Dof, c: f64| to.terms.push((d, c)));
        if let Some(relation) = self.relation(of) {
            let turns = relation.turns.iter();
            to.turns.extend(turns.map(|&(turn, c)| (turn, weight * c)));
        }
    }

    /// The dof by which right-hand sides grow.
    #[must_use]
    pub const fn course(&self) -> Option<Dof> {
        self.course
    }

    /// What nodes move with.
    #[must_use]
    pub fn bodies(&self) -> &[RigidBody] {
        &self.bodies
    }

    /// Where they are at the start.
    #[must_use]
    pub fn initial_poses(&self) -> Vec<Pose> {
        let pose = |body: &RigidBody| Pose {
            origin: body.reference,
            rotation: Mat3::IDENTITY,
        };
        self.bodies.iter().map(pose).collect()
    }

    /// The carrier that a node follows in all directions.
    #[inline]
    #[must_use]
    pub fn body_of(&self, node: NodeId) -> Option<RigidId> {
        let leader = self.leader.get(node as usize)?;
        let whole = leader[0] != NONE && leader[0] == leader[1] && leader[0] == leader[2];
        whole.then_some(leader[0])
    }

    /// What a displacement follows as a rigid body does.
    #[inline]
    #[must_use]
    pub fn leader(&self, dof: Dof, layout: &Layout) -> Option<Turn> {
        if self.leader.is_empty() || dof == NO_DOF {
            return None;
        }
        let (node, axis) = (dof / layout.ndim() as u32, dof as usize % layout.ndim());
        let carrier = self.leader.get(node as usize)?[axis];
        (carrier != NONE).then_some(Turn {
            node,
            axis,
            carrier,
        })
    }

    /// The relation that gives a dof.
    #[inline]
    fn relation(&self, dof: Dof) -> Option<&Relation> {
        let number = *self.relation_of.get(dof as usize)?;
        self.relations.get(number as usize)
    }

    /// Whether a raw dof follows others.
    #[inline]
    #[must_use]
    pub fn depends(&self, dof: Dof, layout: &Layout) -> bool {
        if self.leader.is_empty() && self.relation_of.is_empty() {
            return false;
        }
        self.leader(dof, layout).is_some() || self.relation(dof).is_some()
    }

    /// Whether elements feel it at once when a dof is moved: all but the motion of rigid bodies.
    #[must_use]
    pub fn is_felt(&self, dof: Dof, layout: &Layout) -> bool {
        layout
            .carrier(dof)
            .is_none_or(|c| self.pulls.get(c as usize).copied().unwrap_or(false))
    }

    /// The dofs that a dof is a combination of, with their coefficients: itself where it depends on nothing. What turning
    /// carriers contribute is not among them.
    pub fn combination(&self, dof: Dof, out: &mut impl FnMut(Dof, f64)) {
        self.linear(dof, 1.0, out);
    }

    /// The increment of a dof that follows no carrier, or its value, where `du` has the values of all.
    pub(super) fn increment(&self, dof: Dof, du: &[f64]) -> f64 {
        let mut value = 0.0;
        if dof != NO_DOF {
            self.linear(dof, 1.0, &mut |d: Dof, c: f64| value += c * at(du, d));
        }
        value
    }

    /// Puts dependent displacements, translations and the origins of poses where they belong (E1), (E3). The rotations
    /// of the poses are in place.
    pub(super) fn follow(&self, state: &mut State, layout: &Layout, reference: &[Vec3]) {
        for relation in &self.relations {
            let linear = relation.terms.iter().map(|&(d, c)| c * at(&state.u, d));
            let turns = relation.turns.iter();
            let turned = turns.map(|&(t, c)| {
                c * self.turned(state, layout, reference, t.carrier, t.node)[t.axis]
            });
            let value = linear.sum::<f64>() + turned.sum::<f64>();
            put(&mut state.u, relation.dof, value);
        }
        for (id, (body, pose)) in self.bodies.iter().zip(&mut state.poses).enumerate() {
            for axis in 0..layout.ndim() {
                let moved = at(&state.u, layout.translation(id as RigidId, axis));
                pose.origin[axis] = body.reference[axis] + moved;
            }
        }
        for (id, body) in self.bodies.iter().enumerate() {
            let id = id as RigidId;
            for &node in &body.nodes {
                let turned = self.turned(state, layout, reference, id, node);
                for axis in 0..layout.ndim() {
                    let moved = at(&state.u, layout.translation(id, axis));
                    put(&mut state.u, layout.node(node, axis), moved + turned[axis]);
                }
            }
        }
        for (turn, _) in &self.coupled {
            let Turn {
                node,
                axis,
                carrier,
            } = *turn;
            let turned = self.turned(state, layout, reference, carrier, node)[axis];
            let moved = at(&state.u, layout.translation(turn.carrier, turn.axis));
            put(
                &mut state.u,
                layout.node(turn.node, turn.axis),
                moved + turned,
            );
        }
    }

    /// `R a_0 − a_0`, or `θ × a_0` where rotations are small; exactly zero as long as nothing turns.
    fn turned(
        &self,
        state: &State,
        layout: &Layout,
        reference: &[Vec3],
        carrier: RigidId,
        node: NodeId,
    ) -> Vec3 {
        let start = reference.get(node as usize);
        let body = self.bodies.get(carrier as usize);
        let (Some(&start), Some(body), Some(pose)) =
            (start, body, state.poses.get(carrier as usize))
        else {
            return Vec3::ZERO;
        };
        let arm = start - body.reference;
        let turn = Turn {
            node,
            axis: 0,
            carrier,
        };
        let (stretched, stretch) = self.stretched(arm, turn, state);
        if state.is_small {
            // not as a difference of arms, which would lose the digits of the stretch
            let longer = stretch.map_or(Vec3::ZERO, |(unit, by)| unit * at(&state.u, by));
            return self.rotation(state, layout, carrier).cross(arm) + longer;
        }
        pose.rotation * stretched - arm
    }

    /// The rotation vector of a carrier: its increments summed up.
    fn rotation(&self, state: &State, layout: &Layout, carrier: RigidId) -> Vec3 {
        let about = |axis| self.increment(layout.rotation(carrier, axis), &state.u);
        Vec3::new(about(0), about(1), about(2))
    }

    /// The raw dofs that take the place of these ones, appended to `out`.
    pub fn independent(&self, dofs: &[Dof], layout: &Layout, out: &mut Vec<Dof>) {
        let first = out.len();
        let mut dependent = false;
        for &dof in dofs.iter().filter(|&&d| d != NO_DOF) {
            if let Some(turn) = self.leader(dof, layout) {
                let of = layout.translation(turn.carrier, turn.axis);
                self.linear(of, 1.0, &mut |d: Dof, _: f64| out.push(d));
                self.rotations(turn.carrier, layout, out);
                if let Some(relation) = self.relation(of) {
                    self.turning(relation, layout, out);
                }
            } else if let Some(relation) = self.relation(dof) {
                self.linear(dof, 1.0, &mut |d: Dof, _: f64| out.push(d));
                self.turning(relation, layout, out);
            } else {
                out.push(dof);
                continue;
            }
            dependent = true;
        }
        if dependent {
            out[first..].sort_unstable();
            let mut kept = first;
            for k in first..out.len() {
                if kept == first || out[kept - 1] != out[k] {
                    out[kept] = out[k];
                    kept += 1;
                }
            }
            out.truncate(kept);
        }
    }

    /// The unknowns behind the rotation of a carrier, appended.
    fn rotations(&self, carrier: RigidId, layout: &Layout, out: &mut Vec<Dof>) {
        for dof in (0..3)
            .map(|c| layout.rotation(carrier, c))
            .filter(|&d| d != NO_DOF)
        {
            self.linear(dof, 1.0, &mut |d: Dof, _: f64| out.push(d));
        }
    }

    fn turning(&self, relation: &Relation, layout: &Layout, out: &mut Vec<Dof>) {
        for (turn, _) in &relation.turns {
            self.rotations(turn.carrier, layout, out);
            if let Some(by) = self.stretching(turn.carrier, turn.node) {
                self.linear(by, 1.0, &mut |d: Dof, _: f64| out.push(d));
            }
        }
    }

    /// The terms of a dof that follows no carrier itself, without turns.
    fn linear(&self, dof: Dof, weight: f64, out: &mut impl Resolve) {
        match self.relation(dof) {
            None => out.term(dof, weight),
            Some(relation) => {
                for &(d, c) in &relation.terms {
                    out.term(d, weight * c);
                }
            }
        }
    }

    /// All terms of a dof, differentials of its turns included.
    fn resolve(&self, dof: Dof, state: &State, layout: &Layout, out: &mut impl Resolve) {
        let mut of = dof;
        if let Some(turn) = self.leader(dof, layout) {
            of = layout.translation(turn.carrier, turn.axis);
            self.resolve_turn(turn, 1.0, state, layout, out);
        }
        self.linear(of, 1.0, out);
        if let Some(relation) = self.relation(of) {
            for &(turn, c) in &relation.turns {
                self.resolve_turn(turn, c, state, layout, out);
            }
        }
    }

    /// `dx = dθ × a = −[a]× dθ` (E1), of small rotations too.
    fn resolve_turn(
        &self,
        turn: Turn,
        weight: f64,
        state: &State,
        layout: &Layout,
        out: &mut impl Resolve,
    ) {
        let row = Mat3::skew(self.arm(state, layout, turn)).rows[turn.axis];
        for about in (0..3).filter(|&about| about != turn.axis) {
            let rotation = layout.rotation(turn.carrier, about);
            if rotation != NO_DOF {
                self.linear(rotation, -weight * row[about], out);
            }
        }
        if let Some((unit, by)) = self.stretch_at(state, turn) {
            self.linear(by, weight * unit[turn.axis], out);
        }
        out.turn(turn, weight);
    }

    /// The direction in which an arm stretches at a state, with the dof of it.
    fn stretch_at(&self, state: &State, turn: Turn) -> Option<(Vec3, Dof)> {
        let start = self.guided_arm(turn)?;
        let (_, stretch) = self.stretched(start, turn, state);
        let (unit, by) = stretch?;
        let pose = state.poses.get(turn.carrier as usize)?;
        Some((
            if state.is_small {
                unit
            } else {
                pose.rotation * unit
            },
            by,
        ))
    }

    fn guided_arm(&self, turn: Turn) -> Option<Vec3> {
        let of = (turn.carrier, turn.node);
        let k = self.guided.binary_search_by_key(&of, |g| g.0).ok()?;
        self.guided.get(k).map(|g| g.1)
    }

    /// The arm `R a_0` of what follows; `a_0` where rotations are small.
    fn arm(&self, state: &State, layout: &Layout, turn: Turn) -> Vec3 {
        let of = turn.carrier as usize;
        let (Some(pose), Some(body)) = (state.poses.get(of), self.bodies.get(of)) else {
            return Vec3::ZERO;
        };
        // a node that follows in some directions only lies elsewhere
        let coupled = self.coupled.binary_search_by_key(&turn, |c| c.0).ok();
        let coupled = coupled.and_then(|k| self.coupled.get(k)).map(|c| c.1);
        let start = coupled.or_else(|| self.guided_arm(turn));
        let x = state.x.get(turn.node as usize).copied();
        match (start, state.is_small) {
            (Some(start), true) => start,
            (Some(start), false) => pose.rotation * self.stretched(start, turn, state).0,
            (None, false) => x.unwrap_or(pose.origin) - pose.origin,
            (None, true) => {
                let moved = |axis| at(&state.u, layout.node(turn.node, axis));
                let u = Vec3::new(moved(0), moved(1), moved(2));
                x.map_or(Vec3::ZERO, |x| x - u - body.reference)
            }
        }
    }

    /// What a dof moves with at a state: unknowns with their coefficients, itself where it follows nothing.
    pub fn terms(&self, dof: Dof, state: &State, layout: &Layout, out: &mut impl FnMut(Dof, f64)) {
        if dof != NO_DOF {
            self.resolve(dof, state, layout, out);
        }
    }

    /// Spreads a bound on rounding errors at a dependent dof over what it follows.
    pub(super) fn spread(
        &self,
        dof: Dof,
        error: f64,
        state: &State,
        layout: &Layout,
        out: &mut [f64],
    ) {
        let mut add = |d: Dof, c: f64| {
            if let Some(to) = out.get_mut(d as usize) {
                *to += error * c.abs();
            }
        };
        self.resolve(dof, state, layout, &mut add);
    }

    /// Replaces dependent unknowns in a local force and stiffness, equations (E1) to (E3). The stiffness, row-major, is
    /// empty where there is none; that of the turning forces is added where forces are `turning`.
    #[expect(clippy::too_many_arguments)]
    pub(super) fn expand(
        &self,
        dofs: &[Dof],
        force: &[f64],
        stiffness: &[f64],
        turning: bool,
        state: &State,
        layout: &Layout,
        out: &mut Expanded,
    ) {
        out.clear(layout.ndof());
        for (&dof, &force) in dofs.iter().zip(force) {
            if dof != NO_DOF {
                self.resolve(dof, state, layout, &mut Row { out, force });
            }
            out.start.push(out.terms.len());
        }
        // what follows in one direction only turns about that one, too, once a force acts on it
        for k in 0..out.turns.len() {
            let turn = out.turns[k].0;
            let about = layout.rotation(turn.carrier, turn.axis);
            if about != NO_DOF {
                self.linear(about, 1.0, &mut |d: Dof, _: f64| _ = out.place(d));
            }
        }
        let (n, m) = (dofs.len(), out.dofs.len());
        out.force.resize(m, 0.0);
        for (ends, f) in out.start.windows(2).zip(force) {
            for &(k, c) in &out.terms[ends[0]..ends[1]] {
                out.force[k] += c * f;
            }
        }
        if !turning && stiffness.is_empty() {
            return;
        }
        out.stiffness.resize(m * m, 0.0);
        if !stiffness.is_empty() {
            for (i, row) in out.start.windows(2).enumerate() {
                for (j, column) in out.start.windows(2).enumerate() {
                    let value = stiffness[i * n + j];
                    if value == 0.0 {
                        continue;
                    }
                    for &(p, a) in &out.terms[row[0]..row[1]] {
                        for &(q, b) in &out.terms[column[0]..column[1]] {
                            out.stiffness[p * m + q] += a * b * value;
                        }
                    }
                }
            }
        }
        if turning {
            self.turning_forces(state, layout, out);
        }
    }

    /// The change of the moments with the arms, (E2), and of the forces on stretches with them; none where rotations are small.
    fn turning_forces(&self, state: &State, layout: &Layout, out: &mut Expanded) {
        if state.is_small {
            return;
        }
        let m = out.dofs.len();
        let Expanded {
            turns,
            place,
            stiffness,
            ..
        } = out;
        let mut add = |p: Dof, q: Dof, value: f64| {
            if value == 0.0 || p == NO_DOF || q == NO_DOF {
                return;
            }
            self.linear(p, 1.0, &mut |p: Dof, a: f64| {
                self.linear(q, 1.0, &mut |q: Dof, b: f64| {
                    let (p, q) = (place[p as usize] as usize, place[q as usize] as usize);
                    if let Some(to) = stiffness.get_mut(p * m + q).filter(|_| p < m && q < m) {
                        *to += a * b * value;
                    }
                });
            });
        };
        for &(turn, f) in turns.iter() {
            let single = Vec3::unit(turn.axis) * f;
            let term = Mat3::skew(single) * Mat3::skew(self.arm(state, layout, turn));
            let rotation = |about| layout.rotation(turn.carrier, about);
            for i in 0..3 {
                for j in 0..3 {
                    add(rotation(i), rotation(j), term.rows[i][j]);
                }
            }
            if let Some((unit, by)) = self.stretch_at(state, turn) {
                // f · (dθ × u) ds = dθ · (u × f) ds
                let moment = unit.cross(single);
                for i in 0..3 {
                    add(rotation(i), by, moment[i]);
                    add(by, rotation(i), moment[i]);
                }
            }
        }
    }
}

fn at(values: &[f64], dof: Dof) -> f64 {
    values.get(dof as usize).copied().unwrap_or(0.0)
}

fn put(values: &mut [f64], dof: Dof, value: f64) {
    if let Some(to) = values.get_mut(dof as usize) {
        *to = value;
    }
}
