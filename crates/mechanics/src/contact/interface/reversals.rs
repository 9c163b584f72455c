//! Rows that slip the other way in every iterate.
//!
//! A row that slips is on the disc `|λ_t| = L`; its next direction is that of `z = λ_t + c_t e`. Let k be the stiffness
//! against which it slips, and λ* the traction with which it would stick. With λ_t = L along the direction of slip it finds
//! the slip `e = (λ* − L)/k`, so that
//!
//! ```text
//! z = L − (c_t/k) (L − λ*)                                                                   (E1)
//! ```
//!
//! Where `c_t (L − λ*) > 2 k L`, z is beyond the other end of the disc: the row slips the other way, and from there back by
//! the same formula, for ever, while its state is "slip" all the time. With `c_t < k`, z goes to the inside of the disc, and
//! the row sticks. Nobody knows k: rows that slip together over a length l have G/l, not G/h. So c_t of a row falls by
//! [`EASE`] whenever the row slips against its last direction, and is what it was in the next increment. The solution does not
//! depend on c_t, as any c_t > 0 has the same roots (Alart and Curnier 1991; Hüeber, Stadler and Wohlmuth 2008).

use signorini_geometry::tensor::Vec3;

/// By what c_t of a row falls where its slip turns round.
const EASE: f64 = 0.1;
/// The least that is left of c_t.
const LEAST: f64 = 1e-6;

/// What has become of c_t of each row in an increment, and in which direction it slipped last.
#[derive(Debug)]
pub(super) struct Reversals {
    factors: Vec<f64>,
    directions: Vec<Vec3>,
}

impl Reversals {
    pub fn new(nrow: usize) -> Self {
        Self {
            factors: vec![1.0; nrow],
            directions: vec![Vec3::ZERO; nrow],
        }
    }

    /// Forgets everything.
    pub fn reset(&mut self, nrow: usize) {
        self.factors.clear();
        self.factors.resize(nrow, 1.0);
        self.directions.clear();
        self.directions.resize(nrow, Vec3::ZERO);
    }

    /// What is left of c_t of a row.
    pub fn factor(&self, row: usize) -> f64 {
        self.factors.get(row).copied().unwrap_or(1.0)
    }

    /// Looks at the directions in which rows slip in an iterate, zero where they do not; says how many have turned round.
    pub fn look(&mut self, directions: impl Iterator<Item = Vec3>) -> usize {
        let mut turned = 0;
        let of_rows = self.factors.iter_mut().zip(&mut self.directions);
        for ((factor, last), direction) in of_rows.zip(directions) {
            if direction.dot(*last) < 0.0 {
                *factor = (*factor * EASE).max(LEAST);
                turned += 1;
            }
            *last = direction;
        }
        turned
    }
}

#[cfg(test)]
mod tests {
    use super::Reversals;
    use signorini_geometry::tensor::Vec3;

    const LIMIT: f64 = 1.0;

    /// Iterations of a row on a spring of stiffness 1, from slip along the first axis to sticking at the traction `sticks`.
    fn iterations(c: f64, sticks: f64, mut reversals: Option<Reversals>) -> Option<usize> {
        let mut traction = LIMIT;
        for iteration in 1..20 {
            let slip = sticks - traction;
            let ease = reversals.as_ref().map_or(1.0, |r| r.factor(0));
            let trial = traction + ease * c * slip;
            if trial.abs() <= LIMIT {
                return Some(iteration);
            }
            traction = LIMIT.copysign(trial);
            if let Some(reversals) = &mut reversals {
                reversals.look([Vec3::unit(0) * trial.signum()].into_iter());
            }
        }
        None
    }

    #[test]
    fn a_row_on_a_soft_spring_sticks_after_a_few_reversals_of_slip() {
        for sticks in [-0.9, -0.2, 0.0, 0.2, 0.9] {
            for c in [1.5, 10.0, 1000.0] {
                let eased = iterations(c, sticks, Some(Reversals::new(1)));
                let most = 4 + c.log10() as usize;
                assert!(eased.is_some_and(|n| n <= most), "{c} {sticks}: {eased:?}");
            }
        }
        assert_eq!(iterations(10.0, 0.2, None), None);
    }

    #[test]
    fn a_row_that_opens_turns_or_starts_again_keeps_its_parameter() {
        let mut reversals = Reversals::new(2);
        let [x, y] = [Vec3::unit(0), Vec3::unit(1)];
        let ways = [[x, x], [y, Vec3::ZERO], [x, x * -1.0]];
        let turned = ways.map(|ways| reversals.look(ways.into_iter()));
        assert_eq!((turned, reversals.factor(0)), ([0, 0, 0], 1.0));
        assert_eq!(reversals.look([x * -1.0, x].into_iter()), 2);
        assert_eq!([0, 1, 2].map(|row| reversals.factor(row)), [0.1, 0.1, 1.0]);
        reversals.reset(3);
        assert_eq!([0, 1, 2].map(|row| reversals.factor(row)), [1.0; 3]);
    }
}
