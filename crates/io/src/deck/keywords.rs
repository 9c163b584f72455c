//! What becomes of every keyword.

/// What becomes of a keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// It is read.
    Read,
    /// It changes no result here: left out, with a note.
    Ignored,
    /// It would change results: an error.
    Refused,
}

/// A keyword of a deck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keyword {
    /// In capitals, with its blanks.
    pub name: &'static str,
    /// What becomes of it.
    pub support: Support,
    /// What of it is read, or why it is not.
    pub remark: &'static str,
}

const fn read(name: &'static str, remark: &'static str) -> Keyword {
    Keyword {
        name,
        support: Support::Read,
        remark,
    }
}

const fn ignored(name: &'static str, remark: &'static str) -> Keyword {
    Keyword {
        name,
        support: Support::Ignored,
        remark,
    }
}

const fn refused(name: &'static str, remark: &'static str) -> Keyword {
    Keyword {
        name,
        support: Support::Refused,
        remark,
    }
}

/// Every keyword that is known, in the order of the alphabet.
pub const KEYWORDS: &[Keyword] = &[
    read(
        "AMPLITUDE",
        "NAME, TIME=TOTAL TIME, SHIFTX, SHIFTY; linear between its rows; in steps, too",
    ),
    read("ASSEMBLY", "with END ASSEMBLY"),
    refused("BEAM GENERAL SECTION", "beams are not built yet"),
    refused("BEAM SECTION", "beams are not built yet"),
    read(
        "BOUNDARY",
        "displacements, rotations of rigid bodies, those of shells held, temperatures; AMPLITUDE, OP, FIXED, SUBMODEL",
    ),
    read("CFLUX", "heat at nodes; AMPLITUDE, OP"),
    read("CHANGE FRICTION", "with FRICTION"),
    read("CHANGE SOLID SECTION", "ELSET of whole sections, MATERIAL"),
    read("CHANGE SURFACE BEHAVIOR", "INTERACTION"),
    read("CLEARANCE", "MASTER, SLAVE, VALUE"),
    read(
        "CLOAD",
        "forces at nodes, moments at rigid bodies and shells; AMPLITUDE, TIME DELAY, OP",
    ),
    read(
        "COHESIVE BEHAVIOR",
        "Knn, Kss, Ktt, with DAMAGE INITIATION and EVOLUTION; ELIGIBILITY",
    ),
    read("CONDUCTIVITY", "ISO by temperature, ORTHO, ANISO"),
    read(
        "CONTACT",
        "with CONTACT INCLUSIONS: everything that faces one another may touch",
    ),
    ignored("CONTACT CONTROLS", "contact needs no controls here"),
    ignored(
        "CONTACT CONTROLS ASSIGNMENT",
        "contact needs no controls here",
    ),
    read("CONTACT DAMPING", "TANGENT FRACTION; implicit steps"),
    read("CONTACT EXCLUSIONS", "surfaces that do not touch"),
    ignored("CONTACT FILE", "all fields of contact are written anyway"),
    read("CONTACT FORMULATION", "TYPE=MASTER SLAVE ROLES"),
    read("CONTACT INCLUSIONS", "ALL EXTERIOR, or surfaces"),
    ignored("CONTACT OUTPUT", "all fields of contact are written anyway"),
    read(
        "CONTACT INITIALIZATION ASSIGNMENT",
        "data of all, or of two surfaces",
    ),
    read(
        "CONTACT INITIALIZATION DATA",
        "NAME; SEARCH ABOVE, INTERFERENCE FIT, INITIAL CLEARANCE",
    ),
    read("CONTACT PAIR", "TYPE, SMALL SLIDING, ADJUST by a tolerance"),
    read("CONTACT PRINT", "CDIS, CSTR, CELS, CNUM, CF, CFN, CFS"),
    read(
        "CONTACT PROPERTY ASSIGNMENT",
        "interactions of all, or of two surfaces",
    ),
    ignored("CONTACT STABILIZATION", "contact needs no controls here"),
    ignored(
        "CONTROLS",
        "increments and iterations have controls of their own",
    ),
    read(
        "COUPLED TEMPERATURE-DISPLACEMENT",
        "STEADY STATE; one iteration for both",
    ),
    read(
        "COUPLING",
        "with KINEMATIC or DISTRIBUTING, of surfaces; ORIENTATION",
    ),
    refused("CREEP", "creep is not built"),
    refused("CYCLIC HARDENING", "combined hardening is not built"),
    read("CYCLIC SYMMETRY MODEL", "N, TIE, of matching sides"),
    read(
        "DAMAGE EVOLUTION",
        "TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER LAW; of surfaces",
    ),
    read("DAMAGE INITIATION", "CRITERION=QUADS; of surfaces"),
    read("DAMAGE STABILIZATION", "of surfaces"),
    read("DAMPING", "ALPHA; of motion"),
    read("DEFORMATION PLASTICITY", "at one temperature"),
    read("DENSITY", "constant"),
    ignored(
        "DEPVAR",
        "the laws of *USER MATERIAL that are built keep no state",
    ),
    read("DFLUX", "S1 to S6, BF; AMPLITUDE, OP"),
    ignored("DIAGNOSTICS", "every increment is told of"),
    read("DISTRIBUTING", "with COUPLING"),
    read("DISTRIBUTING COUPLING", "of an element of type DCOUP3D"),
    read("DISTRIBUTION", "axes of elements, for ORIENTATION"),
    ignored(
        "DISTRIBUTION TABLE",
        "what a distribution is made of follows from its use",
    ),
    read(
        "DLOAD",
        "P and P1 to P6, EDNOR1 to EDNOR4 of shells, GRAV, CENTRIF; of MASS elements GRAV; AMPLITUDE, OP",
    ),
    read("DSFLUX", "S; AMPLITUDE, OP"),
    read("DSLOAD", "P; AMPLITUDE, OP"),
    read("DYNAMIC", "DIRECT, ALPHA, EXPLICIT"),
    ignored("EL FILE", "all fields are written anyway"),
    read(
        "EL PRINT",
        "S, E, ME, PEEQ, ENER, ELSE, EVOL, CENT, HFL; TOTALS, FREQUENCY",
    ),
    read(
        "ELASTIC",
        "isotropic, by temperature; ENGINEERING CONSTANTS, ORTHO, ANISO",
    ),
    ignored("ELECTRICAL CONDUCTIVITY", "only of currents"),
    read(
        "ELEMENT",
        "solids in space and in the plane; shells; MASS, ROTARYI, springs",
    ),
    ignored("ELEMENT OUTPUT", "all fields are written anyway"),
    read("ELSET", "GENERATE"),
    ignored("END ASSEMBLY", ""),
    read("END STEP", ""),
    ignored("ENERGY FILE", "all fields are written anyway"),
    ignored("ENERGY OUTPUT", "all fields are written anyway"),
    ignored("ENERGY PRINT", "sums of energy are not printed"),
    read(
        "EQUATION",
        "of displacements, and of rotations of rigid bodies",
    ),
    read("EXPANSION", "isotropic, by temperature; ZERO"),
    ignored(
        "FACE PRINT",
        "heat through faces is not printed; SECTION PRINT has forces",
    ),
    ignored("FILE FORMAT", "all fields are written anyway"),
    ignored("FILE OUTPUT", "all fields are written anyway"),
    read("FILM", "F1 to F6; FILM AMPLITUDE, OP"),
    ignored("FILTER", "all fields are written anyway"),
    ignored("FLUID CONSTANTS", "only of fluids"),
    refused("FLUID SECTION", "networks of fluids are not built"),
    read(
        "FREQUENCY",
        "number, lowest, highest; with STEP, PERTURBATION about a preloaded state",
    ),
    read(
        "FRICTION",
        "a coefficient, and a stick slope with --compat ccx",
    ),
    read("GAP", "of GAPUNI"),
    read(
        "GAP CONDUCTANCE",
        "over the gap; PRESSURE; over the pressure with --compat ccx",
    ),
    read(
        "GAP HEAT GENERATION",
        "the part of the work of friction, and of that of the secondary side",
    ),
    read("HEADING", "the title"),
    read("HEAT TRANSFER", "STEADY STATE; else by backward Euler"),
    read(
        "HYPERELASTIC",
        "NEO HOOKE, MOONEY-RIVLIN, OGDEN; one temperature",
    ),
    read("HYPERFOAM", "one temperature"),
    read("INCLUDE", "INPUT"),
    ignored("INCREMENTATION OUTPUT", "all fields are written anyway"),
    ignored(
        "INELASTIC HEAT FRACTION",
        "only of heat: temperatures are given",
    ),
    read(
        "INITIAL CONDITIONS",
        "TYPE=TEMPERATURE, with gradients of shells; VELOCITY; STRESS and PLASTIC STRAIN at integration points",
    ),
    read("INSTANCE", "moved and turned"),
    read("KINEMATIC", "with COUPLING"),
    read("LATENT HEAT", "with SPECIFIC HEAT"),
    ignored("MAGNETIC PERMEABILITY", "only of currents"),
    read("MASS", "of MASS elements, each with the mass given"),
    read("MATERIAL", ""),
    read("MEMBRANE", "of no elements; membranes are not built"),
    refused("MEMBRANE SECTION", "membranes are not built yet"),
    read(
        "MODEL CHANGE",
        "TYPE=CONTACT PAIR, ADD and REMOVE; TYPE=ELEMENT, ADD=STRAIN FREE or WITH STRAIN, REMOVE",
    ),
    ignored("MONITOR", "every increment is told of"),
    read("MPC", "PLANE, STRAIGHT, BEAM, MEANROT, DIST"),
    read(
        "NODAL THICKNESS",
        "of sections of planes and shells that ask for it",
    ),
    read("NODE", "SYSTEM"),
    ignored("NODE FILE", "all fields are written anyway"),
    ignored("NODE OUTPUT", "all fields are written anyway"),
    read("NODE PRINT", "U, RF, NT, RFL; TOTALS, FREQUENCY"),
    refused("NORMAL", "normals of shells follow from their elements"),
    read("NSET", "GENERATE, ELSET"),
    read(
        "ORIENTATION",
        "rectangular, cylindrical, by DISTRIBUTION; a turn in its second line",
    ),
    ignored("OUTPUT", "all fields are written anyway"),
    read("PART", ""),
    read("PHYSICAL CONSTANTS", "ABSOLUTE ZERO, STEFAN BOLTZMANN"),
    read(
        "PLASTIC",
        "isotropic, KINEMATIC with one slope; one temperature",
    ),
    ignored("PREPRINT", "nothing is printed beforehand"),
    read("PRE-TENSION SECTION", "SURFACE, NODE, a normal"),
    read(
        "PRESSURE PENETRATION",
        "SECONDARY, MAIN; a node of each, pressure, critical pressure; PENETRATION TIME",
    ),
    ignored("PRINT", "every increment is told of"),
    read(
        "RADIATE",
        "R1 to R6, to surroundings; RADIATION AMPLITUDE, OP",
    ),
    read("REFINE MESH", "left out, with a warning"),
    ignored(
        "RESTART",
        "checkpoints are written anyway: signorini resume",
    ),
    read(
        "RIGID BODY",
        "NSET, ELSET; REF NODE, else the mean of its nodes; ROT NODE",
    ),
    read(
        "ROTARY INERTIA",
        "of ROTARYI elements, at nodes of rigid bodies and couplings",
    ),
    ignored(
        "SECTION CONTROLS",
        "reduced integration needs no controls here",
    ),
    ignored("SECTION FILE", "all fields are written anyway"),
    read("SECTION PRINT", "SURFACE; SOF, SOM, SOAREA"),
    read("SFILM", "F; FILM AMPLITUDE, OP"),
    refused(
        "SHELL GENERAL SECTION",
        "write *SHELL SECTION with a material",
    ),
    read(
        "SHELL SECTION",
        "ELSET, MATERIAL, thickness, OFFSET, NODAL THICKNESS; of S3, S4, S6, S8",
    ),
    refused(
        "SHELL TO SOLID COUPLING",
        "shells are hinged at nodes that they share with solids",
    ),
    read(
        "SOLID SECTION",
        "ELSET, MATERIAL, ORIENTATION, thickness in the plane, cross-section of trusses",
    ),
    ignored("SPECIFIC GAS CONSTANT", "only of fluids"),
    read("SPECIFIC HEAT", "by temperature"),
    read(
        "SPRING",
        "of SPRINGA, SPRING1, SPRING2; NONLINEAR, at one temperature",
    ),
    read("SRADIATE", "R, to surroundings; RADIATION AMPLITUDE, OP"),
    read("STATIC", "DIRECT"),
    read("STEP", "NLGEOM, INC, AMPLITUDE"),
    read(
        "SUBMODEL",
        "TYPE=NODE; displacements of a .frd file, by BOUNDARY, SUBMODEL",
    ),
    read(
        "SURFACE",
        "TYPE=ELEMENT, NODE; SNEG and SPOS of shells, their edges from S3 on",
    ),
    read(
        "SURFACE BEHAVIOR",
        "HARD, LINEAR, EXPONENTIAL, TABULAR, TIED",
    ),
    read("SURFACE INTERACTION", ""),
    refused(
        "SURFACE PROPERTY ASSIGNMENT",
        "faces are where their nodes are, without a thickness of their own",
    ),
    read("TEMPERATURE", "of node sets, with gradients of shells"),
    read("TIE", "POSITION TOLERANCE, ADJUST; CYCLIC SYMMETRY"),
    ignored("TIME POINTS", "results are written after every increment"),
    read("TRANSFORM", "TYPE=R, C"),
    read(
        "UNCOUPLED TEMPERATURE-DISPLACEMENT",
        "as COUPLED TEMPERATURE-DISPLACEMENT",
    ),
    read(
        "USER MATERIAL",
        "LIN_ISO_EL, UNDO_NLGEOM_LIN_ISO_EL, CIARLET_EL, COMPRESSION_ONLY, TENSION_ONLY",
    ),
    refused("VISCO", "only static steps are built"),
];

impl Keyword {
    /// The entry of a keyword in capitals and without blanks.
    #[must_use]
    pub fn of(card: &str) -> Option<&'static Self> {
        let is = |one: &&'static Self| one.name.bytes().filter(|b| *b != b' ').eq(card.bytes());
        KEYWORDS.iter().find(is)
    }
}
