//! The whole case.

use super::bodies::{BODY, CONSTRAINT, MASS, MATERIAL, NAMED_ORIENTATION, SPRING};
use super::contact::CONTACT;
use super::geometry::{AXES, CONSTANTS, INITIAL, MESH, MODEL, REFERENCE, SET, THICKNESS};
use super::run::{CHECKPOINT, CYCLE, EXPECT, OUTPUT, SOLVER};
use super::steps::{AMPLITUDE, STEP};
use super::surface::SURFACE;
use super::*;

/// The whole case, without the kinds of things that other rooms describe.
pub(super) static CASE: Table = Table {
    heading: "the case",
    doc: "A contact problem: geometry, materials, bodies, contacts, and what happens step by step.",
    keys: &[
        key("format", Shape::Integer(1, i64::MAX), "version of the case format").or(Default::Integer(1)),
        key("title", Shape::Text, "what the run is about, for reports").or(Default::Text("")),
        key("units", Shape::Text, "length-force-stress, as in mm-N-MPa: a label for reports and plausibility; nothing is converted")
            .or(Default::Text("")),
        key("allow", Shape::List(&Shape::Text, 0, MANY), "codes of warnings to silence").or(Default::Texts(&[])),
        key("mesh", Shape::Table(&MESH), MESH.doc).required(),
        key("model", Shape::Table(&MODEL), MODEL.doc),
        key("sets", Shape::Named(&SET), SET.doc).hints(&["set"]),
        key("reference", Shape::Named(&REFERENCE), REFERENCE.doc).hints(&["references", "point"]),
        key("axes", Shape::Tables(&AXES), AXES.doc).hints(&["transform"]),
        key("amplitude", Shape::Named(&AMPLITUDE), AMPLITUDE.doc).hints(&["amplitudes"]),
        key("material", Shape::Named(&MATERIAL), MATERIAL.doc).hints(&["materials"]),
        key("orientation", Shape::Named(&NAMED_ORIENTATION), NAMED_ORIENTATION.doc).hints(&["orientations"]),
        key("body", Shape::Tables(&BODY), BODY.doc).hints(&["bodies", "part", "section"]),
        key("thickness", Shape::Tables(&THICKNESS), THICKNESS.doc),
        key("mass", Shape::Tables(&MASS), MASS.doc).hints(&["masses"]),
        key("surface", Shape::Tables(&SURFACE), SURFACE.doc).hints(&["surfaces"]),
        key("contact", Shape::Tables(&CONTACT), CONTACT.doc).hints(&["contacts", "pair", "interface"]),
        key("spring", Shape::Tables(&SPRING), SPRING.doc).hints(&["springs"]),
        key("constraint", Shape::Tables(&CONSTRAINT), CONSTRAINT.doc)
            .hints(&["constraints", "coupling", "equation", "mpc", "tie"]),
        key("constants", Shape::Table(&CONSTANTS), CONSTANTS.doc),
        key("initial", Shape::Table(&INITIAL), INITIAL.doc),
        key("step", Shape::Tables(&STEP), STEP.doc).required().hints(&["steps"]),
        key("cycle", Shape::Tables(&CYCLE), CYCLE.doc).hints(&["cycles", "repeat"]),
        key("solver", Shape::Table(&SOLVER), SOLVER.doc),
        key("output", Shape::Table(&OUTPUT), OUTPUT.doc).hints(&["results"]),
        key("checkpoint", Shape::Table(&CHECKPOINT), CHECKPOINT.doc).hints(&["restart"]),
        key("expect", Shape::Tables(&EXPECT), EXPECT.doc).hints(&["check", "test"]),
    ],
    rules: &[Rule::AtLeastOne(&["body", "spring"])],
};
