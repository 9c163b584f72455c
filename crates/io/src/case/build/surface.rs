//! Rigid surfaces that are given by a formula or by triangles.

use super::super::fields::Fields;
use super::super::parts::*;
use super::builder::Builder;
use crate::diagnostic::{Place, codes};
use signorini_vocabulary::Models;

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
        let vocabulary = self.vocabulary;
        let mut shapes = vocabulary.surfaces().iter();
        if let Some(shape) = shapes.find(|shape| fields.has(shape.name)) {
            self.fits_the_space(shape.name, shape.models, fields);
            return Shape::Analytical(self.chosen(fields, shape));
        }
        let path = fields.text("stl");
        if fields.has("stl") && path.trim().is_empty() {
            let remark = "write the path of a file of triangles";
            self.error(&codes::MISSING, "`stl` names no file", &path.place, remark);
        }
        let instead = "write `circle`, `plane` or `polynomial`";
        self.fits_the_space("stl", Models::Space { instead }, fields);
        Shape::Stl { path }
    }

    /// Refuses shapes that models of this space do not have.
    fn fits_the_space(&mut self, name: &str, models: Models, fields: Fields<'_>) {
        let (message, instead) = match (models, self.space.ndim()) {
            (Models::Space { instead }, 2) => {
                (format!("`{name}` is no curve in the plane"), instead)
            }
            (Models::Plane { instead }, 3) => (format!("`{name}` is no surface in space"), instead),
            _ => return,
        };
        if fields.has(name) {
            self.error(&codes::CONTRADICTION, message, &fields.place(name), instead);
        }
    }
}
