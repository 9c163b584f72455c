//! The check block: values that are compared at the end of steps.
//!
//! | record | here |
//! |---|---|
//! | `#NODE … dof 2 unknown d` | `displacement.y @ node N` |
//! | `#REACTION … dof 2` | `reaction_force.y @ node N` |
//! | `#ELEMENT … keyword 4 component 2` | `strain.yy @ element N point P` |
//! | `#ELEMENT … keyword 1 component 2` | `stress.yy @ element N point P`, of small strain |
//! | `#ELEMENT … keyword 150, 151, 152`, of contact elements | `contact_gap`, `contact_pressure`, `contact_status` at the node of the point |
//! | `#LOADLEVEL`, `#TIME` | the time of the step, known without solving |
//!
//! Tolerances are absolute. A shear strain of OOFEM is an angle, twice ours. Points of elements are found by where
//! they are.

use super::Translation;
use crate::case::{Expectation, Moment, Tolerance};
use crate::diagnostic::{Spanned, codes};
use crate::readers::oofem::{Checks, Family, Fault, Kind, Record, RecordError};
use signorini_geometry::element::{self, by_name};
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::Vec3;

/// Where the block says nothing.
const TOLERANCE: f64 = 1e-6;

/// Components of tensors in OOFEM's order.
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "yz", "xz", "xy"];

const AXES: [&str; 3] = ["x", "y", "z"];

/// A value that is wanted.
struct Wanted {
    what: String,
    value: f64,
    tolerance: f64,
}

impl Translation {
    pub fn checks(&mut self) {
        let Some(mut block) = self.parts.checks.take() else {
            return;
        };
        let place = block.head.place();
        if !block.closed {
            let text = "the check block has no end, #%END_CHECK%: is the deck cut off?";
            self.error(&codes::MISSING, text, &place, "");
            return;
        }
        let asked = self.parts.modules.iter();
        if !asked.map(Record::kind).any(|kind| kind == "errorcheck") {
            let text = "the check block is left out: there is no module `errorcheck`";
            self.note(text, &place);
            return;
        }
        let tolerance = block_tolerance(&mut block);
        let Some(tolerance) = self.take(tolerance) else {
            return;
        };
        for mut record in block.records {
            let done = self.check(&mut record, tolerance);
            self.take(done);
            self.finish(&record);
        }
    }

    fn check(&mut self, record: &mut Record, tolerance: f64) -> Result<(), Fault> {
        record.take_kind();
        let place = record.place();
        let step = record.need_whole("tstep")?;
        if record
            .whole("tstepver")?
            .is_some_and(|version| version != 0)
        {
            self.not_built("`tStepVer` other than 0 is not supported", &place, "");
        }
        let tolerance = record.real("tolerance")?.unwrap_or(tolerance);
        let value = record.need_real("value")?;
        let at = usize::try_from(step).ok().and_then(|n| n.checked_sub(1));
        let Some([time, end]) = at.and_then(|at| self.clock.ends.get(at)).copied() else {
            let text = format!("there is no step {step}");
            let remark = format!("the deck has {}", self.clock.ends.len());
            self.error(&codes::OUT_OF_RANGE, text, &place, remark);
            return Ok(());
        };
        let wanted = |what: String| Wanted {
            what,
            value,
            tolerance,
        };
        let wanted = match record.kind().as_str() {
            "#node" => {
                let unknown = record.text("unknown")?.map(|(word, _)| word);
                if unknown
                    .as_deref()
                    .is_some_and(|u| !u.eq_ignore_ascii_case("d"))
                {
                    self.not_built("only displacements, `unknown d`, are known", &place, "");
                }
                self.at_node(record, "displacement")?.map(wanted)
            }
            "#reaction" => {
                let revolved = *self.case.model.space == crate::case::Space::Axisymmetric;
                if revolved {
                    let text = "reactions of bodies of revolution are not checked";
                    let why = "whether they are per radian was not verified";
                    self.not_built(text, &place, why);
                }
                self.at_node(record, "reaction_force")?.map(wanted)
            }
            "#element" => self.at_element(record, value, tolerance)?,
            "#loadlevel" | "#time" => {
                if (time - value).abs() > tolerance {
                    let text = format!("the time of step {step} is {time}, not {value}");
                    self.error(&codes::CONTRADICTION, text, &place, "the check fails");
                }
                None
            }
            other => {
                let text = format!("checks of `{other}` are not supported");
                self.not_built(text, &place, "");
                record.ignore_all();
                None
            }
        };
        if let Some(wanted) = wanted {
            self.case.expectations.push(Expectation {
                what: Spanned::new(wanted.what, place.clone()),
                at: Moment::Time(end),
                value: wanted.value,
                tolerance: Tolerance::Absolute(wanted.tolerance),
                place,
            });
        }
        Ok(())
    }

    fn at_node(&mut self, record: &mut Record, field: &str) -> Result<Option<String>, Fault> {
        let number = record.need_whole("number")?;
        let dof = record.need_whole("dof")?;
        if !self.meshed.mesh.node_labels.contains(&number) {
            return Err(record.wrong_field(
                "number",
                RecordError::Undefined {
                    what: "node",
                    number,
                },
            ));
        }
        let axis = usize::try_from(dof)
            .ok()
            .and_then(|dof| AXES.get(dof.checked_sub(1)?));
        let Some(axis) = axis else {
            return Err(record.wrong_field(
                "dof",
                RecordError::OutOfRange {
                    keyword: "dof".into(),
                    found: dof.to_string(),
                    wanted: "1 to 3",
                },
            ));
        };
        Ok(Some(format!("{field}.{axis} @ node {number}")))
    }

    fn at_element(
        &mut self,
        record: &mut Record,
        value: f64,
        tolerance: f64,
    ) -> Result<Option<Wanted>, Fault> {
        let place = record.place();
        let number = record.need_whole("number")?;
        record.ignore("irule", 1);
        let point = record.need_whole("gp")?;
        let keyword = record.need_whole("keyword")?;
        let component = record.need_whole("component")?;
        let at = self.meshed.elements.get(&number).copied();
        let known =
            at.and_then(|at| Some((*self.meshed.kinds.get(at)?, *self.meshed.cells.get(at)?)));
        let Some((kind, cell)) = known else {
            return Err(record.wrong_field(
                "number",
                RecordError::Undefined {
                    what: "element",
                    number,
                },
            ));
        };
        if kind.family == Family::Contact {
            let node = self.node_of_point(kind, cell, point);
            let quantity = match keyword {
                150 => Some("contact_gap"),
                151 => Some("contact_pressure"),
                152 => Some("contact_status"),
                _ => None,
            };
            let (Some(node), Some(quantity)) = (node, quantity) else {
                let text = "this value of a contact element is not known";
                self.not_built(
                    text,
                    &place,
                    "150, 151 and 152 at points that are nodes are",
                );
                return Ok(None);
            };
            return Ok(Some(Wanted {
                what: format!("{quantity} @ node {node}"),
                value,
                tolerance,
            }));
        }
        let is_bar = kind.family == Family::Bar;
        let large = self.nonlinear && !(is_bar && self.is_small(cell));
        let field = match keyword {
            1 if large => {
                let text = "checks of stresses at large strain are not supported";
                self.not_built(text, &place, "OOFEM's are those of Piola and Kirchhoff");
                return Ok(None);
            }
            1 => "stress",
            4 => "strain",
            _ => {
                let text = format!("the keyword {keyword} is not known");
                self.not_built(text, &place, "1, stress, and 4, strain, are");
                return Ok(None);
            }
        };
        let index = usize::try_from(component)
            .ok()
            .and_then(|c| c.checked_sub(1));
        let name = index.and_then(|index| COMPONENTS.get(index)).copied();
        let name = if is_bar {
            self.along(cell).filter(|_| component == 1)
        } else {
            name
        };
        let (Some(name), Some(ours)) = (name, our_point(kind, point)) else {
            let text = format!(
                "component {component} at point {point} of a {} is not known",
                kind.name
            );
            self.not_built(text, &place, "");
            return Ok(None);
        };
        // a shear strain is an angle there
        let half = if field == "strain" && component > 3 {
            0.5
        } else {
            1.0
        };
        Ok(Some(Wanted {
            what: format!("{field}.{name} @ element {number} point {ours}"),
            value: half * value,
            tolerance: half * tolerance,
        }))
    }

    /// The component along a bar that lies along an axis.
    fn along(&self, cell: CellId) -> Option<&'static str> {
        let mesh = &self.meshed.mesh;
        let point = |node: &u32| mesh.points.get(*node as usize).copied();
        let [first, last] = [mesh.cell(cell).first()?, mesh.cell(cell).last()?];
        let along = (point(last)? - point(first)?).to_array();
        let is_along = |axis: &usize| (0..3).all(|k| (along[k] == 0.0) == (k != *axis));
        let axis = (0..3).find(is_along)?;
        COMPONENTS.get(axis).copied()
    }

    /// Whether a cell is of small strain.
    fn is_small(&self, cell: CellId) -> bool {
        let mesh = &self.meshed.mesh;
        let holds = |name: &str| {
            mesh.sets
                .get(name)
                .is_some_and(|set| set.cells.contains(&cell))
        };
        let mut groups = self.meshed.groups.iter();
        groups.any(|group| group.nlgeo == 0 && holds(&group.name))
    }

    /// The number of the node at a point of a contact element: its points are those of Lobatto.
    fn node_of_point(&self, kind: Kind, cell: CellId, point: u64) -> Option<u64> {
        let corner = match (kind.name, point) {
            ("structuralcontactelement_linelin", 1 | 2) => point as usize - 1,
            ("structuralcontactelement_quadlin", 1) => 2,
            ("structuralcontactelement_quadlin", 2) => 1,
            ("structuralcontactelement_quadlin", 3) => 3,
            ("structuralcontactelement_quadlin", 4) => 0,
            _ => return None,
        };
        let mesh = &self.meshed.mesh;
        let node = mesh.cell(cell).get(corner)?;
        mesh.node_labels.get(*node as usize).copied()
    }
}

/// The tolerance of a block: behind its mark, with or without the word.
fn block_tolerance(block: &mut Checks) -> Result<f64, Fault> {
    block.head.take_kind();
    if let Some(tolerance) = block.head.real("tolerance")? {
        return Ok(tolerance);
    }
    Ok(TOLERANCE)
}

/// Our number, from 1, of a point of an element: the one in its place.
fn our_point(kind: Kind, point: u64) -> Option<u64> {
    let at = usize::try_from(point).ok()?.checked_sub(1)?;
    if kind.points == 1 {
        return (at == 0).then_some(1);
    }
    let side = 1.0 / 3.0_f64.sqrt();
    let end = |bit: usize| if bit & 1 == 0 { -side } else { side };
    // the first coordinate runs slowest
    let element = by_name(kind.element).filter(|e| e.is_linear())?;
    let place = match (element.family(), at) {
        (element::Family::Quadrilateral, 0..4) => Vec3::new(-end(at >> 1), -end(at), 0.0),
        (element::Family::Hexahedron, 0..8) => Vec3::new(end(at >> 1), end(at >> 2), -end(at)),
        _ => return None,
    };
    let points = element.full_rule().points;
    let found = points.iter().position(|xi| (*xi - place).norm() < 1e-9)?;
    Some(found as u64 + 1)
}
