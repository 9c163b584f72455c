//! The mesh, the model, the sets and references of a case.

use toml::de::DeValue;

use super::super::check::id;
use super::super::fields::{Fields, numbers};
use super::super::parts::*;
use super::super::scalar::{is_usable, number, shortened};
use super::builder::Builder;
use crate::diagnostic::{Place, Spanned, codes};

impl Builder<'_> {
    /// Velocities of parts at the start.
    pub(super) fn velocities_at(&mut self, initial: Fields<'_>) -> Vec<VelocityAt> {
        let tables = initial.tables("velocity").into_iter();
        let at = tables.map(|(fields, place)| VelocityAt {
            on: fields.text("on"),
            velocity: self.vector_within(fields, "v").unwrap_or_default(),
            spin: self.spin(fields),
            about: self.vector(fields, "about").unwrap_or_default(),
            place,
        });
        at.collect()
    }

    /// Masses at nodes and of references.
    pub(super) fn masses_at(&mut self, root: &Fields<'_>) -> Vec<MassAt> {
        let tables = root.tables("mass").into_iter();
        let at = tables.map(|(fields, place)| MassAt {
            on: fields.text("on"),
            value: fields.number("value"),
            centroid: (self.vector_within(fields, "centroid"))
                .map(|at| Spanned::new(at, fields.place("centroid"))),
            inertia: self
                .inertia(fields)
                .map(|of| Spanned::new(of, fields.place("inertia"))),
            place,
        });
        at.collect()
    }

    /// Moments of inertia: a number in the plane.
    fn inertia(&mut self, fields: Fields<'_>) -> Option<[f64; 6]> {
        if !fields.has("inertia") {
            return None;
        }
        let (is_plane, place) = (self.space.ndim() == 2, fields.place("inertia"));
        let numbers = fields
            .numbers_if("inertia")
            .map_or_else(Vec::new, |of| of.value);
        let fault = match (fields.number_if("inertia"), &numbers[..], is_plane) {
            (Some(number), _, true) if self.space != Space::Axisymmetric => {
                return Some([0.0, 0.0, number.value, 0.0, 0.0, 0.0]);
            }
            (None, &[xx, yy, zz], false) => return Some([xx, yy, zz, 0.0, 0.0, 0.0]),
            (None, &[xx, yy, zz, xy, xz, yz], false) => return Some([xx, yy, zz, xy, xz, yz]),
            (_, _, false) => "write  inertia = [xx, yy, zz]  or all six",
            (None, _, true) => "write a number:  inertia = ",
            (Some(_), _, true) => "bodies of revolution do not turn",
        };
        let message = "`inertia` does not go with the dimension of the model";
        self.error(&codes::CONTRADICTION, message, &place, fault);
        None
    }

    /// An angular velocity: a number in the plane.
    fn spin(&mut self, fields: Fields<'_>) -> [f64; 3] {
        let (is_plane, place) = (self.space.ndim() == 2, fields.place("omega"));
        let fault = match (fields.number_if("omega"), is_plane) {
            (Some(number), true) if self.space != Space::Axisymmetric => {
                return [0.0, 0.0, number.value];
            }
            (None, false) => return self.vector(fields, "omega").unwrap_or_default(),
            (None, true) if !fields.has("omega") => return [0.0; 3],
            (Some(_), false) => "write a vector:  omega = [x, y, z]",
            (None, true) => "write a number:  omega = ",
            (Some(_), true) => "bodies of revolution do not turn",
        };
        let message = "`omega` does not go with the dimension of the model";
        self.error(&codes::CONTRADICTION, message, &place, fault);
        [0.0; 3]
    }

    pub(super) fn model(&mut self, fields: Fields<'_>) -> Model {
        let word = fields.text("space");
        let space = space(&word.value);
        if fields.has("thickness") && !space.has_thickness() {
            let what = match space {
                Space::Axisymmetric => "of a body of revolution",
                _ => "in space",
            };
            self.error(
                &codes::CONTRADICTION,
                format!("`thickness` means nothing {what}"),
                &fields.place("thickness"),
                "delete it, or choose space = \"plane-strain\" or \"plane-stress\"",
            );
        }
        Model {
            space: Spanned::new(space, word.place),
            thickness: fields.number("thickness"),
        }
    }

    pub(super) fn mesh(&mut self, fields: Fields<'_>) -> MeshSource {
        if let Some(path) = fields.text_if("file") {
            if path.trim().is_empty() {
                self.error(
                    &codes::MISSING,
                    "[mesh] names no file",
                    &path.place,
                    "write the path of a mesh",
                );
            }
            return MeshSource::File { path };
        }
        let elements = fields
            .tables("elements")
            .into_iter()
            .map(|(one, place)| InlineElement {
                id: one.count("id"),
                element_type: one.text("type"),
                group: one.text_if("group"),
                nodes: one.counts("nodes"),
                place,
            });
        MeshSource::Inline {
            nodes: self.nodes(fields),
            elements: elements.collect(),
            place: fields.place("nodes"),
        }
    }

    fn nodes(&mut self, fields: Fields<'_>) -> Vec<(u64, [f64; 3])> {
        let plane = self.space.ndim() == 2;
        let Some(rows) = fields
            .get("nodes")
            .and_then(|value| value.get_ref().as_array())
        else {
            return Vec::new();
        };
        let mut nodes = Vec::with_capacity(rows.len());
        for row in rows.iter() {
            let Some(items) = row.get_ref().as_array() else {
                self.error(
                    &codes::WRONG_TYPE,
                    "a node is a row [id, x, y, z]",
                    &fields.at(row.span()),
                    "not a list",
                );
                continue;
            };
            let node = items.first().and_then(id);
            let point = numbers::<4>(row.get_ref()).map(|[_, x, y, z]| [x, y, z]);
            let point = point.or_else(|| {
                let flat = numbers::<3>(row.get_ref()).filter(|_| plane);
                flat.map(|[_, x, y]| [x, y, 0.0])
            });
            match (node, point) {
                (Some(node), Some(point)) => nodes.push((node, point)),
                _ => self.bad_node(fields, row, items, plane),
            }
        }
        if rows.is_empty() {
            self.error(
                &codes::WRONG_LENGTH,
                "`nodes` needs at least one row",
                &fields.place("nodes"),
                "no rows",
            );
        }
        nodes
    }

    /// Says what is wrong with a row of a node.
    fn bad_node(
        &mut self,
        fields: Fields<'_>,
        row: &toml::Spanned<DeValue<'_>>,
        items: &[toml::Spanned<DeValue<'_>>],
        plane: bool,
    ) {
        let wanted = if plane { "[id, x, y]" } else { "[id, x, y, z]" };
        let right_length = items.len() == 4 || (plane && items.len() == 3);
        if !right_length {
            let message = format!("a node is a row {wanted}, found {} entries", items.len());
            self.error(
                &codes::WRONG_LENGTH,
                message,
                &fields.at(row.span()),
                "a decimal comma splits one number in two",
            );
            return;
        }
        if items.first().and_then(id).is_none() {
            let span = items.first().map_or(row.span(), toml::Spanned::span);
            self.error(
                &codes::WRONG_TYPE,
                "the number of a node is a whole number from 0 on",
                &fields.at(span),
                "not such a number",
            );
        }
        for item in items.iter().skip(1) {
            match number(item.get_ref()) {
                None => self.error(
                    &codes::WRONG_TYPE,
                    "a coordinate is a number",
                    &fields.at(item.span()),
                    "not a number",
                ),
                Some(number) if !is_usable(number) => {
                    self.error(
                        &codes::NOT_FINITE,
                        "a coordinate is a finite number",
                        &fields.at(item.span()),
                        "not finite, or too small",
                    );
                }
                Some(_) => {}
            }
        }
    }

    pub(super) fn set(&mut self, name: Name, fields: Fields<'_>, place: Place) -> Set {
        let of = fields.text_if("of");
        let content = if fields.has("nodes") {
            SetContent::Nodes(fields.counts("nodes"))
        } else if fields.has("elements") {
            SetContent::Elements(fields.counts("elements"))
        } else if fields.has("faces") {
            SetContent::Faces(self.faces(fields))
        } else if fields.has("union") {
            SetContent::Union(fields.texts("union"))
        } else {
            return Set {
                name,
                content: SetContent::Region {
                    region: self.region(fields),
                    of,
                },
                place,
            };
        };
        if let Some(of) = of {
            self.error(
                &codes::CONTRADICTION,
                "`of` means nothing in a set that lists its content",
                &of.place,
                "it goes with `plane`, `box`, `near` and `sphere`",
            );
        }
        Set {
            name,
            content,
            place,
        }
    }

    fn region(&mut self, fields: Fields<'_>) -> Region {
        if fields.has("box") {
            let [low, high] = self.corners(fields);
            return Region::Box { low, high };
        }
        if let Some(point) = self.vector(fields, "near") {
            return Region::Near { point };
        }
        if let Some([center, radius]) = fields.row("sphere") {
            let center = self.vector_at(center.get_ref(), fields.at(center.span()), "sphere");
            return Region::Sphere {
                center: center.unwrap_or_default(),
                radius: number(radius.get_ref()).unwrap_or_default(),
            };
        }
        Region::Plane {
            normal: self.line(fields, "plane").unwrap_or_default(),
            at: fields.number("at"),
            tol: fields.number_if("tol").map(|tol| tol.value),
        }
    }

    /// The corners of a box; no coordinate of the first is greater than that of the second.
    fn corners(&mut self, fields: Fields<'_>) -> [[f64; 3]; 2] {
        let Some(corners) = fields.row::<2>("box") else {
            return [[0.0; 3]; 2];
        };
        let corners = corners.map(|corner| {
            let point = self.vector_at(corner.get_ref(), fields.at(corner.span()), "box");
            point.unwrap_or_default()
        });
        let [low, high] = corners;
        if low.iter().zip(&high).any(|(low, high)| low > high) {
            self.error(
                &codes::OUT_OF_RANGE,
                "a box from a corner to a smaller one holds nothing",
                &fields.place("box"),
                "the smallest coordinates first, then the largest",
            );
        }
        corners
    }

    pub(super) fn local_axes(&mut self, fields: Fields<'_>, place: Place) -> LocalAxes {
        LocalAxes {
            set: fields.text("set"),
            system: self.axes_system(fields),
            place,
        }
    }

    /// How local axes lie.
    pub(super) fn axes_system(&mut self, fields: Fields<'_>) -> AxesSystem {
        let mut vector = |key| self.vector(fields, key).unwrap_or_default();
        if fields.has("x") {
            AxesSystem::Rectangular {
                x: vector("x"),
                xy: vector("xy"),
            }
        } else {
            AxesSystem::Cylindrical {
                from: vector("from"),
                to: vector("to"),
            }
        }
    }

    pub(super) fn reference_point(
        &mut self,
        name: Name,
        fields: Fields<'_>,
        place: Place,
    ) -> Reference {
        let position = match fields.count_if("node") {
            Some(node) => Position::Node(node.value),
            None if fields.has("at") => Position::At(self.vector(fields, "at").unwrap_or_default()),
            None => Position::Mean,
        };
        Reference {
            name,
            position,
            rotations: fields.count_if("rotations").map(|node| node.value),
            place,
        }
    }

    fn faces(&mut self, fields: Fields<'_>) -> Vec<(u64, Side)> {
        let rows = fields
            .get("faces")
            .and_then(|value| value.get_ref().as_array());
        let mut faces = Vec::new();
        for row in rows.into_iter().flat_map(|rows| rows.iter()) {
            let Some([element, side]) = row.get_ref().as_array().map(|items| &**items) else {
                continue;
            };
            let (Some(element), Some(word)) = (id(element), side.get_ref().as_str()) else {
                continue;
            };
            match Side::parse(word) {
                Some(side) => faces.push((element, side)),
                None => self.error(
                    &codes::NOT_A_CHOICE,
                    format!("there is no side \"{}\"", shortened(word)),
                    &fields.at(side.span()),
                    "a side is \"S1\", \"S2\", … as in Abaqus, or \"+x\", \"-x\", … \"-z\" by its normal",
                ),
            }
        }
        faces
    }
}

/// The space of a word.
pub(super) fn space(word: &str) -> Space {
    let mut known = Space::ALL.into_iter();
    known.find(|one| one.word() == word).unwrap_or_default()
}

/// Rows of element, integration point and a tensor.
pub(super) fn at_points(fields: Fields<'_>, key: &str) -> Vec<AtPoint> {
    let rows = fields.rows(key).filter_map(|row| {
        let items = row.get_ref().as_array()?;
        let mut value = [0.0; 6];
        for (slot, item) in value.iter_mut().zip(items.iter().skip(2)) {
            *slot = number(item.get_ref())?;
        }
        Some(AtPoint {
            element: id(items.first()?)?,
            point: id(items.get(1)?)?,
            value,
            place: fields.at(row.span()),
        })
    });
    rows.collect()
}

/// Thickness at nodes.
pub(super) fn thicknesses_at(root: &Fields<'_>) -> Vec<ThicknessAt> {
    let tables = root.tables("thickness").into_iter();
    let at = tables.map(|(fields, place)| ThicknessAt {
        on: fields.text("on"),
        value: fields.number("value"),
        place,
    });
    at.collect()
}

/// Temperatures of parts at the start.
pub(super) fn temperatures_at(fields: Fields<'_>) -> Vec<TemperatureAt> {
    let tables = fields.tables("at").into_iter();
    let at = tables.map(|(fields, place)| TemperatureAt {
        on: fields.text("on"),
        temperature: fields.number("temperature"),
        gradient: fields.number_if("gradient").map(|number| number.value),
        place,
    });
    at.collect()
}

impl Side {
    /// Reads `S2` or `+z`; capitals do not matter.
    pub fn parse(word: &str) -> Option<Self> {
        let axis = |word: &str| match word {
            "x" | "X" => Some(Axis::X),
            "y" | "Y" => Some(Axis::Y),
            "z" | "Z" => Some(Axis::Z),
            _ => None,
        };
        if let Some(word) = word.strip_prefix('+') {
            return Some(Self::Axis(axis(word)?, Sense::Plus));
        }
        if let Some(word) = word.strip_prefix('-') {
            return Some(Self::Axis(axis(word)?, Sense::Minus));
        }
        let digits = word.strip_prefix(['S', 's'])?;
        let side: u8 = digits.parse().ok()?;
        (side > 0 && digits.bytes().all(|byte| byte.is_ascii_digit()))
            .then_some(Self::Numbered(side))
    }
}
