//! What discretizations promise beyond rows.

use super::next_increment;
use super::scene::{Choice, Kind, Method, Scene};
use crate::contact::discretization::{Averaged, BentSides, Capabilities};
use crate::contact::law::Penalty;
use crate::system::{Adaptive, Order, Term};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

const METHODS: [Method; 11] = [
    Method::NodeToSegment,
    Method::SmallSliding,
    Method::OfIncrement,
    Method::Gauss,
    Method::Lobatto,
    Method::GivenNormals,
    Method::PrimaryNormals,
    Method::SecondaryNormals,
    Method::Mortar,
    Method::NodalMortar,
    Method::HeldMortar,
];

/// Every method over several kinds of facets, where the sides have met.
fn scenes() -> impl Iterator<Item = Scene> {
    let kinds = ["line2", "quad4", "tri6"].map(Kind::Elements);
    let both = kinds
        .into_iter()
        .flat_map(|kind| METHODS.map(|method| (kind, method)));
    both.map(|(kind, method)| {
        let choice = Choice::of(Box::new(Penalty));
        let mut scene = Scene::new(kind, method, choice, 5);
        let start = scene.state.clone();
        scene.interface.begin(&next_increment(), &start).unwrap();
        scene.interface.prepare(&start, Order::Residual).unwrap();
        scene
    })
}

fn capabilities(scene: &Scene) -> Capabilities<'_> {
    scene.interface.parts().discretization.capabilities()
}

/// The scenes whose rows average, with them.
fn for_averaged(check: impl Fn(&Scene, &dyn Averaged)) {
    let mut count = 0;
    for scene in scenes() {
        if let Some(averaged) = capabilities(&scene).averaged {
            check(&scene, averaged);
            count += 1;
        }
    }
    assert_eq!(count, 9);
}

#[test]
fn averaged_rows_do_not_see_what_moves_both_sides_together() {
    for_averaged(|scene, averaged| {
        let pairing = scene.interface.pairing();
        let by = |_: NodeId| Vec3::new(0.3, -0.7, 0.0);
        let mut nmet = 0;
        for row in 0..pairing.pairs.len() {
            let approach = averaged.approach(row, pairing, &by);
            let way = averaged.way(row, pairing, &by);
            assert_eq!(approach.is_some(), way.is_some());
            let (Some(approach), Some((way, normal))) = (approach, way) else {
                continue;
            };
            nmet += 1;
            assert!(approach.abs() < 1e-12, "{approach:e}");
            assert!(way.norm() < 1e-12, "{way:?}");
            assert!((normal.norm() - 1.0).abs() < 1e-12);
        }
        assert!(nmet > 0);
    });
}

#[test]
fn averaged_rows_close_at_the_places_of_nodes_by_their_overlap() {
    for_averaged(|scene, averaged| {
        let pairing = scene.interface.pairing();
        let x = |node: NodeId| scene.state.x[node as usize];
        let mut nmet = 0;
        for (row, found) in pairing.pairs.iter().enumerate() {
            let (Some(found), Some(overlap)) = (found, averaged.approach(row, pairing, &x)) else {
                continue;
            };
            nmet += 1;
            assert!(
                (overlap + found.gap).abs() < 1e-12,
                "{overlap} {}",
                found.gap
            );
        }
        assert!(nmet > 0);
    });
}

#[test]
fn averaged_rows_are_not_stretched_at_the_start() {
    for_averaged(|scene, averaged| {
        for row in 0..scene.interface.pairing().pairs.len() {
            let stretch = averaged.stretch(row, scene.interface.pairing());
            assert!((stretch - 1.0).abs() < 1e-12, "{stretch}");
        }
    });
}

#[test]
fn straight_facets_that_stand_for_nothing_else_have_no_rises() {
    let mut count = 0;
    for scene in scenes() {
        let parts = scene.interface.parts();
        if let Some(curved) = capabilities(&scene).curved {
            let pairing = scene.interface.pairing();
            let at = scene.state.placement();
            let rises = curved.rises(&parts.pair, &at, pairing, &BentSides::default());
            assert_eq!(rises.unwrap(), vec![0.0; pairing.pairs.len()]);
            count += 1;
        }
    }
    assert_eq!(count, 24);
}
