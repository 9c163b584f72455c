use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;

/// The number of an unknown, prescribed ones included.
pub type Dof = u32;

/// No unknown: what is added to it is dropped (the third direction of a problem in the plane).
pub const NO_DOF: Dof = u32::MAX;

/// Which raw dof is which: displacements node by node, then rigid bodies, then multipliers.
///
/// A rigid body has its translation first, then its rotation: `x y z θx θy θz` in space, `x y θz` in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Dimension of space: 2 or 3.
    pub ndim: usize,
    /// Number of nodes.
    pub nnode: usize,
    /// Number of rigid bodies.
    pub nrigid: usize,
    /// Number of multipliers.
    pub nmultiplier: usize,
}

/// What a raw dof is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofName {
    /// Displacement of a node along an axis.
    Node(NodeId, usize),
    /// Translation of a rigid body along an axis.
    Translation(RigidId, usize),
    /// Rotation of a rigid body about an axis.
    Rotation(RigidId, usize),
    /// A multiplier.
    Multiplier(usize),
}

impl Layout {
    /// Unknowns of one rigid body: 6 in space, 3 in the plane.
    #[must_use]
    pub const fn nrigid_dof(&self) -> usize {
        if self.ndim == 3 { 6 } else { 3 }
    }

    /// The number of raw dofs.
    #[must_use]
    pub const fn ndof(&self) -> usize {
        self.first_multiplier() + self.nmultiplier
    }

    /// Displacement of a node along an axis; none along `z` in the plane.
    #[inline]
    #[must_use]
    pub const fn node(&self, node: NodeId, axis: usize) -> Dof {
        if axis < self.ndim {
            node * self.ndim as u32 + axis as u32
        } else {
            NO_DOF
        }
    }

    /// Translation of a rigid body along an axis; none along `z` in the plane.
    #[must_use]
    pub const fn translation(&self, body: RigidId, axis: usize) -> Dof {
        if axis < self.ndim {
            self.first_rigid() + body * self.nrigid_dof() as u32 + axis as u32
        } else {
            NO_DOF
        }
    }

    /// Rotation of a rigid body about an axis; in the plane only about `z`.
    #[must_use]
    pub const fn rotation(&self, body: RigidId, axis: usize) -> Dof {
        let first = self.first_rigid() + body * self.nrigid_dof() as u32 + self.ndim as u32;
        match (self.ndim, axis) {
            (3, _) => first + axis as u32,
            (_, 2) => first,
            _ => NO_DOF,
        }
    }

    /// A multiplier.
    #[must_use]
    pub const fn multiplier(&self, number: usize) -> Dof {
        (self.first_multiplier() + number) as Dof
    }

    /// The number of displacements and rotations: the raw dofs before the multipliers.
    #[must_use]
    pub const fn nmotion(&self) -> usize {
        self.first_multiplier()
    }

    /// The rigid body whose translation or rotation a raw dof is.
    #[must_use]
    pub const fn carrier(&self, dof: Dof) -> Option<RigidId> {
        let d = dof as usize;
        if d < self.nnode * self.ndim || d >= self.first_multiplier() {
            return None;
        }
        Some(((d - self.nnode * self.ndim) / self.nrigid_dof()) as RigidId)
    }

    /// What a raw dof is; `None` beyond the last.
    #[must_use]
    pub fn name(&self, dof: Dof) -> Option<DofName> {
        let (d, nodal) = (dof as usize, self.nnode * self.ndim);
        if d < nodal {
            return Some(DofName::Node(dof / self.ndim as u32, d % self.ndim));
        }
        if d < self.first_multiplier() {
            let (body, k) = (
                (d - nodal) / self.nrigid_dof(),
                (d - nodal) % self.nrigid_dof(),
            );
            return Some(match (k < self.ndim, self.ndim) {
                (true, _) => DofName::Translation(body as RigidId, k),
                (false, 2) => DofName::Rotation(body as RigidId, 2),
                (false, _) => DofName::Rotation(body as RigidId, k - 3),
            });
        }
        (d < self.ndof()).then(|| DofName::Multiplier(d - self.first_multiplier()))
    }

    const fn first_rigid(&self) -> Dof {
        (self.nnode * self.ndim) as Dof
    }

    const fn first_multiplier(&self) -> usize {
        self.nnode * self.ndim + self.nrigid * self.nrigid_dof()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_invert_numbers() {
        for ndim in [2, 3] {
            let layout = Layout {
                ndim,
                nnode: 5,
                nrigid: 2,
                nmultiplier: 3,
            };
            let mut seen = 0;
            for dof in 0..layout.ndof() as Dof {
                let back = match layout.name(dof).unwrap() {
                    DofName::Node(n, c) => layout.node(n, c),
                    DofName::Translation(b, c) => layout.translation(b, c),
                    DofName::Rotation(b, c) => layout.rotation(b, c),
                    DofName::Multiplier(i) => layout.multiplier(i),
                };
                assert_eq!(back, dof);
                let carrier = match layout.name(dof).unwrap() {
                    DofName::Translation(b, _) | DofName::Rotation(b, _) => Some(b),
                    _ => None,
                };
                assert_eq!(layout.carrier(dof), carrier);
                seen += 1;
            }
            assert_eq!(seen, 5 * ndim + 2 * layout.nrigid_dof() + 3);
            assert_eq!(layout.name(layout.ndof() as Dof), None);
        }
    }
}
