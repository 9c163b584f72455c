//! The forms of data lines: how many values a line takes, and how many lines a card.
//!
//! A line that is cut off has too few values, a decimal comma makes too many: both would be another model. Values that may
//! be left out are those at the end of a line; empty fields between others are zero.
//!
//! To add a card: one entry in [`form`].

use super::translation::Translation;
use crate::diagnostic::{Diagnostic, codes};
use crate::readers::inp::{Field, Statement, compared};

/// How many there may be, from and to.
type Range = (usize, usize);

const ANY: Range = (0, usize::MAX);
const NONE: Range = (0, 0);

/// What the data lines of a card are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Form {
    /// Lines.
    lines: Range,
    /// Values of each line, or of all together.
    values: Range,
    /// Whether values go on over lines.
    together: bool,
    /// What they are, in words.
    words: &'static str,
}

const fn each(lines: Range, values: Range, words: &'static str) -> Form {
    Form {
        lines,
        values,
        together: false,
        words,
    }
}

const fn together(values: Range, words: &'static str) -> Form {
    Form {
        lines: (1, usize::MAX),
        values,
        together: true,
        words,
    }
}

/// One line or more.
const SOME: Range = (1, usize::MAX);
const AT_MOST_ONE: Range = (0, 1);
const ONE: Range = (1, 1);

/// A temperature with its change along the normal of shells.
const WITH_GRADIENT: &str = "node or set, temperature, gradient of shells";

/// Whether a card without data lines is refused here.
pub(super) fn needs_data(card: &Statement) -> bool {
    form(card).is_some_and(|form| form.lines.0 > 0)
}

/// What a card takes; nothing where that is judged by the stage that reads it.
fn form(card: &Statement) -> Option<Form> {
    // a card that takes back what was there before may have no lines
    let renews = card.peek("OP").map(compared).as_deref() == Some("NEW");
    let some = if renews { ANY } else { SOME };
    Some(match card.keyword.as_str() {
        "SUBMODEL" => each(SOME, (1, usize::MAX), "nodes or node sets"),
        "BOUNDARY" => each(
            some,
            (2, 4),
            "node or set, first and last degree of freedom, value",
        ),
        "CLOAD" => each(some, (3, 3), "node or set, degree of freedom, force"),
        "PRESSUREPENETRATION" => each(
            SOME,
            (3, 4),
            "nodes of both surfaces, pressure, critical pressure",
        ),
        "DSLOAD" => each(some, (3, 3), "surface, P, pressure"),
        "TEMPERATURE" if card.peek("FILE").is_some() => return None,
        "TEMPERATURE" => each(some, (2, 3), WITH_GRADIENT),
        "CHANGEFRICTION"
        | "CHANGESOLIDSECTION"
        | "CHANGESURFACEBEHAVIOR"
        | "CLEARANCE"
        | "COUPLING"
        | "ENDSTEP"
        | "MATERIAL"
        | "RIGIDBODY" => each(NONE, NONE, "no data lines"),
        "CONTACT" | "CONTACTINITIALIZATIONDATA" => each(NONE, NONE, "no data lines"),
        "CONTACTINCLUSIONS" | "CONTACTEXCLUSIONS" => each(ANY, (0, 2), "two surfaces, or one"),
        "CONTACTPROPERTYASSIGNMENT" => each(SOME, (3, 3), "two surfaces, interaction"),
        "CONTACTINITIALIZATIONASSIGNMENT" => each(SOME, (3, 3), "two surfaces, data"),
        "CONTACTFORMULATION" => each(SOME, (3, 3), "two surfaces, role of the first"),
        "CONTACTPAIR" | "TIE" => each(SOME, (2, 2), "secondary and primary surface"),
        "MODELCHANGE" if card.peek("TYPE").map(compared).as_deref() == Some("CONTACTPAIR") => {
            each(SOME, (2, 2), "secondary and primary surface")
        }
        "MODELCHANGE" if card.peek("TYPE").map(compared).as_deref() == Some("ELEMENT") => {
            match card.peek("MECHSTRAINTORESIDUAL") {
                Some(_) => return None,
                None => each(SOME, (1, usize::MAX), "elements or element sets"),
            }
        }
        "CYCLICSYMMETRYMODEL" | "TRANSFORM" => each(ONE, (4, 6), "two points of three coordinates"),
        "DISTRIBUTINGCOUPLING" => each(SOME, (2, 2), "node or set, weight"),
        "GAP" => each(
            ONE,
            (2, 7),
            "clearance, a direction of three components, nothing, stiffness, tension",
        ),
        "KINEMATIC" => each(ANY, (1, 2), "first and last degree of freedom"),
        "DISTRIBUTION" => each(
            SOME,
            (7, 7),
            "element, set or nothing, two points of three coordinates",
        ),
        "NODALTHICKNESS" => each(SOME, (2, 3), "node or set, thickness"),
        "ORIENTATION" => each((1, 2), (1, 6), "two points of three coordinates"),
        "PRE-TENSIONSECTION" => each(AT_MOST_ONE, (0, 3), "a direction of three components"),
        "SHELLSECTION" if card.peek("COMPOSITE").is_some() => return None,
        "SHELLSECTION" => each(AT_MOST_ONE, (0, 2), "a thickness, integration points"),
        "SOLIDSECTION" => each(AT_MOST_ONE, (0, 1), "a thickness or a cross-section"),
        "SURFACEINTERACTION" => each(AT_MOST_ONE, (0, 1), "a thickness"),
        "CFLUX" => each(some, (3, 3), "node or set, 11, heat per time"),
        "DFLUX" => each(some, (3, 3), "element or set, S1 to S6 or BF, heat"),
        "DSFLUX" => each(some, (3, 3), "surface, S, heat per time and area"),
        "FILM" => each(some, (4, 4), "element or set, F1 to F6, sink, coefficient"),
        "SFILM" => each(some, (4, 4), "surface, F, sink, coefficient"),
        "RADIATE" => each(some, (4, 4), "element or set, R1 to R6, sink, emissivity"),
        "SRADIATE" => each(some, (4, 4), "surface, R, sink, emissivity"),
        "PHYSICALCONSTANTS" => each(NONE, NONE, "no data lines"),
        "STATIC"
        | "DYNAMIC"
        | "HEATTRANSFER"
        | "COUPLEDTEMPERATURE-DISPLACEMENT"
        | "UNCOUPLEDTEMPERATURE-DISPLACEMENT" => each(
            AT_MOST_ONE,
            (0, 4),
            "initial increment, period, smallest and largest increment",
        ),
        "FREQUENCY" => each(ONE, (1, 3), "number of frequencies, lowest, highest"),
        "INITIALCONDITIONS" => match card.peek("TYPE").map(compared).as_deref() {
            Some("TEMPERATURE") => each(SOME, (2, 3), WITH_GRADIENT),
            Some("VELOCITY") => each(SOME, (3, 3), "node or set, component, velocity"),
            Some("STRESS" | "PLASTICSTRAIN") if card.peek("USER").is_none() => {
                each(SOME, (3, 8), "element, integration point, six components")
            }
            _ => return None,
        },
        "SURFACEBEHAVIOR" => return behavior(card),
        _ => return property(card),
    })
}

/// Constants of materials.
fn property(card: &Statement) -> Option<Form> {
    let kind = card.peek("TYPE").map(compared).unwrap_or_default();
    let terms = card.peek("N").map_or(Some(1), |n| n.trim().parse().ok());
    let terms: Option<usize> = terms.filter(|terms| (1..=6).contains(terms));
    Some(match card.keyword.as_str() {
        "CONDUCTIVITY" if kind == "ORTHO" => {
            each(SOME, (3, 4), "three conductivities, temperature")
        }
        "CONDUCTIVITY" if kind == "ANISO" => each(SOME, (6, 7), "six conductivities, temperature"),
        "CONDUCTIVITY" => each(SOME, (1, 2), "conductivity, temperature"),
        "SPECIFICHEAT" => each(SOME, (1, 2), "specific heat, temperature"),
        "LATENTHEAT" => each(SOME, (3, 3), "latent heat, solidus, liquidus"),
        "GAPCONDUCTANCE" => each(SOME, (1, 3), "conductance, gap or pressure, temperature"),
        "GAPHEATGENERATION" => each(AT_MOST_ONE, (0, 3), "fraction, part of the secondary side"),
        "COHESIVEBEHAVIOR" => each(AT_MOST_ONE, (2, 3), "Knn, Kss, Ktt"),
        "CONTACTDAMPING" => each(ONE, (1, 1), "pressure over velocity"),
        "DAMAGEINITIATION" => each(ONE, (2, 3), "strengths of opening and of both shears"),
        "DAMAGEEVOLUTION" => each(ONE, (1, 3), "energies of opening and of both shears"),
        "DAMAGESTABILIZATION" => each(ONE, (1, 1), "viscosity"),
        "DENSITY" => each(SOME, (1, 2), "density, temperature"),
        "DEFORMATIONPLASTICITY" => each(SOME, (5, 6), "E, nu, s0, n, alpha, temperature"),
        "ELASTIC" if kind.is_empty() || "ISOTROPIC".starts_with(&kind) => {
            each(SOME, (2, 3), "E, nu, temperature")
        }
        // those of several temperatures are refused where they are read
        "ELASTIC" if "ANISOTROPIC".starts_with(&kind) => {
            together((21, usize::MAX), "21 constants, temperature")
        }
        "ELASTIC" if kind.starts_with("ENGINEERING") || "ORTHOTROPIC".starts_with(&kind) => {
            together((9, usize::MAX), "nine constants, temperature")
        }
        "EXPANSION" if kind.is_empty() || "ISOTROPIC".starts_with(&kind) => {
            each(SOME, (1, 2), "coefficient, temperature")
        }
        "FRICTION" => each(SOME, (1, 2), "coefficient, slope of sticking"),
        "MASS" => each(ONE, (1, 1), "mass"),
        "ROTARYINERTIA" => each(ONE, (3, 6), "I11, I22, I33, I12, I13, I23"),
        "PLASTIC" => each(SOME, (2, 3), "yield stress, plastic strain, temperature"),
        "HYPERELASTIC" if card.peek("OGDEN").is_some() => {
            let n = terms?;
            together(
                (2 * n, 3 * n + 1),
                "mu and alpha of each term, D of each, temperature",
            )
        }
        "HYPERELASTIC"
            if terms == Some(1)
                && (card.peek("NEOHOOKE").is_some()
                    || card.peek("REDUCEDPOLYNOMIAL").is_some()) =>
        {
            together((1, 3), "C10, D1, temperature")
        }
        "HYPERELASTIC" if terms == Some(1) => together((2, 4), "C10, C01, D1, temperature"),
        "HYPERFOAM" => {
            let n = terms?;
            together(
                (2 * n, 3 * n + 1),
                "mu and alpha of each term, nu of each, temperature",
            )
        }
        _ => return None,
    })
}

/// Laws of surfaces.
fn behavior(card: &Statement) -> Option<Form> {
    let kind = card.peek("PRESSURE-OVERCLOSURE").map(compared);
    Some(match kind.as_deref() {
        None | Some("" | "HARD") => each(NONE, NONE, "no data lines"),
        Some("LINEAR") => each(ONE, (1, 3), "stiffness, tension, largest gap"),
        Some("EXPONENTIAL") => each(ONE, (2, 2), "c0, p0"),
        Some("TABULAR") => each(SOME, (2, 3), "pressure, overclosure, temperature"),
        Some("TIED") => each(AT_MOST_ONE, (0, 2), "stiffness"),
        _ => return None,
    })
}

/// Where values may be left out that a decimal comma would fill: from this one on, in a card of one line.
fn optional(card: &Statement) -> Option<usize> {
    match card.keyword.as_str() {
        "DENSITY" | "EXPANSION" | "FRICTION" => Some(1),
        "ELASTIC" | "PLASTIC" => Some(2),
        _ => None,
    }
}

impl Translation<'_> {
    /// Refuses lines with too few values or too many, and cards with too few lines or too many.
    pub fn forms(&mut self) {
        for card in &self.deck.statements {
            if let Some(form) = form(card) {
                let form = match self.shell_nodes.is_empty() && form.words == WITH_GRADIENT {
                    true => each(form.lines, (2, 2), "node or set, temperature"),
                    false => form,
                };
                self.lines_of(card, form);
            }
            if card.keyword == "DLOAD" {
                self.distributed_lines(card);
            }
        }
    }

    fn lines_of(&mut self, card: &Statement, form: Form) {
        // an empty line stands for values that are all left out; there may be a million others, so that none is kept
        let rows = || card.peek_rows().filter(|row| !row.is_empty());
        let (least, most) = form.lines;
        if rows().take(least).count() < least {
            let text = format!("*{} has no data line", card.title);
            let help = format!("write below it: {}", form.words);
            let one = Diagnostic::error(&codes::MISSING, text).at(&card.place, "");
            self.found.push(one.help(help));
            return;
        }
        if most < usize::MAX
            && let Some(row) = rows().nth(most)
        {
            let text = match most {
                0 => format!("*{} takes no data line", card.title),
                _ => format!("*{} takes {most} data line{}", card.title, s(most)),
            };
            let place = row.first().map_or_else(|| card.place.clone(), Field::place);
            self.error(
                &codes::WRONG_LENGTH,
                text,
                &place,
                "this line is one too many",
            );
            return;
        }
        if form.together {
            let all: Vec<Field<'_>> = rows().flatten().collect();
            self.values_of(card, &all, form.values, (form.words, ""));
            return;
        }
        for row in rows() {
            self.values_of(card, &row, form.values, (form.words, " on a line"));
        }
        if let Some(from) = optional(card)
            && let (Some(row), None) = (rows().next(), rows().nth(1))
        {
            self.decimal_comma(card, &row, from);
        }
    }

    /// Lines of *DLOAD, whose values depend on what acts.
    fn distributed_lines(&mut self, card: &Statement) {
        let rows = || card.peek_rows().filter(|row| !row.is_empty());
        let renews = card.peek("OP").map(compared).as_deref() == Some("NEW");
        if !renews && rows().next().is_none() {
            let text = "*DLOAD has no data line";
            let one = Diagnostic::error(&codes::MISSING, text).at(&card.place, "");
            let help =
                "write below it: element or set, P1 to P6 and a pressure, or GRAV, or CENTRIF";
            self.found.push(one.help(help));
        }
        for row in rows() {
            let (values, words) = match row.get(1).map(Field::key).as_deref() {
                Some("GRAV") => (
                    (4, 6),
                    "set, GRAV, acceleration, three components of its direction",
                ),
                Some("CENTRIF") => (
                    (7, 9),
                    "set, CENTRIF, square of the speed, a point and a direction of the axis",
                ),
                _ => ((3, 3), "element or set, side, pressure"),
            };
            self.values_of(card, &row, values, (words, " on a line"));
        }
    }

    /// Judges the number of values: what they are in words, and where they stand.
    pub fn values_of(
        &mut self,
        card: &Statement,
        row: &[Field<'_>],
        values: Range,
        (words, of): (&str, &str),
    ) {
        let (least, most) = values;
        let found = row.len();
        if (least..=most).contains(&found) {
            return;
        }
        let wanted = match (least, most) {
            (0, most) => format!("{most} at most"),
            (least, usize::MAX) => format!("{least} or more"),
            (least, most) if least == most => least.to_string(),
            (least, most) => format!("{least} to {most}"),
        };
        let text = format!(
            "*{} takes {wanted} value{}{of}, found {found}",
            card.title,
            s(most)
        );
        let at = row.get(most).or(row.last());
        let place = at.map_or_else(|| card.place.clone(), Field::place);
        let remark = match found > most {
            true => "one too many",
            false => "the line ends here",
        };
        let mut one = Diagnostic::error(&codes::WRONG_LENGTH, text).at(&place, remark);
        one = one.note(format!("it takes: {words}"));
        if found > most {
            if let Some(help) = decimals(row) {
                one = one.help(help);
            }
        } else {
            one = one.help("write what is missing; was the deck cut off here?");
        }
        self.found.push(one);
    }

    /// Refuses `0,3` where it would be a nought and a temperature, say: one digit, and others right behind the comma, in
    /// the first place that may be left out.
    fn decimal_comma(&mut self, card: &Statement, row: &[Field<'_>], from: usize) {
        let Some([before, after]) = from.checked_sub(1).and_then(|at| row.get(at..=from)) else {
            return;
        };
        let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let whole = before.text.trim_start_matches(['+', '-']);
        if whole.len() == 1 && is_digits(whole) && is_digits(after.text) && before.touches(after) {
            let (a, b) = (before.text, after.text);
            let text = format!(
                "`{a},{b}` in *{} looks like a decimal number with a comma",
                card.title
            );
            let one = Diagnostic::error(&codes::NOT_A_NUMBER, text)
                .at(&before.place(), "a comma separates two values")
                .help(format!(
                    "write {a}.{b}; or, if two values are meant, {a}., {b}."
                ));
            self.found.push(one);
        }
    }
}

/// What to do about decimal commas, where two fields look like one number.
fn decimals(row: &[Field<'_>]) -> Option<String> {
    let is_whole = |field: &Field<'_>| {
        let digits = field.text.trim_start_matches(['+', '-']);
        !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit())
    };
    let goes_on = |field: &Field<'_>| {
        let digits = field.text.split(['e', 'E', 'd', 'D']).next();
        digits
            .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()))
    };
    let pairs = row.windows(2).filter_map(|pair| match pair {
        [a, b] if is_whole(a) && goes_on(b) => Some((a, b)),
        _ => None,
    });
    let pairs: Vec<_> = pairs.collect();
    let apart = row
        .windows(2)
        .any(|pair| matches!(pair, [a, b] if !a.touches(b)));
    let close = pairs.iter().rev().find(|(a, b)| !apart || a.touches(b));
    let (a, b) = close.or(pairs.last())?;
    let (a, b) = (a.text, b.text);
    Some(format!(
        "if `{a},{b}` is one number, write it with a decimal point: {a}.{b}"
    ))
}

const fn s(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
