//! Temperatures as unknowns: conduction, storage, films and radiation, contact that conducts and rubs, coupled with displacements.
//!
//! SOURCE      closed forms; `shared/reference/thermal`, of independent programs; MOOSE (prescribed pressure)
//! GOAL        heat is what the equations say, in every method of contact; nothing of it is lost; Newton's method has its tangent
//! MESH        bars and blocks of quad4 and hex8, with meshes that do not match
//! CONDITIONS  steady and transient, alone and coupled
//! EXPECTED    see each test
//! TOLERANCE   see each test
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod balance;
mod boxes;
#[path = "../common/mod.rs"]
mod common;
mod contact;
mod decks;
mod pairs;
mod repeat;
mod rods;
mod rubbing;
mod tangent;
mod time;

use boxes::Boxes;
use common::Run;
use signorini_mechanics::system::{Frame, HeatBalance};

/// Runs a case that is solved.
#[track_caller]
fn solved(text: &str) -> (Run, Vec<[f64; 3]>) {
    let mut model = common::model("heat", text, &[]);
    let places = model.mesh.points.iter().map(|x| x.to_array()).collect();
    let run = common::run(&mut model);
    assert!(run.error.is_none(), "{}\n{text}", run.error.unwrap());
    (run, places)
}

/// Temperatures at the nodes of a set.
fn at(frame: &Frame, boxes: &Boxes, set: &str) -> Vec<f64> {
    let nodes = boxes.nodes(set).iter();
    nodes.map(|&node| frame.temperature[node - 1]).collect()
}

/// The heat that supports of temperature bring in, all together and in absolute size.
fn heat_in(frame: &Frame) -> [f64; 2] {
    let of_heat = frame
        .fields
        .iter()
        .find(|field| field.name == "temperature");
    let all = &of_heat.unwrap().reaction;
    [all.iter().sum(), all.iter().map(|q| q.abs()).sum()]
}
