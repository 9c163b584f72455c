//! One pair of surfaces with its choices, as the one contact term there is.

use super::discretization::{Discretization, Pair, Pairing, RowOrder, SurfacePair};
use super::friction::FrictionLaw;
use super::kernel::add_pressure;
use super::law::{ContactLaw, Eval, Scale};
use super::row::{Participant, Row, Rows};
use crate::system::{
    Archive, ArchiveError, ContactFrame, Dof, Elimination, Frame, Layout, Order, Part, PatternSink,
    Resultant, Sink, State, Status, Symmetry, Term, TermError, Verdict, Work,
};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Facets, Feature, Placement, SurfaceError, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// Groups evaluated together.
const CHUNK: usize = 64;

/// Rounding error of a gap over the coordinates it comes from.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How many nodes a verdict names.
const NAMED: usize = 4;

/// What a unit of the law's pressure acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The tributary area of the row.
    Area,
    /// The row itself: the law gives forces.
    Node,
}

/// What an interface is made of.
pub struct InterfaceParts {
    /// Its name.
    pub name: String,
    /// The two sides.
    pub pair: SurfacePair,
    /// How they are compared.
    pub discretization: Box<dyn Discretization>,
    /// The contact law.
    pub law: Box<dyn ContactLaw>,
    /// The friction law.
    pub friction: Box<dyn FrictionLaw>,
    /// What the law's pressure acts on.
    pub measure: Measure,
    /// Tributary area of each row; empty where the secondary side has none.
    pub area: Vec<f64>,
    /// The numbers the law scales with.
    pub scale: Scale,
}

/// Two surfaces that may touch: the only contact term, whatever the method, the law, the surfaces or the dimension.
pub struct Interface {
    parts: InterfaceParts,
    layout: Layout,
    elimination: Arc<Elimination>,
    search: Search,
    /// The choices for the present iterate, those of the last accepted state, and those last judged.
    now: Pairing,
    accepted: Pairing,
    judged: Pairing,
    next: Pairing,
    /// Whether the accepted choices are those of a state, and not just of nothing.
    started: bool,
    /// The facet that the pattern couples each row with, its neighbours included; `NONE` where it couples none.
    coupled: Vec<u32>,
    points: Vec<Vec3>,
    boxes: Vec<Aabb>,
}

const NONE: u32 = u32::MAX;

#[derive(Default)]
struct Scratch {
    rows: Rows,
    dofs: Vec<Dof>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Interface {
    /// Makes the term.
    #[must_use]
    pub fn new(parts: InterfaceParts, layout: Layout, elimination: Arc<Elimination>) -> Self {
        let nrow = parts.discretization.nrow();
        let nothing = Pairing {
            pairs: vec![None; nrow],
        };
        Self {
            parts,
            layout,
            elimination,
            search: Search::default(),
            now: nothing.clone(),
            accepted: nothing.clone(),
            judged: nothing.clone(),
            next: nothing,
            started: false,
            coupled: vec![NONE; nrow],
            points: Vec::new(),
            boxes: Vec::new(),
        }
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> &InterfaceParts {
        &self.parts
    }

    /// The choices made for the present iterate.
    #[must_use]
    pub const fn pairing(&self) -> &Pairing {
        &self.now
    }

    fn measure(&self, row: usize) -> f64 {
        match self.parts.measure {
            Measure::Area => self.area(row),
            Measure::Node => 1.0,
        }
    }

    /// Tributary area of a row; 1 where the secondary side has none, so that pressures are then forces.
    fn area(&self, row: usize) -> f64 {
        self.parts.area.get(row).copied().unwrap_or(1.0)
    }

    fn failed(&self, error: &SurfaceError) -> TermError {
        TermError::Surface {
            interface: self.parts.name.clone(),
            message: error.to_string(),
        }
    }

    fn search(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let InterfaceParts {
            pair,
            discretization,
            ..
        } = &self.parts;
        let surface = pair.primary.as_ref();
        self.points.clear();
        let point = |row| discretization.point(row, pair, at);
        self.points.extend((0..discretization.nrow()).map(point));
        self.boxes.clear();
        let facets = 0..surface.nfacet() as u32;
        self.boxes.extend(facets.map(|f| surface.aabb(at, f)));
        let skin = 0.5 * pair.reach;
        self.search
            .update(&self.points, &self.boxes, pair.reach, skin, &|_, _| true);
        let near = self.search.candidates();
        discretization.pair_up(pair, at, near, &self.now, &mut self.next)?;
        std::mem::swap(&mut self.now, &mut self.next);
        Ok(())
    }

    /// Whether a point that was near a facet has jumped through it, out of reach behind it: contact would be lost without
    /// ever having been noticed.
    fn passed_through(&self, at: &Placement) -> Option<String> {
        let surface = self.parts.pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        let rows = self.accepted.pairs.iter().zip(&self.now.pairs).enumerate();
        for (row, (before, now)) in rows {
            let (Some(before), None) = (before, now) else {
                continue;
            };
            let point = self.points.get(row).copied().unwrap_or_default();
            if surface.jet(at, &before.anchor, &mut jet).is_err() {
                continue;
            }
            let away = point - jet.position;
            let behind = -away.dot(jet.normal);
            let distance = away.norm();
            if distance > self.parts.pair.reach && behind > 0.5 * distance {
                return Some(format!(
                    "a point went through the surface in one increment, {behind:.3} behind it and further than the \
                     reach of {:.3}; take smaller increments",
                    self.parts.pair.reach
                ));
            }
        }
        None
    }

    /// Couples every row that touches, or may soon, with its facet; says whether that adds to what was coupled.
    fn couple(&mut self) -> bool {
        let soon = 0.25 * self.parts.pair.reach;
        let wanted = |pair: &Option<Pair>| match pair {
            Some(p) if p.gap < soon => p.anchor.facet,
            _ => NONE,
        };
        let surface = self.parts.pair.primary.as_ref();
        let covered = |pair: &Option<Pair>, coupled: u32| {
            let facet = wanted(pair);
            facet == NONE
                || facet == coupled
                || (coupled != NONE && surface.neighbours(coupled).contains(&facet))
        };
        let rows = self.now.pairs.iter().zip(&self.coupled);
        if rows.into_iter().all(|(pair, &c)| covered(pair, c)) {
            return false;
        }
        for (coupled, pair) in self.coupled.iter_mut().zip(&self.now.pairs) {
            *coupled = wanted(pair);
        }
        true
    }

    fn groups(&self, chunk: usize) -> std::ops::Range<usize> {
        let n = self.parts.discretization.ngroup(&self.now);
        (chunk * CHUNK).min(n)..((chunk + 1) * CHUNK).min(n)
    }

    /// Fills the rows of one group.
    fn rows(
        &self,
        group: usize,
        at: &Placement,
        order: RowOrder,
        rows: &mut Rows,
    ) -> Result<(), TermError> {
        let parts = &self.parts;
        parts
            .discretization
            .rows(group, &parts.pair, at, &self.now, order, rows)
            .map_err(|e| self.failed(&e))
    }

    fn pressure(&self, row: &Row) -> Eval {
        self.parts.law.pressure(row.gap, 0.0, &self.parts.scale)
    }

    /// The rounding error of the forces of a group: that of the positions times the stiffness of the law.
    fn rounding(&self, rows: &Rows, trial: &State) -> f64 {
        let size = |p: &Participant| match *p {
            Participant::Node(node) => trial.x.get(node as usize).map_or(0.0, |x| x.max_abs()),
            Participant::Rigid(body) => {
                let pose = trial.poses.get(body as usize);
                pose.map_or(0.0, |p| p.origin.max_abs())
            }
        };
        let size = rows.participants().iter().map(size).fold(0.0, f64::max);
        let stiffness = |row: &Row| self.pressure(row).dgap.abs() * self.measure(row.number);
        ROUNDING * size * rows.rows().iter().map(stiffness).sum::<f64>()
    }

    /// Adds the rows of a group up in `force` and `stiffness`.
    fn act(&self, rows: &Rows, force: &mut Vec<f64>, stiffness: &mut Vec<f64>, order: Order) {
        let n = rows.ncolumn();
        force.clear();
        force.resize(n, 0.0);
        stiffness.clear();
        if order == Order::Tangent {
            stiffness.resize(n * n, 0.0);
        }
        for row in rows.rows() {
            let pressure = self.pressure(row);
            if pressure != Eval::default() {
                add_pressure(row, self.measure(row.number), &pressure, force, stiffness);
            }
        }
    }
}

impl Term for Interface {
    fn name(&self) -> &str {
        &self.parts.name
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        let surface = self.parts.pair.primary.as_ref();
        let mut dofs: Vec<Dof> = Vec::new();
        for (&node, &facet) in self.parts.pair.points.iter().zip(&self.coupled) {
            if facet == NONE {
                continue;
            }
            for &facet in surface.neighbours(facet).iter().chain([&facet]) {
                dofs.clear();
                match surface.carrier(facet) {
                    Carrier::Nodes(nodes) => {
                        let of = |&n: &NodeId| (0..3).map(move |c| (n, c));
                        dofs.extend(
                            nodes
                                .iter()
                                .flat_map(of)
                                .map(|(n, c)| self.layout.node(n, c)),
                        );
                    }
                    Carrier::Rigid(body) => {
                        dofs.extend((0..3).map(|c| self.layout.translation(body, c)));
                        dofs.extend((0..3).map(|c| self.layout.rotation(body, c)));
                    }
                    Carrier::Fixed => {}
                }
                dofs.extend((0..3).map(|c| self.layout.node(node, c)));
                out.interface(&dofs);
            }
        }
    }

    fn symmetry(&self) -> Symmetry {
        if self.parts.friction.is_frictionless() {
            Symmetry::Definite
        } else {
            Symmetry::Unsymmetric
        }
    }

    fn part(&self) -> Part {
        Part::Interface
    }

    fn begin_increment(&mut self, from: &State) -> Result<(), TermError> {
        if !self.started {
            self.search(&from.placement())
                .map_err(|e| self.failed(&e))?;
            self.accepted.pairs.clone_from(&self.now.pairs);
            self.judged.pairs.clone_from(&self.now.pairs);
            self.started = true;
        }
        Ok(())
    }

    fn prepare(&mut self, trial: &State) -> Result<bool, TermError> {
        let at = trial.placement();
        self.search(&at).map_err(|e| self.failed(&e))?;
        match self.passed_through(&at) {
            Some(message) => Err(TermError::Surface {
                interface: self.parts.name.clone(),
                message,
            }),
            None => Ok(self.couple()),
        }
    }

    fn nchunk(&self) -> usize {
        self.parts.discretization.nrow().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let Scratch {
            rows,
            dofs,
            force,
            stiffness,
        } = work.of::<Scratch>();
        let at = trial.placement();
        let row_order = match order {
            Order::Residual => RowOrder::Gradient,
            Order::Tangent => RowOrder::Tangent,
        };
        for group in self.groups(chunk) {
            // gaps first: most rows are open and need nothing else
            self.rows(group, &at, RowOrder::Gap, rows)?;
            if !rows
                .rows()
                .iter()
                .any(|r| self.pressure(r) != Eval::default())
            {
                continue;
            }
            self.rows(group, &at, row_order, rows)?;
            self.act(rows, force, stiffness, order);
            rows.dofs(&self.layout, dofs);
            out.add(dofs, force, stiffness);
            out.uncertain(dofs, self.rounding(rows, trial));
        }
        Ok(())
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let rows = &mut work.of::<Scratch>().rows;
        let at = trial.placement();
        let mut total = Some(0.0);
        for group in self.groups(chunk) {
            self.rows(group, &at, RowOrder::Gap, rows)?;
            for row in rows.rows() {
                let energy = self.parts.law.energy(row.gap, 0.0, &self.parts.scale);
                let measure = self.measure(row.number);
                total = total.zip(energy).map(|(t, e)| t + measure * e);
            }
        }
        Ok(total)
    }

    fn verdict(&mut self, _: &State) -> Verdict {
        let pairs = self.now.pairs.iter().zip(&self.judged.pairs);
        let touches = |p: &Option<Pair>| p.as_ref().is_some_and(Pair::inside);
        let changed = |(now, before): (&Option<Pair>, &Option<Pair>)| match (now, before) {
            (Some(a), Some(b)) if a.inside() || b.inside() => !a.agrees(b),
            (a, b) => touches(a) != touches(b),
        };
        let mut flips = 0;
        let mut opened = 0;
        let mut closed = 0;
        let mut nodes = Vec::new();
        for (row, (now, before)) in pairs.enumerate() {
            if !changed((now, before)) {
                continue;
            }
            flips += 1;
            closed += usize::from(touches(now) && !touches(before));
            opened += usize::from(!touches(now) && touches(before));
            if nodes.len() < NAMED {
                nodes.extend(self.parts.pair.points.get(row));
            }
        }
        self.judged.pairs.clone_from(&self.now.pairs);
        if flips == 0 {
            return Verdict::Settled;
        }
        let moved = flips - opened - closed;
        Verdict::Repeat {
            changes: flips,
            why: format!(
                "contact \"{}\": {closed} closed, {opened} opened, {moved} went to another facet",
                self.parts.name
            ),
            nodes,
        }
    }

    fn nactive(&self) -> usize {
        let pairs = self.now.pairs.iter().flatten();
        pairs.filter(|p| p.inside()).count()
    }

    fn accept(&mut self, _: &State) -> Result<(), TermError> {
        self.accepted.pairs.clone_from(&self.now.pairs);
        Ok(())
    }

    fn reject(&mut self) {
        self.now.pairs.clone_from(&self.accepted.pairs);
        self.judged.pairs.clone_from(&self.accepted.pairs);
    }

    fn save(&self, out: &mut Archive) {
        let rows = self.accepted.pairs.iter();
        let values: Vec<f64> = rows.flat_map(pair_to_numbers).collect();
        out.put(format!("contact.{}.pairs", self.parts.name), &values);
        let facet = |&f: &u32| if f == NONE { -1.0 } else { f64::from(f) };
        let coupled: Vec<f64> = self.coupled.iter().map(facet).collect();
        out.put(format!("contact.{}.coupled", self.parts.name), &coupled);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let mut values = vec![0.0; self.accepted.pairs.len() * PAIR_NUMBERS];
        from.get(&format!("contact.{}.pairs", self.parts.name), &mut values)?;
        for (pair, numbers) in self
            .accepted
            .pairs
            .iter_mut()
            .zip(values.chunks_exact(PAIR_NUMBERS))
        {
            *pair = pair_from_numbers(numbers);
        }
        let mut coupled = vec![0.0; self.coupled.len()];
        from.get(
            &format!("contact.{}.coupled", self.parts.name),
            &mut coupled,
        )?;
        for (to, facet) in self.coupled.iter_mut().zip(coupled) {
            *to = if facet < 0.0 { NONE } else { facet as u32 };
        }
        self.reject();
        self.started = self.accepted.pairs.iter().any(Option::is_some);
        self.search.forget();
        Ok(())
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let mut report = self.new_report(state);
        let mut rows = Rows::default();
        let (mut force, mut stiffness) = (Vec::new(), Vec::new());
        let at = state.placement();
        let mut centre = (Vec3::ZERO, 0.0);
        for group in 0..self.parts.discretization.ngroup(&self.now) {
            self.rows(group, &at, RowOrder::Gradient, &mut rows)?;
            self.act(&rows, &mut force, &mut stiffness, Order::Residual);
            for row in rows.rows() {
                let k = row.number;
                let value = self.pressure(row).value * self.measure(k) / self.area(k);
                report.gap[k] = row.gap;
                report.pressure[k] = value;
                report.status[k] = if value > 0.0 {
                    Status::Slip
                } else {
                    Status::Open
                };
            }
            self.distribute(&rows, &force, state, &mut report, frame);
        }
        for (k, status) in report.status.iter().enumerate() {
            let area = self.area(k);
            match status {
                Status::Absent | Status::Open => report.area_open += area,
                Status::Stick => report.area_stick += area,
                Status::Slip => report.area_slip += area,
            }
            report.traction[k] = report.force[k] / area;
            let weight = report.pressure[k] * area;
            centre.0 += report.points[k] * weight;
            centre.1 += weight;
            let node = report.nodes[k] as usize;
            if let Some(to) = frame.contact_pressure.get_mut(node) {
                *to = to.max(report.pressure[k]);
            }
        }
        if centre.1 > 0.0 {
            report.center = centre.0 / centre.1;
        }
        report.pressure_max = report.pressure.iter().copied().fold(0.0, f64::max);
        let gaps = report.gap.iter().copied().filter(|g| g.is_finite());
        report.gap_min = gaps.reduce(f64::min).unwrap_or(0.0);
        frame.contacts.push(report);
        Ok(())
    }
}

impl Interface {
    fn new_report(&self, state: &State) -> ContactFrame {
        let pair = &self.parts.pair;
        let n = pair.points.len();
        let of = |&node: &NodeId| state.x.get(node as usize).copied().unwrap_or_default();
        let moved = |&node: &NodeId| {
            let mut u = Vec3::ZERO;
            for axis in 0..self.layout.ndim {
                let dof = self.layout.node(node, axis) as usize;
                u[axis] = state.u.get(dof).copied().unwrap_or_default();
            }
            u
        };
        let local = |nodes: &[NodeId]| -> Vec<u32> {
            let place = |node| pair.points.binary_search(node).ok().map(|k| k as u32);
            nodes.iter().filter_map(place).collect()
        };
        let facet = |facets: &Facets, f: u32| -> Option<(Element, Vec<u32>)> {
            Some((facets.element(f)?, local(facets.nodes(f))))
        };
        let facets = pair.secondary.as_ref().map_or_else(Vec::new, |facets| {
            (0..facets.nfacet() as u32)
                .filter_map(|f| facet(facets, f))
                .collect()
        });
        ContactFrame {
            name: self.parts.name.clone(),
            nodes: pair.points.clone(),
            points: pair.points.iter().map(of).collect(),
            displacement: pair.points.iter().map(moved).collect(),
            facets,
            gap: vec![f64::NAN; n],
            pressure: vec![0.0; n],
            status: vec![Status::Absent; n],
            force: vec![Vec3::ZERO; n],
            traction: vec![Vec3::ZERO; n],
            slip: vec![Vec3::ZERO; n],
            area: (0..n).map(|k| self.area(k)).collect(),
            facet_size: self.parts.scale.length,
            ..ContactFrame::default()
        }
    }

    /// Adds the forces of a group to the nodes, the resultants of both sides, and the rigid bodies.
    fn distribute(
        &self,
        rows: &Rows,
        internal: &[f64],
        state: &State,
        report: &mut ContactFrame,
        frame: &mut Frame,
    ) {
        let mut column = 0;
        let vector = |at: usize| {
            let part = internal.get(at..at + 3);
            part.map_or(Vec3::ZERO, |f| -Vec3::new(f[0], f[1], f[2]))
        };
        for participant in rows.participants() {
            let force = vector(column);
            match *participant {
                Participant::Node(node) => {
                    let x = state.x.get(node as usize).copied().unwrap_or_default();
                    let own = self.parts.pair.points.binary_search(&node);
                    let side = match own {
                        Ok(k) => {
                            report.force[k] += force;
                            &mut report.secondary
                        }
                        Err(_) => &mut report.primary,
                    };
                    add(side, force, x.cross(force));
                    if let Some(to) = frame.contact_force.get_mut(node as usize) {
                        *to += force;
                    }
                    if let Some(body) = self.elimination.body_of(node) {
                        let origin = state.poses.get(body as usize).map(|p| p.origin);
                        let rigid = frame.rigid.get_mut(body as usize);
                        if let (Some(origin), Some(rigid)) = (origin, rigid) {
                            add(&mut rigid.contact, force, (x - origin).cross(force));
                        }
                    }
                }
                Participant::Rigid(body) => {
                    let moment = vector(column + 3);
                    let origin = state.poses.get(body as usize).map(|p| p.origin);
                    let origin = origin.unwrap_or_default();
                    add(&mut report.primary, force, moment + origin.cross(force));
                    if let Some(rigid) = frame.rigid.get_mut(body as usize) {
                        add(&mut rigid.contact, force, moment);
                    }
                }
            }
            column += participant.ncolumn();
        }
    }
}

fn add(to: &mut Resultant, force: Vec3, moment: Vec3) {
    to.force += force;
    to.moment += moment;
}

/// Numbers that hold a pair in a checkpoint: facet (−1: none), three coordinates, feature, its direction, gap.
const PAIR_NUMBERS: usize = 8;

fn pair_to_numbers(pair: &Option<Pair>) -> [f64; PAIR_NUMBERS] {
    let Some(p) = pair else {
        return [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    };
    let (feature, d) = match p.feature {
        Feature::Face => (0.0, [0.0; 2]),
        Feature::Edge { direction } => (1.0, direction),
        Feature::Vertex => (2.0, [0.0; 2]),
    };
    let local = p.anchor.local;
    let facet = f64::from(p.anchor.facet);
    [facet, local.x, local.y, local.z, feature, d[0], d[1], p.gap]
}

fn pair_from_numbers(n: &[f64]) -> Option<Pair> {
    let &[facet, x, y, z, feature, d0, d1, gap] = n else {
        return None;
    };
    if facet < 0.0 {
        return None;
    }
    let feature = match feature as u8 {
        0 => Feature::Face,
        1 => Feature::Edge {
            direction: [d0, d1],
        },
        _ => Feature::Vertex,
    };
    Some(Pair {
        anchor: Anchor {
            facet: facet as u32,
            local: Vec3::new(x, y, z),
        },
        feature,
        gap,
    })
}
