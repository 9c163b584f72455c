//! The report of a contact on an accepted state.

use super::means::{Means, OfRow};
use super::{Contact, Interface, Measure, Order, Participant, Rows, Scratch, State, TermError};
use crate::contact::discretization::OnRow;
use crate::contact::kernel::{Lambda, Traction};
use crate::contact::row::Row;
use crate::system::{
    ContactFrame, ContactSample, ContactWarmth, Footprint, Frame, Resultant, Status,
};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::{Face, NodeId};
use signorini_geometry::surface::{Carrier, ContactSurface, Facets, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// The report of a row, without the pressure on it.
#[derive(Default)]
struct RowReport {
    status: Status,
    /// Whether its law acts.
    acts: bool,
    area: f64,
    /// Pressures are those of an area larger by this factor.
    stretch: f64,
    energy: f64,
    /// None where it meets nothing.
    found: Option<Found>,
}

/// The report of a row on the facet it meets, without the forces on it.
struct Found {
    normal: Vec3,
    gap: f64,
    /// Along which a pressure pushes.
    direction: Vec3,
    elastic_slip: Vec3,
    damage: f64,
    heat: [f64; 3],
}

/// A report while rows are added to it.
struct Sums {
    report: ContactFrame,
    means: Means,
    /// On the nodes of the first of two passes, in the second.
    across: Means,
    /// Entries of nodes whose functions are parts of those of other rows.
    taken: Vec<usize>,
    guests: Vec<NodeId>,
}

impl Sums {
    fn new(report: ContactFrame, nacross: usize) -> Self {
        Self {
            means: Means::new(report.nodes.len()),
            across: Means::new(nacross),
            taken: Vec::new(),
            guests: Vec::new(),
            report,
        }
    }

    /// Sums become means.
    fn divide(self) -> (ContactFrame, Means) {
        let Self {
            mut report,
            means,
            across,
            taken,
            ..
        } = self;
        for k in 0..report.nodes.len() {
            if let Some(mean) = means.of(k) {
                report.normal[k] = mean.normal;
                report.gap[k] = mean.gap;
                report.pressure[k] = mean.pressure;
                report.traction[k] = mean.traction;
                report.multiplier[k] = mean.multiplier;
                report.multiplier_traction[k] = mean.multiplier_traction;
                report.slip[k] = mean.slip;
                report.elastic_slip[k] = mean.elastic_slip;
                if let Some(damage) = report.damage.get_mut(k) {
                    *damage = mean.damage;
                }
                if let Some(warmth) = &mut report.warmth {
                    warmth.add(k, mean.heat);
                }
                // rows of its node that meet nothing, as on another side of an edge, have no part in the means
                report.area[k] = means.whole[k];
            }
        }
        for (_, sum) in report.faces.iter_mut().flatten() {
            sum.divide();
        }
        for k in taken {
            // their areas are parts of those of their borrowers
            report.area[k] = 0.0;
        }
        report.footprint.divide();
        (report, across)
    }
}

/// Adds a report to the frame: to that of the first pass, where it is of the second.
fn hand_over(report: ContactFrame, across: &Means, first: Option<usize>, frame: &mut Frame) {
    match first.and_then(|c| frame.contacts.get_mut(c)) {
        Some(first) => {
            for k in 0..first.nodes.len() {
                if let Some(mean) = across.of(k) {
                    first.pressure[k] += mean.pressure;
                    first.traction[k] += mean.traction;
                    first.multiplier[k] += mean.multiplier;
                    first.multiplier_traction[k] += mean.multiplier_traction;
                    if let Some(warmth) = &mut first.warmth {
                        warmth.add(k, mean.heat);
                    }
                }
            }
            first.add_pass(&report);
        }
        None => frame.contacts.push(report),
    }
    let whole = first.unwrap_or(frame.contacts.len() - 1);
    let Frame {
        contacts,
        contact_pressure,
        ..
    } = frame;
    for (&node, pressure) in contacts[whole].nodes.iter().zip(&contacts[whole].pressure) {
        if let Some(to) = contact_pressure.get_mut(node as usize) {
            *to = to.max(*pressure);
        }
    }
}

impl ContactSample {
    /// Sums become means.
    fn divide(&mut self) {
        if self.area > 0.0 {
            self.gap /= self.area;
            self.pressure /= self.area;
            self.traction = self.traction / self.area;
            self.slip = self.slip / self.area;
        }
        self.normal = self.normal.normalized().unwrap_or_default();
    }
}

impl ContactWarmth {
    fn new(nnode: usize) -> Self {
        let nothing = || vec![0.0; nnode];
        Self {
            flux: nothing(),
            conductance: nothing(),
            friction: nothing(),
            through: 0.0,
            rubbed: 0.0,
        }
    }

    /// Adds flux, conductance and heat of friction at a node.
    fn add(&mut self, k: usize, heat: [f64; 3]) {
        let fields = [&mut self.flux, &mut self.conductance, &mut self.friction];
        for (field, value) in fields.into_iter().zip(heat) {
            if let Some(to) = field.get_mut(k) {
                *to += value;
            }
        }
    }
}

impl Footprint {
    /// Sums become means.
    fn divide(&mut self) {
        if self.area > 0.0 {
            self.center = self.center / self.area;
        }
        self.normal = self.normal.normalized().unwrap_or_default();
    }
}

impl Interface {
    pub(super) fn describe(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        if self.phase().is_some_and(|phase| !phase.stands) {
            return Ok(());
        }
        let mut report = self.new_report(state);
        report.idle = self.idle_rows(state)?;
        // the second pass acts on the nodes of the first, which are its primary side
        let place = |c: &ContactFrame| self.parts.swapped && c.name == report.name;
        let first = frame.contacts.iter().position(place);
        let (rows, in_equations) = self.report_rows(state, (&mut report, first), frame)?;
        let mut on_rows = in_equations.clone();
        let averaged = self.parts.discretization.capabilities().averaged;
        if let Some(averaged) = averaged.filter(|_| self.parts.smooths) {
            let touches = |row: usize| {
                rows.get(row)
                    .is_some_and(|r: &RowReport| r.status.is_closed())
            };
            let joined = self.parts.bond.is_some();
            averaged.smooth(&self.now, &touches, joined, &mut on_rows);
        }
        let mut sums = Sums::new(report, first.map_or(0, |c| frame.contacts[c].nodes.len()));
        let rows = rows.into_iter().zip(on_rows).zip(in_equations);
        for (row, ((reported, on_row), raw)) in rows.enumerate() {
            let of_row = self.of_row(row, &reported, &on_row, &raw);
            let pressure = on_row.pressure * reported.stretch;
            let report = &mut sums.report;
            report.pressure_max = report.pressure_max.max(pressure);
            report.slip_max = report.slip_max.max(self.history.slip(row).norm());
            self.add_to_guests(row, &reported, pressure, of_row.as_ref(), &mut sums);
            self.add_to_nodes(
                row,
                state,
                (&reported, pressure),
                of_row.as_ref(),
                &mut sums,
            );
            let RowReport { area, energy, .. } = reported;
            if let (Some(faces), Some(of_row)) = (&mut sums.report.faces, &of_row)
                && reported.status.is_closed()
            {
                self.add_inside(row, area, energy, of_row, faces);
            }
            if let (Some(first), Some(of_row)) = (first, of_row) {
                let nodes = &frame.contacts[first].nodes;
                self.add_across(row, state, area, of_row, nodes, &mut sums.across)?;
            }
        }
        let (mut report, across) = sums.divide();
        self.describe_closures(state, &mut report)?;
        self.describe_fluid(state, &mut report)?;
        report.work_friction = self.history.work;
        [report.work_damage, report.work_viscous] = self.bonds.spent;
        let torn: f64 = self.bonds.spent.iter().sum();
        if torn != 0.0
            && let Some(energies) = &mut frame.energies
        {
            energies.damping += torn;
        }
        self.report_wear(&mut report, frame);
        if self.history.damped[0] != 0.0 {
            frame.energies.get_or_insert_default().damping += self.history.damped[0];
        }
        hand_over(report, &across, first, frame);
        Ok(())
    }

    /// What a row adds to the means; none where it meets nothing.
    fn of_row(
        &self,
        row: usize,
        reported: &RowReport,
        on_row: &OnRow,
        raw: &OnRow,
    ) -> Option<OfRow> {
        let found = reported.found.as_ref()?;
        let stretch = reported.stretch;
        let pressure = on_row.pressure * stretch;
        Some(OfRow {
            normal: found.normal,
            gap: found.gap,
            pressure,
            traction: found.direction * pressure + on_row.shear * stretch,
            multiplier: raw.pressure * stretch,
            multiplier_traction: (found.direction * raw.pressure + raw.shear) * stretch,
            slip: self.history.slip(row),
            elastic_slip: found.elastic_slip,
            damage: found.damage,
            heat: found.heat.map(|value| value * stretch),
        })
    }

    /// Adds a row to the nodes whose functions are parts of its own.
    fn add_to_guests(
        &self,
        row: usize,
        reported: &RowReport,
        pressure: f64,
        of_row: Option<&OfRow>,
        sums: &mut Sums,
    ) {
        let Some(averaged) = self.parts.discretization.capabilities().averaged else {
            return;
        };
        let pair = &self.parts.pair;
        sums.guests.clear();
        averaged.guests(row, pair, &self.now, &mut sums.guests);
        for node in &sums.guests {
            if let (Ok(k), Some(of_row)) = (pair.points.binary_search(node), of_row) {
                let report = &mut sums.report;
                sums.means.add(k, reported.area, of_row);
                report.status[k] = reported.status;
                report.acts[k] = reported.status.is_closed();
                report.pressure_peak[k] = report.pressure_peak[k].max(pressure);
                sums.taken.push(k);
            }
        }
    }

    /// Adds a row to the nodes of its point, and to the footprint.
    fn add_to_nodes(
        &self,
        row: usize,
        state: &State,
        (reported, pressure): (&RowReport, f64),
        of_row: Option<&OfRow>,
        sums: &mut Sums,
    ) {
        let &RowReport {
            status,
            acts,
            area,
            energy,
            ..
        } = reported;
        let discretization = &self.parts.discretization;
        let inside = discretization.capabilities().inside.is_some();
        let point = discretization.point(row);
        let report = &mut sums.report;
        let place = point.position(&state.placement());
        if let Some(of_row) = of_row.filter(|_| status.is_closed()) {
            report.footprint.area += area;
            report.footprint.center += place * area;
            report.footprint.normal += of_row.normal * area;
        }
        // shares of a point's area: those of a lumped mass
        let squares: f64 = point.weights.iter().map(|w| w * w).sum();
        for (node, shape) in point.nodes.iter().zip(point.weights) {
            let Ok(k) = self.parts.pair.points.binary_search(node) else {
                continue;
            };
            report.pressure_peak[k] = report.pressure_peak[k].max(pressure);
            let share = area * shape * shape / squares;
            report.area[k] += share;
            report.energy[k] += energy * shape * shape / squares;
            match of_row {
                Some(of_row) => sums.means.add(k, share, of_row),
                // a node that meets nothing may still lean on another one
                None if inside => sums.means.add_nothing(k, share),
                None => {}
            }
            if status.number() > report.status[k].number() {
                report.status[k] = status;
            }
            // a multiplier acts where it is zero, too
            report.acts[k] |= status.is_closed() || acts && self.nmultiplier() == 0;
        }
    }

    /// The reports of rows, and the pressures on them; adds up their forces.
    fn report_rows(
        &self,
        state: &State,
        (report, first): (&mut ContactFrame, Option<usize>),
        frame: &mut Frame,
    ) -> Result<(Vec<RowReport>, Vec<OnRow>), TermError> {
        let nrow = self.parts.discretization.nrow();
        let averaged = self.parts.discretization.capabilities().averaged;
        let mut scratch = Scratch::default();
        let mut gap_min: Option<f64> = None;
        let mut centre = (Vec3::ZERO, 0.0);
        let (mut all, mut on_rows) = (Vec::with_capacity(nrow), Vec::with_capacity(nrow));
        for row in 0..nrow {
            let acts = self.reported_row(row, state, &mut scratch.rows)?;
            let coverage = scratch.rows.rows().first().map_or(1.0, |r| r.coverage);
            let present = self.area(row) * coverage;
            // a point of a rule may have no area at all
            let per_area = match self.parts.measure {
                Measure::Area => 1.0,
                Measure::Node => present.recip(),
            };
            // pressures of small strain are those of the areas at the start, as areas of rows that do not act are
            let stretched = averaged.filter(|_| acts && !self.step.nonlinear);
            let stretch = stretched.map_or(1.0, |of| of.stretch(row, &self.now));
            let area = present / stretch;
            let mut reported = RowReport {
                acts,
                area,
                stretch,
                ..RowReport::default()
            };
            let mut on_row = OnRow::default();
            if let Some(filled) = scratch.rows.rows().first() {
                let mut gap = filled.gap;
                reported.status = Status::Open;
                let (mut elastic_slip, mut direction) = (Vec3::ZERO, Vec3::ZERO);
                let damage = self.damage(filled).unwrap_or_default();
                if acts {
                    let lambda = self.lambda(row, state);
                    let traction = self.traction(filled, &lambda);
                    if filled.worn.is_some() {
                        gap = (self.laws_of(row)).seen_by_law(filled.seen(), traction.pressure);
                    }
                    reported.energy = self.measure(row) * self.stored(filled, &lambda, &traction);
                    elastic_slip = match self.parts.bond {
                        Some(_) => filled.within(filled.sliding.slip),
                        None => self.laws().elastic(&traction),
                    };
                    let measure = self.measure(row) * coverage;
                    on_row.pressure = traction.pressure * per_area;
                    let pushed = self.pushed(&scratch.rows, filled, state);
                    // facets that do not lie in one plane push in several directions
                    direction = pushed.force / filled.coverage;
                    on_row.shear = -traction.tangential * per_area;
                    let push = traction.pressure * self.measure(row);
                    report.force_normal += pushed.force * push;
                    report.moment_normal += pushed.moment * push;
                    report.force_shear -= traction.tangential * measure;
                    reported.status = self.status(traction.state, on_row.pressure, damage);
                }
                gap_min = Some(gap_min.map_or(gap, |least| least.min(gap)));
                reported.found = Some(Found {
                    normal: filled.normal,
                    gap,
                    direction,
                    elastic_slip,
                    damage,
                    heat: [0.0; 3],
                });
            }
            let weight = on_row.pressure * present;
            let point = self.parts.discretization.point(row);
            centre.0 += point.position(&state.placement()) * weight;
            centre.1 += weight;
            match reported.status {
                Status::Absent | Status::Open => report.area_open += area,
                Status::Stick | Status::Tied => report.area_stick += area,
                Status::Slip => report.area_slip += area,
            }
            if acts {
                self.add_forces((row, None), state, Order::Residual, &mut scratch);
                let forces = (&scratch.rows, &scratch.force[..]);
                self.distribute(forces, state, (report, first), frame);
            }
            if let (Some(warmth), Some(found)) = (&mut report.warmth, &mut reported.found) {
                let heat = self.warmth_of(row, state, &mut scratch)?;
                let measure = self.measure(row) * coverage;
                warmth.through += measure * heat[0];
                warmth.rubbed += measure * heat[2];
                found.heat = heat.map(|value| value * per_area);
            }
            all.push(reported);
            on_rows.push(on_row);
        }
        report.gap_min = gap_min.unwrap_or(0.0);
        if centre.1 > 0.0 {
            report.center = centre.0 / centre.1;
        }
        Ok((all, on_rows))
    }

    /// What a row that acts does, under a pressure.
    fn status(&self, state: Contact, pressure: f64, damage: f64) -> Status {
        let bond = self.parts.bond.is_some();
        match state {
            _ if pressure <= 0.0 && !bond => Status::Open,
            Contact::Open => Status::Open,
            Contact::Stick if bond && damage < 1.0 => Status::Tied,
            Contact::Stick => Status::Stick,
            Contact::Slip => Status::Slip,
        }
    }

    /// Adds a point that touches to the sums over its face.
    fn add_inside(
        &self,
        row: usize,
        area: f64,
        energy: f64,
        of_row: &OfRow,
        faces: &mut Vec<(Face, ContactSample)>,
    ) {
        let parts = &self.parts;
        let inside = parts.discretization.capabilities().inside;
        let point = inside.and_then(|points| points.get(row));
        let secondary = parts.pair.secondary.as_ref();
        let Some(face) = point.and_then(|point| secondary?.face(point.facet)) else {
            return;
        };
        // rows of a face follow one another
        if faces.last().is_none_or(|(last, _)| *last != face) {
            faces.push((face, ContactSample::default()));
        }
        let Some((_, sum)) = faces.last_mut() else {
            return;
        };
        sum.area += area;
        sum.normal += of_row.normal * area;
        sum.gap += of_row.gap * area;
        sum.pressure += of_row.pressure * area;
        sum.traction += of_row.traction * area;
        sum.slip += (of_row.slip + of_row.elastic_slip) * area;
        sum.energy += energy;
    }

    /// What a unit of pressure does to the secondary side; moment about the origin.
    pub(super) fn pushed(&self, rows: &Rows, filled: &Row, state: &State) -> Resultant {
        let secondary = rows.secondary();
        let mut sum = Resultant::default();
        let mut column = 0;
        for (place, participant) in rows.participants().iter().enumerate() {
            if let Some(&[x, y, z]) = filled.weights.get(column..column + 3)
                && let Participant::Node(node) = *participant
                && secondary.contains(&place)
            {
                let force = Vec3::new(x, y, z);
                add(&mut sum, force, self.place(node, state).cross(force));
            }
            column += participant.ncolumn();
        }
        sum
    }

    /// Where forces on a node act: at the start, in linear steps whose pairs stay.
    fn place(&self, node: NodeId, state: &State) -> Vec3 {
        let x = state.x.get(node as usize).copied().unwrap_or_default();
        if !self.step.nonlinear && self.parts.discretization.capabilities().keeps_weights() {
            x - self.displacement(node, state)
        } else {
            x
        }
    }

    /// The energy in the springs of a row, over its measure.
    fn stored(&self, filled: &Row, lambda: &Lambda, traction: &Traction) -> f64 {
        let laws = self.laws();
        if laws.bond {
            return laws.bond_energy(filled, &self.past_of_increment(filled.number));
        }
        let stretched = match self.step.scheme {
            // what has slipped in the increment is spent
            Some(_) => laws.elastic(traction),
            None => filled.sliding.slip,
        };
        let along = match laws.friction {
            Some(_) => 0.5 * traction.tangential.dot(stretched),
            None => 0.0,
        };
        let scalar = laws.scalar(filled.normal, lambda);
        let across = match self.nmultiplier() {
            0 => {
                let seen = laws.seen_by_law(filled.seen(), traction.pressure);
                laws.law.energy(seen, scalar, laws.scale)
            }
            _ => None,
        };
        along + across.unwrap_or(0.0)
    }

    /// Adds a row to the means at the nodes of the facet that it acts on.
    fn add_across(
        &self,
        row: usize,
        state: &State,
        area: f64,
        of_row: OfRow,
        nodes: &[NodeId],
        means: &mut Means,
    ) -> Result<(), TermError> {
        let surface = self.parts.pair.primary.as_ref();
        let Some(found) = &self.now.pairs[row] else {
            return Ok(());
        };
        let mut jet = SurfaceJet::default();
        surface
            .jet(&state.placement(), &found.anchor, &mut jet)
            .map_err(|e| self.failed(&e))?;
        let Carrier::Nodes(facet) = surface.carrier(found.anchor.facet) else {
            return Ok(());
        };
        let reaction = OfRow {
            traction: -of_row.traction,
            multiplier_traction: -of_row.multiplier_traction,
            heat: [-of_row.heat[0], of_row.heat[1], of_row.heat[2]],
            ..of_row
        };
        for (node, shape) in facet.iter().zip(jet.shape) {
            if let Ok(k) = nodes.binary_search(node) {
                means.add(k, area * shape * shape, &reaction);
            }
        }
        Ok(())
    }

    fn new_report(&self, state: &State) -> ContactFrame {
        let pair = &self.parts.pair;
        let inside = self.parts.discretization.capabilities().inside;
        let n = pair.points.len();
        let of = |&node: &NodeId| state.x.get(node as usize).copied().unwrap_or_default();
        let moved = |&node: &NodeId| self.displacement(node, state);
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
            normal: vec![Vec3::ZERO; n],
            gap: vec![f64::NAN; n],
            pressure: vec![0.0; n],
            pressure_peak: vec![0.0; n],
            multiplier: vec![0.0; n],
            multiplier_traction: vec![Vec3::ZERO; n],
            status: vec![Status::Absent; n],
            acts: vec![false; n],
            force: vec![Vec3::ZERO; n],
            traction: vec![Vec3::ZERO; n],
            slip: vec![Vec3::ZERO; n],
            elastic_slip: vec![Vec3::ZERO; n],
            energy: vec![0.0; n],
            faces: inside.map(|_| Vec::new()),
            area: vec![0.0; n],
            damage: self
                .parts
                .cohesion
                .as_ref()
                .map_or_else(Vec::new, |_| vec![0.0; n]),
            facet_size: self.parts.scale.length,
            reported_as: self.parts.reported_as.clone(),
            drift: self.drift,
            warmth: self.heat().map(|_| ContactWarmth::new(n)),
            ..ContactFrame::default()
        }
    }

    pub(super) fn displacement(&self, node: NodeId, state: &State) -> Vec3 {
        let mut u = Vec3::ZERO;
        for axis in 0..self.layout.ndim() {
            let dof = self.layout.node(node, axis) as usize;
            u[axis] = state.u.get(dof).copied().unwrap_or_default();
        }
        u
    }

    /// Adds the forces of a row to the nodes, the resultants of both sides, and the rigid bodies; and to the nodes of
    /// the first pass, where this is the second.
    fn distribute(
        &self,
        (rows, internal): (&Rows, &[f64]),
        state: &State,
        (report, first): (&mut ContactFrame, Option<usize>),
        frame: &mut Frame,
    ) {
        let mut column = 0;
        let vector = |at: usize| {
            let part = internal.get(at..at + 3);
            part.map_or(Vec3::ZERO, |f| -Vec3::new(f[0], f[1], f[2]))
        };
        let secondary = rows.secondary();
        for (place, participant) in rows.participants().iter().enumerate() {
            let force = vector(column);
            match *participant {
                Participant::Node(node) => {
                    let x = self.place(node, state);
                    let side = if secondary.contains(&place) {
                        if let Ok(k) = self.parts.pair.points.binary_search(&node) {
                            report.force[k] += force;
                        }
                        &mut report.secondary
                    } else {
                        if let Some(first) = first.and_then(|c| frame.contacts.get_mut(c))
                            && let Ok(k) = first.nodes.binary_search(&node)
                        {
                            first.force[k] += force;
                        }
                        &mut report.primary
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
