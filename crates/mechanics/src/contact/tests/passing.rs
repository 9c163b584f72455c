//! What comes fast, and from afar, within one increment is met, or the increment fails.

use super::own::{KINDS, NEVER, Skin, rectangle, rows, surface};
use crate::contact::discretization::{FacetSizes, REACH, SurfacePair};
use crate::contact::{Interface, InterfaceParts};
use crate::system::{Adaptive, Choices, Elimination, Layout, Order, State, Term};
use signorini_geometry::surface::Placement;
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// The label of the face of the plate that the block comes to.
const TOP: usize = 2;

struct Falls {
    interface: Interface,
    labels: Vec<usize>,
    layout: Layout,
    reference: Vec<Vec3>,
    state: State,
    nplate: usize,
}

impl Falls {
    /// A block, `gap` above a plate of this thickness; of rows, those of nodes or of points inside facets.
    fn new(kind: &str, thickness: f64, gap: f64, inside: usize) -> Self {
        let skin = |outline| Skin {
            name: "",
            outlines: vec![outline],
            may_touch: NEVER,
            touches: false,
            hollow: false,
        };
        let plate = rectangle([0.0, -thickness], [6.0, thickness], 0.5, 0);
        let block = rectangle([1.1, gap], [3.0, 1.0], 0.4, 0);
        let both = Skin {
            outlines: vec![plate, block],
            ..skin(rectangle([0.0, 0.0], [1.0, 1.0], 1.0, 0))
        };
        let (all, x, labels, _) = surface(&both, kind, 0.0);
        // facets of both bodies, which share no nodes
        let high = |f: u32| {
            let nodes = all.nodes(f).iter();
            nodes.clone().all(|&n| x[n as usize].y > 0.5 * gap)
        };
        let nfacet = labels.len() as u32;
        let nplate = (0..nfacet).filter(|&f| !high(f)).count();
        let part = |of_block: bool| {
            let facets = (0..nfacet).filter(|&f| high(f) == of_block);
            let named: Vec<_> = facets.map(|f| (kind, all.nodes(f).to_vec())).collect();
            super::facets_of(&mut x.clone(), &named)
        };
        let (primary, secondary) = (part(false), part(true));
        let [nodes, points] = rows(&secondary);
        let method = if inside == 0 { nodes } else { points };
        let at = Placement { x: &x, poses: &[] };
        let of_block = secondary.all_nodes();
        let sizes = FacetSizes::new(&of_block, Some(&secondary), &primary, &at);
        let largest = sizes.primary.iter().copied().fold(0.0, f64::max);
        let pair = SurfacePair {
            secondary: Some(secondary),
            sizes,
            ..SurfacePair::new(of_block, Arc::new(primary), REACH * largest)
        };
        let ndim = if kind.starts_with("line") { 2 } else { 3 };
        let layout = Layout::new(ndim, x.len(), 0);
        let elimination = Arc::new(Elimination::default());
        let state = State::initial(&layout, &x, &elimination);
        let parts = InterfaceParts::new("falls", pair, Box::new(method), 7.0);
        let mut interface = Interface::new(parts, layout, elimination);
        interface.begin(&super::next_increment(), &state).unwrap();
        interface.prepare(&state, Order::Tangent).unwrap();
        Self {
            interface,
            labels,
            layout,
            reference: x,
            state,
            nplate,
        }
    }

    /// The state with the block moved, and all of it carried along.
    fn moved(&self, block: Vec3, carried: Vec3) -> State {
        let mut du = vec![0.0; self.layout.ndof()];
        for node in 0..self.layout.nnode() as u32 {
            let of_block = self.interface.parts().pair.points.contains(&node);
            let by = if of_block { carried + block } else { carried };
            for axis in 0..self.layout.ndim() {
                du[self.layout.node(node, axis) as usize] = by[axis];
            }
        }
        let mut state = self.state.clone();
        let nothing = Elimination::default();
        state.advance_from(
            &self.state,
            &du,
            1.0,
            &self.layout,
            &self.reference,
            &nothing,
        );
        state
    }

    /// Rows of the lower face of the block that are below the upper face of the plate now.
    fn below(&self, state: &State, level: f64) -> Vec<usize> {
        let method = &self.interface.parts().discretization;
        let at = |row: usize, x: &[Vec3]| method.point(row).position(&Placement { x, poses: &[] });
        let lowest = (0..method.nrow()).map(|row| at(row, &self.reference).y);
        let lowest = lowest.fold(f64::INFINITY, f64::min) + 1e-9;
        let rows = (0..method.nrow()).filter(|&row| at(row, &self.reference).y < lowest);
        rows.filter(|&row| at(row, &state.x).y < level).collect()
    }
}

#[test]
fn a_body_that_comes_fast_within_one_increment_is_met_or_the_increment_fails() {
    let (mut met, mut failed) = (0, 0);
    for kind in KINDS {
        for thickness in [0.1, 0.6] {
            for (gap, inside) in [(0.05, 0), (0.05, 1), (0.8, 0), (3.0, 1)] {
                let mut falls = Falls::new(kind, thickness, gap, inside);
                for way in [0.07, 0.2, 0.5, 4.0] {
                    let carried = Vec3::new(90.0, -35.0, 0.0);
                    let sideways = Vec3::new(0.31 * f64::min(way, 1.0), 0.0, 0.0);
                    let state = falls.moved(Vec3::new(0.0, -way, 0.0) + sideways, carried);
                    falls.interface.reject();
                    let told = falls.interface.prepare(&state, Order::Tangent);
                    let below = falls.below(&state, carried.y);
                    if told.is_err() {
                        failed += 1;
                        assert!(!below.is_empty(), "{kind}: nothing went through");
                        continue;
                    }
                    for row in below {
                        met += 1;
                        let found = falls.interface.pairing().pairs[row];
                        let place = format!("{kind} t {thickness} gap {gap} way {way}");
                        let found = found.unwrap_or_else(|| panic!("{place}: lost"));
                        let label = falls.labels[found.anchor.facet as usize];
                        assert!(found.gap < 0.0, "{place}: gap {}", found.gap);
                        assert_eq!(label, TOP, "{place}");
                    }
                }
            }
        }
    }
    assert!(met > 100 && failed > 20, "{met} {failed}");
}

#[test]
fn what_goes_along_with_a_surface_sees_the_same_however_far() {
    for kind in KINDS {
        let mut falls = Falls::new(kind, 0.3, 0.05, 0);
        assert!(falls.nplate > 0);
        let here = falls.moved(Vec3::new(0.0, -0.02, 0.0), Vec3::ZERO);
        falls.interface.prepare(&here, Order::Tangent).unwrap();
        let facets = |falls: &Falls| -> Vec<Option<u32>> {
            let pairs = falls.interface.pairing().pairs.iter();
            pairs.map(|p| p.map(|p| p.anchor.facet)).collect()
        };
        let right = facets(&falls);
        assert!(right.iter().any(Option::is_some));
        let far = falls.moved(Vec3::new(0.0, -0.02, 0.0), Vec3::new(64.0, -32.0, 0.0));
        falls.interface.prepare(&far, Order::Tangent).unwrap();
        assert_eq!(facets(&falls), right);
    }
}
