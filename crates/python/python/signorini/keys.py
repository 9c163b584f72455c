"""Every key of a case as an attribute: one class for each table.

Written by `cargo xtask keys` from `signorini schema`; `cargo xtask docs` fails where the two differ.
"""

# ruff: noqa: E501
# pyright: reportIncompatibleVariableOverride=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from ._table import Items, Key, MaterialTable, Mixed, Named, One, Shape, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .physics import ContactLaw, Course, FrictionLimit, Projection, SignedDistance


class Amplitude(Table):
    """Functions of time: linear between rows and constant outside, or of the program.

    TOML: `amplitude`.
    """

    _toml = "amplitude"
    own: Key[str | None, str | Course] = Key(
        "A function of time of the program that runs the case, by its name there",
        "text",
    )
    table: Key[list[list[float]] | None, Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [time, value]; times increase",
        "list of list of number, 2 of them",
    )
    time: Key[Literal["step", "total"], Literal["step", "total"]] = Key(
        "Time of the step, or of the whole run",
        "`\"step\"`, `\"total\"`",
        default="step",
    )


class Axes(Table):
    """Local axes of nodes, that  local = true  of [[step.print]] prints along; the last that names a node holds.

    TOML: `axes`.
    """

    _toml = "axes"
    from_: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A point of the axis of a cylindrical system: radial, circumferential, along the axis",
        "list of number",
        key="from",
    )
    set: Key[str | None, str] = Key("The set or group of nodes", "text")
    to: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Another one", "list of number")
    x: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A vector along the first axis, the same everywhere",
        "list of number",
    )
    xy: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A vector in the plane of the first and the second",
        "list of number",
    )


class BodyOrientation(Table):
    """Axes of the material, the same everywhere.

    TOML: `body.orientation`.
    """

    _toml = "body.orientation"
    x: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Along the first axis", "list of number")
    y: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "With x, spans the plane of the first two axes",
        "list of number",
    )


class BodyShell(Table):
    """A shell of elements tri3, tri6, quad4 or quad8 in space, which become solids of this thickness: from the negative side, S1, to the positive one, S2, from which the nodes of an element run counter-clockwise.

    TOML: `body.shell`.
    """

    _toml = "body.shell"
    normals: Key[float, float] = Key(
        "The angle (degrees) up to which elements at a node share their normal; beyond it they meet at an edge",
        "number ≥ 0.0, ≤ 180.0",
        default=20.0,
    )
    offset: Key[float, float] = Key(
        "Distance of the nodes from the middle surface, in thicknesses; positive towards the positive side: with 0.5 they lie on it",
        "number",
        default=0.0,
    )
    points: Key[int, int] = Key(
        "Integration points through the thickness; take 5 of materials that yield",
        "whole number ≥ 2, ≤ 9",
        default=2,
    )
    thickness: Key[float | Literal["field"] | None, float | Literal["field"]] = Key(
        "Thickness (length), or field: that of [[thickness]] at its nodes",
        "number > 0.0 or `\"field\"`",
    )


class Body(Table):
    """Groups of elements that are solids, shells (of elements of the plane, in space), bars (of line elements) or rigid tools.

    TOML: `body`.
    """

    _toml = "body"
    area: Key[float | None, float] = Key("Cross-section of bars (area); those of none carry no force", "number ≥ 0.0")
    at_nodes: Key[Literal["linear", "element"], Literal["linear", "element"]] = Key(
        "How stresses at points are carried to nodes: by the closest linear field, or that of the element's own shape functions, where it has as many points: quad8, quad9, hex20 and hex27 with full integration",
        "`\"linear\"`, `\"element\"`",
        default="linear",
    )
    capacity: Key[Literal["consistent", "lumped"], Literal["consistent", "lumped"]] = Key(
        "Where it stores heat: between the nodes of elements, or at these, which hardly overshoots",
        "`\"consistent\"`, `\"lumped\"`",
        default="consistent",
    )
    group: Key[str | list[str] | None, str | Sequence[str]] = Key(
        "The mesh group, or a list of them",
        "text or list of text",
    )
    integration: Key[Literal["full", "reduced", "raised"], Literal["full", "reduced", "raised"]] = Key(
        "Quadrature points of an element; reduced: one order less, of quadratic elements; raised: nine of wedge6",
        "`\"full\"`, `\"reduced\"`, `\"raised\"`",
        default="full",
    )
    locking: Key[Literal["auto", "none", "b-bar", "f-bar", "incompatible", "selective-shear"], Literal["auto", "none", "b-bar", "f-bar", "incompatible", "selective-shear"]] = Key(
        "What is done against locking",
        "`\"auto\"`, `\"none\"`, `\"b-bar\"`, `\"f-bar\"`, `\"incompatible\"`, `\"selective-shear\"`",
        default="auto",
    )
    mass_matrix: Key[Literal["auto", "consistent", "lumped"], Literal["auto", "consistent", "lumped"]] = Key(
        "Where its mass is in dynamic steps: between the nodes of elements, or at these; auto: consistent",
        "`\"auto\"`, `\"consistent\"`, `\"lumped\"`",
        default="auto",
    )
    material: Key[str | None, str] = Key(
        "Its material; a rigid body has the density of it, and no other property",
        "text",
    )
    orientation: Mixed[BodyOrientation] = Mixed(
        BodyOrientation,
        "Axes of the material: those of an [orientation], or { x, y }; absent: those of the frame",
        "text or a table",
    )
    reference: Key[str | None, str] = Key(
        "The [reference] a rigid body moves with; absent: the mean of its nodes",
        "text",
    )
    rigid: Key[bool, bool] = Key("Whether it moves as a whole", "`true` or `false`", default=False)
    shell: One[BodyShell] = One(
        BodyShell,
        "A shell of elements tri3, tri6, quad4 or quad8 in space, which become solids of this thickness: from the negative side, S1, to the positive one, S2, from which the nodes of an element run counter-clockwise",
        "a table",
    )
    space: Key[Literal["plane-strain", "plane-stress", "axisymmetric"] | None, Literal["plane-strain", "plane-stress", "axisymmetric"]] = Key(
        "What the plane of this body stands for; absent: what that of the model does",
        "`\"plane-strain\"`, `\"plane-stress\"`, `\"axisymmetric\"`",
    )
    strain: Key[Literal["auto", "small"], Literal["auto", "small"]] = Key(
        "Of bars: as large as their step has them, or small in all steps",
        "`\"auto\"`, `\"small\"`",
        default="auto",
    )
    temperatures: Key[Literal["full", "linear"], Literal["full", "linear"]] = Key(
        "How temperatures vary in an element; linear, as strains do: of quad8 and hex20 with full integration",
        "`\"full\"`, `\"linear\"`",
        default="full",
    )
    thickness: Key[float | Literal["field"] | None, float | Literal["field"]] = Key(
        "Thickness in a plane model (length), or field: that of [[thickness]] at its nodes; next to bodies of revolution, that of the full circumference; absent: that of the model",
        "number > 0.0 or `\"field\"`",
    )


class CheckpointEvery(Table):
    """How often; absent: { increments = 5, wall = "10 min" }.

    TOML: `checkpoint.every`.
    """

    _toml = "checkpoint.every"
    increments: Key[int | None, int] = Key("After so many increments", "whole number ≥ 1, ≤ 1000000000")
    wall: Key[str | None, str] = Key("After so much time on the clock, as in \"10 min\"", "text")


class Checkpoint(Table):
    """When a run can be resumed from.

    TOML: `checkpoint`.
    """

    _toml = "checkpoint"
    every: One[CheckpointEvery] = One(
        CheckpointEvery,
        "How often; absent: { increments = 5, wall = \"10 min\" }",
        "a table",
    )
    keep: Key[int, int] = Key(
        "How many are kept, in files that take turns; at least two",
        "whole number ≥ 1, ≤ 26",
        default=2,
    )


class Constants(Table):
    """Constants of nature, in the units of the case: radiation needs them.

    TOML: `constants`.
    """

    _toml = "constants"
    absolute_zero: Key[float | None, float] = Key("Absolute zero, on the scale of temperatures", "number")
    stefan_boltzmann: Key[float | None, float] = Key(
        "Heat per time and area of a black surface over its absolute temperature to the fourth power",
        "number > 0.0",
    )


class ConstraintLocal(Table):
    """Axes that the directions of kinematic are along, x first, at the place of each node: two vectors, or a cylindrical system.

    TOML: `constraint.local`.
    """

    _toml = "constraint.local"
    from_: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A point of the axis of a cylindrical system: radial, circumferential, along the axis",
        "list of number",
        key="from",
    )
    to: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Another one", "list of number")
    x: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A vector along the first axis, the same everywhere",
        "list of number",
    )
    xy: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A vector in the plane of the first and the second",
        "list of number",
    )


class Constraint(Table):
    """Constraints between displacements, for the whole run.

    TOML: `constraint`.
    """

    _toml = "constraint"
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "The direction of the axis of twist and cyclic; absent: \"z\"",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    dofs: Key[Literal["all"] | list[Literal["x", "y", "z", "rx", "ry", "rz"]] | None, Literal["all"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]]] = Key(
        "The directions, of kinematic and equal: \"all\" or a list of \"x\", \"y\", \"z\"",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`, `\"rx\"`, `\"ry\"`, `\"rz\"`",
    )
    equation: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [set or reference, direction, coefficient]; their sum is `rhs`, node by node of sets of several",
        "list of list of text; `\"x\"`, `\"y\"`, `\"z\"`, `\"rx\"`, `\"ry\"`, `\"rz\"`; number, 3 of them",
    )
    kind: Key[Literal["kinematic", "distributing", "plane", "line", "equal", "distance", "twist", "pretension", "cyclic"] | None, Literal["kinematic", "distributing", "plane", "line", "equal", "distance", "twist", "pretension", "cyclic"]] = Key(
        "Kinematic: nodes follow the reference; distributing: the reference follows their mean; plane, line: nodes stay in a plane, on a line; equal: nodes move alike; distance: two nodes keep theirs; twist: x of the reference is the angle (radian) by which nodes turn in the mean; pretension: faces are cut apart, x of the reference is by how much their sides overlap; cyclic: nodes move as those of the other side of a sector do",
        "`\"kinematic\"`, `\"distributing\"`, `\"plane\"`, `\"line\"`, `\"equal\"`, `\"distance\"`, `\"twist\"`, `\"pretension\"`, `\"cyclic\"`",
    )
    local: One[ConstraintLocal] = One(
        ConstraintLocal,
        "Axes that the directions of kinematic are along, x first, at the place of each node: two vectors, or a cylindrical system",
        "a table",
    )
    most: Key[float | None, float] = Key(
        "How far apart the two nodes of distance may go; absent: they keep their distance",
        "number > 0.0",
    )
    normal: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "Along which the sides of pretension overlap; absent: the mean normal of its faces",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    on: Key[str | None, str] = Key(
        "The nodes; of pretension the faces, of the side that the normal points away from",
        "text",
    )
    point: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A point of the axis of cyclic; absent: the origin",
        "list of number",
    )
    reference: Key[str | None, str] = Key("The reference, of kinematic, distributing, twist and pretension", "text")
    rhs: Key[float, float] = Key("The right-hand side, reached linearly over the first step", "number", default=0.0)
    sectors: Key[int | None, int] = Key("How many sectors make the whole, of cyclic", "whole number ≥ 1, ≤ 1000000000")
    with_: Key[str | None, str] = Key("The nodes of the other side, of cyclic", "text", key="with")


class ContactAdhesion(Table):
    """A pull between sides that are near, in place of `enforcement`: { work, range, shape }.

    TOML: `contact.adhesion`.
    """

    _toml = "contact.adhesion"
    range: Key[float | None, float] = Key(
        "Of \"dugdale\" the gap up to which it pulls, of \"lennard-jones\" the distance of atoms that touch (length)",
        "number > 0.0",
    )
    shape: Key[Literal["dugdale", "lennard-jones"], Literal["dugdale", "lennard-jones"]] = Key(
        "Dugdale: the same tension up to the range; lennard-jones: as between half-spaces of atoms",
        "`\"dugdale\"`, `\"lennard-jones\"`",
        default="dugdale",
    )
    work: Key[float | None, float] = Key("Work of adhesion, per area (force per length)", "number > 0.0")


class ContactCohesiveMixity(Table):
    """The toughness between opening and shear: { bk = exponent } of Benzeggagh and Kenane, or { power = exponent }.

    TOML: `contact.cohesive.mixity`.
    """

    _toml = "contact.cohesive.mixity"
    bk: Key[float | None, float] = Key("Exponent of the share of shear in the energy", "number > 0.0")
    power: Key[float | None, float] = Key("Exponent of the ratios of energies and toughnesses", "number > 0.0")


class ContactCohesive(Table):
    """With `tied`: how the joint breaks.

    TOML: `contact.cohesive`.
    """

    _toml = "contact.cohesive"
    initiation: Key[Literal["mixity", "quadratic"], Literal["mixity", "quadratic"]] = Key(
        "Where damage begins between opening and shear: interpolated as the toughness is by `bk`, or where the squares of tractions over strengths add up to 1, as by `power`",
        "`\"mixity\"`, `\"quadratic\"`",
        default="mixity",
    )
    mixity: One[ContactCohesiveMixity] = One(
        ContactCohesiveMixity,
        "The toughness between opening and shear: { bk = exponent } of Benzeggagh and Kenane, or { power = exponent }",
        "a table",
    )
    softening: Key[Literal["bilinear", "exponential"], Literal["bilinear", "exponential"]] = Key(
        "Bilinear: elastic up to the strength, then linear; exponential: curved from the start, with one toughness",
        "`\"bilinear\"`, `\"exponential\"`",
        default="bilinear",
    )
    stiffness: Key[Literal["auto"] | float | list[Any], Literal["auto"] | float | Sequence[Any] | NDArray[Any]] = Key(
        "Traction per opening before damage begins, of both directions or of each; auto: as stiff as contact, and no less than ten times what breaks at once",
        "`\"auto\"` or number > 0.0 or list of number > 0.0, 2 of them",
        default="auto",
    )
    strength: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "The largest tractions along the normal and across it",
        "list of number > 0.0, 2 of them",
    )
    toughness: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "The energies per area that opening and shear take (force per length)",
        "list of number > 0.0, 2 of them",
    )
    viscosity: Key[float, float] = Key(
        "Time by which damage is delayed, for the sake of convergence; its work is reported",
        "number ≥ 0.0",
        default=0.0,
    )


class ContactConductanceGas(Table):
    """K/(gap + jump), of a gas or a fluid between the sides.

    TOML: `contact.conductance.gas`.
    """

    _toml = "contact.conductance.gas"
    jump: Key[float | None, float] = Key("A length that is added to the gap", "number > 0.0")
    k: Key[float | None, float] = Key("Its conductivity", "number > 0.0")


class ContactConductancePower(Table):
    """H0 (pressure/hardness)^n.

    TOML: `contact.conductance.power`.
    """

    _toml = "contact.conductance.power"
    h0: Key[float | None, float] = Key("H where the pressure is the hardness", "number > 0.0")
    hardness: Key[float | None, float] = Key("A pressure", "number > 0.0")
    n: Key[float, float] = Key("The exponent; 0.95 after Cooper, Mikic and Yovanovich", "number > 0.0", default=0.95)


class ContactConductance(Table):
    """Ways that heat takes across a contact, up to its reach: heat per time, area and difference of temperatures.

    TOML: `contact.conductance`.
    """

    _toml = "contact.conductance"
    constant: Key[float | None, float] = Key("Of what touches", "number ≥ 0.0")
    gas: One[ContactConductanceGas] = One(
        ContactConductanceGas,
        "K/(gap + jump), of a gas or a fluid between the sides",
        "a table",
    )
    over_gap: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [gap, h], linear between, constant before the first and 0 beyond the last",
        "list of list of number; number ≥ 0.0, 2 of them",
    )
    over_pressure: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [pressure, h] of what touches, linear between, constant outside",
        "list of list of number ≥ 0.0, 2 of them",
    )
    power: One[ContactConductancePower] = One(ContactConductancePower, "H0 (pressure/hardness)^n", "a table")
    radiation: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "Between parallel grey surfaces with these emissivities, with the [constants] of the case",
        "list of number > 0.0, ≤ 1.0, 2 of them",
    )


class ContactDamping(Table):
    """What damps closed points in dynamic steps.

    TOML: `contact.damping`.
    """

    _toml = "contact.damping"
    normal: Key[float, float] = Key(
        "Pressure over the velocity of the gap, or force where the law gives forces",
        "number ≥ 0.0",
        default=0.0,
    )
    pulls: Key[bool, bool] = Key(
        "Whether points that open may be held back by more than presses them; else they are free from then on",
        "`true` or `false`",
        default=False,
    )
    tangential: Key[float, float] = Key(
        "The same over the velocity of slip, with friction and without",
        "number ≥ 0.0",
        default=0.0,
    )


class ContactEnforcementArctangent(Table):
    """A penalty rounded by an arctangent, with a tension at a distance.

    TOML: `contact.enforcement.arctangent`.
    """

    _toml = "contact.enforcement.arctangent"
    stiffness: Key[float | None, float] = Key("Force or pressure per penetration, far inside", "number > 0.0")
    tension: Key[float | None, float] = Key("The tension at a distance", "number > 0.0")
    within: Key[float | None, float] = Key(
        "The gap beyond which nothing acts, in sizes of the facets; absent: it acts at any distance",
        "number ≥ 0.0",
    )


class ContactEnforcementDugdale(Table):
    """Adhesion: a tension that is the same up to a gap.

    TOML: `contact.enforcement.dugdale`.
    """

    _toml = "contact.enforcement.dugdale"
    range: Key[float | None, float] = Key("The gap up to which it pulls (length)", "number > 0.0")
    work: Key[float | None, float] = Key("Work of adhesion, per area", "number > 0.0")


class ContactEnforcementExponential(Table):
    """A pressure that grows exponentially as the gap closes.

    TOML: `contact.enforcement.exponential`.
    """

    _toml = "contact.enforcement.exponential"
    c0: Key[float | None, float] = Key("The gap at which it has fallen to 1 %", "number > 0.0")
    p0: Key[float | None, float] = Key("Pressure at zero gap", "number > 0.0")
    within: Key[float | None, float] = Key(
        "The gap beyond which nothing acts (length); absent: it acts at any distance",
        "number ≥ 0.0",
    )


class ContactEnforcementLagrange(Table):
    """No penetration at all, by multipliers: {}.

    TOML: `contact.enforcement.lagrange`.
    """

    _toml = "contact.enforcement.lagrange"


class ContactEnforcementLennardJones(Table):
    """Adhesion: the pressure between half-spaces of atoms.

    TOML: `contact.enforcement.lennard_jones`.
    """

    _toml = "contact.enforcement.lennard_jones"
    range: Key[float | None, float] = Key("The distance of atoms that touch (length)", "number > 0.0")
    work: Key[float | None, float] = Key("Work of adhesion, per area", "number > 0.0")


class ContactEnforcement(Table):
    """How penetration is prevented.

    TOML: `contact.enforcement`.
    """

    _toml = "contact.enforcement"
    arctangent: One[ContactEnforcementArctangent] = One(
        ContactEnforcementArctangent,
        "A penalty rounded by an arctangent, with a tension at a distance",
        "a table",
    )
    augmented: Key[Literal["uzawa", "newton"] | None, Literal["uzawa", "newton"]] = Key(
        "Multipliers in addition to a penalty, updated between solutions or solved for with them",
        "`\"uzawa\"`, `\"newton\"`",
    )
    dugdale: One[ContactEnforcementDugdale] = One(
        ContactEnforcementDugdale,
        "Adhesion: a tension that is the same up to a gap",
        "a table",
    )
    exponential: One[ContactEnforcementExponential] = One(
        ContactEnforcementExponential,
        "A pressure that grows exponentially as the gap closes",
        "a table",
    )
    gap_tol: Key[Literal["auto"], Literal["auto"]] = Key(
        "Largest penetration of `augmented`; auto: that of [solver] newton",
        "`\"auto\"`",
        default="auto",
    )
    lagrange: One[ContactEnforcementLagrange] = One(
        ContactEnforcementLagrange,
        "No penetration at all, by multipliers: {}",
        "a table",
    )
    lennard_jones: One[ContactEnforcementLennardJones] = One(
        ContactEnforcementLennardJones,
        "Adhesion: the pressure between half-spaces of atoms",
        "a table",
    )
    own: Key[str | None, str] = Key("A contact law of the program that runs the case, by its name there", "text")
    penalty: Key[Literal["auto"] | float | list[list[Any]], Literal["auto"] | float | Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Force or pressure per penetration, or rows [gap, pressure]",
        "`\"auto\"` or number > 0.0 or list of list of number; number ≥ 0.0, 2 of them",
        default="auto",
    )
    per: Key[Literal["node", "area"] | None, Literal["node", "area"]] = Key(
        "A force per node, or a pressure; absent: by what the secondary side is",
        "`\"node\"`, `\"area\"`",
    )


class ContactFluid(Table):
    """A fluid that comes between the sides from their rim, and presses them apart where it is.

    TOML: `contact.fluid`.
    """

    _toml = "contact.fluid"
    critical: Key[float | Literal["fluid"], float | Literal["fluid"]] = Key(
        "The contact pressure up to which it enters: a number, 0 where contact is lost; \"fluid\": its own pressure",
        "number ≥ 0.0 or `\"fluid\"`",
        default=0.0,
    )
    from_: Key[str | None, str] = Key("Nodes of either side where it is from the start", "text", key="from")
    pressure: Key[float | None, float] = Key(
        "Its pressure at the end of the first step, reached linearly; it stays, unless a [[step.contact]] has another `fluid`",
        "number ≥ 0.0",
    )
    ramp: Key[float, float] = Key(
        "The part of the step in which its pressure grows on points that it has just reached",
        "number ≥ 0.0",
        default=0.001,
    )
    recede: Key[bool, bool] = Key(
        "Whether points dry after an increment at whose end they are pressed by 1.05 times `critical`, or more",
        "`true` or `false`",
        default=True,
    )


class ContactFriction(Table):
    """What limits friction, and what sticking yields.

    TOML: `contact.friction`.
    """

    _toml = "contact.friction"
    cap: Key[float | None, float] = Key("Largest shear traction, with `mu`", "number > 0.0")
    elastic_slip: Key[float | None, float] = Key("How far points move before they slip (length)", "number > 0.0")
    kinetic: Key[float | None, float] = Key("Coefficient after much slip", "number ≥ 0.0")
    mu: Key[float | None, float] = Key("Coefficient of friction", "number ≥ 0.0")
    own: Key[str | None, str] = Key("A friction law of the program that runs the case, by its name there", "text")
    static: Key[float | None, float] = Key("Coefficient before any slip", "number > 0.0")
    stiffness: Key[float | None, float] = Key("Shear traction per elastic slip", "number > 0.0")
    transition: Key[float | None, float] = Key("Length of slip over which the one becomes the other", "number > 0.0")
    tresca: Key[float | None, float] = Key("Shear traction wherever it touches", "number > 0.0")


class ContactFrictionHeat(Table):
    """What becomes of the work of friction.

    TOML: `contact.friction_heat`.
    """

    _toml = "contact.friction_heat"
    fraction: Key[float, float] = Key("The part of it that becomes heat", "number ≥ 0.0, ≤ 1.0", default=1.0)
    to_secondary: Key[float, float] = Key(
        "The part of that which the secondary side takes",
        "number ≥ 0.0, ≤ 1.0",
        default=0.5,
    )


class ContactGasketUnloading(Table):
    """How it opens from a closure.

    TOML: `contact.gasket.unloading`.
    """

    _toml = "contact.gasket.unloading"
    curve: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [closure, pressure], from the closure that stays at pressure 0 to `from`, on `loading`",
        "list of list of number; number ≥ 0.0, 2 of them",
    )
    from_: Key[float | None, float] = Key("The largest closure so far", "number > 0.0", key="from")


class ContactGasket(Table):
    """A gasket between the sides, in the place of `enforcement`: pressure against closure, the way by which a gap has closed.

    TOML: `contact.gasket`.
    """

    _toml = "contact.gasket"
    loading: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [closure, pressure] of closing further than ever; it begins at pressure 0 and goes on with its last slope",
        "list of list of number; number ≥ 0.0, 2 of them",
    )
    onset: Key[float | None, float] = Key(
        "The closure up to which it opens as it closes; absent: where the slope of `loading` has fallen by a tenth of its steepest",
        "number > 0.0",
    )
    tension: Key[float, float] = Key(
        "How stiff it is in being opened further than to pressure 0, over its first stiffness",
        "number ≥ 0.0",
        default=0.0,
    )
    unloading: Items[ContactGasketUnloading] = Items(
        ContactGasketUnloading,
        "Curves of opening, by the closures that they begin at; absent: it opens as it closes",
        "list of a table",
    )


class ContactStart(Table):
    """What is done about gaps and overlaps at the start.

    TOML: `contact.start`.
    """

    _toml = "contact.start"
    clearance: Key[Literal["measured"] | float, Literal["measured"] | float] = Key(
        "Gaps are taken to be this, whatever the mesh says; negative: overlaps",
        "`\"measured\"` or number",
        default="measured",
    )
    close_gaps_below: Key[float, float] = Key(
        "Gaps and overlaps up to this are removed by moving nodes, without strain",
        "number ≥ 0.0",
        default=0.0,
    )
    close_gaps_of: Key[str | None, str] = Key(
        "Gaps and overlaps of the nodes of this set are removed likewise, whatever their size",
        "text",
    )
    facets: Key[Literal["bent", "straight"], Literal["bent", "straight"]] = Key(
        "Gaps of surfaces that conform are measured between the curved surfaces that facets of linear elements were cut from, or between the facets",
        "`\"bent\"`, `\"straight\"`",
        default="bent",
    )
    interference: Key[Literal["step", "increment", "increments", "now", "strain-free"], Literal["step", "increment", "increments", "now", "strain-free"]] = Key(
        "Step: overlaps are resolved over the first step; increment: over its first two increments; increments: over what is left of it, as each increment finds them; now: at once; strain-free: they stay, without pressure",
        "`\"step\"`, `\"increment\"`, `\"increments\"`, `\"now\"`, `\"strain-free\"`",
        default="step",
    )


class ContactPair(Table):
    """With `all`: what is different where two of them meet; of several that name a pair the last holds.

    TOML: `contact.pair`.
    """

    _toml = "contact.pair"
    between: Key[list[str] | None, Sequence[str]] = Key(
        "Two bodies, groups, sets or materials, or \"any\"",
        "list of text, 2 of them",
    )
    enforcement: Mixed[ContactEnforcement] = Mixed(
        ContactEnforcement,
        "How penetration is prevented",
        "`\"auto\"` or a table",
    )
    friction: Mixed[ContactFriction] = Mixed(
        ContactFriction,
        "Coefficient of friction, or a table of what limits it",
        "number ≥ 0.0 or a table",
    )
    method: Key[Literal["auto", "node-to-node", "node-to-segment", "gauss-point", "mortar"] | None, Literal["auto", "node-to-node", "node-to-segment", "gauss-point", "mortar"]] = Key(
        "How the sides are discretized",
        "`\"auto\"`, `\"node-to-node\"`, `\"node-to-segment\"`, `\"gauss-point\"`, `\"mortar\"`",
    )
    secondary: Key[str | None, str] = Key("The one of the two that carries the points", "text")
    start: One[ContactStart] = One(ContactStart, "What is done about gaps and overlaps at the start", "a table")


class ContactRule(Table):
    """Points of gauss-point, along each direction of a facet.

    TOML: `contact.rule`.
    """

    _toml = "contact.rule"
    cut: Key[bool, bool] = Key(
        "Whether facets are cut where facets of the other side end; what both share has points of its own; with sliding = \"increment\" in every increment, else at the start",
        "`true` or `false`",
        default=False,
    )
    kind: Key[Literal["gauss", "lobatto"], Literal["gauss", "lobatto"]] = Key(
        "Points inside, or with the ends",
        "`\"gauss\"`, `\"lobatto\"`",
        default="gauss",
    )
    points: Key[Literal["auto"] | int, Literal["auto"] | int] = Key(
        "How many; auto: one more than the degree of the facet",
        "`\"auto\"` or whole number ≥ 1, ≤ 32",
        default="auto",
    )


class ContactTied(Table):
    """Sides that are joined.

    TOML: `contact.tied`.
    """

    _toml = "contact.tied"
    offset: Key[Literal["keep", "close", "pull"], Literal["keep", "close", "pull"]] = Key(
        "Whether distances at the start stay, are closed without strain, or pull, overlaps over the first step",
        "`\"keep\"`, `\"close\"`, `\"pull\"`",
        default="keep",
    )
    penalty_tangential: Key[float | None, float] = Key(
        "Traction per way apart within the tangent plane, with a penalty at points; absent: as along the normal",
        "number ≥ 0.0",
    )
    within: Key[float | None, float] = Key(
        "Points further away are not joined (length); absent: all within reach",
        "number > 0.0",
    )


class ContactWear(Table):
    """Material that sliding takes off the sides: a depth in proportion to pressure and way, in static steps.

    TOML: `contact.wear`.
    """

    _toml = "contact.wear"
    coefficient: Key[float | None, float] = Key("Depth per way and pressure (1/pressure)", "number > 0.0")
    hardness: Key[float | None, float] = Key("With `k` (pressure)", "number > 0.0")
    k: Key[float | None, float] = Key("The same times the hardness", "number > 0.0")
    limit: Key[float, float] = Key(
        "Depth over the size of the facets beyond which a warning says so: nodes stay where they are",
        "number > 0.0",
        default=0.05,
    )
    of: Key[Literal["secondary", "primary"], Literal["secondary", "primary"]] = Key(
        "The side whose coefficient that is",
        "`\"secondary\"`, `\"primary\"`",
        default="secondary",
    )
    primary: Key[float | None, float] = Key(
        "The coefficient of the primary side, in addition to that of the secondary one",
        "number > 0.0",
    )


class Contact(Table):
    """Pairs of surfaces that may touch.

    TOML: `contact`.
    """

    _toml = "contact"
    active: Key[bool, bool] = Key("Whether it acts from the first step on", "`true` or `false`", default=True)
    adhesion: One[ContactAdhesion] = One(
        ContactAdhesion,
        "A pull between sides that are near, in place of `enforcement`: { work, range, shape }",
        "a table",
    )
    all: Key[bool | list[str] | None, bool | Sequence[str]] = Key(
        "True: every outer face may touch every other, and pairs are found; a list: those of these bodies, groups or sets",
        "`true` or `false` or list of text",
    )
    area: Key[Literal["reference", "current", "adjacent", "opposite"], Literal["reference", "current", "adjacent", "opposite"]] = Key(
        "What points stand for: their area at the start, their present one, that of all outer faces at a node, or the facet opposite",
        "`\"reference\"`, `\"current\"`, `\"adjacent\"`, `\"opposite\"`",
        default="reference",
    )
    basis: Key[Literal["part", "whole"], Literal["part", "whole"]] = Key(
        "Of mortar, on quadratic facets: over what no weight of a node is negative, any part of a facet or the whole",
        "`\"part\"`, `\"whole\"`",
        default="part",
    )
    cohesive: One[ContactCohesive] = One(ContactCohesive, "With `tied`: how the joint breaks", "a table")
    conductance: Mixed[ContactConductance] = Mixed(
        ContactConductance,
        "Heat per time, area and difference of temperatures of what touches; or the ways that heat takes, which add up; absent: none",
        "number ≥ 0.0 or a table",
    )
    damping: One[ContactDamping] = One(ContactDamping, "What damps closed points in dynamic steps", "a table")
    enforcement: Mixed[ContactEnforcement] = Mixed(
        ContactEnforcement,
        "How penetration is prevented",
        "`\"auto\"` or a table",
        default="auto",
    )
    exclude: Key[list[str | list[str]] | None, Sequence[Any] | NDArray[Any]] = Key(
        "With `all`: what touches nothing; a pair of names: what does not touch each other, or itself",
        "list of text or list of text",
    )
    features: Key[Literal["auto", "faces", "edges"], Literal["auto", "faces", "edges"]] = Key(
        "Where points may rest: anywhere and a little beyond the rim, within faces only, or on the edges of the rim, too",
        "`\"auto\"`, `\"faces\"`, `\"edges\"`",
        default="auto",
    )
    fluid: One[ContactFluid] = One(
        ContactFluid,
        "A fluid that comes between the sides from their rim, and presses them apart where it is",
        "a table",
    )
    friction: Mixed[ContactFriction] = Mixed(
        ContactFriction,
        "Coefficient of friction, or a table of what limits it",
        "number ≥ 0.0 or a table",
        default=0.0,
    )
    friction_heat: Mixed[ContactFrictionHeat] = Mixed(
        ContactFrictionHeat,
        "Whether friction heats the sides, in half each where nothing else is said",
        "`true` or `false` or a table",
        default=True,
    )
    friction_history: Key[Literal["place", "traction"], Literal["place", "traction"]] = Key(
        "What sticking points remember: the place where they stick; or, as OOFEM has it, the traction of the last increment, without friction in the one in which they close",
        "`\"place\"`, `\"traction\"`",
        default="place",
    )
    gasket: One[ContactGasket] = One(
        ContactGasket,
        "A gasket between the sides, in the place of `enforcement`: pressure against closure, the way by which a gap has closed",
        "a table",
    )
    method: Key[Literal["auto", "node-to-node", "node-to-segment", "gauss-point", "mortar"], Literal["auto", "node-to-node", "node-to-segment", "gauss-point", "mortar"]] = Key(
        "How the sides are discretized",
        "`\"auto\"`, `\"node-to-node\"`, `\"node-to-segment\"`, `\"gauss-point\"`, `\"mortar\"`",
        default="auto",
    )
    name: Key[str | None, str] = Key("Its name, in results and messages", "text")
    normals: Key[Literal["primary", "secondary", "nodal"] | list[float], Literal["primary", "secondary", "nodal"] | Sequence[float] | NDArray[Any]] = Key(
        "Of node-to-node: those of a side, or a vector towards the secondary side; of mortar: \"nodal\", or \"secondary\" for those of facets, which turn to the other side otherwise",
        "`\"primary\"`, `\"secondary\"`, `\"nodal\"` or list of number",
        default="primary",
    )
    pair: Items[ContactPair] = Items(
        ContactPair,
        "With `all`: what is different where two of them meet; of several that name a pair the last holds",
        "list of a table",
    )
    pairs: Key[Literal["nearest", "order"], Literal["nearest", "order"]] = Key(
        "Of node-to-node: which nodes meet, the nearest or those of one place in the two lists",
        "`\"nearest\"`, `\"order\"`",
        default="nearest",
    )
    passes: Key[int, int] = Key("1, or 2: also with the sides swapped", "whole number ≥ 1, ≤ 2", default=1)
    primary: Key[str | None, str | Shape | SignedDistance | Projection] = Key(
        "The side they may not pass through: a set, a [[surface]], or \"self\"",
        "text",
    )
    reach: Key[Literal["auto"] | float, Literal["auto"] | float] = Key(
        "How far the sides are searched for each other (length)",
        "`\"auto\"` or number > 0.0",
        default="auto",
    )
    restitution: Key[float, float] = Key(
        "The velocity with which points leave an impact, over that with which they came: of multipliers, between rigid sides, and in explicit steps",
        "number ≥ 0.0, ≤ 1.0",
        default=0.0,
    )
    rule: One[ContactRule] = One(ContactRule, "Points of gauss-point, along each direction of a facet", "a table")
    secondary: Key[str | None, str] = Key(
        "The side that carries the points: the finer, softer or more curved one",
        "text",
    )
    self_: Key[bool, bool] = Key(
        "With `all`: whether bodies may touch themselves",
        "`true` or `false`",
        default=True,
        key="self",
    )
    sliding: Key[Literal["auto", "finite", "increment", "small"], Literal["auto", "finite", "increment", "small"]] = Key(
        "How far points slide: any way; or each keeps the tangent plane it meets at the start of the increment, or first. auto: \"small\" in linear geometry, else \"finite\"",
        "`\"auto\"`, `\"finite\"`, `\"increment\"`, `\"small\"`",
        default="auto",
    )
    start: One[ContactStart] = One(ContactStart, "What is done about gaps and overlaps at the start", "a table")
    temperature: Key[float | None, float] = Key(
        "The temperature of a rigid surface; absent: it neither gives nor takes heat",
        "number",
    )
    tied: Mixed[ContactTied] = Mixed(
        ContactTied,
        "Whether the sides are joined: false, true or { offset, within }",
        "`true` or `false` or a table",
        default=False,
    )
    wear: One[ContactWear] = One(
        ContactWear,
        "Material that sliding takes off the sides: a depth in proportion to pressure and way, in static steps",
        "a table",
    )


class CycleJump(Table):
    """One cycle that is solved stands for many, as far as wear changes little from one to the next; absent: each is solved.

    TOML: `cycle.jump`.
    """

    _toml = "cycle.jump"
    first: Key[int | None, int] = Key(
        "For how many the first stands; absent: one in ten thousand",
        "whole number ≥ 1, ≤ 1000000000",
    )
    max_wear: Key[float | None, float] = Key(
        "The largest depth that one may take off (length); absent: any",
        "number > 0.0",
    )
    tol: Key[float, float] = Key("What may go wrong in one of them, over the depth", "number > 0.0", default=0.01)


class Cycle(Table):
    """Steps that come again and again.

    TOML: `cycle`.
    """

    _toml = "cycle"
    count: Key[int | None, int] = Key("How many cycles there are", "whole number ≥ 1, ≤ 1000000000")
    jump: One[CycleJump] = One(
        CycleJump,
        "One cycle that is solved stands for many, as far as wear changes little from one to the next; absent: each is solved",
        "a table",
    )
    steps: Key[list[str] | None, Sequence[str]] = Key(
        "Their names, which follow one another in the case",
        "list of text",
    )


class ExpectTol(Table):
    """How far off it may be: { rel } relative to the value, or { abs } in its unit.

    TOML: `expect.tol`.
    """

    _toml = "expect.tol"
    abs: Key[float | None, float] = Key("In the unit of the value", "number ≥ 0.0")
    rel: Key[float | None, float] = Key("Relative to the value", "number ≥ 0.0")


class Expect(Table):
    """Values that are checked at the end.

    TOML: `expect`.
    """

    _toml = "expect"
    at: Key[int | None, int] = Key("The data row of history.csv; absent: the last", "whole number ≥ 1, ≤ 1000000000")
    time: Key[float | None, float] = Key("The total time", "number")
    tol: One[ExpectTol] = One(
        ExpectTol,
        "How far off it may be: { rel } relative to the value, or { abs } in its unit",
        "a table",
    )
    value: Key[float | None, float] = Key("What it should be", "number")
    what: Key[str | None, str] = Key("A column of history.csv, or \"displacement.z @ node 5\"", "text")


class InitialAt(Table):
    """Temperatures at the start that differ from that of everything; of several that name a node the last holds.

    TOML: `initial.at`.
    """

    _toml = "initial.at"
    gradient: Key[float | None, float] = Key(
        "Of shells: change of temperature per length along their normal; `temperature` is that of the middle surface; absent: 0",
        "number",
    )
    on: Key[str | None, str] = Key("The set or group", "text")
    temperature: Key[float | None, float] = Key("The temperature at the start", "number")


class InitialVelocity(Table):
    """Velocities at the start of the first step, if it is dynamic; of several that name a node the last holds.

    TOML: `initial.velocity`.
    """

    _toml = "initial.velocity"
    about: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A point of its axis; absent: the origin",
        "list of number",
    )
    omega: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Angular velocity (radian/time); a number in the plane",
        "number or list of number",
    )
    on: Key[str | None, str] = Key("The set, group, reference or rigid body", "text")
    v: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Velocity; of the point `about`, where there is an `omega`",
        "list of number",
    )


class Initial(Table):
    """Fields at the start.

    TOML: `initial`.
    """

    _toml = "initial"
    at: Items[InitialAt] = Items(
        InitialAt,
        "Temperatures at the start that differ from that of everything; of several that name a node the last holds",
        "list of a table",
    )
    strain: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Strain without stress at integration points, likewise; shears are those of the tensor",
        "list of list of whole number ≥ 0; whole number ≥ 1, ≤ 1000000000; number, 8 of them",
    )
    stress: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Stress without strain at integration points, rows [element, point, xx, yy, zz, xy, xz, yz]",
        "list of list of whole number ≥ 0; whole number ≥ 1, ≤ 1000000000; number, 8 of them",
    )
    temperature: Key[float | None, float] = Key(
        "Temperature of everything; absent: that at which materials have no thermal strain",
        "number",
    )
    velocity: Items[InitialVelocity] = Items(
        InitialVelocity,
        "Velocities at the start of the first step, if it is dynamic; of several that name a node the last holds",
        "list of a table",
    )


class Mass(Table):
    """Masses at nodes, of references and rigid bodies, in dynamic steps, natural modes and by gravity; masses of one node or reference add up.

    TOML: `mass`.
    """

    _toml = "mass"
    centroid: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Centroid of the mass of a reference at the start; absent: at the reference",
        "list of number",
    )
    inertia: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Moments of inertia of the mass of a reference about its centroid (mass length²), [xx, yy, zz] or [xx, yy, zz, xy, xz, yz] with the signs of a matrix; a number in the plane",
        "number > 0.0 or list of number",
    )
    on: Key[str | None, str] = Key("The set, group, reference or rigid body", "text")
    value: Key[float | None, float] = Key("The mass: at each node of a set, or of the reference", "number > 0.0")


class MaterialConductivity(Table):
    """Conductivity by direction, along the axes of the material.

    TOML: `material.conductivity`.
    """

    _toml = "material.conductivity"
    along: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "Along the three axes",
        "list of number > 0.0, 3 of them",
    )
    rows: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [temperature, k11, k22, k33, k12, k23, k13]",
        "list of list of number; number > 0.0; number, 7 of them",
    )


class MaterialDamping(Table):
    """Viscous forces in dynamic steps.

    TOML: `material.damping`.
    """

    _toml = "material.damping"
    mass: Key[float, float] = Key(
        "Force over mass and velocity (1/time); motions of the body as a whole are slowed, too",
        "number ≥ 0.0",
        default=0.0,
    )
    stiffness: Key[float, float] = Key(
        "Stress over the initial stiffness and the rate of strain (time)",
        "number ≥ 0.0",
        default=0.0,
    )


class MaterialExpansion(Table):
    """Thermal expansion: strain alpha (T - reference), counted from the temperature `free` on.

    TOML: `material.expansion`.
    """

    _toml = "material.expansion"
    alpha: Key[float | list[list[Any]] | None, float | Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Strain per temperature; or rows [temperature, alpha], linear between, constant outside",
        "number or list of list of number, 2 of them",
    )
    free: Key[float | Literal["start"] | None, float | Literal["start"]] = Key(
        "The temperature without thermal strain; start: what each place is at at the start; absent: the reference",
        "number or `\"start\"`",
    )
    reference: Key[float, float] = Key("The temperature from which alpha counts", "number", default=0.0)


class MaterialPlasticity(Table):
    """Yielding after von Mises, of linear-elastic.

    TOML: `material.plasticity`.
    """

    _toml = "material.plasticity"
    hardening: Key[Literal["isotropic", "kinematic", "combined"], Literal["isotropic", "kinematic", "combined"]] = Key(
        "Whether the yield surface grows, moves, or both",
        "`\"isotropic\"`, `\"kinematic\"`, `\"combined\"`",
        default="isotropic",
    )
    modulus: Key[float | None, float] = Key(
        "Kinematic hardening modulus of combined hardening (stress)",
        "number ≥ 0.0",
    )
    table: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [true yield stress, equivalent plastic strain], from strain 0 on",
        "list of list of number > 0.0; number ≥ 0.0, 2 of them",
    )


class Material(MaterialTable):
    """Materials.

    TOML: `material`.
    """

    _toml = "material"
    D: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Stiffness of anisotropic (stress), upper half by columns: D1111, D1122, D2222, D1133, D2233, D3333, D1112, … D1212, D1113, … D1313, D1123, … D2323",
        "list of number, 21 of them",
    )
    E: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Young's modulus (stress); at each of the temperatures T",
        "number > 0.0 or list of number > 0.0",
    )
    E1: Key[float | None, float] = Key("Young's modulus along the first axis of the material (stress)", "number > 0.0")
    E2: Key[float | None, float] = Key("Young's modulus along the second axis (stress)", "number > 0.0")
    E3: Key[float | None, float] = Key("Young's modulus along the third axis (stress)", "number > 0.0")
    G12: Key[float | None, float] = Key("Shear modulus between the axes 1 and 2 (stress)", "number > 0.0")
    G13: Key[float | None, float] = Key("Shear modulus between the axes 1 and 3 (stress)", "number > 0.0")
    G23: Key[float | None, float] = Key("Shear modulus between the axes 2 and 3 (stress)", "number > 0.0")
    T: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Temperatures of linear-elastic-by-temperature, increasing",
        "number or list of number",
    )
    alpha: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Exponents of the terms of ogden and hyperfoam",
        "number or list of number",
    )
    bulk: Key[float | None, float] = Key("Bulk modulus (stress)", "number > 0.0")
    c01: Key[float | None, float] = Key("Constant of mooney-rivlin (stress)", "number")
    c10: Key[float | None, float] = Key("Constant of mooney-rivlin (stress)", "number")
    conductivity: Mixed[MaterialConductivity] = Mixed(
        MaterialConductivity,
        "Heat per time, length and temperature; or rows [temperature, k], linear between, constant outside; or by direction",
        "number > 0.0 or list of list of number; number > 0.0, 2 of them or a table",
    )
    damping: One[MaterialDamping] = One(MaterialDamping, "Viscous forces in dynamic steps", "a table")
    density: Key[float | None, float] = Key("Mass per volume", "number > 0.0")
    expansion: One[MaterialExpansion] = One(
        MaterialExpansion,
        "Thermal expansion: strain alpha (T - reference), counted from the temperature `free` on",
        "a table",
    )
    exponent: Key[float | None, float] = Key("Hardening exponent of ramberg-osgood, at least 1", "number")
    latent_heat: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [heat per mass, solidus, liquidus] of changes of phase",
        "list of list of number > 0.0; number, 3 of them",
    )
    model: Key[Literal["linear-elastic", "saint-venant-kirchhoff", "neo-hookean", "mooney-rivlin", "mooney-rivlin-logarithmic", "ogden", "orthotropic", "hyperfoam", "anisotropic", "linear-elastic-by-temperature", "rotated-linear", "ciarlet", "no-tension", "no-compression", "ramberg-osgood", "ramberg-osgood-eulerian", "own"] | None, Literal["linear-elastic", "saint-venant-kirchhoff", "neo-hookean", "mooney-rivlin", "mooney-rivlin-logarithmic", "ogden", "orthotropic", "hyperfoam", "anisotropic", "linear-elastic-by-temperature", "rotated-linear", "ciarlet", "no-tension", "no-compression", "ramberg-osgood", "ramberg-osgood-eulerian", "own"]] = Key(
        "The law; absent: of bodies that conduct heat and never deform",
        "`\"linear-elastic\"`, `\"saint-venant-kirchhoff\"`, `\"neo-hookean\"`, `\"mooney-rivlin\"`, `\"mooney-rivlin-logarithmic\"`, `\"ogden\"`, `\"orthotropic\"`, `\"hyperfoam\"`, `\"anisotropic\"`, `\"linear-elastic-by-temperature\"`, `\"rotated-linear\"`, `\"ciarlet\"`, `\"no-tension\"`, `\"no-compression\"`, `\"ramberg-osgood\"`, `\"ramberg-osgood-eulerian\"`, `\"own\"`",
    )
    mu: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Shear moduli of the terms of ogden and hyperfoam (stress)",
        "number or list of number",
    )
    nu: Key[float | list[float] | None, float | Sequence[float] | NDArray[Any]] = Key(
        "Poisson's ratio; at each of the temperatures T, of each term of hyperfoam",
        "number > -1.0, < 0.5 or list of number > -1.0, < 0.5",
    )
    nu12: Key[float | None, float] = Key("Contraction along 2 over stretch along 1, under stress along 1", "number")
    nu13: Key[float | None, float] = Key("Contraction along 3 over stretch along 1, under stress along 1", "number")
    nu23: Key[float | None, float] = Key("Contraction along 3 over stretch along 2, under stress along 2", "number")
    offset: Key[float | None, float] = Key(
        "Plastic over elastic strain of ramberg-osgood at its reference stress",
        "number ≥ 0.0",
    )
    own: Key[str | None, str] = Key("A material of the program that runs the case, by its name there", "text")
    plasticity: One[MaterialPlasticity] = One(
        MaterialPlasticity,
        "Yielding after von Mises, of linear-elastic",
        "a table",
    )
    reference_stress: Key[float | None, float] = Key(
        "Stress at which the plastic strain of ramberg-osgood is `offset` times the elastic one (stress)",
        "number > 0.0",
    )
    residual: Key[float | None, float] = Key(
        "Stress that is left of the tension of no-tension, of the compression of no-compression (stress)",
        "number > 0.0",
    )
    specific_heat: Key[float | list[list[Any]] | None, float | Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Heat per mass and temperature; or rows [temperature, c], linear between, constant outside; next to a density",
        "number > 0.0 or list of list of number; number > 0.0, 2 of them",
    )


class LinearElastic(Material):
    """Isotropic and linear; of Saint Venant and Kirchhoff at finite strain.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "linear-elastic"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class SaintVenantKirchhoff(Material):
    """Isotropic and linear between Green's strain and the second stress of Piola and Kirchhoff.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "saint-venant-kirchhoff"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class NeoHookean(Material):
    """Isotropic rubber with one shear modulus, compressible.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "neo-hookean"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class MooneyRivlin(Material):
    """Rubber by two invariants.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "mooney-rivlin"

    def __init__(
        self,
        *,
        bulk: float,
        c01: float,
        c10: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(bulk=bulk, c01=c01, c10=c10, density=density, expansion=expansion, plasticity=plasticity)


class MooneyRivlinLogarithmic(Material):
    """Rubber by two invariants, its volume by a logarithm.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "mooney-rivlin-logarithmic"

    def __init__(
        self,
        *,
        bulk: float,
        c01: float,
        c10: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(bulk=bulk, c01=c01, c10=c10, density=density, expansion=expansion, plasticity=plasticity)


class Ogden(Material):
    """Rubber by powers of principal stretches.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "ogden"

    def __init__(
        self,
        *,
        alpha: float | Sequence[float] | NDArray[Any],
        bulk: float,
        mu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(alpha=alpha, bulk=bulk, density=density, expansion=expansion, mu=mu, plasticity=plasticity)


class Orthotropic(Material):
    """Linear, with three axes of symmetry.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "orthotropic"

    def __init__(
        self,
        *,
        E1: float,
        E2: float,
        E3: float,
        G12: float,
        G13: float,
        G23: float,
        nu12: float,
        nu13: float,
        nu23: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E1=E1, E2=E2, E3=E3, G12=G12, G13=G13, G23=G23, density=density, expansion=expansion, nu12=nu12, nu13=nu13, nu23=nu23, plasticity=plasticity)


class Hyperfoam(Material):
    """Foam by powers of principal stretches.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "hyperfoam"

    def __init__(
        self,
        *,
        alpha: float | Sequence[float] | NDArray[Any],
        mu: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(alpha=alpha, density=density, expansion=expansion, mu=mu, nu=nu, plasticity=plasticity)


class Anisotropic(Material):
    """Linear, without symmetry.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "anisotropic"

    def __init__(
        self,
        *,
        D: Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(D=D, density=density, expansion=expansion, plasticity=plasticity)


class LinearElasticByTemperature(Material):
    """Isotropic and linear, with constants that depend on the temperature.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "linear-elastic-by-temperature"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        T: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, T=T, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class RotatedLinear(Material):
    """Isotropic and linear between the stretch and the second stress of Piola and Kirchhoff.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "rotated-linear"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class Ciarlet(Material):
    """Isotropic, for metals under large compression.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "ciarlet"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        nu: float | Sequence[float] | NDArray[Any],
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, nu=nu, plasticity=plasticity)


class NoTension(Material):
    """Compression alone along each principal axis, without contraction across.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "no-tension"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        residual: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, plasticity=plasticity, residual=residual)


class NoCompression(Material):
    """Tension alone along each principal axis, without contraction across.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "no-compression"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        residual: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, plasticity=plasticity, residual=residual)


class RambergOsgood(Material):
    """Plasticity by deformation theory, with a power of the stress; Kirchhoff's stress and logarithmic strain.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "ramberg-osgood"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        exponent: float,
        nu: float | Sequence[float] | NDArray[Any],
        offset: float,
        reference_stress: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, exponent=exponent, nu=nu, offset=offset, plasticity=plasticity, reference_stress=reference_stress)


class RambergOsgoodEulerian(Material):
    """The same with Cauchy's stress and the strain of Almansi, as in CalculiX.

    TOML: `material.NAME`.
    """

    _toml = "material.NAME"
    _model = "ramberg-osgood-eulerian"

    def __init__(
        self,
        *,
        E: float | Sequence[float] | NDArray[Any],
        exponent: float,
        nu: float | Sequence[float] | NDArray[Any],
        offset: float,
        reference_stress: float,
        density: float | None = None,
        expansion: MaterialExpansion | Mapping[str, Any] | None = None,
        plasticity: MaterialPlasticity | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(E=E, density=density, expansion=expansion, exponent=exponent, nu=nu, offset=offset, plasticity=plasticity, reference_stress=reference_stress)


class MeshElements(Table):
    """An element written in place.

    TOML: `mesh.elements`.
    """

    _toml = "mesh.elements"
    group: Key[str | None, str] = Key("The group it belongs to", "text")
    id: Key[int | None, int] = Key("Its number", "whole number ≥ 0")
    nodes: Key[list[int] | None, Sequence[int] | NDArray[Any]] = Key(
        "The numbers of its nodes",
        "list of whole number ≥ 0",
    )
    type: Key[str | None, str] = Key("Its type, as in hex8 or tet4", "text")


class Mesh(Table):
    """Nodes and elements: a file, or written in place.

    TOML: `mesh`.
    """

    _toml = "mesh"
    elements: Items[MeshElements] = Items(MeshElements, "The elements", "list of a table")
    file: Key[str | None, str] = Key("Path of a mesh file, relative to the case", "text")
    nodes: Key[list[list[float]] | None, Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [id, x, y, z]; [id, x, y] in the plane",
        "list of list of number",
    )


class Model(Table):
    """Dimension of the model.

    TOML: `model`.
    """

    _toml = "model"
    space: Key[Literal["3d", "plane-strain", "plane-stress", "axisymmetric"], Literal["3d", "plane-strain", "plane-stress", "axisymmetric"]] = Key(
        "Space, a plane, or a body of revolution (r = x, axis y)",
        "`\"3d\"`, `\"plane-strain\"`, `\"plane-stress\"`, `\"axisymmetric\"`",
        default="3d",
    )
    thickness: Key[float, float] = Key(
        "Thickness of a model in plane strain or plane stress",
        "number > 0.0",
        default=1.0,
    )


class Orientation(Table):
    """Axes of materials, of the undeformed body, that bodies name.

    TOML: `orientation`.
    """

    _toml = "orientation"
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "The axis of a cylindrical one: \"x\", \"y\", \"z\" or a vector",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    kind: Key[Literal["rectangular", "cylindrical", "elements"], Literal["rectangular", "cylindrical", "elements"]] = Key(
        "The same everywhere; radial, circumferential and along an axis at every integration point; or by element",
        "`\"rectangular\"`, `\"cylindrical\"`, `\"elements\"`",
        default="rectangular",
    )
    origin: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "A point of the axis of a cylindrical one; absent: the origin",
        "list of number",
    )
    rows: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [element, x, y] of elements with axes of their own",
        "list of list of whole number ≥ 0; list of number, 3 of them",
    )
    turn: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "Turns all axes about one of themselves, 1, 2 or 3, counter-clockwise as seen from its tip",
        "list of whole number ≥ 1, ≤ 3; number, 2 of them",
    )
    x: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Along the first axis; of elements without a row",
        "list of number",
    )
    y: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "With x, spans the plane of the first two axes; of elements without a row",
        "list of number",
    )


class OutputEvery(Table):
    """How often results are written.

    TOML: `output.every`.
    """

    _toml = "output.every"
    time: Key[float | None, float] = Key("After so much time", "number > 0.0")


class OutputHistory(Table):
    """Columns of history.csv.

    TOML: `output.history`.
    """

    _toml = "output.history"
    contact: Key[str | None, str] = Key("Of this contact", "text")
    name: Key[str | None, str] = Key("The first part of the column's name", "text")
    node: Key[int | None, int] = Key("Of the node of this number", "whole number ≥ 0")
    quantity: Key[str | list[str] | None, str | Sequence[str]] = Key(
        "The quantity, as in force_z or displacement.z, or a list of them",
        "text or list of text",
    )
    reference: Key[str | None, str] = Key("Of this reference or rigid body", "text")
    set: Key[str | None, str] = Key("Of this set: the sum of forces, the mean of other quantities", "text")


class Output(Table):
    """What is written.

    TOML: `output`.
    """

    _toml = "output"
    contact_pressure: Key[Literal["multiplier", "smoothed"], Literal["multiplier", "smoothed"]] = Key(
        "Pressures and tractions of mortar contact on quadratic triangles: those of the equations, or smoothed over the triangles that touch",
        "`\"multiplier\"`, `\"smoothed\"`",
        default="multiplier",
    )
    every: Mixed[OutputEvery] = Mixed(
        OutputEvery,
        "Write after so many increments, or { time }",
        "whole number ≥ 1, ≤ 1000000000 or a table",
        default=1,
    )
    fields: Key[list[Literal["displacement", "reaction_force", "stress", "cauchy_stress", "von_mises", "principal", "principal_stress", "strain", "plastic_strain", "temperature", "contact", "contact_pressure"]], Sequence[Literal["displacement", "reaction_force", "stress", "cauchy_stress", "von_mises", "principal", "principal_stress", "strain", "plastic_strain", "temperature", "contact", "contact_pressure"]]] = Key(
        "Fields to write",
        "list of `\"displacement\"`, `\"reaction_force\"`, `\"stress\"`, `\"cauchy_stress\"`, `\"von_mises\"`, `\"principal\"`, `\"principal_stress\"`, `\"strain\"`, `\"plastic_strain\"`, `\"temperature\"`, `\"contact\"`, `\"contact_pressure\"`",
        default=["displacement", "stress", "contact"],
    )
    format: Key[list[Literal["vtu", "frd"]], Sequence[Literal["vtu", "frd"]]] = Key(
        "Formats of results",
        "list of `\"vtu\"`, `\"frd\"`",
        default=["vtu"],
    )
    history: Items[OutputHistory] = Items(OutputHistory, "Columns of history.csv", "list of a table")
    names: Key[Literal["signorini"], Literal["signorini"]] = Key(
        "How fields are named",
        "`\"signorini\"`",
        default="signorini",
    )


class Reference(Table):
    """Named points with translations and rotations of their own; without `at` and `node` in the mean of the nodes that move with it.

    TOML: `reference`.
    """

    _toml = "reference"
    at: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Where it is at the start", "list of number")
    node: Key[int | None, int] = Key("The node where it is at the start", "whole number ≥ 0")
    rotations: Key[int | None, int] = Key(
        "A node that stands for its rotations where displacements of nodes are printed",
        "whole number ≥ 0",
    )


class Set(Table):
    """Named sets of nodes, elements or faces.

    TOML: `sets`.
    """

    _toml = "sets"
    at: Key[float | None, float] = Key("Distance of the plane from the origin, along its normal", "number")
    box: Key[list[list[float]] | None, Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any]] = Key(
        "What lies between two corners: [[x, y, z], [x, y, z]]",
        "list of list of number, 2 of them",
    )
    elements: Key[list[int] | None, Sequence[int] | NDArray[Any]] = Key(
        "Numbers of elements",
        "list of whole number ≥ 0",
    )
    faces: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [element, side]: side \"S1\", \"S2\", … as in Abaqus, or \"+z\", \"-x\", … by its normal; of shells S1 is the negative side, S2 the positive one, S3, S4, … the edges",
        "list of list of whole number ≥ 0; text, 2 of them",
    )
    near: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "The node nearest to a point",
        "list of number",
    )
    nodes: Key[list[int] | None, Sequence[int] | NDArray[Any]] = Key("Numbers of nodes", "list of whole number ≥ 0")
    of: Key[str | None, str] = Key("The body or group whose nodes are searched; absent: all", "text")
    plane: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "What lies in a plane: \"x\", \"y\", \"z\" or a vector normal to it",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    sphere: Key[list[Any] | None, Sequence[Any] | NDArray[Any]] = Key(
        "What lies in a sphere",
        "list of list of number; number > 0.0, 2 of them",
    )
    tol: Key[float | None, float] = Key(
        "Distance from the plane up to which nodes count; absent: 1e-6 of the size of the mesh",
        "number > 0.0",
    )
    union: Key[list[str] | None, Sequence[str]] = Key("Names of sets or groups", "list of text")


class SolverNewton(Table):
    """Newton's method.

    TOML: `solver.newton`.
    """

    _toml = "solver.newton"
    force_tol: Key[float, float] = Key(
        "Largest residual force, relative to the mean force",
        "number > 0.0",
        default=1e-6,
    )
    gap_tol: Key[float, float] = Key(
        "Largest penetration, relative to the size of a facet, of laws with multipliers",
        "number > 0.0",
        default=1e-6,
    )
    line_search: Key[Literal["auto"] | bool, Literal["auto"] | bool] = Key(
        "Whether corrections are shortened",
        "`\"auto\"` or `true` or `false`",
        default="auto",
    )
    max_iterations: Key[int, int] = Key(
        "Iterations of an increment at most, and three times as many while its force error falls",
        "whole number ≥ 1, ≤ 1000000000",
        default=20,
    )
    stress: Key[Literal["auto", "mixed", "current"], Literal["auto", "mixed", "current"]] = Key(
        "Stress of the geometric stiffness at finite strain: `mixed` takes the stress that the last correction predicted, `auto` does in shells, and in other thin bodies where no contact has friction",
        "`\"auto\"`, `\"mixed\"`, `\"current\"`",
        default="auto",
    )


class Solver(Table):
    """How equations are solved.

    TOML: `solver`.
    """

    _toml = "solver"
    free_motions: Key[Literal["refuse", "hold"], Literal["refuse", "hold"]] = Key(
        "Motions that nothing resists: an error, or held where no load acts on them",
        "`\"refuse\"`, `\"hold\"`",
        default="refuse",
    )
    linear: Key[Literal["auto", "direct", "multigrid", "mumps", "petsc"], Literal["auto", "direct", "multigrid", "mumps", "petsc"]] = Key(
        "How linear equations are solved: auto takes multigrid for large models in space and the direct solver for others; petsc shares them out among the ranks of mpirun, and is what auto takes there; mumps and petsc are there where the program was built with them",
        "`\"auto\"`, `\"direct\"`, `\"multigrid\"`, `\"mumps\"`, `\"petsc\"`",
        default="auto",
    )
    newton: One[SolverNewton] = One(SolverNewton, "Newton's method", "a table")
    on_trouble: Key[list[Literal["cut", "stabilize", "points"]], Sequence[Literal["cut", "stabilize", "points"]]] = Key(
        "What is tried, in order, when an increment does not converge; points solves the case again from the start, with Gauss points in contacts for which the program chose mortar",
        "list of `\"cut\"`, `\"stabilize\"`, `\"points\"`",
        default=["cut", "stabilize", "points"],
    )
    stabilize: Key[Literal["auto"] | bool, Literal["auto"] | bool] = Key(
        "Whether a vanishing viscous force holds bodies that only open contact holds",
        "`\"auto\"` or `true` or `false`",
        default="auto",
    )
    threads: Key[Literal["auto"] | int, Literal["auto"] | int] = Key(
        "The number of threads",
        "`\"auto\"` or whole number ≥ 1, ≤ 4096",
        default="auto",
    )


class Spring(Table):
    """Springs between nodes, or to the ground.

    TOML: `spring`.
    """

    _toml = "spring"
    between: Key[list[str] | None, Sequence[str]] = Key(
        "Two sets of as many nodes, paired in their order",
        "list of text, 2 of them",
    )
    direction: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector; absent: along the line between its ends, which turns with them",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    name: Key[str | None, str] = Key("Its name, in messages", "text")
    on: Key[str | None, str] = Key("A set of nodes tied to the ground", "text")
    stiffness: Key[float | None, float] = Key("Force over elongation, of each spring", "number > 0.0")
    table: Key[list[list[Any]] | None, Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [force, elongation], linear between, constant outside",
        "list of list of number, 2 of them",
    )


class Activate(Table):
    """Elements that take part again from this step on, with their loads and contact faces.

    TOML: `step.activate`.
    """

    _toml = "step.activate"
    group: Key[str | None, str] = Key("The group or set of elements", "text")
    strain: Key[Literal["free", "keep"], Literal["free", "keep"]] = Key(
        "Free: without stress where they are now, as new; keep: with the strain and the history that they have",
        "`\"free\"`, `\"keep\"`",
        default="free",
    )


class ContactChange(Table):
    """Changes of contacts, from this step on.

    TOML: `step.contact`.
    """

    _toml = "step.contact"
    active: Key[bool | None, bool] = Key("Whether it acts", "`true` or `false`")
    fluid: Key[float | None, float] = Key(
        "The pressure of its fluid at the end of the step, reached linearly",
        "number ≥ 0.0",
    )
    friction: Mixed[ContactFriction] = Mixed(
        ContactFriction,
        "Coefficient of friction, or a table of what limits it",
        "number ≥ 0.0 or a table",
    )
    name: Key[str | None, str] = Key("The contact", "text")
    slip: Key[float | None, float] = Key(
        "How far the sides slide for wear in each step, out of the plane or round (length); absent: as they move",
        "number ≥ 0.0",
    )


class Deactivate(Table):
    """Elements that take no part from this step on, nor do their loads and contact faces.

    TOML: `step.deactivate`.
    """

    _toml = "step.deactivate"
    group: Key[str | None, str] = Key("The group or set of elements", "text")
    ramp: Key[bool, bool] = Key(
        "Whether what they exert falls to zero over the step; false: it is gone at once",
        "`true` or `false`",
        default=True,
    )


class DynamicsMassScaling(Table):
    """Explicit: mass added to elements that would need shorter increments than this.

    TOML: `step.dynamics.mass_scaling`.
    """

    _toml = "step.dynamics.mass_scaling"
    limit: Key[float, float] = Key("The mass that may be added, over that of all bodies", "number ≥ 0.0", default=0.05)
    step: Key[float | None, float] = Key("The shortest increment that is wanted (time)", "number > 0.0")


class Dynamics(Table):
    """How a dynamic step goes through time.

    TOML: `step.dynamics`.
    """

    _toml = "step.dynamics"
    alpha: Key[float | None, float] = Key(
        "In its place, that of Hilber, Hughes and Taylor; 0: the trapezoidal rule of Newmark",
        "number ≥ -0.3333333333333333, ≤ 0.0",
    )
    contact_force: Key[Literal["end", "weighted"], Literal["end", "weighted"]] = Key(
        "End: contact acts as a whole, as it is at the end of an increment; weighted: of penalties and curves, with its share of all forces, and what it was before, as CalculiX does: hard contact flickers then",
        "`\"end\"`, `\"weighted\"`",
        default="end",
    )
    contact_mass: Key[Literal["as-is", "redistributed"], Literal["as-is", "redistributed"]] = Key(
        "Redistributed: elements with nodes on a side of a contact give their mass to their other nodes; impacts then neither flicker nor lose energy",
        "`\"as-is\"`, `\"redistributed\"`",
        default="as-is",
    )
    error_tol: Key[float, float] = Key(
        "Of increments that adapt: their local error of displacements, over the largest displacement so far; 0: it does not count",
        "number ≥ 0.0",
        default=0.001,
    )
    impact_step: Key[float, float] = Key(
        "Of increments that adapt: the longest in which contact closes or opens, over the time that a wave takes through an element of the secondary side; 0: any",
        "number ≥ 0.0",
        default=1.5,
    )
    mass_scaling: One[DynamicsMassScaling] = One(
        DynamicsMassScaling,
        "Explicit: mass added to elements that would need shorter increments than this",
        "a table",
    )
    method: Key[Literal["generalized-alpha", "energy-momentum", "explicit"], Literal["generalized-alpha", "energy-momentum", "explicit"]] = Key(
        "Implicit, of second order; energy-momentum: forces of bodies and contacts with a penalty do exactly the work of their energy; explicit: central differences with masses at nodes, in short increments that follow from what is stable, as many as an increment takes",
        "`\"generalized-alpha\"`, `\"energy-momentum\"`, `\"explicit\"`",
        default="generalized-alpha",
    )
    rho_inf: Key[float | None, float] = Key(
        "The spectral radius of the highest frequencies: 1 keeps them, 0 takes them away in an increment; absent: 0.8",
        "number ≥ 0.0, ≤ 1.0",
    )
    safety: Key[float | None, float] = Key(
        "Explicit: the length of short increments, over the longest that is stable; absent: 0.9",
        "number > 0.0, ≤ 1.0",
    )


class Fix(Table):
    """Supports, at the present position.

    TOML: `step.fix`.
    """

    _toml = "step.fix"
    on: Key[str | None, str] = Key("The set, mesh group, reference or rigid body it acts on", "text")
    rot: Key[Literal["all"] | list[Literal["x", "y", "z"]] | None, Literal["all"] | Sequence[Literal["x", "y", "z"]]] = Key(
        "Rotations held, of a reference, rigid body or shell nodes",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`",
    )
    u: Key[Literal["all"] | list[Literal["x", "y", "z"]] | None, Literal["all"] | Sequence[Literal["x", "y", "z"]]] = Key(
        "Displacements held: \"all\" or a list of \"x\", \"y\", \"z\"",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`",
    )


class Free(Table):
    """Supports and motions of earlier steps that end.

    TOML: `step.free`.
    """

    _toml = "step.free"
    on: Key[str | None, str] = Key("The set, mesh group, reference or rigid body it acts on", "text")
    rot: Key[Literal["all"] | list[Literal["x", "y", "z"]] | None, Literal["all"] | Sequence[Literal["x", "y", "z"]]] = Key(
        "Rotations set free, of a reference, rigid body or shell nodes",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`",
    )
    temperature: Key[bool, bool] = Key(
        "Whether temperatures that earlier steps gave are set free",
        "`true` or `false`",
        default=False,
    )
    u: Key[Literal["all"] | list[Literal["x", "y", "z"]] | None, Literal["all"] | Sequence[Literal["x", "y", "z"]]] = Key(
        "Displacements set free: \"all\" or a list of \"x\", \"y\", \"z\"",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`",
    )


class Frequency(Table):
    """Which natural frequencies a frequency step finds.

    TOML: `step.frequency`.
    """

    _toml = "step.frequency"
    lower: Key[float | None, float] = Key(
        "The frequency above which they begin (cycles per time); absent: with the lowest",
        "number ≥ 0.0",
    )
    modes: Key[int, int] = Key(
        "How many, the lowest first; rigid motions of free bodies count",
        "whole number ≥ 1, ≤ 10000",
        default=10,
    )
    upper: Key[float | None, float] = Key(
        "The frequency at which they end, where there are not as many; absent: nowhere",
        "number > 0.0",
    )


class Increments(Table):
    """How the step is cut into increments: a smaller one after a failure; after two easy ones a larger one, or all that is left of the step where that is not much more.

    TOML: `step.increments`.
    """

    _toml = "step.increments"
    count_max: Key[int, int] = Key("How many there may be", "whole number ≥ 1, ≤ 1000000000", default=1000)
    fixed: Key[int | None, int] = Key("Exactly so many equal ones", "whole number ≥ 1, ≤ 1000000000")
    initial: Key[float | None, float] = Key("The first one, in the time of the step", "number > 0.0")
    max: Key[float | None, float] = Key("The largest one; absent: the whole step", "number > 0.0")
    min: Key[float | None, float] = Key("The smallest one; absent: 1e-5 of the step", "number > 0.0")


class LoadCentrifugal(Table):
    """Forces of a frame that rotates.

    TOML: `step.load.centrifugal`.
    """

    _toml = "step.load.centrifugal"
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector along the axis",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    point: Key[list[float], Sequence[float] | NDArray[Any]] = Key(
        "A point of the axis; absent: the origin",
        "list of number",
        default=[0.0, 0.0, 0.0],
    )
    speed: Key[float | None, float] = Key("Angular velocity, in radian per time", "number")


class LoadFilm(Table):
    """Convection: heat per time and area out of a surface, h (T - sink).

    TOML: `step.load.film`.
    """

    _toml = "step.load.film"
    h: Key[float | None, float] = Key("Heat per time, area and temperature", "number ≥ 0.0")
    sink: Key[float | None, float] = Key("The temperature far from the surface", "number")


class LoadRadiation(Table):
    """Radiation to surroundings: emissivity sigma ((T - T_0)^4 - (sink - T_0)^4), with the constants of the case.

    TOML: `step.load.radiation`.
    """

    _toml = "step.load.radiation"
    emissivity: Key[float | None, float] = Key("Part of the radiation of a black surface", "number ≥ 0.0, ≤ 1.0")
    sink: Key[float | None, float] = Key("The temperature of the surroundings", "number")


class Load(Table):
    """Loads, reached linearly over the step unless `table` or `amplitude` says otherwise.

    TOML: `step.load`.
    """

    _toml = "step.load"
    amplitude: Key[str | None, str | Course] = Key("The name of an amplitude, a factor over time", "text")
    body_force: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Force per volume [x, y, z]",
        "list of number",
    )
    centrifugal: One[LoadCentrifugal] = One(LoadCentrifugal, "Forces of a frame that rotates", "a table")
    coupling: Key[Literal["none", "rigid-x", "rigid-y", "rigid-z"], Literal["none", "rigid-x", "rigid-y", "rigid-z"]] = Key(
        "The direction in which what is loaded keeps one common displacement, in the whole run",
        "`\"none\"`, `\"rigid-x\"`, `\"rigid-y\"`, `\"rigid-z\"`",
        default="none",
    )
    film: One[LoadFilm] = One(LoadFilm, "Convection: heat per time and area out of a surface, h (T - sink)", "a table")
    follows: Key[bool | None, bool] = Key(
        "Whether a pressure turns with the surface; absent: it does in nonlinear steps",
        "`true` or `false`",
    )
    force: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "The total force [x, y, z], spread over what it acts on",
        "list of number",
    )
    gravity: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Acceleration [x, y, z] of all mass",
        "list of number",
    )
    heat_flux: Key[float | None, float] = Key("Heat per time and area into a surface", "number")
    heat_power: Key[float | None, float] = Key("Heat per time, spread over what it acts on", "number")
    heat_source: Key[float | None, float] = Key("Heat per time and volume, within bodies", "number")
    line: Key[float | None, float] = Key(
        "Force per length of edges of shells, within the shell and normal to the edge, positive inwards",
        "number",
    )
    moment: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "The moment [x, y, z] about the centre of what it acts on; of shell nodes: at each",
        "list of number",
    )
    name: Key[str | None, str] = Key("Its name: a later load of this name replaces it", "text")
    on: Key[str | None, str] = Key("The set, mesh group, reference or rigid body it acts on", "text")
    per_node: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "The same force [x, y, z] at every node",
        "list of number",
    )
    pressure: Key[float | None, float] = Key("Pressure on a surface, positive inwards", "number")
    radiation: One[LoadRadiation] = One(
        LoadRadiation,
        "Radiation to surroundings: emissivity sigma ((T - T_0)^4 - (sink - T_0)^4), with the constants of the case",
        "a table",
    )
    table: Key[list[list[float]] | None, Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [time of the step, factor]; times increase",
        "list of list of number, 2 of them",
    )
    traction: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "Force per area [x, y, z]",
        "list of number",
    )


class MaterialChange(Table):
    """Bodies that are made of another material from this step on.

    TOML: `step.material`.
    """

    _toml = "step.material"
    group: Key[str | None, str] = Key("The group of the body", "text")
    material: Key[str | None, str] = Key("Its new material", "text")


class MoveFrom(Table):
    """The results of another model, whose displacements nodes have at their places.

    TOML: `step.move.from`.
    """

    _toml = "step.move.from"
    data_set: Key[int | None, int] = Key(
        "The number of the displacement field, in place of a step",
        "whole number ≥ 1, ≤ 1000000000",
    )
    elements: Key[list[int] | None, Sequence[int] | NDArray[Any]] = Key(
        "The numbers of its elements that count; absent: all",
        "list of whole number ≥ 1, ≤ 1000000000",
    )
    file: Key[str | None, str] = Key("Its results: a .frd, .vtu or .pvd file, or a folder of results", "text")
    ramp: Key[bool, bool] = Key(
        "Whether they are reached linearly over the step; false: from its first increment on",
        "`true` or `false`",
        default=True,
    )
    step: Key[int | None, int] = Key("The number of its step; the end of it counts", "whole number ≥ 1, ≤ 1000000000")
    u: Key[Literal["all"] | list[Literal["x", "y", "z"]], Literal["all"] | Sequence[Literal["x", "y", "z"]] | Sequence[Sequence[float]] | Course] = Key(
        "Displacements prescribed: \"all\" or a list of \"x\", \"y\", \"z\"",
        "`\"all\"` or list of `\"x\"`, `\"y\"`, `\"z\"`",
        default="all",
    )


class Motion(Table):
    """The course of a prescribed component or temperature.

    TOML: `step.move.rx`.
    """

    _toml = "step.move.rx"
    amplitude: Key[str | None, str] = Key("The name of an amplitude", "text")
    table: Key[list[list[float]] | None, Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any]] = Key(
        "Rows [time of the step, value]; times increase",
        "list of list of number, 2 of them",
    )
    value: Key[float, float] = Key("What the amplitude is multiplied with", "number", default=1.0)


class Move(Table):
    """Prescribed motions: a number is reached linearly over the step.

    TOML: `step.move`.
    """

    _toml = "step.move"
    from_: One[MoveFrom] = One(
        MoveFrom,
        "The results of another model, whose displacements nodes have at their places",
        "a table",
        key="from",
    )
    on: Key[str | None, str] = Key("The set, mesh group, reference or rigid body it acts on", "text")
    rx: Mixed[Motion] = Mixed(Motion, "Rotation about x, in radian, of a reference or rigid body", "number or a table")
    ry: Mixed[Motion] = Mixed(Motion, "Rotation about y, in radian, of a reference or rigid body", "number or a table")
    rz: Mixed[Motion] = Mixed(Motion, "Rotation about z, in radian, of a reference or rigid body", "number or a table")
    ux: Mixed[Motion] = Mixed(Motion, "Displacement along x", "number or a table")
    uy: Mixed[Motion] = Mixed(Motion, "Displacement along y", "number or a table")
    uz: Mixed[Motion] = Mixed(Motion, "Displacement along z", "number or a table")


class Print(Table):
    """Tables in NAME.dat, in CalculiX's format; absent: those of the step before, [] ends them.

    TOML: `step.print`.
    """

    _toml = "step.print"
    contact: Key[list[Literal["gap", "traction", "energy", "count", "force", "normal-force", "shear-force"]] | None, Sequence[Literal["gap", "traction", "energy", "count", "force", "normal-force", "shear-force"]]] = Key(
        "Quantities of contact, at the points of its secondary side or in all",
        "list of `\"gap\"`, `\"traction\"`, `\"energy\"`, `\"count\"`, `\"force\"`, `\"normal-force\"`, `\"shear-force\"`",
    )
    elements: Key[list[Literal["stress", "strain", "mechanical-strain", "plastic-strain", "energy-density", "energy", "volume", "spin-squared", "heat-flux"]] | None, Sequence[Literal["stress", "strain", "mechanical-strain", "plastic-strain", "energy-density", "energy", "volume", "spin-squared", "heat-flux"]]] = Key(
        "Quantities of elements, at their integration points where they vary",
        "list of `\"stress\"`, `\"strain\"`, `\"mechanical-strain\"`, `\"plastic-strain\"`, `\"energy-density\"`, `\"energy\"`, `\"volume\"`, `\"spin-squared\"`, `\"heat-flux\"`",
    )
    every: Key[int, int] = Key(
        "After so many increments, and at the end of the step",
        "whole number ≥ 1, ≤ 1000000000",
        default=1,
    )
    faces: Key[list[Literal["force"]] | None, Sequence[Literal["force"]]] = Key(
        "Quantities of faces, inside a body or around it: force and moment of the stresses at their nodes",
        "list of `\"force\"`",
    )
    local: Key[bool, bool] = Key(
        "Whether vectors at nodes are printed along their [[axes]], and tensors at points along the axes of the material",
        "`true` or `false`",
        default=False,
    )
    nodes: Key[list[Literal["displacement", "reaction", "temperature", "heat-reaction"]] | None, Sequence[Literal["displacement", "reaction", "temperature", "heat-reaction"]]] = Key(
        "Quantities of nodes",
        "list of `\"displacement\"`, `\"reaction\"`, `\"temperature\"`, `\"heat-reaction\"`",
    )
    on: Key[str | None, str] = Key(
        "The set or group of nodes, elements or faces, or the contact; absent: every contact",
        "text",
    )
    totals: Key[Literal["no", "yes", "only"], Literal["no", "yes", "only"]] = Key(
        "Whether sums over the set follow: of reactions, energies, volumes",
        "`\"no\"`, `\"yes\"`, `\"only\"`",
        default="no",
    )


class Temperature(Table):
    """Temperatures, reached linearly over the step, and at once in transient ones; others stay, or are unknown in heat and coupled steps.

    TOML: `step.temperature`.
    """

    _toml = "step.temperature"
    gradient: Key[float | None, float] = Key(
        "Of shells: change of temperature per length along their normal, with the course of `value`, which is that of the middle surface; absent: 0",
        "number",
    )
    on: Key[str | None, str] = Key("The set or group; \"all\" is everything", "text")
    value: Mixed[Motion] = Mixed(
        Motion,
        "The temperature at the end of the step; its course, in heat and coupled steps",
        "number or a table",
    )


class Step(Table):
    """What happens, in order; a step keeps what earlier ones set.

    TOML: `step`.
    """

    _toml = "step"
    activations: Items[Activate] = Items(
        Activate,
        "Elements that take part again from this step on, with their loads and contact faces",
        "list of a table",
        key="activate",
    )
    contacts: Items[ContactChange] = Items(
        ContactChange,
        "Changes of contacts, from this step on",
        "list of a table",
        key="contact",
    )
    deactivations: Items[Deactivate] = Items(
        Deactivate,
        "Elements that take no part from this step on, nor do their loads and contact faces",
        "list of a table",
        key="deactivate",
    )
    duration: Key[float, float] = Key("How long it takes", "number > 0.0", default=1.0)
    dynamics: One[Dynamics] = One(Dynamics, "How a dynamic step goes through time", "a table")
    fixes: Items[Fix] = Items(Fix, "Supports, at the present position", "list of a table", key="fix")
    frees: Items[Free] = Items(Free, "Supports and motions of earlier steps that end", "list of a table", key="free")
    frequency: One[Frequency] = One(Frequency, "Which natural frequencies a frequency step finds", "a table")
    geometry: Key[Literal["auto", "linear", "nonlinear"], Literal["auto", "linear", "nonlinear"]] = Key(
        "Small displacements or any; auto: as the step before, at first nonlinear, and in frequency steps",
        "`\"auto\"`, `\"linear\"`, `\"nonlinear\"`",
        default="auto",
    )
    increments: Mixed[Increments] = Mixed(
        Increments,
        "A number, { fixed } or { initial, min, max, count_max }",
        "whole number ≥ 1, ≤ 1000000000 or a table",
        default=10,
    )
    kind: Key[Literal["static", "dynamic", "frequency", "heat", "coupled"], Literal["static", "dynamic", "frequency", "heat", "coupled"]] = Key(
        "The kind of analysis: equilibrium, a motion in time with inertia, natural frequencies about the state that earlier steps lead to, which stays as it is, temperatures alone, or equilibrium and temperatures together",
        "`\"static\"`, `\"dynamic\"`, `\"frequency\"`, `\"heat\"`, `\"coupled\"`",
        default="static",
    )
    loads: Items[Load] = Items(
        Load,
        "Loads, reached linearly over the step unless `table` or `amplitude` says otherwise",
        "list of a table",
        key="load",
    )
    materials: Items[MaterialChange] = Items(
        MaterialChange,
        "Bodies that are made of another material from this step on",
        "list of a table",
        key="material",
    )
    moves: Items[Move] = Items(
        Move,
        "Prescribed motions: a number is reached linearly over the step",
        "list of a table",
        key="move",
    )
    name: Key[str | None, str] = Key("Its name, in results and messages", "text")
    prints: Items[Print] = Items(
        Print,
        "Tables in NAME.dat, in CalculiX's format; absent: those of the step before, [] ends them",
        "list of a table",
        key="print",
    )
    temperatures: Items[Temperature] = Items(
        Temperature,
        "Temperatures, reached linearly over the step, and at once in transient ones; others stay, or are unknown in heat and coupled steps",
        "list of a table",
        key="temperature",
    )
    thermal: Key[Literal["steady", "transient"] | None, Literal["steady", "transient"]] = Key(
        "Of heat and coupled steps: heat in equilibrium, or stored by bodies as time passes; loads and temperatures then act at once unless they have a table or an amplitude",
        "`\"steady\"`, `\"transient\"`",
    )


class Circle(Shape):
    """Of a model in the plane.

    TOML: `surface.shape.circle`.
    """

    _toml = "surface.shape.circle"
    center: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Its centre", "list of number")
    radius: Key[float | None, float] = Key("Its radius", "number > 0.0")
    side: Key[Literal["outside", "inside"], Literal["outside", "inside"]] = Key(
        "Where bodies are",
        "`\"outside\"`, `\"inside\"`",
        default="outside",
    )

    def __init__(
        self,
        *,
        radius: float,
        center: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
        side: Literal["outside", "inside"] | None = None,
    ) -> None:
        super().__init__(center=center, radius=radius, side=side)


class Cone(Shape):
    """A cone without end; bodies are outside.

    TOML: `surface.shape.cone`.
    """

    _toml = "surface.shape.cone"
    apex: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Its tip", "list of number")
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector, from the tip into the cone",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    half_angle: Key[float | None, float] = Key("Between the axis and the surface (degrees)", "number > 0.0, < 90.0")

    def __init__(
        self,
        *,
        axis: Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        half_angle: float,
        apex: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
    ) -> None:
        super().__init__(apex=apex, axis=axis, half_angle=half_angle)


class Cylinder(Shape):
    """A cylinder without ends.

    TOML: `surface.shape.cylinder`.
    """

    _toml = "surface.shape.cylinder"
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector along its axis",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    point: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("A point of its axis", "list of number")
    radius: Key[float | None, float] = Key("Its radius", "number > 0.0")
    side: Key[Literal["outside", "inside"], Literal["outside", "inside"]] = Key(
        "Where bodies are",
        "`\"outside\"`, `\"inside\"`",
        default="outside",
    )

    def __init__(
        self,
        *,
        axis: Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        radius: float,
        point: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
        side: Literal["outside", "inside"] | None = None,
    ) -> None:
        super().__init__(axis=axis, point=point, radius=radius, side=side)


class Plane(Shape):
    """A plane without end; in the plane, a line.

    TOML: `surface.shape.plane`.
    """

    _toml = "surface.shape.plane"
    normal: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector, towards the bodies",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    point: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("A point of it", "list of number")

    def __init__(
        self,
        *,
        normal: Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        point: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
    ) -> None:
        super().__init__(normal=normal, point=point)


class Polynomial(Shape):
    """The curve y = c_n x^n + … + c_0, the same for all z.

    TOML: `surface.shape.polynomial`.
    """

    _toml = "surface.shape.polynomial"
    coefficients: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key(
        "[c_n, …, c_0], the highest power first",
        "list of number",
    )
    side: Key[Literal["above", "below"], Literal["above", "below"]] = Key(
        "Where bodies are",
        "`\"above\"`, `\"below\"`",
        default="above",
    )

    def __init__(
        self,
        *,
        coefficients: Sequence[float] | NDArray[Any],
        side: Literal["above", "below"] | None = None,
    ) -> None:
        super().__init__(coefficients=coefficients, side=side)


class Sphere(Shape):
    """A sphere; in the plane, write `circle`.

    TOML: `surface.shape.sphere`.
    """

    _toml = "surface.shape.sphere"
    center: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Its centre", "list of number")
    radius: Key[float | None, float] = Key("Its radius", "number > 0.0")
    side: Key[Literal["outside", "inside"], Literal["outside", "inside"]] = Key(
        "Where bodies are",
        "`\"outside\"`, `\"inside\"`",
        default="outside",
    )

    def __init__(
        self,
        *,
        radius: float,
        center: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
        side: Literal["outside", "inside"] | None = None,
    ) -> None:
        super().__init__(center=center, radius=radius, side=side)


class Torus(Shape):
    """A ring with a round section.

    TOML: `surface.shape.torus`.
    """

    _toml = "surface.shape.torus"
    axis: Key[Literal["x", "y", "z"] | list[float] | None, Literal["x", "y", "z"] | Sequence[float] | NDArray[Any]] = Key(
        "\"x\", \"y\", \"z\" or a vector along its axis",
        "`\"x\"`, `\"y\"`, `\"z\"` or list of number",
    )
    center: Key[list[float] | None, Sequence[float] | NDArray[Any]] = Key("Its centre", "list of number")
    radius: Key[float | None, float] = Key("From the axis to the middle of the tube", "number > 0.0")
    side: Key[Literal["outside", "inside"], Literal["outside", "inside"]] = Key(
        "Where bodies are",
        "`\"outside\"`, `\"inside\"`",
        default="outside",
    )
    tube: Key[float | None, float] = Key("Radius of the tube", "number > 0.0")

    def __init__(
        self,
        *,
        axis: Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        radius: float,
        tube: float,
        center: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),
        side: Literal["outside", "inside"] | None = None,
    ) -> None:
        super().__init__(axis=axis, center=center, radius=radius, side=side, tube=tube)


class SurfaceShape(Table):
    """What it is: one shape with its numbers.

    TOML: `surface.shape`.
    """

    _toml = "surface.shape"
    circle: One[Circle] = One(Circle, "Of a model in the plane", "a table")
    cone: One[Cone] = One(Cone, "A cone without end; bodies are outside", "a table")
    cylinder: One[Cylinder] = One(Cylinder, "A cylinder without ends", "a table")
    own: Key[str | None, str] = Key("A shape of the program that runs the case, by its name there", "text")
    plane: One[Plane] = One(Plane, "A plane without end; in the plane, a line", "a table")
    polynomial: One[Polynomial] = One(Polynomial, "The curve y = c_n x^n + … + c_0, the same for all z", "a table")
    sphere: One[Sphere] = One(Sphere, "A sphere; in the plane, write `circle`", "a table")
    stl: Key[str | None, str] = Key(
        "Path of a file of triangles, relative to the case; their normals point to the bodies",
        "text",
    )
    torus: One[Torus] = One(Torus, "A ring with a round section", "a table")


class Surface(Table):
    """Rigid surfaces without a mesh, for the primary side of contacts.

    TOML: `surface`.
    """

    _toml = "surface"
    name: Key[str | None, str] = Key("Its name, for `primary`", "text")
    reference: Key[str | None, str] = Key("The [reference] it moves with; absent: fixed in space", "text")
    shape: One[SurfaceShape] = One(SurfaceShape, "What it is: one shape with its numbers", "a table")


class Thickness(Table):
    """Thickness at nodes, of plane bodies and shells with thickness = "field"; of several that name a node the last holds.

    TOML: `thickness`.
    """

    _toml = "thickness"
    on: Key[str | None, str] = Key("The set or group", "text")
    value: Key[float | None, float] = Key("The thickness there (length)", "number > 0.0")


class CaseTable(Table):
    """A contact problem: geometry, materials, bodies, contacts, and what happens step by step.."""

    _toml = ""
    allow: Key[list[str], Sequence[str]] = Key("Codes of warnings to silence", "list of text", default=[])
    amplitudes: Named[Amplitude] = Named(
        Amplitude,
        "Functions of time: linear between rows and constant outside, or of the program",
        "tables by name",
        key="amplitude",
    )
    axes: Items[Axes] = Items(
        Axes,
        "Local axes of nodes, that  local = true  of [[step.print]] prints along; the last that names a node holds",
        "list of a table",
    )
    bodies: Items[Body] = Items(
        Body,
        "Groups of elements that are solids, shells (of elements of the plane, in space), bars (of line elements) or rigid tools",
        "list of a table",
        key="body",
    )
    checkpoint: One[Checkpoint] = One(Checkpoint, "When a run can be resumed from", "a table")
    constants: One[Constants] = One(
        Constants,
        "Constants of nature, in the units of the case: radiation needs them",
        "a table",
    )
    constraints: Items[Constraint] = Items(
        Constraint,
        "Constraints between displacements, for the whole run",
        "list of a table",
        key="constraint",
    )
    contacts: Items[Contact] = Items(Contact, "Pairs of surfaces that may touch", "list of a table", key="contact")
    cycle: Items[Cycle] = Items(Cycle, "Steps that come again and again", "list of a table")
    expects: Items[Expect] = Items(Expect, "Values that are checked at the end", "list of a table", key="expect")
    format: Key[int, int] = Key("Version of the case format", "whole number ≥ 1", default=1)
    initial: One[Initial] = One(Initial, "Fields at the start", "a table")
    mass: Items[Mass] = Items(
        Mass,
        "Masses at nodes, of references and rigid bodies, in dynamic steps, natural modes and by gravity; masses of one node or reference add up",
        "list of a table",
    )
    materials: Named[Material] = Named(Material, "Materials", "tables by name", key="material")
    mesh: One[Mesh] = One(Mesh, "Nodes and elements: a file, or written in place", "a table")
    model: One[Model] = One(Model, "Dimension of the model", "a table")
    orientations: Named[Orientation] = Named(
        Orientation,
        "Axes of materials, of the undeformed body, that bodies name",
        "tables by name",
        key="orientation",
    )
    output: One[Output] = One(Output, "What is written", "a table")
    references: Named[Reference] = Named(
        Reference,
        "Named points with translations and rotations of their own; without `at` and `node` in the mean of the nodes that move with it",
        "tables by name",
        key="reference",
    )
    sets: Named[Set] = Named(Set, "Named sets of nodes, elements or faces", "tables by name")
    solver: One[Solver] = One(Solver, "How equations are solved", "a table")
    springs: Items[Spring] = Items(Spring, "Springs between nodes, or to the ground", "list of a table", key="spring")
    steps: Items[Step] = Items(
        Step,
        "What happens, in order; a step keeps what earlier ones set",
        "list of a table",
        key="step",
    )
    surfaces: Items[Surface] = Items(
        Surface,
        "Rigid surfaces without a mesh, for the primary side of contacts",
        "list of a table",
        key="surface",
    )
    thickness: Items[Thickness] = Items(
        Thickness,
        "Thickness at nodes, of plane bodies and shells with thickness = \"field\"; of several that name a node the last holds",
        "list of a table",
    )
    title: Key[str, str] = Key("What the run is about, for reports", "text", default="")
    units: Key[str, str] = Key(
        "Length-force-stress, as in mm-N-MPa: a label for reports and plausibility; nothing is converted",
        "text",
        default="",
    )


if TYPE_CHECKING:
    BodyKeys = TypedDict("BodyKeys", {
        "area": float,
        "at_nodes": Literal["linear", "element"],
        "capacity": Literal["consistent", "lumped"],
        "integration": Literal["full", "reduced", "raised"],
        "locking": Literal["auto", "none", "b-bar", "f-bar", "incompatible", "selective-shear"],
        "mass_matrix": Literal["auto", "consistent", "lumped"],
        "orientation": str | BodyOrientation | Mapping[str, Any],
        "reference": str,
        "rigid": bool,
        "shell": BodyShell | Mapping[str, Any],
        "space": Literal["plane-strain", "plane-stress", "axisymmetric"],
        "strain": Literal["auto", "small"],
        "temperatures": Literal["full", "linear"],
        "thickness": float | Literal["field"],
    }, total=False)
    ConstraintKeys = TypedDict("ConstraintKeys", {
        "axis": Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        "dofs": Literal["all"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]],
        "equation": Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any],
        "local": ConstraintLocal | Mapping[str, Any],
        "most": float,
        "normal": Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        "point": Sequence[float] | NDArray[Any],
        "reference": str,
        "rhs": float,
        "sectors": int,
        "with_": str,
    }, total=False)
    ContactKeys = TypedDict("ContactKeys", {
        "active": bool,
        "adhesion": ContactAdhesion | Mapping[str, Any],
        "all": bool | Sequence[str],
        "area": Literal["reference", "current", "adjacent", "opposite"],
        "basis": Literal["part", "whole"],
        "cohesive": ContactCohesive | Mapping[str, Any],
        "conductance": float | ContactConductance | Mapping[str, Any],
        "damping": ContactDamping | Mapping[str, Any],
        "enforcement": Literal["auto"] | ContactEnforcement | Mapping[str, Any] | ContactLaw,
        "exclude": Sequence[Any] | NDArray[Any],
        "features": Literal["auto", "faces", "edges"],
        "fluid": ContactFluid | Mapping[str, Any],
        "friction": float | ContactFriction | Mapping[str, Any] | FrictionLimit,
        "friction_heat": bool | ContactFrictionHeat | Mapping[str, Any],
        "friction_history": Literal["place", "traction"],
        "gasket": ContactGasket | Mapping[str, Any],
        "method": Literal["auto", "node-to-node", "node-to-segment", "gauss-point", "mortar"],
        "normals": Literal["primary", "secondary", "nodal"] | Sequence[float] | NDArray[Any],
        "pair": Sequence[ContactPair | Mapping[str, Any]],
        "pairs": Literal["nearest", "order"],
        "passes": int,
        "reach": Literal["auto"] | float,
        "restitution": float,
        "rule": ContactRule | Mapping[str, Any],
        "self_": bool,
        "sliding": Literal["auto", "finite", "increment", "small"],
        "start": ContactStart | Mapping[str, Any],
        "temperature": float,
        "tied": bool | ContactTied | Mapping[str, Any],
        "wear": ContactWear | Mapping[str, Any],
    }, total=False)
    OrientationKeys = TypedDict("OrientationKeys", {
        "axis": Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        "kind": Literal["rectangular", "cylindrical", "elements"],
        "origin": Sequence[float] | NDArray[Any],
        "rows": Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any],
        "turn": Sequence[Any] | NDArray[Any],
        "x": Sequence[float] | NDArray[Any],
        "y": Sequence[float] | NDArray[Any],
    }, total=False)
    SetKeys = TypedDict("SetKeys", {
        "at": float,
        "box": Sequence[Sequence[float] | NDArray[Any]] | NDArray[Any],
        "elements": Sequence[int] | NDArray[Any],
        "faces": Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any],
        "near": Sequence[float] | NDArray[Any],
        "nodes": Sequence[int] | NDArray[Any],
        "of": str,
        "plane": Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        "sphere": Sequence[Any] | NDArray[Any],
        "tol": float,
        "union": Sequence[str],
    }, total=False)
    SpringKeys = TypedDict("SpringKeys", {
        "between": Sequence[str],
        "direction": Literal["x", "y", "z"] | Sequence[float] | NDArray[Any],
        "on": str,
        "stiffness": float,
        "table": Sequence[Sequence[Any] | NDArray[Any]] | NDArray[Any],
    }, total=False)
    PrintKeys = TypedDict("PrintKeys", {
        "contact": Sequence[Literal["gap", "traction", "energy", "count", "force", "normal-force", "shear-force"]],
        "elements": Sequence[Literal["stress", "strain", "mechanical-strain", "plastic-strain", "energy-density", "energy", "volume", "spin-squared", "heat-flux"]],
        "every": int,
        "faces": Sequence[Literal["force"]],
        "local": bool,
        "nodes": Sequence[Literal["displacement", "reaction", "temperature", "heat-reaction"]],
        "totals": Literal["no", "yes", "only"],
    }, total=False)
