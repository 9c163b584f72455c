//! Conformance of rigid analytical surfaces: against parametrisations written down afresh, differences, brute force.
use super::smallest;
use crate::random::Random;
use crate::surface::*;
use crate::tensor::{Mat3, Sym3, Vec3};
use std::f64::consts::{PI, TAU};

pub(super) const EMPTY: Placement = Placement { x: &[], poses: &[] };

/// A shape, seen from either side, and a parametrisation of (the near part of) it over the unit square.
struct Case {
    name: &'static str,
    ntan: usize,
    shape: Box<dyn Fn(bool) -> Box<dyn Shape>>,
    point: Box<dyn Fn(f64, f64) -> Vec3>,
}

impl Case {
    fn new<S: Shape + 'static>(
        name: &'static str,
        ntan: usize,
        shape: impl Fn(bool) -> S + 'static,
        point: impl Fn(f64, f64) -> Vec3 + 'static,
    ) -> Self {
        Self {
            name,
            ntan,
            shape: Box::new(move |outside| Box::new(shape(outside))),
            point: Box::new(point),
        }
    }

    fn surface(&self, outside: bool, mount: Mount) -> Analytical {
        Analytical::new(mount, (self.shape)(outside)).unwrap()
    }

    fn fixed(&self, outside: bool) -> Analytical {
        self.surface(outside, Mount::fixed(self.ntan))
    }

    /// In a model of the plane, its points.
    fn flat(&self, v: Vec3) -> Vec3 {
        if self.ntan == 1 {
            Vec3::new(v.x, v.y, 0.0)
        } else {
            v
        }
    }

    fn near(&self, random: &mut Random) -> Vec3 {
        self.flat(random.vector() * 2.5)
    }
}

fn side(outside: bool) -> Side {
    if outside { Side::Outside } else { Side::Inside }
}

fn sign(outside: bool) -> f64 {
    if outside { 1.0 } else { -1.0 }
}

/// Two unit vectors that make an orthonormal frame with a direction.
fn frame(axis: Vec3) -> (Vec3, Vec3, Vec3) {
    let a = axis.normalized().unwrap();
    let e = a.cross(Vec3::new(0.3, -0.5, 0.9)).normalized().unwrap();
    (a, e, a.cross(e))
}

/// `½ x·Q x − ½` with its derivatives: an ellipsoid, far from a distance.
pub(super) fn ellipsoid(q: Sym3, s: f64) -> SignedDistance {
    let m = q.to_mat3();
    distance(
        move |x| Ok(s * 0.5 * (x.dot(m * x) - 1.0)),
        move |x| Ok(m * x * s),
        move |_| Ok(q * s),
    )
}

/// A function of lengths about 1.
pub(super) fn distance(
    value: impl Fn(Vec3) -> Result<f64, String> + Send + Sync + 'static,
    gradient: impl Fn(Vec3) -> Result<Vec3, String> + Send + Sync + 'static,
    hessian: impl Fn(Vec3) -> Result<Sym3, String> + Send + Sync + 'static,
) -> SignedDistance {
    SignedDistance::new(1.0, Box::new(value), Box::new(gradient), Box::new(hessian)).unwrap()
}

/// A torus around z as a true distance.
pub(super) fn ring(radius: f64, tube: f64, s: f64) -> SignedDistance {
    let split = move |x: Vec3| {
        let e = Vec3::new(x.x, x.y, 0.0).normalized().ok_or("on the axis")?;
        let w = x - e * radius;
        Ok::<_, String>((e, w, w.norm()))
    };
    distance(
        move |x| Ok(s * (split(x)?.2 - tube)),
        move |x| split(x).map(|(_, w, d)| w * (s / d)),
        move |x| {
            let (e, w, d) = split(x)?;
            let around = Vec3::unit(2).cross(e);
            let n = w / d;
            let i = Mat3::IDENTITY - Mat3::outer(n, n) - Mat3::outer(around, around);
            let rho = x.dot(e);
            let m = i * d.recip() + Mat3::outer(around, around) * (n.dot(e) / rho);
            Ok(Sym3::symmetric_part(m * s))
        },
    )
    .within(Vec3::ZERO, radius + tube)
}

/// In space.
fn solids(random: &mut Random) -> Vec<Case> {
    let c = random.vector() * 0.3;
    let axis = random.vector() * 3.0;
    let (a, e, f) = frame(axis);
    let round = move |angle: f64| e * angle.cos() + f * angle.sin();
    let radius = 1.0 + 0.3 * random.signed();
    let tube = 0.3 + 0.1 * random.signed();
    let alpha = 0.3 + random.unit();
    let coefficients: [f64; 5] = std::array::from_fn(|_| 0.6 * random.signed());
    let graph = move |x: f64| coefficients.iter().fold(0.0, |f, c| f * x + c);
    let axes = Vec3::new(1.0, 1.2, 0.8) + random.vector() * 0.1;
    let turn = Mat3::rotation(random.vector());
    let inverse = Sym3::diagonal(axes.x.powi(-2), axes.y.powi(-2), axes.z.powi(-2));
    let on_unit = |u: f64, v: f64| {
        let (p, t) = (TAU * u, PI * v);
        Vec3::new(p.cos() * t.sin(), p.sin() * t.sin(), t.cos())
    };
    vec![
        Case::new(
            "plane",
            2,
            move |o| Plane::new(c, axis * sign(o)).unwrap(),
            move |u, v| c + e * (12.0 * u - 6.0) + f * (12.0 * v - 6.0),
        ),
        Case::new(
            "sphere",
            2,
            move |o| Sphere::new(c, radius, side(o)).unwrap(),
            move |u, v| c + on_unit(u, v) * radius,
        ),
        Case::new(
            "cylinder",
            2,
            move |o| Cylinder::new(c, axis, radius, side(o)).unwrap(),
            move |u, v| c + a * (12.0 * v - 6.0) + round(TAU * u) * radius,
        ),
        Case::new(
            "cone",
            2,
            move |o| Cone::new(c, axis, alpha, side(o)).unwrap(),
            move |u, v| c + (a * alpha.cos() + round(TAU * u) * alpha.sin()) * (8.0 * v),
        ),
        Case::new(
            "torus",
            2,
            move |o| Torus::new(c, axis, radius, tube, side(o)).unwrap(),
            move |u, v| {
                let e = round(TAU * u);
                let psi = TAU * v;
                c + e * (radius + tube * psi.cos()) + a * (tube * psi.sin())
            },
        ),
        Case::new(
            "polynomial",
            2,
            move |o| {
                let facing = if o { Facing::Above } else { Facing::Below };
                Polynomial::new(&coefficients, facing).unwrap()
            },
            move |u, v| {
                let x = 12.0 * u - 6.0;
                Vec3::new(x, graph(x), 12.0 * v - 6.0)
            },
        ),
        Case::new(
            "ellipsoid",
            2,
            move |o| ellipsoid(inverse.congruence(turn), sign(o)),
            move |u, v| {
                let p = on_unit(u, v);
                turn * Vec3::new(p.x * axes.x, p.y * axes.y, p.z * axes.z)
            },
        ),
        Case::new(
            "ring",
            2,
            move |o| ring(radius, tube, sign(o)),
            move |u, v| {
                let (p, q) = (TAU * u, TAU * v);
                let r = radius + tube * q.cos();
                Vec3::new(r * p.cos(), r * p.sin(), tube * q.sin())
            },
        ),
    ]
}

/// In the plane; where a section has two parts, `v` chooses one.
fn sections(random: &mut Random) -> Vec<Case> {
    let c = Vec3::new(0.3 * random.signed(), 0.3 * random.signed(), 0.0);
    let turn = TAU * random.unit();
    let a = Vec3::new(turn.cos(), turn.sin(), 0.0);
    let e = Vec3::unit(2).cross(a);
    let either = |v: f64| if v < 0.5 { 1.0 } else { -1.0 };
    let round = |angle: f64| Vec3::new(angle.cos(), angle.sin(), 0.0);
    let radius = 1.0 + 0.3 * random.signed();
    let tube = 0.3 + 0.1 * random.signed();
    let alpha = 0.3 + random.unit();
    let z = Vec3::unit(2);
    let coefficients: [f64; 4] = std::array::from_fn(|_| random.signed());
    let graph = move |x: f64| coefficients.iter().fold(0.0, |f, c| f * x + c);
    let (p, q) = (0.8 + 0.2 * random.unit(), 1.1f64);
    let inverse = Sym3::diagonal(p.powi(-2), q.powi(-2), 0.0);
    vec![
        Case::new(
            "line",
            1,
            move |o| Plane::new(c, a * sign(o)).unwrap(),
            move |u, _| c + e * (12.0 * u - 6.0),
        ),
        Case::new(
            "circle",
            1,
            move |o| Sphere::new(c, radius, side(o)).unwrap(),
            move |u, _| c + round(TAU * u) * radius,
        ),
        Case::new(
            "cylinder along z",
            1,
            move |o| Cylinder::new(c + z, z, radius, side(o)).unwrap(),
            move |u, _| c + round(TAU * u) * radius,
        ),
        Case::new(
            "strip",
            1,
            move |o| Cylinder::new(c, a, radius, side(o)).unwrap(),
            move |u, v| c + a * (12.0 * u - 6.0) + e * (either(v) * radius),
        ),
        Case::new(
            "wedge",
            1,
            move |o| Cone::new(c, a, alpha, side(o)).unwrap(),
            move |u, v| c + (a * alpha.cos() + e * (either(v) * alpha.sin())) * (8.0 * u),
        ),
        Case::new(
            "torus around z",
            1,
            move |o| Torus::new(c, z, radius, tube, side(o)).unwrap(),
            move |u, v| c + round(TAU * u) * (radius + tube * either(v)),
        ),
        Case::new(
            "torus around its axis in the plane",
            1,
            move |o| Torus::new(c, a, radius, tube, side(o)).unwrap(),
            move |u, v| c + e * (either(v) * radius) + round(TAU * u) * tube,
        ),
        Case::new(
            "polynomial in the plane",
            1,
            move |o| {
                let facing = if o { Facing::Above } else { Facing::Below };
                Polynomial::new(&coefficients, facing).unwrap()
            },
            move |u, _| {
                let x = 12.0 * u - 6.0;
                Vec3::new(x, graph(x), 0.0)
            },
        ),
        Case::new(
            "ellipse",
            1,
            move |o| ellipsoid(inverse, sign(o)),
            move |u, _| {
                let r = round(TAU * u);
                Vec3::new(p * r.x, q * r.y, 0.0)
            },
        ),
    ]
}

fn zoo(random: &mut Random) -> Vec<Case> {
    let mut all = solids(random);
    all.extend(sections(random));
    all
}

fn zoos(n: usize, random: &mut Random) -> Vec<Case> {
    (0..n).flat_map(|_| zoo(random)).collect()
}

fn project(surface: &Analytical, at: &Placement, point: Vec3) -> Option<(Projection, SurfaceJet)> {
    let mut jet = SurfaceJet::default();
    let found = surface.project(at, 0, point, None, &mut jet).unwrap()?;
    Some((found, jet))
}

/// κ_ab and the smallest of `1 − g κ` over the tangents.
fn kappa(jet: &SurfaceJet, gap: f64) -> ([f64; 3], f64) {
    let k = jet.curvature.map(|c| c.dot(jet.normal));
    let (mean, half) = (0.5 * (k[0] + k[1]), 0.5 * (k[0] - k[1]));
    let spread = half.hypot(k[2]);
    let lowest = [mean - spread, mean + spread].map(|k| 1.0 - gap * k);
    (k, lowest[0].min(lowest[1]))
}

#[test]
fn tangents_and_normal_make_a_frame() {
    let mut random = Random(21);
    for case in zoos(20, &mut random) {
        for outside in [true, false] {
            let surface = case.fixed(outside);
            let name = case.name;
            let Some((found, jet)) = project(&surface, &EMPTY, case.near(&mut random)) else {
                continue;
            };
            let [t1, t2] = jet.tangent;
            assert_eq!((found.anchor.facet, jet.nnode), (0, 0));
            assert!((jet.normal.norm() - 1.0).abs() < 1e-14, "{name}");
            assert!((t1.norm() - 1.0).abs() < 1e-14, "{name}");
            let across = if case.ntan == 2 { t2 } else { Vec3::unit(2) };
            assert!((t1.cross(across) - jet.normal).norm() < 1e-14, "{name}");
            let second = if case.ntan == 2 { 1.0 } else { 0.0 };
            assert!((t2.norm() - second).abs() < 1e-14, "{name}");
            assert_eq!(jet.metric, [1.0, second, 0.0], "{name}");
            // the anchor alone gives the same
            let mut again = SurfaceJet::default();
            surface.jet(&EMPTY, &found.anchor, &mut again).unwrap();
            assert_eq!(again.position, jet.position);
            assert_eq!(again.curvature, jet.curvature);
        }
    }
}

#[test]
fn curvature_matches_differences_of_a_parametrisation() {
    let mut random = Random(22);
    for case in zoos(20, &mut random) {
        let surface = case.fixed(true);
        let other = case.fixed(false);
        for _ in 0..5 {
            let [u, v] = [0.2 + 0.2 * random.unit(), 0.15 + 0.3 * random.unit()];
            let mut jet = SurfaceJet::default();
            let local = (case.point)(u, v);
            let anchor = Anchor { facet: 0, local };
            surface.jet(&EMPTY, &anchor, &mut jet).unwrap();
            let h = 1e-3;
            let p = |i: f64, j: f64| (case.point)(u + i * h, v + j * h);
            // fourth order
            let slope = |i: f64, j: f64| {
                (p(i, j) - p(-i, -j)) * (2.0 / (3.0 * h))
                    - (p(2.0 * i, 2.0 * j) - p(-2.0 * i, -2.0 * j)) / (12.0 * h)
            };
            let bend = |i: f64, j: f64| {
                let near = (p(i, j) + p(-i, -j)) * (4.0 / 3.0);
                let far = (p(2.0 * i, 2.0 * j) + p(-2.0 * i, -2.0 * j)) / 12.0;
                (near - far - p(0.0, 0.0) * 2.5) / (h * h)
            };
            let directions: &[(f64, f64)] = match case.ntan {
                1 => &[(1.0, 0.0)],
                _ => &[(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0)],
            };
            for &(i, j) in directions {
                let along = slope(i, j);
                let tolerance = 1e-7 * along.norm_squared().max(1.0);
                assert!(along.dot(jet.normal).abs() < tolerance, "{}", case.name);
                let d = jet.tangent.map(|t| t.dot(along));
                let [k11, k22, k12] = jet.curvature.map(|c| c.dot(jet.normal));
                let found = k11 * d[0] * d[0] + k22 * d[1] * d[1] + 2.0 * k12 * d[0] * d[1];
                let expected = bend(i, j).dot(jet.normal);
                assert!(
                    (found - expected).abs() < tolerance,
                    "{}: {found} {expected}",
                    case.name
                );
            }
            let mut back = SurfaceJet::default();
            other.jet(&EMPTY, &anchor, &mut back).unwrap();
            assert_eq!(back.normal, -jet.normal);
        }
    }
}

#[test]
fn projection_of_shapes_agrees_with_brute_force() {
    let mut random = Random(23);
    let mut checked = 0;
    let mut vertices = 0;
    for case in zoos(12, &mut random) {
        let surface = case.fixed(true);
        for _ in 0..6 {
            let point = case.near(&mut random);
            let expected = smallest(|u, v| (point - (case.point)(u, v)).norm());
            let Some((found, jet)) = project(&surface, &EMPTY, point) else {
                // beyond the centres of curvature of a function that is no distance
                assert!(case.name.starts_with("ellips"), "{}", case.name);
                continue;
            };
            let name = case.name;
            if name.starts_with("ellips") && found.distance > expected + 1e-9 {
                // ... another branch may be closer there
                let gap = (point - jet.position).dot(jet.normal);
                assert!(gap < -0.5, "{name} {gap}");
                continue;
            }
            checked += 1;
            assert!(
                (found.distance - expected).abs() < 1e-9,
                "{name}: {} {expected}",
                found.distance
            );
            let away = point - jet.position;
            assert!((away.norm() - found.distance).abs() < 1e-14, "{name}");
            if found.feature == Feature::Face {
                let off = away - jet.normal * away.dot(jet.normal);
                assert!(off.norm() < 1e-12, "{name}: {:e}", off.norm());
            } else {
                vertices += 1;
                assert!(["cone", "wedge"].contains(&name));
                assert!(away.dot(jet.normal) > 0.0);
            }
            if surface.aabb(&EMPTY, 0).is_bounded() {
                assert!(
                    surface
                        .aabb(&EMPTY, 0)
                        .inflated(1e-12)
                        .contains(jet.position)
                );
            }
        }
    }
    assert!(checked > 1100 && vertices > 10, "{checked} {vertices}");
}

/// (E1), (E2) of the head of `analytical.rs`.
#[test]
fn gradient_and_hessian_of_the_gap_match_differences() {
    let mut random = Random(24);
    let mut checked = std::collections::BTreeMap::new();
    for case in zoos(20, &mut random) {
        let surface = case.fixed(random.bits().is_multiple_of(2));
        for _ in 0..8 {
            let point = case.near(&mut random);
            let Some((found, jet)) = project(&surface, &EMPTY, point) else {
                continue;
            };
            let gap = (point - jet.position).dot(jet.normal);
            let (k, margin) = kappa(&jet, gap);
            if margin < 0.2 || found.feature != Feature::Face {
                continue;
            }
            let h = 1e-3;
            let ndim = case.ntan + 1;
            let mut slope = Vec3::ZERO;
            let mut bend = Mat3::ZERO;
            let mut other_branch = false;
            for i in 0..ndim {
                for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                    let there = point + Vec3::unit(i) * (step * h);
                    let Some((found, jet_there)) = project(&surface, &EMPTY, there) else {
                        other_branch = true;
                        continue;
                    };
                    other_branch |= (jet_there.normal - jet.normal).norm() > 0.1
                        || found.feature != Feature::Face;
                    let gap = (there - jet_there.position).dot(jet_there.normal);
                    slope[i] += weight * gap / (12.0 * h);
                    bend.rows[i] += jet_there.normal * (weight / (12.0 * h));
                }
            }
            if other_branch {
                continue;
            }
            assert!((slope - jet.normal).norm() < 1e-7, "{}", case.name);
            // −κ (I − g κ)⁻¹, as tensors of space
            let mut form = Mat3::ZERO;
            for (a, b) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
                form = form + Mat3::outer(jet.tangent[a], jet.tangent[b]) * k[pair(a, b)];
            }
            let (inverse, _) = (Mat3::IDENTITY - form * gap).inverse().unwrap();
            let expected = form * inverse * -1.0;
            let off = bend - expected;
            let off = off.rows.iter().map(|r| r.max_abs()).fold(0.0, f64::max);
            assert!(off < 1e-5, "{}: {off:e} at {gap}", case.name);
            *checked.entry(case.name).or_insert(0) += 1;
        }
    }
    assert_eq!(checked.len(), 17, "{checked:?}");
    assert!(checked.values().all(|&n| n > 15), "{checked:?}");
}

#[test]
fn what_carries_a_shape_carries_its_closest_points() {
    let mut random = Random(25);
    for case in zoos(20, &mut random) {
        let reference = case.flat(random.vector());
        let turn = match case.ntan {
            1 => Vec3::new(0.0, 0.0, 3.0 * random.signed()),
            _ => random.vector() * 2.0,
        };
        let pose = Pose {
            origin: case.flat(random.vector() * 3.0),
            rotation: Mat3::rotation(turn),
        };
        let still = Pose {
            origin: reference,
            rotation: Mat3::IDENTITY,
        };
        let fixed = case.fixed(true);
        let carried = case.surface(true, Mount::on(case.ntan, 1, reference));
        assert_eq!(carried.carrier(0), Carrier::Rigid(1));
        assert_eq!(fixed.carrier(0), Carrier::Fixed);
        let moved = |x: Vec3| pose.origin + pose.rotation * (x - reference);
        let point = case.near(&mut random);
        let Some((here, jet)) = project(&fixed, &EMPTY, point) else {
            continue;
        };
        let swapped = [pose, still];
        let at = |poses| Placement { x: &[], poses };
        let (same, _) = project(&carried, &at(&swapped), point).unwrap();
        assert!((same.anchor.local - here.anchor.local).norm() < 1e-12);
        let poses = [still, pose];
        let (there, turned) = project(&carried, &at(&poses), moved(point)).unwrap();
        let name = case.name;
        assert!((there.distance - here.distance).abs() < 1e-12, "{name}");
        assert_eq!(there.feature, here.feature);
        assert!(
            (there.anchor.local - here.anchor.local).norm() < 1e-11,
            "{name}"
        );
        assert!(
            (turned.position - moved(jet.position)).norm() < 1e-11,
            "{name}"
        );
        assert!(
            (turned.normal - pose.rotation * jet.normal).norm() < 1e-11,
            "{name}"
        );
        let outward = carried.outward(&at(&poses), &there).unwrap();
        assert!(!outward.rim);
        assert!((outward.direction - turned.normal).norm() < 1e-14, "{name}");
        let (k, _) = kappa(&jet, 0.0);
        let (kt, _) = kappa(&turned, 0.0);
        let invariants = |k: [f64; 3]| (k[0] + k[1], k[0] * k[1] - k[2] * k[2]);
        let ((t, d), (tt, dt)) = (invariants(k), invariants(kt));
        let scale = 1.0 + t * t + d.abs();
        assert!(
            (t - tt).abs() < 1e-8 * scale && (d - dt).abs() < 1e-8 * scale,
            "{name}"
        );
        let aabb = carried.aabb(&at(&poses), 0);
        assert!(aabb.inflated(1e-12).contains(turned.position));
    }
}

#[test]
fn a_hole_is_the_body_of_its_shape_turned_inside_out() {
    let mut random = Random(26);
    let mut signs = [0; 2];
    for case in zoos(20, &mut random) {
        let point = case.near(&mut random);
        let body = project(&case.fixed(true), &EMPTY, point);
        let hole = project(&case.fixed(false), &EMPTY, point);
        let (Some((f, body)), Some((g, hole))) = (body, hole) else {
            continue;
        };
        assert!(
            (body.position - hole.position).norm() < 1e-12,
            "{}",
            case.name
        );
        assert!((body.normal + hole.normal).norm() < 1e-12);
        assert_eq!(f.feature, g.feature);
        let gap = (point - body.position).dot(body.normal);
        signs[usize::from(gap > 0.0)] += 1;
    }
    assert!(signs.iter().all(|&n| n > 50), "{signs:?}");
}

#[test]
fn where_a_whole_circle_is_closest_there_is_no_closest_point() {
    let (o, z) = (Vec3::ZERO, Vec3::unit(2));
    let none = |shape: Box<dyn Shape>, point: Vec3| {
        let surface = Analytical::new(Mount::fixed(2), shape).unwrap();
        project(&surface, &EMPTY, point).is_none()
    };
    let ball = || Box::new(Sphere::new(z, 1.0, Side::Inside).unwrap());
    assert!(none(ball(), z) && !none(ball(), o));
    assert!(none(ball(), Vec3::new(f64::NAN, 0.0, 0.0)));
    let rod = Cylinder::new(o, z, 1.0, Side::Outside).unwrap();
    assert!(none(Box::new(rod), z * 5.0));
    let tip = || Box::new(Cone::new(o, z, 0.5, Side::Outside).unwrap());
    assert!(none(tip(), z) && !none(tip(), -z) && !none(tip(), o));
    let tyre = || Box::new(Torus::new(o, z, 2.0, 0.5, Side::Outside).unwrap());
    assert!(none(tyre(), z) && none(tyre(), Vec3::new(0.0, 2.0, 0.0)));
    assert!(none(Box::new(ellipsoid(Sym3::IDENTITY, 1.0)), o));
    // beyond the centre of curvature of the foot, which is on the long axis
    let long = ellipsoid(Sym3::diagonal(0.01, 1.0, 1.0), 1.0);
    assert!(none(Box::new(long), Vec3::unit(0)));
    assert!(!none(
        Box::new(ring(2.0, 0.5, 1.0)),
        Vec3::new(3.0, 0.0, 1.0)
    ));
}

#[test]
fn shapes_that_are_none_are_refused_in_words() {
    let (o, z, nan) = (Vec3::ZERO, Vec3::unit(2), Vec3::new(0.0, f64::NAN, 0.0));
    let outside = Side::Outside;
    let said = |e: AnalyticalError| e.to_string();
    assert_eq!(
        said(Plane::new(o, o).unwrap_err()),
        "the normal of the plane is zero; it must be a direction"
    );
    assert_eq!(
        said(Plane::new(nan, z).unwrap_err()),
        "the point of the plane must be finite"
    );
    assert_eq!(
        said(Sphere::new(o, -1.0, outside).unwrap_err()),
        "the radius of the sphere is -1; it must be positive and finite"
    );
    for radius in [0.0, f64::NAN, f64::INFINITY] {
        assert!(Sphere::new(o, radius, outside).is_err());
        assert!(Cylinder::new(o, z, radius, outside).is_err());
        assert!(Torus::new(o, z, radius, 0.1, outside).is_err());
        assert!(Torus::new(o, z, 1.0, radius, outside).is_err());
    }
    assert!(Cylinder::new(o, o, 1.0, outside).is_err());
    for angle in [0.0, -0.1, PI / 2.0, 2.0, f64::NAN] {
        assert!(Cone::new(o, z, angle, outside).is_err());
    }
    assert_eq!(
        said(Cone::new(o, z, PI, outside).unwrap_err()),
        "the half angle is 180°; it must lie between 0° and 90°"
    );
    assert_eq!(
        said(Torus::new(o, z, 1.0, 1.0, outside).unwrap_err()),
        "the tube's radius is 1; it must be smaller than that of the ring, 1"
    );
    let polynomial = |c: &[f64]| Polynomial::new(c, Facing::Above);
    assert!(polynomial(&[]).is_err() && polynomial(&[f64::NAN]).is_err());
    assert!(polynomial(&[1.0; MAX_DEGREE + 1]).is_ok());
    assert_eq!(
        said(polynomial(&[1.0; MAX_DEGREE + 2]).unwrap_err()),
        "the polynomial is of degree 11; 10 is the most"
    );
    let value = Box::new(|x: Vec3| Ok(x.z));
    let unsized_plane = SignedDistance::new(0.0, value, Box::new(Ok), Box::new(|_| Ok(Sym3::ZERO)));
    assert_eq!(
        said(unsized_plane.unwrap_err()),
        "the size of the surface is 0; it must be positive and finite"
    );
    // huge and tiny directions are directions
    assert!(Plane::new(o, z * 1e300).is_ok() && Plane::new(o, z * 1e-300).is_ok());

    let plane = |shape: Box<dyn Shape>| Analytical::new(Mount::fixed(1), shape).map(|_| ());
    let tilted = Vec3::new(1.0, 0.0, 1.0);
    assert_eq!(
        said(plane(Box::new(Plane::new(o, tilted).unwrap())).unwrap_err()),
        "in a model of the plane the normal must have no component along z"
    );
    assert!(plane(Box::new(Sphere::new(z, 1.0, outside).unwrap())).is_err());
    assert!(plane(Box::new(Cylinder::new(o, tilted, 1.0, outside).unwrap())).is_err());
    assert!(
        plane(Box::new(
            Cylinder::new(z, Vec3::unit(0), 1.0, outside).unwrap()
        ))
        .is_err()
    );
    assert!(plane(Box::new(Cone::new(o, z, 0.5, outside).unwrap())).is_err());
    assert!(plane(Box::new(Torus::new(o, tilted, 1.0, 0.5, outside).unwrap())).is_err());
    let sphere = || Box::new(Sphere::new(o, 1.0, outside).unwrap());
    assert!(Analytical::new(Mount::fixed(3), sphere()).is_err());
    assert!(Analytical::new(Mount::on(2, 0, nan), sphere()).is_err());
    let surface = Analytical::new(Mount::fixed(2), sphere()).unwrap();
    let beyond = Anchor { facet: 1, local: z };
    let mut jet = SurfaceJet::default();
    assert_eq!(
        surface.jet(&EMPTY, &beyond, &mut jet),
        Err(SurfaceError::NoSuchFacet { facet: 1 })
    );
}
