use super::Region;
use super::local::gather;
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
        let mut places = Vec::new();
        for (patch, nodes, factor) in faces.pieces() {
            gather(x, nodes, &mut places);
            for sample in patch.samples() {
                let at = sample.position(&places);
                let (t1, t2) = sample.tangents(patch.space(), &places);
                let directed = t1.cross(t2) * (factor * sample.weight);
                let of_nodes = nodes.iter().zip(sample.shape);
                let stress = of_nodes.fold(Sym3::ZERO, |sum, (&node, shape)| {
                    sum + stress.get(node as usize).copied().unwrap_or_default() * *shape
                });
                let force = stress.to_mat3() * directed;
                sum.area += directed.norm();
                sum.center += at * directed.norm();
                sum.normal += directed;
                sum.force += force;
                sum.moment += at.cross(force);
            }
        }
        if sum.area > 0.0 {
            sum.center = sum.center / sum.area;
        }
        sum.normal = sum.normal.normalized().unwrap_or_default();
        sum
    }
}
