//! Rigid triangles: a box against its exact distance, moved and turned; what is no surface.

use crate::mesh::NodeId;
use crate::random::Random;
use crate::surface::*;
use crate::tensor::{Mat3, Vec3};

/// The box `|x_i| ≤ h_i`, of 12 triangles with their normals out.
fn block(h: Vec3) -> (Vec<Vec3>, Vec<[NodeId; 3]>) {
    let sign = |k: u32, bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |k| Vec3::new(h.x * sign(k, 0), h.y * sign(k, 1), h.z * sign(k, 2));
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |[a, b, c, d]: [NodeId; 4]| [[a, b, c], [a, c, d]];
    (
        (0..8).map(corner).collect(),
        sides.into_iter().flat_map(halves).collect(),
    )
}

/// The signed distance of that box.
fn distance(h: Vec3, x: Vec3) -> f64 {
    let q = Vec3::new(x.x.abs(), x.y.abs(), x.z.abs()) - h;
    q.max(Vec3::ZERO).norm() + q.x.max(q.y).max(q.z).min(0.0)
}

/// The closest facet's answer: signed by the outward direction.
fn gap(surface: &Triangulated, at: &Placement, point: Vec3) -> (f64, Feature, Vec3) {
    let mut jet = SurfaceJet::default();
    let facets = 0..surface.nfacet() as u32;
    let all = facets.filter_map(|f| surface.project(at, f, point, None, &mut jet).unwrap());
    let found = all
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .unwrap();
    surface.jet(at, &found.anchor, &mut jet).unwrap();
    let outward = surface.outward(at, &found).unwrap();
    assert!(!outward.rim);
    let side = outward.direction.dot(point - jet.position);
    (found.distance.copysign(side), found.feature, jet.position)
}

#[test]
fn a_moved_block_of_triangles_has_the_distance_of_a_box() {
    let mut random = Random(31);
    let h = Vec3::new(1.0, 0.6, 0.4);
    let (points, triangles) = block(h);
    let reference = random.vector();
    let mount = Mount::on(2, 0, reference);
    let surface = Triangulated::new(mount, points, &triangles).unwrap();
    assert_eq!(
        (surface.nfacet(), surface.carrier(3)),
        (12, Carrier::Rigid(0))
    );
    let mut kinds = [0; 3];
    for _ in 0..2000 {
        let pose = Pose {
            origin: random.vector() * 5.0,
            rotation: Mat3::rotation(random.vector() * 2.0),
        };
        let poses = [pose];
        let at = Placement {
            x: &[],
            poses: &poses,
        };
        let x = random.vector() * 1.5;
        let there = pose.origin + pose.rotation * (x - reference);
        let (found, feature, foot) = gap(&surface, &at, there);
        let expected = distance(h, x);
        assert!(
            (found - expected).abs() < 1e-12,
            "{found} {expected} {feature:?}"
        );
        assert!(((there - foot).norm() - found.abs()).abs() < 1e-13);
        kinds[match feature {
            Feature::Face => 0,
            Feature::Edge { .. } => 1,
            Feature::Vertex => 2,
        }] += 1;
        let boxes = (0..12).map(|f| surface.aabb(&at, f));
        let around = boxes.fold(crate::proximity::Aabb::EMPTY, |a, b| a.union(b));
        assert!(around.inflated(1e-12).contains(foot));
    }
    assert!(kinds.iter().all(|&k| k > 100), "{kinds:?}");
    let fixed = Triangulated::new(Mount::fixed(2), block(h).0, &triangles).unwrap();
    let none = Placement { x: &[], poses: &[] };
    assert_eq!(fixed.carrier(0), Carrier::Fixed);
    assert!((gap(&fixed, &none, Vec3::new(2.0, 0.1, 0.1)).0 - 1.0).abs() < 1e-15);
}

#[test]
fn jets_of_moved_triangles_match_differences() {
    let mut random = Random(32);
    let (points, triangles) = block(Vec3::new(1.0, 0.6, 0.4));
    let surface = Triangulated::new(Mount::on(2, 0, Vec3::unit(1)), points, &triangles).unwrap();
    let poses = [Pose {
        origin: random.vector(),
        rotation: Mat3::rotation(random.vector()),
    }];
    let at = Placement {
        x: &[],
        poses: &poses,
    };
    for facet in 0..12 {
        let jet_at = |local: Vec3| {
            let mut jet = SurfaceJet::default();
            surface
                .jet(&at, &Anchor { facet, local }, &mut jet)
                .unwrap();
            jet
        };
        let middle = Vec3::new(0.3, 0.3, 0.0);
        let jet = jet_at(middle);
        assert_eq!(jet.nnode, 0);
        for a in 0..2 {
            let along = jet_at(middle + Vec3::unit(a) * 0.1).position - jet.position;
            assert!((along * 10.0 - jet.tangent[a]).norm() < 1e-13);
            assert!((jet.tangent[a].norm_squared() - jet.metric[a]).abs() < 1e-13);
        }
        let normal = jet.tangent[0].cross(jet.tangent[1]).normalized().unwrap();
        assert!((normal - jet.normal).norm() < 1e-14);
        assert_eq!(jet.curvature, [Vec3::ZERO; 3]);
        // out of the block, whose middle has moved along
        let middle = poses[0].origin - poses[0].rotation * Vec3::unit(1);
        assert!((jet.position - middle).dot(jet.normal) > 0.3);
    }
}

#[test]
fn an_open_surface_has_a_rim() {
    let (points, mut triangles) = block(Vec3::new(1.0, 1.0, 1.0));
    triangles.truncate(2);
    let surface = Triangulated::new(Mount::fixed(2), points, &triangles).unwrap();
    let at = Placement { x: &[], poses: &[] };
    let mut jet = SurfaceJet::default();
    let beside = Vec3::new(-0.5, 1.5, -1.2);
    let all = (0..2).filter_map(|f| surface.project(&at, f, beside, None, &mut jet).unwrap());
    let found = all
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .unwrap();
    assert!(surface.outward(&at, &found).unwrap().rim);
    assert_eq!(surface.neighbours(0), [1]);
    assert!((surface.size(&at, 0) - 2f64.sqrt()).abs() < 1e-14);
}

#[test]
fn triangles_that_are_no_surface_are_refused_in_words() {
    let said = |points: Vec<Vec3>, triangles: &[[NodeId; 3]]| {
        Triangulated::new(Mount::fixed(2), points, triangles)
            .unwrap_err()
            .to_string()
    };
    let (points, triangles) = block(Vec3::new(1.0, 1.0, 1.0));
    assert_eq!(said(points.clone(), &[]), "the surface has no triangles");
    assert_eq!(
        said(points.clone(), &[[0, 1, 2], [1, 2, 8]]),
        "triangle 2 has point 8, but there are 8 points, from 0"
    );
    let mut turned = triangles.clone();
    turned[5].swap(0, 1);
    assert!(said(points.clone(), &turned).contains("turned inside out"));
    assert!(said(points.clone(), &[[0, 0, 1]]).contains("triangle 1 has no area"));
    let mut flat = points.clone();
    flat[1] = (flat[0] + flat[2]) * 0.5;
    assert!(said(flat, &[[0, 1, 2]]).contains("no area"));
    let mut infinite = points.clone();
    infinite[7].x = f64::INFINITY;
    assert!(said(infinite, &triangles).contains("must be finite"));
    let plane = Triangulated::new(Mount::fixed(1), points, &triangles).unwrap_err();
    assert!(plane.to_string().contains("cannot be made of triangles"));
}
