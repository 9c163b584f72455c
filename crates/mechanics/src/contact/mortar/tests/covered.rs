//! Facets that are covered in part, seen edge on, or folded.

use super::scenes::*;
use crate::contact::mortar::*;
use crate::contact::tests::Random;
use signorini_geometry::element::by_name;
use signorini_geometry::tensor::Mat3;

#[test]
fn surfaces_that_are_apart_touch_nowhere_but_with_weights_of_either_sign() {
    let lower: [&[f64]; 2] = [&[0.0, 0.45, 1.0], &[0.0, 0.6, 1.0]];
    let whole: [&[f64]; 2] = [&[0.0, 0.3, 0.7, 1.0], &[0.0, 0.4, 0.8, 1.0]];
    let overhanging: [&[f64]; 2] = [&[-0.35, 0.3, 0.7, 1.2], &[-0.2, 0.35, 0.8, 1.15]];
    // where weights are negative, a gap predicts contact
    for (name, upper, alpha, expected) in [
        ("quad8", whole, 0.0, 16),
        ("quad8", whole, 0.2, 0),
        ("quad8", whole, 0.375, 0),
        ("quad8", overhanging, 0.0, 16),
        ("quad8", overhanging, 0.2, 12),
        ("quad8", overhanging, 0.375, 0),
        ("quad9", whole, 0.0, 0),
        ("quad9", overhanging, 0.0, 20),
        ("quad9", overhanging, 0.25, 0),
    ] {
        let element = by_name(name).unwrap();
        let below = quadratic_grid(element, lower[0], lower[1], true);
        let mut above = quadratic_grid(element, upper[0], upper[1], false);
        for x in &mut above.0 {
            x.z += 0.01;
        }
        let gaps = gaps(element, alpha, [&above, &below]);
        let touching = gaps.iter().filter(|g| **g < 0.0).count();
        println!("{name}, alpha {alpha}: {touching} of {} nodes", gaps.len());
        assert_eq!(touching, expected, "{name} {alpha}");
        let total: f64 = gaps.iter().sum();
        assert!((total - 0.01).abs() < 1e-13, "{total}");
    }
}

#[test]
fn flanks_seen_edge_on_never_stop_a_run() {
    for other in secondaries().filter(|e| e.dim() == 2) {
        let name = other.name();
        let (mut met, mut passed) = (0, 0);
        for own in ["quad4", "quad8", "tri6"].map(|n| by_name(n).unwrap()) {
            let x = facet(own, 0.0, &mut Random::new(1));
            for half in [1e-6, 0.01, 0.1, 0.3, 0.5] {
                for degrees in (120..=240).map(|d| f64::from(d) * 0.5) {
                    for sign in [-1.0, 1.0] {
                        let angle = sign * degrees.to_radians();
                        let flank = bent(other, sign * half, angle);
                        let what = format!("{name} bent by {half} at {degrees}");
                        match attempt([own, other], [&x, &flank]) {
                            Ok(covered) => {
                                balanced(&covered, &what);
                                if covered.met().is_empty() {
                                    passed += 1
                                } else {
                                    met += 1
                                }
                            }
                            Err(why) => assert!(degrees <= 60.0, "{what}: {why}"),
                        }
                    }
                }
            }
        }
        println!("{name}: {met} flanks compared, {passed} passed over");
        assert!(met > 100 && passed > 100);
    }
}

#[test]
fn a_facet_folded_in_front_of_another_is_refused_and_one_next_to_it_is_not() {
    let quad = by_name("quad4").unwrap();
    let x = facet(quad, 0.0, &mut Random::new(1));
    let mut folded: Vec<Vec3> = x.iter().map(|x| Vec3::new(x.x, -x.y, 0.1)).collect();
    folded[1] = Vec3::new(-0.6, -0.6, 0.1);
    let found = attempt([quad; 2], [&x, &folded]);
    assert_eq!(found.err(), Some(MortarError::Folded { number: 0 }));
    let next_to_it: Vec<Vec3> = folded
        .iter()
        .map(|&x| x + Vec3::new(2.5, 0.0, 0.0))
        .collect();
    assert!(
        attempt([quad; 2], [&x, &next_to_it])
            .unwrap()
            .met()
            .is_empty()
    );
}

#[test]
fn a_corner_of_a_block_over_the_edge_of_another_covers_what_its_lower_face_does() {
    let quad = by_name("quad4").unwrap();
    let x = facet(quad, 0.0, &mut Random::new(1));
    for tilt in [
        0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, -1e-15, -1e-12, -1e-9, -1e-6, -1e-3,
    ] {
        // the lower face of a block with its corner over the edge x = 1, and its two flanks at that corner
        let turn = Mat3::rotation(Vec3::new(tilt, -tilt, 0.0));
        let face = |corners: [[f64; 3]; 4]| -> Vec<Vec3> {
            let place = |c: [f64; 3]| turn * Vec3::from(c) + Vec3::new(0.4, -0.3, 0.01);
            corners.into_iter().map(place).collect()
        };
        let lower = face([
            [0.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [2.0, 2.0, 0.0],
            [2.0, 0.0, 0.0],
        ]);
        let left = face([
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 2.0],
            [0.0, 2.0, 2.0],
            [0.0, 2.0, 0.0],
        ]);
        let front = face([
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 0.0, 2.0],
            [0.0, 0.0, 2.0],
        ]);
        let facets = [&lower, &left, &front].map(|x| Facet { element: quad, x });
        let own = Facet {
            element: quad,
            x: &x,
        };
        let mut covered = Covered::default();
        covered.evaluate(&own, &facets, &[], true).unwrap();
        balanced(&covered, "a corner");
        let area: f64 = covered.d().iter().sum();
        assert!(
            (area - 0.6 * 1.3).abs() < 10.0 * tilt.abs() + 1e-14,
            "{tilt:e}: {area}"
        );
    }
}

#[test]
fn overlaps_however_thin_or_oblique_balance() {
    let mut random = Random::new(7);
    for elements in pairings() {
        let line = elements[0].dim() == 1;
        let mut met = 0;
        for _ in 0..200 {
            let x = facet(elements[0], 0.1 * unit(&mut random).powi(3), &mut random);
            let [mut other, _] =
                primaries(elements[1], 0.1 * unit(&mut random).powi(3), &mut random);
            // away until a strip or a corner is left, and turned a little
            let width = 10f64.powf(-16.0 * unit(&mut random));
            let turn = random.vector() * 10f64.powf(-12.0 * unit(&mut random));
            let turn = if line {
                Vec3::new(0.0, 0.0, turn.z)
            } else {
                turn
            };
            let turn = Mat3::rotation(turn);
            other.iter_mut().for_each(|p| *p = turn * *p);
            for a in 0..if unit(&mut random) < 0.5 {
                1
            } else {
                elements[0].dim()
            } {
                let most = x.iter().map(|p| p[a]).fold(f64::MIN, f64::max);
                let least = other.iter().map(|p| p[a]).fold(f64::MAX, f64::min);
                other.iter_mut().for_each(|p| p[a] += most - width - least);
            }
            match attempt(elements, [&x, &other]) {
                Ok(covered) => {
                    balanced(&covered, &format!("{elements:?} {width:e}"));
                    met += covered.met().len();
                }
                Err(why) => panic!("{elements:?} {width:e}: {why}"),
            }
        }
        assert!(met > 10, "{elements:?}: {met}");
    }
}

#[test]
fn what_is_covered_of_a_covered_facet_is_all_of_it() {
    for element in secondaries() {
        let name = element.name();
        let covered = evaluate([element; 2], &patch(element, Vec3::ZERO, 5.0), false);
        for (d, full) in covered.d().iter().zip(covered.full()) {
            assert!(
                (d - full).abs() < 1e-14 && *full > 0.05,
                "{name}: {d} {full}"
            );
        }
    }
}

#[test]
fn islands_are_lumped_and_corners_are_not() {
    for element in secondaries() {
        let name = element.name();
        let mut last = false;
        for size in [0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-4] {
            let x = patch(
                element,
                Vec3::new(0.03, 0.02 * (element.dim() as f64 - 1.0), 0.0),
                size,
            );
            let island = evaluate([element; 2], &x, true);
            assert!(
                island.lumped() || !last,
                "{name}: the fallback is left again"
            );
            last = island.lumped();
            for j in 0..island.nnode() {
                let sum: f64 = island.m(j).iter().sum();
                // rounding, as many times as the condition allows
                let all: f64 = island.d().iter().sum();
                assert!((island.d()[j] - sum).abs() < 1e-9 * all);
                assert!(island.d()[j] >= 0.0);
                if island.lumped() {
                    assert!(
                        island.m(j).iter().all(|m| m.abs() <= 2.0 * island.d()[j]),
                        "{name}"
                    );
                }
            }
        }
        assert!(last, "{name}");
    }
    // a corner is covered: cond stays bounded however little it is
    for (name, corner) in [("line2", 1.0), ("quad4", 1.0)] {
        let element = by_name(name).unwrap();
        for size in [0.1, 1e-2, 1e-3, 1e-4] {
            let at = Vec3::new(corner, corner * (element.dim() as f64 - 1.0), 0.0);
            let x = patch(element, at, size);
            let covered = evaluate([element; 2], &x, false);
            assert!(!covered.lumped(), "{name} {size}");
            assert!(covered.d().iter().all(|d| *d > 0.0));
            let full = covered.full();
            let most = covered
                .d()
                .iter()
                .zip(full)
                .map(|(d, f)| d / f)
                .fold(0.0, f64::max);
            assert!(most < 4.1 * size.powi(element.dim() as i32));
        }
    }
}

#[test]
fn what_cannot_be_integrated_over_is_said() {
    let quad = by_name("quad4").unwrap();
    let x = facet(quad, 0.0, &mut Random::new(5));
    let mut covered = Covered::default();
    let short = Facet {
        element: quad,
        x: &x[..3],
    };
    let found = covered.evaluate(&short, &[], &[], true);
    let expected = MortarError::Positions {
        element: "quad4",
        positions: 3,
    };
    assert_eq!(found, Err(expected));
    let flat = [Vec3::ZERO; 4];
    let found = covered.evaluate(
        &Facet {
            element: quad,
            x: &flat,
        },
        &[],
        &[],
        true,
    );
    assert_eq!(found, Err(MortarError::Secondary));
    let own = Facet {
        element: quad,
        x: &x,
    };
    covered.evaluate(&own, &[own], &[], true).unwrap();
    assert!(covered.met().is_empty() && covered.d().iter().all(|d| *d == 0.0));
    assert!(!covered.lumped());
}
