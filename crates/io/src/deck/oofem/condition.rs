//! Supports, motions, loads.
//!
//! A value of a condition is total, and its function of time a factor. What is zero at all times is a support.

use super::Translation;
use crate::case::{Course, Directions, Fix, Load, Motion, Move, Name, Space};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::oofem::{Fault, Record, RecordError};
use signorini_vocabulary::{Chosen, Value};
use std::collections::BTreeMap;

/// Contacts, which have a stage of their own.
pub(super) const CONTACTS: [&str; 5] = [
    "n2npenaltycontact",
    "n2nlagrangianmultipliercontact",
    "n2spenaltycontact",
    "n2slagrangianmultipliercontact",
    "structuralpenaltycontactbc",
];

/// What the function of a condition makes of it.
struct Driver {
    function: u64,
    /// Whether it is zero at the ends of all steps.
    is_zero: bool,
}

impl Translation {
    pub fn conditions(&mut self) {
        let mut of_nodes = self.conditions_of_nodes();
        let mut numbers = std::collections::BTreeSet::new();
        for mut record in self.parts.conditions.clone() {
            let kind = record.kind();
            if CONTACTS.contains(&kind.as_str()) {
                continue;
            }
            record.take_kind();
            let number = record.number();
            let Some(number) = self.take(number) else {
                continue;
            };
            if !numbers.insert(number) {
                let text = format!("a second condition has the number {number}");
                self.error(&codes::NAME_TWICE, text, &record.place(), "");
            }
            let own = of_nodes.remove(&number).unwrap_or_default();
            let done = match kind.as_str() {
                "boundarycondition" => self.support(&mut record, &own),
                "nodalload" => self.nodal_load(number, &mut record, &own),
                "deadweight" => self.dead_weight(number, &mut record),
                "constantedgeload" | "constantsurfaceload" => self.side_load(number, &mut record),
                other => {
                    let text = format!("the condition `{other}` is not supported");
                    self.not_built(text, &record.place(), "see docs/oofem.md");
                    record.ignore_all();
                    Ok(())
                }
            };
            self.take(done);
            self.finish(&record);
        }
        for (number, nodes) in of_nodes {
            let node = nodes.first().map_or(0, |(node, _)| *node);
            let text =
                format!("node {node} names condition {number}, which the deck does not have");
            self.error(&codes::UNDEFINED, text, &Place::nowhere(), "");
        }
    }

    /// The conditions that records of nodes name: nodes, with the component where it is one of a support.
    fn conditions_of_nodes(&mut self) -> BTreeMap<u64, Vec<(u64, Option<usize>)>> {
        let mut found: BTreeMap<u64, Vec<(u64, Option<usize>)>> = BTreeMap::new();
        let mut records = std::mem::take(&mut self.parts.nodes);
        for record in &mut records {
            let Ok(node) = record.number() else { continue };
            let supports = record.wholes("bc");
            let supports = self.take(supports).flatten().unwrap_or_default();
            for (place, &number) in supports.iter().enumerate().filter(|(_, n)| **n > 0) {
                let Some(dof) = self.dofs.get(place).copied() else {
                    let text = format!("`bc` of node {node} has more entries than it has freedoms");
                    let at = record.place_of_field("bc");
                    self.error(&codes::WRONG_LENGTH, text, &at, "");
                    continue;
                };
                let component = Some(dof as usize - 1);
                found.entry(number).or_default().push((node, component));
            }
            let loads = record.wholes("load");
            for number in self.take(loads).flatten().unwrap_or_default() {
                found.entry(number).or_default().push((node, None));
            }
        }
        self.parts.nodes = records;
        found
    }

    fn driver(&mut self, record: &mut Record) -> Result<Option<Driver>, Fault> {
        let function = record.need_whole("loadtimefunction")?;
        let place = record.place_of_field("loadtimefunction");
        let course = self.course(function, &place);
        Ok(course.map(|values| Driver {
            function,
            is_zero: values.iter().all(|value| *value == 0.0),
        }))
    }

    /// The nodes that a condition acts on by its set.
    fn nodes_of(&mut self, record: &mut Record) -> Result<Vec<u64>, Fault> {
        let Some(set) = record.whole("set")?.filter(|set| *set > 0) else {
            return Ok(Vec::new());
        };
        let place = record.place_of_field("set");
        Ok(self.labels_of_set(set, &place).unwrap_or_default())
    }

    /// Components, from 0, of degrees of freedom; of the first `count` where the record names none.
    fn components(&mut self, record: &mut Record, count: usize) -> Result<Vec<usize>, Fault> {
        let dofs = match record.wholes("dofs")? {
            Some(dofs) => dofs,
            None => self.dofs.iter().copied().take(count).collect(),
        };
        let mut components = Vec::with_capacity(dofs.len());
        for dof in dofs {
            if !self.dofs.contains(&dof) || dof > self.ndim() as u64 {
                let error = RecordError::OutOfRange {
                    keyword: "dofs".into(),
                    found: dof.to_string(),
                    wanted: "a displacement that nodes of the domain have",
                };
                return Err(record.wrong_field("dofs", error));
            }
            components.push(dof as usize - 1);
        }
        Ok(components)
    }

    fn support(&mut self, record: &mut Record, own: &[(u64, Option<usize>)]) -> Result<(), Fault> {
        let place = record.place();
        let driver = self.driver(record)?;
        let mut values = record.reals("values")?.unwrap_or_default();
        if values.is_empty() {
            let single = record.real("prescribedvalue")?;
            let single = single.map_or_else(|| record.real("d"), |value| Ok(Some(value)))?;
            values.extend(single);
        }
        if values.is_empty() {
            let keyword = "values";
            return Err(record.wrong(RecordError::Missing { keyword }));
        }
        let nodes = self.nodes_of(record)?;
        let components = self.components(record, values.len())?;
        let Some(driver) = driver else {
            return Ok(());
        };
        let single = values.first().copied().unwrap_or(0.0);
        if !nodes.is_empty() {
            if components.len() != values.len() {
                let text = format!(
                    "{} values are given for {} degrees of freedom",
                    values.len(),
                    components.len()
                );
                self.error(&codes::WRONG_LENGTH, text, &place, "");
                return Ok(());
            }
            let pairs: Vec<(usize, f64)> = components.into_iter().zip(values).collect();
            self.prescribe(nodes, &pairs, &driver, &place);
        }
        // old records name a component each; nodes that share it become one set
        let mut by_component: BTreeMap<usize, Vec<u64>> = BTreeMap::new();
        for (node, component) in own {
            if let Some(component) = component {
                by_component.entry(*component).or_default().push(*node);
            }
        }
        for (component, nodes) in by_component {
            self.prescribe(nodes, &[(component, single)], &driver, &place);
        }
        Ok(())
    }

    /// Supports and motions of these components of some nodes. Components of slave nodes follow their masters.
    fn prescribe(
        &mut self,
        nodes: Vec<u64>,
        components: &[(usize, f64)],
        driver: &Driver,
        place: &Place,
    ) {
        let mut groups: BTreeMap<Vec<usize>, Vec<u64>> = BTreeMap::new();
        for node in nodes {
            let slaved = self.slaves.get(&node).cloned().unwrap_or_default();
            groups.entry(slaved).or_default().push(node);
        }
        for (slaved, nodes) in groups {
            let free = components.iter().filter(|(c, _)| !slaved.contains(c));
            let free: Vec<(usize, f64)> = free.copied().collect();
            if free.len() < components.len() {
                let node = nodes.first().copied().unwrap_or(0);
                let text = format!(
                    "node {node} follows others: what this condition prescribes of it is left out"
                );
                self.note(text, place);
            }
            if free.is_empty() {
                continue;
            }
            let on = self.nodes_named(nodes, place);
            let is_zero = |value: f64| value == 0.0 || driver.is_zero;
            let mut held = [false; 3];
            let mut moved: [Option<Motion>; 3] = [None, None, None];
            for (component, value) in free {
                if is_zero(value) {
                    if let Some(held) = held.get_mut(component) {
                        *held = true;
                    }
                } else if let Some(moved) = moved.get_mut(component) {
                    let name = self.amplitude(driver.function);
                    *moved = Some(Motion::Amplitude {
                        name: Spanned::new(name, place.clone()),
                        value,
                    });
                }
            }
            if held != [false; 3] {
                self.first.fixes.push(Fix {
                    on: on.clone(),
                    u: Directions { xyz: held },
                    rot: Directions::default(),
                    place: place.clone(),
                });
            }
            if moved.iter().any(Option::is_some) {
                self.first.moves.push(Move {
                    on,
                    u: moved,
                    from: None,
                    rot: Default::default(),
                    place: place.clone(),
                });
            }
        }
    }

    fn push_load(
        &mut self,
        number: u64,
        on: Name,
        (name, vector): (&'static str, [f64; 3]),
        driver: &Driver,
        place: &Place,
    ) {
        if vector == [0.0; 3] || driver.is_zero {
            return;
        }
        let course = self.amplitude(driver.function);
        let own = self.fresh(&format!("load-{number}"));
        self.first.loads.push(Load {
            name: Some(Spanned::new(own, place.clone())),
            on,
            kind: Chosen::bare(name, Value::Numbers(vector.into())),
            what: place.clone(),
            follows: None,
            coupling: None,
            course: Course::Amplitude(Spanned::new(course, place.clone())),
            place: place.clone(),
        });
    }

    /// Refuses forces on bodies of revolution.
    fn no_revolution(&mut self, place: &Place) -> bool {
        let revolved = *self.case.model.space == Space::Axisymmetric;
        if revolved {
            let text = "forces on bodies of revolution are not supported in decks";
            let why = "whether they are per radian or of the whole circumference was not verified";
            self.not_built(text, place, why);
        }
        revolved
    }

    fn vector(
        &mut self,
        record: &mut Record,
        components: &[usize],
        values: &[f64],
    ) -> Option<[f64; 3]> {
        if components.len() != values.len() {
            let text = format!(
                "{} components are given for {} degrees of freedom",
                values.len(),
                components.len()
            );
            self.error(&codes::WRONG_LENGTH, text, &record.place(), "");
            return None;
        }
        let mut vector = [0.0; 3];
        for (component, value) in components.iter().zip(values) {
            if let Some(slot) = vector.get_mut(*component) {
                *slot = *value;
            }
        }
        Some(vector)
    }

    fn nodal_load(
        &mut self,
        number: u64,
        record: &mut Record,
        own: &[(u64, Option<usize>)],
    ) -> Result<(), Fault> {
        let place = record.place();
        let driver = self.driver(record)?;
        let values = record.need_reals("components")?;
        let mut nodes = self.nodes_of(record)?;
        let components = self.components(record, values.len())?;
        if record.whole("cstype")?.is_some_and(|kind| kind > 1) {
            self.not_built("`csType` of a load on nodes is not supported", &place, "");
        }
        nodes.extend(
            own.iter()
                .filter(|(_, c)| c.is_none())
                .map(|(node, _)| *node),
        );
        let force = self.vector(record, &components, &values);
        if self.no_revolution(&place) || nodes.is_empty() {
            return Ok(());
        }
        if let (Some(driver), Some(force)) = (driver, force) {
            let on = self.nodes_named(nodes, &place);
            self.push_load(number, on, ("per_node", force), &driver, &place);
        }
        Ok(())
    }

    fn dead_weight(&mut self, number: u64, record: &mut Record) -> Result<(), Fault> {
        let place = record.place();
        let driver = self.driver(record)?;
        let values = record.need_reals("components")?;
        let set = record.need_whole("set")?;
        let components: Vec<usize> = self.dofs.iter().map(|dof| *dof as usize - 1).collect();
        let components: Vec<usize> = components.into_iter().take(values.len()).collect();
        let acceleration = self.vector(record, &components, &values);
        let names = self.meshed.sets.get(&set);
        let Some(name) = names.and_then(|names| names.elements.clone()) else {
            let text = format!("set {set} has no elements");
            self.error(&codes::WRONG_KIND, text, &record.place_of_field("set"), "");
            return Ok(());
        };
        if self.no_revolution(&place) {
            return Ok(());
        }
        if let (Some(driver), Some(acceleration)) = (driver, acceleration) {
            let on = Spanned::new(name, place.clone());
            self.push_load(number, on, ("gravity", acceleration), &driver, &place);
        }
        Ok(())
    }

    fn side_load(&mut self, number: u64, record: &mut Record) -> Result<(), Fault> {
        let place = record.place();
        let driver = self.driver(record)?;
        let values = record.need_reals("components")?;
        let set = record.need_whole("set")?;
        record.ignore("ndofs", 1);
        let kind = record.whole("loadtype")?.unwrap_or(3);
        let local = record.whole("cstype")?.unwrap_or(0);
        if kind != 3 || local != 0 {
            let text = "only loads of  loadType 3  along global axes,  csType 0,  are supported";
            self.not_built(text, &place, "");
        }
        let components: Vec<usize> = (0..self.ndim().min(values.len())).collect();
        let traction = self.vector(record, &components, &values);
        let names = self.meshed.sets.get(&set);
        let Some(name) = names.and_then(|names| names.sides.clone()) else {
            let text = format!("set {set} has no sides of elements");
            self.error(&codes::WRONG_KIND, text, &record.place_of_field("set"), "");
            return Ok(());
        };
        if self.no_revolution(&place) {
            return Ok(());
        }
        if self.case.model.thickness != 1.0 {
            let text = "loads on edges of a thickness other than 1 are not supported";
            let why = "whether they are per length or per area was not verified";
            self.not_built(text, &place, why);
        }
        if let (Some(driver), Some(traction)) = (driver, traction) {
            let on = Spanned::new(name, place.clone());
            self.push_load(number, on, ("traction", traction), &driver, &place);
        }
        Ok(())
    }
}
