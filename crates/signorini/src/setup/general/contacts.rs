//! From pairs to contacts.

use super::pair::{Pair, Touch, sorted};
use super::source::{Side, Wall, has};
use super::{Birth, General};
use crate::setup::names::Names;
use signorini_geometry::mesh::Face;
use signorini_geometry::surface::ContactSurface;
use signorini_io::case::{
    self, ANY, Case, Contact, Enforcement, Excluded, Features, Found, Method, Name, SELF,
};
use signorini_io::diagnostic::Spanned;
use std::collections::{BTreeMap, BTreeSet};

/// A contact with the names and faces of its sides.
struct FoundContact {
    contact: Contact,
    sides: Vec<(String, Vec<Face>)>,
}

impl General {
    /// The pairs in the order in which they were found.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The pairs with regions that meet from now on. A region that is next to a side of a pair, and meets its other side,
    /// becomes a part of that side: nodes near the edge between the two have one row, and it is that of the better facet.
    /// Bodies that meet by faces anywhere do so everywhere: only where edges and corners alone meet are they points.
    pub fn with(&self, births: &[Birth]) -> Vec<Pair> {
        let mut pairs = self.pairs.clone();
        for birth in births {
            let [a, b] = birth.regions;
            let is_fold = a == b;
            let fits = |side: &[u32], region: u32| {
                side.contains(&region) || side.iter().any(|one| self.are_next(*one, region))
            };
            let joins = |pair: &Pair| {
                let [secondary, primary] = &pair.sides;
                let is_in = |a: &u32, b: &u32| secondary.contains(a) || primary.contains(b);
                let in_order = is_in(&a, &b) && fits(secondary, a) && fits(primary, b);
                let turned = is_in(&b, &a) && fits(secondary, b) && fits(primary, a);
                // sides that share nodes are none of one contact
                let touches = |side: &[u32], region: u32| {
                    side.iter()
                        .any(|one| *one == region || self.are_next(*one, region))
                };
                let is_apart = |a: u32, b: u32| !touches(secondary, b) && !touches(primary, a);
                match (is_fold || secondary == primary, in_order, turned) {
                    (false, true, _) if is_apart(a, b) => Some([a, b]),
                    (false, _, true) if is_apart(b, a) => Some([b, a]),
                    _ => None,
                }
            };
            let found = pairs.iter_mut().find_map(|pair| Some((joins(pair)?, pair)));
            match found {
                None => pairs.push(Pair {
                    sides: [vec![a], vec![b]],
                    touch: birth.touch,
                }),
                Some((regions, pair)) => {
                    if pair.touch != Touch::Faces && birth.touch != Touch::Faces {
                        let is_turned = regions != birth.regions;
                        pair.touch = match is_turned {
                            true => Touch::Edges,
                            false => pair.touch.max(birth.touch),
                        };
                    }
                    for (side, region) in pair.sides.iter_mut().zip(regions) {
                        if let Err(at) = side.binary_search(&region) {
                            side.insert(at, region);
                        }
                    }
                }
            }
        }
        let bodies = |[a, b]: [u32; 2]| sorted([self.label(a), self.label(b)]);
        let met = births
            .iter()
            .filter(|birth| birth.touch == Touch::Faces)
            .map(|birth| birth.regions);
        let known = self.pairs.iter().filter(|pair| pair.touch == Touch::Faces);
        let by_faces = met.chain(known.map(Pair::first)).map(bodies);
        let by_faces: BTreeSet<[u32; 2]> = by_faces.collect();
        for pair in &mut pairs {
            if by_faces.contains(&bodies(pair.first())) {
                pair.touch = Touch::Faces;
            }
        }
        pairs
    }

    /// Whether facets of two regions share nodes.
    fn are_next(&self, a: u32, b: u32) -> bool {
        let facets = self.finder.skin().facets();
        let mut near = self
            .regions
            .facets(a)
            .iter()
            .flat_map(|f| facets.neighbours(*f));
        near.any(|&facet| self.regions.of(facet) == Some(b))
    }

    /// All bodies with the rigid surfaces that they may touch and that no contact names for them.
    pub(super) fn against_surfaces(&self, case: &Case) -> Vec<Wall> {
        let skin = self.finder.skin();
        let mut walls = Vec::new();
        for (label, body) in (0..).zip(&self.labels) {
            let own = (0..)
                .zip(&self.sides)
                .filter(|(_, side): &(u32, &Side)| side.label == label && !side.is_led);
            let facets: Vec<u32> = own
                .flat_map(|(region, _)| self.regions.facets(region).iter().copied())
                .filter(|&facet| skin.takes_part(facet))
                .collect();
            for surface in &case.surfaces {
                let name = &surface.name;
                let is_named = |facet: u32| {
                    let mut contacts = case.contacts.iter().zip(&self.named);
                    contacts.any(|(contact, [side, _])| {
                        contact.primary.value == name.value && has(side, facet)
                    })
                };
                let may = |facet: &u32| self.may_touch(*facet, name) && !is_named(*facet);
                let facets: Vec<u32> = facets.iter().copied().filter(may).collect();
                if !facets.is_empty() {
                    walls.push(Wall {
                        body: body.clone(),
                        surface: name.value.clone(),
                        facets,
                    });
                }
            }
        }
        walls
    }

    /// Whether a facet may touch a rigid surface.
    fn may_touch(&self, facet: u32, surface: &Name) -> bool {
        let is = |name: &Name| self.means(name, facet);
        let is_it = |name: &Name| name.value == surface.value || name.value == ANY;
        let of = &self.settings.of;
        let is_listed = of.is_empty() || (of.iter().any(is) && of.iter().any(is_it));
        let excludes = |(one, other): &Excluded| match other {
            None => is(one) || one.value == surface.value,
            Some(other) => is(one) && is_it(other) || is(other) && is_it(one),
        };
        is_listed && !self.settings.exclude.iter().any(excludes)
    }

    /// Hands the contacts over to the case, and the faces of their sides to the names.
    pub(in crate::setup) fn hand_over(&self, case: &mut Case, names: &mut Names<'_>) {
        for one in self.contacts() {
            case.contacts.push(one.contact);
            one.sides.into_iter().for_each(|side| names.add_faces(side));
        }
    }

    /// The contacts with rigid surfaces and of all pairs, each with the faces of its sides.
    fn contacts(&self) -> Vec<FoundContact> {
        let mut count: BTreeMap<String, usize> = BTreeMap::new();
        let contact = |pair: &Pair| {
            let [a, b] = pair.first();
            let (name, in_order) = self.name([a, b]);
            let number = count.entry(name.clone()).or_insert(0);
            *number += 1;
            let own = match *number {
                1 => name.clone(),
                number => format!("{name}#{number}"),
            };
            let found = Found {
                pair: name,
                is_reversed: !in_order,
            };
            self.contact(pair, &own, found)
        };
        let walls = self.walls.iter().map(|wall| self.against(wall));
        walls.chain(self.pairs.iter().map(contact)).collect()
    }

    /// What all contacts have in common, with what is different for some.
    fn with_settings(&self, is_meant: impl Fn(&case::GeneralPair) -> bool) -> Contact {
        let mut contact = self.settings.common.clone();
        for own in self.settings.pairs.iter().filter(|own| is_meant(own)) {
            if let Some(friction) = &own.friction {
                contact.friction.clone_from(friction);
            }
            if let Some((enforcement, per)) = &own.enforcement {
                (contact.enforcement, contact.per) = (enforcement.clone(), *per);
            }
            if let Some(method) = &own.method {
                contact.method = method.clone();
            }
            if let Some(start) = &own.start {
                contact.start = start.clone();
            }
        }
        contact
    }

    fn against(&self, wall: &Wall) -> FoundContact {
        let first = wall.facets.first().copied().unwrap_or(u32::MAX);
        let is_body = |name: &Name| self.means(name, first);
        let is_wall = |name: &Name| name.value == wall.surface || name.value == ANY;
        let mut contact = self.with_settings(|own| {
            let [one, other] = &own.between;
            is_body(one) && is_wall(other) || is_body(other) && is_wall(one)
        });
        if matches!(*contact.method, Method::Auto | Method::Mortar) {
            // mortar compares two surfaces of solids; nodes of edges would stand for facets that face elsewhere, too
            contact.method = Method::GaussPoint.into();
        }
        let side = format!("{}/skin", wall.body);
        let named = |name: &str| Spanned::new(name.to_owned(), contact.place.clone());
        let own = format!("{}-{}", wall.body, wall.surface);
        [contact.name, contact.secondary, contact.primary] =
            [&*own, &*side, &*wall.surface].map(named);
        contact.found = Some(Found {
            pair: own,
            is_reversed: false,
        });
        let facets = self.finder.skin().facets();
        let faces = wall.facets.iter().filter_map(|&facet| facets.face(facet));
        FoundContact {
            contact,
            sides: vec![(side, faces.collect())],
        }
    }

    fn contact(&self, pair: &Pair, name: &str, found: Found) -> FoundContact {
        let facets = self.finder.skin().facets();
        let first = pair.first();
        let mut contact = self.with_settings(|own| self.is_between(own, first).is_some());
        if pair.touch != Touch::Faces {
            by_points(&mut contact, pair.touch);
        }
        let side = |regions: &Vec<u32>| {
            let label = regions
                .first()
                .map_or(u32::MAX, |region| self.label(*region));
            let label = self.labels.get(label as usize).map_or("", String::as_str);
            let numbers: Vec<String> = regions.iter().map(u32::to_string).collect();
            let faces = regions
                .iter()
                .flat_map(|region| self.regions.facets(*region));
            let faces = faces.filter_map(|&facet| facets.face(facet)).collect();
            (format!("{label}/{}", numbers.join("+")), faces)
        };
        let [secondary, primary] = pair.sides.each_ref().map(side);
        let named = |name: &str| Spanned::new(name.to_owned(), contact.place.clone());
        let is_fold = secondary.0 == primary.0;
        let sides = [
            name,
            &*secondary.0,
            if is_fold { SELF } else { &*primary.0 },
        ];
        [contact.name, contact.secondary, contact.primary] = sides.map(named);
        contact.found = Some(found);
        FoundContact {
            contact,
            sides: vec![secondary, primary],
        }
    }

    /// Whether a setting of pairs is about two regions; then, whether its first name is that of the first.
    pub(super) fn is_between(&self, own: &case::GeneralPair, pair: [u32; 2]) -> Option<bool> {
        let first = |region: u32| self.regions.facets(region).first().copied();
        let [a, b] = [first(pair[0])?, first(pair[1])?];
        let [one, other] = &own.between;
        let is = |name: &Name, facet: u32| self.means(name, facet);
        if is(one, a) && is(other, b) {
            Some(true)
        } else {
            (is(one, b) && is(other, a)).then_some(false)
        }
    }
}

/// Lets nodes of the side with the edges rest on faces and edges of the other, and of both where both have them, unless the case
/// names a method: an edge or a corner between the nodes of the other side is not felt by means over its facets. Multipliers are
/// for the nodes of one side alone.
fn by_points(contact: &mut Contact, touch: Touch) {
    if *contact.method == Method::Auto {
        contact.method = Method::NodeToSegment.into();
        contact.features = Features::Edges;
        let by_penalty = matches!(
            contact.enforcement,
            Enforcement::Auto | Enforcement::Penalty(_)
        );
        contact.two_pass = by_penalty && touch == Touch::Edges;
    }
}
