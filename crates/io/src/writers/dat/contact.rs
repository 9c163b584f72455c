//! Tables of contact.

use super::{Of, Page};
use signorini_geometry::tensor::Vec3;

/// What a table of contact holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// Gap, negative in penetration, and slip along two tangents, of closed nodes.
    Gaps,
    /// The same, means over closed parts of faces.
    FaceGaps,
    /// Pressure, and the traction against which they slip along two tangents, of closed nodes.
    Tractions,
    /// The same, means over closed parts of faces.
    FaceTractions,
    /// Energy of closed nodes.
    Energies,
    /// Energy of faces.
    FaceEnergies,
    /// Its sum.
    TotalEnergy,
    /// The number of closed nodes.
    Count,
}

impl ContactKind {
    const fn caption(self) -> &'static str {
        match self {
            Self::Gaps => {
                "relative contact displacement (slave node,normal,tang1,tang2) for all contact elements and time"
            }
            Self::Tractions => {
                "contact stress (slave node,press,tang1,tang2) for all contact elements and time"
            }
            Self::FaceGaps => {
                "relative contact displacement (slave element+face,normal,tang1,tang2) for all contact elements and time"
            }
            Self::FaceTractions => {
                "contact stress (slave element+face,press,tang1,tang2) for all contact elements and time"
            }
            Self::FaceEnergies => {
                "contact print energy (slave element+face,energy)for all contact elements and time"
            }
            // no blank: so it is written
            Self::Energies => {
                "contact print energy (slave node,energy) forall contact elements and time"
            }
            Self::TotalEnergy => "total contact spring energy for time ",
            Self::Count => "total number of contact elements for time ",
        }
    }
}

/// What the secondary side of a contact feels, or faces of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Force on it.
    pub force: Vec3,
    /// Its moment about the origin.
    pub moment: Vec3,
    /// Centre of the area.
    pub center: Vec3,
    /// Mean normal out of the body.
    pub normal: Vec3,
    /// Area: of a contact, the closed part.
    pub area: f64,
}

impl Statistics {
    fn about_center(&self) -> Vec3 {
        self.moment - self.center.cross(self.force)
    }
}

impl Page {
    /// Begins a table of contact.
    pub fn contact_table(&mut self, kind: ContactKind) {
        let (caption, time) = (kind.caption(), std::mem::take(&mut self.time));
        self.line(format_args!("\n {caption}{time}\n"));
        self.time = time;
    }

    /// Adds the row of a table that counts.
    pub fn count(&mut self, count: usize) {
        self.line(format_args!("{count:17}"));
    }

    /// Adds the resultants of a contact between these two sides.
    pub fn statistics(&mut self, secondary: &str, primary: &str, of: &Statistics) {
        let [secondary, primary] = [secondary, primary].map(str::to_ascii_uppercase);
        let sides = format!("slave set {secondary}, master set {primary}");
        self.resultants(
            &sides,
            of,
            "total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)",
            (
                "area,  normal force (+ = tension) and shear force (size)",
                &[],
            ),
        );
    }

    /// Adds the resultants of stresses on these faces.
    pub fn section(&mut self, faces: &str, of: &Statistics) {
        let faces = format!("surface set {}", faces.to_ascii_uppercase());
        let moment = of.about_center();
        let torque = moment.dot(of.normal);
        let bending = (moment - of.normal * torque).norm();
        self.resultants(
            &faces,
            of,
            "total surface force (fx,fy,fz) and moment about the origin(mx,my,mz)",
            (
                "area, normal force (+ = tension), shear force (size), torque and bending moment (size)",
                &[torque, bending],
            ),
        );
    }

    fn resultants(
        &mut self,
        on: &str,
        of: &Statistics,
        force: &str,
        (sizes, more): (&str, &[f64]),
    ) {
        let time = std::mem::take(&mut self.time);
        self.line(format_args!("\n\n statistics for {on} and time {time}"));
        self.time = time;
        let both = |a: Vec3, b: Vec3| [a.to_array(), b.to_array()].concat();
        let along = of.force.dot(of.normal);
        let across = (of.force - of.normal * along).norm();
        let lines = [
            (force, both(of.force, of.moment)),
            (
                "center of gravity and mean normal",
                both(of.center, of.normal),
            ),
            (
                "moment about the center of gravity(mx,my,mz)",
                of.about_center().to_array().to_vec(),
            ),
            (sizes, [&[of.area, along, across], more].concat()),
        ];
        for (caption, numbers) in lines {
            self.line(format_args!("\n   {caption}\n"));
            self.row(Of::Both, &numbers);
        }
    }
}

/// The tangents of tables: the first along x as far as that lies in the plane, along z where the normal is x.
#[must_use]
pub fn tangents(normal: Vec3) -> [Vec3; 2] {
    let within = |axis: usize| {
        let unit = Vec3::unit(axis);
        (unit - normal * unit.dot(normal)).normalized()
    };
    let is_x = 1.0 - normal.x * normal.x < ALONG;
    let first = within(if is_x { 2 } else { 0 }).unwrap_or_default();
    [first, normal.cross(first)]
}

/// The square of the sine up to which a normal counts as along x.
const ALONG: f64 = 1e-10;
