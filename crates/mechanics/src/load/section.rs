use super::Region;
use super::spread::each_area;
use signorini_geometry::tensor::{Sym3, Vec3};

/// What stresses do on faces, which may lie inside a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Section {
    /// The area; axisymmetric: of the full circumference.
    pub area: f64,
    /// The centre of the area.
    pub center: Vec3,
    /// The mean normal, of unit length: out of the cells that the faces belong to.
    pub normal: Vec3,
    /// `∫ σn dA`: what is beyond the faces exerts on these cells.
    pub force: Vec3,
    /// `∫ x × σn dA`, about the origin.
    pub moment: Vec3,
}

impl Section {
    /// Of faces with their nodes at `x`, from the stress at each node of the mesh.
    #[must_use]
    pub fn new(faces: &Region, x: &[Vec3], stress: &[Sym3]) -> Self {
        let mut sum = Self::default();
        each_area(faces, x, |nodes, shape, directed| {
            let (mut at, mut here) = (Vec3::ZERO, Sym3::ZERO);
            for (&node, n) in nodes.iter().zip(shape) {
                at += x.get(node as usize).copied().unwrap_or_default() * *n;
                here = here + stress.get(node as usize).copied().unwrap_or_default() * *n;
            }
            let force = here.to_mat3() * directed;
            sum.area += directed.norm();
            sum.center += at * directed.norm();
            sum.normal += directed;
            sum.force += force;
            sum.moment += at.cross(force);
        });
        if sum.area > 0.0 {
            sum.center = sum.center / sum.area;
        }
        sum.normal = sum.normal.normalized().unwrap_or_default();
        sum
    }
}
