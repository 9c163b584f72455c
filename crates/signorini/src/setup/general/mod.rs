//! Contact without pairs: regions of surfaces that meet, and the contacts they become.
//!
//! ```text
//! bodies ──Skin, Regions──▶ General ──find, at the start and after every increment──▶ pairs of regions ──▶ contacts
//! ```
//!
//! A pair that is found stays. It is a contact as any other, whose sides are regions: what comes near next to a side
//! joins it. What the case says of all contacts and of pairs becomes its settings. Where a run finds a pair, the model is
//! built again with it: see [`crate::run`]. The regions depend on the mesh, on supports and on names alone, so that their numbers mean the same in
//! every process.

mod contacts;
mod pair;
mod source;

pub(crate) use pair::Pair;
pub(super) use source::Source;

use super::origin::Origin;
use pair::{Touch, sorted};
use signorini_geometry::surface::ContactSurface;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, ANY, Excluded, Name};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::facing::{Facing, Finder, Meeting, Regions, secondary};
use source::{Known, Side, Wall, has, pairs_of};
use std::collections::{BTreeMap, BTreeSet};

/// The part of the size of a facet and of the thickness behind it that may pass between two looks.
const PASSES: f64 = 0.25;

/// Looks at one increment at most.
const LOOKS: f64 = 100.0;

/// What meets, where nobody names pairs.
pub(crate) struct General {
    settings: case::General,
    finder: Finder,
    regions: Regions,
    /// What each region is of.
    sides: Vec<Side>,
    /// The body of each facet: what shares nodes, or did before it was cut.
    body: Vec<u32>,
    /// The names of what regions are of, in their order.
    labels: Vec<String>,
    /// Of each name in the settings, the facets that it means.
    meant: BTreeMap<String, Vec<bool>>,
    /// Sides of contacts that the case names.
    named: Vec<[Vec<bool>; 2]>,
    /// Bodies and rigid surfaces without a mesh, which are contacts from the start on, by points inside facets: all of the
    /// body is one side, and nodes of its edges would stand for facets that face elsewhere, too.
    walls: Vec<Wall>,
    /// The pairs in the order in which they were found.
    pairs: Vec<Pair>,
    /// What the model was built from.
    pub(super) origin: Origin,
}

/// What a look at a way of all nodes finds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Births {
    /// What meets and did not before: first faces, then edges and corners.
    pub pairs: Vec<Birth>,
    /// Whether some of these are inside one another already.
    pub is_inside: bool,
}

/// Two regions that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Birth {
    /// The one that would be secondary first.
    pub regions: [u32; 2],
    /// By what.
    pub touch: Touch,
}

impl General {
    /// What may meet in a model; nothing is found yet.
    pub(super) fn new(
        settings: &case::General,
        source: &Source<'_>,
        origin: Origin,
        found: &mut Diagnostics,
    ) -> Option<Self> {
        let mut known = Known::new(source);
        let skin = match known.skin(source) {
            Ok(skin) => skin,
            Err(error) => {
                let place = &settings.common.place;
                found.push(Diagnostic::error(&codes::BAD_SURFACE, error.to_string()).at(place, ""));
                return None;
            }
        };
        let facets = skin.facets();
        let meant = source.meant_by(settings, facets, found);
        let named = source.sides_of_contacts(facets);
        let body = known.number(source, &skin);
        // what differs in anything that is asked of a region is in different regions
        let mut kinds: BTreeMap<(u32, bool, Vec<bool>), u32> = BTreeMap::new();
        let kind = (0..facets.nfacet() as u32).map(|facet| {
            let side = known.side(source, &skin, &body, facet);
            let names = meant.values().map(|flags: &Vec<bool>| has(flags, facet));
            let next = kinds.len() as u32;
            let kind = (side.label, side.is_led, names.collect());
            *kinds.entry(kind).or_insert(next)
        });
        let kind: Vec<u32> = kind.collect();
        let kind = |facet: u32| kind.get(facet as usize).copied().unwrap_or(u32::MAX);
        let regions = Regions::new(&skin, &source.mesh.points, kind);
        let first = |region: u32| regions.facets(region).first().copied().unwrap_or(u32::MAX);
        let sides = (0..regions.count() as u32).map(first);
        let sides = sides
            .map(|facet| known.side(source, &skin, &body, facet))
            .collect();
        let mut general = Self {
            settings: settings.clone(),
            sides,
            body,
            labels: known.names,
            meant,
            named,
            walls: Vec::new(),
            pairs: Vec::new(),
            regions,
            finder: Finder::new(skin),
            origin,
        };
        general.walls = general.against_surfaces(source.case);
        Some(general)
    }

    /// Whether a name is that of a pair that may be found: `plate-bolt`.
    pub fn may_be_called(&self, name: &str) -> bool {
        let first = self.labels.iter().enumerate();
        let mut rest = first.filter_map(|(at, label)| {
            let second = name.strip_prefix(label.as_str())?.strip_prefix('-')?;
            self.labels.get(at..).map(|later| (second, later))
        });
        rest.any(|(second, later)| later.iter().any(|label| label == second))
    }

    /// Finds what meets at the start, where nodes are at `x`.
    pub fn start(&mut self, x: &[Vec3]) {
        let births = self.look(x, x);
        self.pairs = self.with(&births.pairs);
    }

    /// Takes pairs that were found before; says whether they are pairs of this model.
    pub fn take(&mut self, pairs: &[Pair]) -> bool {
        let is_known = |region: &u32| (*region as usize) < self.regions.count();
        self.pairs = pairs.to_vec();
        let mut sides = pairs.iter().flat_map(|pair| &pair.sides);
        sides.all(|side| !side.is_empty() && side.iter().all(is_known))
    }

    /// What meets on the straight way of all nodes from one place to another, at its end or within reach of going on
    /// like that.
    pub fn look(&mut self, from: &[Vec3], to: &[Vec3]) -> Births {
        let way: Vec<Vec3> = to.iter().zip(from).map(|(to, from)| *to - *from).collect();
        let nlook = self.nlook(&way);
        let of_pair = |pair: &Pair| -> Vec<[u32; 2]> {
            let [one, other] = &pair.sides;
            pairs_of(one, other)
                .map(|(a, b)| sorted([*a, *b]))
                .collect()
        };
        let known: BTreeSet<[u32; 2]> = self.pairs.iter().flat_map(of_pair).collect();
        let mut births: BTreeMap<[u32; 2], Meeting> = BTreeMap::new();
        let motion: Vec<Vec3> = way.iter().map(|v| *v / nlook as f64).collect();
        for look in 1..=nlook {
            let left = (nlook - look) as f64;
            let at: Vec<Vec3> = to
                .iter()
                .zip(&motion)
                .map(|(x, v)| *x - *v * left)
                .collect();
            self.finder.find(&at, &motion);
            for met in self.regions.meetings(&self.wanted()) {
                if self.may_meet(&met) && !known.contains(&met.regions) {
                    let before = births.remove(&met.regions);
                    let least = before.map_or(f64::INFINITY, |before| before.gap[0]);
                    let gap = [least.min(met.gap[0]), met.gap[1]];
                    births.insert(met.regions, Meeting { gap, ..met });
                }
            }
        }
        let mut births: Vec<Meeting> = births.into_values().collect();
        births.sort_by_key(|met| {
            let labels = sorted(met.regions.map(|region| self.label(region)));
            (met.sharp != [false; 2], labels, met.regions)
        });
        Births {
            is_inside: births.iter().any(|met| met.gap[0] < 0.0),
            pairs: births.iter().map(|met| self.birth(to, met)).collect(),
        }
    }

    /// What meets, where nodes are at `x`. Nodes of edges are secondary, whatever else would decide.
    fn birth(&self, x: &[Vec3], met: &Meeting) -> Birth {
        let [a, b] = met.regions;
        let regions = self.with_roles(x, met);
        let is_named = |own: &case::GeneralPair| {
            own.secondary.is_some() && self.is_between(own, met.regions).is_some()
        };
        let edge = match met.sharp {
            [true, false] => Some([a, b]),
            [false, true] => Some([b, a]),
            _ => None,
        };
        let (regions, touch) = match edge {
            _ if met.sharp == [false; 2] => (regions, Touch::Faces),
            Some(edge) if edge == regions || !self.settings.pairs.iter().any(is_named) => {
                (edge, Touch::Edge)
            }
            _ => (regions, Touch::Edges),
        };
        Birth { regions, touch }
    }

    /// A pair with the secondary region first, where nodes are at `x`: that which the case says, or by the standing of the
    /// facets that meet. Where nothing differs, it is that of the later body.
    fn with_roles(&self, x: &[Vec3], met: &Meeting) -> [u32; 2] {
        let skin = self.finder.skin();
        let [(a, of_a), (b, of_b)] = {
            let [one, other] = met.regions;
            let [live, of_other] = &met.live;
            match self.label(one) <= self.label(other) {
                true => [(one, live), (other, of_other)],
                false => [(other, of_other), (one, live)],
            }
        };
        let pair = [a, b];
        let standing = [(a, of_a), (b, of_b)].map(|(region, live)| {
            let side = self.side(region);
            let (is_led, modulus) = side.map_or((true, 0.0), |side| (side.is_led, side.modulus));
            skin.standing(x, live, is_led, modulus)
        });
        let mut is_first = secondary(standing) == 0;
        for own in &self.settings.pairs {
            if let (Some(in_order), Some(name)) = (self.is_between(own, pair), &own.secondary) {
                is_first = (name.value == own.between[0].value) == in_order;
            }
        }
        if is_first { [a, b] } else { [b, a] }
    }

    /// How often to look, so that nothing passes through a body in between.
    fn nlook(&self, way: &[Vec3]) -> usize {
        let skin = self.finder.skin();
        let most = |facet: u32| {
            let nodes = skin.facets().nodes(facet).iter();
            let of = nodes.filter_map(|&node| way.get(node as usize));
            let far = of.map(|v| v.norm()).fold(0.0, f64::max);
            let at = facet as usize;
            let size = skin.size().get(at).zip(skin.thickness().get(at));
            size.map_or(0.0, |(size, thickness)| {
                far / (PASSES * size.min(*thickness))
            })
        };
        let all = (0..skin.facets().nfacet() as u32)
            .map(most)
            .fold(0.0, f64::max);
        // counts that are no number are none
        all.ceil().clamp(1.0, LOOKS) as usize
    }

    /// What the last look found, but for what the case excludes or names itself.
    fn wanted(&self) -> Vec<Facing> {
        let all = self.finder.found().iter().copied();
        all.filter(|one| self.is_wanted(one)).collect()
    }

    fn is_wanted(&self, one: &Facing) -> bool {
        let (a, b) = (one.facet, one.other);
        let is_own = self.body.get(a as usize) == self.body.get(b as usize);
        if is_own && !self.settings.with_itself {
            return false;
        }
        let is = |name: &Name, facet: u32| self.means(name, facet);
        let of = &self.settings.of;
        if !of.is_empty() && ![a, b].iter().all(|&f| of.iter().any(|name| is(name, f))) {
            return false;
        }
        let excludes = |(one, other): &Excluded| match other {
            None => is(one, a) || is(one, b),
            Some(other) => is(one, a) && is(other, b) || is(one, b) && is(other, a),
        };
        let names = |[one, other]: &[Vec<bool>; 2]| {
            has(one, a) && has(other, b) || has(one, b) && has(other, a)
        };
        !self.settings.exclude.iter().any(excludes) && !self.named.iter().any(names)
    }

    fn means(&self, name: &Name, facet: u32) -> bool {
        name.value == ANY
            || self
                .meant
                .get(&name.value)
                .is_some_and(|flags| has(flags, facet))
    }

    /// Two regions that cannot follow cannot make way for each other.
    fn may_meet(&self, met: &Meeting) -> bool {
        let is_led = |region: &u32| self.side(*region).is_none_or(|side| side.is_led);
        !met.regions.iter().all(is_led)
    }

    fn side(&self, region: u32) -> Option<&Side> {
        self.sides.get(region as usize)
    }

    fn label(&self, region: u32) -> u32 {
        self.side(region).map_or(u32::MAX, |side| side.label)
    }

    /// What a pair of regions is called without a number, and whether its regions are in the order of that name.
    fn name(&self, [a, b]: [u32; 2]) -> (String, bool) {
        let name = |region| {
            self.labels
                .get(self.label(region) as usize)
                .map_or("", String::as_str)
        };
        let in_order = self.label(a) <= self.label(b);
        let [first, second] = if in_order { [a, b] } else { [b, a] };
        (format!("{}-{}", name(first), name(second)), in_order)
    }
}
