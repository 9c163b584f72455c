//! Contacts, and their changes in a step.

use super::placeholders::LAWS;
use super::*;

pub(super) static CONTACT: Table = Table {
    heading: "[[contact]]",
    doc: "pairs of surfaces that may touch",
    keys: &[
        key("name", Shape::Text, "its name, in results and messages"),
        key(
            "secondary",
            Shape::Text,
            "the side that carries the points: the finer, softer or more curved one",
        )
        .hints(&["slave", "source"]),
        key(
            "primary",
            Shape::Text,
            "the side they may not pass through: a set, a [[surface]], or \"self\"",
        )
        .hints(&["master", "target"]),
        key(
            "all",
            Shape::Either(&[Shape::Flag, Shape::List(&Shape::Text, 1, MANY)]),
            "true: every outer face may touch every other, and pairs are found; a list: those of these bodies, groups or sets",
        )
        .hints(&["general", "auto"]),
        key(
            "self",
            Shape::Flag,
            "with `all`: whether bodies may touch themselves",
        )
        .or(Default::Flag(true)),
        key(
            "exclude",
            Shape::List(&NAMES, 1, MANY),
            "with `all`: what touches nothing; a pair of names: what does not touch each other, or itself",
        )
        .hints(&["exclusions"]),
        key(
            "method",
            Shape::Choice(METHODS),
            "how the sides are discretized",
        )
        .or(Default::Text("auto")),
        key(
            "passes",
            Shape::Integer(1, 2),
            "1, or 2: also with the sides swapped",
        )
        .or(Default::Integer(1)),
        key("rule", Shape::Table(&RULE), RULE.doc).hints(&["integration", "quadrature"]),
        key(
            "area",
            Shape::Choice(&[
                word("reference"),
                word("current"),
                word("adjacent"),
                word("opposite"),
            ]),
            "what points stand for: their area at the start, their present one, that of all outer faces at a node, or the facet opposite",
        )
        .or(Default::Text("reference")),
        key(
            "enforcement",
            Shape::Either(ENFORCEMENTS),
            "how penetration is prevented",
        )
        .or(Default::Text("auto")),
        key("adhesion", Shape::Table(&ADHESION), ADHESION.doc),
        FRICTION_KEY.or(Default::Number(0.0)),
        key(
            "friction_history",
            Shape::Choice(&[word("place"), word("traction")]),
            "what sticking points remember: the place where they stick; or, as OOFEM has it, the traction of the last increment, without friction in the one in which they close",
        )
        .or(Default::Text("place")),
        key("gasket", Shape::Table(&GASKET), GASKET.doc).hints(&["seal"]),
        key("fluid", Shape::Table(&FLUID), FLUID.doc).hints(&["penetration", "leak"]),
        key("damping", Shape::Table(&DAMPING), DAMPING.doc).hints(&["viscosity"]),
        key(
            "restitution",
            Shape::Number(Bounds {
                from: Some(0.0),
                to: Some(1.0),
                ..FREE
            }),
            "the velocity with which points leave an impact, over that with which they came: of multipliers, between rigid sides, and in explicit steps",
        )
        .or(Default::Number(0.0)),
        key("wear", Shape::Table(&WEAR), WEAR.doc).hints(&["archard"]),
        key(
            "conductance",
            Shape::Either(&[NOT_NEGATIVE, Shape::Table(&CONDUCTANCE)]),
            "heat per time, area and difference of temperatures of what touches; or the ways that heat takes, which add up; absent: none",
        )
        .hints(&["gap_conductance"]),
        key(
            "friction_heat",
            Shape::Either(&[Shape::Flag, Shape::Table(&FRICTION_HEAT)]),
            "whether friction heats the sides, in half each where nothing else is said",
        )
        .or(Default::Flag(true))
        .hints(&["frictional_heat"]),
        key(
            "temperature",
            ANY,
            "the temperature of a rigid surface; absent: it neither gives nor takes heat",
        ),
        key(
            "sliding",
            Shape::Choice(&[word("auto"), word("finite"), word("increment"), word("small")]),
            "how far points slide: any way; or each keeps the tangent plane it meets at the start of the increment, or first. auto: \"small\" in linear geometry, else \"finite\"",
        )
        .or(Default::Text("auto")),
        key(
            "features",
            Shape::Choice(&[word("auto"), word("faces"), word("edges")]),
            "where points may rest: anywhere and a little beyond the rim, within faces only, or on the edges of the rim, too",
        )
        .or(Default::Text("auto")),
        key(
            "tied",
            Shape::Either(&[Shape::Flag, Shape::Table(&TIED)]),
            "whether the sides are joined: false, true or { offset, within }",
        )
        .or(Default::Flag(false))
        .hints(&["bonded", "glued", "tie"]),
        key("cohesive", Shape::Table(&COHESIVE), COHESIVE.doc).hints(&[
            "cohesion", "adhesive", "czm", "damage",
        ]),
        key("start", Shape::Table(&START), START.doc).hints(&["adjust", "initial"]),
        key(
            "normals",
            Shape::Either(&[
                Shape::Choice(&[word("primary"), word("secondary"), word("nodal")]),
                VECTOR,
            ]),
            "of node-to-node: those of a side, or a vector towards the secondary side; of mortar: \"nodal\", or \"secondary\" for those of facets, which turn to the other side otherwise",
        )
        .or(Default::Text("primary"))
        .hints(&["normal"]),
        key(
            "basis",
            Shape::Choice(&[word("part"), word("whole")]),
            "of mortar, on quadratic facets: over what no weight of a node is negative, any part of a facet or the whole",
        )
        .or(Default::Text("part")),
        key(
            "pairs",
            Shape::Choice(&[word("nearest"), word("order")]),
            "of node-to-node: which nodes meet, the nearest or those of one place in the two lists",
        )
        .or(Default::Text("nearest")),
        key(
            "reach",
            Shape::Either(&[AUTO, POSITIVE]),
            "how far the sides are searched for each other (length)",
        )
        .or(Default::Text("auto")),
        key(
            "active",
            Shape::Flag,
            "whether it acts from the first step on",
        )
        .or(Default::Flag(true)),
        key("pair", Shape::Tables(&PAIR), PAIR.doc),
    ],
    rules: &[
        Rule::Instead("all", &["name", "secondary", "primary"]),
        Rule::Needs("self", "all"),
        Rule::Needs("exclude", "all"),
        Rule::Needs("pair", "all"),
        Rule::AtMostOne(&["all", "gasket"]),
        Rule::AtMostOne(&["all", "fluid"]),
        Rule::AtMostOne(&["gasket", "enforcement"]),
    ],
};

static PAIR: Table = Table {
    heading: "[[contact.pair]]",
    doc: "with `all`: what is different where two of them meet; of several that name a pair the last holds",
    keys: &[
        key(
            "between",
            Shape::List(&Shape::Text, 2, 2),
            "two bodies, groups, sets or materials, or \"any\"",
        )
        .required(),
        FRICTION_KEY,
        key(
            "enforcement",
            Shape::Either(ENFORCEMENTS),
            "how penetration is prevented",
        ),
        key(
            "method",
            Shape::Choice(METHODS),
            "how the sides are discretized",
        ),
        key(
            "secondary",
            Shape::Text,
            "the one of the two that carries the points",
        ),
        key("start", Shape::Table(&START), START.doc).hints(&["adjust", "initial"]),
    ],
    rules: &[Rule::AtLeastOne(&[
        "friction",
        "enforcement",
        "method",
        "secondary",
        "start",
    ])],
};
const METHODS: &[Choice] = &[
    word("auto"),
    word("node-to-node"),
    word("node-to-segment"),
    word("gauss-point"),
    word("mortar"),
];
const ENFORCEMENTS: &[Shape] = &[AUTO, Shape::Table(&ENFORCEMENT)];
const FRICTIONS: &[Shape] = &[NOT_NEGATIVE, Shape::Table(&FRICTION)];
const FRICTION_KEY: Key = key(
    "friction",
    Shape::Either(FRICTIONS),
    "coefficient of friction, or a table of what limits it",
)
.hints(&["mu"]);

static CONDUCTANCE: Table = Table {
    heading: "conductance",
    doc: "ways that heat takes across a contact, up to its reach: heat per time, area and difference of temperatures",
    keys: &[
        key("constant", NOT_NEGATIVE, "of what touches"),
        key(
            "over_pressure",
            Shape::List(
                &Shape::Row("[pressure, h]", &[NOT_NEGATIVE, NOT_NEGATIVE]),
                1,
                MANY,
            ),
            "rows [pressure, h] of what touches, linear between, constant outside",
        ),
        key(
            "over_gap",
            Shape::List(&Shape::Row("[gap, h]", &[ANY, NOT_NEGATIVE]), 1, MANY),
            "rows [gap, h], linear between, constant before the first and 0 beyond the last",
        ),
        key("power", Shape::Table(&POWER), POWER.doc),
        key("gas", Shape::Table(&GAS), GAS.doc),
        key(
            "radiation",
            Shape::Row("[emissivity, emissivity]", &[EMISSIVITY, EMISSIVITY]),
            "between parallel grey surfaces with these emissivities, with the [constants] of the case",
        ),
    ],
    rules: &[Rule::AtLeastOne(&[
        "constant",
        "over_pressure",
        "over_gap",
        "power",
        "gas",
        "radiation",
    ])],
};

const EMISSIVITY: Shape = Shape::Number(Bounds {
    above: Some(0.0),
    to: Some(1.0),
    ..FREE
});

static POWER: Table = Table {
    heading: "power",
    doc: "h0 (pressure/hardness)^n",
    keys: &[
        key("h0", POSITIVE, "h where the pressure is the hardness").required(),
        key("hardness", POSITIVE, "a pressure")
            .required()
            .hints(&["at"]),
        key(
            "n",
            POSITIVE,
            "the exponent; 0.95 after Cooper, Mikic and Yovanovich",
        )
        .or(Default::Number(0.95)),
    ],
    rules: &[],
};

static GAS: Table = Table {
    heading: "gas",
    doc: "k/(gap + jump), of a gas or a fluid between the sides",
    keys: &[
        key("k", POSITIVE, "its conductivity").required(),
        key("jump", POSITIVE, "a length that is added to the gap")
            .required()
            .hints(&["g0"]),
    ],
    rules: &[],
};

static FRICTION_HEAT: Table = Table {
    heading: "friction_heat",
    doc: "what becomes of the work of friction",
    keys: &[
        key(
            "fraction",
            Shape::Number(Bounds {
                from: Some(0.0),
                to: Some(1.0),
                ..FREE
            }),
            "the part of it that becomes heat",
        )
        .or(Default::Number(1.0)),
        key(
            "to_secondary",
            Shape::Number(Bounds {
                from: Some(0.0),
                to: Some(1.0),
                ..FREE
            }),
            "the part of that which the secondary side takes",
        )
        .or(Default::Number(0.5)),
    ],
    rules: &[],
};

static GASKET: Table = Table {
    heading: "gasket",
    doc: "a gasket between the sides, in the place of `enforcement`: pressure against closure, the way by which a gap has closed",
    keys: &[
        key(
            "loading",
            CLOSURES,
            "rows [closure, pressure] of closing further than ever; it begins at pressure 0 and goes on with its last slope",
        )
        .required(),
        key(
            "unloading",
            Shape::Tables(&UNLOADING),
            "curves of opening, by the closures that they begin at; absent: it opens as it closes",
        )
        .hints(&["opening"]),
        key(
            "onset",
            POSITIVE,
            "the closure up to which it opens as it closes; absent: where the slope of `loading` has fallen by a tenth of its steepest",
        )
        .hints(&["yield"]),
        key(
            "tension",
            NOT_NEGATIVE,
            "how stiff it is in being opened further than to pressure 0, over its first stiffness",
        )
        .or(Default::Number(0.0)),
    ],
    rules: &[Rule::Needs("onset", "unloading")],
};

static UNLOADING: Table = Table {
    heading: "unloading",
    doc: "how it opens from a closure",
    keys: &[
        key("from", POSITIVE, "the largest closure so far").required(),
        key(
            "curve",
            CLOSURES,
            "rows [closure, pressure], from the closure that stays at pressure 0 to `from`, on `loading`",
        )
        .required(),
    ],
    rules: &[],
};
const CLOSURES: Shape = Shape::List(
    &Shape::Row("[closure, pressure]", &[ANY, NOT_NEGATIVE]),
    2,
    MANY,
);

static FLUID: Table = Table {
    heading: "fluid",
    doc: "a fluid that comes between the sides from their rim, and presses them apart where it is",
    keys: &[
        key(
            "pressure",
            NOT_NEGATIVE,
            "its pressure at the end of the first step, reached linearly; it stays, unless a [[step.contact]] has another `fluid`",
        )
        .required(),
        key("from", Shape::Text, "nodes of either side where it is from the start").required(),
        key(
            "critical",
            Shape::Either(&[NOT_NEGATIVE, Shape::Choice(&[word("fluid")])]),
            "the contact pressure up to which it enters: a number, 0 where contact is lost; \"fluid\": its own pressure",
        )
        .or(Default::Number(0.0)),
        key(
            "ramp",
            NOT_NEGATIVE,
            "the part of the step in which its pressure grows on points that it has just reached",
        )
        .or(Default::Number(0.001)),
        key(
            "recede",
            Shape::Flag,
            "whether points dry after an increment at whose end they are pressed by 1.05 times `critical`, or more",
        )
        .or(Default::Flag(true)),
    ],
    rules: &[],
};

static DAMPING: Table = Table {
    heading: "damping",
    doc: "what damps closed points in dynamic steps",
    keys: &[
        key(
            "normal",
            NOT_NEGATIVE,
            "pressure over the velocity of the gap, or force where the law gives forces",
        )
        .or(Default::Number(0.0)),
        key(
            "tangential",
            NOT_NEGATIVE,
            "the same over the velocity of slip, with friction and without",
        )
        .or(Default::Number(0.0)),
        key(
            "pulls",
            Shape::Flag,
            "whether points that open may be held back by more than presses them; else they are free from then on",
        )
        .or(Default::Flag(false)),
    ],
    rules: &[],
};

static WEAR: Table = Table {
    heading: "wear",
    doc: "material that sliding takes off the sides: a depth in proportion to pressure and way, in static steps",
    keys: &[
        key(
            "coefficient",
            POSITIVE,
            "depth per way and pressure (1/pressure)",
        )
        .hints(&["rate"]),
        key("k", POSITIVE, "the same times the hardness"),
        key("hardness", POSITIVE, "with `k` (pressure)"),
        key(
            "of",
            Shape::Choice(&[word("secondary"), word("primary")]),
            "the side whose coefficient that is",
        )
        .or(Default::Text("secondary")),
        key(
            "primary",
            POSITIVE,
            "the coefficient of the primary side, in addition to that of the secondary one",
        ),
        key(
            "limit",
            POSITIVE,
            "depth over the size of the facets beyond which a warning says so: nodes stay where they are",
        )
        .or(Default::Number(0.05)),
    ],
    rules: &[
        Rule::ExactlyOne(&["coefficient", "k"]),
        Rule::Needs("k", "hardness"),
        Rule::Needs("hardness", "k"),
    ],
};

static RULE: Table = Table {
    heading: "rule",
    doc: "points of gauss-point, along each direction of a facet",
    keys: &[
        key(
            "kind",
            Shape::Choice(&[word("gauss"), word("lobatto")]),
            "points inside, or with the ends",
        )
        .or(Default::Text("gauss")),
        key(
            "points",
            Shape::Either(&[AUTO, Shape::Integer(1, 32)]),
            "how many; auto: one more than the degree of the facet",
        )
        .or(Default::Text("auto")),
        key(
            "cut",
            Shape::Flag,
            "whether facets are cut where facets of the other side end; what both share has points of its own; with \
             sliding = \"increment\" in every increment, else at the start",
        )
        .or(Default::Flag(false)),
    ],
    rules: &[],
};

pub(super) static ENFORCEMENT: Table = Table {
    heading: "enforcement",
    doc: "how penetration is prevented",
    keys: &[
        key(
            "penalty",
            Shape::Either(&[AUTO, POSITIVE, PRESSURES]),
            "force or pressure per penetration, or rows [gap, pressure]",
        )
        .or(Default::Text("auto"))
        .hints(&["stiffness", "epsilon"]),
        key("lagrange", Shape::Table(&LAGRANGE), LAGRANGE.doc).hints(&["multipliers"]),
        key(
            "augmented",
            Shape::Choice(&[word("uzawa"), word("newton")]),
            "multipliers in addition to a penalty, updated between solutions or solved for with them",
        ),
        key(
            "per",
            Shape::Choice(&[word("node"), word("area")]),
            "a force per node, or a pressure; absent: by what the secondary side is",
        ),
        key(
            "gap_tol",
            Shape::Either(&[
                AUTO,
                Shape::Later(
                    &POSITIVE,
                    "newton = { gap_tol = .. }  in [solver], for all contacts",
                ),
            ]),
            "largest penetration of `augmented`; auto: that of [solver] newton",
        )
        .or(Default::Text("auto")),
    ],
    rules: &[
        Rule::AtMostOne(&["lagrange", "augmented", LAWS]),
        Rule::AtMostOne(&["penalty", LAWS]),
        Rule::AtMostOne(&["penalty", "lagrange"]),
        Rule::AtMostOne(&["lagrange", "per"]),
        Rule::Needs("gap_tol", "augmented"),
    ],
};
const PRESSURES: Shape = Shape::List(
    &Shape::Row("[gap, pressure]", &[ANY, NOT_NEGATIVE]),
    2,
    MANY,
);

static LAGRANGE: Table = Table {
    heading: "lagrange",
    doc: "no penetration at all, by multipliers: {}",
    keys: &[],
    rules: &[],
};

pub(super) static FRICTION: Table = Table {
    heading: "friction",
    doc: "what limits friction, and what sticking yields",
    keys: &[
        key(
            "elastic_slip",
            POSITIVE,
            "how far points move before they slip (length)",
        ),
        key("stiffness", POSITIVE, "shear traction per elastic slip").hints(&["penalty"]),
    ],
    rules: &[Rule::AtMostOne(&["elastic_slip", "stiffness"])],
};

static TIED: Table = Table {
    heading: "tied",
    doc: "sides that are joined",
    keys: &[
        key(
            "offset",
            Shape::Choice(&[word("keep"), word("close"), word("pull")]),
            "whether distances at the start stay, are closed without strain, or pull, overlaps over the first step",
        )
        .or(Default::Text("keep")),
        key(
            "within",
            POSITIVE,
            "points further away are not joined (length); absent: all within reach",
        ),
        key(
            "penalty_tangential",
            NOT_NEGATIVE,
            "traction per way apart within the tangent plane, with a penalty at points; absent: as along the normal",
        ),
    ],
    rules: &[],
};

static ADHESION: Table = Table {
    heading: "adhesion",
    doc: "a pull between sides that are near, in place of `enforcement`: { work, range, shape }",
    keys: &[
        key("work", POSITIVE, "work of adhesion, per area (force per length)").required(),
        key(
            "range",
            POSITIVE,
            "of \"dugdale\" the gap up to which it pulls, of \"lennard-jones\" the distance of atoms that touch (length)",
        )
        .required(),
        key(
            "shape",
            Shape::Choice(&[word("dugdale"), word("lennard-jones")]),
            "dugdale: the same tension up to the range; lennard-jones: as between half-spaces of atoms",
        )
        .or(Default::Text("dugdale")),
    ],
    rules: &[],
};

static COHESIVE: Table = Table {
    heading: "cohesive",
    doc: "with `tied`: how the joint breaks",
    keys: &[
        key(
            "strength",
            Shape::Row("[opening, shear]", &[POSITIVE, POSITIVE]),
            "the largest tractions along the normal and across it",
        )
        .required(),
        key(
            "toughness",
            Shape::Row("[opening, shear]", &[POSITIVE, POSITIVE]),
            "the energies per area that opening and shear take (force per length)",
        )
        .required()
        .hints(&["energy", "fracture_energy"]),
        key("mixity", Shape::Table(&MIXITY), MIXITY.doc).hints(&["mixed_mode"]),
        key(
            "initiation",
            Shape::Choice(&[word("mixity"), word("quadratic")]),
            "where damage begins between opening and shear: interpolated as the toughness is by `bk`, or where the squares of \
             tractions over strengths add up to 1, as by `power`",
        )
        .or(Default::Text("mixity")),
        key(
            "softening",
            Shape::Choice(&[word("bilinear"), word("exponential")]),
            "bilinear: elastic up to the strength, then linear; exponential: curved from the start, with one toughness",
        )
        .or(Default::Text("bilinear")),
        key(
            "stiffness",
            Shape::Either(&[
                AUTO,
                POSITIVE,
                Shape::Row("[opening, shear]", &[POSITIVE, POSITIVE]),
            ]),
            "traction per opening before damage begins, of both directions or of each; auto: as stiff as contact, and no less \
             than ten times what breaks at once",
        )
        .or(Default::Text("auto")),
        key(
            "viscosity",
            NOT_NEGATIVE,
            "time by which damage is delayed, for the sake of convergence; its work is reported",
        )
        .or(Default::Number(0.0)),
    ],
    rules: &[],
};

static MIXITY: Table = Table {
    heading: "mixity",
    doc: "the toughness between opening and shear: { bk = exponent } of Benzeggagh and Kenane, or { power = exponent }",
    keys: &[
        key(
            "bk",
            POSITIVE,
            "exponent of the share of shear in the energy",
        ),
        key(
            "power",
            POSITIVE,
            "exponent of the ratios of energies and toughnesses",
        ),
    ],
    rules: &[Rule::AtMostOne(&["bk", "power"])],
};

static START: Table = Table {
    heading: "start",
    doc: "what is done about gaps and overlaps at the start",
    keys: &[
        key(
            "close_gaps_below",
            NOT_NEGATIVE,
            "gaps and overlaps up to this are removed by moving nodes, without strain",
        )
        .or(Default::Number(0.0))
        .hints(&["adjust", "close_gaps"]),
        key(
            "close_gaps_of",
            Shape::Text,
            "gaps and overlaps of the nodes of this set are removed likewise, whatever their size",
        ),
        key(
            "clearance",
            Shape::Either(&[Shape::Choice(&[word("measured")]), ANY]),
            "gaps are taken to be this, whatever the mesh says; negative: overlaps",
        )
        .or(Default::Text("measured")),
        key(
            "interference",
            Shape::Choice(&[
                word("step"),
                word("increment"),
                word("increments"),
                word("now"),
                word("strain-free"),
            ]),
            "step: overlaps are resolved over the first step; increment: over its first two increments; increments: over \
             what is left of it, as each increment finds them; now: at once; strain-free: they stay, without pressure",
        )
        .or(Default::Text("step"))
        .hints(&["overlap", "shrink"]),
        key(
            "facets",
            Shape::Choice(&[word("bent"), word("straight")]),
            "gaps of surfaces that conform are measured between the curved surfaces that facets of linear elements were \
             cut from, or between the facets",
        )
        .or(Default::Text("bent"))
        .hints(&["chord", "faceted"]),
    ],
    rules: &[],
};

pub(super) static CONTACT_CHANGE: Table = Table {
    heading: "[[step.contact]]",
    doc: "changes of contacts, from this step on",
    keys: &[
        key("name", Shape::Text, "the contact").required(),
        key("active", Shape::Flag, "whether it acts"),
        FRICTION_KEY,
        key(
            "fluid",
            NOT_NEGATIVE,
            "the pressure of its fluid at the end of the step, reached linearly",
        ),
        key(
            "slip",
            NOT_NEGATIVE,
            "how far the sides slide for wear in each step, out of the plane or round (length); absent: as they move",
        ),
    ],
    rules: &[Rule::AtLeastOne(&["active", "friction", "fluid", "slip"])],
};
