use std::collections::BTreeMap;
use thiserror::Error;

/// The constants of a material, by their names in a case. A number is a list of one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constants {
    values: BTreeMap<String, Vec<f64>>,
}

/// Why constants make no material.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConstantsError {
    /// One is missing.
    #[error("the constant {name} is missing")]
    Missing {
        /// Its name.
        name: &'static str,
    },
    /// One is not in its range.
    #[error("{name} = {value} is not allowed: it must be {allowed}")]
    Range {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        allowed: &'static str,
    },
    /// A list where there must be one number.
    #[error("the constant {name} must be one number")]
    Several {
        /// Its name.
        name: &'static str,
    },
    /// Several that do not fit each other.
    #[error("{what}")]
    Unfit {
        /// What is wrong, in words.
        what: &'static str,
    },
}

impl Constants {
    /// Young's modulus and Poisson's ratio.
    #[must_use]
    pub fn elastic(e: f64, nu: f64) -> Self {
        let mut constants = Self::default();
        constants.set("E", vec![e]);
        constants.set("nu", vec![nu]);
        constants
    }

    /// A value for every constant of every law.
    #[cfg(test)]
    pub(crate) fn sample() -> Self {
        let mut constants = Self::elastic(500.0, 0.3);
        for (name, values) in [
            ("c10", &[80.0][..]),
            ("c01", &[30.0]),
            ("bulk", &[700.0]),
            ("mu", &[150.0, -20.0, 60.0]),
            ("alpha", &[1.3, -2.0, 5.0]),
            ("E1", &[900.0]),
            ("E2", &[400.0]),
            ("E3", &[250.0]),
            ("nu12", &[0.3]),
            ("nu13", &[0.25]),
            ("nu23", &[0.4]),
            ("G12", &[170.0]),
            ("G13", &[140.0]),
            ("G23", &[90.0]),
            ("T", &[0.0]),
            ("residual", &[50.0]),
            ("reference_stress", &[20.0]),
            ("exponent", &[3.0]),
            ("offset", &[0.4]),
            (
                "D",
                &[
                    300.0, 110.0, 320.0, 130.0, 140.0, 350.0, 16.0, 17.0, 18.0, 190.0, 20.0, 21.0,
                    22.0, 23.0, 240.0, 25.0, 26.0, 27.0, 28.0, 29.0, 200.0,
                ],
            ),
        ] {
            constants.set(name, values.to_vec());
        }
        constants
    }

    /// Gives a constant its value.
    pub fn set(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.values.insert(name.into(), values);
    }

    /// A number.
    ///
    /// # Errors
    /// It is missing, or a list of several.
    pub fn number(&self, name: &'static str) -> Result<f64, ConstantsError> {
        match self.list(name)? {
            [value] => Ok(*value),
            _ => Err(ConstantsError::Several { name }),
        }
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// It is missing.
    pub fn list(&self, name: &'static str) -> Result<&[f64], ConstantsError> {
        let values = self.values.get(name).filter(|v| !v.is_empty());
        values
            .map(Vec::as_slice)
            .ok_or(ConstantsError::Missing { name })
    }

    /// A number greater than zero.
    ///
    /// # Errors
    /// It is missing, or not positive.
    pub fn positive(&self, name: &'static str) -> Result<f64, ConstantsError> {
        let value = self.number(name)?;
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        Err(ConstantsError::Range {
            name,
            value,
            allowed: "greater than 0",
        })
    }

    /// Young's modulus `E > 0` and Poisson's ratio `−1 < nu < ½`.
    ///
    /// # Errors
    /// One is missing, or out of its range.
    pub fn isotropic(&self) -> Result<(f64, f64), ConstantsError> {
        let (e, nu) = (self.positive("E")?, self.number("nu")?);
        if nu > -1.0 && nu < 0.5 {
            return Ok((e, nu));
        }
        Err(ConstantsError::Range {
            name: "nu",
            value: nu,
            allowed: "greater than -1 and less than 0.5",
        })
    }
}
