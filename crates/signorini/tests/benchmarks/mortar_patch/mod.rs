//! The patch test of two blocks that are joined by mortar contact.
mod blocks;

use blocks::{Blocks, Errors, Strains};

const PLANE: [&str; 5] = ["quad4", "tri3", "quad8", "quad9", "tri6"];
const SPACE: [&str; 7] = ["hex8", "tet4", "wedge6", "hex20", "hex27", "tet10", "wedge15"];

/// Distortion of the meshes, at which rules are exact.
const DISTORTION: f64 = 0.12;

fn pairings<const N: usize>(names: [&'static str; N]) -> Vec<[&'static str; 2]> {
    names.iter().flat_map(|a| names.map(|b| [*a, b])).collect()
}

/// One line: the largest errors of a pairing.
fn told(name: &str, elements: [&str; 2], errors: Errors) {
    let Errors { displacement, stress, pressure } = errors;
    let [lower, upper] = elements;
    println!("{name}: {lower} under {upper}: u {displacement:.1e} stress {stress:.1e} pressure {pressure:.1e}");
}

/// Both sides as the secondary one.
fn either(blocks: &Blocks, strain: f64) -> Errors {
    let exact = blocks.pressed(strain);
    let with = |upper_is_secondary| Blocks { upper_is_secondary, ..blocks.clone() }.errors(&exact);
    with(true).or(with(false))
}

fn in_the_plane(strains: Strains, young: [f64; 2], strain: f64) {
    for elements in pairings(PLANE) {
        let blocks = Blocks { strains, young, ..Blocks::new(elements, DISTORTION) };
        let errors = either(&blocks, strain);
        told(&format!("{strains:?}"), elements, errors);
        assert!(errors.most() < 1e-12, "{elements:?}: {errors:?}");
    }
}

#[test]
fn in_the_plane_every_pairing_passes() {
    let start = std::time::Instant::now();
    in_the_plane(Strains::Held, [100.0, 200.0], -0.01);
    in_the_plane(Strains::Linear, [100.0; 2], -0.01);
    in_the_plane(Strains::Finite, [100.0; 2], -0.1);
    println!("{:?}", start.elapsed());
}

fn in_space(strains: Strains, young: [f64; 2], strain: f64) {
    for elements in pairings(SPACE) {
        let blocks = Blocks { strains, young, ..Blocks::new(elements, DISTORTION) };
        let start = std::time::Instant::now();
        let errors = either(&blocks, strain);
        told(&format!("{:?} {strains:?}", start.elapsed()), elements, errors);
        assert!(errors.most() < 1e-10, "{elements:?}: {errors:?}");
    }
}

#[test]
fn in_space_every_pairing_passes() {
    in_space(Strains::Held, [100.0, 200.0], -0.01);
}

#[test]
fn in_space_every_pairing_passes_linear() {
    in_space(Strains::Linear, [100.0; 2], -0.01);
}

#[test]
fn in_space_every_pairing_passes_finite() {
    in_space(Strains::Finite, [100.0; 2], -0.1);
}
