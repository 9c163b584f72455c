//! `NAME.dat`: what the steps ask to be printed, increment by increment.

#[cfg(test)]
mod tests;

use crate::setup::{
    ContactQuantity, ElementQuantity, Model, NodeQuantity, Printed, PrintedContact, PrintedFace,
    PrintedOf,
};
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::case::{Position, Space, Totals};
use signorini_io::writers::dat::{
    ContactKind, Kind, Of, Page, Points, Statistics, WEDGE, tangents, tensor,
};
use signorini_mechanics::load::{Region, Section};
use signorini_mechanics::solve::IncrementRecord;
use signorini_mechanics::system::{
    ContactFrame, ContactSample, Footprint, Frame, PointSample, Resultant, RigidBody, Samples,
    SpinFrame,
};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// The tables of a run.
#[derive(Debug)]
pub struct Tables {
    steps: Vec<Vec<Printed>>,
    mesh: Arc<Mesh>,
    // whether the model is one of revolution, and the cells that are
    revolved: bool,
    revolving: BTreeSet<CellId>,
    // cells around nodes of bodies of revolution whose forces are printed, and steps of large strain
    around: Vec<CellId>,
    nonlinear: Vec<bool>,
    // nodes of the mesh that stand for references
    references: HashMap<NodeId, Stand>,
    // what moves with each of them
    followers: Vec<RigidBody>,
}

/// What a node of the mesh stands for.
#[derive(Clone, Copy, Debug)]
struct Stand {
    rigid: RigidId,
    /// Whether for its rotations, not its translations.
    turns: bool,
}

impl Tables {
    /// The tables of every step of a model.
    pub fn new(model: &Model) -> Self {
        let revolved = *model.case.model.space == Space::Axisymmetric;
        Self {
            steps: model.prints.clone(),
            mesh: Arc::clone(&model.mesh),
            revolved,
            revolving: model.revolving.clone(),
            around: model.hoops.clone(),
            nonlinear: model.steps.iter().map(|step| step.nonlinear).collect(),
            references: references(model),
            followers: model.system.elimination.bodies().to_vec(),
        }
    }

    /// Whether no step asks for any.
    pub fn is_empty(&self) -> bool {
        self.steps.iter().all(Vec::is_empty)
    }

    /// What is printed after an increment; `None` where nothing is.
    pub fn page(&self, record: &IncrementRecord, frame: &Frame) -> Option<Page> {
        let (time, duration) = record.step_time;
        let is_due = |one: &&Printed| {
            time >= duration || (record.increment as u64).is_multiple_of(one.every)
        };
        let tables = self.steps.get(record.step)?;
        let mut due = tables.iter().filter(is_due).peekable();
        due.peek()?;
        let page = Page::new(record.step + 1, record.increment, record.time);
        let mut writer = Writer {
            tables: self,
            frame,
            page,
            points: HashMap::new(),
            hoop: self.hoop(record.step, frame),
        };
        for one in due {
            match &one.what {
                PrintedOf::Nodes(nodes, quantities) => {
                    quantities.iter().for_each(|q| writer.nodes(one, nodes, *q));
                }
                PrintedOf::Elements(cells, quantities) => {
                    let quantities = quantities.iter();
                    quantities.for_each(|q| writer.elements(one, cells, *q));
                }
                PrintedOf::Contacts(contacts, quantities) => {
                    let quantities = quantities.iter();
                    quantities.for_each(|q| writer.contacts(one, contacts, *q));
                }
                PrintedOf::Faces(faces) => {
                    let nonlinear = self.nonlinear.get(record.step).is_some_and(|is| *is);
                    writer.section(&one.set, faces, nonlinear);
                }
            }
        }
        Some(writer.page)
    }

    /// What hoop stresses do to the radial forces of bodies of revolution, `∫ σ_θθ N/r dv` at each node: CalculiX adds up
    /// forces along x over its wedge, and that part, across x, is not among them.
    fn hoop(&self, step: usize, frame: &Frame) -> HashMap<NodeId, f64> {
        let mut hoop = HashMap::new();
        let nonlinear = self.nonlinear.get(step).is_some_and(|is| *is);
        let mut shape = Vec::new();
        for &cell in &self.around {
            let (Some(element), Some((rule, samples))) =
                (self.mesh.element(cell), frame.samples.of(cell))
            else {
                continue;
            };
            let nodes = self.mesh.cell(cell);
            shape.resize(element.nnode(), 0.0);
            for (xi, sample) in rule.points.iter().zip(samples) {
                element.shape(xi, &mut shape);
                let x = |node: &NodeId| self.mesh.points.get(*node as usize).map_or(0.0, |x| x.x);
                let radius: f64 = nodes.iter().zip(&shape).map(|(node, n)| n * x(node)).sum();
                // dv/r = J dV/(F_θθ R)
                let stretch = Sym3::IDENTITY + sample.strain * 2.0;
                let growth = match nonlinear {
                    true => (stretch.to_mat3().determinant() / stretch.zz()).sqrt(),
                    false => 1.0,
                };
                let force = sample.stress.zz() * sample.volume * growth / radius;
                for (&node, n) in nodes.iter().zip(&shape) {
                    *hoop.entry(node).or_default() += n * force;
                }
            }
        }
        hoop
    }

    /// What is printed of forces, energies and volumes.
    fn share(&self) -> f64 {
        if self.revolved { WEDGE } else { 1.0 }
    }
}

/// A number along a normal, and a vector along the tangents that belong to it.
fn along(across: f64, vector: Vec3, normal: Vec3) -> [f64; 3] {
    let [first, second] = tangents(normal);
    [across, vector.dot(first), vector.dot(second)]
}

/// The nodes of the mesh that stand for references, or for their rotations. A node of a solid speaks for itself, unless
/// its reference carries something: a motion along axes of its own has a reference where it is, too.
fn references(model: &Model) -> HashMap<NodeId, Stand> {
    let mesh = &model.mesh;
    let solid: HashSet<NodeId> = mesh
        .cells(mesh.dim())
        .flat_map(|cell| mesh.cell(cell).iter().copied())
        .collect();
    let bodies = model.system.elimination.bodies();
    let carries = |rigid: RigidId| {
        let body = bodies.get(rigid as usize);
        body.is_some_and(|body| !body.nodes.is_empty())
    };
    let mut all = HashMap::new();
    for reference in &model.case.references {
        let mut known = model.references.iter();
        let Some(known) = known.find(|one| one.name == reference.name.value) else {
            continue;
        };
        let place = match reference.position {
            Position::Node(label) => model.node(label),
            Position::At(_) | Position::Mean => None,
        };
        let rotations = reference.rotations.and_then(|label| model.node(label));
        for (node, turns) in [(place, false), (rotations, true)] {
            let rigid = known.rigid;
            let node = node.filter(|node| carries(rigid) || !solid.contains(node));
            all.extend(node.map(|node| (node, Stand { rigid, turns })));
        }
    }
    all
}

/// Fills a page.
struct Writer<'a> {
    tables: &'a Tables,
    frame: &'a Frame,
    page: Page,
    // by element, number of points and whether it revolves
    points: HashMap<(&'static str, usize, bool), Points>,
    hoop: HashMap<NodeId, f64>,
}

impl Writer<'_> {
    fn nodes(&mut self, one: &Printed, nodes: &[NodeId], quantity: NodeQuantity) {
        let at = |values: &[Vec3], node: NodeId| values.get(node as usize).copied();
        let share = self.tables.share();
        match quantity {
            NodeQuantity::Displacement => {
                self.page.table(Kind::Displacements, &one.set);
                for (k, &node) in nodes.iter().enumerate() {
                    let stand = self.tables.references.get(&node);
                    let rigid = stand.and_then(|s| self.frame.rigid.get(s.rigid as usize));
                    let u = match stand.zip(rigid) {
                        Some((stand, rigid)) if stand.turns => rigid.rotation,
                        Some((_, rigid)) => rigid.displacement,
                        None => at(&self.frame.displacement, node).unwrap_or_default(),
                    };
                    self.vector(one, k, node, u);
                }
            }
            NodeQuantity::Temperature => {
                self.page.table(Kind::Temperatures, &one.set);
                for &node in nodes {
                    let t = self.frame.temperature.get(node as usize).copied();
                    self.page.row(self.node(node), &[t.unwrap_or_default()]);
                }
            }
            NodeQuantity::HeatReaction => {
                let heat = |node: &NodeId| self.frame.internal_heat.get(*node as usize).copied();
                let heat = |node: &NodeId| heat(node).unwrap_or_default() * share;
                if one.totals != Totals::Only {
                    self.page.table(Kind::Heat, &one.set);
                    for node in nodes {
                        self.page.row(self.node(*node), &[heat(node)]);
                    }
                }
                if one.totals != Totals::No {
                    self.page.table(Kind::TotalHeat, &one.set);
                    self.page.row(Of::All, &[nodes.iter().map(heat).sum()]);
                }
            }
            NodeQuantity::Reaction => {
                let force = |node: NodeId| {
                    if let Some(stand) = self.tables.references.get(&node) {
                        return self.carried(*stand) * share;
                    }
                    let mut force = at(&self.frame.internal_force, node).unwrap_or_default();
                    force.x -= self.hoop.get(&node).copied().unwrap_or(0.0);
                    force * share
                };
                let forces: Vec<Vec3> = nodes.iter().map(|node| force(*node)).collect();
                if one.totals != Totals::Only {
                    self.page.table(Kind::Forces, &one.set);
                    for (k, (&node, force)) in nodes.iter().zip(&forces).enumerate() {
                        self.vector(one, k, node, *force);
                    }
                }
                if one.totals != Totals::No {
                    let total: Vec3 = forces.iter().copied().sum();
                    self.page.table(Kind::TotalForce, &one.set);
                    self.page.row(Of::All, &total.to_array());
                }
            }
        }
    }

    /// A vector at the node in place k of a table.
    fn vector(&mut self, one: &Printed, k: usize, node: NodeId, vector: Vec3) {
        let label = self.tables.mesh.node_labels.get(node as usize);
        let label = label.copied().unwrap_or_default();
        match one.axes.get(k).copied().flatten() {
            Some(axes) => {
                let along = axes.map(|axis| vector.dot(axis));
                self.page.row(Of::Local(label), &along);
            }
            None => self.page.row(Of::One(label), &vector.to_array()),
        }
    }

    /// The force of all nodes that move with a reference, or its moment about it; of one that nodes do not simply move
    /// with, what supports exert on it.
    fn carried(&self, stand: Stand) -> Vec3 {
        let (Some(body), Some(rigid)) = (
            self.tables.followers.get(stand.rigid as usize),
            self.frame.rigid.get(stand.rigid as usize),
        ) else {
            return Vec3::ZERO;
        };
        if body.nodes.is_empty() {
            return match stand.turns {
                true => rigid.reaction_moment,
                false => rigid.reaction_force,
            };
        }
        let centre = body.reference + rigid.displacement;
        let of_node = |&node: &NodeId| {
            let at = |values: &[Vec3]| values.get(node as usize).copied().unwrap_or_default();
            let force = at(&self.frame.internal_force);
            match stand.turns {
                true => (at(&self.tables.mesh.points) + at(&self.frame.displacement) - centre)
                    .cross(force),
                false => force,
            }
        };
        body.nodes.iter().map(of_node).sum()
    }

    fn elements(&mut self, one: &Printed, cells: &[CellId], quantity: ElementQuantity) {
        match quantity {
            ElementQuantity::Stress => {
                self.tensors(Kind::Stresses, one, cells, |s| s.stress);
            }
            ElementQuantity::Strain => {
                self.tensors(Kind::Strains, one, cells, |s| s.strain);
            }
            ElementQuantity::MechanicalStrain => {
                let kind = Kind::MechanicalStrains;
                self.tensors(kind, one, cells, |s| s.mechanical_strain);
            }
            ElementQuantity::PlasticStrain => {
                // never negative, carried to other points or not
                let value = |at: f64| at.max(0.0);
                let of = |s: &PointSample| s.plastic_strain;
                self.scalars(Kind::PlasticStrains, &one.set, cells, of, value);
            }
            ElementQuantity::EnergyDensity => {
                let of = |s: &PointSample| s.energy;
                self.scalars(Kind::EnergyDensities, &one.set, cells, of, |at| at);
            }
            ElementQuantity::Energy => {
                let kinds = [Kind::Energies, Kind::TotalEnergy];
                self.sums(kinds, one, cells, |s| s.energy * s.volume);
            }
            ElementQuantity::Volume => {
                let kinds = [Kind::Volumes, Kind::TotalVolume];
                self.sums(kinds, one, cells, |s| s.volume);
            }
            ElementQuantity::SpinSquared => self.spins(&one.set, cells),
            ElementQuantity::HeatFlux => {
                self.page.table(Kind::HeatFluxes, &one.set);
                let fluxes = &self.frame.heat_samples;
                self.at_points(fluxes, cells, |page, of_point, points, place, samples| {
                    let value = |p: usize| samples.get(p).copied().unwrap_or_default();
                    page.row(of_point, &points.vector(place, value).to_array());
                });
            }
        }
    }

    /// The squared angular velocity of the last centrifugal load that acts on each element, zero without one. One of
    /// that name goes on in a later step as another load while the first one fades: both together are meant.
    fn spins(&mut self, set: &str, cells: &[CellId]) {
        self.page.table(Kind::Spins, set);
        let frame = self.frame;
        for cell in cells {
            let here = |spin: &&SpinFrame| spin.cells.binary_search(cell).is_ok();
            let acts = |spin: &&SpinFrame| here(spin) && spin.square != 0.0;
            let last = frame.spins.iter().rfind(acts);
            let of_name = |spin: &&SpinFrame| last.is_some_and(|last| last.name == spin.name);
            let together = frame.spins.iter().filter(here).filter(of_name);
            let square = together.fold(0.0, |sum, spin| sum + spin.square);
            self.page.row(Of::One(self.label(*cell)), &[square]);
        }
    }

    /// Tensors at points; along the axes of the undeformed material where that is wanted and the material has some.
    fn tensors(
        &mut self,
        kind: Kind,
        one: &Printed,
        cells: &[CellId],
        of: fn(&PointSample) -> Sym3,
    ) {
        self.page.table(kind, &one.set);
        let axes = |s: &PointSample| s.axes.filter(|_| one.local);
        let samples = &self.frame.samples;
        self.at_points(samples, cells, |page, of_point, points, place, samples| {
            let value = |s: &PointSample| match axes(s) {
                Some(axes) => of(s).congruence(axes),
                None => of(s),
            };
            let value = points.tensor(place, |p| samples.get(p).map_or(Sym3::ZERO, value));
            let of_point = match of_point {
                Of::Point(cell, point) if samples.iter().any(|s| axes(s).is_some()) => {
                    Of::LocalPoint(cell, point)
                }
                other => other,
            };
            page.row(of_point, &tensor(&value));
        });
    }

    fn scalars(
        &mut self,
        kind: Kind,
        set: &str,
        cells: &[CellId],
        of: fn(&PointSample) -> f64,
        take: fn(f64) -> f64,
    ) {
        self.page.table(kind, set);
        let samples = &self.frame.samples;
        self.at_points(samples, cells, |page, of_point, points, place, samples| {
            let value = points.scalar(place, |p| samples.get(p).map_or(0.0, of));
            page.row(of_point, &[take(value)]);
        });
    }

    /// Hands over every printed point of these cells.
    fn at_points<S>(
        &mut self,
        sampled: &Samples<S>,
        cells: &[CellId],
        mut put: impl FnMut(&mut Page, Of, &Points, usize, &[S]),
    ) {
        for &cell in cells {
            let Some((rule, samples)) = sampled.of(cell) else {
                continue;
            };
            let label = self.label(cell);
            let Self {
                page,
                points,
                tables,
                ..
            } = self;
            let Some(element) = tables.mesh.element(cell) else {
                continue;
            };
            let revolves = tables.revolving.contains(&cell);
            let new = || Points::new(element.name(), rule, revolves);
            let key = (element.name(), rule.npoint(), revolves);
            let points = points.entry(key).or_insert_with(new);
            for place in 0..points.len() {
                put(page, Of::Point(label, place + 1), points, place, samples);
            }
        }
    }

    /// A table of integrals over each cell, and their sum.
    fn sums(
        &mut self,
        [each, all]: [Kind; 2],
        one: &Printed,
        cells: &[CellId],
        of: fn(&PointSample) -> f64,
    ) {
        let share = self.tables.share();
        let integral =
            |(_, samples): (&Rule, &[PointSample])| samples.iter().map(of).sum::<f64>() * share;
        let sampled = |cell: &CellId| Some((*cell, self.frame.samples.of(*cell).map(integral)?));
        let values: Vec<(CellId, f64)> = cells.iter().filter_map(sampled).collect();
        if one.totals != Totals::Only {
            self.page.table(each, &one.set);
            for (cell, value) in &values {
                self.page.row(Of::One(self.label(*cell)), &[*value]);
            }
        }
        if one.totals != Totals::No {
            self.page.table(all, &one.set);
            let total = values.iter().map(|(_, value)| value).sum();
            self.page.row(Of::All, &[total]);
        }
    }

    fn contacts(&mut self, one: &Printed, contacts: &[PrintedContact], quantity: ContactQuantity) {
        let share = self.tables.share();
        let frames = &self.frame.contacts;
        let frame = |part: &&PrintedContact| frames.iter().find(|c| c.name == part.name);
        let acting: Vec<&ContactFrame> = contacts.iter().filter_map(|c| frame(&c)).collect();
        match quantity {
            ContactQuantity::Gap => {
                let kinds = [ContactKind::Gaps, ContactKind::FaceGaps];
                self.closed(kinds, &acting, |at| along(at.gap, at.slip, at.normal));
            }
            ContactQuantity::Traction => {
                let kinds = [ContactKind::Tractions, ContactKind::FaceTractions];
                self.closed(kinds, &acting, |at| {
                    along(at.pressure, -at.traction, at.normal)
                });
            }
            ContactQuantity::Energy => {
                if one.totals != Totals::Only {
                    let kinds = [ContactKind::Energies, ContactKind::FaceEnergies];
                    self.closed(kinds, &acting, |at| [at.energy * share]);
                }
                if one.totals != Totals::No {
                    let total: f64 = acting.iter().flat_map(|c| &c.energy).sum();
                    self.page.contact_table(ContactKind::TotalEnergy);
                    self.page.row(Of::All, &[total * share]);
                }
            }
            ContactQuantity::Count => {
                self.page.contact_table(ContactKind::Count);
                let of = |c: &&ContactFrame| c.acts.iter().filter(|acts| **acts).count();
                self.page.count(acting.iter().map(of).sum());
            }
            ContactQuantity::Force => self.resultants(contacts, |c| c.secondary),
            ContactQuantity::NormalForce => self.resultants(contacts, |c| Resultant {
                force: c.force_normal,
                moment: c.moment_normal,
            }),
            ContactQuantity::ShearForce => self.resultants(contacts, |c| Resultant {
                force: c.force_shear,
                moment: c.secondary.moment - c.moment_normal,
            }),
        }
    }

    /// A table of the nodes of contacts at which something acts, and one of faces of those that have their points inside.
    fn closed<const N: usize>(
        &mut self,
        [of_nodes, of_faces]: [ContactKind; 2],
        contacts: &[&ContactFrame],
        numbers: impl Fn(&ContactSample) -> [f64; N],
    ) {
        let (inside, at_nodes): (Vec<&ContactFrame>, Vec<_>) =
            contacts.iter().partition(|c| c.faces.is_some());
        if !at_nodes.is_empty() || inside.is_empty() {
            self.page.contact_table(of_nodes);
        }
        for contact in at_nodes {
            let nodes = contact.nodes.iter().zip(&contact.acts).enumerate();
            for (k, (&node, _)) in nodes.filter(|(_, (_, acts))| **acts) {
                let sample = ContactSample {
                    normal: contact.normal[k],
                    gap: contact.gap[k],
                    pressure: contact.pressure[k],
                    traction: contact.traction[k],
                    slip: contact.slip[k] + contact.elastic_slip[k],
                    energy: contact.energy[k],
                    ..ContactSample::default()
                };
                self.page.row(self.node(node), &numbers(&sample));
            }
        }
        if !inside.is_empty() {
            self.page.contact_table(of_faces);
        }
        for (face, one) in inside.iter().flat_map(|c| c.faces.iter().flatten()) {
            let of = Of::Side(self.label(face.cell), face.side as usize + 1);
            self.page.row(of, &numbers(one));
        }
    }

    /// What each contact feels.
    fn resultants(&mut self, contacts: &[PrintedContact], of: fn(&ContactFrame) -> Resultant) {
        let share = self.tables.share();
        for part in contacts {
            let Some(contact) = self.frame.contacts.iter().find(|c| c.name == part.name) else {
                continue;
            };
            let Resultant { force, moment } = of(contact);
            let Footprint {
                area,
                center,
                normal,
            } = contact.footprint;
            let statistics = Statistics {
                force: force * share,
                moment: moment * share,
                center,
                normal: -normal,
                area: area * share,
            };
            let (page, secondary) = (&mut self.page, &part.secondary);
            page.statistics(secondary, &part.primary, &statistics);
        }
    }

    /// What stresses do on faces: in their present places where displacements are large.
    fn section(&mut self, set: &str, faces: &[PrintedFace], nonlinear: bool) {
        let (mesh, share) = (&self.tables.mesh, self.tables.share());
        let mut region = Region::default();
        for of in faces {
            if let Some((element, nodes)) = mesh.face(of.face) {
                let rule = element.surface_rule();
                let across = (of.space, of.profile.as_deref());
                region.push_by((element, rule), across, &nodes, 1.0);
            }
        }
        let mut places = mesh.points.clone();
        if nonlinear {
            let moves = places.iter_mut().zip(&self.frame.displacement);
            moves.for_each(|(x, u)| *x += *u);
        }
        let section = Section::new(&region, &places, &self.frame.stress);
        let statistics = Statistics {
            force: section.force * share,
            moment: section.moment * share,
            center: section.center,
            normal: section.normal,
            area: section.area * share,
        };
        self.page.section(set, &statistics);
    }

    fn node(&self, node: NodeId) -> Of {
        let label = self.tables.mesh.node_labels.get(node as usize);
        Of::One(label.copied().unwrap_or_default())
    }

    fn label(&self, cell: CellId) -> u64 {
        self.tables.mesh.cell_label(cell).unwrap_or_default()
    }
}
