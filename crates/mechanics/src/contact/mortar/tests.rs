//! Bases and integrals against reference values, differences and balance, over all pairings.

use super::pair::facing;
use super::*;
use crate::contact::tests::Random;
use crate::cubic::CUBIC;
use serde_json::Value;
use signorini_geometry::element::{MAX_FACET_NODES, TABLE, by_name};
use signorini_geometry::tensor::Mat3;
use std::path::Path;

/// Every facet that mortar contact takes as a secondary one: lines first, and linear ones.
fn secondaries() -> impl Iterator<Item = Element> {
    let facets = TABLE.into_iter().filter(|e| e.dim() < 3);
    let mut facets: Vec<Element> = facets.filter(|e| e.dual_basis().is_some()).collect();
    facets.sort_by_key(|e| (e.dim(), e.order()));
    facets.into_iter()
}

/// With every primary facet; made-up ones of degree 3 come last.
fn pairings() -> Vec<[Element; 2]> {
    let known = secondaries().flat_map(|a| secondaries().map(move |b| [a, b]));
    let cubic = secondaries().flat_map(|a| CUBIC.map(move |b| [a, b]));
    let all = known.chain(cubic);
    all.filter(|[a, b]| a.dim() == b.dim()).collect()
}

/// Those of the plane.
fn pairings_of_lines() -> impl Iterator<Item = [Element; 2]> {
    pairings().into_iter().filter(|pair| pair[0].dim() == 1)
}

/// Uniform on [0, 1].
fn unit(random: &mut Random) -> f64 {
    0.5 + 0.5 * random.signed()
}

/// A file of reference values in a folder next to the repository, or further up.
fn reference(name: &str) -> Option<Value> {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let path = folders.find_map(|f| {
        let path = f.join("shared/reference").join(name);
        path.is_file().then_some(path)
    });
    let Some(path) = path else {
        eprintln!("SKIPPED: no {name} in shared/reference beside the repository");
        return None;
    };
    Some(serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect()
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().unwrap().iter().map(numbers).collect()
}

/// Nodes of a facet about the origin, warped by `noise`, cubic ones by less: their nodes are closer.
fn facet(element: Element, noise: f64, random: &mut Random) -> Vec<Vec3> {
    let noise = if element.order() > 2 {
        0.2 * noise
    } else {
        noise
    };
    let place = |xi: &Vec3| {
        let mut n = random.vector() * noise;
        if element.dim() == 1 {
            n.z = 0.0;
        }
        *xi - element.centre() + n
    };
    element.nodes().iter().map(place).collect()
}

/// Two primary facets over a secondary one, so that each covers a part of it.
fn primaries(element: Element, noise: f64, random: &mut Random) -> [Vec<Vec3>; 2] {
    [-1.0, 1.0].map(|side| {
        let over = |x: Vec3| match element.dim() {
            1 => Vec3::new(side * 0.8 - x.x, x.y + 0.1, 0.0),
            _ => Vec3::new(side * 0.6 + x.x, 0.15 - x.y, x.z + 0.1),
        };
        facet(element, noise, random)
            .into_iter()
            .map(over)
            .collect()
    })
}

fn evaluate(elements: [Element; 2], x: &[Vec<Vec3>], derivatives: bool) -> Covered {
    measured(Measure::Flat, elements, x, derivatives)
}

fn measured(
    measure: Measure,
    elements: [Element; 2],
    x: &[Vec<Vec3>],
    derivatives: bool,
) -> Covered {
    let mut covered = Covered::new(measure);
    let [secondary, primary] = elements;
    let others: Vec<Facet> = x[1..]
        .iter()
        .map(|x| Facet {
            element: primary,
            x,
        })
        .collect();
    let own = Facet {
        element: secondary,
        x: &x[0],
    };
    covered.evaluate(&own, &others, &[], derivatives).unwrap();
    covered
}

fn random_scene(elements: [Element; 2], noise: f64, random: &mut Random) -> Vec<Vec<Vec3>> {
    let [a, b] = primaries(elements[1], noise, random);
    vec![facet(elements[0], noise, random), a, b]
}

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

/// A grid of rectangles of the plane z = `z`, its normal up or down, and the numbers of its nodes.
fn grid(x: &[f64], y: &[f64], up: bool) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let nodes = y
        .iter()
        .flat_map(|&y| x.iter().map(move |&x| Vec3::new(x, y, 0.0)));
    let nx = x.len();
    let mut facets = Vec::new();
    if y.len() == 1 {
        for i in 0..nx - 1 {
            facets.push(if up { vec![i + 1, i] } else { vec![i, i + 1] });
        }
    }
    for k in 0..y.len() - 1 {
        for i in 0..nx - 1 {
            let a = k * nx + i;
            let mut nodes = vec![a, a + 1, a + nx + 1, a + nx];
            if !up {
                nodes.reverse();
            }
            facets.push(nodes);
        }
    }
    (nodes.collect(), facets)
}

/// D and M of two surfaces of facets of one kind, by node.
fn surfaces(
    element: Element,
    [secondary, primary]: [&(Vec<Vec3>, Vec<Vec<usize>>); 2],
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let positions = |(x, facets): &(Vec<Vec3>, Vec<Vec<usize>>)| -> Vec<Vec<Vec3>> {
        facets
            .iter()
            .map(|f| f.iter().map(|&k| x[k]).collect())
            .collect()
    };
    let (own, others) = (positions(secondary), positions(primary));
    let others: Vec<Facet> = others.iter().map(|x| Facet { element, x }).collect();
    let mut d = vec![0.0; secondary.0.len()];
    let mut m = vec![vec![0.0; primary.0.len()]; d.len()];
    let mut covered = Covered::default();
    for (nodes, x) in secondary.1.iter().zip(&own) {
        covered
            .evaluate(&Facet { element, x }, &others, &[], false)
            .unwrap();
        let met = covered.met().iter().flat_map(|&f| &primary.1[f]);
        let columns: Vec<usize> = met.copied().collect();
        for (j, &node) in nodes.iter().enumerate() {
            d[node] += covered.d()[j];
            for (&l, m_jl) in columns.iter().zip(covered.m(j)) {
                m[node][l] += m_jl;
            }
        }
    }
    (d, m)
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

/// The same grid of quad8 or quad9: mid nodes follow the corners.
fn quadratic_grid(
    element: Element,
    x: &[f64],
    y: &[f64],
    up: bool,
) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let (mut nodes, mut facets) = grid(x, y, up);
    for facet in &mut facets {
        let corners: Vec<Vec3> = facet.iter().map(|&k| nodes[k]).collect();
        let quad = by_name("quad4").unwrap();
        let mut shape = [0.0; 4];
        for xi in &element.nodes()[4..] {
            quad.shape(xi, &mut shape);
            let at: Vec3 = corners.iter().zip(shape).map(|(x, n)| *x * n).sum();
            let known = nodes.iter().position(|x| (*x - at).norm() < 1e-12);
            facet.push(known.unwrap_or(nodes.len()));
            if known.is_none() {
                nodes.push(at);
            }
        }
    }
    (nodes, facets)
}

/// `∫ψ_j (x − x^m)` along the normal at the nodes of a surface, with the basis of this α.
fn gaps(
    element: Element,
    alpha: f64,
    [secondary, primary]: [&(Vec<Vec3>, Vec<Vec<usize>>); 2],
) -> Vec<f64> {
    let t = Transformation::with_alpha(element, alpha);
    let n = element.nnode();
    let mut gaps = vec![0.0; secondary.0.len()];
    for nodes in &secondary.1 {
        let x: Vec<Vec3> = nodes.iter().map(|&k| secondary.0[k]).collect();
        let frame = Frame::of(&Facet { element, x: &x }).unwrap();
        let nu = frame.normal();
        // over all primary facets: ∫N, ∫N Nᵀ, and ∫N (x − x^m)·ν
        let (mut d, mut g, mut apart) = (
            [0.0; MAX_FACET_NODES],
            [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES],
            [0.0; MAX_FACET_NODES],
        );
        for facet in &primary.1 {
            let other: Vec<Vec3> = facet.iter().map(|&k| primary.0[k]).collect();
            let mut pair = Pair::default();
            let other = Facet { element, x: &other };
            if !pair.integrate(&frame, &other, 0, false).unwrap() {
                continue;
            }
            for j in 0..n {
                d[j] += pair.n(j);
                for k in 0..n {
                    g[j][k] += pair.nn(j, k);
                    apart[j] += pair.nn(j, k) * nu.dot(x[k]);
                    apart[j] -= pair.nm(j, k) * nu.dot(other.x[k]);
                }
            }
        }
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for (j, row) in s.iter_mut().enumerate().take(n) {
            for (k, s) in row.iter_mut().enumerate().take(n) {
                let over = |i: usize| (0..n).map(|m| t.get(k, m) * g[i][m]).sum::<f64>();
                *s = (0..n).map(|i| t.get(j, i) * over(i)).sum();
            }
        }
        let inverse = basis::inverse(&s, n).unwrap();
        for j in 0..n {
            let d: f64 = (0..n).map(|k| t.get(j, k) * d[k]).sum();
            let over = |i: usize| (0..n).map(|k| t.get(i, k) * apart[k]).sum::<f64>();
            let mean: f64 = (0..n).map(|i| inverse[j][i] * over(i)).sum();
            gaps[nodes[j]] += d * mean;
        }
    }
    gaps
}

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

/// What holds of every facet that was integrated over: `Σ_l M_jl = D_j ≥ 0`.
fn balanced(covered: &Covered, what: &str) {
    for (j, d) in covered.d().iter().enumerate() {
        let sum: f64 = covered.m(j).iter().sum();
        assert!((d - sum).abs() < 1e-13, "{what}: {d:e} {sum:e}");
        assert!(*d >= 0.0, "{what}: {d:e}");
    }
}

/// The integrals, or why there are none.
fn attempt(elements: [Element; 2], x: [&[Vec3]; 2]) -> Result<Covered, MortarError> {
    let [own, other] = [0, 1].map(|k| Facet {
        element: elements[k],
        x: x[k],
    });
    let mut covered = Covered::default();
    covered.evaluate(&own, &[other], &[], true)?;
    Ok(covered)
}

/// A facet bent about the y axis by `half` an angle to either side, its normal at the centre turned by `angle` from −e_z.
fn bent(element: Element, half: f64, angle: f64) -> Vec<Vec3> {
    let turn = Mat3::rotation(Vec3::new(0.0, angle, 0.0));
    let place = |xi: &Vec3| {
        let at = (*xi - element.centre()) * 2.0 / if element.ncorner() == 3 { 1.0 } else { 2.0 };
        let phi = at.x * half;
        turn * Vec3::new(phi.sin() / half, -at.y, (phi.cos() - 1.0) / half)
    };
    element.nodes().iter().map(place).collect()
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
fn a_facet_folded_in_front_of_another_is_said_and_one_beside_it_is_not() {
    let quad = by_name("quad4").unwrap();
    let x = facet(quad, 0.0, &mut Random::new(1));
    let mut folded: Vec<Vec3> = x.iter().map(|x| Vec3::new(x.x, -x.y, 0.1)).collect();
    folded[1] = Vec3::new(-0.6, -0.6, 0.1);
    let found = attempt([quad; 2], [&x, &folded]);
    assert_eq!(found.err(), Some(MortarError::Folded { number: 0 }));
    let beside: Vec<Vec3> = folded
        .iter()
        .map(|&x| x + Vec3::new(2.5, 0.0, 0.0))
        .collect();
    assert!(attempt([quad; 2], [&x, &beside]).unwrap().met().is_empty());
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
fn derivatives_match_differences() {
    let mut random = Random::new(3);
    let mut worst = 0.0f64;
    let flat = pairings().into_iter().map(|e| (e, Measure::Flat));
    let revolved = pairings_of_lines().map(|e| (e, Measure::Revolved));
    for (elements, measure) in flat.chain(revolved) {
        let mut x = random_scene(elements, 0.08, &mut random);
        if measure == Measure::Revolved {
            x.iter_mut()
                .flatten()
                .for_each(|x| *x += Vec3::new(3.0, 0.0, 0.0));
            let turn = Mat3::rotation(Vec3::new(0.0, 0.0, 0.4));
            x.iter_mut().flatten().for_each(|x| *x = turn * *x);
        }
        let exact = measured(measure, elements, &x, true);
        assert_eq!(exact.met().len(), 2);
        let columns: Vec<(usize, usize)> = (0..3)
            .flat_map(|k| (0..x[k].len()).map(move |i| (k, i)))
            .collect();
        assert_eq!(exact.ncolumn(), 3 * columns.len());
        let components = if elements[0].dim() == 1 { 2 } else { 3 };
        for (number, &(k, i)) in columns.iter().enumerate().filter(|(n, _)| n % 3 != 1) {
            for c in 0..components {
                let h = 1e-4;
                let moved = |h: f64| {
                    let mut x = x.clone();
                    x[k][i][c] += h;
                    measured(measure, elements, &x, false)
                };
                let at = [-2.0, -1.0, 1.0, 2.0].map(|s| moved(s * h));
                let slope = |of: &dyn Fn(&Covered) -> f64| {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|s| of(&at[s]));
                    (a - 8.0 * b + 8.0 * c - d) / (12.0 * h)
                };
                let v = 3 * number + c;
                let mut compare = |of: &dyn Fn(&Covered) -> f64, ours: f64| {
                    let slope = slope(of);
                    let error = (slope - ours).abs() / (1.0 + slope.abs());
                    worst = worst.max(error);
                    assert!(error < 1e-7, "{elements:?} {v}: {slope} {ours}");
                };
                for j in 0..exact.nnode() {
                    compare(&|c| c.d()[j], exact.dd(j)[v]);
                    for l in 0..exact.nprimary() {
                        compare(&|c| c.m(j)[l], exact.dm(j, l)[v]);
                    }
                }
                for a in 0..3 {
                    let ours = exact.dnormal(a).get(v).copied().unwrap_or(0.0);
                    compare(&|c| c.normal()[a], ours);
                }
            }
        }
    }
    println!("largest error of derivatives: {worst:.1e}");
}

#[test]
fn facets_seen_almost_edge_on_fade_out_and_their_derivatives_match_differences() {
    let cosine = |degrees: f64| degrees.to_radians().cos();
    assert_eq!(facing(cosine(59.9)).0, 1.0);
    assert_eq!(facing(cosine(80.1)).0, 0.0);
    for limit in [60.0, 80.0] {
        let [inside, outside] = [-1e-4, 1e-4].map(|d| facing(cosine(limit + d)));
        assert!((inside.0 - outside.0).abs() < 1e-9 && (inside.1 - outside.1).abs() < 1e-3);
    }
    let mut random = Random::new(5);
    let (mut worst, mut compared) = (0.0f64, 0);
    for elements in pairings() {
        for degrees in [62.0, 70.0, 77.0] {
            let axis = Vec3::unit(if elements[0].dim() == 1 { 2 } else { 1 });
            let turn = Mat3::rotation(axis * f64::to_radians(degrees));
            let [over, _] = primaries(elements[1], 0.02, &mut random);
            let flank: Vec<Vec3> = over.iter().map(|x| turn * *x).collect();
            let mut x = vec![facet(elements[0], 0.02, &mut random), flank];
            let exact = evaluate(elements, &x, true);
            if exact.met().is_empty() {
                continue; // curved beyond what can be seen of it
            }
            compared += 1;
            balanced(&exact, "almost edge-on");
            assert!((exact.facing() - cosine(degrees)).abs() < 0.1);
            for (k, element) in elements.into_iter().enumerate() {
                for v in 0..3 * element.nnode() {
                    if element.dim() == 1 && v % 3 == 2 {
                        continue;
                    }
                    let h = 1e-5;
                    let mut moved = |h: f64| {
                        let before = x[k][v / 3][v % 3];
                        x[k][v / 3][v % 3] += h;
                        let found = evaluate(elements, &x, false);
                        x[k][v / 3][v % 3] = before;
                        found
                    };
                    let [low, high] = [-h, h].map(&mut moved);
                    let column = 3 * elements[0].nnode() * k + v;
                    let mut compare = |of: &dyn Fn(&Covered) -> f64, ours: f64| {
                        let slope = (of(&high) - of(&low)) / (2.0 * h);
                        let error = (slope - ours).abs() / (1.0 + slope.abs());
                        worst = worst.max(error);
                        assert!(
                            error < 1e-5,
                            "{elements:?} {degrees} {column}: {slope} {ours}"
                        );
                    };
                    for j in 0..exact.nnode() {
                        compare(&|c| c.d()[j], exact.dd(j)[column]);
                        for l in 0..exact.nprimary() {
                            compare(&|c| c.m(j)[l], exact.dm(j, l)[column]);
                        }
                    }
                }
            }
        }
    }
    println!("{compared} pairs, largest error of derivatives: {worst:.1e}");
    assert!(compared > 40, "{compared}");
}

#[test]
fn integrals_do_not_notice_a_rigid_motion_and_the_normal_turns_with_it() {
    let mut random = Random::new(4);
    for elements in pairings() {
        let x = random_scene(elements, 0.1, &mut random);
        let mut turn = random.vector() * 2.0;
        let mut shift = random.vector() * 3.0;
        if elements[0].dim() == 1 {
            (turn, shift) = (
                Vec3::new(0.0, 0.0, turn.z),
                Vec3::new(shift.x, shift.y, 0.0),
            );
        }
        let turn = Mat3::rotation(turn);
        let moved: Vec<Vec<Vec3>> = x
            .iter()
            .map(|x| x.iter().map(|&x| turn * x + shift).collect())
            .collect();
        let (before, after) = (
            evaluate(elements, &x, false),
            evaluate(elements, &moved, false),
        );
        assert!((turn * before.normal() - after.normal()).max_abs() < 1e-14);
        for j in 0..before.nnode() {
            assert!((before.d()[j] - after.d()[j]).abs() < 1e-13, "{elements:?}");
            for (a, b) in before.m(j).iter().zip(after.m(j)) {
                assert!((a - b).abs() < 1e-11, "{elements:?} {a} {b}");
            }
        }
    }
}

#[test]
fn a_uniform_pressure_on_surfaces_of_revolution_has_the_exact_resultant() {
    let mut random = Random::new(8);
    let tau = std::f64::consts::TAU;
    for elements in pairings_of_lines() {
        for _ in 0..20 {
            let turn = Mat3::rotation(Vec3::new(0.0, 0.0, random.signed()));
            let place = |x: Vec3| turn * x + Vec3::new(2.5, 0.3, 0.0);
            let bend = 0.3 * random.signed();
            // the secondary side, bent, under one that covers it
            let own: Vec<Vec3> = elements[0].nodes().to_vec();
            let own: Vec<Vec3> = own
                .into_iter()
                .map(|x| place(Vec3::new(x.x, bend * (1.0 - x.x * x.x), 0.0)))
                .collect();
            let other: Vec<Vec3> = elements[1]
                .nodes()
                .iter()
                .map(|x| place(*x * -2.0))
                .collect();
            let covered = measured(Measure::Revolved, elements, &[own.clone(), other], false);
            balanced(&covered, "a ring");
            // along the axis, whatever the bend: 2 pi r dr
            let force = covered.d().iter().sum::<f64>() * covered.normal().y;
            let exact = 0.5 * tau * (own[1].x.powi(2) - own[0].x.powi(2));
            assert!(
                (force - exact).abs() < 1e-13 * tau,
                "{elements:?}: {force} {exact}"
            );
            for (d, full) in covered.d().iter().zip(covered.full()) {
                assert!((d - full).abs() < 1e-13, "{elements:?}: {d} {full}");
            }
        }
    }
}

#[test]
fn rings_that_coincide_pass_on_the_forces_of_a_uniform_pressure() {
    // straight lines: what a uniform pressure does to a node is the integral of 2 pi r N, on either side
    for elements in pairings_of_lines() {
        let line = |from: f64, to: f64| -> Vec<Vec3> {
            let place = |xi: &Vec3| {
                let s = 0.5 * (from + to) + 0.5 * (to - from) * xi.x;
                Vec3::new(1.0 + s, 0.5 * s, 0.0)
            };
            elements[usize::from(from > to)]
                .nodes()
                .iter()
                .map(place)
                .collect()
        };
        let exact = |element: Element, x: &[Vec3]| -> Vec<f64> {
            let mut sum = vec![0.0; x.len()];
            let mut n = sum.clone();
            let length = (x[1] - x[0]).norm();
            for (xi, w) in signorini_geometry::element::quadrature::gauss(4) {
                element.shape(&Vec3::new(xi, 0.0, 0.0), &mut n);
                let r: f64 = n.iter().zip(x).map(|(n, x)| n * x.x).sum();
                let w = w * 0.5 * length * std::f64::consts::TAU * r;
                sum.iter_mut().zip(&n).for_each(|(s, n)| *s += w * n);
            }
            sum
        };
        let (own, other) = (line(0.0, 1.0), line(0.8, 0.3));
        let one = measured(
            Measure::Revolved,
            elements,
            &[own.clone(), other.clone()],
            false,
        );
        let of_primary = exact(elements[1], &other);
        for (l, e) in of_primary.iter().enumerate() {
            let sum: f64 = (0..one.nnode()).map(|j| one.m(j)[l]).sum();
            assert!((sum - e).abs() < 1e-13, "{elements:?} M {l}: {sum} {e}");
        }
        let rest = [line(0.3, -0.2), line(1.1, 0.8)];
        let all = [own.clone(), other, rest[0].clone(), rest[1].clone()];
        let all = measured(Measure::Revolved, elements, &all, false);
        let t = Transformation::of(elements[0], Basis::Part).unwrap();
        let of_own = exact(elements[0], &own);
        for (j, d) in all.d().iter().enumerate() {
            let e: f64 = (0..own.len()).map(|k| t.get(j, k) * of_own[k]).sum();
            assert!((d - e).abs() < 1e-13, "{elements:?} D {j}: {d} {e}");
        }
    }
}

/// A facet and a flat one over the part of it about `at`, `size` times as large.
fn patch(element: Element, at: Vec3, size: f64) -> Vec<Vec<Vec3>> {
    let centre = element.centre();
    let own: Vec<Vec3> = element.nodes().iter().map(|x| *x - centre).collect();
    let over = |x: &Vec3| match element.dim() {
        1 => *x * -size + at,
        _ => Vec3::new(x.x, -x.y, 0.0) * size + at,
    };
    vec![own.clone(), own.iter().map(over).collect()]
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

#[test]
#[ignore = "a measurement"]
fn speed() {
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
