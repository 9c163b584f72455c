//! The tangent as Faltus and Horák print it, with both readings of its curvature: wrong on warped facets.
//!
//! ```text
//! A_ab = m_ab − g κ_ab,   D_a = A⁻¹_ab (T_b − g B_b)
//! ∂²g/∂d² = B_a D_aᵀ + D_a B_aᵀ + κ_ab D_a D_bᵀ + g m^ab B̄_a B̄_bᵀ,   B̄_a = B_a + κ_ab D_b       (P1)
//! ```
//!
//! with `κ_ab = ±ν·ρ_,ab`: the signs of the two terms in κ contradict that in `A`, whichever way it is read.

use super::super::discretization::projected::Point;
use super::super::discretization::{
    Anchored, Averaged, Capabilities, Discretization, Links, Pair, Pairing, PointToSegment,
    Renewable, SurfacePair,
};
use super::super::row::{RowOrder, Rows, Wanted};
use super::{Random, facets, first_rows, largest, pair_up};
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{Carrier, Feature, Placement, SurfaceError, SurfaceJet, pair};
use signorini_geometry::tensor::Vec3;

/// Node-to-segment rows with the derivative of the weights as printed, (P1), on faces carried by nodes.
pub(crate) struct PrintedSigns {
    pub(crate) inner: PointToSegment,
    /// +1 where κ is read as ν·ρ_,ab, −1 where it is read as −ν·ρ_,ab.
    pub(crate) kappa_sign: f64,
}

impl Discretization for PrintedSigns {
    fn nrow(&self) -> usize {
        self.inner.nrow()
    }

    fn point(&self, row: usize) -> Point<'_> {
        self.inner.point(row)
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            is_symmetric: true,
            ..Capabilities::default()
        }
    }

    fn averaged_mut(&mut self) -> Option<&mut dyn Averaged> {
        None
    }

    fn renewable_mut(&mut self) -> Option<&mut dyn Renewable> {
        None
    }

    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Search,
        last: &Pairing,
        next: RowOrder,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        self.inner.pair_up(pair, at, near, last, next, out)
    }

    fn row(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let mut right = Rows::default();
        self.inner.row(row, pair, at, links, wanted, &mut right)?;
        out.start(right.participants().to_vec());
        out.set_secondary(right.secondary());
        for row in right.rows() {
            let tangent = wanted.order == RowOrder::Tangent;
            let copy = out.push(row.number, wanted);
            copy.gap = row.gap;
            copy.normal = row.normal;
            if wanted.order == RowOrder::Gap {
                continue;
            }
            copy.gradient.copy_from_slice(&row.gradient);
            copy.weights.copy_from_slice(&row.weights);
            copy.dweights.copy_from_slice(&row.dweights);
            let Some(found) = links.pairing.pairs.get(row.number).copied().flatten() else {
                continue;
            };
            let by_nodes = matches!(pair.primary.carrier(found.anchor.facet), Carrier::Nodes(_));
            if tangent && by_nodes && found.feature == Feature::Face {
                let mut jet = SurfaceJet::default();
                pair.primary.jet(at, &found.anchor, &mut jet)?;
                let ntan = pair.primary.ntan();
                self.printed(&jet, ntan, row.gap, &mut copy.dweights);
            }
        }
        Ok(())
    }

    fn anchor(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        found: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError> {
        self.inner.anchor(row, pair, at, found, slip)
    }
}

impl PrintedSigns {
    /// (P1), row-major.
    fn printed(&self, jet: &SurfaceJet, ntan: usize, gap: f64, out: &mut [f64]) {
        let n = 3 * (jet.nnode + 1);
        let nu = jet.normal;
        let symmetric = |of: &dyn Fn(usize) -> f64| {
            let mut m = [[0.0; 2]; 2];
            for (a, line) in m.iter_mut().enumerate() {
                for (b, value) in line.iter_mut().enumerate() {
                    *value = if a < ntan && b < ntan {
                        of(pair(a, b))
                    } else {
                        f64::from(u8::from(a == b))
                    };
                }
            }
            m
        };
        let kappa = |k: usize| self.kappa_sign * nu.dot(jet.curvature[k]);
        let m_inverse = inverse(&symmetric(&|k| jet.metric[k]));
        let metric = |p: usize, q: usize| m_inverse[p][q];
        let a_inverse = inverse(&symmetric(&|k| jet.metric[k] - gap * kappa(k)));
        // a column is a component of a node of the facet (weight −N) or of the point (weight 1)
        let weight = |j: usize, of: &dyn Fn(usize) -> f64, own: f64| match j / 3 {
            i if i < jet.nnode => -of(i),
            _ => own,
        };
        let column = |j: usize, a: usize| {
            let t = weight(j, &|i| jet.shape[i], 1.0) * jet.tangent[a][j % 3];
            let b = weight(j, &|i| jet.dshape[i][a], 0.0) * nu[j % 3];
            (t, b)
        };
        let b = |j: usize, a: usize| column(j, a).1;
        let d = |j: usize, a: usize| -> f64 {
            let right = |c: usize| column(j, c).0 - gap * column(j, c).1;
            (0..ntan).map(|c| a_inverse[a][c] * right(c)).sum()
        };
        let bar = |j: usize, a: usize| -> f64 {
            let bent = (0..ntan).map(|c| kappa(pair(a, c)) * d(j, c));
            b(j, a) + bent.sum::<f64>()
        };
        for i in 0..n {
            for j in 0..n {
                let mut sum = 0.0;
                for p in 0..ntan {
                    sum += b(i, p) * d(j, p) + d(i, p) * b(j, p);
                    for q in 0..ntan {
                        sum += kappa(pair(p, q)) * d(i, p) * d(j, q)
                            + gap * metric(p, q) * bar(i, p) * bar(j, q);
                    }
                }
                out[i * n + j] = sum;
            }
        }
    }
}

fn inverse([[a, b], [c, d]]: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let det = a * d - b * c;
    [[d / det, -b / det], [-c / det, a / det]]
}

/// Force `f = g b` of a unit penalty and its stiffness with these weights' derivative.
fn penalty(method: &dyn Discretization, pair: &SurfacePair, x: &[Vec3]) -> (Vec<f64>, Vec<f64>) {
    let at = Placement { x, poses: &[] };
    let pairing = pair_up(
        &PointToSegment::at_nodes(&pair.points),
        pair,
        &at,
        pair.reach,
    );
    assert_eq!(pairing.pairs[0].unwrap().feature, Feature::Face);
    let rows = first_rows(method, pair, &at, &pairing);
    let row = &rows.rows()[0];
    let n = rows.ncolumn();
    let force = row.weights.iter().map(|b| row.gap * b).collect();
    let entry = |k: usize| row.weights[k / n] * row.gradient[k % n] + row.gap * row.dweights[k];
    (force, (0..n * n).map(entry).collect())
}

/// Central differences of fourth order of the force, row-major.
fn differences(pair: &SurfacePair, x: &[Vec3], nodes: &[usize]) -> Vec<f64> {
    let n = 3 * nodes.len();
    let h = 1e-3;
    let mut stiffness = vec![0.0; n * n];
    for j in 0..n {
        for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let mut moved = x.to_vec();
            moved[nodes[j / 3]][j % 3] += step * h;
            let (force, _) = penalty(&PointToSegment::at_nodes(&pair.points), pair, &moved);
            for (i, f) in force.iter().enumerate() {
                stiffness[i * n + j] += weight * f / (12.0 * h);
            }
        }
    }
    stiffness
}

/// `|a − b| / |b|` in the Frobenius norm.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
    squares(&mut a.iter().zip(b).map(|(a, b)| a - b)) / squares(&mut b.iter().copied())
}

/// Errors of our tangent and of the printed one in its two readings, on a facet whose nodes are moved by up to
/// `warp`; the curvature's largest component, too.
fn errors(warp: f64, random: &mut Random) -> ([f64; 3], f64) {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let mut x: Vec<Vec3> = corners.map(|(u, v)| Vec3::new(u, v, 0.0)).to_vec();
    for x in &mut x {
        let moved = random.vector() * 0.2;
        *x += Vec3::new(moved.x, moved.y, warp * random.signed());
    }
    let primary = std::sync::Arc::new(facets(&mut x, &[vec![0, 1, 2, 3]]));
    let pair = SurfacePair::new(vec![x.len() as u32], primary, 1.0);
    // a point over the middle of the facet, 0.03 to 0.3 above or below
    let gap = (0.165 + 0.135 * random.signed()) * random.signed().signum();
    let local = Vec3::new(0.5 * random.signed(), 0.5 * random.signed(), 0.0);
    let mut jet = SurfaceJet::default();
    let anchor = signorini_geometry::surface::Anchor { facet: 0, local };
    let at = Placement { x: &x, poses: &[] };
    pair.primary.jet(&at, &anchor, &mut jet).unwrap();
    x.push(jet.position + jet.normal * gap);

    let exact = differences(&pair, &x, &[0, 1, 2, 3, x.len() - 1]);
    let printed = |kappa_sign| PrintedSigns {
        inner: PointToSegment::at_nodes(&pair.points),
        kappa_sign,
    };
    let methods: [&dyn Discretization; 3] = [
        &PointToSegment::at_nodes(&pair.points),
        &printed(1.0),
        &printed(-1.0),
    ];
    let error = |method| distance(&penalty(method, &pair, &x).1, &exact);
    let kappa = jet.curvature.map(|c| c.dot(jet.normal));
    (methods.map(error), largest(&kappa))
}

#[test]
fn tangent_with_printed_signs_fails_on_warped_faces() {
    let mut random = Random::new(3);
    for warp in [0.1, 0.25] {
        let mut typical: [Vec<f64>; 2] = Default::default();
        while typical[0].len() < 200 {
            let ([ours, plus, minus], kappa) = errors(warp, &mut random);
            assert!(ours < 1e-9, "{ours:e}");
            // by chance a facet may be all but flat
            if kappa > 0.02 {
                assert!(plus > 1e-3, "{plus:e} with curvature {kappa}");
                assert!(minus > 1e-4, "{minus:e} with curvature {kappa}");
                typical[0].push(plus);
                typical[1].push(minus);
            }
        }
        // medians at a warp of a tenth are 4e-2 and 9e-3; the second error is that of A alone, of the order g κ
        let [plus, minus] = typical.map(|mut e| {
            e.sort_by(f64::total_cmp);
            e[100]
        });
        assert!((2e-2..2e-1).contains(&plus), "{plus:e}");
        assert!((4e-3..4e-2).contains(&minus), "{minus:e}");
        assert!(plus > 2.0 * minus, "{plus:e} {minus:e}");
    }
}

#[test]
fn tangent_with_printed_signs_is_exact_on_flat_faces() {
    let mut random = Random::new(4);
    for _ in 0..100 {
        let (all, kappa) = errors(0.0, &mut random);
        assert!(kappa < 1e-14);
        assert!(all.iter().all(|e| *e < 1e-7), "{all:?}");
    }
}
