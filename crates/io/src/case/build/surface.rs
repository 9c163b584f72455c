//! Rigid surfaces that are given by a formula or by triangles.

use super::super::fields::Fields;
use super::super::parts::*;
use super::super::scalar::number;
use super::Builder;
use crate::diagnostic::{Place, codes};

/// Shapes that only models in space have, and what is meant in the plane.
const OF_SPACE: [(&str, &str); 5] = [
    ("sphere", "write `circle`"),
    ("cylinder", "write `circle`, its section"),
    ("cone", "write `plane`, its section"),
    ("torus", "write `circle`, its section"),
    ("stl", "write `circle`, `plane` or `polynomial`"),
];

impl Builder<'_> {
    pub(super) fn surface(&mut self, fields: Fields<'_>, place: Place) -> Surface {
        Surface {
            name: fields.text("name"),
            shape: self.shape(fields.table("shape")),
            reference: fields.text_if("reference"),
            triangles: None,
            place,
        }
    }

    fn shape(&mut self, fields: Fields<'_>) -> Shape {
        self.shapes_of_the_space(fields);
        let of = |key: &str| fields.table(key);
        if let Some(path) = fields.text_if("stl") {
            if path.trim().is_empty() {
                let remark = "write the path of a file of triangles";
                self.error(&codes::MISSING, "`stl` names no file", &path.place, remark);
            }
            Shape::Stl { path }
        } else if fields.has("sphere") || fields.has("circle") {
            let key = if fields.has("sphere") {
                "sphere"
            } else {
                "circle"
            };
            let ball = of(key);
            Shape::Sphere {
                center: self.point(ball, "center"),
                radius: ball.number("radius"),
                facing: facing(ball),
            }
        } else if fields.has("cylinder") {
            let cylinder = of("cylinder");
            Shape::Cylinder {
                point: self.point(cylinder, "point"),
                axis: self.direction(cylinder, "axis"),
                radius: cylinder.number("radius"),
                facing: facing(cylinder),
            }
        } else if fields.has("cone") {
            let cone = of("cone");
            Shape::Cone {
                apex: self.point(cone, "apex"),
                axis: self.direction(cone, "axis"),
                half_angle: cone.number("half_angle"),
            }
        } else if fields.has("torus") {
            self.torus(of("torus"))
        } else if fields.has("polynomial") {
            let polynomial = of("polynomial");
            let coefficients = polynomial.rows("coefficients");
            Shape::Polynomial {
                coefficients: coefficients.filter_map(|c| number(c.get_ref())).collect(),
                above: polynomial.text("side").value != "below",
            }
        } else {
            let plane = of("plane");
            Shape::Plane {
                point: self.point(plane, "point"),
                normal: self.direction(plane, "normal"),
            }
        }
    }

    fn torus(&mut self, fields: Fields<'_>) -> Shape {
        let (radius, tube) = (fields.number("radius"), fields.number("tube"));
        if radius > 0.0 && tube >= radius {
            self.error(
                &codes::OUT_OF_RANGE,
                format!("a tube of radius {tube} around a circle of radius {radius} meets itself"),
                &fields.place("tube"),
                "must be less than `radius`",
            );
        }
        Shape::Torus {
            center: self.point(fields, "center"),
            axis: self.direction(fields, "axis"),
            radius,
            tube,
            facing: facing(fields),
        }
    }

    /// Refuses shapes that the model has no room for.
    fn shapes_of_the_space(&mut self, fields: Fields<'_>) {
        if self.space.ndim() == 3 {
            if fields.has("circle") {
                self.error(
                    &codes::CONTRADICTION,
                    "`circle` is no surface in space",
                    &fields.place("circle"),
                    "write `sphere` or `cylinder`",
                );
            }
            return;
        }
        for (key, meant) in OF_SPACE.iter().filter(|(key, _)| fields.has(key)) {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` is no curve in the plane"),
                &fields.place(key),
                *meant,
            );
        }
    }

    /// A point, in the plane of a plane model.
    fn point(&mut self, fields: Fields<'_>, key: &str) -> [f64; 3] {
        self.vector_within(fields, key).unwrap_or_default()
    }

    /// A direction, in the plane of a plane model.
    fn direction(&mut self, fields: Fields<'_>, key: &str) -> [f64; 3] {
        let along = self.line(fields, key).unwrap_or_default();
        self.within(along, key, &fields.place(key));
        along
    }
}

fn facing(fields: Fields<'_>) -> Facing {
    if fields.text("side").value == "inside" {
        Facing::Inside
    } else {
        Facing::Outside
    }
}
