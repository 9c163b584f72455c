//! Loads of all steps, as terms.

use super::label::label;
use super::substance::Substance;
use super::{ActivityError, Context, LoadPart, ModelError};
use crate::load::{
    Acting, Course, Domain, Effect, LoadError, NodalForces, Place, Region, Schedule, Site, Weight,
};
use crate::solid::Integration;
use crate::solve::Step;
use crate::system::{CellChange, Dof, Idealisation, NO_DOF, StepContext, Term};
use signorini_geometry::mesh::{CellId, Face, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// The terms of these loads, given step by step.
pub(super) fn terms(
    context: &Context<'_>,
    steps: &[Step],
    loads: Vec<Vec<LoadPart>>,
) -> Result<Vec<Box<dyn Term>>, ModelError> {
    let mut terms = Vec::new();
    for (part, schedule) in schedules(steps, loads)? {
        for (part, schedule) in context.parts_of(part, schedule, steps)? {
            match part.load.place {
                Place::Points => terms.extend(context.on_points(&part, &schedule, steps)?),
                _ => terms.extend(context.load(&part, schedule, steps)?),
            }
        }
    }
    Ok(terms)
}

/// The steps as terms see them.
fn contexts(steps: &[Step]) -> Vec<StepContext> {
    let mut start = 0.0;
    let context = |(number, step): (usize, &Step)| {
        let here = step.context(number, start);
        start += step.duration;
        here
    };
    steps.iter().enumerate().map(context).collect()
}

/// Every load ever given, with its factor over time.
fn schedules(
    steps: &[Step],
    loads: Vec<Vec<LoadPart>>,
) -> Result<Vec<(LoadPart, Schedule)>, ModelError> {
    let mut all: Vec<(LoadPart, Schedule)> = Vec::new();
    let contexts = contexts(steps);
    for (number, ((step, here), parts)) in steps.iter().zip(contexts).zip(loads).enumerate() {
        let mut names = BTreeSet::new();
        if let Some(twice) = parts.iter().find(|p| !names.insert(&p.name)) {
            let step = step.name.clone();
            return Err(ModelError::Load {
                load: twice.name.clone(),
                source: LoadError::Twice { step },
            });
        }
        for (before, schedule) in &mut all {
            let Some(after) = parts.iter().find(|p| p.name == before.name) else {
                schedule.stay(&here);
                continue;
            };
            // a table accounts for the earlier load there
            if after.course != Course::Ramp && after.load.is_alike(&before.load) {
                schedule.stop();
            } else {
                schedule.fade();
            }
        }
        for part in parts {
            let mut schedule = Schedule::idle(number);
            schedule.begin(&part.course, &here);
            all.push((part, schedule));
        }
    }
    Ok(all)
}

fn set<T: Copy + Ord>(members: &[T]) -> BTreeSet<T> {
    members.iter().copied().collect()
}

/// In which steps what a load acts on takes part, and in which it fades when it goes.
type Stay = (Vec<bool>, Vec<bool>);

impl Context<'_> {
    /// A load on faces or cells in parts, each of what takes part in the same steps.
    fn parts_of(
        &self,
        part: LoadPart,
        schedule: Schedule,
        steps: &[Step],
    ) -> Result<Vec<(LoadPart, Schedule)>, ModelError> {
        let cells: Vec<CellId> = match &part.load.place {
            Place::Faces(faces) => faces.iter().map(|face| face.cell).collect(),
            Place::Cells(cells) => cells.clone(),
            Place::Nodes(_) | Place::Carrier(_) | Place::Points => Vec::new(),
        };
        if !cells.iter().any(|&cell| self.activity.names(cell)) {
            return Ok(vec![(part, schedule)]);
        }
        let course = |cell: CellId| -> Stay {
            let fades = |step| {
                let change = self.activity.change(cell, step);
                change == Some(CellChange::Removed { ramp: true })
            };
            let ramps = (0..self.activity.nstep()).map(fades);
            (self.activity.course(cell), ramps.collect())
        };
        let mut groups: BTreeMap<Stay, Vec<usize>> = BTreeMap::new();
        for (k, &cell) in cells.iter().enumerate() {
            groups.entry(course(cell)).or_default().push(k);
        }
        if groups.len() > 1 && part.load.load.properties().domain == Domain::FacesOrNodes {
            let load = part.name;
            return Err(ActivityError::TotalOverParts { load }.into());
        }
        let contexts = contexts(steps);
        let of_group = |((active, ramps), members): (Stay, Vec<usize>)| {
            let place = match &part.load.place {
                Place::Faces(faces) => Place::Faces(picked(faces, &members)),
                Place::Cells(cells) => Place::Cells(picked(cells, &members)),
                other => other.clone(),
            };
            let load = Acting {
                place,
                ..part.load.clone()
            };
            let part = LoadPart {
                load,
                ..part.clone()
            };
            (part, schedule.partial(&active, &ramps, &contexts))
        };
        Ok(groups.into_iter().map(of_group).collect())
    }

    /// The term of a load; none where it has no size.
    fn load(
        &self,
        part: &LoadPart,
        schedule: Schedule,
        steps: &[Step],
    ) -> Result<Option<Box<dyn Term>>, ModelError> {
        let name = &part.name[..];
        let named = |source| ModelError::Load {
            load: name.into(),
            source,
        };
        let Acting { load, place } = &part.load;
        let site = match place {
            Place::Carrier(carrier) => {
                let by_mass = load.properties().domain == Domain::Mass;
                let mut heavy = self.heavy.iter().filter(|_| by_mass);
                let body = heavy.find(|body| body.carrier == *carrier);
                let mass = body.map_or(0.0, |body| body.mass);
                let wrench = load.resultant(mass);
                let wrench = wrench.ok_or_else(|| named(LoadError::Misplaced))?;
                if by_mass {
                    let body = *body.ok_or_else(|| named(LoadError::Massless))?;
                    let weight = Weight::new(name, self.layout, body, wrench[0], schedule);
                    return Ok(Some(Box::new(weight)));
                }
                return Ok(self.on_carrier(name, *carrier, wrench, schedule, steps));
            }
            Place::Nodes(nodes) => {
                for &node in nodes {
                    if self.is_loose(node) {
                        let node = label(self.mesh, node);
                        return Err(named(LoadError::Loose { node }));
                    }
                    self.moves(node, steps).map_err(named)?;
                }
                self.site(part, schedule.clone())
            }
            Place::Faces(_) | Place::Cells(_) | Place::Points => self.site(part, schedule.clone()),
        };
        if load.properties().is_heat && !self.layout.has_temperatures() {
            return Err(named(LoadError::NoTemperatures));
        }
        match load.effect(site.map_err(named)?).map_err(named)? {
            Effect::Heats(heats) => {
                let of_node = |(node, heat)| (self.layout.temperature(node), heat);
                let heats = acting(heats.into_iter().map(of_node));
                let term = self.dead(name, &heats, schedule);
                Ok(term.map(|t| Box::new(t) as Box<dyn Term>))
            }
            Effect::Term(term) => Ok(Some(term)),
            Effect::Forces(forces) => {
                let term = self.dead(name, &self.at_nodes(forces), schedule);
                Ok(term.map(|t| Box::new(t) as Box<dyn Term>))
            }
        }
    }

    /// Refuses static steps where nothing but its mass resists a load on a node.
    fn moves(&self, node: NodeId, steps: &[Step]) -> Result<(), LoadError> {
        let is_alone = self.singles.alone.get(node as usize) == Some(&true);
        match is_alone && steps.iter().any(Step::is_static) {
            true => Err(LoadError::Alone {
                node: label(self.mesh, node),
            }),
            false => Ok(()),
        }
    }

    /// A load by mass on rigid bodies, and on masses at nodes that follow none.
    fn on_points(
        &self,
        part: &LoadPart,
        schedule: &Schedule,
        steps: &[Step],
    ) -> Result<Vec<Box<dyn Term>>, ModelError> {
        let (name, load) = (&part.name, &part.load.load);
        let by_mass = load.properties().domain == Domain::Mass;
        let named = |source| ModelError::Load {
            load: name.clone(),
            source,
        };
        let force = |mass: f64| {
            let wrench = load.resultant(mass).filter(|_| by_mass);
            let force = wrench.map(|[force, _]| force);
            force.ok_or_else(|| named(LoadError::Misplaced))
        };
        let mut terms: Vec<Box<dyn Term>> = Vec::new();
        for body in self.heavy.iter() {
            let name = format!("{name} of {}", self.carrier_name(body.carrier));
            let force = force(body.mass)?;
            let weight = Weight::new(name, self.layout, *body, force, schedule.clone());
            terms.push(Box::new(weight));
        }
        let mut forces = Vec::new();
        for &(node, mass) in self.singles.masses {
            if self.elimination.body_of(node).is_none() {
                self.moves(node, steps).map_err(named)?;
                forces.push((node, force(mass)?));
            }
        }
        let dead = self.dead(name, &self.at_nodes(forces), schedule.clone());
        terms.extend(dead.map(|term| Box::new(term) as Box<dyn Term>));
        Ok(terms)
    }

    /// Where a load acts, apart from carriers.
    fn site<'a>(&'a self, part: &'a LoadPart, schedule: Schedule) -> Result<Site<'a>, LoadError> {
        let mut site = Site {
            name: &part.name,
            nodes: &[],
            cells: &[],
            region: Region::default(),
            revolved: false,
            schedule,
            layout: self.layout,
            radiation: self.radiation,
            reference: self.reference,
        };
        match (part.load.load.properties().domain, &part.load.place) {
            (Domain::Nodes | Domain::FacesOrNodes, Place::Nodes(nodes)) => site.nodes = nodes,
            (Domain::Faces | Domain::FacesOrNodes, Place::Faces(faces)) => {
                site.region = self.faces(faces)?;
            }
            (domain @ (Domain::Volume | Domain::Mass), Place::Cells(cells)) => {
                let of_revolution =
                    |&cell: &CellId| self.spaces.of_cell(cell) == Idealisation::Axisymmetric;
                site.revolved = cells.iter().any(of_revolution);
                site.region = self.cells(cells, domain)?;
                site.cells = cells;
            }
            _ => return Err(LoadError::Misplaced),
        }
        Ok(site)
    }

    /// A dead load.
    fn dead(&self, name: &str, forces: &[(Dof, f64)], schedule: Schedule) -> Option<NodalForces> {
        let load = NodalForces::new(name, forces, schedule);
        (!forces.is_empty()).then(|| load.following(&self.elimination, &self.layout))
    }

    /// Forces on nodes as forces on unknowns.
    fn at_nodes(&self, forces: impl IntoIterator<Item = (NodeId, Vec3)>) -> Vec<(Dof, f64)> {
        let components = |(node, force): (NodeId, Vec3)| {
            (0..3).map(move |axis| (self.layout.node(node, axis), force[axis]))
        };
        acting(forces.into_iter().flat_map(components))
    }

    fn on_carrier(
        &self,
        name: &str,
        carrier: RigidId,
        [force, moment]: [Vec3; 2],
        schedule: Schedule,
        steps: &[Step],
    ) -> Option<Box<dyn Term>> {
        let layout = &self.layout;
        let along = (0..3).map(|c| (layout.translation(carrier, c), force[c]));
        let about = (0..3).map(|c| (layout.rotation(carrier, c), moment[c]));
        let turns = acting(about.clone());
        let swivels = steps.iter().map(|step| {
            let held = |dof: Dof| step.prescriptions.iter().any(|p| p.dof == dof);
            let rotations = (0..3).map(|c| layout.rotation(carrier, c));
            let free = rotations.filter(|&dof| dof != NO_DOF && !held(dof)).count();
            step.nonlinear && free > 1 && turns.iter().any(|(dof, _)| !held(*dof))
        });
        let swivels = swivels.collect();
        let load = self.dead(name, &acting(along.chain(about)), schedule)?;
        Some(Box::new(load.swivelling(swivels)))
    }

    /// The body of a cell that a load acts on.
    fn body(&self, cell: CellId) -> Result<&Substance, LoadError> {
        let body = self.owner.get(&cell);
        let body = body.and_then(|&b| self.substances.get(b));
        body.ok_or_else(|| LoadError::Outside {
            element: self.number(cell),
        })
    }

    /// Faces of bodies that a load acts on.
    fn faces(&self, faces: &[Face]) -> Result<Region, LoadError> {
        let mut region = Region::default();
        for &face in &set(faces) {
            let body = self.body(face.cell)?;
            let side = self.mesh.face(face);
            let side = side.filter(|(e, _)| e.dim() + 1 == self.layout.ndim());
            let (element, nodes) = side.ok_or_else(|| LoadError::NoFace {
                element: self.number(face.cell),
                side: usize::from(face.side) + 1,
            })?;
            let rule = element.surface_rule();
            let across = (body.space, body.profile.as_deref());
            region.push_by((element, rule), across, &nodes, 1.0);
        }
        some(region)
    }

    /// Cells of bodies that a load acts on, with their densities where it acts by mass.
    fn cells(&self, cells: &[CellId], domain: Domain) -> Result<Region, LoadError> {
        let mut region = Region::default();
        for &cell in &set(cells) {
            let body = self.body(cell)?;
            let has_volume = |dim| dim == self.layout.ndim() || body.section.is_some();
            let element = self.mesh.element(cell).filter(|e| has_volume(e.dim()));
            let element = element.ok_or_else(|| LoadError::NoVolume {
                element: self.number(cell),
            })?;
            let density = match domain {
                Domain::Mass => body.density,
                _ => Some(1.0),
            };
            let density = density.ok_or_else(|| LoadError::NoDensity {
                body: body.name.clone(),
            })?;
            let factor = density * body.section.unwrap_or(1.0);
            // by the rule of the element: reduced integration makes another mass of bent elements
            let rule = match body.integration {
                Integration::Full | Integration::Raised | Integration::Through(_) => {
                    element.surface_rule()
                }
                Integration::Reduced => element.reduced_rule(),
            };
            let across = (body.space, body.profile.as_deref());
            region.push_by((element, rule), across, self.mesh.cell(cell), factor);
        }
        some(region)
    }

    /// The number of a cell in the input.
    fn number(&self, cell: CellId) -> u64 {
        self.mesh.cell_label(cell).unwrap_or(0)
    }
}

/// Some of these.
fn picked<T: Copy>(of: &[T], members: &[usize]) -> Vec<T> {
    let members = members.iter().filter_map(|&k| of.get(k));
    members.copied().collect()
}

/// What acts, on unknowns that exist.
fn acting(forces: impl IntoIterator<Item = (Dof, f64)>) -> Vec<(Dof, f64)> {
    let acts = |(dof, force): &(Dof, f64)| *dof != NO_DOF && *force != 0.0;
    forces.into_iter().filter(acts).collect()
}

fn some(region: Region) -> Result<Region, LoadError> {
    if region.is_empty() {
        return Err(LoadError::Nowhere);
    }
    Ok(region)
}
