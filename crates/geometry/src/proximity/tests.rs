use super::{Aabb, Bvh, Search, Sweep, brute, bvh};
use crate::random::Random;
use crate::tensor::Vec3;
use std::time::Instant;

impl Random {
    /// In the ball of radius 1.
    fn ball(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if v.norm_squared() <= 1.0 {
                return v;
            }
        }
    }

    fn aabb(&mut self, size: f64) -> Aabb {
        let centre = self.vector();
        Aabb::around([0; 2].map(|_| centre + self.vector() * size))
    }
}

const ALL_Y: Aabb = Aabb {
    min: Vec3::new(-0.1, f64::NEG_INFINITY, -0.1),
    max: Vec3::new(0.1, f64::INFINITY, 0.1),
};
const NOT_A_NUMBER: Aabb = Aabb {
    min: Vec3::new(f64::NAN, 0.0, 0.0),
    max: Vec3::new(f64::NAN, 1.0, 1.0),
};
const INSIDE_OUT: Aabb = Aabb {
    min: Vec3::new(0.5, -1.0, -1.0),
    max: Vec3::new(-0.5, 1.0, 1.0),
};

/// Families of boxes that differ in what makes a tree hard to build.
fn families(random: &mut Random) -> Vec<(&'static str, Vec<Aabb>)> {
    let mut many = |n: usize, size: f64| (0..n).map(|_| random.aabb(size)).collect::<Vec<_>>();
    let cloud = many(1000, 0.05);
    let large = many(200, 1.0);
    let few = [0, 1, 2, 4, 5, 9].map(|n| ("few", many(n, 0.2)));
    let flat = |b: &Aabb, keep: Vec3| {
        let scale = |v: Vec3| Vec3::new(v.x * keep.x, v.y * keep.y, v.z * keep.z);
        Aabb::around([scale(b.min), scale(b.max)])
    };
    let in_plane = cloud.iter().map(|b| flat(b, Vec3::new(1.0, 1.0, 0.0)));
    let on_line = cloud.iter().map(|b| flat(b, Vec3::unit(1)));
    let shrinking = (0..1080).map(|k| {
        let x = 0.5f64.powi(k);
        Aabb::around([Vec3::new(x, 0.0, 0.0), Vec3::new(1.5 * x, 0.0, 0.0)])
    });
    let mut mixed = cloud.clone();
    for (k, odd) in [Aabb::ALL, Aabb::EMPTY, ALL_Y, NOT_A_NUMBER, INSIDE_OUT]
        .into_iter()
        .enumerate()
    {
        mixed[37 * k + 11] = odd;
        mixed[97 * k + 500] = odd;
    }
    let mut families = vec![
        ("in_plane", in_plane.collect()),
        ("on_line", on_line.collect()),
        ("identical", vec![cloud[0]; 300]),
        ("shrinking", shrinking.collect()),
        (
            "only_odd",
            vec![Aabb::ALL, Aabb::EMPTY, NOT_A_NUMBER, ALL_Y],
        ),
        ("cloud", cloud),
        ("large", large),
        ("mixed", mixed),
    ];
    families.extend(few);
    families
}

/// Every query of the tree against its oracle.
fn assert_agrees(name: &str, tree: &Bvh, boxes: &[Aabb], random: &mut Random) {
    let (mut found, mut expected) = (vec![7], vec![]);
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    for k in 0..60 {
        let point = match k {
            0 => Vec3::new(nan, 0.0, 0.0),
            1 => Vec3::new(0.0, inf, 0.0),
            2 => boxes.first().map_or(Vec3::ZERO, |b| b.min),
            _ => random.vector() * 1.2,
        };
        let size = random.unit();
        for distance in [0.0, 0.03, size, 10.0, inf, -0.1, nan] {
            tree.query(point, distance, &mut found);
            brute::query(boxes, point, distance, &mut expected);
            assert_eq!(found, expected, "{name}: {point:?} {distance}");
        }
        for region in [random.aabb(size), Aabb::ALL, Aabb::EMPTY, ALL_Y, INSIDE_OUT] {
            tree.overlaps(&region, &mut found);
            brute::overlaps(boxes, &region, &mut expected);
            assert_eq!(found, expected, "{name}: {region:?}");
        }
        let along = [
            random.vector() * 2.0,
            Vec3::unit(k % 3) * size,
            Vec3::new(nan, 0.0, 1.0),
        ];
        for along in along {
            tree.crossed(point, along, &mut found);
            brute::crossed(boxes, point, along, &mut expected);
            assert_eq!(found, expected, "{name}: {point:?} {along:?}");
        }
        assert_eq!(
            closest(boxes, |visit| tree.visit_near(point, visit), point),
            closest(boxes, |visit| brute::visit_near(boxes, point, visit), point),
            "{name}: {point:?}"
        );
    }
}

/// The smallest distance from `point` of a corner of a box, the smallest number among equals, as a visitor finds it.
fn closest(
    boxes: &[Aabb],
    search: impl FnOnce(&mut dyn FnMut(u32) -> f64),
    point: Vec3,
) -> Option<(f64, u32)> {
    let mut best = None;
    search(&mut |id| {
        let distance = (boxes[id as usize].min - point).norm();
        if best.is_none_or(|best| (distance, id) < best) {
            best = Some((distance, id));
        }
        best.map_or(f64::INFINITY, |(distance, _)| distance)
    });
    best
}

#[test]
fn a_box_reaches_as_far_as_its_furthest_corner() {
    let mut random = Random(7);
    for _ in 0..1000 {
        let (b, d) = (random.aabb(0.5), random.vector());
        let corner = |k: usize| {
            let side = |i: usize| if k >> i & 1 == 1 { b.max[i] } else { b.min[i] };
            Vec3::new(side(0), side(1), side(2))
        };
        let right = (0..8)
            .map(|k| d.dot(corner(k)))
            .fold(f64::NEG_INFINITY, f64::max);
        assert!((b.furthest(d) - right).abs() < 1e-14);
    }
    assert_eq!(ALL_Y.furthest(Vec3::new(1.0, 0.0, -1.0)), 0.2);
    assert_eq!(ALL_Y.furthest(Vec3::unit(1)), f64::INFINITY);
}

#[test]
fn distance_to_a_box_is_that_of_its_closest_point() {
    let mut random = Random(1);
    for _ in 0..1000 {
        let (b, p) = (random.aabb(0.5), random.vector() * 2.0);
        let clamped = p.max(b.min).min(b.max);
        assert_eq!(b.distance_squared(p), (clamped - p).norm_squared());
        assert_eq!(b.contains(p), b.distance_squared(p) == 0.0);
        let d = (clamped - p).norm();
        assert!(b.within(p, d * 1.000_001) && (d == 0.0 || !b.within(p, d * 0.999_999)));
    }
}

#[test]
fn a_line_crosses_a_box_where_one_of_its_points_is_inside() {
    let mut random = Random(4);
    let mut crossings = 0;
    for _ in 0..2000 {
        let (b, p, d) = (random.aabb(1.0), random.vector(), random.vector() * 2.0);
        let mut inside = (0..=1000).map(|k| b.contains(p + d * (f64::from(k) / 1000.0)));
        let inside = inside.any(|inside| inside);
        crossings += u32::from(inside);
        assert!(b.is_crossed(p, d) || !inside);
        // a line that only grazes the box may pass between two of the samples
        let grown = b.inflated(0.01);
        let mut near = (0..=1000).map(|k| grown.contains(p + d * (f64::from(k) / 1000.0)));
        assert!(!b.is_crossed(p, d) || near.any(|near| near));
    }
    assert!(crossings > 50);
}

#[test]
fn a_point_meets_the_moving_boxes_that_it_comes_near_on_the_way() {
    let mut random = Random(5);
    let carried = Vec3::new(30.0, -7.0, 2.0);
    for apart in [0.0, 0.1] {
        let from: Vec<Aabb> = (0..400).map(|_| random.aabb(0.3)).collect();
        let to: Vec<Aabb> = from
            .iter()
            .map(|b| {
                let by = carried + random.vector() * 0.5;
                Aabb::around([b.min + by, b.max + by + random.vector() * 0.02])
            })
            .collect();
        let sweep = Sweep::new(&from, &to);
        let (mut found, mut some) = (Vec::new(), 0);
        for _ in 0..200 {
            let p0 = random.vector();
            let p1 = p0 + carried + random.vector();
            sweep.met([p0, p1], apart, &mut found);
            some += found.len();
            for (id, (a, b)) in from.iter().zip(&to).enumerate() {
                let near = |grown: f64| {
                    (0..=400).any(|k| {
                        let l = f64::from(k) / 400.0;
                        let at = |a: Vec3, b: Vec3| a + (b - a) * l;
                        let now = Aabb {
                            min: at(a.min, b.min),
                            max: at(a.max, b.max),
                        };
                        now.inflated(apart + grown).contains(at(p0, p1))
                    })
                };
                let met = found.contains(&(id as u32));
                assert!(met || !near(-1e-12));
                assert!(!met || near(0.01));
            }
        }
        // boxes that are carried along are not met
        assert!(some > 100 && some < 200 * 100, "{some}");
    }
}

#[test]
fn empty_boxes_are_near_nothing_and_have_no_width() {
    for b in [Aabb::EMPTY, NOT_A_NUMBER, INSIDE_OUT] {
        assert!(b.is_empty() && !b.is_bounded());
        assert!(!b.overlaps(&Aabb::ALL) && !Aabb::ALL.overlaps(&b));
        assert!(!b.within(Vec3::ZERO, f64::INFINITY) && !b.contains(Vec3::ZERO));
        assert_eq!(b.width(), 0.0);
    }
    for b in [Aabb::ALL, ALL_Y] {
        assert!(!b.is_empty() && !b.is_bounded() && b.width() == f64::INFINITY);
    }
    let point = Aabb::around([Vec3::unit(0)]);
    assert!(point.is_bounded() && point.overlaps(&point) && point.within(Vec3::unit(0), 0.0));
}

#[test]
fn tree_finds_what_brute_force_finds() {
    let mut random = Random(2);
    for (name, boxes) in families(&mut random) {
        let tree = Bvh::build(&boxes);
        assert_eq!(tree.nbox(), boxes.len());
        assert!(!tree.degraded(), "{name}");
        assert_agrees(name, &tree, &boxes, &mut random);
    }
}

#[test]
fn refitted_tree_finds_what_brute_force_finds() {
    let mut random = Random(3);
    for (name, mut boxes) in families(&mut random) {
        let mut tree = Bvh::build(&boxes);
        for step in [0.01, 0.3, 3.0] {
            for b in &mut boxes {
                let (d, e) = (random.vector() * step, random.vector() * 0.1 * step);
                (b.min, b.max) = ((b.min + d).min(b.max + d + e), b.max + d + e);
            }
            tree.refit(&boxes);
            assert_agrees(name, &tree, &boxes, &mut random);
        }
        // what was bounded becomes odd, what was odd becomes bounded
        boxes.reverse();
        tree.refit(&boxes);
        assert_agrees(name, &tree, &boxes, &mut random);
        boxes.pop();
        tree.refit(&boxes);
        assert_agrees(name, &tree, &boxes, &mut random);
    }
}

#[test]
fn depth_is_bounded_for_any_boxes_and_small_for_even_ones() {
    let mut random = Random(4);
    for (name, boxes) in families(&mut random) {
        let depth = Bvh::build(&boxes).depth();
        assert!(depth <= bvh::DEEPEST, "{name}: {depth}");
    }
    let even: Vec<_> = (0..10_000).map(|_| random.aabb(0.01)).collect();
    let depth = Bvh::build(&even).depth();
    assert!(depth <= 2 * 14, "{depth}");
}

#[test]
fn nearest_visits_few_of_many() {
    let mut random = Random(5);
    let boxes: Vec<_> = (0..20_000).map(|_| random.aabb(0.005)).collect();
    let tree = Bvh::build(&boxes);
    let (mut nvisit, nquery) = (0, 200);
    for _ in 0..nquery {
        let point = random.vector();
        let mut found = f64::INFINITY;
        tree.visit_near(point, |id| {
            nvisit += 1;
            found = found.min((boxes[id as usize].centre() - point).norm());
            found
        });
    }
    assert!(nvisit < 20 * nquery, "{nvisit}");
}

#[test]
fn tree_degrades_when_boxes_change_places_and_not_when_they_move_together() {
    let mut random = Random(6);
    let boxes: Vec<_> = (0..2000).map(|_| random.aabb(0.02)).collect();
    let mut tree = Bvh::build(&boxes);
    let together = |b: &Aabb| Aabb::around([b.min, b.max].map(|p| p * 3.0 + Vec3::unit(0) * 50.0));
    tree.refit(&boxes.iter().map(together).collect::<Vec<_>>());
    assert!(!tree.degraded());
    let mut shuffled = boxes.clone();
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, random.bits() as usize % (i + 1));
    }
    tree.refit(&shuffled);
    assert!(tree.degraded());
    tree.rebuild(&shuffled);
    assert!(!tree.degraded());

    let mut bounded = boxes.clone();
    bounded[5] = Aabb::ALL;
    tree.refit(&bounded);
    assert!(tree.degraded(), "a bounded box became unbounded");
    tree.rebuild(&bounded);
    assert!(!tree.degraded());
    tree.refit(&boxes);
    assert!(tree.degraded(), "an unbounded box became bounded");
}

/// Facets and points that drift, jitter and now and then jump.
struct Motion {
    random: Random,
    points: Vec<Vec3>,
    boxes: Vec<Aabb>,
}

impl Motion {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let points = (0..150).map(|_| random.vector()).collect();
        let mut boxes: Vec<_> = (0..200).map(|_| random.aabb(0.1)).collect();
        boxes[17] = ALL_Y;
        Self {
            random,
            points,
            boxes,
        }
    }

    fn advance(&mut self, step: f64) {
        let random = &mut self.random;
        let (drift, counter) = (random.ball() * step, random.ball() * step);
        for p in &mut self.points {
            *p += drift + random.ball() * step;
        }
        for b in &mut self.boxes {
            let (d, e) = (random.ball() * step, random.ball() * step);
            let (min, max) = (b.min + counter + d, b.max + counter + e);
            (b.min, b.max) = (min.min(max), min.max(max));
        }
    }
}

/// The pairs whose distance by (E1) is at most `reach`.
fn pairs(motion: &Motion, reach: f64, filter: impl Fn(u32, u32) -> bool) -> Vec<(u32, u32)> {
    let mut pairs = vec![];
    for (i, p) in (0..).zip(&motion.points) {
        for (f, b) in (0..).zip(&motion.boxes) {
            if b.distance_squared(*p).sqrt() <= reach && !b.is_empty() && filter(i, f) {
                pairs.push((i, f));
            }
        }
    }
    pairs
}

fn found(search: &Search) -> Vec<(u32, u32)> {
    let near = search.candidates();
    let row = |i: usize| near.near(i).iter().map(move |&f| (i as u32, f));
    let pairs: Vec<_> = (0..near.npoint()).flat_map(row).collect();
    assert_eq!(pairs.len(), near.npair());
    pairs
}

#[test]
fn candidates_hold_all_within_reach_whatever_moves() {
    let filter = |i: u32, f: u32| !(i + f).is_multiple_of(5);
    let (mut nrebuilt, mut nkept) = (0, 0);
    for (seed, step, skin) in [
        (1, 0.001, 0.05),
        (2, 0.01, 0.1),
        (3, 0.02, 0.02),
        (4, 0.005, 0.0),
    ] {
        let mut motion = Motion::new(seed);
        let mut search = Search::default();
        let mut last: Option<(Vec<Vec3>, Vec<Aabb>)> = None;
        for k in 0..120 {
            let reach = 0.05;
            let rebuilt = search.update(&motion.points, &motion.boxes, reach, skin, &filter);
            let found = found(&search);
            if rebuilt {
                nrebuilt += 1;
                assert_eq!(found, pairs(&motion, reach + skin, filter));
                if let Some((points, boxes)) = last {
                    let point = points.iter().zip(&motion.points).map(|(&a, &b)| b - a);
                    let corner = boxes.iter().zip(&motion.boxes);
                    let corner = corner.flat_map(|(a, b)| [b.min - a.min, b.max - a.max]);
                    let most = point
                        .chain(corner)
                        .map(|d| if d.y.is_nan() { 0.0 } else { d.norm() });
                    assert!(most.fold(0.0, f64::max) > 0.4 * skin);
                }
                last = Some((motion.points.clone(), motion.boxes.clone()));
            } else {
                nkept += 1;
                let within = pairs(&motion, reach, filter);
                assert!(!within.is_empty());
                assert!(within.iter().all(|pair| found.binary_search(pair).is_ok()));
            }
            motion.advance(if k % 40 == 39 { 20.0 * step } else { step });
        }
    }
    assert!(nrebuilt > 50 && nkept > 50, "{nrebuilt} {nkept}");
}

#[test]
fn candidates_are_kept_up_to_the_whole_skin_between_point_and_box() {
    // point and box approach each other head on; 1/8 and its multiples are exact
    let facet = |x: f64| {
        [Aabb::around([
            Vec3::new(x, -1.0, -1.0),
            Vec3::new(x + 4.0, 1.0, 1.0),
        ])]
    };
    let at = |x: f64| [Vec3::new(x, 0.0, 0.0)];
    for (point, box_, rebuilt) in [
        (0.25, 0.25, false),
        (0.5, 0.0, false),
        (0.0, 0.5, false),
        (0.25, 0.375, true),
        (0.375, 0.25, true),
    ] {
        let mut search = Search::default();
        let mut update = |x, y| search.update(&at(x), &facet(y), 0.25, 0.5, &|_, _| true);
        assert!(update(0.0, 0.75));
        assert!(!update(0.0, 0.75));
        assert_eq!(update(point, 0.75 - box_), rebuilt, "{point} {box_}");
        assert_eq!(search.candidates().near(0), [0]);
    }
}

#[test]
fn a_box_that_only_shrinks_does_not_count_as_moving() {
    let facet = |size: f64| [Aabb::around([Vec3::ZERO, Vec3::unit(1) * size])];
    let mut search = Search::default();
    let mut update = |size| search.update(&[Vec3::unit(0)], &facet(size), 1.0, 0.1, &|_, _| true);
    assert!(update(9.0));
    assert!(!update(0.5));
    assert!(update(9.2));
}

#[test]
fn candidates_are_collected_again_when_the_question_changes() {
    let mut motion = Motion::new(8);
    let mut search = Search::default();
    let all = |_: u32, _: u32| true;
    let mut update = |m: &Motion, reach, filter: &dyn Fn(u32, u32) -> bool| {
        let rebuilt = search.update(&m.points, &m.boxes, reach, 0.1, filter);
        (rebuilt, found(&search))
    };
    assert_eq!(update(&motion, 0.1, &all), (true, pairs(&motion, 0.2, all)));
    assert!(!update(&motion, 0.05, &all).0);
    assert!(!update(&motion, 0.2, &all).0);
    assert_eq!(update(&motion, 0.3, &all), (true, pairs(&motion, 0.4, all)));
    motion.points.pop();
    assert_eq!(update(&motion, 0.3, &all), (true, pairs(&motion, 0.4, all)));
    motion.boxes.pop();
    assert_eq!(update(&motion, 0.3, &all), (true, pairs(&motion, 0.4, all)));
    let none = |_: u32, _: u32| false;
    assert!(!update(&motion, 0.3, &none).0);
    search.forget();
    assert!(search.update(&motion.points, &motion.boxes, 0.3, 0.1, &none));
    assert_eq!(search.candidates().npair(), 0);
    assert_eq!(search.candidates().near(10_000), [0u32; 0]);
    assert!(search.update(&[], &[], 0.3, 0.1, &all));
    assert_eq!(search.candidates().npoint(), 0);
}

#[test]
fn candidates_notice_boxes_and_points_that_appear_or_vanish() {
    let unit = Aabb::around([Vec3::ZERO, Vec3::unit(0)]);
    let nan = Vec3::new(0.0, f64::NAN, 0.0);
    let mut search = Search::default();
    let mut near = |p: Vec3, b: Aabb| {
        let rebuilt = search.update(&[p, Vec3::ZERO], &[b], 0.1, 0.1, &|_, _| true);
        (rebuilt, search.candidates().near(0).len())
    };
    for empty in [Aabb::EMPTY, NOT_A_NUMBER, INSIDE_OUT] {
        assert_eq!(near(Vec3::unit(0), unit).1, 1);
        near(Vec3::ZERO, empty);
        assert!(near(Vec3::unit(2), empty).0);
        assert_eq!(near(Vec3::unit(2), unit), (true, 0));
        assert_eq!(near(Vec3::unit(2), Aabb::ALL), (true, 1));
        assert_eq!(near(Vec3::unit(2), Aabb::ALL), (false, 1));
    }
    assert_eq!(near(nan, unit), (true, 0));
    assert_eq!(near(nan, unit), (true, 0));
    assert_eq!(near(Vec3::ZERO, unit), (true, 1));
}

#[test]
fn updates_reuse_their_memory() {
    let mut motion = Motion::new(9);
    let mut search = Search::default();
    let update = |search: &mut Search, m: &Motion| {
        search.update(&m.points, &m.boxes, 0.1, 0.0, &|_, _| true)
    };
    for _ in 0..20 {
        update(&mut search, &motion);
        motion.advance(0.01);
    }
    let before = search.memory();
    motion.points.reverse();
    assert!(update(&mut search, &motion));
    assert_eq!(search.memory(), before);
}

/// SOURCE: own. GOAL: what building, refitting and asking cost. MESH: 100 000 facets of a wavy sheet.
#[test]
#[ignore = "prints times; run it alone with --release --nocapture"]
fn measure_a_hundred_thousand_boxes() {
    let side = 317;
    let height = |i: usize, j: usize, t: f64| {
        let (x, y) = (i as f64 / side as f64, j as f64 / side as f64);
        Vec3::new(x, y, 0.05 * (20.0 * x + t).sin() * (15.0 * y).cos())
    };
    let sheet = |t: f64| -> Vec<Aabb> {
        let facet = |k: usize| {
            let (i, j) = (k % side, k / side);
            let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            Aabb::around(corners.map(|(i, j)| height(i, j, t)))
        };
        (0..100_000).map(facet).collect()
    };
    let timed = |what: &str, run: &mut dyn FnMut()| {
        let best = (0..5)
            .map(|_| {
                let start = Instant::now();
                run();
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!("{what:<48} {:9.3} ms", best * 1e3);
    };
    let (boxes, moved) = (sheet(0.0), sheet(0.5));
    let reach = 0.5 / side as f64;
    let points: Vec<_> = (0..100_000)
        .map(|k| height(k % side, k / side, 0.0) + Vec3::unit(2) * reach)
        .collect();
    let mut tree = Bvh::build(&boxes);
    let mut out = vec![];
    timed("build", &mut || tree.rebuild(&boxes));
    timed("refit", &mut || tree.refit(&moved));
    println!("depth {}, degraded {}", tree.depth(), tree.degraded());
    tree.rebuild(&boxes);
    timed("100 000 queries", &mut || {
        points.iter().for_each(|&p| tree.query(p, reach, &mut out));
    });
    timed("100 000 nearest", &mut || {
        for &p in &points {
            let mut found = f64::INFINITY;
            tree.visit_near(p, |id| {
                found = found.min(boxes[id as usize].distance_squared(p).sqrt());
                found
            });
        }
    });
    let mut search = Search::default();
    timed("collect the candidates of 100 000 points", &mut || {
        search.forget();
        search.update(&points, &boxes, reach, reach, &|_, _| true);
    });
    println!("{} pairs", search.candidates().npair());
    timed("find that nothing has moved", &mut || {
        assert!(!search.update(&points, &boxes, reach, reach, &|_, _| true));
    });
    // how the time of a query follows the cost (E4) as boxes change places
    let mut random = Random(10);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let mut swapped = 0;
    for nswap in [0, 10, 20, 50, 100] {
        while swapped < nswap {
            let n = order.len() as u64;
            order.swap((random.bits() % n) as usize, (random.bits() % n) as usize);
            swapped += 1;
        }
        let boxes: Vec<_> = order.iter().map(|&k| boxes[k]).collect();
        tree.refit(&boxes);
        let what = format!("queries, {nswap} swaps, cost × {:.2}", tree.growth());
        timed(&what, &mut || {
            points.iter().for_each(|&p| tree.query(p, reach, &mut out));
        });
    }
    for size in [0.5, 1.0, 2.0, 4.0] {
        let jitter = |b: &Aabb| {
            let d = random.vector() * (size / side as f64);
            Aabb::around([b.min + d, b.max + d])
        };
        let boxes: Vec<_> = boxes.iter().map(jitter).collect();
        for what in ["refitted", "built anew"] {
            tree.refit(&boxes);
            let what = format!("{what}, jitter {size} facets, cost × {:.2}", tree.growth());
            timed(&what, &mut || {
                points.iter().for_each(|&p| tree.query(p, reach, &mut out));
            });
            tree.rebuild(&boxes);
        }
        tree.rebuild(&sheet(0.0));
    }
}
