use signorini_geometry::element::{Element, MAX_FACET_NODES};

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
    /// The one of this basis; the identity for linear facets.
    #[must_use]
    pub fn of(element: Element, basis: Basis) -> Self {
        let alpha = match (element.name(), basis) {
            ("tri6" | "quad8", Basis::Whole) => 0.2,
            ("quad8", Basis::Part) => 3.0 / 8.0,
            _ => 0.25,
        };
        Self::with_alpha(element, alpha)
    }

    /// The one with this α; mid nodes follow the corners in the order of the edges, then comes the centre.
    ///
    /// # Limits
    /// Facets, of at most [`MAX_FACET_NODES`] nodes.
    #[must_use]
    pub fn with_alpha(element: Element, alpha: f64) -> Self {
        let (n, corners) = (element.nnode().min(MAX_FACET_NODES), element.ncorner());
        let mut t = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for (k, row) in t.iter_mut().enumerate() {
            row[k] = 1.0;
        }
        if n > corners {
            let mid = 1.0 - 2.0 * alpha;
            let nedge = if element.dim() == 1 {
                1
            } else {
                element.edges().len()
            };
            for (&[a, b], k) in element.edges().iter().zip(corners..corners + nedge) {
                t[a][k] = alpha;
                t[b][k] = alpha;
                t[k][k] = mid;
            }
            for centre in corners + nedge..n {
                for row in &mut t[..corners] {
                    row[centre] = alpha * alpha;
                }
                for row in &mut t[corners..corners + nedge] {
                    row[centre] = alpha * mid;
                }
                t[centre][centre] = mid * mid;
            }
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
