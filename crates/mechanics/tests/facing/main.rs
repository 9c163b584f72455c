//! Facets that face one another, on skins that are labelled by hand: which of them may touch is known from how they were made.
//!
//! SOURCE      Written for the purpose.
//! GOAL        every facet that may touch another within its length is found with it, and no other
//! MESH        two blocks, five sheets, the lips of a slit tube, a spring, a folded sheet, a convex block, a bent strip, a bolted
//!             joint, fifty balls, two gears
//! CONDITIONS  at rest, next to one another
//! EXPECTED    the same along every line, without a tree and without filters, among the facets that may touch
//! TOLERANCE   none
#![allow(clippy::unwrap_used)]

mod skins;

use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::surface::{ContactSurface, Placement};
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_mechanics::facing::{Facing, Finder, Meeting, Regions, Skin, Standing, secondary};
use skins::{Side, Skinned, all};
use std::collections::BTreeSet;

/// What a search has found, against what is known.
#[derive(Debug, Default, PartialEq)]
struct Verdict {
    /// Pairs found.
    found: usize,
    /// Those that cannot touch.
    bad: usize,
    /// Pairs that lines cross among those that may touch, and that were not found.
    missed: usize,
    /// Facets that cannot touch and that lines cross within their length, from both sides.
    crossed: usize,
}

fn finder(of: &Skinned) -> Finder {
    let cells: Vec<CellId> = of.mesh.cells(of.mesh.dim()).collect();
    Finder::new(Skin::new(&of.mesh, &cells, |_| false).unwrap())
}

/// The same bodies of tetrahedra or triangles.
fn split(of: &Mesh) -> Mesh {
    let (kind, corners): (_, &[&[usize]]) = match of.dim() {
        2 => ("tri3", &[&[0, 1, 2], &[0, 2, 3]]),
        _ => (
            "tet4",
            // around the diagonal from the first corner to the seventh
            &[
                &[0, 1, 2, 6],
                &[0, 2, 3, 6],
                &[0, 3, 7, 6],
                &[0, 7, 4, 6],
                &[0, 4, 5, 6],
                &[0, 5, 1, 6],
            ],
        ),
    };
    let mut mesh = Mesh {
        points: of.points.clone(),
        node_labels: of.node_labels.clone(),
        ..Mesh::default()
    };
    for cell in of.cells(of.dim()) {
        let nodes = of.cell(cell);
        for part in corners {
            let nodes: Vec<NodeId> = part.iter().map(|&k| nodes[k]).collect();
            let label = mesh.ncell() as u64 + 1;
            mesh.push_cell(by_name(kind).unwrap(), &nodes, label);
        }
    }
    mesh
}

/// The same bodies, cells and nodes in another order.
fn shuffled(of: &Mesh) -> Mesh {
    let n = of.nnode();
    // n and this step have no common divisor
    let step = (n / 2 + 1..).find(|step| gcd(*step, n) == 1).unwrap();
    let place = |node: usize| (node * step + 7) % n;
    let mut mesh = Mesh {
        points: vec![Vec3::ZERO; n],
        node_labels: (1..=n as u64).collect(),
        ..Mesh::default()
    };
    for (node, &x) in of.points.iter().enumerate() {
        mesh.points[place(node)] = x;
    }
    let mut cells: Vec<CellId> = of.cells(of.dim()).collect();
    cells.reverse();
    let middle = cells.len() / 3;
    cells.rotate_left(middle);
    for cell in cells {
        let nodes: Vec<NodeId> = of
            .cell(cell)
            .iter()
            .map(|&k| place(k as usize) as NodeId)
            .collect();
        let label = mesh.ncell() as u64 + 1;
        mesh.push_cell(of.element(cell).unwrap(), &nodes, label);
    }
    mesh
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The sides of all facets.
fn sides(of: &Skinned, finder: &Finder) -> Vec<Side> {
    let (skin, x) = (finder.skin(), &of.mesh.points);
    let all = 0..skin.facets().nfacet() as u32;
    all.map(|facet| {
        let (at, normal) = skin.middle(x, facet);
        Side {
            at,
            normal,
            body: skin.body()[facet as usize],
        }
    })
    .collect()
}

/// The same search without a tree and without filters: along every line, the closest of the facets that may touch.
fn judge(of: &Skinned) -> Verdict {
    let mut finder = finder(of);
    let sides = sides(of, &finder);
    let found: Vec<Facing> = finder.find(&of.mesh.points, &[]).to_vec();
    let may = |f: u32, q: u32| (of.may_touch)(&sides[f as usize], &sides[q as usize]);
    let mut verdict = Verdict {
        found: found.len(),
        bad: found.iter().filter(|p| !may(p.facet, p.other)).count(),
        ..Verdict::default()
    };
    let at = Placement {
        x: &of.mesh.points,
        poses: &[],
    };
    let skin = finder.skin();
    let n = skin.facets().nfacet() as u32;
    for f in 0..n {
        let (reach, normal) = (skin.size()[f as usize], sides[f as usize].normal);
        let mut points = [Vec3::ZERO; 4];
        let npoint = skin.points(at.x, f, &mut points);
        let near = |q: &u32| {
            let far = 3.0 * (reach + skin.size()[*q as usize]);
            (sides[*q as usize].at - sides[f as usize].at).norm() < far && !skin.touch(f, *q)
        };
        let near: Vec<u32> = (0..n).filter(near).collect();
        for &point in &points[..npoint] {
            let mut crossed: Vec<(f64, u32)> = Vec::new();
            for &q in &near {
                let from = point - normal * reach;
                let Some(s) = skin.facets().crossing(&at, q, from, normal) else {
                    continue;
                };
                let s = s - reach;
                if s > reach {
                    continue;
                }
                if !may(f, q) {
                    verdict.crossed += 1;
                    continue;
                }
                let thickness = skin.thickness()[f as usize].min(skin.thickness()[q as usize]);
                let opposes = normal.dot(sides[q as usize].normal) < 0.0;
                if opposes && s >= -0.5 * thickness {
                    crossed.push((s.abs(), q));
                }
            }
            // on an edge several are the closest
            let nearest = crossed.iter().map(|c| c.0).fold(f64::INFINITY, f64::min);
            let is_found = |q: u32| {
                found
                    .binary_search_by_key(&(f, q), |p| (p.facet, p.other))
                    .is_ok()
            };
            let mut closest = crossed.iter().filter(|c| c.0 <= nearest + 1e-9 * reach);
            if !crossed.is_empty() && !closest.any(|c| is_found(c.1)) {
                verdict.missed += 1;
            }
        }
    }
    verdict
}

/// A rotation about no axis in particular.
fn turn() -> Mat3 {
    let first = Vec3::new(0.6, -0.3, 0.7).normalized().unwrap_or_default();
    let second = Vec3::new(0.1, 0.9, 0.4)
        .cross(first)
        .normalized()
        .unwrap_or_default();
    Mat3 {
        rows: [first, second, first.cross(second)],
    }
}

fn judge_all(judged: Vec<(Skinned, Verdict)>) {
    for (of, verdict) in &judged {
        println!("{:14} {verdict:?}", of.name);
    }
    for (of, verdict) in judged {
        assert_eq!(
            (verdict.bad, verdict.missed),
            (0, 0),
            "{}: {verdict:?}",
            of.name
        );
        assert_eq!(verdict.found > 0, of.touches, "{}: {verdict:?}", of.name);
        assert_eq!(verdict.crossed > 0, of.tempts, "{}: {verdict:?}", of.name);
    }
}

#[test]
fn facets_that_may_touch_are_found_and_no_others() {
    let judged = all().into_iter().map(|of| (judge(&of), of));
    judge_all(judged.map(|(verdict, of)| (of, verdict)).collect());
}

#[test]
fn the_same_holds_for_triangles() {
    let judged = all().into_iter().map(|of| {
        let of = Skinned {
            mesh: split(&of.mesh),
            ..of
        };
        (judge(&of), of)
    });
    judge_all(judged.map(|(verdict, of)| (of, verdict)).collect());
}

/// Middles of facets that face one another, in the frame of the skin as it was made.
fn pairs(mesh: &Mesh, places: &[Vec3]) -> BTreeSet<[[i64; 3]; 2]> {
    let cells: Vec<CellId> = mesh.cells(mesh.dim()).collect();
    let moved = Mesh {
        points: places.to_vec(),
        ..mesh.clone()
    };
    let mut finder = Finder::new(Skin::new(&moved, &cells, |_| false).unwrap());
    let found = finder.find(places, &[]).to_vec();
    let at = |facet: u32| {
        let middle = finder.skin().middle(&mesh.points, facet).0;
        middle.to_array().map(|x| (x * 1e6).round() as i64)
    };
    found.iter().map(|p| [at(p.facet), at(p.other)]).collect()
}

#[test]
fn numbers_orders_places_and_scales_change_nothing() {
    for of in all() {
        let here = pairs(&of.mesh, &of.mesh.points);
        let other = shuffled(&of.mesh);
        assert_eq!(pairs(&other, &other.points), here, "{}", of.name);
        if of.mesh.dim() == 3 {
            let (turn, shift) = (turn(), Vec3::new(3.0, -2.0, 5.0));
            for scale in [1e-4, 1e4] {
                let places = of.mesh.points.iter().map(|x| (turn * *x + shift) * scale);
                let places: Vec<Vec3> = places.collect();
                assert_eq!(pairs(&of.mesh, &places), here, "{} {scale}", of.name);
            }
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let of = skins::balls(50, 6);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| finder(&of).find(&of.mesh.points, &[]).to_vec())
    };
    let alone = run(1);
    assert!(alone.len() > 500);
    for threads in [2, 5] {
        assert!(run(threads) == alone);
    }
}

/// Two blocks far apart: nothing, unless one is expected to come to the other, and not where both move alike.
#[test]
fn facets_farther_away_are_found_where_they_are_expected_to_meet() {
    let of = &all()[0];
    let mut finder = finder(of);
    let upper: Vec<bool> = {
        let body = finder.skin().body();
        let facets = finder.skin().facets();
        let mut upper = vec![false; of.mesh.nnode()];
        for (facet, body) in (0..).zip(body) {
            facets
                .nodes(facet)
                .iter()
                .for_each(|&n| upper[n as usize] = *body == 1);
        }
        upper
    };
    let places: Vec<Vec3> = of
        .mesh
        .points
        .iter()
        .zip(&upper)
        .map(|(x, up)| if *up { *x + Vec3::unit(2) * 0.6 } else { *x })
        .collect();
    let moving = |[low, high]: [f64; 2]| -> Vec<Vec3> {
        let motion = upper.iter().map(|up| if *up { high } else { low });
        motion.map(|by| Vec3::unit(2) * by).collect()
    };
    let near = finder.find(&of.mesh.points, &[]).len();
    assert!(finder.find(&places, &[]).is_empty());
    assert!(finder.find(&places, &moving([0.5, 0.5])).is_empty());
    for motion in [[0.0, -0.5], [0.5, 0.0], [0.25, -0.25]] {
        assert_eq!(finder.find(&places, &moving(motion)).len(), near);
    }
}

/// Bodies may overlap by less than half the thickness of the thinner one; deeper, nothing is found, and never a wrong side.
#[test]
fn sheets_that_overlap_by_less_than_half_their_thickness_face_each_other() {
    for part in [0.05, 0.2, 0.45, 0.55, 0.9, 1.05, 1.4] {
        let mut mesh = Mesh::default();
        let (thin, thick) = (0.2, 0.3);
        let low = thick - part * thin;
        skins::slab(&mut mesh, [8, 8, 1], [0.0, thick]);
        skins::slab(&mut mesh, [7, 7, 1], [low, low + thin]);
        let cells: Vec<CellId> = mesh.cells(3).collect();
        let mut finder = Finder::new(Skin::new(&mesh, &cells, |_| false).unwrap());
        let found = finder.find(&mesh.points, &[]).to_vec();
        let up = |facet: u32| finder.skin().middle(&mesh.points, facet).1.z;
        for one in &found {
            let (low, high) = match finder.skin().body()[one.facet as usize] {
                0 => (one.facet, one.other),
                _ => (one.other, one.facet),
            };
            assert!(up(low) > 0.9 && up(high) < -0.9, "{part}: {one:?}");
            assert!((one.gap + part * thin).abs() < 1e-12, "{part}: {one:?}");
        }
        assert_eq!(!found.is_empty(), part < 0.5, "{part}");
    }
}

/// What is left out faces nothing, and hides what is behind it.
#[test]
fn a_body_that_is_left_out_stands_in_the_way() {
    let heights = [[0.0, 0.3], [0.31, 0.36], [0.37, 0.67]];
    let mut mesh = Mesh::default();
    for height in heights {
        skins::slab(&mut mesh, [6, 6, 1], height);
    }
    let cells: Vec<CellId> = mesh.cells(3).collect();
    let number = |left_out: Option<u32>, cells: &[CellId]| {
        let is_out = |face: Face| left_out == Some(face.cell.index / 36);
        let mut finder = Finder::new(Skin::new(&mesh, cells, is_out).unwrap());
        finder.find(&mesh.points, &[]).len()
    };
    assert_eq!(number(None, &cells), 4 * 36);
    assert_eq!(number(Some(1), &cells), 0);
    assert_eq!(number(Some(0), &cells), 2 * 36);
    let without: Vec<CellId> = cells
        .iter()
        .filter(|cell| cell.index / 36 != 1)
        .copied()
        .collect();
    assert_eq!(number(None, &without), 2 * 36);
}

#[test]
fn the_thickness_is_that_of_the_body_behind_a_facet() {
    let mut mesh = Mesh::default();
    skins::slab(&mut mesh, [8, 8, 1], [0.0, 0.3]);
    skins::slab(&mut mesh, [8, 8, 4], [2.0, 9.0]);
    let cells: Vec<CellId> = mesh.cells(3).collect();
    let skin = Skin::new(&mesh, &cells, |_| false).unwrap();
    for facet in 0..skin.facets().nfacet() as u32 {
        let (body, up) = (
            skin.body()[facet as usize],
            skin.middle(&mesh.points, facet).1.z,
        );
        let thickness = skin.thickness()[facet as usize];
        if up.abs() > 0.9 {
            let right = [0.3, f64::INFINITY][body as usize];
            assert!(
                thickness == right || (thickness - right).abs() < 1e-12,
                "{thickness}"
            );
        }
    }
}

/// What regions meet in a skin.
fn met(of: &Skinned) -> (Finder, Regions, Vec<Meeting>) {
    let mut finder = finder(of);
    let regions = Regions::new(finder.skin(), &of.mesh.points, |_| 0);
    let met = regions.meetings(finder.find(&of.mesh.points, &[]));
    (finder, regions, met)
}

#[test]
fn regions_meet_as_they_were_made() {
    // how many pairs of regions meet, of how many pairs of bodies, and how many of these are of one body or of one region
    let right = [
        ("two blocks", 1, 1, 0, 0),
        ("five sheets", 4, 4, 0, 0),
        ("thin box, lips", 1, 1, 1, 0),
        ("spring", 1, 1, 1, 0),
        ("folded sheet", 1, 1, 1, 0),
        ("convex block", 0, 0, 0, 0),
        ("bent strip", 0, 0, 0, 0),
        // the head and the nut are on the plates, the shank is in two holes
        ("bolted joint", 5, 3, 0, 0),
        ("balls", 105, 105, 0, 0),
        // flanks, tips and roots of teeth
        ("gears", 13, 1, 0, 0),
    ];
    for (of, (name, count, bodies, own, folds)) in all().iter().zip(right) {
        assert_eq!(of.name, name);
        let (finder, regions, met) = met(of);
        let body = |region: u32| finder.skin().body()[regions.facets(region)[0] as usize];
        let met_bodies: BTreeSet<[u32; 2]> = met.iter().map(|m| m.regions.map(body)).collect();
        let is_own = |one: &&Meeting| body(one.regions[0]) == body(one.regions[1]);
        let is_fold = |one: &&Meeting| one.regions[0] == one.regions[1];
        assert_eq!(
            (
                met.len(),
                met_bodies.len(),
                met.iter().filter(is_own).count(),
                met.iter().filter(is_fold).count()
            ),
            (count, bodies, own, folds),
            "{name}"
        );
        for one in &met {
            judge_sides(&regions, one);
        }
    }
}

/// A region goes round no edge, and beyond it is one.
#[test]
fn regions_end_at_edges_and_nowhere_else() {
    for of in all() {
        let (finder, regions, _) = met(&of);
        let skin = finder.skin();
        let normal = |facet: u32| skin.middle(&of.mesh.points, facet).1;
        for facet in 0..skin.facets().nfacet() as u32 {
            let own = regions.of(facet).unwrap();
            assert!(regions.facets(own).binary_search(&facet).is_ok());
            for &next in skin.facets().neighbours(facet) {
                let smooth = normal(facet).dot(normal(next)) > 0.8661;
                let is_own = skin.body()[facet as usize] == skin.body()[next as usize];
                assert!(
                    !(smooth && is_own) || regions.of(next) == Some(own),
                    "{}",
                    of.name
                );
            }
        }
        let sum: usize = (0..regions.count())
            .map(|r| regions.facets(r as u32).len())
            .sum();
        assert_eq!(sum, skin.facets().nfacet());
    }
}

#[test]
fn kinds_of_facets_are_regions_of_their_own() {
    let of = &all()[5];
    let finder = finder(of);
    let (skin, x) = (finder.skin(), &of.mesh.points);
    assert_eq!(Regions::new(skin, x, |_| 0).count(), 6);
    let left = |facet: u32| u32::from(skin.middle(x, facet).0.x < 0.5);
    // four of the six sides of a block are cut in two by a plane across it
    assert_eq!(Regions::new(skin, x, left).count(), 10);
}

#[test]
fn a_bore_that_is_narrower_than_its_facets_faces_itself_all_around() {
    let of = skins::tube();
    let verdict = judge(&of);
    assert_eq!((verdict.bad, verdict.missed), (0, 0));
    let (_, regions, met) = met(&of);
    let walls: BTreeSet<u32> = met.iter().flat_map(|one| one.regions).collect();
    let live: BTreeSet<u32> = met.iter().flat_map(|one| one.live.concat()).collect();
    let all: usize = walls.iter().map(|&wall| regions.facets(wall).len()).sum();
    assert_eq!((all, live.len()), (16, 16));
}

/// Regions hold what faces the other.
fn judge_sides(regions: &Regions, one: &Meeting) {
    assert!(one.gap[0] <= one.gap[1]);
    for (&region, live) in one.regions.iter().zip(&one.live) {
        assert!(!live.is_empty());
        assert!(live.iter().all(|&facet| regions.of(facet) == Some(region)));
    }
}

#[test]
fn the_finer_then_the_softer_then_the_more_convex_side_is_secondary_and_what_is_led_is_primary() {
    let like = Standing {
        is_led: false,
        size: 1.0,
        modulus: 10.0,
        bulge: 0.0,
    };
    let led = Standing {
        is_led: true,
        size: 0.1,
        ..like
    };
    let finer = Standing {
        size: 0.9,
        modulus: 20.0,
        ..like
    };
    let softer = Standing {
        size: 0.97,
        modulus: 5.0,
        bulge: -1.0,
        ..like
    };
    let rounder = Standing { bulge: 0.5, ..like };
    for (one, other) in [
        (finer, led),
        (finer, like),
        (softer, like),
        (rounder, like),
        (finer, softer),
    ] {
        assert_eq!(secondary([one, other]), 0, "{one:?} {other:?}");
        assert_eq!(secondary([other, one]), 1, "{one:?} {other:?}");
    }
    assert_eq!(secondary([like, like]), 1);
}

#[test]
fn balls_are_convex_by_their_curvature_and_holes_hollow() {
    let balls = skins::balls(2, 8);
    let (finder, regions, met) = met(&balls);
    let standing = |side: &[u32]| finder.skin().standing(&balls.mesh.points, side, false, 1.0);
    for region in met[0].regions {
        let bulge = standing(regions.facets(region)).bulge;
        assert!((bulge - 1.0).abs() < 0.1, "{bulge}");
    }
    let joint = &all()[7];
    let (finder, regions, met) = self::met(joint);
    let (skin, x) = (finder.skin(), &joint.mesh.points);
    let is_round = |region: u32| skin.middle(x, regions.facets(region)[0]).1.z.abs() < 0.1;
    let round: Vec<&Meeting> = met.iter().filter(|one| is_round(one.regions[0])).collect();
    // plates are the bodies 0 and 1, the bolt is 2; its shank is met by the walls of holes
    assert_eq!(round.len(), 2);
    for one in round {
        let of = |region: u32| skin.standing(x, regions.facets(region), false, 1.0).bulge;
        assert!(of(one.regions[0]) < -0.2 && of(one.regions[1]) > 0.2);
    }
}
