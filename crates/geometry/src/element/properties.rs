//! What methods need to know of an element, as data.

/// How mortar contact makes functions `Ñ = T N` without negative values from the shape functions of a facet, as its dual
/// basis needs them. Every variant keeps `Σ Ñ = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DualBasis {
    /// `T = 1`: the shape functions themselves are not negative.
    Shape,
    /// Each mid node of an edge leaves a part of its function to the two corners:
    /// `Ñ_corner = N_corner + α Σ N_edge`, `Ñ_edge = (1 − 2α) N_edge`.
    Edges {
        /// α with which `Ñ` are not negative at any point.
        pointwise: f64,
        /// α with which `∫Ñ` are positive over the whole facet, nearer to those of an even pressure.
        whole: f64,
    },
    /// The same with one α along each axis: the tensor product over a line or a quadrilateral with a centre.
    Axes {
        /// α, with which `Ñ` are not negative at any point.
        alpha: f64,
    },
}

/// How an element locks in bending and for nearly incompressible materials, which decides on the remedies it can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LockingClass {
    /// Strains are constant, or nearly so: too stiff in bending, and the dilatation leaves nothing to project.
    ConstantStrain,
    /// Linear along each axis: incompatible modes free bending, and a constant dilatation the change of volume.
    Multilinear,
    /// Quadratic or more: bending is free; the dilatation can be projected onto a polynomial.
    HigherOrder {
        /// Terms of the polynomial for which the displacements hold enough bubbles: 1 for a constant one, or 1 more for
        /// each axis for a linear one.
        ndilatation: usize,
    },
}
