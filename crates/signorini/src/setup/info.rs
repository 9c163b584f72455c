//! What contacts and references became, for histories and messages.

use super::contact;
use signorini_geometry::surface::RigidId;
use signorini_io::case::{Case, Enforcement, Method};
use signorini_mechanics::model::{CohesionSummary, ContactSummary, StartSummary};

/// What a contact became.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInfo {
    /// Its name.
    pub name: String,
    /// The method in use.
    pub method: &'static str,
    /// Whether the program chose the method, and how penetration is prevented.
    pub automatic: bool,
    /// How penetration is prevented, in words.
    pub enforcement: String,
    /// How far its points slide, in words.
    pub sliding: &'static str,
    /// The penalty in use.
    pub penalty: f64,
    /// Whether the case gives it as a number.
    pub is_given: bool,
    /// What it refers to: `"node"` or `"area"`.
    pub per: &'static str,
    /// Points of the secondary side.
    pub npoint: usize,
    /// Facets of the primary side.
    pub nfacet: usize,
    /// Size of its facets.
    pub facet_size: f64,
    /// Gaps and overlaps at the start.
    pub start: StartSummary,
    /// How its joint breaks; `None`: it does not.
    pub cohesion: Option<CohesionSummary>,
    /// The name that histories have it by: its own, or where nobody names pairs that of all contacts of two bodies.
    pub reported_name: String,
    /// Whether the program found it, where nobody names pairs.
    pub is_found: bool,
}

/// A reference or rigid body, as histories name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReferenceInfo {
    /// Name of the reference, or of the group of the rigid body.
    pub name: String,
    /// Its number.
    pub rigid: RigidId,
}

/// What the contacts of a case became.
pub(super) fn contacts(case: &Case, summaries: &[ContactSummary]) -> Vec<ContactInfo> {
    let one = |summary: &ContactSummary| {
        let own = case
            .contacts
            .iter()
            .filter(|one| one.name.value == summary.name);
        let is_tied = own.clone().any(|one| one.tied.is_some());
        let automatic = own.clone().any(|one| {
            one.tied.is_none()
                && *one.method == Method::Auto
                && one.enforcement == Enforcement::Auto
        });
        let first = own.clone().next();
        let found = first.and_then(|one| one.found.as_ref());
        let is_given =
            first.is_some_and(|one| matches!(one.enforcement, Enforcement::Penalty(Some(_))));
        ContactInfo {
            name: summary.name.clone(),
            method: contact::word(&summary.method),
            automatic,
            enforcement: contact::words(summary),
            sliding: contact::range(summary, is_tied),
            penalty: summary.penalty,
            is_given,
            per: contact::per(summary.measure),
            npoint: summary.npoint,
            nfacet: summary.nfacet,
            facet_size: summary.facet_size,
            start: summary.start,
            cohesion: summary.cohesion,
            reported_name: found.map_or(&summary.name, |found| &found.pair).clone(),
            is_found: found.is_some(),
        }
    };
    summaries.iter().map(one).collect()
}
