//! The parameters that cards take, and the words that these may have.
//!
//! A parameter that is like one of the card's, or a word that it does not take, is a fault: a typing error in `NLGEOM`
//! would otherwise solve another problem. Parameters that are known and change no result here are taken and noted as not
//! read; so are those that are like none, as CalculiX passes over them.
//!
//! Source: Abaqus Keywords Reference Guide; CalculiX CrunchiX User's Manual, chapter 7.
//!
//! To add a parameter: one entry in [`CARDS`].

use super::spelling::compared;
use crate::diagnostic::{Code, closest, codes};

/// What a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Takes {
    /// Anything: a name, a number, nothing.
    Any,
    /// Nothing.
    Flag,
    /// A whole number from 1 on.
    Count,
    /// One of these words; "" where it may stand alone.
    Words(&'static [&'static str]),
}
use Takes::{Any, Count, Flag, Words};

const YES_NO: Takes = Words(&["YES", "NO"]);
const OP: (&str, Takes) = ("OP", Words(&["NEW", "MOD"]));
const TOTALS: (&str, Takes) = ("TOTALS", Words(&["YES", "NO", "ONLY"]));
const GLOBAL: (&str, Takes) = ("GLOBAL", YES_NO);
const FREQUENCY: (&str, Takes) = ("FREQUENCY", Any);

/// The parameters of a card.
struct Card {
    /// In capitals, with its blanks.
    keyword: &'static str,
    /// Those that are read, and those that change no result here; in capitals, with their blanks.
    takes: &'static [(&'static str, Takes)],
    /// Those that other programs know, and that would change results.
    refused: &'static [&'static str],
}

const fn card(
    keyword: &'static str,
    takes: &'static [(&'static str, Takes)],
    refused: &'static [&'static str],
) -> Card {
    Card {
        keyword,
        takes,
        refused,
    }
}

/// The cards that are read.
#[rustfmt::skip]
const CARDS: &[Card] = &[
    card("AMPLITUDE",
        &[("NAME", Any), ("TIME", Words(&["STEP TIME", "TOTAL TIME"])), ("DEFINITION", Any), ("VALUE", Any), ("USER", Any),
          ("SHIFTX", Any), ("SHIFTY", Any)],
        &["SMOOTH", "BEGIN", "FIXED INTERVAL", "VARIABLES", "PROPERTIES"]),
    card("ASSEMBLY", &[("NAME", Any), ("LIBRARY", Any)], &[]),
    card("BOUNDARY",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP, ("FIXED", Flag), ("TYPE", Any), ("SUBMODEL", Any), ("USER", Any),
          ("STEP", Count), ("DATA SET", Count)],
        &["LOAD CASE", "REGION TYPE", "MASS FLOW", "PRESSURE", "TEMPERATURE", "GLOBAL ELSET", "FILE",
          "PHANTOM", "SCALE"]),
    card("CFLUX",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP],
        &["ADD", "USER", "SUBMODEL", "STEP", "DATA SET", "REGION TYPE", "MASS FLOW"]),
    card("CHANGE FRICTION", &[("INTERACTION", Any)], &["RESET", "AMPLITUDE", "ELSET"]),
    card("CHANGE SOLID SECTION", &[("ELSET", Any), ("MATERIAL", Any), ("ORIENTATION", Any)], &[]),
    card("CHANGE SURFACE BEHAVIOR", &[("INTERACTION", Any)], &[]),
    card("CLEARANCE", &[("MASTER", Any), ("SLAVE", Any), ("VALUE", Any), ("CPSET", Any)], &["TABULAR", "BOLT"]),
    card("CLOAD",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP],
        &["FOLLOWER", "LOAD CASE", "SUBMODEL", "STEP", "DATA SET", "OMEGA0", "SECTOR", "REGION TYPE", "USER", "REAL",
          "IMAGINARY", "CYCLIC MODE", "PROPERTIES"]),
    card("COHESIVE BEHAVIOR", &[("TYPE", Any), ("ELIGIBILITY", Any)], &["REPEATED CONTACTS", "DEPENDENCIES"]),
    card("CONDUCTIVITY",
        &[("TYPE", Words(&["ISO", "ORTHO", "ANISO"]))],
        &["DEPENDENCIES", "USER", "FLUID", "PORE FLUID"]),
    card("CONTACT", &[], &[]),
    card("CONTACT DAMPING", &[("TANGENT FRACTION", Any)], &["DEFINITION", "DEPENDENCIES"]),
    card("CONTACT EXCLUSIONS", &[], &[]),
    card("CONTACT FORMULATION", &[("TYPE", Any)], &[]),
    card("CONTACT INCLUSIONS", &[("ALL EXTERIOR", Flag)], &[]),
    card("CONTACT INITIALIZATION ASSIGNMENT", &[], &[]),
    card("CONTACT INITIALIZATION DATA",
        &[("NAME", Any), ("SEARCH ABOVE", Any), ("SEARCH BELOW", Any), ("INTERFERENCE FIT", Any),
          ("INITIAL CLEARANCE", Any), ("ADJUST", YES_NO)],
        &["MINIMUM DISTANCE", "SEARCH NSET", "SECONDARY NODESET", "STEP FRACTION"]),
    card("CONTACT PROPERTY ASSIGNMENT", &[], &[]),
    card("CONTACT PAIR",
        &[("INTERACTION", Any), ("TYPE", Any), ("ADJUST", Any), ("SMALL SLIDING", Flag), ("CPSET", Any),
          ("EXTENSION ZONE", Any), ("TRACKING", Any), ("NAME", Any), ("SUPPLEMENTARY CONSTRAINTS", Any),
          ("NO THICKNESS", Any), ("SMOOTH", Any), ("MECHANICAL CONSTRAINT", Any), ("WEIGHT", Any),
          ("GEOMETRIC CORRECTION", Any), ("FRACTION", Any), ("SLIDING TRANSITION", Any)],
        &["TIED", "HCRIT", "SLIP TOLERANCE", "OP", "MINIMUM DISTANCE", "DELAY"]),
    card("CONTACT PRINT",
        &[("SLAVE", Any), ("MASTER", Any), ("NSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any),
          ("TIME POINTS", Any), ("SUMMARY", Any), ("CONTACT ELEMENTS", Any)],
        &[]),
    card("COUPLED TEMPERATURE-DISPLACEMENT",
        &[("STEADY STATE", Flag), ("DIRECT", Words(&["", "NOSTOP"])), ("DELTMX", Any), ("SOLVER", Any)],
        &["ALPHA", "CETOL", "CREEP", "ELECTRICAL", "STABILIZE", "EXPLICIT", "TIME RESET", "TOTAL TIME AT START", "COMPRESSIBLE"]),
    card("COUPLING",
        &[("REF NODE", Any), ("SURFACE", Any), ("ORIENTATION", Any), ("CONSTRAINT NAME", Any)],
        &["INFLUENCE RADIUS", "ADJUST", "ALPHA"]),
    card("CYCLIC SYMMETRY MODEL", &[("N", Any), ("TIE", Any), ("NGRAPH", Any), ("ELSET", Any), ("CHECK", Any)], &[]),
    card("DEFORMATION PLASTICITY", &[], &[]),
    card("DAMAGE EVOLUTION",
        &[("TYPE", Any), ("MIXED MODE BEHAVIOR", Any), ("MODE MIX RATIO", Any), ("POWER", Any), ("SOFTENING", Any)],
        &["DEGRADATION", "DEPENDENCIES", "FAILURE MECHANISM"]),
    card("DAMAGE INITIATION", &[("CRITERION", Any)],
        &["TOLERANCE", "DEPENDENCIES", "FAILURE MECHANISM", "POSITION", "SMOOTHING", "NAME", "PROPERTIES"]),
    card("DAMAGE STABILIZATION", &[], &["FAILURE MECHANISM"]),
    card("DAMPING", &[("ALPHA", Any), ("BETA", Any)], &["COMPOSITE", "STRUCTURAL", "ALPHA CURRENT"]),
    card("DENSITY", &[("FLUID", Flag)], &["DEPENDENCIES"]),
    card("DFLUX",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP],
        &["USER", "SUBMODEL", "STEP", "DATA SET", "REGION TYPE", "GLOBAL ELSET"]),
    card("DISTRIBUTING",
        &[("COUPLING", Any), ("WEIGHTING METHOD", Words(&["UNIFORM"]))],
        &["ROTATIONAL COUPLING", "CYCLIC SYMMETRY"]),
    card("DISTRIBUTING COUPLING", &[("ELSET", Any)], &[]),
    card("DISTRIBUTION", &[("NAME", Any), ("LOCATION", Words(&["ELEMENT"])), ("TABLE", Any)], &[]),
    card("DLOAD",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP],
        &["FOLLOWER", "LOAD CASE", "SUBMODEL", "STEP", "DATA SET", "SECTOR", "CONSTANT RESULTANT", "ORIENTATION", "REF NODE",
          "REGION TYPE", "REAL", "IMAGINARY", "CYCLIC MODE", "GLOBAL ELSET"]),
    card("DSFLUX",
        &[("AMPLITUDE", Any), OP], &["USER", "REGION TYPE"]),
    card("DSLOAD",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), OP],
        &["FOLLOWER", "LOAD CASE", "SUBMODEL", "STEP", "DATA SET", "SECTOR", "CONSTANT RESULTANT", "ORIENTATION", "REF NODE",
          "REAL", "IMAGINARY", "CYCLIC MODE", "GLOBAL ELSET"]),
    card("DYNAMIC",
        &[("DIRECT", Words(&["", "NOSTOP"])), ("ALPHA", Any), ("EXPLICIT", Any), ("SOLVER", Any), ("NOHAF", Flag), ("HAFTOL", Any)],
        &["RELATIVE TO ABSOLUTE", "INITIAL", "APPLICATION", "BETA", "GAMMA", "SUBSPACE", "TIME INTEGRATOR", "IMPACT", "ADIABATIC", "SINGULAR MASS", "FULLY PLASTIC"]),
    card("ELASTIC",
        &[("TYPE", Any), ("MODULI", Words(&["LONG TERM", "INSTANTANEOUS"]))],
        &["DEPENDENCIES", "COMPRESSION FACTOR"]),
    card("ELEMENT", &[("TYPE", Any), ("ELSET", Any), ("INPUT", Any)], &["FILE", "OFFSET", "SOLID ELEMENT NUMBERING"]),
    card("EL PRINT",
        &[("ELSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any), ("TIME POINTS", Any),
          ("SUMMARY", Any), ("POSITION", Any), ("REBAR", Any), ("DIRECTIONS", Any), ("LAST MODE", Any), ("MODE", Any),
          ("OUTPUT", Any)],
        &[]),
    card("ELSET",
        &[("ELSET", Any), ("GENERATE", Flag), ("INSTANCE", Any), ("INTERNAL", Flag), ("UNSORTED", Flag), ("INPUT", Any)],
        &[]),
    card("END STEP", &[], &[]),
    card("EQUATION", &[], &["REMOVE", "REMOVE ALL", "REMOVALL"]),
    card("EXPANSION", &[("TYPE", Any), ("ZERO", Any)], &["DEPENDENCIES", "USER", "PORE FLUID"]),
    card("FILM",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), ("FILM AMPLITUDE", Any), ("FILM TIME DELAY", Any), OP],
        &["USER", "REGION TYPE"]),
    card("FREQUENCY",
        &[("SOLVER", Any), ("STORAGE", YES_NO), ("GLOBAL", YES_NO), ("EIGENSOLVER", Any), ("NORMALIZATION", Words(&["MASS"])),
          ("SIM", Any)],
        &["CYCMPC", "ACOUSTIC COUPLING", "RESIDUAL MODES", "PROPERTY EVALUATION", "NUMBER INTERVAL", "ACOUSTIC RANGE FACTOR"]),
    card("FRICTION",
        &[("LAGRANGE", Any), ("SLIP TOLERANCE", Any), ("ELASTIC SLIP", Any)],
        &["ROUGH", "TAUMAX", "ANISOTROPIC", "EXPONENTIAL DECAY", "DEPENDENCIES", "USER", "SHEAR TRACTION SLOPE", "TEST DATA",
          "PROPERTIES", "DEPVAR"]),
    card("GAP", &[("ELSET", Any)], &[]),
    card("GAP CONDUCTANCE",
        &[("PRESSURE", Flag)], &["USER", "DEPENDENCIES", "MASS FLOW RATE", "TABLE"]),
    card("GAP HEAT GENERATION",
        &[], &["USER"]),
    card("HEADING", &[("UNSYMM", Any), ("SPARSE", Any)], &[]),
    card("HEAT TRANSFER",
        &[("STEADY STATE", Flag), ("DIRECT", Words(&["", "NOSTOP"])), ("DELTMX", Any), ("SOLVER", Any), ("TIME RESET", Flag)],
        &["FREQUENCY", "MODAL DYNAMIC", "END", "MXDEM", "STORAGE", "TOTAL TIME AT START"]),
    card("HYPERELASTIC",
        &[("NEO HOOKE", Flag), ("REDUCED POLYNOMIAL", Flag), ("OGDEN", Flag), ("ARRUDA-BOYCE", Flag), ("YEOH", Flag),
          ("MOONEY-RIVLIN", Flag), ("POLYNOMIAL", Flag), ("N", Any), ("MODULI", Words(&["LONG TERM", "INSTANTANEOUS"]))],
        &["VAN DER WAALS", "MARLOW", "USER", "TEST DATA INPUT", "POISSON", "DEPENDENCIES", "BETA", "TYPE", "PROPERTIES",
          "ANISOTROPIC", "FUNG-ANISOTROPIC", "FUNG-ORTHOTROPIC", "HOLZAPFEL"]),
    card("HYPERFOAM", &[("N", Any), ("MODULI", Words(&["LONG TERM", "INSTANTANEOUS"]))], &["TEST DATA INPUT", "POISSON"]),
    card("INITIAL CONDITIONS",
        &[("TYPE", Any), ("USER", Any)],
        &["FILE", "STEP", "INC", "INTERPOLATE", "SECTION POINTS", "GEOSTATIC", "REBAR", "UNBALANCED STRESS", "VARIABLE",
          "NUMBER BACKSTRESSES", "ABSOLUTE EXTERIOR TOLERANCE", "DRIVING ELSETS"]),
    card("INSTANCE", &[("NAME", Any), ("PART", Any)], &["LIBRARY", "INSTANCE"]),
    card("KINEMATIC", &[], &["CYCLIC SYMMETRY"]),
    card("LATENT HEAT",
        &[], &["SCALE"]),
    card("MASS", &[("ELSET", Any), ("TYPE", Words(&["ISOTROPIC"]))], &["ALPHA", "COMPOSITE", "ORIENTATION"]),
    card("MATERIAL", &[("NAME", Any), ("RTOL", Any), ("SRATE FACTOR", Any), ("STRAIN RATE REGULARIZATION", Any)], &[]),
    card("MEMBRANE", &[("ELSET", Any), ("MATERIAL", Any)], &[]),
    card("MODEL CHANGE",
        &[("TYPE", Any), ("ADD", Words(&["", "STRAIN FREE", "WITH STRAIN"])), ("REMOVE", Flag), ("CPSET", Any),
          ("MECHSTRAINTORESIDUAL", Any)],
        &["ACTIVATE", "RESTART"]),
    card("MPC", &[], &["USER", "MODE"]),
    card("NODAL THICKNESS", &[], &[]),
    card("NODE", &[("NSET", Any), ("SYSTEM", Any), ("INPUT", Any)], &[]),
    card("NODE PRINT",
        &[("NSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any), ("TIME POINTS", Any),
          ("SUMMARY", Any), ("LAST MODE", Any), ("MODE", Any), ("OUTPUT", Any)],
        &[]),
    card("NSET",
        &[("NSET", Any), ("ELSET", Any), ("GENERATE", Flag), ("INSTANCE", Any), ("INTERNAL", Flag), ("UNSORTED", Flag),
          ("INPUT", Any), FREQUENCY],
        &[]),
    card("ORIENTATION",
        &[("NAME", Any), ("SYSTEM", Words(&["RECTANGULAR", "R", "CYLINDRICAL", "C"])),
          ("DEFINITION", Words(&["COORDINATES"]))],
        &["LOCAL DIRECTIONS"]),
    card("PART", &[("NAME", Any)], &[]),
    card("PHYSICAL CONSTANTS",
        &[("ABSOLUTE ZERO", Any), ("STEFAN BOLTZMANN", Any), ("NEWTON GRAVITY", Any), ("UNIVERSAL GAS CONSTANT", Any)],
        &[]),
    card("PLASTIC",
        &[("HARDENING", Any)],
        &["RATE", "DEPENDENCIES", "DATA TYPE", "NUMBER BACKSTRESSES", "PROPERTIES", "SCALESTRESS", "EXTRAPOLATION"]),
    card("PRE-TENSION SECTION", &[("SURFACE", Any), ("NODE", Any), ("ELEMENT", Any)], &[]),
    card("PRESSURE PENETRATION",
        &[("SECONDARY", Any), ("SLAVE", Any), ("MAIN", Any), ("PRIMARY", Any), ("MASTER", Any), ("PENETRATION TIME", Any), OP],
        &["AMPLITUDE", "IMAGINARY", "REAL", "REGION TYPE", "WETTED FRONT"]),
    card("RADIATE",
        &[("AMPLITUDE", Any), ("TIME DELAY", Any), ("RADIATION AMPLITUDE", Any), ("RADIATION TIME DELAY", Any), OP],
        &["CAVITY", "ENVNODE", "REGION TYPE"]),
    card("REFINE MESH", &[("LIMIT", Any), ("ELSET", Any), ("USER CODE", Any)], &[]),
    card("RIGID BODY",
        &[("NSET", Any), ("ELSET", Any), ("REF NODE", Any), ("ROT NODE", Any), ("ISOTHERMAL", Any),
          ("POSITION", Words(&["INPUT"]))],
        &["PIN NSET", "TIE NSET", "ANALYTICAL SURFACE", "DENSITY", "OFFSET", "NODAL THICKNESS"]),
    card("ROTARY INERTIA", &[("ELSET", Any)], &["ALPHA", "COMPOSITE", "ORIENTATION"]),
    card("SECTION PRINT",
        &[("SURFACE", Any), ("NAME", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any),
          ("TIME POINTS", Any), ("AXES", Any), ("UPDATE", Any)],
        &[]),
    card("SFILM",
        &[("AMPLITUDE", Any), ("FILM AMPLITUDE", Any), OP], &["USER", "REGION TYPE"]),
    card("SHELL SECTION",
        &[("ELSET", Any), ("MATERIAL", Any), ("OFFSET", Any), ("NODAL THICKNESS", Flag), ("CONTROLS", Any),
          ("POISSON", Any), ("SECTION INTEGRATION", Any)],
        &["COMPOSITE", "LAYUP", "ORIENTATION", "SYMMETRIC", "STACK DIRECTION", "DENSITY", "TEMPERATURE", "BENDING ONLY",
          "MEMBRANE ONLY", "SHELL THICKNESS", "THICKNESS MODULUS", "SMEAR ALL LAYERS"]),
    card("SOLID SECTION",
        &[("ELSET", Any), ("MATERIAL", Any), ("ORIENTATION", Any), ("CONTROLS", Any), ("OFFSET", Any),
          ("NODAL THICKNESS", Flag)],
        &["COMPOSITE", "LAYUP", "REF NODE", "STACK DIRECTION", "SYMMETRIC"]),
    card("SPECIFIC HEAT",
        &[], &["CONSTANTVOLUME", "DEPENDENCIES", "USER"]),
    card("SPRING",
        &[("ELSET", Any), ("ORIENTATION", Any), ("NONLINEAR", Flag), ("RTOL", Any)],
        &["COMPLEX STIFFNESS", "DEPENDENCIES"]),
    card("SRADIATE",
        &[("AMPLITUDE", Any), ("RADIATION AMPLITUDE", Any), OP], &["REGION TYPE"]),
    card("STATIC",
        &[("DIRECT", Words(&["", "NOSTOP"])), ("SOLVER", Any), ("STABILIZE", Any), ("ALLSDTOL", Any), ("CONTINUE", Any),
          ("FACTOR", Any)],
        &["RIKS", "TIME RESET", "TOTAL TIME AT START", "FULLY PLASTIC", "LONG TERM"]),
    card("STEP",
        &[("NLGEOM", Words(&["", "YES", "NO"])), ("INC", Count), ("AMPLITUDE", Words(&["RAMP", "STEP"])),
          ("PERTURBATION", Any), ("NAME", Any), ("UNSYMM", Any), ("EXTRAPOLATION", Any), ("CONVERT SDI", Any),
          ("SOLVER", Any), ("INCF", Any)],
        &["CYCLIC SYMMETRY"]),
    card("SUBMODEL",
        &[("TYPE", Words(&["NODE", "SURFACE"])), ("INPUT", Any), ("GLOBAL ELSET", Any)],
        &["SHELL TO SOLID", "SHELL THICKNESS", "ACOUSTIC TO STRUCTURE", "ABSOLUTE EXTERIOR TOLERANCE", "EXTERIOR TOLERANCE",
          "INTERSECTION ONLY"]),
    card("SURFACE",
        &[("NAME", Any), ("TYPE", Any), ("COMBINE", Any), ("CROP", Any), ("INSTANCE", Any), ("INTERNAL", Flag),
          ("INPUT", Any), ("DEFINITION", Any), ("REGION TYPE", Any), ("NO THICKNESS", Any), ("TRIM", Any),
          ("SCALE THICK", Any), ("PROPERTY", Any), ("MAX RATIO", Any), ("DISCRETIZATION", Any), ("FILLET RADIUS", Any)],
        &["OFFSET"]),
    card("SURFACE BEHAVIOR",
        &[("PRESSURE-OVERCLOSURE", Any), ("AUGMENTED LAGRANGE", Any), ("PENALTY", Any), ("DIRECT", Any), ("METHOD", Any)],
        &["NO SEPARATION", "STIFFNESS BEHAVIOR"]),
    card("SURFACE INTERACTION",
        &[("NAME", Any), ("UNSYMM", Any)],
        &["USER", "DEPVAR", "PROPERTIES", "PAD THICKNESS", "TRACKING THICKNESS"]),
    card("TEMPERATURE",
        &[("AMPLITUDE", Any), ("FILE", Any), OP],
        &["BSTEP", "ESTEP", "BINC", "EINC", "SUBMODEL", "STEP", "DATA SET", "USER", "INTERPOLATE", "MIDSIDE", "GLOBAL ELSET",
          "TIME DELAY", "ABSOLUTE EXTERIOR TOLERANCE"]),
    card("TIE",
        &[("NAME", Any), ("POSITION TOLERANCE", Any), ("ADJUST", YES_NO), ("CYCLIC SYMMETRY", Flag), ("TYPE", Any),
          ("NO ROTATION", Any), ("NO THICKNESS", Any), ("CONSTRAINT RATIO", Any)],
        &["TIED NSET", "MULTIBODY"]),
    card("TRANSFORM", &[("NSET", Any), ("TYPE", Any)], &[]),
    card("UNCOUPLED TEMPERATURE-DISPLACEMENT",
        &[("STEADY STATE", Flag), ("DIRECT", Words(&["", "NOSTOP"])), ("DELTMX", Any), ("SOLVER", Any)],
        &["ALPHA", "CETOL", "CREEP", "ELECTRICAL", "STABILIZE", "EXPLICIT", "TIME RESET", "TOTAL TIME AT START", "COMPRESSIBLE"]),
    card("USER MATERIAL",
        &[("CONSTANTS", Any), ("TYPE", Words(&["MECHANICAL"])), ("UNSYMM", Any)],
        &["HYBRID FORMULATION", "EFFMOD", "PROPERTIES"]),
];

/// The cards that only print: a parameter that they do not have changes no result.
const PRINTS: [&str; 4] = ["CONTACT PRINT", "EL PRINT", "NODE PRINT", "SECTION PRINT"];

/// What is wrong with a parameter.
#[derive(Debug)]
pub(crate) struct Fault {
    /// What kind of fault it is.
    pub code: &'static Code,
    /// What is wrong.
    pub message: String,
    /// What was probably meant.
    pub remark: String,
    /// What the card takes.
    pub known: String,
}

/// What is wrong with a parameter of a card that is read; nothing for cards that are not.
///
/// `keyword` and `name` are in capitals and without blanks, `value` as it was written. A name that is like none that the
/// card takes is no fault, nor is any name of a card that only prints: CalculiX passes over it, and so it is noted as not
/// read, see [`not_read`].
pub(crate) fn judge(keyword: &str, name: &str, value: &str) -> Option<Fault> {
    let card = Card::of(keyword)?;
    let Some((name, takes)) = card.taken(name) else {
        return strange(card, name);
    };
    let keyword = card.keyword;
    let found = compared(value);
    let wanted = match takes {
        Any => return None,
        Flag if found.is_empty() => return None,
        Count if found.parse::<u64>().is_ok_and(|count| count > 0) => return None,
        Words(words) if words.iter().any(|word| is_same(word, &found)) => return None,
        Flag => "it takes no value".to_owned(),
        Count => "it takes a whole number from 1 on".to_owned(),
        Words(words) => {
            let words: Vec<&str> = words.iter().copied().filter(|w| !w.is_empty()).collect();
            format!("it takes {}", words.join(" or "))
        }
    };
    let meant = match takes {
        Words(words) => nearest(&found, words.iter().copied()),
        _ => None,
    };
    Some(Fault {
        code: match takes {
            Count => &codes::OUT_OF_RANGE,
            _ => &codes::NOT_A_CHOICE,
        },
        message: format!("{name}={} of *{keyword} is not known", shown(value)),
        remark: meant.map_or(wanted.clone(), |meant| format!("did you mean {meant}?")),
        known: wanted,
    })
}

/// A parameter that the card does not take; nothing where it may be passed over.
fn strange(card: &Card, name: &str) -> Option<Fault> {
    let keyword = card.keyword;
    let names = || card.takes.iter().map(|(name, _)| *name);
    let known: Vec<&str> = names().collect();
    let known = match known.is_empty() {
        true => format!("*{keyword} takes no parameters"),
        false => format!("*{keyword} takes {}", known.join(", ")),
    };
    if name == "INPUT" || card.refused.iter().any(|refused| is_same(refused, name)) {
        return Some(Fault {
            code: &codes::NOT_BUILT,
            message: format!("{} of *{keyword} is not supported", card.spelled(name)),
            remark: match name {
                "INPUT" => {
                    "write the lines into the deck, or *INCLUDE, INPUT=… below the card".to_owned()
                }
                _ if name == "SUBMODEL" => {
                    "only displacements of a global model are built".to_owned()
                }
                _ => "without it the deck means something else".to_owned(),
            },
            known,
        });
    }
    if PRINTS.contains(&keyword) {
        return None;
    }
    let meant = nearest(name, names().chain(card.refused.iter().copied()))?;
    Some(Fault {
        code: &codes::UNKNOWN_KEY,
        message: format!("*{keyword} has no parameter {}", shown(name)),
        remark: format!("did you mean {meant}?"),
        known,
    })
}

/// A note on a parameter that nobody has asked for.
pub(crate) fn not_read(keyword: &str, name: &str) -> String {
    let Some(card) = Card::of(keyword) else {
        return format!("{} of *{keyword} is not read", shown(name));
    };
    let keyword = card.keyword;
    if card.taken(name).is_some() {
        return format!("{} of *{keyword} is not read", card.spelled(name));
    }
    let names = card.takes.iter().map(|(name, _)| *name);
    let meant = nearest(name, names).map_or(String::new(), |m| format!("; did you mean {m}?"));
    let name = shown(name);
    format!("*{keyword} has no parameter {name}: it is not read{meant}")
}

/// A parameter as manuals write it, with its blanks.
pub(crate) fn spelled<'n>(keyword: &str, name: &'n str) -> &'n str {
    Card::of(keyword).map_or(name, |card| card.spelled(name))
}

impl Card {
    /// The entry of a keyword without blanks.
    fn of(keyword: &str) -> Option<&'static Self> {
        CARDS.iter().find(|card| is_same(card.keyword, keyword))
    }

    /// What a parameter takes, given without blanks, with its name.
    fn taken(&self, name: &str) -> Option<(&'static str, &'static Takes)> {
        let found = self.takes.iter().find(|(known, _)| is_same(known, name));
        found.map(|(known, takes)| (*known, takes))
    }

    fn spelled<'n>(&self, name: &'n str) -> &'n str {
        let names = self.takes.iter().map(|(known, _)| *known);
        let mut names = names.chain(self.refused.iter().copied());
        names.find(|known| is_same(known, name)).unwrap_or(name)
    }
}

/// Whether a word of the tables is this one, which has no blanks.
fn is_same(known: &str, word: &str) -> bool {
    known.bytes().filter(|b| *b != b' ').eq(word.bytes())
}

/// The word of the tables that is like one without blanks.
fn nearest(word: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    let known: Vec<(String, &str)> = known.map(|one| (one.replace(' ', ""), one)).collect();
    let found = closest(word, known.iter().map(|(compact, _)| compact.as_str()))?;
    let found = known.iter().find(|(compact, _)| compact == found);
    found.map(|(_, shown)| *shown)
}

/// The beginning of a word, for messages.
fn shown(word: &str) -> String {
    word.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::{KEYWORDS, Support};

    #[test]
    fn every_card_that_is_read_has_its_parameters_listed_once() {
        let read = KEYWORDS.iter().filter(|one| one.support == Support::Read);
        let read: Vec<&str> = read.map(|one| one.name).collect();
        for keyword in read.iter().filter(|keyword| **keyword != "INCLUDE") {
            let count = CARDS.iter().filter(|card| card.keyword == *keyword).count();
            assert_eq!(count, 1, "{keyword}");
        }
        for card in CARDS {
            assert!(read.contains(&card.keyword), "{}", card.keyword);
            let names = || card.takes.iter().map(|(name, _)| name).chain(card.refused);
            for name in names() {
                assert_eq!(names().filter(|one| *one == name).count(), 1, "{name}");
            }
        }
    }

    /// Every word with each pair of neighbours exchanged, and each letter left out.
    fn misspelt(word: &str) -> Vec<String> {
        let letters: Vec<char> = word.chars().collect();
        let mut all = Vec::new();
        for at in 0..letters.len() {
            let mut less = letters.clone();
            less.remove(at);
            all.push(less.into_iter().collect());
            if at + 1 < letters.len() {
                let mut swapped = letters.clone();
                swapped.swap(at, at + 1);
                all.push(swapped.into_iter().collect());
            }
        }
        all.retain(|other: &String| other != word);
        all
    }

    #[test]
    fn every_parameter_of_every_card_is_met_with_a_proposal_where_it_is_misspelt() {
        let mut count = 0;
        for card in CARDS.iter().filter(|card| !PRINTS.contains(&card.keyword)) {
            let keyword = card.keyword.replace(' ', "");
            for (name, _) in card.takes.iter().filter(|(name, _)| name.len() > 3) {
                let others = misspelt(&name.replace(' ', "")).into_iter();
                for typed in others.filter(|name| card.taken(name).is_none()) {
                    let fault = judge(&keyword, &typed, "").unwrap();
                    let proposal = fault.remark.starts_with("did you mean ");
                    assert!(proposal, "{} {typed}: {fault:?}", card.keyword);
                    assert_eq!(fault.code.class.exit_code(), 3);
                    count += 1;
                }
            }
        }
        assert!(count > 1000, "{count}");
    }

    #[test]
    fn every_word_of_every_parameter_is_met_with_a_proposal_where_it_is_misspelt() {
        let mut count = 0;
        for card in CARDS {
            let keyword = card.keyword.replace(' ', "");
            for (name, takes) in card.takes {
                let Words(words) = takes else { continue };
                let name = name.replace(' ', "");
                for word in *words {
                    assert!(judge(&keyword, &name, &word.to_lowercase()).is_none());
                    let others = misspelt(&word.replace(' ', "")).into_iter();
                    for typed in others.filter(|typed| !words.iter().any(|w| is_same(w, typed))) {
                        let fault = judge(&keyword, &name, &typed).unwrap();
                        assert!(fault.known.starts_with("it takes "), "{fault:?}");
                        count += 1;
                    }
                }
            }
        }
        assert!(count > 100, "{count}");
    }

    #[test]
    fn what_a_card_takes_is_taken_and_what_it_does_not_is_not() {
        for (keyword, name, value) in [
            ("STEP", "NLGEOM", ""),
            ("STEP", "NLGEOM", "yes"),
            ("STEP", "INC", "100"),
            ("CLOAD", "OP", " new "),
            ("NODEFILE", "ANYTHING", "at all"),
            // like none that the card takes, or of a card that only prints
            ("CLOAD", "QWERTZ", ""),
            ("CONTACTPRINT", "SET", "N"),
        ] {
            assert!(
                judge(keyword, name, value).is_none(),
                "{keyword} {name} {value}"
            );
        }
        for (keyword, name, value, remark) in [
            ("STEP", "NLGOEM", "", "did you mean NLGEOM?"),
            ("STEP", "NLGEOM", "YSE", "did you mean YES?"),
            ("CLOAD", "OP", "NWE", "did you mean NEW?"),
            ("CLOAD", "OP", "", "it takes NEW or MOD"),
            ("STEP", "INC", "0", "it takes a whole number from 1 on"),
            ("STEP", "INC", "-3", "it takes a whole number from 1 on"),
            ("NSET", "GENERATE", "YES", "it takes no value"),
            (
                "CLOAD",
                "FOLLOWER",
                "",
                "without it the deck means something else",
            ),
        ] {
            let fault = judge(keyword, name, value).unwrap();
            assert_eq!(fault.remark, remark, "{fault:?}");
        }
    }

    #[test]
    fn what_nobody_reads_is_named_as_manuals_write_it() {
        for (keyword, name, note) in [
            (
                "NODEPRINT",
                "TIMEPOINTS",
                "TIME POINTS of *NODE PRINT is not read",
            ),
            (
                "CONTACTPRINT",
                "SET",
                "*CONTACT PRINT has no parameter SET: it is not read; did you mean NSET?",
            ),
            (
                "CLOAD",
                "QWERTZ",
                "*CLOAD has no parameter QWERTZ: it is not read",
            ),
        ] {
            assert_eq!(not_read(keyword, name), note);
        }
        assert_eq!(spelled("RIGIDBODY", "REFNODE"), "REF NODE");
        assert_eq!(spelled("SOLIDSECTION", "NODALTHICKNESS"), "NODAL THICKNESS");
    }
}
