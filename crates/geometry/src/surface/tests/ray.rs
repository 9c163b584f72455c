//! Lines that cross facets, against the points of the facets themselves.

use super::*;

/// A point of the reference domain, or up to `beyond` outside it.
fn local(element: Element, random: &mut Random, beyond: f64) -> Vec3 {
    let mut xi = random.vector() * (1.0 + beyond);
    xi.z = 0.0;
    if element.dim() == 1 {
        xi.y = 0.0;
    }
    xi
}

fn position(surface: &Facets, x: &[Vec3], local: Vec3) -> Vec3 {
    let mut jet = SurfaceJet::default();
    let at = Placement { x, poses: &[] };
    surface
        .jet(&at, &Anchor { facet: 0, local }, &mut jet)
        .unwrap();
    jet.position
}

/// A flat facet: an affine image of the reference element, in any place.
fn flat(surface: &Facets, n: usize, random: &mut Random) -> Vec<Vec3> {
    let element = surface.element(0).unwrap();
    let (origin, [a, b]) = (random.vector(), [0; 2].map(|_| random.vector()));
    let mut x = vec![Vec3::ZERO; n];
    for (xi, &node) in element.nodes().iter().zip(surface.nodes(0)) {
        let mut place = origin + a * xi.x + b * xi.y;
        if element.dim() == 1 {
            place.z = 0.0;
        }
        x[node as usize] = place;
    }
    x
}

#[test]
fn a_line_crosses_a_flat_facet_where_a_point_of_it_is() {
    let mut random = Random(11);
    for element in kinds() {
        let kind = element.name();
        let (surface, start) = single(element);
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..1500 {
            let x = flat(&surface, start.len(), &mut random);
            let xi = local(element, &mut random, 0.5);
            let to = position(&surface, &x, xi);
            let mut along = random.vector();
            if element.dim() == 1 {
                along.z = 0.0;
            }
            let s = random.unit() * 3.0;
            let crossed = surface.crossed_at(&x, 0, to - along * s, along);
            if element.contains(&xi, -1e-3) {
                inside += 1;
                let crossed = crossed.unwrap();
                assert!(
                    (crossed - s).abs() < 1e-6 * (1.0 + s),
                    "{kind}: {crossed} {s}"
                );
                assert_eq!(surface.crossed_at(&x, 0, to + along * 1e-3, along), None);
            } else if !element.contains(&xi, 1e-3) {
                outside += 1;
                assert_eq!(crossed, None, "{kind}: {xi:?}");
            }
        }
        assert!(inside > 50 && outside > 50, "{kind}: {inside} {outside}");
    }
}

#[test]
fn a_line_through_a_bent_facet_crosses_it_up_to_a_part_of_its_height() {
    let mut random = Random(12);
    for element in kinds().filter(|e| !e.is_linear()) {
        let kind = element.name();
        let (surface, start) = single(element);
        let mut x = vec![Vec3::ZERO; start.len()];
        let height = 0.1;
        let across = if element.dim() == 1 {
            Vec3::unit(1)
        } else {
            Vec3::unit(2)
        };
        for (xi, &node) in element.nodes().iter().zip(surface.nodes(0)) {
            x[node as usize] = *xi + across * (height * (1.0 - xi.x * xi.x));
        }
        for _ in 0..200 {
            let xi = local(element, &mut random, 0.0);
            if !element.contains(&xi, -1e-3) {
                continue;
            }
            let from = position(&surface, &x, xi) - across;
            let s = surface.crossed_at(&x, 0, from, across).unwrap();
            assert!((s - 1.0).abs() < 0.26 * height, "{kind}: {s}");
        }
    }
}
