//! The parameters that cards take, and the words that these may have.
//!
//! A parameter that no card has, or a word that it does not take, is a fault: a typing error in `NLGEOM` would otherwise
//! solve another problem. Parameters that are known and change no result here are taken and noted as not read.
//!
//! Source: Abaqus Keywords Reference Guide; CalculiX CrunchiX User's Manual, chapter 7.
//!
//! To add a parameter: one entry in [`CARDS`].

use super::card::compared;
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
    /// In capitals, without blanks.
    keyword: &'static str,
    /// Those that are read, and those that change no result here.
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
        &[("NAME", Any), ("TIME", Words(&["STEPTIME", "TOTALTIME"])), ("DEFINITION", Any), ("VALUE", Any), ("USER", Any),
          ("SHIFTX", Any), ("SHIFTY", Any)],
        &["SMOOTH", "BEGIN", "FIXEDINTERVAL", "VARIABLES", "PROPERTIES"]),
    card("ASSEMBLY", &[("NAME", Any), ("LIBRARY", Any)], &[]),
    card("BOUNDARY",
        &[("AMPLITUDE", Any), ("TIMEDELAY", Any), OP, ("FIXED", Flag), ("TYPE", Any), ("SUBMODEL", Any), ("USER", Any)],
        &["LOADCASE", "REGIONTYPE", "MASSFLOW", "PRESSURE", "TEMPERATURE", "STEP", "DATASET", "GLOBALELSET", "FILE",
          "PHANTOM", "SCALE"]),
    card("CHANGEFRICTION", &[("INTERACTION", Any)], &["RESET", "AMPLITUDE", "ELSET"]),
    card("CHANGESOLIDSECTION", &[("ELSET", Any), ("MATERIAL", Any), ("ORIENTATION", Any)], &[]),
    card("CHANGESURFACEBEHAVIOR", &[("INTERACTION", Any)], &[]),
    card("CLEARANCE", &[("MASTER", Any), ("SLAVE", Any), ("VALUE", Any), ("CPSET", Any)], &["TABULAR", "BOLT"]),
    card("CLOAD",
        &[("AMPLITUDE", Any), ("TIMEDELAY", Any), OP],
        &["FOLLOWER", "LOADCASE", "SUBMODEL", "STEP", "DATASET", "OMEGA0", "SECTOR", "REGIONTYPE", "USER", "REAL",
          "IMAGINARY", "CYCLICMODE", "PROPERTIES"]),
    card("CONTACTPAIR",
        &[("INTERACTION", Any), ("TYPE", Any), ("ADJUST", Any), ("SMALLSLIDING", Flag), ("CPSET", Any),
          ("EXTENSIONZONE", Any), ("TRACKING", Any), ("NAME", Any), ("SUPPLEMENTARYCONSTRAINTS", Any),
          ("NOTHICKNESS", Any), ("SMOOTH", Any), ("MECHANICALCONSTRAINT", Any), ("WEIGHT", Any),
          ("GEOMETRICCORRECTION", Any), ("FRACTION", Any), ("SLIDINGTRANSITION", Any)],
        &["TIED", "HCRIT", "SLIPTOLERANCE", "OP", "MINIMUMDISTANCE", "DELAY"]),
    card("CONTACTPRINT",
        &[("SLAVE", Any), ("MASTER", Any), ("NSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any),
          ("TIMEPOINTS", Any), ("SUMMARY", Any), ("CONTACTELEMENTS", Any)],
        &[]),
    card("COUPLING",
        &[("REFNODE", Any), ("SURFACE", Any), ("ORIENTATION", Any), ("CONSTRAINTNAME", Any)],
        &["INFLUENCERADIUS", "ADJUST", "ALPHA"]),
    card("CYCLICSYMMETRYMODEL", &[("N", Any), ("TIE", Any), ("NGRAPH", Any), ("ELSET", Any), ("CHECK", Any)], &[]),
    card("DENSITY", &[("FLUID", Flag)], &["DEPENDENCIES"]),
    card("DISTRIBUTING",
        &[("COUPLING", Any), ("WEIGHTINGMETHOD", Words(&["UNIFORM"]))],
        &["ROTATIONALCOUPLING", "CYCLICSYMMETRY"]),
    card("DISTRIBUTINGCOUPLING", &[("ELSET", Any)], &[]),
    card("DLOAD",
        &[("AMPLITUDE", Any), ("TIMEDELAY", Any), OP],
        &["FOLLOWER", "LOADCASE", "SUBMODEL", "STEP", "DATASET", "SECTOR", "CONSTANTRESULTANT", "ORIENTATION", "REFNODE",
          "REGIONTYPE", "REAL", "IMAGINARY", "CYCLICMODE", "GLOBALELSET"]),
    card("DSLOAD",
        &[("AMPLITUDE", Any), ("TIMEDELAY", Any), OP],
        &["FOLLOWER", "LOADCASE", "SUBMODEL", "STEP", "DATASET", "SECTOR", "CONSTANTRESULTANT", "ORIENTATION", "REFNODE",
          "REAL", "IMAGINARY", "CYCLICMODE", "GLOBALELSET"]),
    card("ELASTIC",
        &[("TYPE", Any), ("MODULI", Words(&["LONGTERM", "INSTANTANEOUS"]))],
        &["DEPENDENCIES", "COMPRESSIONFACTOR"]),
    card("ELEMENT", &[("TYPE", Any), ("ELSET", Any), ("INPUT", Any)], &["FILE", "OFFSET", "SOLIDELEMENTNUMBERING"]),
    card("ELPRINT",
        &[("ELSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any), ("TIMEPOINTS", Any),
          ("SUMMARY", Any), ("POSITION", Any), ("REBAR", Any), ("DIRECTIONS", Any), ("LASTMODE", Any), ("MODE", Any),
          ("OUTPUT", Any)],
        &[]),
    card("ELSET",
        &[("ELSET", Any), ("GENERATE", Flag), ("INSTANCE", Any), ("INTERNAL", Flag), ("UNSORTED", Flag), ("INPUT", Any)],
        &[]),
    card("ENDSTEP", &[], &[]),
    card("EQUATION", &[], &["REMOVE", "REMOVEALL", "REMOVALL"]),
    card("EXPANSION", &[("TYPE", Any), ("ZERO", Any)], &["DEPENDENCIES", "USER", "POREFLUID"]),
    card("FRICTION",
        &[("LAGRANGE", Any), ("SLIPTOLERANCE", Any), ("ELASTICSLIP", Any)],
        &["ROUGH", "TAUMAX", "ANISOTROPIC", "EXPONENTIALDECAY", "DEPENDENCIES", "USER", "SHEARTRACTIONSLOPE", "TESTDATA",
          "PROPERTIES", "DEPVAR"]),
    card("GAP", &[("ELSET", Any)], &[]),
    card("HEADING", &[("UNSYMM", Any), ("SPARSE", Any)], &[]),
    card("HYPERELASTIC",
        &[("NEOHOOKE", Flag), ("REDUCEDPOLYNOMIAL", Flag), ("OGDEN", Flag), ("ARRUDA-BOYCE", Flag), ("YEOH", Flag),
          ("MOONEY-RIVLIN", Flag), ("POLYNOMIAL", Flag), ("N", Any), ("MODULI", Words(&["LONGTERM", "INSTANTANEOUS"]))],
        &["VANDERWAALS", "MARLOW", "USER", "TESTDATAINPUT", "POISSON", "DEPENDENCIES", "BETA", "TYPE", "PROPERTIES",
          "ANISOTROPIC", "FUNG-ANISOTROPIC", "FUNG-ORTHOTROPIC", "HOLZAPFEL"]),
    card("HYPERFOAM", &[("N", Any), ("MODULI", Words(&["LONGTERM", "INSTANTANEOUS"]))], &["TESTDATAINPUT", "POISSON"]),
    card("INITIALCONDITIONS",
        &[("TYPE", Any), ("USER", Any)],
        &["FILE", "STEP", "INC", "INTERPOLATE", "SECTIONPOINTS", "GEOSTATIC", "REBAR", "UNBALANCEDSTRESS", "VARIABLE",
          "NUMBERBACKSTRESSES", "ABSOLUTEEXTERIORTOLERANCE", "DRIVINGELSETS"]),
    card("INSTANCE", &[("NAME", Any), ("PART", Any)], &["LIBRARY", "INSTANCE"]),
    card("KINEMATIC", &[], &["CYCLICSYMMETRY"]),
    card("MATERIAL", &[("NAME", Any), ("RTOL", Any), ("SRATEFACTOR", Any), ("STRAINRATEREGULARIZATION", Any)], &[]),
    card("MEMBRANE", &[("ELSET", Any), ("MATERIAL", Any)], &[]),
    card("MODELCHANGE", &[("TYPE", Any), ("ADD", Any), ("REMOVE", Any), ("CPSET", Any)],
        &["ACTIVATE", "RESTART", "MECHSTRAINTORESIDUAL"]),
    card("MPC", &[], &["USER", "MODE"]),
    card("NODE", &[("NSET", Any), ("SYSTEM", Any), ("INPUT", Any)], &[]),
    card("NODEPRINT",
        &[("NSET", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any), ("TIMEPOINTS", Any),
          ("SUMMARY", Any), ("LASTMODE", Any), ("MODE", Any), ("OUTPUT", Any)],
        &[]),
    card("NSET",
        &[("NSET", Any), ("ELSET", Any), ("GENERATE", Flag), ("INSTANCE", Any), ("INTERNAL", Flag), ("UNSORTED", Flag),
          ("INPUT", Any), FREQUENCY],
        &[]),
    card("ORIENTATION",
        &[("NAME", Any), ("SYSTEM", Words(&["RECTANGULAR", "R", "CYLINDRICAL", "C"])),
          ("DEFINITION", Words(&["COORDINATES"]))],
        &["LOCALDIRECTIONS"]),
    card("PART", &[("NAME", Any)], &[]),
    card("PLASTIC",
        &[("HARDENING", Any)],
        &["RATE", "DEPENDENCIES", "DATATYPE", "NUMBERBACKSTRESSES", "PROPERTIES", "SCALESTRESS", "EXTRAPOLATION"]),
    card("PRE-TENSIONSECTION", &[("SURFACE", Any), ("NODE", Any), ("ELEMENT", Any)], &[]),
    card("RIGIDBODY",
        &[("NSET", Any), ("ELSET", Any), ("REFNODE", Any), ("ROTNODE", Any), ("ISOTHERMAL", Any),
          ("POSITION", Words(&["INPUT"]))],
        &["PINNSET", "TIENSET", "ANALYTICALSURFACE", "DENSITY", "OFFSET", "NODALTHICKNESS"]),
    card("SECTIONPRINT",
        &[("SURFACE", Any), ("NAME", Any), FREQUENCY, TOTALS, GLOBAL, ("FREQ", Any), ("FREQUENCYF", Any),
          ("TIMEPOINTS", Any), ("AXES", Any), ("UPDATE", Any)],
        &[]),
    card("SOLIDSECTION",
        &[("ELSET", Any), ("MATERIAL", Any), ("ORIENTATION", Any), ("CONTROLS", Any), ("OFFSET", Any)],
        &["NODALTHICKNESS", "COMPOSITE", "LAYUP", "REFNODE", "STACKDIRECTION", "SYMMETRIC"]),
    card("SPRING",
        &[("ELSET", Any), ("ORIENTATION", Any), ("NONLINEAR", Flag), ("RTOL", Any)],
        &["COMPLEXSTIFFNESS", "DEPENDENCIES"]),
    card("STATIC",
        &[("DIRECT", Words(&["", "NOSTOP"])), ("SOLVER", Any), ("STABILIZE", Any), ("ALLSDTOL", Any), ("CONTINUE", Any),
          ("FACTOR", Any)],
        &["RIKS", "TIMERESET", "TOTALTIMEATSTART", "FULLYPLASTIC", "LONGTERM"]),
    card("STEP",
        &[("NLGEOM", Words(&["", "YES", "NO"])), ("INC", Count), ("AMPLITUDE", Words(&["RAMP", "STEP"])),
          ("PERTURBATION", Any), ("NAME", Any), ("UNSYMM", Any), ("EXTRAPOLATION", Any), ("CONVERTSDI", Any),
          ("SOLVER", Any), ("INCF", Any)],
        &["CYCLICSYMMETRY"]),
    card("SURFACE",
        &[("NAME", Any), ("TYPE", Any), ("COMBINE", Any), ("CROP", Any), ("INSTANCE", Any), ("INTERNAL", Flag),
          ("INPUT", Any), ("DEFINITION", Any), ("REGIONTYPE", Any), ("NOTHICKNESS", Any), ("TRIM", Any),
          ("SCALETHICK", Any), ("PROPERTY", Any), ("MAXRATIO", Any), ("DISCRETIZATION", Any), ("FILLETRADIUS", Any)],
        &["OFFSET"]),
    card("SURFACEBEHAVIOR",
        &[("PRESSURE-OVERCLOSURE", Any), ("AUGMENTEDLAGRANGE", Any), ("PENALTY", Any), ("DIRECT", Any), ("METHOD", Any)],
        &["NOSEPARATION", "STIFFNESSBEHAVIOR"]),
    card("SURFACEINTERACTION",
        &[("NAME", Any), ("UNSYMM", Any)],
        &["USER", "DEPVAR", "PROPERTIES", "PADTHICKNESS", "TRACKINGTHICKNESS"]),
    card("TEMPERATURE",
        &[("AMPLITUDE", Any), ("FILE", Any), OP],
        &["BSTEP", "ESTEP", "BINC", "EINC", "SUBMODEL", "STEP", "DATASET", "USER", "INTERPOLATE", "MIDSIDE", "GLOBALELSET",
          "TIMEDELAY", "ABSOLUTEEXTERIORTOLERANCE"]),
    card("TIE",
        &[("NAME", Any), ("POSITIONTOLERANCE", Any), ("ADJUST", YES_NO), ("CYCLICSYMMETRY", Flag), ("TYPE", Any),
          ("NOROTATION", Any), ("NOTHICKNESS", Any), ("CONSTRAINTRATIO", Any)],
        &["TIEDNSET", "MULTIBODY"]),
    card("TRANSFORM", &[("NSET", Any), ("TYPE", Any)], &[]),
];

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
/// `name` is in capitals and without blanks, `value` as it was written.
pub(crate) fn judge(keyword: &str, name: &str, value: &str) -> Option<Fault> {
    let card = CARDS.iter().find(|card| card.keyword == keyword)?;
    let Some((_, takes)) = card.takes.iter().find(|(known, _)| *known == name) else {
        return Some(strange(card, name));
    };
    let found = compared(value);
    let wanted = match takes {
        Any => return None,
        Flag if found.is_empty() => return None,
        Count if found.parse::<u64>().is_ok_and(|count| count > 0) => return None,
        Words(words) if words.contains(&found.as_str()) => return None,
        Flag => "it takes no value".to_owned(),
        Count => "it takes a whole number from 1 on".to_owned(),
        Words(words) => {
            let words: Vec<&str> = words.iter().copied().filter(|w| !w.is_empty()).collect();
            format!("it takes {}", words.join(" or "))
        }
    };
    let meant = match takes {
        Words(words) => closest(&found, words.iter().copied()),
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

/// A parameter that the card does not take.
fn strange(card: &Card, name: &str) -> Fault {
    let (keyword, shown) = (card.keyword, shown(name));
    let known: Vec<&str> = card.takes.iter().map(|(name, _)| *name).collect();
    let known = match known.is_empty() {
        true => format!("*{keyword} takes no parameters"),
        false => format!("*{keyword} takes {}", known.join(", ")),
    };
    if name == "INPUT" || card.refused.contains(&name) {
        return Fault {
            code: &codes::NOT_BUILT,
            message: format!("{shown} of *{keyword} is not supported"),
            remark: match name {
                "INPUT" => {
                    "write the lines into the deck, or *INCLUDE, INPUT=… below the card".to_owned()
                }
                _ => "without it the deck means something else".to_owned(),
            },
            known,
        };
    }
    let names = card.takes.iter().map(|(name, _)| *name);
    let meant = closest(name, names.chain(card.refused.iter().copied()));
    Fault {
        code: &codes::UNKNOWN_KEY,
        message: format!("*{keyword} has no parameter {shown}"),
        remark: meant.map_or(String::new(), |meant| format!("did you mean {meant}?")),
        known,
    }
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
        let compact = |name: &str| name.replace(' ', "");
        let read = KEYWORDS.iter().filter(|one| one.support == Support::Read);
        let read: Vec<String> = read.map(|one| compact(one.name)).collect();
        for keyword in read.iter().filter(|keyword| *keyword != "INCLUDE") {
            let count = CARDS.iter().filter(|card| card.keyword == keyword).count();
            assert_eq!(count, 1, "{keyword}");
        }
        for card in CARDS {
            assert!(
                read.iter().any(|one| one == card.keyword),
                "{}",
                card.keyword
            );
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
        for card in CARDS {
            let is_known = |name: &String| card.takes.iter().any(|(known, _)| known == name);
            for (name, _) in card.takes.iter().filter(|(name, _)| name.len() > 3) {
                for typed in misspelt(name).into_iter().filter(|name| !is_known(name)) {
                    let fault = judge(card.keyword, &typed, "").unwrap();
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
            for (name, takes) in card.takes {
                let Words(words) = takes else { continue };
                for word in *words {
                    assert!(judge(card.keyword, name, &word.to_lowercase()).is_none());
                    let others = misspelt(word).into_iter();
                    for typed in others.filter(|typed| !words.contains(&typed.as_str())) {
                        let fault = judge(card.keyword, name, &typed).unwrap();
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
}
