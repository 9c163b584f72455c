//! Bases and integrals against reference values, differences and balance, over all pairings.

mod covered;
mod derivatives;
mod scenes;

use super::*;
use crate::contact::tests::Random;
use scenes::*;
use serde_json::Value;
use signorini_geometry::element::{MAX_FACET_NODES, by_name};

#[test]
fn weights_transformations_and_bases_of_whole_quadratic_facets_are_those_of_the_reference() {
    let Some(file) = reference("quadratic_dual.json") else {
        return;
    };
    let mut worst = 0.0f64;
    let mut singular = 0;
    for (name, case) in file["basis"].as_object().unwrap() {
        let (kind, alpha) = name.split_once('_').unwrap();
        let element = by_name(kind).unwrap();
        let x: Vec<Vec3> = element.nodes().to_vec();
        let turned: Vec<Vec3> = match element.dim() {
            1 => x.iter().map(|x| *x * -1.0).collect(),
            _ => x.iter().map(|x| Vec3::new(x.y, x.x, 0.0)).collect(),
        };
        let frame = Frame::of(&Facet { element, x: &x }).unwrap();
        let mut pair = Pair::default();
        assert!(
            pair.integrate(
                &frame,
                &Facet {
                    element,
                    x: &turned
                },
                0,
                false
            )
            .unwrap()
        );
        let n = x.len();
        let t = Transformation::with_alpha(element, alpha.parse().unwrap());
        let area: f64 = (0..n).map(|j| pair.n(j)).sum();
        let mut d = [0.0; MAX_FACET_NODES];
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for j in 0..n {
            d[j] = (0..n).map(|k| t.get(j, k) * pair.n(k)).sum();
            for k in 0..n {
                let over = |i: usize| (0..n).map(|m| t.get(k, m) * pair.nn(i, m)).sum::<f64>();
                s[j][k] = (0..n).map(|i| t.get(j, i) * over(i)).sum();
            }
        }
        let inverse = basis::inverse(&s, n).unwrap();
        let weights = numbers(&case["weights"]);
        let (expected_t, expected_a) = (rows(&case["T"]), &case["A"]);
        for j in 0..n {
            worst = worst.max((d[j] / area - weights[j]).abs());
            for k in 0..n {
                worst = worst.max((t.get(j, k) - expected_t[j][k]).abs());
                if name == "tri6_0" {
                    singular += 1;
                } else {
                    let a = d[j] * inverse[j][k];
                    worst = worst.max((a - numbers(&expected_a[j])[k]).abs());
                }
            }
        }
    }
    println!("largest difference from the reference: {worst:.1e}");
    assert!(worst < 1e-9 && singular == 36);
}

#[test]
fn overhanging_grids_have_the_weights_of_the_reference_and_balance_a_uniform_pressure() {
    let Some(file) = reference("partial_patch.json") else {
        return;
    };
    // what two grids share is the unit square, or its edge
    let lower: [&[f64]; 2] = [&[0.0, 0.45, 1.0], &[0.0, 0.6, 1.0]];
    let upper: [&[f64]; 2] = [&[-0.35, 0.3, 0.7, 1.2], &[-0.2, 0.35, 0.8, 1.15]];
    let mut checked = 0;
    for row in file["rows"].as_array().unwrap() {
        let case = row["case"].as_str().unwrap();
        let wanted = row["kind"] == "dual" && row["mode"] == "consistent";
        if !wanted || !matches!(case, "2d" | "3d") {
            continue;
        }
        let plane = case == "2d";
        let element = by_name(if plane { "line2" } else { "quad4" }).unwrap();
        let across = |y: &'static [f64]| if plane { &[0.0][..] } else { y };
        let below = grid(lower[0], across(&[0.0, 0.6, 1.0]), true);
        let above = grid(upper[0], across(&[-0.2, 0.35, 0.8, 1.15]), false);
        let sides = if row["secondary"] == "upper" {
            [&above, &below]
        } else {
            [&below, &above]
        };
        let (d, m) = surfaces(element, sides);
        let least = d.iter().copied().fold(f64::MAX, f64::min);
        assert!(
            (least - row["min_wt"].as_f64().unwrap()).abs() < 1e-14,
            "{case}: {least}"
        );
        let covered = d.iter().filter(|d| **d > 0.0).count();
        assert_eq!(covered as u64, row["n_covered"].as_u64().unwrap());
        // what a uniform pressure does to a node: the integral of its function over [0, 1], or its product
        let hat = |x: &[f64], k: usize| -> f64 {
            let points = signorini_geometry::element::quadrature::gauss(2);
            let mut cuts: Vec<f64> = x.iter().map(|v| v.clamp(0.0, 1.0)).collect();
            cuts.dedup();
            let value = |s: f64| {
                let side = |other: Option<&f64>| match other {
                    Some(&o) if (s - x[k]) * (o - x[k]) >= 0.0 => {
                        (1.0 - (s - x[k]) / (o - x[k])).max(0.0)
                    }
                    _ => 0.0,
                };
                let left = side(k.checked_sub(1).map(|i| &x[i]));
                if s < x[k] { left } else { side(x.get(k + 1)) }
            };
            let part = |c: &[f64]| {
                let at = |&(p, w): &(f64, f64)| {
                    let half = 0.5 * (c[1] - c[0]);
                    w * half * value(0.5 * (c[0] + c[1]) + p * half)
                };
                points.iter().map(at).sum::<f64>()
            };
            cuts.windows(2).map(part).sum()
        };
        let exact = |grid: [&[f64]; 2], node: usize| {
            let nx = grid[0].len();
            let along = hat(grid[0], node % nx);
            if plane {
                along
            } else {
                along * hat(grid[1], node / nx)
            }
        };
        let [own, other] = if row["secondary"] == "upper" {
            [upper, lower]
        } else {
            [lower, upper]
        };
        for (j, d) in d.iter().enumerate() {
            assert!((d - exact(own, j)).abs() < 1e-15, "{case} D {j}");
            let sum: f64 = m[j].iter().sum();
            assert!((d - sum).abs() < 1e-15);
        }
        for l in 0..m[0].len() {
            let sum: f64 = m.iter().map(|row| row[l]).sum();
            assert!((sum - exact(other, l)).abs() < 1e-15, "{case} M {l}");
        }
        checked += 1;
    }
    assert_eq!(checked, 4);
}

#[test]
fn deformed_blocks_have_the_integrals_of_an_independent_program() {
    let files = [
        (
            "two_block_3d_mortar.json",
            vec!["frictionless", "frictionless_facetnormal", "coulomb0.3"],
        ),
        (
            "two_block_2d_mortar_friction.json",
            vec!["facet_frictionless", "facet_coulomb0.3"],
        ),
    ];
    for (name, runs) in files {
        let Some(file) = reference(name) else {
            return;
        };
        let plane = name.contains("2d");
        let element = by_name(if plane { "line2" } else { "quad4" }).unwrap();
        let list = |value: &Value| -> Vec<Vec<usize>> {
            let row = |v: &Vec<f64>| v.iter().map(|&k| k as usize).collect();
            rows(value).iter().map(row).collect()
        };
        let mesh = &file["mesh"];
        let points = rows(&mesh["nodes"]);
        let (secondary, primary) = if plane {
            // bodies run counter-clockwise: the lower side of the upper one goes right, the upper side of the other left
            let own = vec![vec![15, 16], vec![16, 17]];
            (own, (10..14).map(|k| vec![k + 1, k]).collect())
        } else {
            (
                list(&mesh["secondary_facets"]),
                list(&mesh["primary_facets"]),
            )
        };
        let numbered = |facets: &[Vec<usize>]| {
            let mut all: Vec<usize> = facets.concat();
            all.sort_unstable();
            all.dedup();
            all
        };
        let (own, other) = (numbered(&secondary), numbered(&primary));
        let mut worst = 0.0f64;
        for run in runs {
            for step in file["runs"][run].as_array().unwrap() {
                let u = rows(&step["u"]);
                let place = |k: usize| {
                    let mut x = Vec3::ZERO;
                    for (c, (p, u)) in points[k].iter().zip(&u[k]).enumerate() {
                        x[c] = p + u;
                    }
                    x
                };
                let x: Vec<Vec3> = (0..points.len()).map(place).collect();
                let (d, m) = surfaces(
                    element,
                    [&(x.clone(), secondary.clone()), &(x, primary.clone())],
                );
                let (expected_d, expected_m) = (rows(&step["D"]), rows(&step["M"]));
                for (j, &node) in own.iter().enumerate() {
                    worst = worst.max((d[node] - expected_d[j][j]).abs());
                    for (l, &other) in other.iter().enumerate() {
                        worst = worst.max((m[node][other] - expected_m[j][l]).abs());
                    }
                }
            }
        }
        println!("{name}: largest difference of D and M {worst:.1e}");
        // of 0.1; the reference has a rule of degree 5 in space, and prints 12 digits
        assert!(worst < if plane { 1e-11 } else { 1e-8 }, "{worst:e}");
    }
}

#[test]
fn whole_grids_have_the_integrals_of_the_reference() {
    let Some(file) = reference("mortar_patch_2d.json") else {
        return;
    };
    let data = &file["2d_upper_dual"];
    let along = |key: &str| -> Vec<f64> {
        let (places, nodes) = (rows(&data["X"]), numbers(&data[key]));
        nodes.iter().map(|&n| places[n as usize][0]).collect()
    };
    let (above, below) = (along("slave_nodes"), along("master_nodes"));
    let sides = [grid(&above, &[0.0], false), grid(&below, &[0.0], true)];
    let (d, m) = surfaces(by_name("line2").unwrap(), [&sides[0], &sides[1]]);
    let (expected_d, expected_m) = (rows(&data["D"]), rows(&data["M"]));
    let mut worst = 0.0f64;
    for j in 0..d.len() {
        worst = worst.max((d[j] - expected_d[j][j]).abs());
        for (m, expected) in m[j].iter().zip(&expected_m[j]) {
            worst = worst.max((m - expected).abs());
        }
    }
    println!("largest difference of D and M {worst:.1e}");
    // the file has 13 digits
    assert!(worst < 1e-12, "{worst:e}");
}

#[test]
fn rows_of_both_sides_have_the_same_sum() {
    let mut random = Random::new(1);
    for elements in pairings() {
        let x = random_scene(elements, 0.05, &mut random);
        let covered = evaluate(elements, &x, true);
        assert_eq!(covered.met(), [0, 1]);
        for (j, d) in covered.d().iter().enumerate() {
            let sum: f64 = covered.m(j).iter().sum();
            assert!((d - sum).abs() < 1e-13, "{elements:?}: {d} {sum}");
            assert!(*d > 0.0, "{elements:?}: {d}");
            for v in 0..covered.ncolumn() {
                let terms = (0..covered.nprimary()).map(|l| covered.dm(j, l)[v]);
                let (sum, size) =
                    terms.fold((0.0, 1.0), |(s, z), t: f64| (s + t, f64::max(z, t.abs())));
                let error = (covered.dd(j)[v] - sum).abs() / size;
                assert!(error < 1e-11, "{elements:?}: {error:e}");
            }
        }
    }
}

#[test]
fn a_node_that_facets_share_has_what_it_has_on_each() {
    let mut random = Random::new(7);
    for elements in pairings() {
        let x = random_scene(elements, 0.05, &mut random);
        let [secondary, primary] = elements;
        let others = [&x[1], &x[2]].map(|x| Facet {
            element: primary,
            x,
        });
        let own = Facet {
            element: secondary,
            x: &x[0],
        };
        // the second facet has the first node of the first one as its last
        let n = primary.nnode();
        let nodes: Vec<u32> = (0..2 * n as u32 - 1).chain([0]).collect();
        let apart = evaluate(elements, &x, true);
        let mut shared = Covered::default();
        shared.evaluate(&own, &others, &nodes, true).unwrap();
        assert_eq!((apart.nprimary(), shared.nprimary()), (2 * n, 2 * n - 1));
        assert_eq!(shared.nodes(), (0..2 * n - 1).collect::<Vec<_>>());
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{a} {b}");
        // sums over coinciding nodes: the last node of all goes to the first
        let first = secondary.nnode();
        let columns = |line: &[f64], v: usize| {
            let twin = v.checked_sub(3 * first).filter(|c| *c < 3);
            line[v] + twin.map_or(0.0, |c| line[3 * (first + 2 * n - 1) + c])
        };
        for j in 0..first {
            for v in 0..shared.ncolumn() {
                close(shared.dd(j)[v], columns(apart.dd(j), v));
            }
            for l in 0..2 * n - 1 {
                let twin = (l == 0).then_some(2 * n - 1);
                let of_twin = twin.map_or(0.0, |t| apart.m(j)[t]);
                close(shared.m(j)[l], apart.m(j)[l] + of_twin);
                for v in 0..shared.ncolumn() {
                    let of_twin = twin.map_or(0.0, |t| columns(apart.dm(j, t), v));
                    close(shared.dm(j, l)[v], columns(apart.dm(j, l), v) + of_twin);
                }
            }
        }
    }
}

#[test]
fn linear_fields_pass_from_one_side_to_the_other_where_surfaces_coincide() {
    let mut random = Random::new(2);
    let mut worst = 0.0f64;
    for elements in pairings() {
        let x = random_scene(elements, 0.0, &mut random);
        let x: Vec<Vec<Vec3>> = x
            .into_iter()
            .map(|x| {
                let flat = |x: Vec3| match elements[0].dim() {
                    1 => Vec3::new(x.x, 0.0, 0.0),
                    _ => Vec3::new(x.x, x.y, 0.0),
                };
                x.into_iter().map(flat).collect()
            })
            .collect();
        let covered = evaluate(elements, &x, false);
        let t = Transformation::of(elements[0], Basis::Part).unwrap();
        for axis in 0..elements[0].dim() {
            let mut own: Vec<f64> = x[0].iter().map(|x| x[axis]).collect();
            t.values(&mut own);
            for (j, d) in covered.d().iter().enumerate() {
                let others = x[1..].iter().flatten().map(|x| x[axis]);
                let sum: f64 = covered.m(j).iter().zip(others).map(|(m, x)| m * x).sum();
                worst = worst.max((d * own[j] - sum).abs());
            }
        }
    }
    println!("linear fields: {worst:.1e}");
    assert!(worst < 1e-12);
}

#[test]
#[ignore = "a measurement"]
fn measure_mortar() {
    let mut random = Random::new(6);
    let own_kinds = [
        ("line2", 0.0),
        ("tri3", 0.0),
        ("quad4", 0.0),
        ("quad4", 0.08),
        ("quad8", 0.0),
        ("quad8", 0.001),
        ("quad8", 0.03),
        ("tri6", 0.03),
        ("quad9", 0.0),
    ];
    for (name, noise) in own_kinds {
        let element = by_name(name).unwrap();
        let x = random_scene([element; 2], noise, &mut random);
        let others: Vec<Facet> = x[1..].iter().map(|x| Facet { element, x }).collect();
        let own = Facet { element, x: &x[0] };
        let frame = Frame::of(&own).unwrap();
        let mut times = [f64::MAX; 3];
        let (mut pair, mut covered) = (Pair::default(), Covered::default());
        for (k, time) in times.iter_mut().enumerate() {
            for _ in 0..20 {
                let start = std::time::Instant::now();
                for _ in 0..50 {
                    match k {
                        2 => covered.evaluate(&own, &others, &[], true).unwrap(),
                        _ => assert!(pair.integrate(&frame, &others[0], 0, k == 1).unwrap()),
                    }
                }
                *time = time.min(start.elapsed().as_secs_f64() / 50.0);
            }
        }
        let [plain, derived, facet] = times;
        println!(
            "{name} ({noise}): {:.0} pairs/s in values, {:.0} with derivatives, {:.0} facets/s with two each; \
             us: {:.1} {:.1} {:.1}",
            1.0 / plain,
            1.0 / derived,
            1.0 / facet,
            1e6 * plain,
            1e6 * derived,
            1e6 * facet
        );
    }
}

/// SOURCE: Popp, Wohlmuth, Gee, Wall 2012: parts of the facet that its corners and the middles of its edges stand for.
#[test]
fn weights_over_a_whole_facet_are_positive_in_either_basis() {
    let parts = [
        ("tri6", Basis::Part, [1.0 / 6.0, 1.0 / 6.0]),
        ("tri6", Basis::Whole, [2.0 / 15.0, 1.0 / 5.0]),
        ("quad8", Basis::Part, [1.0 / 6.0, 1.0 / 12.0]),
        ("quad8", Basis::Whole, [1.0 / 20.0, 1.0 / 5.0]),
    ];
    for (name, basis, [corner, middle]) in parts {
        let element = by_name(name).unwrap();
        let mut covered = Covered::default();
        covered.measured(Measure::Flat, basis);
        let x = element.nodes();
        covered
            .evaluate(&Facet { element, x }, &[], &[], false)
            .unwrap();
        let area: f64 = covered.full().iter().sum();
        for (k, weight) in covered.full().iter().enumerate() {
            let wanted = if k < element.ncorner() {
                corner
            } else {
                middle
            };
            assert!(
                (weight / area - wanted).abs() < 1e-12,
                "{name} {basis:?} {k}: {weight}"
            );
        }
    }
}
