//! What surfaces see of themselves, against labels of the geometry: no facet that cannot be touched, and none missed.

use super::{facets_of, with_mid_nodes};
use crate::contact::closest_points;
use crate::contact::discretization::{
    Discretization, FacetSizes, OwnBody, PointToSegment, REACH, SurfacePair,
};
use signorini_geometry::element::quadrature;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Feature, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A closed line round a body, its inside to the left; every segment has a label.
pub(super) struct Outline {
    pub at: Vec<[f64; 2]>,
    pub label: Vec<usize>,
}

/// Bodies of which everything is skin, and which labels may touch one another.
pub(super) struct Skin {
    pub name: &'static str,
    pub outlines: Vec<Outline>,
    pub may_touch: fn(usize, usize) -> bool,
    /// Whether some do.
    pub touches: bool,
    /// Whether all outlines bound one body.
    pub hollow: bool,
}

pub(super) const NEVER: fn(usize, usize) -> bool = |_, _| false;

/// The line through these corners, in segments of about the length `h`; the segment from corner `k` has the label `k`.
fn polygon(corners: &[[f64; 2]], h: f64) -> Outline {
    let labels: Vec<usize> = (0..corners.len()).collect();
    labelled(corners, &labels, h)
}

fn labelled(corners: &[[f64; 2]], labels: &[usize], h: f64) -> Outline {
    let mut outline = Outline {
        at: Vec::new(),
        label: Vec::new(),
    };
    for (k, &[ax, ay]) in corners.iter().enumerate() {
        let [bx, by] = corners[(k + 1) % corners.len()];
        let n = ((bx - ax).hypot(by - ay) / h).ceil().max(1.0);
        for i in 0..n as usize {
            let s = i as f64 / n;
            outline.at.push([ax + s * (bx - ax), ay + s * (by - ay)]);
            outline.label.push(labels[k]);
        }
    }
    outline
}

pub(super) fn rectangle([x, y]: [f64; 2], [w, t]: [f64; 2], h: f64, first: usize) -> Outline {
    let corners = [[x, y], [x + w, y], [x + w, y + t], [x, y + t]];
    labelled(&corners, &[first, first + 1, first + 2, first + 3], h)
}

/// A strip of this thickness to the left of a line of `n` places: 0 on the line, 1 and 3 at the ends, 2 on the left.
fn strip(
    n: usize,
    thickness: f64,
    line: impl Fn(f64) -> [f64; 2],
    label: impl Fn(f64, usize) -> usize,
) -> Outline {
    let along = |k: usize| k as f64 / n as f64;
    let normal = |s: f64| {
        let (a, b) = (line(s - 1e-5), line(s + 1e-5));
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let d = dx.hypot(dy);
        [-dy / d, dx / d]
    };
    let mut outline = Outline {
        at: Vec::new(),
        label: Vec::new(),
    };
    for k in 0..=n {
        outline.at.push(line(along(k)));
        let middle = (k as f64 + 0.5) / n as f64;
        outline.label.push(if k < n {
            label(middle, 0)
        } else {
            label(1.0, 1)
        });
    }
    for k in (0..=n).rev() {
        let ([x, y], [nx, ny]) = (line(along(k)), normal(along(k)));
        outline.at.push([x + thickness * nx, y + thickness * ny]);
        let middle = (k as f64 - 0.5) / n as f64;
        outline.label.push(if k > 0 {
            label(middle, 2)
        } else {
            label(0.0, 3)
        });
    }
    outline
}

/// A hairpin of two legs of the length 6, `gap` apart inside of the bend; 10 and 20 are the insides of the legs.
fn hairpin(thickness: f64, gap: f64, n: usize) -> Outline {
    let (r, leg) = (0.5 * gap, 6.0);
    let length = 2.0 * leg + PI * r;
    let line = move |s: f64| {
        let s = s * length;
        if s < leg {
            [leg - s, -r]
        } else if s > leg + PI * r {
            [s - leg - PI * r, r]
        } else {
            let phi = -0.5 * PI - (s - leg) / r;
            [r * phi.cos(), r * phi.sin()]
        }
    };
    strip(n, thickness, line, move |s, side| match side {
        0 if s * length < leg => 10,
        0 if s * length > leg + PI * r => 20,
        0 => 30,
        side => side,
    })
}

/// A spiral of some turns, `gap` between them: labels give inside (1) or outside (2), and the turn.
fn spiral(thickness: f64, gap: f64, n: usize) -> Outline {
    let (turns, pitch) = (3.0, thickness + gap);
    let line = move |s: f64| {
        let phi = TAU * turns * s;
        let r = 2.0 + pitch * phi / TAU;
        [r * phi.cos(), -r * phi.sin()]
    };
    // running clockwise, the outside is on the left
    strip(n, thickness, line, move |s, side| {
        let turn = (turns * s).floor() as usize;
        match side {
            0 => 100 + turn,
            2 => 200 + turn,
            _ => side,
        }
    })
}

/// A tube that is pressed flat: 1 outside, 2 inside.
fn tube(thickness: f64, gap: f64, n: usize) -> [Outline; 2] {
    let flat = |a: f64, b: f64, label: usize, way: f64| {
        let place = |k: usize| {
            let phi = way * TAU * (k as f64 + 0.3) / n as f64;
            let (s, c) = phi.sin_cos();
            // a flattened circle: long sides that are nearly straight
            [
                a * c.signum() * c.abs().powf(0.8),
                b * s.signum() * s.abs().powf(0.4),
            ]
        };
        Outline {
            at: (0..n).map(place).collect(),
            label: vec![label; n],
        }
    };
    let (a, b) = (3.0, 0.5 * gap);
    [
        flat(a + thickness, b + thickness, 1, 1.0),
        flat(a, b, 2, -1.0),
    ]
}

impl Skin {
    /// Outlines that touch nothing.
    fn apart(name: &'static str, outlines: Vec<Outline>) -> Self {
        Self {
            touches: false,
            ..Self::touching(name, outlines, NEVER)
        }
    }

    /// Outlines that touch where two labels may.
    fn touching(
        name: &'static str,
        outlines: Vec<Outline>,
        may_touch: fn(usize, usize) -> bool,
    ) -> Self {
        Self {
            name,
            outlines,
            may_touch,
            touches: true,
            hollow: false,
        }
    }
}

fn skins(h: f64) -> Vec<Skin> {
    let n = |length: f64| (length / h).ceil() as usize;
    vec![
        Skin::apart(
            "convex block",
            vec![rectangle([0.0, 0.0], [4.0, 1.0], h, 0)],
        ),
        Skin::apart(
            "plate thinner than its facets",
            vec![rectangle([0.0, 0.0], [6.0, 0.1], h, 0)],
        ),
        Skin::apart(
            "wedge",
            vec![polygon(&[[0.0, 0.0], [5.0, 0.0], [5.0, 0.7]], h)],
        ),
        Skin::apart(
            "bent beam",
            vec![strip(
                n(12.0),
                0.25,
                |s| [4.0 * (-4.0 * s).cos(), 4.0 * (-4.0 * s).sin()],
                |_, side| side,
            )],
        ),
        Skin::touching(
            "two blocks",
            vec![
                rectangle([0.0, 0.0], [4.0, 1.0], h, 0),
                rectangle([1.1, 1.05], [1.7, 0.6], 0.7 * h, 10),
            ],
            |a, b| a.min(b) == 2 && a.max(b) == 10,
        ),
        Skin::touching(
            "sheets that overlap or not",
            [0.0, 0.21, 0.40, 0.55, 0.78]
                .iter()
                .enumerate()
                .map(|(k, &y)| rectangle([0.1 * k as f64, y], [5.0, 0.2], h, 10 * k))
                .collect(),
            |a, b| {
                let (a, b) = (a.min(b), a.max(b));
                a / 10 + 1 == b / 10 && a % 10 == 2 && b % 10 == 0
            },
        ),
        Skin::touching(
            "folded sheet",
            vec![hairpin(0.15, 0.18, 5 * n(13.0))],
            |a, b| [10, 20, 30].contains(&a) && [10, 20, 30].contains(&b),
        ),
        Skin::touching("spiral", vec![spiral(0.15, 0.1, n(45.0))], |a, b| {
            a / 100 + b / 100 == 3 && a / 100 != b / 100
        }),
        Skin {
            hollow: true,
            ..Skin::touching(
                "tube pressed flat",
                tube(0.2, 0.25, n(14.0)).into(),
                |a, b| a == 2 && b == 2,
            )
        },
        // a thin C: its lips face each other across a slit
        Skin::touching(
            "box with lips",
            vec![labelled(
                &[
                    [0.0, 0.0],
                    [3.0, 0.0],
                    [3.0, 1.0],
                    [1.6, 1.0],
                    [1.6, 0.9],
                    [2.9, 0.9],
                    [2.9, 0.1],
                    [0.1, 0.1],
                    [0.1, 0.9],
                    [1.5, 0.9],
                    [1.5, 1.0],
                    [0.0, 1.0],
                ],
                &[0, 1, 2, 10, 4, 5, 6, 7, 8, 11, 9, 3],
                h,
            )],
            |a, b| (a.min(b) == 10 && a.max(b) == 11) || (a.min(b) >= 4 && a.max(b) <= 8),
        ),
    ]
}

/// The surface of a skin, in the plane or drawn out along z, turned by an angle, with the label of each facet.
pub(super) fn surface(
    skin: &Skin,
    kind: &str,
    turned: f64,
) -> (Facets, Vec<Vec3>, Vec<usize>, Vec<u32>) {
    let layers = if kind.starts_with("line") { 0 } else { 2 };
    let (sin, cos) = turned.sin_cos();
    let mut x = Vec::new();
    let mut facets: Vec<Vec<NodeId>> = Vec::new();
    let (mut labels, mut bodies) = (Vec::new(), Vec::new());
    for (body, outline) in (0..).zip(&skin.outlines) {
        let n = outline.at.len() as NodeId;
        let first = x.len() as NodeId;
        for layer in 0..=layers {
            let turn = |&[u, v]: &[f64; 2]| {
                Vec3::new(cos * u - sin * v, sin * u + cos * v, 0.4 * f64::from(layer))
            };
            x.extend(outline.at.iter().map(turn));
        }
        for k in 0..n {
            let label = outline.label[k as usize];
            let (a, b) = (first + k, first + (k + 1) % n);
            if layers == 0 {
                facets.push(vec![a, b]);
                labels.push(label);
            }
            for layer in 0..layers as NodeId {
                let (lower, upper) = (layer * n, (layer + 1) * n);
                let quad = [a + lower, b + lower, b + upper, a + upper];
                if kind.starts_with("tri") {
                    facets.push(vec![quad[0], quad[1], quad[2]]);
                    facets.push(vec![quad[0], quad[2], quad[3]]);
                    labels.extend([label; 2]);
                } else {
                    facets.push(quad.to_vec());
                    labels.push(label);
                }
            }
        }
        bodies.resize(facets.len(), if skin.hollow { 0 } else { body });
    }
    if ["line3", "tri6", "quad8"].contains(&kind) {
        with_mid_nodes(&mut x, &mut facets, false);
    }
    let named: Vec<_> = facets.into_iter().map(|nodes| (kind, nodes)).collect();
    let surface = facets_of(&mut x, &named);
    (surface, x, labels, bodies)
}

fn itself(surface: &Facets, bodies: &[u32], x: &[Vec3]) -> SurfacePair {
    let at = Placement { x, poses: &[] };
    let points = surface.all_nodes();
    let sizes = FacetSizes::new(&points, Some(surface), surface, &at);
    let largest = sizes.primary.iter().copied().fold(0.0, f64::max);
    SurfacePair {
        own: Some(OwnBody::new(&points, surface, bodies, &at)),
        secondary: Some(surface.clone()),
        sizes,
        same: true,
        ..SurfacePair::new(points, Arc::new(surface.clone()), REACH * largest)
    }
}

/// Nodes, and two points along each direction inside facets.
pub(super) fn rows(surface: &Facets) -> [PointToSegment; 2] {
    let gauss = quadrature::gauss(2);
    [
        PointToSegment::at_nodes(&surface.all_nodes()),
        PointToSegment::inside(surface, move |e| quadrature::on_facet(e, &gauss)),
    ]
}

/// The labels of the facets around the point of a row.
fn labels_of(surface: &Facets, rows: &PointToSegment, row: usize, labels: &[usize]) -> Vec<usize> {
    if let Some(point) = rows.on_facets().and_then(|points| points.get(row)) {
        return vec![labels[point.facet as usize]];
    }
    let node = rows.point(row).nodes[0];
    let around = (0..surface.nfacet() as u32).filter(|&f| surface.nodes(f).contains(&node));
    around.map(|f| labels[f as usize]).collect()
}

pub(super) const KINDS: [&str; 6] = ["line2", "line3", "quad4", "tri3", "quad8", "tri6"];

/// A distance that every point sees, in front of its facet.
const CLOSE: f64 = 0.2;

/// Half the thickness of the thinnest skin, nearly.
const INTO: f64 = 0.045;

/// How far the closest allowed facet is that a point inside a facet is in front of, or a little behind: every facet is
/// looked at.
fn opposite(
    pair: &SurfacePair,
    rows: &PointToSegment,
    row: usize,
    at: &Placement,
    allowed: &dyn Fn(u32) -> bool,
) -> Option<f64> {
    let surface = pair.primary.as_ref();
    let own = rows.on_facets()?.get(row)?;
    let mut jet = SurfaceJet::default();
    let local = surface.domain(own.facet)?.centre();
    let facet = own.facet;
    surface.jet(at, &Anchor { facet, local }, &mut jet).unwrap();
    let (normal, point) = (jet.normal, rows.point(row));
    let x = point.position(at);
    let near = |f: u32| surface.aabb(at, f).distance_squared(x) <= CLOSE * CLOSE;
    let facets = (0..surface.nfacet() as u32).filter(|&f| near(f) && allowed(f));
    let away = facets
        .filter(|&f| !pair.is_next_to(point.nodes, f))
        .filter_map(|f| {
            let found = surface.project(at, f, x, None, &mut jet).unwrap()?;
            let gap = (x - jet.position).dot(jet.normal);
            let faces = found.feature == Feature::Face && jet.normal.dot(normal) < -0.5;
            (faces && (-INTO..CLOSE).contains(&gap)).then_some(found.distance)
        });
    away.reduce(f64::min)
}

#[test]
fn a_surface_sees_of_itself_what_it_may_touch_and_nothing_else() {
    for (h, turned) in [(0.6, 0.0), (0.6, std::f64::consts::FRAC_PI_6)] {
        for skin in skins(h) {
            for kind in KINDS {
                let (surface, x, labels, bodies) = surface(&skin, kind, turned);
                let at = Placement { x: &x, poses: &[] };
                let pair = itself(&surface, &bodies, &x);
                for rows in rows(&surface) {
                    let found = closest_points(&rows, &pair, &at).unwrap();
                    let mut met = 0;
                    for (row, found) in found.pairs.iter().enumerate() {
                        let may = |own: &[usize], other: usize| {
                            own.iter().any(|&l| (skin.may_touch)(l, other))
                        };
                        let own = labels_of(&surface, &rows, row, &labels);
                        let allowed = |f: u32| may(&own, labels[f as usize]);
                        let place = format!("{} {kind} h {h}: {own:?}", skin.name);
                        let sees = opposite(&pair, &rows, row, &at, &allowed);
                        if let Some(away) = sees {
                            let found =
                                found.unwrap_or_else(|| panic!("{place}: nothing at {away}"));
                            assert!(found.gap.abs() < away + 1e-9, "{place}: {}", found.gap);
                        }
                        // corners may see others past an edge, from in front
                        let Some(found) = found.filter(|p| p.gap < CLOSE) else {
                            continue;
                        };
                        met += 1;
                        let other = found.anchor.facet;
                        assert!(allowed(other), "{place} meets {}", labels[other as usize]);
                    }
                    assert_eq!(met > 0, skin.touches, "{} {kind} h {h}: {met}", skin.name);
                }
            }
        }
    }
}

/// Of the facets within reach, those that no projection is needed for are none that are met, and they are most.
#[test]
fn facets_that_need_no_projection_are_none_that_are_met() {
    let (mut near, mut projected) = (0, 0);
    for skin in skins(0.6) {
        for kind in KINDS {
            let (surface, x, _, bodies) = surface(&skin, kind, std::f64::consts::FRAC_PI_6);
            let at = Placement { x: &x, poses: &[] };
            let pair = itself(&surface, &bodies, &x);
            let now = pair.own.as_ref().unwrap().at(&surface, &at);
            let mut jet = SurfaceJet::default();
            for rows in rows(&surface) {
                for row in 0..rows.nrow() {
                    let point = rows.point(row);
                    let place = point.position(&at);
                    let inside = rows.on_facets().and_then(|points| points.get(row));
                    let own = pair.own_point(point.nodes, inside, &now).unwrap();
                    for facet in 0..surface.nfacet() as u32 {
                        let bounds = surface.aabb(&at, facet);
                        if pair.is_next_to(point.nodes, facet) || !bounds.within(place, pair.reach)
                        {
                            continue;
                        }
                        let may = own.may_meet(facet, &bounds, place);
                        (near, projected) = (near + 1, projected + usize::from(may));
                        let found = surface.project(&at, facet, place, None, &mut jet).unwrap();
                        let meets = found.is_some_and(|found| own.meets(place, &found, &jet));
                        assert!(may || !meets, "{} {kind}: facet {facet}", skin.name);
                    }
                }
            }
        }
    }
    assert!(3 * projected < near, "{projected} of {near}");
}
