//! Solver, output, checkpoints, expectations.

use super::*;

pub(super) static SOLVER: Table = Table {
    heading: "[solver]",
    doc: "how equations are solved",
    keys: &[
        key("newton", Shape::Table(&NEWTON), NEWTON.doc),
        key(
            "linear",
            Shape::Choice(&[
                word("auto"),
                word("direct"),
                word("multigrid"),
                word("mumps"),
                word("petsc"),
                Choice::later("iterative", "direct"),
            ]),
            "how linear equations are solved: auto takes multigrid for large models in space and the direct solver for others; petsc shares them out among the ranks of mpirun, and is what auto takes there; mumps and petsc are there where the program was built with them",
        )
        .or(Default::Text("auto")),
        key(
            "stabilize",
            Shape::Either(&[AUTO, Shape::Flag]),
            "whether a vanishing viscous force holds bodies that only open contact holds",
        )
        .or(Default::Text("auto")),
        key(
            "free_motions",
            Shape::Choice(&[word("refuse"), word("hold")]),
            "motions that nothing resists: an error, or held where no load acts on them",
        )
        .or(Default::Text("refuse")),
        key(
            "on_trouble",
            Shape::List(
                &Shape::Choice(&[word("cut"), word("stabilize"), word("points")]),
                0,
                3,
            ),
            "what is tried, in order, when an increment does not converge; points solves the case again from the start, with Gauss points in contacts for which the program chose mortar",
        )
        .or(Default::Texts(&["cut", "stabilize", "points"])),
        key(
            "threads",
            Shape::Either(&[AUTO, Shape::Integer(1, 4096)]),
            "the number of threads",
        )
        .or(Default::Text("auto")),
    ],
    rules: &[],
};

pub(super) static NEWTON: Table = Table {
    heading: "newton",
    doc: "Newton's method",
    keys: &[
        key(
            "max_iterations",
            COUNT,
            "iterations of an increment at most, and three times as many while its force error falls",
        )
        .or(Default::Integer(20)),
        key(
            "force_tol",
            POSITIVE,
            "largest residual force, relative to the mean force",
        )
        .or(Default::Number(1e-6))
        .hints(&["tol", "tolerance", "rtol"]),
        key(
            "gap_tol",
            POSITIVE,
            "largest penetration, relative to the size of a facet, of laws with multipliers",
        )
        .or(Default::Number(1e-6)),
        key(
            "line_search",
            Shape::Either(&[AUTO, Shape::Flag]),
            "whether corrections are shortened",
        )
        .or(Default::Text("auto")),
        key(
            "stress",
            Shape::Choice(&[word("auto"), word("mixed"), word("current")]),
            "stress of the geometric stiffness at finite strain: `mixed` takes the stress that the last correction predicted, `auto` does in shells, and in other thin bodies where no contact has friction",
        )
        .or(Default::Text("auto")),
    ],
    rules: &[],
};

pub(super) static OUTPUT: Table = Table {
    heading: "[output]",
    doc: "what is written",
    keys: &[
        key(
            "format",
            Shape::List(&Shape::Choice(FORMATS), 1, 4),
            "formats of results",
        )
        .or(Default::Texts(&["vtu"])),
        key(
            "fields",
            Shape::List(&Shape::Choice(WORDS_OF_FIELDS), 0, MANY),
            "fields to write",
        )
        .or(Default::Texts(&["displacement", "stress", "contact"]))
        .hints(&["field"]),
        key(
            "contact_pressure",
            Shape::Choice(&[word("multiplier"), word("smoothed")]),
            "pressures and tractions of mortar contact on quadratic triangles: those of the equations, or smoothed over the triangles that touch",
        )
        .or(Default::Text("multiplier")),
        key(
            "every",
            Shape::Either(&[COUNT, Shape::Table(&EVERY)]),
            "write after so many increments, or { time }",
        )
        .or(Default::Integer(1)),
        key(
            "names",
            Shape::Choice(&[word("signorini"), Choice::later("abaqus", "signorini")]),
            "how fields are named",
        )
        .or(Default::Text("signorini")),
        key("history", Shape::Tables(&HISTORY), HISTORY.doc),
    ],
    rules: &[],
};
/// The words of `[output] fields`. Fields at nodes come with their counterpart in the cells, where there is one.
pub const FIELDS: [&str; 12] = [
    "displacement",
    "reaction_force",
    "stress",
    "cauchy_stress",
    "von_mises",
    "principal",
    "principal_stress",
    "strain",
    "plastic_strain",
    "temperature",
    "contact",
    "contact_pressure",
];
const WORDS_OF_FIELDS: &[Choice] = &{
    let mut words = [word(""); FIELDS.len()];
    let mut at = 0;
    while at < FIELDS.len() {
        words[at] = word(FIELDS[at]);
        at += 1;
    }
    words
};
const FORMATS: &[Choice] = &[
    word("vtu"),
    Choice::later("vtkhdf", "vtu"),
    word("frd"),
    Choice::later("xdmf", "vtu"),
];

pub(super) static EVERY: Table = Table {
    heading: "every",
    doc: "how often results are written",
    keys: &[key("time", POSITIVE, "after so much time").required()],
    rules: &[],
};

pub(super) static HISTORY: Table = Table {
    heading: "[[output.history]]",
    doc: "columns of history.csv",
    keys: &[
        key("name", Shape::Text, "the first part of the column's name").required(),
        key(
            "quantity",
            NAMES,
            "the quantity, as in force_z or displacement.z, or a list of them",
        )
        .required()
        .hints(&["quantities"]),
        key("contact", Shape::Text, "of this contact"),
        key("reference", Shape::Text, "of this reference or rigid body"),
        key("node", ID, "of the node of this number"),
        key(
            "set",
            Shape::Text,
            "of this set: the sum of forces, the mean of other quantities",
        ),
    ],
    rules: &[Rule::ExactlyOne(&["contact", "reference", "node", "set"])],
};

pub(super) static CHECKPOINT: Table = Table {
    heading: "[checkpoint]",
    doc: "when a run can be resumed from",
    keys: &[
        key(
            "every",
            Shape::Table(&CHECKPOINT_EVERY),
            "how often; absent: { increments = 5, wall = \"10 min\" }",
        ),
        key(
            "keep",
            Shape::Integer(1, 26),
            "how many are kept, in files that take turns; at least two",
        )
        .or(Default::Integer(2)),
    ],
    rules: &[],
};

pub(super) static CHECKPOINT_EVERY: Table = Table {
    heading: "every",
    doc: "how often checkpoints are written",
    keys: &[
        key("increments", COUNT, "after so many increments"),
        key(
            "wall",
            Shape::Text,
            "after so much time on the clock, as in \"10 min\"",
        ),
    ],
    rules: &[Rule::AtLeastOne(&["increments", "wall"])],
};

pub(super) static CYCLE: Table = Table {
    heading: "[[cycle]]",
    doc: "steps that come again and again",
    keys: &[
        key(
            "steps",
            Shape::List(&Shape::Text, 1, MANY),
            "their names, which follow one another in the case",
        )
        .required(),
        key("count", COUNT, "how many cycles there are").required(),
        key("jump", Shape::Table(&JUMP), JUMP.doc),
    ],
    rules: &[],
};

static JUMP: Table = Table {
    heading: "jump",
    doc: "one cycle that is solved stands for many, as far as wear changes little from one to the next; absent: each is solved",
    keys: &[
        key(
            "tol",
            POSITIVE,
            "what may go wrong in one of them, over the depth",
        )
        .or(Default::Number(0.01)),
        key(
            "first",
            COUNT,
            "for how many the first stands; absent: one in ten thousand",
        ),
        key(
            "max_wear",
            POSITIVE,
            "the largest depth that one may take off (length); absent: any",
        ),
    ],
    rules: &[],
};

pub(super) static EXPECT: Table = Table {
    heading: "[[expect]]",
    doc: "values that are checked at the end",
    keys: &[
        key(
            "what",
            Shape::Text,
            "a column of history.csv, or \"displacement.z @ node 5\"",
        )
        .required()
        .hints(&["quantity", "name"]),
        key("at", COUNT, "the data row of history.csv; absent: the last").hints(&["row"]),
        key("time", ANY, "the total time"),
        key("value", ANY, "what it should be").required(),
        key("tol", Shape::Table(&TOLERANCE), TOLERANCE.doc)
            .required()
            .hints(&["tolerance"]),
    ],
    rules: &[Rule::AtMostOne(&["at", "time"])],
};

pub(super) static TOLERANCE: Table = Table {
    heading: "tol",
    doc: "how far off it may be: { rel } relative to the value, or { abs } in its unit",
    keys: &[
        key("rel", NOT_NEGATIVE, "relative to the value"),
        key("abs", NOT_NEGATIVE, "in the unit of the value"),
    ],
    rules: &[Rule::ExactlyOne(&["rel", "abs"])],
};
