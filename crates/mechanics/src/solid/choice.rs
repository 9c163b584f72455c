/// How many quadrature points an element has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// As many as integrate the stiffness of the undistorted element exactly.
    #[default]
    Full,
    /// One order less, for quad8 and hex20; elements of lower order keep the full rule.
    Reduced,
}

/// What is done against locking in bending and of nearly incompressible materials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Locking {
    /// What suits the element, the idealisation and the size of strains.
    #[default]
    Auto,
    /// Nothing.
    None,
    /// The volumetric strain is averaged over the element; small strain.
    BBar,
    /// The volume ratio is averaged over the element, in variational form; finite strain.
    FBar,
    /// Incompatible modes, condensed; small strain only, for they are unstable in compression at finite strain.
    Incompatible,
}
