//! Heat in a run: its audit, and the entry of `summary.json`.

use super::worst::{Worst, number};
use signorini_io::checkpoint::{Archive, ArchiveError};
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::writers::json::{HeatEntry, HeatSummary};
use signorini_mechanics::audit;
use signorini_mechanics::system::{Frame, HeatBalance, HeatFlows, Measured};

/// The name under which its findings are stored, where there are any.
const STORED: &str = "run/audit.heat";

/// What the audit of heat found so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct HeatAudit(Worst);

impl HeatAudit {
    /// Looks at an accepted increment.
    pub fn look(&mut self, frame: &Frame) {
        let largest = self.0.measured.allowed;
        let Some(measured) = audit::heat(frame, largest) else {
            return;
        };
        self.0.take(&measured, frame.time);
        self.0.measured.allowed = measured.allowed;
    }

    /// The worst of all increments; none where no step found temperatures.
    pub fn seen(&self) -> Option<&Worst> {
        Some(&self.0).filter(|worst| worst.measured.limit > 0.0)
    }

    /// Whether as much came in as was taken up, in all increments.
    pub fn passes(&self) -> bool {
        self.0.failed == 0
    }

    /// A warning, where that is not so.
    pub fn warning(&self, increments: u64) -> Diagnostic {
        let m = &self.0.measured;
        let message = format!(
            "heat is lost or made: {:.1e} of what flows, where {:.0e} is let pass",
            m.part, m.limit
        );
        Diagnostic::warning(&codes::HEAT_LOST, message)
            .note(format!(
                "the balance is off by {} of heat per time",
                number(m.worst)
            ))
            .note(self.0.times(increments))
            .help("smaller residuals:  newton = { force_tol = 1e-12 }  in [solver]")
            .help("smaller increments")
    }

    /// Stores the findings in a checkpoint, where there are any.
    ///
    /// # Errors
    /// A name that the archive has.
    pub fn save(&self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let Some(worst) = self.seen() else {
            return Ok(());
        };
        let m = &worst.measured;
        let failed = worst.failed as f64;
        let numbers = [
            m.part,
            m.limit,
            m.worst,
            m.allowed,
            worst.time,
            worst.first,
            failed,
        ];
        archive.put_f64(STORED, &numbers)
    }

    /// The state in a checkpoint; nothing seen where it does not know of heat.
    pub fn restored(archive: &Archive) -> Self {
        let numbers = archive.get_f64(STORED).unwrap_or_default();
        let numbers = numbers.first_chunk().copied();
        let of = |[part, limit, worst, allowed, time, first, failed]: [f64; 7]| Worst {
            measured: Measured {
                part,
                limit,
                worst,
                allowed,
                ..Measured::default()
            },
            time,
            first,
            failed: failed as u64,
        };
        Self(numbers.map(of).unwrap_or_default())
    }
}

/// The balance as results have it: what bodies took up counts in steps of all kinds, all else in transient ones.
pub(super) fn reported(frame: &Frame) -> HeatBalance {
    let balance = frame.heat.unwrap_or_default();
    HeatBalance {
        total: HeatFlows {
            stored: frame.heat_stored,
            ..balance.total
        },
        ..balance
    }
}

/// The entry of `summary.json`.
pub(super) fn summary(balance: &HeatBalance) -> HeatSummary {
    let entry = |flows: HeatFlows| HeatEntry {
        loads: flows.loads,
        supports: flows.supports,
        surfaces: flows.surfaces,
        friction: flows.friction,
        stored: flows.stored,
    };
    HeatSummary {
        rate: entry(balance.rate),
        total: entry(balance.total),
        imbalance: balance.imbalance(),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Heat of 10 that comes in, of which this is lost.
    pub fn balance(lost: f64) -> HeatBalance {
        HeatBalance {
            rate: HeatFlows {
                loads: 10.0,
                stored: 10.0 - lost,
                ..HeatFlows::default()
            },
            turnover: 10.0,
            ..HeatBalance::default()
        }
    }

    #[test]
    fn heat_that_is_lost_is_doubted_by_its_part_of_the_largest_so_far() {
        let mut audit = HeatAudit::default();
        audit.look(&Frame::default());
        assert!(audit.seen().is_none() && audit.passes());
        let mut look = |time: f64, lost: f64, size: f64| {
            let mut heat = balance(lost);
            (heat.rate, heat.turnover) = (heat.rate.times(size), size * heat.turnover);
            audit.look(&Frame {
                time,
                heat: Some(heat),
                ..Frame::default()
            });
            audit.passes()
        };
        assert!(look(1.0, 5e-8, 1.0));
        assert!(look(2.0, 1e-3, 1e-6));
        assert!(!look(3.0, 1e-4, 1.0));
        assert!(!look(4.0, 0.0, 1.0));
        let worst = audit.seen().unwrap();
        assert_eq!((worst.failed, worst.first, worst.time), (1, 3.0, 3.0));
        assert!((worst.measured.part - 1e-5).abs() < 1e-12);
        let text = audit.warning(4).message;
        assert!(text.contains("1.0e-5 of what flows"), "{text}");
        let mut archive = Archive::new();
        audit.save(&mut archive).unwrap();
        assert_eq!(HeatAudit::restored(&archive), audit);
    }
}
