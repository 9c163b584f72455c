//! The keys of the constants of laws, each once.

use signorini_vocabulary::{ANY, Key, MANY, NOT_NEGATIVE, POISSON, POSITIVE, Shape, key};

const LIST: Shape = Shape::Either(&[ANY, Shape::List(&ANY, 1, MANY)]);

pub(super) const TEMPERATURES: Key = key(
    "T",
    LIST,
    "temperatures of linear-elastic-by-temperature, increasing",
)
.hints(&["temperature", "temperatures"])
.required();
pub(super) const YOUNG: Key = key(
    "E",
    Shape::Either(&[POSITIVE, Shape::List(&POSITIVE, 1, MANY)]),
    "Young's modulus (stress); at each of the temperatures T",
)
.hints(&["young", "youngs_modulus", "modulus"])
.required();
pub(super) const POISSONS_RATIO: Key = key(
    "nu",
    Shape::Either(&[POISSON, Shape::List(&POISSON, 1, MANY)]),
    "Poisson's ratio; at each of the temperatures T, of each term of hyperfoam",
)
.hints(&["poisson", "poissons_ratio"])
.required();
pub(super) const C10: Key = key("c10", ANY, "constant of mooney-rivlin (stress)").required();
pub(super) const C01: Key = key("c01", ANY, "constant of mooney-rivlin (stress)").required();
pub(super) const SHEAR_MODULI: Key = key(
    "mu",
    LIST,
    "shear moduli of the terms of ogden and hyperfoam (stress)",
)
.required();
pub(super) const EXPONENTS: Key = key(
    "alpha",
    LIST,
    "exponents of the terms of ogden and hyperfoam",
)
.required();
pub(super) const BULK: Key = key("bulk", POSITIVE, "bulk modulus (stress)")
    .hints(&["K", "bulk_modulus"])
    .required();
pub(super) const RESIDUAL: Key = key(
    "residual",
    POSITIVE,
    "stress that is left of the tension of no-tension, of the compression of no-compression (stress)",
)
.required();
pub(super) const REFERENCE_STRESS: Key = key(
    "reference_stress",
    POSITIVE,
    "stress at which the plastic strain of ramberg-osgood is `offset` times the elastic one (stress)",
)
.hints(&["s0", "sigma0"])
.required();
pub(super) const EXPONENT: Key = key(
    "exponent",
    ANY,
    "hardening exponent of ramberg-osgood, at least 1",
)
.hints(&["n"])
.required();
pub(super) const OFFSET: Key = key(
    "offset",
    NOT_NEGATIVE,
    "plastic over elastic strain of ramberg-osgood at its reference stress",
)
.hints(&["yield_offset"])
.required();
pub(super) const E1: Key = key(
    "E1",
    POSITIVE,
    "Young's modulus along the first axis of the material (stress)",
)
.required();
pub(super) const E2: Key = key(
    "E2",
    POSITIVE,
    "Young's modulus along the second axis (stress)",
)
.required();
pub(super) const E3: Key = key(
    "E3",
    POSITIVE,
    "Young's modulus along the third axis (stress)",
)
.required();
pub(super) const NU12: Key = key(
    "nu12",
    ANY,
    "contraction along 2 over stretch along 1, under stress along 1",
)
.required();
pub(super) const NU13: Key = key(
    "nu13",
    ANY,
    "contraction along 3 over stretch along 1, under stress along 1",
)
.required();
pub(super) const NU23: Key = key(
    "nu23",
    ANY,
    "contraction along 3 over stretch along 2, under stress along 2",
)
.required();
pub(super) const G12: Key = key(
    "G12",
    POSITIVE,
    "shear modulus between the axes 1 and 2 (stress)",
)
.required();
pub(super) const G13: Key = key(
    "G13",
    POSITIVE,
    "shear modulus between the axes 1 and 3 (stress)",
)
.required();
pub(super) const G23: Key = key(
    "G23",
    POSITIVE,
    "shear modulus between the axes 2 and 3 (stress)",
)
.required();
pub(super) const STIFFNESS: Key = key(
            "D",
            Shape::List(&ANY, 21, 21),
            "stiffness of anisotropic (stress), upper half by columns: D1111, D1122, D2222, D1133, D2233, D3333, \
             D1112, … D1212, D1113, … D1313, D1123, … D2323",
        )
    .required();
