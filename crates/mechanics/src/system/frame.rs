use super::{ContactAudit, HeatBalance, Samples};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, Face};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;

/// The state of contact at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Status {
    /// Nothing of the other side is within reach.
    #[default]
    Absent,
    /// Not touching.
    Open,
    /// Touching, without relative motion.
    Stick,
    /// Touching and free to slide; closed contact without friction counts as this.
    Slip,
    /// Joined.
    Tied,
}

impl Status {
    /// The number it has in files: −1 not a candidate, 0 open, 1 stick, 2 slip, 3 tied.
    #[must_use]
    pub const fn number(self) -> i8 {
        match self {
            Self::Absent => -1,
            Self::Open => 0,
            Self::Stick => 1,
            Self::Slip => 2,
            Self::Tied => 3,
        }
    }

    /// Whether it touches.
    #[must_use]
    pub const fn is_closed(self) -> bool {
        matches!(self, Self::Stick | Self::Slip | Self::Tied)
    }
}

/// A force and its moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// The force.
    pub force: Vec3,
    /// The moment about the point that the context names.
    pub moment: Vec3,
}

/// What happened where a part of the secondary side touches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSample {
    /// Its area.
    pub area: f64,
    /// The mean normal out of the primary side, of unit length.
    pub normal: Vec3,
    /// The mean gap.
    pub gap: f64,
    /// The mean pressure.
    pub pressure: f64,
    /// The mean traction on the secondary side.
    pub traction: Vec3,
    /// The mean slip, with what sticking has yielded.
    pub slip: Vec3,
    /// The energy in its springs.
    pub energy: f64,
}

/// The part of the secondary side that touches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Its area.
    pub area: f64,
    /// The centre of its area.
    pub center: Vec3,
    /// The mean normal out of the primary side, of unit length.
    pub normal: Vec3,
}

/// What happened at one contact interface.
#[derive(Clone, Debug, Default)]
pub struct ContactFrame {
    /// Name of the interface.
    pub name: String,
    /// Nodes of the secondary side.
    pub nodes: Vec<u32>,
    /// Their present positions.
    pub points: Vec<Vec3>,
    /// Their displacements.
    pub displacement: Vec<Vec3>,
    /// Facets of the secondary side as indices into `points`; empty where it is bare nodes.
    pub facets: Vec<(Element, Vec<u32>)>,
    /// Unit normal out of the primary side at each node; zero where nothing is within reach.
    pub normal: Vec<Vec3>,
    /// Gap at each node: positive open, negative penetration. NaN where nothing is within reach.
    pub gap: Vec<f64>,
    /// Pressure at each node, ≥ 0; force where the secondary side has no area. By mortar it is that of the present area at
    /// finite strain, and of the area at the start in linear steps.
    pub pressure: Vec<f64>,
    /// The largest pressure of the points around each node, those inside its facets where the method has points there.
    /// The largest of all is `pressure_max`.
    pub pressure_peak: Vec<f64>,
    /// The pressure in the equations at each node, of its multiplier or of its law, before smoothing; a mean over points
    /// as `pressure` is, which equals it where nothing is smoothed.
    pub multiplier: Vec<f64>,
    /// The traction in the equations at each node, likewise; `traction` equals it where nothing is smoothed.
    pub multiplier_traction: Vec<Vec3>,
    /// Status at each node.
    pub status: Vec<Status>,
    /// Whether something acts at each node: it is closed, or so near that a law acts that pulls at a distance.
    pub acts: Vec<bool>,
    /// Contact force on each secondary node.
    pub force: Vec<Vec3>,
    /// Traction on the secondary side at each node, the mean over the points around it.
    pub traction: Vec<Vec3>,
    /// Accumulated slip at each node.
    pub slip: Vec<Vec3>,
    /// What sticking has yielded at each node, in addition to its slip.
    pub elastic_slip: Vec<Vec3>,
    /// Energy that springs of the contact law, and of sticking, hold at each node.
    pub energy: Vec<f64>,
    /// The faces of the secondary side with points inside that touch; `None` where the points are its nodes.
    pub faces: Option<Vec<(Face, ContactSample)>>,
    /// What touches.
    pub footprint: Footprint,
    /// Tributary area of each node: by mortar, the part that is covered, and none of a node that leans on another one.
    pub area: Vec<f64>,
    /// What the primary side exerts on the secondary; moment about the origin.
    pub secondary: Resultant,
    /// What the secondary side exerts on the primary; moment about the origin.
    pub primary: Resultant,
    /// How histories report it, where that is not by its own name; `None`: by that, with the force on the secondary side.
    pub reported_as: Option<ReportedAs>,
    /// The part of the force on the secondary side that pressures exert.
    pub force_normal: Vec3,
    /// The moment of that part about the origin.
    pub moment_normal: Vec3,
    /// The part that tangential tractions exert.
    pub force_shear: Vec3,
    /// The largest pressure at a point: the largest of `pressure_peak`.
    pub pressure_max: f64,
    /// The smallest gap; 0 where nothing is within reach.
    pub gap_min: f64,
    /// The largest accumulated slip.
    pub slip_max: f64,
    /// Open area.
    pub area_open: f64,
    /// Sticking area.
    pub area_stick: f64,
    /// Slipping area.
    pub area_slip: f64,
    /// Centre of pressure; zero without contact.
    pub center: Vec3,
    /// Work spent in friction since the start.
    pub work_friction: f64,
    /// Of a contact with a fluid, how much of each node is wet, from 0 to 1; else empty.
    pub wet: Vec<f64>,
    /// What its fluid does.
    pub fluid: Option<FluidFrame>,
    /// Of a contact with a gasket, its closure at each node, and the largest so far; else empty.
    pub closure: Vec<f64>,
    /// The largest closure so far.
    pub closure_max: Vec<f64>,
    /// Damage of the joint at each node, from 0 to 1, the mean over the points around it; empty where none may break.
    pub damage: Vec<f64>,
    /// Energy that damage has taken since the start.
    pub work_damage: f64,
    /// Work spent since the start by the viscosity that delays damage.
    pub work_viscous: f64,
    /// Characteristic size of the facets, for judging the penetration.
    pub facet_size: f64,
    /// The largest motion since the start of what touched, along the other side, over that size, and its node; `None` where
    /// contact follows what moves.
    pub drift: Option<(f64, u32)>,
    /// Rows that touch and whose multipliers act on nothing that moves.
    pub idle: IdleRows,
    /// What its sides have lost, where they wear.
    pub wear: Option<Wear>,
    /// The heat across it, where it conducts and temperatures are unknown.
    pub warmth: Option<ContactWarmth>,
}

/// Heat across a contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactWarmth {
    /// Heat per time and area from the secondary side to the primary at each node of the secondary side, the mean over the points
    /// around it; that of friction is not in it.
    pub flux: Vec<f64>,
    /// The conductance there, likewise.
    pub conductance: Vec<f64>,
    /// Heat per time and area that friction sets free there, likewise.
    pub friction: Vec<f64>,
    /// Heat per time from the secondary side to the primary.
    pub through: f64,
    /// Heat per time that friction sets free.
    pub rubbed: f64,
}

/// What the sides of a contact have lost by wear.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wear {
    /// Depth at each node of the secondary side, the mean over the points around it.
    pub depth: Vec<f64>,
    /// Depth at nodes of the primary side; empty where that does not wear.
    pub opposite: Vec<(u32, f64)>,
    /// Volume of each side, the secondary one first.
    pub volume: [f64; 2],
    /// The largest depth at a point of either side, and a node there.
    pub deepest: f64,
    /// See `deepest`.
    pub node: Option<u32>,
}

/// What a fluid between the sides of a contact does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FluidFrame {
    /// Its pressure.
    pub pressure: f64,
    /// The area that is wet.
    pub area: f64,
    /// What it exerts on the secondary side, and the opposite on the primary; moment about the origin. Contact forces are
    /// without it.
    pub on_secondary: Resultant,
    /// A node at a side of the rim that the fluid has reached and did not come from: it leaks.
    pub leak: Option<u32>,
}

/// Rows whose multipliers are left out, as what they act on is prescribed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IdleRows {
    /// How many, with all of their multipliers.
    pub whole: usize,
    /// How many others without friction along each axis.
    pub friction: [usize; 3],
    /// A node of one of them.
    pub node: Option<u32>,
}

impl IdleRows {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// How histories report a contact: several of one name together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportedAs {
    /// The name.
    pub name: String,
    /// Whether with the force on the primary side.
    pub on_primary: bool,
}

impl ContactFrame {
    /// Adds the second pass of this contact, whose sides are swapped; its pressures and tractions at the nodes are in
    /// already.
    pub fn add_pass(&mut self, pass: &Self) {
        for (to, from) in [
            (&mut self.secondary, &pass.primary),
            (&mut self.primary, &pass.secondary),
        ] {
            to.force += from.force;
            to.moment += from.moment;
        }
        self.force_normal -= pass.force_normal;
        self.moment_normal -= pass.moment_normal;
        self.force_shear -= pass.force_shear;
        // the sides feel the pressures of both passes
        self.pressure_peak.clone_from(&self.pressure);
        self.pressure_max = self.pressure.iter().copied().fold(0.0, f64::max);
        self.gap_min = self.gap_min.min(pass.gap_min);
        self.slip_max = self.slip_max.max(pass.slip_max);
        self.work_friction += pass.work_friction;
        if let (Some(warmth), Some(other)) = (&mut self.warmth, &pass.warmth) {
            warmth.through -= other.through;
            warmth.rubbed += other.rubbed;
        }
        if let (Some(faces), Some(others)) = (&mut self.faces, &pass.faces) {
            faces.extend(others);
        }
    }

    /// What acts on the side whose force histories have: the secondary one, unless they have that on the primary.
    #[must_use]
    pub fn reported(&self) -> Resultant {
        match &self.reported_as {
            Some(ReportedAs {
                on_primary: true, ..
            }) => self.primary,
            _ => self.secondary,
        }
    }

    /// The name by which histories report it.
    #[must_use]
    pub fn reported_name(&self) -> &str {
        let other = self.reported_as.as_ref();
        other.map_or(&self.name, |reported| &reported.name)
    }

    /// The number of closed nodes.
    #[must_use]
    pub fn nclosed(&self) -> usize {
        self.status.iter().filter(|s| s.is_closed()).count()
    }
}

/// Where the energy of a motion with inertia is, and where it went since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// ½ v·M v.
    pub kinetic: f64,
    /// The same at the start of the run.
    pub kinetic_at_start: f64,
    /// In bodies and springs.
    pub internal: f64,
    /// In what penalties and elastic sticking hold.
    pub contact: f64,
    /// Work of supports and loads.
    pub external: f64,
    /// Spent in friction.
    pub friction: f64,
    /// Spent in damping, and in joints that break.
    pub damping: f64,
}

impl Energies {
    /// What the method of going through time has taken away; negative where it has added some.
    #[must_use]
    pub fn algorithmic(&self) -> f64 {
        let given = self.kinetic_at_start + self.external;
        given - (self.kinetic + self.internal + self.contact + self.friction + self.damping)
    }
}

/// A field of the nodes at an accepted state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalValues {
    /// Its name.
    pub name: &'static str,
    /// The number of its components.
    pub ncomponent: usize,
    /// The values: node by node, component by component.
    pub values: Vec<f64>,
    /// The residuals where it is prescribed, in the same order; 0 elsewhere; empty of what follows from fields.
    pub reaction: Vec<f64>,
}

/// The results at one accepted state. Plain data: writers take it from here.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Total time.
    pub time: f64,
    /// Cycles that are behind, with all that the present one stands for; 0 outside of cycles.
    pub cycles: f64,
    /// Name of the step.
    pub step: String,
    /// Number of the step, from 0.
    pub step_number: usize,
    /// Increment within the step, from 1; 0 for the undeformed state.
    pub increment: usize,
    /// Displacement of each node.
    pub displacement: Vec<Vec3>,
    /// Velocity of each node; empty where there is no inertia.
    pub velocity: Vec<Vec3>,
    /// Acceleration of each node, which belongs to an earlier time, (E7) of `motion`; empty where there is no inertia.
    pub acceleration: Vec<Vec3>,
    /// Force that supports exert on each node.
    pub reaction_force: Vec<Vec3>,
    /// The fields of the nodes besides the displacement, and what follows from them.
    pub fields: Vec<NodalValues>,
    /// Force of bodies, springs and contacts at each node, which is what loads, supports and couplings exert on it;
    /// empty where not wanted.
    pub internal_force: Vec<Vec3>,
    /// Heat per time that bodies and contacts take from each node, which is what loads and held temperatures give it; empty where
    /// not wanted.
    pub internal_heat: Vec<f64>,
    /// Cauchy stress at each node, the mean over the cells around it.
    pub stress: Vec<Sym3>,
    /// Strain at each node, averaged likewise: linearized at small strain, logarithmic `½ ln(F Fᵀ)` at finite strain.
    pub strain: Vec<Sym3>,
    /// Depth worn off at each node, of either side of contacts; empty where none wears.
    pub worn_depth: Vec<f64>,
    /// Equivalent plastic strain at each node, averaged likewise; empty where no material has one.
    pub plastic_strain: Vec<f64>,
    /// How much went into each nodal mean; 0 at nodes without a solid.
    pub stress_weight: Vec<f64>,
    /// Cauchy stress of each cell, the mean over its volume; by block of the mesh, then cell.
    pub cell_stress: Vec<Vec<Sym3>>,
    /// Strain of each cell, likewise.
    pub cell_strain: Vec<Vec<Sym3>>,
    /// Equivalent plastic strain of each cell, likewise; empty where no material has one.
    pub cell_plastic_strain: Vec<Vec<f64>>,
    /// Whether each cell takes part, likewise; empty where all cells always do.
    pub active: Vec<Vec<bool>>,
    /// Values at the integration points of the cells that are wanted.
    pub samples: Samples,
    /// Fluxes of heat there, through present areas.
    pub heat_samples: Samples<Vec3>,
    /// Temperature of each node; empty where there are none.
    pub temperature: Vec<f64>,
    /// Flux of heat at each node through present areas (heat per time and area), the mean over the cells around it; empty where
    /// temperatures are no unknowns.
    pub heat_flux: Vec<Vec3>,
    /// How much went into each of these means.
    pub heat_weight: Vec<f64>,
    /// Heat that bodies took up since the start, in steps of all kinds.
    pub heat_stored: f64,
    /// Where heat comes from and goes to; none where temperatures are no unknowns.
    pub heat: Option<HeatBalance>,
    /// Contact force on each node, of both sides.
    pub contact_force: Vec<Vec3>,
    /// Contact pressure at each node, 0 where there is no contact.
    pub contact_pressure: Vec<f64>,
    /// The contact interfaces.
    pub contacts: Vec<ContactFrame>,
    /// What contact exerts on each rigid body, about its reference point; and its motion.
    pub rigid: Vec<RigidFrame>,
    /// The centrifugal loads, in the order in which they are given.
    pub spins: Vec<SpinFrame>,
    /// Work spent so far by viscous forces that hold what only contact stops.
    pub work_stabilization: f64,
    /// The part of it that led to another equilibrium where there was none nearby.
    pub work_jumps: f64,
    /// Work that supports and loads have done so far, by the trapezoidal rule over increments.
    pub work_external: f64,
    /// The sum of the absolute values of the work of each increment, to which fractions refer.
    pub work_turnover: f64,
    /// Potential energy, where every term has one.
    pub energy: Option<f64>,
    /// Where the energy of a motion with inertia is; none in a model without.
    pub energies: Option<Energies>,
    /// What the audits of the contacts found.
    pub audits: Vec<ContactAudit>,
    /// How bodies that only contact holds moved in the increment.
    pub free_motions: Vec<FreeMotion>,
}

/// The motion in an increment of bodies that only contact holds.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// Their names, as in `"pin" and "ring"`.
    pub bodies: Arc<str>,
    /// The largest component of the displacement of a node.
    pub distance: f64,
    /// Work of the viscous forces on them.
    pub work: f64,
    /// What it had been, had they acted all the time.
    pub work_throughout: f64,
    /// `Σ |f · Δu|` of the contact forces at its end and the displacements in it.
    pub opposed: f64,
}

/// A centrifugal load at an accepted state.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinFrame {
    /// Its name.
    pub name: Arc<str>,
    /// The cells that it acts on, sorted.
    pub cells: Arc<[CellId]>,
    /// The squared angular velocity; of what fades, its part.
    pub square: f64,
}

/// A rigid body at an accepted state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidFrame {
    /// What contact exerts on it; moment about the reference point.
    pub contact: Resultant,
    /// Translation of the reference point since the start.
    pub displacement: Vec3,
    /// Rotation since the start, as axis times angle.
    pub rotation: Vec3,
    /// What supports exert on it along prescribed translations.
    pub reaction_force: Vec3,
    /// What they exert about prescribed rotations.
    pub reaction_moment: Vec3,
    /// Velocity of the reference point, of a body with a mass in a motion with inertia.
    pub velocity: Vec3,
    /// Angular velocity in space (radian per time), likewise.
    pub angular_velocity: Vec3,
}

impl Frame {
    /// Says whether a cell takes part.
    pub(crate) fn set_active(&mut self, cell: CellId, is_active: bool) {
        if self.active.is_empty() {
            let all = self.cell_stress.iter().map(|block| vec![true; block.len()]);
            self.active = all.collect();
        }
        let block = self.active.get_mut(cell.block as usize);
        if let Some(to) = block.and_then(|block| block.get_mut(cell.index as usize)) {
            *to = is_active;
        }
    }

    /// A frame with room for a mesh.
    #[must_use]
    pub fn new(nnode: usize, ncell: &[usize]) -> Self {
        Self {
            displacement: vec![Vec3::ZERO; nnode],
            reaction_force: vec![Vec3::ZERO; nnode],
            stress: vec![Sym3::ZERO; nnode],
            strain: vec![Sym3::ZERO; nnode],
            stress_weight: vec![0.0; nnode],
            cell_stress: ncell.iter().map(|&n| vec![Sym3::ZERO; n]).collect(),
            cell_strain: ncell.iter().map(|&n| vec![Sym3::ZERO; n]).collect(),
            contact_force: vec![Vec3::ZERO; nnode],
            contact_pressure: vec![0.0; nnode],
            ..Self::default()
        }
    }
}
