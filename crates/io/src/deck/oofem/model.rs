//! Space, materials, cross-sections, bars, slave nodes.

use super::Translation;
use crate::case::{
    AtNodes, Body, Constant, Constraint, ConstraintKind, Directions, Fix, Hardening, Integration,
    Locking, Material, MaterialDamping, Model, Plasticity, Space, Summand, Temperatures, Thickness,
};
use crate::deck::Compat;
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::oofem::{Family, Fault, Group, Record};
use std::collections::{BTreeMap, BTreeSet};

/// Domains, and the degrees of freedom that their nodes have.
const DOMAINS: [(&str, &[u64]); 6] = [
    ("2dplanestress", &[1, 2]),
    ("planestrain", &[1, 2]),
    ("3daxisymm", &[1, 2]),
    ("2dtruss", &[1, 3]),
    ("1dtruss", &[1]),
    ("3d", &[1, 2, 3]),
];

/// Elements whose shear strain OOFEM takes from their centre.
const SELECTIVE: [&str; 2] = ["planestress2d", "l4axisymm"];

/// The rule for an element with so many points in OOFEM; tri6 with 4 points takes the full rule, of 3.
const RULES: [(&str, u64, Integration); 15] = [
    ("line2", 1, Integration::Full),
    ("tri3", 1, Integration::Full),
    ("tri6", 3, Integration::Full),
    ("tri6", 4, Integration::Full),
    ("quad4", 4, Integration::Full),
    ("quad8", 4, Integration::Reduced),
    ("quad8", 9, Integration::Full),
    ("tet4", 1, Integration::Full),
    ("tet10", 4, Integration::Full),
    ("hex8", 8, Integration::Full),
    ("hex20", 8, Integration::Reduced),
    ("hex20", 27, Integration::Full),
    ("wedge6", 6, Integration::Full),
    ("wedge6", 9, Integration::Raised),
    ("wedge15", 9, Integration::Full),
];

fn takes_shear_of_centre(group: &Group) -> bool {
    SELECTIVE.contains(&group.kind.name) && group.points.is_none()
}

/// A cross-section.
#[derive(Clone, Copy, Debug, Default)]
struct Section {
    thickness: f64,
    area: f64,
    is_dummy: bool,
}

impl Translation {
    pub fn model(&mut self) {
        self.space();
        let sections = self.sections();
        self.materials();
        self.bodies(&sections);
        self.slave_nodes();
    }

    fn space(&mut self) {
        let domain = self.parts.domain.clone();
        let kind = self.parts.domain.text("domain");
        let kind = self.take(kind).flatten();
        let (word, place) = kind.unwrap_or((String::new(), domain.place()));
        let word = word.to_lowercase();
        let known = DOMAINS.iter().find(|(name, _)| word.starts_with(name));
        let rotating = ["2dplanestressrot", "3dshell", "3dbeam"];
        match known.filter(|_| !rotating.iter().any(|name| word.starts_with(name))) {
            Some((_, dofs)) => self.dofs = dofs,
            None => {
                let text = format!("the domain `{word}` is not supported");
                let names = DOMAINS.map(|(name, _)| name).join(", ");
                self.not_built(text, &place, format!("supported are {names}"));
            }
        }
        let families: BTreeSet<&str> = (self.meshed.groups.iter())
            .map(|group| group.kind.family)
            .filter(|family| *family != Family::Bar)
            .map(family_word)
            .collect();
        let mut families = families.into_iter();
        let first = families.next();
        if let Some(second) = families.next() {
            let text = format!(
                "elements of {} and of {second} in one deck",
                first.unwrap_or_default()
            );
            self.not_built(text, &Place::nowhere(), "a model has one of them");
        }
        let in_plane = |group: &Group| group.plane == 1;
        let space = match first {
            Some("plane stress") => Space::PlaneStress,
            Some("plane strain") => Space::PlaneStrain,
            Some("axisymmetry") => Space::Axisymmetric,
            None if self.meshed.groups.iter().all(in_plane) => Space::PlaneStress,
            _ => Space::ThreeD,
        };
        self.case.model = Model {
            space: space.into(),
            thickness: 1.0,
        };
        if space != Space::ThreeD && self.meshed.mesh.points.iter().any(|x| x.z != 0.0) {
            let text = "nodes of a plane model have a third coordinate that is not zero";
            self.error(&codes::BAD_MESH, text, &Place::nowhere(), "");
        }
        self.bars_lie(space);
        let large = self.meshed.groups.iter().map(|group| group.nlgeo);
        self.nonlinear = large.max() == Some(1);
    }

    /// Bars of the domain `2dTruss` lie in x and z, those of `1dTruss` along x: nothing moves them out of it.
    fn bars_lie(&mut self, space: Space) {
        let names: BTreeSet<&str> = (self.meshed.groups.iter())
            .filter(|group| group.kind.family == Family::Bar)
            .map(|group| match (group.kind.name, group.plane) {
                ("truss2d", 1) => "truss2d, cs 1",
                ("truss2d", 2) => "truss2d, cs 2",
                (name, _) => name,
            })
            .collect();
        let Some(first) = names.first().copied() else {
            return;
        };
        let held = match first {
            _ if names.len() > 1 => None,
            "truss3d" if space == Space::ThreeD => Some([false; 3]),
            "truss2d, cs 1" if space != Space::Axisymmetric => {
                Some([false, false, space == Space::ThreeD])
            }
            "truss2d" if space == Space::ThreeD => Some([false, true, false]),
            "truss1d" if space == Space::ThreeD => Some([false, true, true]),
            _ => None,
        };
        let Some(held) = held else {
            let all: Vec<&str> = names.into_iter().collect();
            let text = format!(
                "bars of type {} do not go with this deck",
                all.join(" and ")
            );
            let why = "a deck has bars of one plane, the one of its other elements";
            self.not_built(text, &Place::nowhere(), why);
            return;
        };
        if held != [false; 3] {
            let labels = self.meshed.mesh.node_labels.clone();
            let on = self.nodes_named(labels, &Place::nowhere());
            self.first.fixes.push(Fix {
                on,
                u: Directions { xyz: held },
                rot: Directions::default(),
                place: Place::nowhere(),
            });
        }
    }

    fn sections(&mut self) -> BTreeMap<u64, Section> {
        let mut sections = BTreeMap::new();
        for mut record in std::mem::take(&mut self.parts.sections) {
            record.take_kind();
            let section = self.section(&mut record);
            if let Some((number, section)) = self.take(section) {
                sections.insert(number, section);
            }
            self.finish(&record);
        }
        sections
    }

    fn section(&mut self, record: &mut Record) -> Result<(u64, Section), Fault> {
        let number = record.number()?;
        record.ignore("material", 1);
        record.ignore("mat", 1);
        record.ignore("set", 1);
        let kind = record.kind();
        let is_dummy = kind == "dummycs";
        if kind != "simplecs" && !is_dummy {
            let text = format!("the cross-section `{kind}` is not supported");
            self.not_built(text, &record.place(), "SimpleCS and DummyCS are");
            record.ignore_all();
        }
        let positive = |this: &mut Self, record: &mut Record, keyword| -> Result<_, Fault> {
            let value = record.real(keyword)?;
            if value.is_some_and(|value| value < 0.0) {
                let text = format!("`{keyword}` of a cross-section is negative");
                let place = record.place_of_field(keyword);
                this.error(&codes::OUT_OF_RANGE, text, &place, "");
            }
            Ok(value)
        };
        let thickness = positive(self, record, "thick")?;
        let width = positive(self, record, "width")?;
        let area = positive(self, record, "area")?;
        let product = thickness.unwrap_or(0.0) * width.unwrap_or(0.0);
        Ok((
            number,
            Section {
                thickness: thickness.unwrap_or(1.0),
                area: area.unwrap_or(product),
                is_dummy,
            },
        ))
    }

    fn materials(&mut self) {
        let mut used: BTreeMap<u64, BTreeSet<u64>> = BTreeMap::new();
        for group in &self.meshed.groups {
            used.entry(group.material).or_default().insert(group.nlgeo);
        }
        let mut seen = BTreeSet::new();
        for mut record in std::mem::take(&mut self.parts.materials) {
            record.take_kind();
            let number = record.number();
            let Some(number) = self.take(number) else {
                continue;
            };
            if !seen.insert(number) {
                let text = format!("a second material has the number {number}");
                self.error(&codes::NAME_TWICE, text, &record.place(), "");
            }
            let large = used.get(&number).is_some_and(|all| all.contains(&1));
            let material = self.material(number, &mut record, large);
            if let Some(Some(material)) = self.take(material)
                && used.contains_key(&number)
            {
                self.case.materials.push(material);
            }
            self.finish(&record);
        }
        for group in self.meshed.groups.clone() {
            if !seen.contains(&group.material) {
                let text = format!(
                    "elements {} have material {}, which the deck does not have",
                    group.kind.name, group.material
                );
                self.error(&codes::UNDEFINED, text, &Place::nowhere(), "");
            }
        }
    }

    fn material(
        &mut self,
        number: u64,
        record: &mut Record,
        large: bool,
    ) -> Result<Option<Material>, Fault> {
        let place = record.place();
        let mut constants: Vec<Constant> = Vec::new();
        let mut add = |name, value: f64, place: Place| {
            let values = Spanned::new(vec![value], place);
            constants.push(Constant { name, values });
        };
        let density = record.real("d")?.filter(|d| *d != 0.0);
        let mut plasticity = None;
        let model = match record.kind().as_str() {
            kind @ ("isole" | "misesmat") => {
                add("E", record.need_real("e")?, record.place_of_field("e"));
                add("nu", record.need_real("n")?, record.place_of_field("n"));
                record.ignore("talpha", 1);
                if kind == "misesmat" {
                    plasticity = Some(self.mises(record)?);
                }
                if large && kind == "isole" {
                    "saint-venant-kirchhoff"
                } else {
                    "linear-elastic"
                }
            }
            "mooneyrivlincompressiblemat" => {
                add("c10", record.need_real("c1")?, record.place_of_field("c1"));
                add("c01", record.need_real("c2")?, record.place_of_field("c2"));
                add("bulk", record.need_real("k")?, record.place_of_field("k"));
                if !large && self.uses(number) {
                    let text = "this material needs elements with  nlgeo 1";
                    self.error(&codes::CONTRADICTION, text, &place, "");
                }
                "mooney-rivlin-logarithmic"
            }
            "dummymat" => {
                record.ignore_all();
                return Ok(None);
            }
            other => {
                record.ignore_all();
                if !self.uses(number) {
                    let text = format!("material {number} is left out: no element has it");
                    self.note(text, &place);
                    return Ok(None);
                }
                let text = format!("the material `{other}` is not supported");
                let known = "IsoLE, MisesMat and MooneyRivlinCompressibleMat are";
                self.not_built(text, &place, known);
                return Ok(None);
            }
        };
        Ok(Some(Material {
            name: Spanned::new(material_name(number), place.clone()),
            model: Spanned::new(model.to_owned(), place.clone()),
            constants,
            own: None,
            density: density.map(|d| Spanned::new(d, record.place_of_field("d"))),
            damping: MaterialDamping::default(),
            expansion: None,
            heat: None,
            plasticity,
            place,
        }))
    }

    fn uses(&self, material: u64) -> bool {
        let mut groups = self.meshed.groups.iter();
        groups.any(|group| group.material == material)
    }

    /// Plasticity of von Mises with linear isotropic hardening.
    fn mises(&mut self, record: &mut Record) -> Result<Plasticity, Fault> {
        let place = record.place_of_field("sig0");
        let yields = record.need_real("sig0")?;
        let modulus = record.real("h")?.unwrap_or(0.0);
        record.ignore("yieldtol", 1);
        if record.whole("htype")?.is_some_and(|kind| kind != 0) {
            let text = "`htype` other than 0 is not supported";
            let place = record.place_of_field("htype");
            self.not_built(text, &place, "hardening is linear");
            record.ignore_all();
        }
        if self.nonlinear {
            let text = "MisesMat with large strains is not supported";
            self.not_built(text, &record.place(), "write  nlgeo 0");
        }
        // one row more than yield makes a straight line; it ends far behind any strain
        let far = 1e3;
        let mut table = vec![[yields, 0.0]];
        if modulus != 0.0 {
            table.push([yields + far * modulus, far]);
        }
        Ok(Plasticity {
            hardening: Spanned::from(Hardening::Isotropic),
            table: Spanned::new(table, place),
            modulus: None,
        })
    }

    fn bodies(&mut self, sections: &BTreeMap<u64, Section>) {
        for group in self.meshed.groups.clone() {
            let Some(section) = sections.get(&group.section).copied() else {
                let text = format!(
                    "elements {} have cross-section {}, which the deck does not have",
                    group.kind.name, group.section
                );
                self.error(&codes::UNDEFINED, text, &Place::nowhere(), "");
                continue;
            };
            if section.is_dummy {
                let text = format!("elements {} have a DummyCS", group.kind.name);
                self.error(&codes::CONTRADICTION, text, &Place::nowhere(), "");
            }
            if group.nlgeo > 1 {
                let text = "`nlgeo` other than 0 and 1 is not supported";
                self.not_built(text, &Place::nowhere(), "1 is the total Lagrangian form");
            }
            let is_bar = group.kind.family == Family::Bar;
            let small = group.nlgeo == 0 && self.nonlinear;
            if small && !is_bar {
                let text = "elements of small and of large strain in one deck are not supported";
                let why = "only bars may differ from the rest";
                self.not_built(text, &Place::nowhere(), why);
            }
            let thickness = self.thickness(&group, section);
            let body = Body {
                groups: vec![Spanned::from(group.name.as_str())],
                material: Some(Spanned::from(material_name(group.material))),
                integration: self.integration(&group),
                locking: Spanned::from(self.locking(&group)),
                orientation: None,
                space: None,
                shell: None,
                thickness,
                temperatures: Temperatures::Full,
                at_nodes: AtNodes::Linear,
                area: is_bar.then(|| Spanned::from(section.area)),
                small_strain: small,
                mass_matrix: Default::default(),
                lumped_capacity: false,
                rigid: false,
                reference: None,
                place: Place::nowhere(),
            };
            if is_bar && section.area == 0.0 {
                let text = format!(
                    "cross-section {} has no area: bars of it carry no force",
                    group.section
                );
                self.warn(text, &Place::nowhere(), "");
            }
            self.case.bodies.push(body);
        }
    }

    /// The thickness of plane elements; none where it is that of the model.
    fn thickness(&mut self, group: &Group, section: Section) -> Option<Spanned<Thickness>> {
        if !self.case.model.space.has_thickness() || group.kind.family == Family::Bar {
            return None;
        }
        let is_first = self.case.bodies.iter().all(|body| body.area.is_some());
        if is_first {
            self.case.model.thickness = section.thickness;
        }
        let differs = section.thickness != self.case.model.thickness;
        differs.then(|| Spanned::from(Thickness::Uniform(section.thickness)))
    }

    fn locking(&self, group: &Group) -> Locking {
        match self.compat {
            Compat::Oofem if group.nlgeo == 0 && takes_shear_of_centre(group) => Locking::Shear,
            Compat::Oofem => Locking::None,
            _ if group.kind.family == Family::Bar => Locking::None,
            _ => Locking::Auto,
        }
    }

    /// The rule with as many points as OOFEM takes, where we have one.
    fn integration(&mut self, group: &Group) -> Integration {
        let kind = group.kind;
        let wanted = group.points.unwrap_or(kind.points);
        let mut known = RULES.iter();
        let found = known.find(|(name, points, _)| (*name, *points) == (kind.element, wanted));
        let rule = match found {
            Some((_, _, rule)) => *rule,
            None => {
                let text = format!(
                    "{} with {wanted} integration points is not supported",
                    kind.name
                );
                self.not_built(text, &Place::nowhere(), "leave `NIP` away");
                Integration::Full
            }
        };
        if self.compat == Compat::Oofem && group.nlgeo == 1 && takes_shear_of_centre(group) {
            self.warn(
                format!("the shear strain of {} is taken at all points", kind.name),
                &Place::nowhere(),
                "with  nlgeo 0  it is that of the centre, as in OOFEM; of  nlgeo 1  this was not verified",
            );
        }
        rule
    }

    /// Nodes that follow others.
    fn slave_nodes(&mut self) {
        let mut records = std::mem::take(&mut self.parts.nodes);
        for record in &mut records {
            let kind = record.kind();
            match kind.as_str() {
                "node" => {}
                "slavenode" => {
                    let done = self.slave_node(record);
                    self.take(done);
                }
                other => {
                    let text = format!("nodes of type `{other}` are not supported");
                    self.not_built(text, &record.place(), "Node and SlaveNode are");
                    record.ignore_all();
                }
            }
        }
        self.parts.nodes = records;
    }

    fn slave_node(&mut self, record: &mut Record) -> Result<(), Fault> {
        let number = record.number()?;
        let place = record.place();
        let kinds = record.need_wholes("doftype")?;
        let masters = record.need_wholes("masterdofman")?;
        let weights = record.need_reals("weights")?;
        if masters.len() != weights.len() {
            let text = format!("{} masters have {} weights", masters.len(), weights.len());
            self.error(&codes::WRONG_LENGTH, text, &place, "");
            return Ok(());
        }
        for master in &masters {
            if !self.meshed.mesh.node_labels.contains(master) || *master == number {
                let text = format!("node {number} cannot follow node {master}");
                let place = record.place_of_field("masterdofman");
                self.error(
                    &codes::UNDEFINED,
                    text,
                    &place,
                    "it does not exist, or is itself",
                );
                return Ok(());
            }
        }
        let mut slaved = Vec::new();
        for (place_of_dof, kind) in kinds.iter().enumerate() {
            let component = self.dofs.get(place_of_dof).map(|dof| *dof as usize - 1);
            match (kind, component) {
                (0, _) | (_, None) => {}
                (2, Some(component)) => slaved.push(component),
                _ => {
                    let text = format!("`doftype` {kind} is not supported");
                    self.not_built(text, &record.place_of_field("doftype"), "0 and 2 are");
                }
            }
        }
        for &component in &slaved {
            let mut terms = vec![self.summand(number, component, 1.0, &place)];
            for (master, weight) in masters.iter().zip(&weights) {
                terms.push(self.summand(*master, component, -weight, &place));
            }
            self.case.constraints.push(Constraint {
                kind: ConstraintKind::Equation { terms, rhs: 0.0 },
                place: place.clone(),
            });
        }
        self.slaves.insert(number, slaved);
        Ok(())
    }

    fn summand(&mut self, node: u64, component: usize, coefficient: f64, place: &Place) -> Summand {
        Summand {
            on: self.nodes_named(vec![node], place),
            component: Spanned::new(component, place.clone()),
            coefficient,
        }
    }
}

pub(super) fn material_name(number: u64) -> String {
    format!("material-{number}")
}

fn family_word(family: Family) -> &'static str {
    match family {
        Family::PlaneStress => "plane stress",
        Family::PlaneStrain => "plane strain",
        Family::Axisymmetric => "axisymmetry",
        Family::Solid => "space",
        Family::Bar | Family::Contact => "bars",
    }
}
