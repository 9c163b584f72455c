//! Means of a rise of the surfaces over the facets they were cut from, as mortar rows weigh them.
//!
//! ```text
//! R_j = ∫ψ_j (δ^s + δ^m)
//! ```
//!
//! with the rise δ of either side over its straight facet, along the normal. `R_j/D_j` is what the gap of row j between
//! straight facets has in excess of the gap between the surfaces. Integrals are over the plane of the secondary facet, with the
//! basis and the weights (E6) of [`Covered`].

use super::pair::facing;
use super::{Covered, Facet, Frame, Measure, MortarError};
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::overlap::{Facing, integrate};
use signorini_geometry::tensor::Vec3;

/// What rules need beyond products of shape functions for a rise, which has one degree more than a linear facet along each
/// direction.
const DEGREE: usize = 2;

/// `∫ψ_j (δ^s + δ^m)` over what a secondary facet shares with primary ones, for each of its nodes: by how much a gap that is
/// measured between straight facets exceeds that of the surfaces they were cut from, times D_j.
///
/// `covered` holds the integrals of the facet `own` against `others`; `rise` is δ at a point of the own facet (`None`) or of
/// one of the others, in its parameters.
///
/// # Errors
/// A facet is folded.
pub fn rises(
    covered: &Covered,
    measure: Measure,
    own: &Facet,
    others: &[Facet],
    rise: &dyn Fn(Option<usize>, Vec3) -> f64,
) -> Result<[f64; MAX_FACET_NODES], MortarError> {
    let frame = Frame::measured(own, measure)?;
    let plane = own.plane().ok_or(MortarError::Secondary)?;
    let secondary = own
        .flat_on(&plane, Facing::Same)
        .ok_or(MortarError::Secondary)?;
    let (n, factor) = (covered.nnode(), frame.factor());
    let mut integrals = [0.0; MAX_FACET_NODES];
    for (pair, &number) in covered.pairs().iter().zip(covered.met()) {
        let other = others.get(number);
        let Some(primary) = other.and_then(|other| other.flat_on(&plane, Facing::Opposite)) else {
            continue;
        };
        let seen = facing(pair.cosine()).0;
        let done = integrate(&secondary, &primary, |cell| {
            cell.simplices(|simplex| {
                simplex.points(factor.degree() + DEGREE, |point| {
                    let at = |xi: [f64; 2]| Vec3::new(xi[0], xi[1], 0.0);
                    let rise = rise(None, at(point.secondary.xi))
                        + rise(Some(number), at(point.primary.xi));
                    let weight = seen * factor.at(point.at[0]) * point.weight;
                    for (sum, shape) in integrals.iter_mut().zip(point.secondary.shape).take(n) {
                        *sum += weight * shape * rise;
                    }
                })
            })
        });
        done.map_err(|_| MortarError::Folded { number })?;
    }
    let mut found = [0.0; MAX_FACET_NODES];
    for (j, found) in found.iter_mut().enumerate().take(n) {
        *found = covered.weighted(j, &integrals);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::by_name;

    /// Two facets of each side of the plane y = 0 or z = 0, whose ends do not meet.
    fn facets(space: bool) -> (Vec<Vec3>, Vec<Vec<Vec3>>, &'static str) {
        if !space {
            let at = |x: f64| Vec3::new(x, 0.0, 0.0);
            let own = vec![at(0.0), at(1.0)];
            let others = vec![vec![at(0.4), at(-0.2)], vec![at(1.3), at(0.4)]];
            return (own, others, "line2");
        }
        let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        let own = vec![at(0.0, 0.0), at(1.0, 0.0), at(1.1, 1.0), at(0.0, 0.9)];
        let square = |a: f64, b: f64| vec![at(a, -0.3), at(a, 1.4), at(b, 1.4), at(b, -0.3)];
        (own, vec![square(-0.2, 0.4), square(0.4, 1.3)], "quad4")
    }

    /// The sums of a facet for a rise, with D.
    fn sums(space: bool, rise: &dyn Fn(Option<usize>, Vec3) -> f64) -> Vec<[f64; 2]> {
        let (own, others, name) = facets(space);
        let element = by_name(name).unwrap();
        let own = Facet { element, x: &own };
        let others: Vec<Facet> = others.iter().map(|x| Facet { element, x }).collect();
        let mut covered = Covered::new(Measure::Flat);
        covered.evaluate(&own, &others, &[], false).unwrap();
        assert_eq!(covered.met().len(), 2);
        let found = rises(&covered, Measure::Flat, &own, &others, rise).unwrap();
        let d = covered.d().iter();
        d.zip(found).map(|(d, found)| [found, *d]).collect()
    }

    #[test]
    fn the_mean_of_a_constant_rise_of_either_side_is_that_constant() {
        for space in [false, true] {
            for of in [true, false] {
                let rise = |side: Option<usize>, _| f64::from(u8::from(side.is_none() == of)) * 0.3;
                for [sum, d] in sums(space, &rise) {
                    assert!((sum - 0.3 * d).abs() < 1e-12, "{sum} {d}");
                }
            }
        }
    }

    #[test]
    fn a_rise_like_a_function_of_one_node_counts_at_that_node_alone() {
        for space in [false, true] {
            let element = by_name(if space { "quad4" } else { "line2" }).unwrap();
            for k in 0..element.nnode() {
                let rise = |side: Option<usize>, xi: Vec3| {
                    let mut shape = [0.0; MAX_FACET_NODES];
                    element.shape(&xi, &mut shape[..element.nnode()]);
                    if side.is_none() { shape[k] } else { 0.0 }
                };
                for (j, [sum, d]) in sums(space, &rise).into_iter().enumerate() {
                    let due = if j == k { d } else { 0.0 };
                    assert!((sum - due).abs() < 1e-10, "{j} {k}: {sum} {due}");
                }
            }
        }
    }
}
