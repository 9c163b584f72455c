//! The graph of a polynomial.
//!
//! The closest point of `y = f(x)` to `(X, Y)` lies within `h` of X, where `h` is the distance of any point of the graph,
//! at first that straight up or down, `|f(X) − Y|`. With `x = X + h u` and `f = Y + h φ(u)`
//!
//! ```text
//! F(u) = ½ (u² + φ(u)²) → min over [−1, 1],   F ≤ ½ there                                        (E1)
//! G(u) = F'(u) = u + φ φ',   of degree 2n − 1                                                    (E2)
//! ```
//!
//! and the closest point is the best root of (E2). All roots are found: between two neighbouring roots of its
//! derivative a polynomial is monotonous and has one root or none, which bracketed Newton finds; the derivative's roots
//! are found in the same way, down to a straight line. A double root that rounding hides is no change of sign, thus no
//! minimum. Where the closest point is much closer than `h`, it all begins again with its distance: that keeps the
//! roots of a steep graph apart.
//!
//! Source: for the oracle of a parabola, the cubic `2a²t³ + (1 − 2aY) t − X = 0` of its closest points.

use super::SurfaceError;
use super::analytical::{Patch, Shape, dyad};
use super::error::AnalyticalError;
use crate::tensor::Vec3;
use signorini_vocabulary::{ANY, Default, Description, Entry, MANY, Shape as Form, key, word};

/// The entry of [`Polynomial`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new(
        "polynomial",
        "the curve y = c_n x^n + … + c_0, the same for all z",
        &[
            key(
                "coefficients",
                Form::List(&ANY, 1, MANY),
                "[c_n, …, c_0], the highest power first",
            )
            .required()
            .hints(&["coeffs"]),
            key(
                "side",
                Form::Choice(&[word("above"), word("below")]),
                "where bodies are",
            )
            .or(Default::Text("above")),
        ],
    )
    .hints(&["parabola"]),
    make: |values| {
        let facing = match values.text("side") {
            Some("below") => Facing::Below,
            _ => Facing::Above,
        };
        Ok(Box::new(Polynomial::new(
            values.list("coefficients")?,
            facing,
        )?))
    },
};

/// The highest degree: (E2) squares the condition of the polynomial.
pub const MAX_DEGREE: usize = 10;

/// Room for the coefficients of (E2).
const ROOM: usize = 2 * MAX_DEGREE + 2;

/// Of two feet whose distances are equal to this, relatively, the one to the left counts.
const TIE: f64 = 1e-12;

/// How often the search begins again with a smaller h.
const RESTARTS: usize = 8;

/// Steps of Newton after a root has been found, and how long they may be, over h: they make up for rounding only.
const POLISH: usize = 3;
const POLISHED: f64 = 1e-4;

/// On which side of a graph there is room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// The body is below; other bodies are above.
    #[default]
    Above,
    /// The body is above; other bodies are below.
    Below,
}

/// The graph of a polynomial, `y = c_n xⁿ + … + c_0`; in space, extruded along z.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// `c_0, c_1, …, c_n`.
    coefficients: Vec<f64>,
    facing: Facing,
}

impl Polynomial {
    /// With the coefficients `c_n, …, c_0`, highest first.
    ///
    /// # Errors
    /// No coefficients, one that is not finite, a degree above [`MAX_DEGREE`].
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Facing, Polynomial, Shape};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// // y = x²: the closest point of (0, 0.4) is the vertex, as 0.4 < 1/2, the radius of curvature there
    /// let parabola = Polynomial::new(&[1.0, 0.0, 0.0], Facing::Above)?;
    /// let on = parabola.closest(Vec3::new(0.0, 0.4, 0.0))?.ok_or("no closest point")?;
    /// assert!(on.norm() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(coefficients: &[f64], facing: Facing) -> Result<Self, AnalyticalError> {
        if coefficients.is_empty() {
            return Err(AnalyticalError::NoCoefficients);
        }
        if coefficients.iter().any(|c| !c.is_finite()) {
            let what = "the coefficients of the polynomial";
            return Err(AnalyticalError::NotFinite { what });
        }
        let leading = coefficients.iter().take_while(|&&c| c == 0.0).count();
        let leading = leading.min(coefficients.len() - 1);
        let coefficients: Vec<f64> = coefficients.iter().skip(leading).rev().copied().collect();
        let degree = coefficients.len() - 1;
        if degree > MAX_DEGREE {
            let most = MAX_DEGREE;
            return Err(AnalyticalError::Degree { degree, most });
        }
        Ok(Self {
            coefficients,
            facing,
        })
    }

    /// f, f', f''.
    fn at(&self, x: f64) -> [f64; 3] {
        let horner = |[f, d, dd]: [f64; 3], c: &f64| [f * x + c, d * x + f, dd * x + d];
        let [f, d, half] = self.coefficients.iter().rev().fold([0.0; 3], horner);
        [f, d, 2.0 * half]
    }

    /// The coefficients of φ, and how many there are.
    fn scaled(&self, x: f64, y: f64, h: f64) -> ([f64; ROOM], usize) {
        let n = self.coefficients.len();
        let mut phi = [0.0; ROOM];
        phi[..n].copy_from_slice(&self.coefficients);
        // division by (x − X), again and again
        for first in 0..n {
            for k in (first..n - 1).rev() {
                phi[k] += phi[k + 1] * x;
            }
        }
        phi[0] -= y;
        let mut power = h.recip();
        for c in &mut phi[..n] {
            *c *= power;
            power *= h;
        }
        (phi, n)
    }

    /// The x of the closest point.
    fn foot(&self, x: f64, y: f64) -> f64 {
        let distance = |at: f64| (at - x).hypot(self.at(at)[0] - y);
        let (mut foot, mut h) = (x, distance(x));
        for _ in 0..RESTARTS {
            if h == 0.0 || !h.is_finite() {
                return foot;
            }
            let found = self.polished(x, y, x + h * self.best_root(x, y, h), h);
            let reached = distance(found);
            let much_closer = reached < 0.5 * h;
            // distances near their minimum are equal to rounding, where feet are not
            if reached <= h * (1.0 + TIE) {
                (foot, h) = (found, reached);
            }
            if !much_closer {
                break;
            }
        }
        foot
    }

    /// The u of the smallest value of (E1).
    fn best_root(&self, x: f64, y: f64, h: f64) -> f64 {
        let (phi, n) = self.scaled(x, y, h);
        let phi = &phi[..n];
        let mut g = [0.0; ROOM]; // (E2)
        g[1] = 1.0;
        for (i, a) in phi.iter().enumerate() {
            for (k, b) in phi.iter().enumerate().skip(1) {
                g[i + k - 1] += a * b * k as f64;
            }
        }
        let degree = (2 * n).saturating_sub(3).max(1);
        let mut roots = [0.0; ROOM];
        let nroot = roots_within(&g[..=degree], &mut roots);
        let value = |u: f64| u.hypot(evaluate(phi, u)[0]); // (E1)
        let mut best = (0.0, f64::INFINITY);
        for &u in &roots[..nroot] {
            let reached = value(u);
            if reached < best.1 * (1.0 - TIE) {
                best = (u, reached);
            }
        }
        best.0
    }

    /// Newton with the polynomial as it was given: the shift to φ rounds.
    fn polished(&self, x: f64, y: f64, mut foot: f64, h: f64) -> f64 {
        for _ in 0..POLISH {
            let [f, d, dd] = self.at(foot);
            let slope = 1.0 + d * d + (f - y) * dd;
            let step = (x - foot + (y - f) * d) / slope;
            if !(slope > 0.0 && step.abs() < POLISHED * h) {
                break;
            }
            foot += step;
        }
        foot
    }
}

/// A polynomial, lowest coefficient first, and its derivative.
fn evaluate(p: &[f64], u: f64) -> [f64; 2] {
    let horner = |[f, d]: [f64; 2], c: &f64| [f * u + c, d * u + f];
    p.iter().rev().fold([0.0; 2], horner)
}

/// The roots of a polynomial in [−1, 1] at which it changes its sign, in increasing order, and how many there are.
fn roots_within(p: &[f64], roots: &mut [f64; ROOM]) -> usize {
    let mut nroot = 0;
    let mut derivative = [0.0; ROOM];
    for order in (0..p.len() - 1).rev() {
        // p^(order) / order!, so that the numbers stay small
        let m = p.len() - order;
        for (k, (d, c)) in derivative.iter_mut().zip(&p[order..]).enumerate() {
            *d = c * binomial(k + order, order);
        }
        let here = &derivative[..m];
        let turns = *roots;
        let nturn = nroot;
        nroot = 0;
        let mut a = -1.0;
        for &b in turns[..nturn].iter().chain([&1.0]) {
            if let Some(root) = root_between(here, a, b) {
                roots[nroot] = root;
                nroot += 1;
            }
            a = b;
        }
    }
    nroot
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// The root of a polynomial that is monotonous in `a ≤ u < b`, by Newton's method kept within its bracket.
fn root_between(p: &[f64], mut a: f64, mut b: f64) -> Option<f64> {
    let (at_a, at_b) = (evaluate(p, a)[0], evaluate(p, b)[0]);
    if at_a == 0.0 {
        return Some(a);
    }
    if at_a * at_b.signum() >= 0.0 || at_b == 0.0 {
        return None;
    }
    let mut u = 0.5 * (a + b);
    for _ in 0..200 {
        let [f, slope] = evaluate(p, u);
        if f == 0.0 {
            break;
        }
        if (f < 0.0) == (at_a < 0.0) {
            a = u;
        } else {
            b = u;
        }
        let newton = u - f / slope;
        let next = if a < newton && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
        if (next - u).abs() <= f64::EPSILON * u.abs() || next == a || next == b {
            u = next;
            break;
        }
        u = next;
    }
    Some(u)
}

impl Shape for Polynomial {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let x = self.foot(point.x, point.y);
        let foot = Vec3::new(x, self.at(x)[0], point.z);
        Ok(foot.is_finite().then_some(foot))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let [_, d, dd] = self.at(on.x);
        let stretch = d.hypot(1.0);
        let tangent = Vec3::new(1.0, d, 0.0) / stretch;
        let normal = Vec3::new(-d, 1.0, 0.0) / stretch;
        let bend = -dd / (stretch * stretch * stretch);
        let patch = Patch::smooth(normal, dyad(tangent) * bend);
        Ok(match self.facing {
            Facing::Above => patch,
            Facing::Below => patch.reversed(),
        })
    }
}
