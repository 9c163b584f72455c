//! One process.

use crate::Ranks;
use crate::error::{RanksError, fits};

/// A process that computes by itself: what all ranks have is what it has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn all_gather(&self, own: &[f64], counts: &[usize], all: &mut [f64]) -> Result<(), RanksError> {
        fits("counts", counts.len(), 1)?;
        fits("numbers of a rank", own.len(), counts[0])?;
        fits("numbers of all ranks", all.len(), own.len())?;
        all.copy_from_slice(own);
        Ok(())
    }

    fn broadcast(&self, _: &mut [u8]) -> Result<(), RanksError> {
        Ok(())
    }

    fn least(&self, _: &mut [u64]) -> Result<(), RanksError> {
        Ok(())
    }

    fn abort(&self, _: u8) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agree;

    #[test]
    fn one_process_hears_itself() {
        let mut all = [0.0; 3];
        Alone.all_gather(&[1.0, 2.0, 3.0], &[3], &mut all).unwrap();
        assert_eq!(all, [1.0, 2.0, 3.0]);
        let mut numbers = [3, 7];
        Alone.least(&mut numbers).unwrap();
        assert_eq!(numbers, [3, 7]);
        assert!(agree(&Alone, 0).unwrap() && agree(&Alone, u64::MAX).unwrap());
    }

    #[test]
    fn lists_that_do_not_fit_are_errors() {
        let mut all = [0.0; 3];
        assert!(Alone.all_gather(&[1.0], &[3], &mut all).is_err());
        assert!(Alone.all_gather(&[1.0], &[1], &mut all).is_err());
        assert!(Alone.all_gather(&[1.0], &[], &mut all).is_err());
    }
}
