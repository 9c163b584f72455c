//! Materials, bodies, springs, constraints.

use super::geometry::{AXES_RULES, OF_AXES};
use super::*;
use crate::case::parts::Shell;

pub(super) static MATERIAL: Table = Table {
    heading: "[material.NAME]",
    doc: "materials",
    keys: &[
        key(
            "model",
            Shape::Choice(&[]),
            "the law; absent: of bodies that conduct heat and never deform",
        )
        .hints(&["law", "type"]),
        key("density", POSITIVE, "mass per volume").hints(&["rho"]),
        key("damping", Shape::Table(&DAMPING), DAMPING.doc),
        key("expansion", Shape::Table(&EXPANSION), EXPANSION.doc).hints(&["thermal_expansion"]),
        key(
            "conductivity",
            Shape::Either(&[
                POSITIVE,
                Shape::List(&Shape::Row("[temperature, k]", &[ANY, POSITIVE]), 1, MANY),
                Shape::Table(&CONDUCTIVITY),
            ]),
            "heat per time, length and temperature; or rows [temperature, k], linear between, constant outside; or by direction",
        )
        .hints(&["k", "thermal_conductivity"]),
        key(
            "specific_heat",
            Shape::Either(&[
                POSITIVE,
                Shape::List(&Shape::Row("[temperature, c]", &[ANY, POSITIVE]), 1, MANY),
            ]),
            "heat per mass and temperature; or rows [temperature, c], linear between, constant outside; next to a density",
        )
        .hints(&["heat_capacity"]),
        key(
            "latent_heat",
            Shape::List(
                &Shape::Row("[heat, solidus, liquidus]", &[POSITIVE, ANY, ANY]),
                1,
                MANY,
            ),
            "rows [heat per mass, solidus, liquidus] of changes of phase",
        ),
        key("plasticity", Shape::Table(&PLASTICITY), PLASTICITY.doc).hints(&[
            "plastic",
            "yield",
            "hardening",
        ]),
    ],
    rules: &[],
};
static DAMPING: Table = Table {
    heading: "damping",
    doc: "viscous forces in dynamic steps",
    keys: &[
        key(
            "mass",
            NOT_NEGATIVE,
            "force over mass and velocity (1/time); motions of the body as a whole are slowed, too",
        )
        .or(Default::Number(0.0))
        .hints(&["alpha"]),
        key(
            "stiffness",
            NOT_NEGATIVE,
            "stress over the initial stiffness and the rate of strain (time)",
        )
        .or(Default::Number(0.0))
        .hints(&["beta"]),
    ],
    rules: &[],
};
pub(super) static CONDUCTIVITY: Table = Table {
    heading: "conductivity",
    doc: "conductivity by direction, along the axes of the material",
    keys: &[
        key(
            "along",
            Shape::Row("[k1, k2, k3]", &[POSITIVE, POSITIVE, POSITIVE]),
            "along the three axes",
        ),
        key(
            "rows",
            Shape::List(
                &Shape::Row(
                    "[temperature, k11, k22, k33, k12, k23, k13]",
                    &[ANY, POSITIVE, POSITIVE, POSITIVE, ANY, ANY, ANY],
                ),
                1,
                MANY,
            ),
            "rows [temperature, k11, k22, k33, k12, k23, k13]",
        ),
    ],
    rules: &[Rule::ExactlyOne(&["along", "rows"])],
};
static EXPANSION: Table = Table {
    heading: "expansion",
    doc: "thermal expansion: strain alpha (T - reference), counted from the temperature `free` on",
    keys: &[
        key(
            "alpha",
            Shape::Either(&[
                ANY,
                Shape::List(&Shape::Row("[temperature, alpha]", &[ANY, ANY]), 1, MANY),
            ]),
            "strain per temperature; or rows [temperature, alpha], linear between, constant outside",
        )
        .required(),
        key("reference", ANY, "the temperature from which alpha counts").or(Default::Number(0.0)),
        key(
            "free",
            Shape::Either(&[ANY, Shape::Choice(&[word("start")])]),
            "the temperature without thermal strain; start: what each place is at at the start; absent: the reference",
        ),
    ],
    rules: &[],
};

static PLASTICITY: Table = Table {
    heading: "plasticity",
    doc: "yielding after von Mises, of linear-elastic",
    keys: &[
        key(
            "hardening",
            Shape::Choice(&[word("isotropic"), word("kinematic"), word("combined")]),
            "whether the yield surface grows, moves, or both",
        )
        .or(Default::Text("isotropic")),
        key(
            "table",
            Shape::List(
                &Shape::Row("[stress, plastic strain]", &[POSITIVE, NOT_NEGATIVE]),
                1,
                MANY,
            ),
            "rows [true yield stress, equivalent plastic strain], from strain 0 on",
        )
        .required(),
        key(
            "modulus",
            NOT_NEGATIVE,
            "kinematic hardening modulus of combined hardening (stress)",
        ),
    ],
    rules: &[],
};

pub(super) static BODY: Table = Table {
    heading: "[[body]]",
    doc: "groups of elements that are solids, shells (of elements of the plane, in space), bars (of line elements) or rigid tools",
    keys: &[
        key("group", NAMES, "the mesh group, or a list of them")
            .required()
            .hints(&["groups", "name"]),
        key(
            "material",
            Shape::Text,
            "its material; a rigid body has the density of it, and no other property",
        ),
        key(
            "integration",
            Shape::Choice(&[word("full"), word("reduced"), word("raised")]),
            "quadrature points of an element; reduced: one order less, of quadratic elements; raised: nine of wedge6",
        )
        .or(Default::Text("full")),
        key(
            "locking",
            Shape::Choice(&[
                word("auto"),
                word("none"),
                word("b-bar"),
                word("f-bar"),
                word("incompatible"),
                word("selective-shear"),
            ]),
            "what is done against locking",
        )
        .or(Default::Text("auto")),
        key(
            "orientation",
            Shape::Either(&[Shape::Text, Shape::Table(&ORIENTATION)]),
            "axes of the material: those of an [orientation], or { x, y }; absent: those of the frame",
        ),
        key(
            "space",
            Shape::Choice(geometry::PLANES),
            "what the plane of this body stands for; absent: what that of the model does",
        ),
        key(
            "thickness",
            Shape::Either(&[POSITIVE, Shape::Choice(&[word("field")])]),
            "thickness in a plane model (length), or field: that of [[thickness]] at its nodes; next to bodies of revolution, that of the full circumference; absent: that of the model",
        ),
        key("shell", Shape::Table(&SHELL), SHELL.doc).hints(&["shell_section", "sheet"]),
        key(
            "temperatures",
            Shape::Choice(&[word("full"), word("linear")]),
            "how temperatures vary in an element; linear, as strains do: of quad8 and hex20 with full integration",
        )
        .or(Default::Text("full")),
        key(
            "at_nodes",
            Shape::Choice(&[word("linear"), word("element")]),
            "how stresses at points are carried to nodes: by the closest linear field, or that of the element's own shape \
             functions, where it has as many points: quad8, quad9, hex20 and hex27 with full integration",
        )
        .or(Default::Text("linear")),
        key(
            "area",
            NOT_NEGATIVE,
            "cross-section of bars (area); those of none carry no force",
        )
        .hints(&["section"]),
        key(
            "strain",
            Shape::Choice(&[word("auto"), word("small")]),
            "of bars: as large as their step has them, or small in all steps",
        )
        .or(Default::Text("auto")),
        key(
            "mass_matrix",
            Shape::Choice(&[word("auto"), word("consistent"), word("lumped")]),
            "where its mass is in dynamic steps: between the nodes of elements, or at these; auto: consistent",
        )
        .or(Default::Text("auto")),
        key(
            "capacity",
            Shape::Choice(&[word("consistent"), word("lumped")]),
            "where it stores heat: between the nodes of elements, or at these, which hardly overshoots",
        )
        .or(Default::Text("consistent")),
        key("rigid", Shape::Flag, "whether it moves as a whole").or(Default::Flag(false)),
        key(
            "reference",
            Shape::Text,
            "the [reference] a rigid body moves with; absent: the mean of its nodes",
        ),
    ],
    rules: &[],
};

static SHELL: Table = Table {
    heading: "shell",
    doc: "a shell of elements tri3, tri6, quad4 or quad8 in space, which become solids of this thickness: from the negative side, S1, \
          to the positive one, S2, from which the nodes of an element run counter-clockwise",
    keys: &[
        key(
            "thickness",
            Shape::Either(&[POSITIVE, Shape::Choice(&[word("field")])]),
            "thickness (length), or field: that of [[thickness]] at its nodes",
        )
        .required()
        .hints(&["t"]),
        key(
            "offset",
            ANY,
            "distance of the nodes from the middle surface, in thicknesses; positive towards the positive side: with 0.5 they lie on it",
        )
        .or(Default::Number(0.0)),
        key(
            "normals",
            Shape::Number(Bounds {
                from: Some(0.0),
                to: Some(180.0),
                ..FREE
            }),
            "the angle (degrees) up to which elements at a node share their normal; beyond it they meet at an edge",
        )
        .or(Default::Number(Shell::NORMALS))
        .hints(&["angle"]),
        key(
            "points",
            Shape::Integer(2, 9),
            "integration points through the thickness; take 5 of materials that yield",
        )
        .or(Default::Integer(Shell::POINTS as i64))
        .hints(&["integration_points"]),
    ],
    rules: &[],
};

pub(super) static NAMED_ORIENTATION: Table = Table {
    heading: "[orientation.NAME]",
    doc: "axes of materials, of the undeformed body, that bodies name",
    keys: &[
        key(
            "kind",
            Shape::Choice(&[word("rectangular"), word("cylindrical"), word("elements")]),
            "the same everywhere; radial, circumferential and along an axis at every integration point; or by element",
        )
        .or(Default::Text("rectangular")),
        key("x", VECTOR, "along the first axis; of elements without a row"),
        key(
            "y",
            VECTOR,
            "with x, spans the plane of the first two axes; of elements without a row",
        ),
        key("origin", VECTOR, "a point of the axis of a cylindrical one; absent: the origin").hints(&["from"]),
        key("axis", LINE, "the axis of a cylindrical one: \"x\", \"y\", \"z\" or a vector").hints(&["direction"]),
        key(
            "rows",
            Shape::List(&Shape::Row("[element, x, y]", &[ID, VECTOR, VECTOR]), 1, MANY),
            "rows [element, x, y] of elements with axes of their own",
        ),
        key(
            "turn",
            Shape::Row("[axis, degrees]", &[Shape::Integer(1, 3), ANY]),
            "turns all axes about one of themselves, 1, 2 or 3, counter-clockwise as seen from its tip",
        ),
    ],
    rules: &[Rule::Needs("x", "y"), Rule::Needs("y", "x")],
};

static ORIENTATION: Table = Table {
    heading: "orientation",
    doc: "axes of the material, the same everywhere",
    keys: &[
        key("x", VECTOR, "along the first axis").required(),
        key("y", VECTOR, "with x, spans the plane of the first two axes").required(),
    ],
    rules: &[],
};

pub(super) static SPRING: Table = Table {
    heading: "[[spring]]",
    doc: "springs between nodes, or to the ground",
    keys: &[
        key("name", Shape::Text, "its name, in messages").required(),
        key(
            "between",
            Shape::List(&Shape::Text, 2, 2),
            "two sets of as many nodes, paired in their order",
        )
        .hints(&["ends", "nodes"]),
        key("on", Shape::Text, "a set of nodes tied to the ground").hints(&["set"]),
        key("stiffness", POSITIVE, "force over elongation, of each spring").hints(&["k"]),
        key(
            "table",
            Shape::List(&Shape::Row("[force, elongation]", &[ANY, ANY]), 1, MANY),
            "rows [force, elongation], linear between, constant outside",
        ),
        key(
            "direction",
            LINE,
            "\"x\", \"y\", \"z\" or a vector; absent: along the line between its ends, which turns with them",
        )
        .hints(&["axis"]),
    ],
    rules: &[
        Rule::ExactlyOne(&["between", "on"]),
        Rule::ExactlyOne(&["stiffness", "table"]),
    ],
};

pub(super) static CONSTRAINT: Table = Table {
    heading: "[[constraint]]",
    doc: "constraints between displacements, for the whole run",
    keys: &[
        key(
            "equation",
            Shape::List(
                &Shape::Row("[set, direction, coefficient]", &[Shape::Text, COMPONENT, ANY]),
                1,
                MANY,
            ),
            "rows [set or reference, direction, coefficient]; their sum is `rhs`, node by node of sets of several",
        )
        .hints(&["terms"]),
        key("rhs", ANY, "the right-hand side, reached linearly over the first step")
            .or(Default::Number(0.0)),
        key(
            "kind",
            Shape::Choice(&[
                word("kinematic"),
                word("distributing"),
                word("plane"),
                word("line"),
                word("equal"),
                word("distance"),
                word("twist"),
                word("pretension"),
                word("cyclic"),
            ]),
            "kinematic: nodes follow the reference; distributing: the reference follows their mean; \
             plane, line: nodes stay in a plane, on a line; equal: nodes move alike; distance: two nodes keep theirs; \
             twist: x of the reference is the angle (radian) by which nodes turn in the mean; \
             pretension: faces are cut apart, x of the reference is by how much their sides overlap; \
             cyclic: nodes move as those of the other side of a sector do",
        )
        .hints(&["type"]),
        key("on", Shape::Text, "the nodes; of pretension the faces, of the side that the normal points away from")
            .hints(&["set", "group", "surface"]),
        key(
            "reference",
            Shape::Text,
            "the reference, of kinematic, distributing, twist and pretension",
        ),
        key(
            "dofs",
            Shape::Either(&[
                Shape::Choice(&[word("all")]),
                Shape::List(&COMPONENT, 1, 6),
            ]),
            "the directions, of kinematic and equal: \"all\" or a list of \"x\", \"y\", \"z\"",
        ),
        key("local", Shape::Table(&LOCAL), LOCAL.doc).hints(&["axes", "orientation"]),
        key(
            "most",
            POSITIVE,
            "how far apart the two nodes of distance may go; absent: they keep their distance",
        ),
        key(
            "normal",
            LINE,
            "along which the sides of pretension overlap; absent: the mean normal of its faces",
        ),
        key("with", Shape::Text, "the nodes of the other side, of cyclic"),
        key("sectors", COUNT, "how many sectors make the whole, of cyclic"),
        key("point", VECTOR, "a point of the axis of cyclic; absent: the origin"),
        key("axis", LINE, "the direction of the axis of twist and cyclic; absent: \"z\""),
    ],
    rules: &[
        Rule::ExactlyOne(&["equation", "kind"]),
        Rule::Needs("rhs", "equation"),
        Rule::Needs("kind", "on"),
        Rule::Needs("on", "kind"),
        Rule::Needs("reference", "kind"),
        Rule::Needs("dofs", "kind"),
        Rule::Needs("local", "dofs"),
        Rule::Needs("most", "kind"),
        Rule::Needs("normal", "kind"),
        Rule::Needs("with", "kind"),
        Rule::Needs("sectors", "kind"),
        Rule::Needs("point", "kind"),
        Rule::Needs("axis", "kind"),
    ],
};
static LOCAL: Table = Table {
    heading: "[constraint.local]",
    doc: "axes that the directions of kinematic are along, x first, at the place of each node: two vectors, or a cylindrical system",
    keys: &OF_AXES,
    rules: AXES_RULES,
};

/// Displacements along, and rotations about the axes.
const COMPONENT: Shape = Shape::Choice(&[
    word("x"),
    word("y"),
    word("z"),
    word("rx"),
    word("ry"),
    word("rz"),
]);

pub(super) static MASS: Table = Table {
    heading: "[[mass]]",
    doc: "masses at nodes, of references and rigid bodies, in dynamic steps, natural modes and by gravity; masses of one node or \
          reference add up",
    keys: &[
        key("on", Shape::Text, "the set, group, reference or rigid body")
            .required()
            .hints(&["set", "group", "nodes", "reference"]),
        key(
            "value",
            POSITIVE,
            "the mass: at each node of a set, or of the reference",
        )
        .required()
        .hints(&["mass"]),
        key(
            "centroid",
            VECTOR,
            "centroid of the mass of a reference at the start; absent: at the reference",
        )
        .hints(&["at", "center"]),
        key(
            "inertia",
            Shape::Either(&[POSITIVE, Shape::List(&ANY, 3, 6)]),
            "moments of inertia of the mass of a reference about its centroid (mass length²), [xx, yy, zz] or [xx, yy, zz, xy, xz, yz] \
             with the signs of a matrix; a number in the plane",
        ),
    ],
    rules: &[],
};
