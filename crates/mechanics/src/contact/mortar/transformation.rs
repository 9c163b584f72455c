use signorini_geometry::element::{DualBasis, Element, MAX_FACET_NODES};

/// Over what the weights of nodes of quadratic facets are not negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// Over any part of a facet: for contact that covers facets in part.
    #[default]
    Part,
    /// Over a whole facet: weights are nearer to those of an even pressure.
    ///
    /// # Source
    /// Popp, Wohlmuth, Gee, Wall, SIAM J. Sci. Comput. 34, 2012.
    Whole,
}

/// The transformation T of the shape functions of a facet, (E4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transformation {
    n: usize,
    t: [[f64; MAX_FACET_NODES]; MAX_FACET_NODES],
}

impl Transformation {
    /// The one of this basis; the identity for linear facets. `None` for facets without a dual basis.
    ///
    /// # Limits
    /// Facets, of at most [`MAX_FACET_NODES`] nodes.
    #[must_use]
    pub fn of(element: Element, basis: Basis) -> Option<Self> {
        match (element.dual_basis()?, basis) {
            (DualBasis::Shape, _) => Some(Self::identity(element)),
            (DualBasis::Edges { whole: alpha, .. }, Basis::Whole)
            | (
                DualBasis::Edges {
                    pointwise: alpha, ..
                },
                Basis::Part,
            )
            | (DualBasis::Axes { alpha }, _) => Some(Self::with_alpha(element, alpha)),
        }
    }

    /// The one with this α; mid nodes follow the corners in the order of the edges, then comes the centre.
    ///
    /// # Limits
    /// Facets, of at most [`MAX_FACET_NODES`] nodes.
    #[must_use]
    pub fn with_alpha(element: Element, alpha: f64) -> Self {
        let Self { n, mut t } = Self::identity(element);
        let mid = 1.0 - 2.0 * alpha;
        for (k, [a, b]) in element.mid_nodes() {
            t[a][k] = alpha;
            t[b][k] = alpha;
            t[k][k] = mid;
        }
        let (corners, mids) = (element.ncorner(), element.mid_nodes().count());
        for centre in corners + mids..n {
            for row in &mut t[..corners] {
                row[centre] = alpha * alpha;
            }
            for row in &mut t[corners..corners + mids] {
                row[centre] = alpha * mid;
            }
            t[centre][centre] = mid * mid;
        }
        Self { n, t }
    }

    fn identity(element: Element) -> Self {
        let n = element.nnode().min(MAX_FACET_NODES);
        let mut t = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for (k, row) in t.iter_mut().enumerate() {
            row[k] = 1.0;
        }
        Self { n, t }
    }

    /// T_jk.
    #[must_use]
    pub fn get(&self, j: usize, k: usize) -> f64 {
        self.t[j][k]
    }

    /// `T⁻ᵀ x`: the values that belong to the transformed functions, in place of those of the nodes.
    ///
    /// # Limits
    /// `x` has an entry for each node.
    pub fn values(&self, x: &mut [f64]) {
        // T is upper triangular: forward substitution with its transpose
        for k in 0..self.n.min(x.len()) {
            let before: f64 = (0..k).map(|j| self.t[j][k] * x[j]).sum();
            x[k] = (x[k] - before) / self.t[k][k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::mortar::{Covered, Facet, Measure, MortarError};
    use crate::cubic::CUBIC;
    use signorini_geometry::element::TABLE;
    use signorini_geometry::element::quadrature::{gauss, lobatto, on_facet};
    use signorini_geometry::tensor::Vec3;

    /// Ñ at a point.
    fn transformed(t: &Transformation, element: Element, xi: &Vec3) -> Vec<f64> {
        let n = element.nnode();
        let mut shape = vec![0.0; n];
        element.shape(xi, &mut shape);
        let of = |j: usize| (0..n).map(|k| t.get(j, k) * shape[k]).sum();
        (0..n).map(of).collect()
    }

    fn facets() -> impl Iterator<Item = Element> {
        TABLE.into_iter().filter(|e| e.dim() < 3)
    }

    #[test]
    fn transformed_functions_are_nowhere_negative_and_sum_to_one() {
        for element in facets() {
            let Some(t) = Transformation::of(element, Basis::Part) else {
                continue;
            };
            for (xi, _) in on_facet(element, &lobatto(21)) {
                let n = transformed(&t, element, &xi);
                let sum: f64 = n.iter().sum();
                assert!((sum - 1.0).abs() < 1e-14, "{element:?} {sum}");
                assert!(n.iter().all(|n| *n > -1e-14), "{element:?} {xi:?} {n:?}");
            }
        }
    }

    #[test]
    fn integrals_of_transformed_functions_over_whole_facets_are_positive() {
        for element in facets() {
            for basis in [Basis::Part, Basis::Whole] {
                let Some(t) = Transformation::of(element, basis) else {
                    continue;
                };
                let mut integrals = vec![0.0; element.nnode()];
                for (xi, weight) in on_facet(element, &gauss(5)) {
                    let n = transformed(&t, element, &xi);
                    integrals
                        .iter_mut()
                        .zip(n)
                        .for_each(|(i, n)| *i += weight * n);
                }
                assert!(
                    integrals.iter().all(|i| *i > 0.01),
                    "{element:?} {integrals:?}"
                );
            }
        }
    }

    #[test]
    fn facets_without_a_dual_basis_are_refused_by_name() {
        for element in CUBIC {
            assert_eq!(Transformation::of(element, Basis::Part), None);
            let own = Facet {
                element,
                x: element.nodes(),
            };
            let refused = Covered::new(Measure::Flat).evaluate(&own, &[], &[], false);
            let name = element.name();
            assert_eq!(refused, Err(MortarError::NoDualBasis { element: name }));
        }
    }
}
