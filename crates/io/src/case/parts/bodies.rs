//! Materials, bodies, springs, constraints.

use super::{AxesSystem, Directions, Name, Space};
use crate::diagnostic::{Place, Spanned};

/// How many quadrature points an element has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// The usual ones.
    #[default]
    Full,
    /// One order less, of quadratic elements.
    Reduced,
    /// Nine of wedge6.
    Raised,
}

/// What is done against locking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Locking {
    /// The program chooses.
    #[default]
    Auto,
    /// Nothing.
    None,
    /// A coarser volumetric strain, at small strain.
    BBar,
    /// A coarser volume ratio, at finite strain.
    FBar,
    /// Incompatible modes.
    Incompatible,
    /// The shear strain of the centre everywhere.
    Shear,
}

impl Locking {
    /// Its word in a case.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::None => "none",
            Self::BBar => "b-bar",
            Self::FBar => "f-bar",
            Self::Incompatible => "incompatible",
            Self::Shear => "selective-shear",
        }
    }
}

/// Viscous forces of a material in motions in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialDamping {
    /// Over mass and velocity (1/time).
    pub mass: f64,
    /// Over the initial stiffness and the rate of strain (time).
    pub stiffness: f64,
}

impl MaterialDamping {
    /// Whether there are any.
    pub fn is_any(&self) -> bool {
        *self != Self::default()
    }
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: Name,
    /// Its law, as in `neo-hookean`; empty: it conducts heat alone.
    pub model: Spanned<String>,
    /// The constants of its law, those and no others, in the order of the law.
    pub constants: Vec<Constant>,
    /// The law of the program that runs the case, by its name there; of the model [`OWN`](crate::case::vocabulary::OWN).
    pub own: Option<Name>,
    /// Density (mass per volume).
    pub density: Option<Spanned<f64>>,
    /// Viscous forces in dynamic steps.
    pub damping: MaterialDamping,
    /// Thermal expansion.
    pub expansion: Option<Expansion>,
    /// How it conducts and stores heat.
    pub heat: Option<Conduction>,
    /// Yielding and hardening.
    pub plasticity: Option<Plasticity>,
    /// Where it was written.
    pub place: Place,
}

impl Material {
    /// A constant that is one number.
    pub fn number(&self, name: &str) -> Option<f64> {
        let constant = self.constants.iter().find(|one| one.name == name)?;
        constant.values.first().copied()
    }
}

/// A constant of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Its name, as in `nu`.
    pub name: &'static str,
    /// Its value, or several.
    pub values: Spanned<Vec<f64>>,
}

/// How a material conducts and stores heat.
#[derive(Clone, Debug, PartialEq)]
pub struct Conduction {
    /// What it conducts.
    pub conductivity: Conductivity,
    /// Rows of temperature, increasing, and heat per mass and temperature; one holds at all temperatures; none: it stores nothing.
    pub specific_heat: Vec<[f64; 2]>,
    /// Heat per mass, solidus and liquidus of changes of phase.
    pub latent_heat: Vec<[f64; 3]>,
    /// Where it was written.
    pub place: Place,
}

/// What a material conducts: heat per time, length and temperature.
#[derive(Clone, Debug, PartialEq)]
pub enum Conductivity {
    /// The same in all directions: rows of temperature, increasing, and conductivity; one holds at all temperatures.
    Isotropic(Vec<[f64; 2]>),
    /// Along the axes of the material.
    Along([f64; 3]),
    /// Rows of temperature, increasing, and 11, 22, 33, 12, 23, 13 in the axes of the material.
    Full(Vec<[f64; 7]>),
}

/// Thermal expansion: strain `alpha(T) (T − reference)` in all directions, less what it is where it is to be none.
#[derive(Clone, Debug, PartialEq)]
pub struct Expansion {
    /// Rows of temperature, increasing, and strain per temperature; one holds at all temperatures.
    pub alpha: Vec<[f64; 2]>,
    /// The temperature from which `alpha` counts.
    pub reference: f64,
    /// The temperature without thermal strain.
    pub free: Spanned<Unstrained>,
}

/// The temperature without thermal strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unstrained {
    /// This one.
    At(f64),
    /// What each place is at at the start.
    AtStart,
}

impl Unstrained {
    /// The temperature, where it is the same everywhere.
    #[must_use]
    pub fn given(self) -> Option<f64> {
        match self {
            Self::At(temperature) => Some(temperature),
            Self::AtStart => None,
        }
    }
}

/// Plasticity of von Mises.
#[derive(Clone, Debug, PartialEq)]
pub struct Plasticity {
    /// What yielding does to the yield surface.
    pub hardening: Spanned<Hardening>,
    /// Rows of true yield stress and equivalent plastic strain, from strain zero on.
    pub table: Spanned<Vec<[f64; 2]>>,
    /// Kinematic hardening modulus (stress) of combined hardening.
    pub modulus: Option<Spanned<f64>>,
}

/// What yielding does to the yield surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hardening {
    /// It grows.
    #[default]
    Isotropic,
    /// It moves.
    Kinematic,
    /// It grows along the table and moves with the modulus.
    Combined,
}

/// Groups of elements that make one or more solids, bars or rigid tools.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The groups.
    pub groups: Vec<Name>,
    /// The material; of a rigid body that whose density it has, if any.
    pub material: Option<Name>,
    /// How many quadrature points an element has.
    pub integration: Integration,
    /// What is done against locking.
    pub locking: Spanned<Locking>,
    /// Axes of the material; none: those of the frame.
    pub orientation: Option<BodyAxes>,
    /// What its plane stands for; none: what that of the model does.
    pub space: Option<Spanned<Space>>,
    /// Thickness in a plane model; none: that of the model.
    pub thickness: Option<Spanned<Thickness>>,
    /// What makes shells of its elements; none: they are solids or bars.
    pub shell: Option<Shell>,
    /// How temperatures vary in an element.
    pub temperatures: Temperatures,
    /// How stresses and strains at points are carried to nodes.
    pub at_nodes: AtNodes,
    /// Cross-section of bars (area).
    pub area: Option<Spanned<f64>>,
    /// Whether strains of bars are small in all steps.
    pub small_strain: bool,
    /// Where its mass is in dynamic steps.
    pub mass_matrix: MassMatrix,
    /// Whether it stores heat at nodes, not between them.
    pub lumped_capacity: bool,
    /// Whether it moves as a whole.
    pub rigid: bool,
    /// The reference a rigid body moves with; none: a point of its own, in the mean of its nodes.
    pub reference: Option<Name>,
    /// Where it was written.
    pub place: Place,
}

/// Where the mass of a body is in dynamic steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// As the method of the step wants it: consistent in implicit ones.
    #[default]
    Auto,
    /// Between the nodes of elements.
    Consistent,
    /// At nodes.
    Lumped,
}

/// A mass at each of some nodes, or of a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct MassAt {
    /// The nodes, or the reference or rigid body.
    pub on: Name,
    /// The mass: at each of these nodes.
    pub value: f64,
    /// Its centroid at the start, of a reference; none: there.
    pub centroid: Option<Spanned<[f64; 3]>>,
    /// Moments of inertia about the centroid, of a reference: xx, yy, zz, xy, xz, yz.
    pub inertia: Option<Spanned<[f64; 6]>>,
    /// Where it was written.
    pub place: Place,
}

/// Velocities of some nodes at the start: those of a rigid motion.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityAt {
    /// The nodes.
    pub on: Name,
    /// The velocity at `about`.
    pub velocity: [f64; 3],
    /// The angular velocity (radian per time).
    pub spin: [f64; 3],
    /// A point of the axis of the angular velocity.
    pub about: [f64; 3],
    /// Where it was written.
    pub place: Place,
}

/// What makes shells of the elements of a body, which lie in space and have two dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Shell {
    /// Thickness.
    pub thickness: Spanned<Thickness>,
    /// Distance of the nodes from the middle surface, in thicknesses, positive towards the positive side.
    pub offset: f64,
    /// The angle (degrees) up to which elements at a node share their normal.
    pub normals: Spanned<f64>,
    /// Integration points through the thickness.
    pub points: usize,
    /// Where it was written.
    pub place: Place,
}

impl Shell {
    /// The angle (degrees) up to which elements at a node share their normal, where nothing else is given.
    pub const NORMALS: f64 = 20.0;
    /// Integration points through the thickness, where nothing else is given.
    pub const POINTS: usize = 2;
}

/// The thickness of a body in the plane, or of a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thickness {
    /// The same everywhere (length).
    Uniform(f64),
    /// That of each node: see [`ThicknessAt`].
    Field,
}

/// The thickness at some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct ThicknessAt {
    /// The nodes.
    pub on: Name,
    /// Their thickness (length).
    pub value: f64,
    /// Where it was written.
    pub place: Place,
}

/// The temperature of some nodes at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureAt {
    /// The nodes.
    pub on: Name,
    /// Their temperature.
    pub temperature: f64,
    /// Of shells: its change per length along their normal; none: 0.
    pub gradient: Option<f64>,
    /// Where it was written.
    pub place: Place,
}

/// How temperatures vary in an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Temperatures {
    /// As its shape functions do.
    #[default]
    Full,
    /// Linearly in quad8 and hex20 with full integration: those at the points of reduced integration, continued.
    Linear,
}

/// How stresses and strains at the points of an element are carried to its nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtNodes {
    /// By the linear field that comes closest to them.
    #[default]
    Linear,
    /// By the field of its own shape functions that comes closest to them, where it has as many points as nodes.
    Element,
}

/// Axes of the material of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyAxes {
    /// The same everywhere.
    Here(Orientation),
    /// Those of an orientation of the case.
    Named(Name),
}

impl BodyAxes {
    /// Where they were written.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Here(one) => &one.place,
            Self::Named(name) => &name.place,
        }
    }
}

/// Named axes of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedOrientation {
    /// Its name.
    pub name: Name,
    /// How the axes lie.
    pub system: MaterialSystem,
    /// One of the axes, from 0, about which all are turned then, and by how many degrees.
    pub turn: Option<(usize, f64)>,
    /// Where it was written.
    pub place: Place,
}

/// How axes of materials lie.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialSystem {
    /// The same everywhere.
    Rectangular {
        /// Along the first axis.
        x: [f64; 3],
        /// Towards the second axis.
        y: [f64; 3],
    },
    /// Radial, circumferential and along an axis, at every integration point.
    Cylindrical {
        /// A point of the axis.
        origin: [f64; 3],
        /// Its direction, of any length.
        axis: [f64; 3],
    },
    /// By element.
    Elements {
        /// Along the first axis of elements without a row.
        x: [f64; 3],
        /// Towards their second axis.
        y: [f64; 3],
        /// Those of elements.
        rows: Vec<ElementAxes>,
    },
}

/// Axes in an element.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementAxes {
    /// Its number.
    pub element: u64,
    /// Along the first axis.
    pub x: [f64; 3],
    /// Towards the second axis.
    pub y: [f64; 3],
    /// Where it was written.
    pub place: Place,
}

/// Axes of a material: x, and y in the plane of both vectors. Of any length, not parallel.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// Along the first axis.
    pub x: [f64; 3],
    /// Towards the second axis.
    pub y: [f64; 3],
    /// Where it was written.
    pub place: Place,
}

/// A spring, or one between each pair of nodes of two sets.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Its name.
    pub name: Name,
    /// What it is tied to.
    pub ends: SpringEnds,
    /// Its force, by its elongation.
    pub law: SpringLaw,
    /// Its direction, fixed in space, of any length; none: along the line between its ends.
    pub direction: Option<[f64; 3]>,
    /// Where it was written.
    pub place: Place,
}

/// The force of a spring, by its elongation.
#[derive(Clone, Debug, PartialEq)]
pub enum SpringLaw {
    /// In proportion: force over elongation.
    Linear(f64),
    /// Rows of force and elongation; straight between, constant outside.
    Table(Vec<[f64; 2]>),
}

/// What a spring is tied to.
#[derive(Clone, Debug, PartialEq)]
pub enum SpringEnds {
    /// Two sets of as many nodes, paired in their order.
    Between(Name, Name),
    /// The nodes of a set and the ground.
    Ground(Name),
}

/// A constraint.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// What it says.
    pub kind: ConstraintKind,
    /// Where it was written.
    pub place: Place,
}

/// What a constraint says.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind {
    /// The sum of coefficient times motion is `rhs`; for sets of several nodes, node by node in their order.
    Equation {
        /// The summands.
        terms: Vec<Summand>,
        /// The right-hand side.
        rhs: f64,
    },
    /// The nodes follow the reference as a rigid body does, in these directions.
    Kinematic {
        /// The nodes.
        on: Name,
        /// What they follow.
        reference: Name,
        /// The directions.
        axes: Directions,
        /// The axes that these are along, at the place of each node; absent: those of the model.
        local: Option<AxesSystem>,
    },
    /// The reference follows the mean motion of the nodes, which stay free to deform.
    Distributing {
        /// The nodes.
        on: Name,
        /// What follows them.
        reference: Name,
    },
    /// The nodes stay in a plane, which may move and turn.
    Plane {
        /// The nodes.
        on: Name,
    },
    /// These displacements of all nodes are equal.
    Equal {
        /// The nodes.
        on: Name,
        /// The directions.
        axes: Directions,
    },
    /// The nodes stay on a line, which may move and turn.
    Line {
        /// The nodes.
        on: Name,
    },
    /// Two nodes keep their distance, or go no farther apart than `most`.
    Distance {
        /// The nodes.
        on: Name,
        /// The largest distance.
        most: Option<f64>,
    },
    /// The x of the reference is the angle (radian) by which the nodes turn in the mean about an axis through their mean.
    Twist {
        /// The nodes.
        on: Name,
        /// Whose x is the angle.
        reference: Name,
        /// The direction of the axis.
        axis: [f64; 3],
    },
    /// The body is cut at faces; the x of the reference is by how much the two sides overlap.
    Pretension {
        /// The faces, of the side that the normal points away from.
        on: Name,
        /// Whose x is the overlap, and whose force along x pulls the sides together.
        reference: Name,
        /// Along what; `None`: the mean normal of the faces.
        normal: Option<[f64; 3]>,
    },
    /// The nodes of one side of a sector move as those of the other side do, turned by the angle of the sector.
    Cyclic {
        /// The nodes that follow.
        on: Name,
        /// Those they follow.
        with: Name,
        /// How many sectors make the whole.
        sectors: u64,
        /// A point of the axis.
        point: [f64; 3],
        /// The direction of the axis.
        axis: [f64; 3],
    },
}

/// A summand of an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Summand {
    /// A set of nodes, a reference or a rigid body.
    pub on: Name,
    /// 0 to 2: displacement along x, y, z; 3 to 5: rotation about them.
    pub component: Spanned<usize>,
    /// What it is multiplied with.
    pub coefficient: f64,
}
