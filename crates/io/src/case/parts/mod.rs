//! What a run is asked to do, as plain structs that any reader fills.
//!
//! Numbers are in the units of the case; nothing is converted. Names refer to groups of the mesh or to sets of the
//! case. Values that later messages may point at remember where they were written ([`Spanned`]).

mod bodies;
mod contact;
mod geometry;
mod run;
mod steps;
mod surface;

pub use bodies::*;
pub use contact::*;
pub use geometry::*;
pub use run::*;
pub use steps::*;
pub use surface::*;

use crate::diagnostic::Spanned;

/// A name and where it was written.
pub type Name = Spanned<String>;

/// A whole case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Version of the case format.
    pub format: u32,
    /// What the run is about, for reports.
    pub title: String,
    /// The label of units, as in `mm-N-MPa`; empty where none is given.
    pub units: Spanned<String>,
    /// Codes of warnings that are silenced.
    pub allow: Vec<String>,
    /// Where nodes and elements come from.
    pub mesh: MeshSource,
    /// Dimension of the model.
    pub model: Model,
    /// Named sets of nodes and faces.
    pub sets: Vec<Set>,
    /// Named points with translations and rotations of their own.
    pub references: Vec<Reference>,
    /// Local axes of nodes, that tables are printed along; the last that names a node holds for it.
    pub axes: Vec<LocalAxes>,
    /// Named functions of time.
    pub amplitudes: Vec<Amplitude>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Named axes of materials.
    pub orientations: Vec<NamedOrientation>,
    /// Which groups are solids, bars or rigid tools.
    pub bodies: Vec<Body>,
    /// Thickness at nodes, of plane bodies that take it; of several that name a node the last holds.
    pub thicknesses: Vec<ThicknessAt>,
    /// Springs.
    pub springs: Vec<Spring>,
    /// Rigid surfaces without a mesh.
    pub surfaces: Vec<Surface>,
    /// Pairs of surfaces that may touch.
    pub contacts: Vec<Contact>,
    /// Contact of everything with everything.
    pub general: Option<General>,
    /// Constraints between displacements.
    pub constraints: Vec<Constraint>,
    /// Temperature of everything at the start; none: where no material expands, or as the build finds it.
    pub initial_temperature: Option<Spanned<f64>>,
    /// Constants of nature.
    pub constants: Option<Constants>,
    /// Temperatures of parts at the start; of several that name a node the last holds.
    pub initial_temperatures: Vec<TemperatureAt>,
    /// Velocities of parts at the start; of several that name a node the last holds.
    pub initial_velocities: Vec<VelocityAt>,
    /// Masses at nodes.
    pub masses: Vec<MassAt>,
    /// Stress without strain at integration points, at the start.
    pub initial_stress: Vec<AtPoint>,
    /// Strain without stress at integration points, at the start.
    pub initial_strain: Vec<AtPoint>,
    /// What happens, in order.
    pub steps: Vec<Step>,
    /// Steps that come again.
    pub cycles: Vec<Cycle>,
    /// How equations are solved.
    pub solver: Solver,
    /// What is written.
    pub output: Output,
    /// When a run can be resumed from.
    pub checkpoint: Checkpoint,
    /// Values that are checked at the end.
    pub expectations: Vec<Expectation>,
}

impl Case {
    /// A case of nothing, with every key at its default.
    #[must_use]
    pub fn empty() -> Self {
        super::build::empty()
    }

    /// The names a case with its mesh in place knows of itself: groups of elements, sets, surfaces, references. A mesh
    /// file adds its own.
    pub fn names(&self) -> Vec<&str> {
        let sets = self.sets.iter().map(|set| set.name.as_str());
        let references = self.references.iter().map(|one| one.name.as_str());
        let surfaces = self.surfaces.iter().map(|one| one.name.as_str());
        let mut names: Vec<&str> = sets.chain(references).chain(surfaces).collect();
        if let MeshSource::Inline { elements, .. } = &self.mesh {
            names.extend(
                elements
                    .iter()
                    .filter_map(|one| one.group.as_deref())
                    .map(String::as_str),
            );
        }
        names.sort_unstable();
        names.dedup();
        names
    }
}
