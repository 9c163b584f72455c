//! Integrals of products of shape functions over what two facets share, and their derivatives by places on the plane.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | `N_j N_k`, `N_j N^m_l` | the two blocks of a [`Twin`] | `N` × `N` each, zero beyond the nodes there are |
//! | ∫ over a simplex, over all | `part`, `values` | a twin each |
//! | ∂/∂X_ia | `by_place` | a twin for each node of the secondary facet, then of the primary one, and each a |
//! | ∂/∂r of the ends | `by_radius` | two twins |
//! | ∂/∂c_a | `by_corner` | a twin for each corner of the cell at hand and each a |
//!
//! By (E4) of the overlap, with `f` any of the products and `w_p` the weight of a point,
//!
//! ```text
//! d∫f = Σ_p w_p ∂f/∂p·Σ_c s_c dc  +  Σ_c (∫f/A) ∂A/∂c·dc  −  Σ_p w_p (∂N_j/∂p N_k Σ_i N_i dX_i + N_j ∂N_k/∂p Σ_i N_i dX_i)  (E7)
//! ```
//!
//! where the sums in the last term are those of the facet that the differentiated function belongs to. The first two go by
//! corners, and from there, cell by cell, to the nodes that these move with.

use super::factor::{Factor, zeros};
use pulp::Arch;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::overlap::{
    Cell, Facing, Flat, MAX_CORNERS, OverlapError, Point, Simplex, integrate,
};

/// Products of functions, by the node of the one and the node of the other.
type Block<const N: usize> = [[f64; N]; N];

/// Those of two functions of the secondary side, and those of one of each side.
type Twin<const N: usize> = [Block<N>; 2];

/// The sums, with the memory they take.
#[derive(Clone, Debug, Default)]
pub(super) struct Products {
    /// N: there is room for so many nodes of a facet.
    width: usize,
    dim: usize,
    nsecondary: usize,
    values: Vec<f64>,
    by_corner: Vec<f64>,
    by_place: Vec<f64>,
    by_radius: Vec<f64>,
}

impl Products {
    /// Sums up over all points of what two facets share; says the area with all signs positive.
    ///
    /// # Errors
    /// A map has no inverse at a point.
    pub fn over(
        &mut self,
        secondary: &Flat,
        primary: &Flat,
        factor: Factor,
        derivatives: bool,
    ) -> Result<f64, OverlapError> {
        let nodes = [secondary, primary].map(|flat| flat.x().len());
        (self.dim, self.nsecondary) = (secondary.element().dim(), nodes[0]);
        let facets = [secondary, primary];
        match (self.dim, nodes[0].max(nodes[1])) {
            (1, ..=2) => self.sum_up::<2, 1>(facets, factor, derivatives),
            (1, ..=3) => self.sum_up::<3, 1>(facets, factor, derivatives),
            (1, _) => self.sum_up::<MAX_FACET_NODES, 1>(facets, factor, derivatives),
            (_, ..=3) => self.sum_up::<3, 2>(facets, factor, derivatives),
            (_, ..=4) => self.sum_up::<4, 2>(facets, factor, derivatives),
            (_, ..=6) => self.sum_up::<6, 2>(facets, factor, derivatives),
            (_, ..=9) => self.sum_up::<9, 2>(facets, factor, derivatives),
            _ => self.sum_up::<MAX_FACET_NODES, 2>(facets, factor, derivatives),
        }
    }

    fn sum_up<const N: usize, const D: usize>(
        &mut self,
        [secondary, primary]: [&Flat; 2],
        factor: Factor,
        derivatives: bool,
    ) -> Result<f64, OverlapError> {
        self.width = N;
        let twin = 2 * N * N;
        if derivatives {
            zeros(&mut self.by_place, 2 * N * D * twin);
            zeros(&mut self.by_radius, 2 * factor.degree() * twin);
            self.by_corner.resize(MAX_CORNERS * D * twin, 0.0);
        }
        let nothing = [[[0.0; N]; N]; 2];
        let mut sums = Sums::<N, D> {
            part: nothing,
            values: nothing,
            by_corner: twins(&mut self.by_corner),
            by_place: twins(&mut self.by_place),
            by_radius: twins(&mut self.by_radius),
            derivatives,
        };
        let arch = Arch::new();
        let mut gross = 0.0;
        integrate(secondary, primary, |cell| {
            sums.begin(cell);
            cell.simplices(|simplex| {
                simplex.points(factor.degree(), |point| {
                    let weighted = Weighted::new(point, factor);
                    gross += weighted.weight.abs();
                    arch.dispatch(
                        #[inline(always)]
                        || sums.add(simplex, point, &weighted),
                    );
                })?;
                arch.dispatch(
                    #[inline(always)]
                    || sums.end(simplex),
                );
                Ok(())
            })?;
            sums.follow(cell, arch);
            Ok(())
        })?;
        self.values.clear();
        self.values
            .extend(sums.values.as_flattened().as_flattened());
        Ok(gross)
    }

    /// `∫N_j N_k` for the first block, `∫N_j N^m_l` for the second.
    pub fn value(&self, block: usize, j: usize, k: usize) -> f64 {
        self.values[self.place(block, j, k)]
    }

    /// All derivatives by a component of the place of a node, the secondary facet's first: both blocks.
    pub fn by_place(&self, node: usize, a: usize) -> &[f64] {
        let place = match node.checked_sub(self.nsecondary) {
            None => node,
            Some(primary) => self.width + primary,
        };
        &self.by_place[(place * self.dim + a) * self.len()..][..self.len()]
    }

    /// All derivatives by the radius of an end; none where integrals are not over surfaces of revolution.
    pub fn by_radius(&self, end: usize) -> &[f64] {
        let of_end = end * self.len()..(end + 1) * self.len();
        let of_end = self.by_radius.get(of_end);
        of_end.unwrap_or_default()
    }

    /// How many numbers [`Self::by_place`] gives.
    pub fn len(&self) -> usize {
        2 * self.width * self.width
    }

    /// The place of a product in what [`Self::by_place`] gives.
    pub fn place(&self, block: usize, j: usize, k: usize) -> usize {
        (block * self.width + j) * self.width + k
    }
}

/// Numbers as twins.
fn twins<const N: usize>(numbers: &mut [f64]) -> &mut [Twin<N>] {
    let blocks = numbers.as_chunks_mut::<N>().0.as_chunks_mut::<N>().0;
    blocks.as_chunks_mut::<2>().0
}

/// The sums of two facets of at most `N` nodes in `D` dimensions.
struct Sums<'a, const N: usize, const D: usize> {
    part: Twin<N>,
    values: Twin<N>,
    by_corner: &'a mut [Twin<N>],
    by_place: &'a mut [Twin<N>],
    by_radius: &'a mut [Twin<N>],
    derivatives: bool,
}

/// `to += factor · from`
#[inline(always)]
fn add<const N: usize>(to: &mut Block<N>, factor: f64, from: &Block<N>) {
    for (to, from) in to.iter_mut().zip(from) {
        for (to, from) in to.iter_mut().zip(from) {
            *to += factor * from;
        }
    }
}

#[inline(always)]
fn add_twin<const N: usize>(to: &mut Twin<N>, factor: f64, from: &Twin<N>) {
    for (to, from) in to.iter_mut().zip(from) {
        add(to, factor, from);
    }
}

impl<const N: usize, const D: usize> Sums<'_, N, D> {
    fn begin(&mut self, cell: &Cell) {
        if self.derivatives {
            self.by_corner[..cell.corners().len() * D].fill([[[0.0; N]; N]; 2]);
        }
    }

    /// Adds what a point contributes.
    #[inline(always)]
    fn add(&mut self, simplex: &Simplex, point: &Point, weighted: &Weighted) {
        let own: [f64; N] = std::array::from_fn(|k| point.secondary.shape[k]);
        let other: [f64; N] = std::array::from_fn(|k| point.primary.shape[k]);
        let w = weighted.weight;
        let mut products = [[[0.0; N]; N]; 2];
        for j in 0..N {
            for k in 0..N {
                products[0][j][k] = own[j] * own[k];
                products[1][j][k] = own[j] * other[k];
            }
        }
        add_twin(&mut self.part, w, &products);
        if !self.derivatives {
            return;
        }
        let (own_places, other_places) = self.by_place.split_at_mut(N * D);
        for a in 0..D {
            let (g, h) = (&point.secondary.gradient, &point.primary.gradient);
            // w ∂f/∂p: of both blocks, and of the second what the function of either side makes of it
            let mut slopes = [[[0.0; N]; N]; 2];
            let (mut of_own, mut of_other) = ([[0.0; N]; N], [[0.0; N]; N]);
            for j in 0..N {
                let (slope, value) = (w * g[j][a], w * own[j]);
                for k in 0..N {
                    slopes[0][j][k] = slope * own[k] + value * g[k][a];
                    of_own[j][k] = slope * other[k];
                    of_other[j][k] = value * h[k][a];
                    slopes[1][j][k] = of_own[j][k] + of_other[j][k];
                }
            }
            for i in 0..N {
                if let Some([nn, nm]) = own_places.get_mut(i * D + a) {
                    add(nn, -own[i], &slopes[0]);
                    add(nm, -own[i], &of_own);
                }
                if let Some([_, nm]) = other_places.get_mut(i * D + a) {
                    add(nm, -other[i], &of_other);
                }
            }
            if a == 0 && weighted.along != 0.0 {
                add_twin(&mut slopes, weighted.along, &products);
            }
            for (&corner, &share) in simplex.corners.iter().zip(&point.shares).take(D + 1) {
                if let Some(to) = self.by_corner.get_mut(corner * D + a) {
                    add_twin(to, share, &slopes);
                }
            }
        }
        if let Some([a, b, ra, rb]) = weighted.by_ends {
            let places = own_places.iter_mut().take(2);
            let ends = places.chain(self.by_radius.iter_mut());
            for (to, slope) in ends.zip([a, b, ra, rb]) {
                add_twin(to, slope, &products);
            }
        }
    }

    /// What the size of a simplex makes of its integrals, and these to the others.
    #[inline(always)]
    fn end(&mut self, simplex: &Simplex) {
        let part = std::mem::replace(&mut self.part, [[[0.0; N]; N]; 2]);
        if self.derivatives {
            for (corner, dsize) in simplex.corners.iter().zip(&simplex.dsize).take(D + 1) {
                for (a, dsize) in dsize.iter().enumerate().take(D) {
                    add_twin(
                        &mut self.by_corner[corner * D + a],
                        dsize / simplex.size,
                        &part,
                    );
                }
            }
        }
        add_twin(&mut self.values, 1.0, &part);
    }

    /// From derivatives by the corners of a cell to derivatives by places.
    fn follow(&mut self, cell: &Cell, arch: Arch) {
        if !self.derivatives {
            return;
        }
        for (corner, by_corner) in (0..cell.corners().len()).zip(self.by_corner.chunks_exact(D)) {
            cell.moves(corner, |facet, node, slopes| {
                let first = match facet {
                    Facing::Same => node,
                    Facing::Opposite => N + node,
                };
                let places = &mut self.by_place[first * D..][..D];
                arch.dispatch(
                    #[inline(always)]
                    || {
                        for (slopes, by_corner) in slopes.iter().zip(by_corner) {
                            let places = places.iter_mut().zip(slopes);
                            for (to, &slope) in places.filter(|(_, s)| **s != 0.0) {
                                add_twin(to, slope, by_corner);
                            }
                        }
                    },
                );
            });
        }
    }
}

/// The weight of a point and its factor.
struct Weighted {
    /// Both.
    weight: f64,
    /// The derivative of the factor by the place, times the weight alone.
    along: f64,
    /// Those by the places and radii of the ends, likewise.
    by_ends: Option<[f64; 4]>,
}

impl Weighted {
    fn new(point: &Point, factor: Factor) -> Self {
        let slopes = factor.slopes(point.at[0]);
        let slopes = slopes.map(|s| s.map(|s| s * point.weight));
        Self {
            weight: factor.at(point.at[0]) * point.weight,
            along: slopes.map_or(0.0, |s| s[0]),
            by_ends: slopes.map(|[_, a, b, ra, rb]| [a, b, ra, rb]),
        }
    }
}
