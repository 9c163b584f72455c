use thiserror::Error;

/// What grows with plastic strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HardeningKind {
    /// The radius of the yield surface, by the table.
    Isotropic,
    /// The yield surface moves: the radius stays, the centre goes so far that monotonic uniaxial stress follows the table.
    Kinematic,
    /// The radius by the table, and the centre linearly: monotonic uniaxial stress is the table plus `modulus` times the
    /// equivalent plastic strain.
    Combined {
        /// Slope of the centre over plastic strain in uniaxial stress, at least 0.
        modulus: f64,
    },
}

/// Yield stress over equivalent plastic strain, straight between the rows of a table and constant beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardening {
    kind: HardeningKind,
    table: Vec<[f64; 2]>,
    /// Slope of the centre that is not in the table.
    modulus: f64,
}

/// Why rows make no hardening.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum HardeningError {
    /// No row.
    #[error("the table of yield stresses has no row")]
    Empty,
    /// It does not begin with the first yield.
    #[error(
        "the table of yield stresses begins at the plastic strain {strain}: its first row must be [yield stress, 0]"
    )]
    First {
        /// The plastic strain of the first row.
        strain: f64,
    },
    /// Plastic strains do not increase.
    #[error(
        "row {row} of the table of yield stresses: its plastic strain {strain} must be greater than that of the row before"
    )]
    Order {
        /// The row, from 1.
        row: usize,
        /// Its plastic strain.
        strain: f64,
    },
    /// A yield stress is not positive.
    #[error("row {row} of the table of yield stresses: {stress} must be greater than 0")]
    Stress {
        /// The row, from 1.
        row: usize,
        /// Its yield stress.
        stress: f64,
    },
    /// The yield stress falls too fast.
    #[error(
        "row {row} of the table of yield stresses: the stress falls with the slope {slope:.6e} on the way there, which must \
         stay above minus three times the shear modulus"
    )]
    Falling {
        /// The row, from 1.
        row: usize,
        /// Its slope.
        slope: f64,
    },
    /// The slope of the centre is negative or not a number.
    #[error("the kinematic modulus {modulus} must be 0 or greater")]
    Modulus {
        /// It.
        modulus: f64,
    },
}

/// How far plastic flow went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Flow {
    /// Increment of the equivalent plastic strain.
    pub plastic: f64,
    /// Increment of the centre, as uniaxial stress.
    pub centre: f64,
    /// Slope of radius and centre together at the end.
    pub slope: f64,
    /// Integral of the growth of the centre, and of the radius, over the increment.
    pub work: f64,
}

impl Hardening {
    /// From rows `[true yield stress, equivalent plastic strain]`.
    ///
    /// # Errors
    /// The table is empty, does not begin at the plastic strain 0, its plastic strains do not increase, a stress or a
    /// modulus is out of range.
    pub fn new(kind: HardeningKind, table: Vec<[f64; 2]>) -> Result<Self, HardeningError> {
        let first = table.first().ok_or(HardeningError::Empty)?;
        if first[1] != 0.0 {
            return Err(HardeningError::First { strain: first[1] });
        }
        let mut last = f64::NEG_INFINITY;
        for (i, &[stress, strain]) in table.iter().enumerate() {
            let row = i + 1;
            if !(stress > 0.0 && stress.is_finite()) {
                return Err(HardeningError::Stress { row, stress });
            }
            if !(strain > last && strain.is_finite()) {
                return Err(HardeningError::Order { row, strain });
            }
            last = strain;
        }
        let modulus = match kind {
            HardeningKind::Combined { modulus } => modulus,
            _ => 0.0,
        };
        if !(modulus >= 0.0 && modulus.is_finite()) {
            return Err(HardeningError::Modulus { modulus });
        }
        Ok(Self {
            kind,
            table,
            modulus,
        })
    }

    /// That no stretch of the table falls as steeply as a stiffness unloads.
    pub(super) fn check_slope(&self, stiffness: f64) -> Result<(), HardeningError> {
        for i in 1..self.table.len() {
            let slope = self.segment(i).0;
            if slope + self.modulus <= -stiffness {
                return Err(HardeningError::Falling { row: i + 1, slope });
            }
        }
        Ok(())
    }

    /// Slope up to a row and its plastic strain; beyond the last row flat and endless.
    fn segment(&self, row: usize) -> (f64, f64) {
        match (
            row.checked_sub(1).and_then(|i| self.table.get(i)),
            self.table.get(row),
        ) {
            (Some(a), Some(b)) => ((b[0] - a[0]) / (b[1] - a[1]), b[1]),
            _ => (0.0, f64::INFINITY),
        }
    }

    /// The first row beyond a plastic strain.
    fn row(&self, plastic: f64) -> usize {
        self.table.partition_point(|row| row[1] <= plastic)
    }

    /// Radius of the yield surface, as uniaxial stress.
    pub(super) fn radius(&self, plastic: f64) -> f64 {
        let plastic = match self.kind {
            HardeningKind::Kinematic => 0.0,
            _ => plastic,
        };
        let row = self.row(plastic);
        let start = row.checked_sub(1).and_then(|i| self.table.get(i));
        start.map_or(0.0, |[stress, strain]| {
            stress + self.segment(row).0 * (plastic - strain)
        })
    }

    /// How far the flow goes that takes away `excess`, the uniaxial stress beyond the yield surface, when stress falls by
    /// `stiffness` per equivalent plastic strain: exact across the rows.
    pub(super) fn flow(&self, plastic: f64, mut excess: f64, stiffness: f64) -> Flow {
        let radius = self.radius(plastic);
        let mut flow = Flow::default();
        let mut row = self.row(plastic);
        let mut grown = 0.0;
        loop {
            let (table, end) = self.segment(row);
            flow.slope = table + self.modulus;
            let room = end - plastic - flow.plastic;
            let whole = excess / (stiffness + flow.slope);
            let step = whole.min(room);
            flow.work += (grown + 0.5 * flow.slope * step) * step;
            grown += flow.slope * step;
            flow.plastic += step;
            flow.centre += step
                * match self.kind {
                    HardeningKind::Kinematic => table,
                    _ => self.modulus,
                };
            if whole <= room {
                flow.work += radius * flow.plastic;
                return flow;
            }
            excess -= (stiffness + flow.slope) * step;
            row += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_that_is_none_is_refused_with_its_row() {
        let new = |rows: &[[f64; 2]]| Hardening::new(HardeningKind::Isotropic, rows.to_vec());
        assert_eq!(new(&[]), Err(HardeningError::Empty));
        let outcome = new(&[[200.0, 0.1]]);
        assert_eq!(outcome, Err(HardeningError::First { strain: 0.1 }));
        let outcome = new(&[[200.0, 0.0], [250.0, 0.0]]);
        let expected = HardeningError::Order {
            row: 2,
            strain: 0.0,
        };
        assert_eq!(outcome, Err(expected));
        let outcome = new(&[[200.0, 0.0], [0.0, 0.1]]);
        let expected = HardeningError::Stress {
            row: 2,
            stress: 0.0,
        };
        assert_eq!(outcome, Err(expected));
        assert!(matches!(
            new(&[[f64::NAN, 0.0]]),
            Err(HardeningError::Stress { row: 1, .. })
        ));
        assert!(matches!(
            new(&[[1.0, 0.0], [1.0, f64::NAN]]),
            Err(HardeningError::Order { row: 2, .. })
        ));
        let kind = HardeningKind::Combined { modulus: -1.0 };
        assert_eq!(
            Hardening::new(kind, vec![[1.0, 0.0]]),
            Err(HardeningError::Modulus { modulus: -1.0 })
        );
        let falling = new(&[[200.0, 0.0], [100.0, 0.1]]).unwrap();
        assert!(falling.check_slope(1001.0).is_ok());
        assert_eq!(
            falling.check_slope(1000.0),
            Err(HardeningError::Falling {
                row: 2,
                slope: -1000.0
            })
        );
    }

    #[test]
    fn flow_is_exact_across_rows() {
        let rows = vec![[200.0, 0.0], [300.0, 0.1], [350.0, 0.3]];
        let hardening = Hardening::new(HardeningKind::Isotropic, rows).unwrap();
        assert_eq!(hardening.radius(0.05), 250.0);
        assert_eq!(hardening.radius(9.0), 350.0);
        // from 0.05 to 0.4: the radius grows by 100, stress falls by 1000 · 0.35
        let flow = hardening.flow(0.05, 100.0 + 350.0, 1000.0);
        assert!((flow.plastic - 0.35).abs() < 1e-15);
        assert_eq!((flow.slope, flow.centre), (0.0, 0.0));
        let area = 0.05 * 275.0 + 0.2 * 325.0 + 0.1 * 350.0;
        assert!((flow.work - area).abs() < 1e-13 * area);
    }
}
