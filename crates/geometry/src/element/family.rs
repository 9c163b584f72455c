use crate::tensor::Vec3;

/// The shape of a reference domain, whatever the degree of the element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// `ξ ∈ [-1, 1]`.
    Line,
    /// Area coordinates `ξ = L2`, `η = L3`.
    Triangle,
    /// `ξ, η ∈ [-1, 1]`.
    Quadrilateral,
    /// Volume coordinates `ξ = L2`, `η = L3`, `ζ = L4`.
    Tetrahedron,
    /// `ξ, η, ζ ∈ [-1, 1]`.
    Hexahedron,
    /// A triangle (`ξ = L2`, `η = L3`) along a line `ζ ∈ [-1, 1]`.
    Wedge,
}

impl Family {
    /// The dimension of the reference domain: 1, 2 or 3.
    #[must_use]
    pub const fn dim(self) -> usize {
        match self {
            Self::Line => 1,
            Self::Triangle | Self::Quadrilateral => 2,
            Self::Tetrahedron | Self::Hexahedron | Self::Wedge => 3,
        }
    }

    /// The number of corners.
    #[must_use]
    pub const fn ncorner(self) -> usize {
        match self {
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quadrilateral | Self::Tetrahedron => 4,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
        }
    }

    /// The edges as pairs of corners, in the order in which they bound the element (faces: round the boundary). In the
    /// reference domain they are straight.
    #[must_use]
    pub const fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Self::Line => &[[0, 1]],
            Self::Triangle => &[[0, 1], [1, 2], [2, 0]],
            Self::Quadrilateral => &[[0, 1], [1, 2], [2, 3], [3, 0]],
            Self::Tetrahedron => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
            Self::Hexahedron => &[
                [0, 1],
                [1, 2],
                [2, 3],
                [3, 0],
                [4, 5],
                [5, 6],
                [6, 7],
                [7, 4],
                [0, 4],
                [1, 5],
                [2, 6],
                [3, 7],
            ],
            Self::Wedge => &[
                [0, 1],
                [1, 2],
                [2, 0],
                [3, 4],
                [4, 5],
                [5, 3],
                [0, 3],
                [1, 4],
                [2, 5],
            ],
        }
    }

    /// Whether `xi` lies in the reference domain, exceeded by at most `tolerance`.
    #[must_use]
    pub fn contains(self, xi: &Vec3, tolerance: f64) -> bool {
        let along = |x: f64| x.abs() <= 1.0 + tolerance;
        let positive = |x: f64| x >= -tolerance;
        match self {
            Self::Line => along(xi.x),
            Self::Triangle => positive(xi.x) && positive(xi.y) && xi.x + xi.y <= 1.0 + tolerance,
            Self::Quadrilateral => along(xi.x) && along(xi.y),
            Self::Tetrahedron => {
                positive(xi.x)
                    && positive(xi.y)
                    && positive(xi.z)
                    && xi.x + xi.y + xi.z <= 1.0 + tolerance
            }
            Self::Hexahedron => along(xi.x) && along(xi.y) && along(xi.z),
            Self::Wedge => {
                positive(xi.x) && positive(xi.y) && xi.x + xi.y <= 1.0 + tolerance && along(xi.z)
            }
        }
    }
}
