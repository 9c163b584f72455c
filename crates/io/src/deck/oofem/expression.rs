//! Expressions of the time `t`: numbers, `+ - * / ^`, parentheses, functions.

use std::iter::Peekable;
use std::str::Chars;

/// How deep parentheses may stand in each other.
const DEPTH: usize = 64;

/// A function of one number, with its name.
type Function = (&'static str, fn(f64) -> f64);

const FUNCTIONS: [Function; 10] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
];

/// Why an expression has no value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionError {
    /// Something else than a number, `t`, a function or a parenthesis.
    #[error("`{found}` stands where a number, t, a function or ( should")]
    Unexpected {
        /// What stands there.
        found: String,
    },
    /// No such function.
    #[error(
        "there is no function `{name}`; there are sin, cos, tan, asin, acos, atan, exp, ln, sqrt, abs"
    )]
    Unknown {
        /// Its name.
        name: String,
    },
    /// Parentheses in parentheses.
    #[error("parentheses stand more than {DEPTH} deep in each other")]
    Deep,
    /// No number comes out.
    #[error("its value at t = {time} is {value}")]
    NotFinite {
        /// The time.
        time: String,
        /// The value.
        value: String,
    },
}

/// The value of an expression at a time.
///
/// # Errors
/// The text is no such expression, or its value is no finite number.
pub fn value(text: &str, time: f64) -> Result<f64, ExpressionError> {
    let mut parser = Parser {
        rest: text.chars().peekable(),
        time,
        depth: 0,
    };
    let value = parser.sum()?;
    if parser.next_is_any() {
        return Err(parser.unexpected());
    }
    if !value.is_finite() {
        return Err(ExpressionError::NotFinite {
            time: time.to_string(),
            value: value.to_string(),
        });
    }
    Ok(value)
}

struct Parser<'t> {
    rest: Peekable<Chars<'t>>,
    time: f64,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<char> {
        while self.rest.next_if(|c| c.is_whitespace()).is_some() {}
        self.rest.peek().copied()
    }

    fn next_is_any(&mut self) -> bool {
        self.peek().is_some()
    }

    fn take(&mut self, wanted: char) -> bool {
        let is_there = self.peek() == Some(wanted);
        if is_there {
            self.rest.next();
        }
        is_there
    }

    fn unexpected(&mut self) -> ExpressionError {
        let found: String = self.rest.by_ref().take(20).collect();
        ExpressionError::Unexpected { found }
    }

    fn sum(&mut self) -> Result<f64, ExpressionError> {
        let mut value = self.product()?;
        loop {
            if self.take('+') {
                value += self.product()?;
            } else if self.take('-') {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result<f64, ExpressionError> {
        let mut value = self.signed()?;
        loop {
            if self.take('*') {
                value *= self.signed()?;
            } else if self.take('/') {
                value /= self.signed()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn signed(&mut self) -> Result<f64, ExpressionError> {
        let mut sign = 1.0;
        while let Some(c @ ('-' | '+')) = self.peek() {
            self.rest.next();
            sign = if c == '-' { -sign } else { sign };
        }
        Ok(sign * self.power()?)
    }

    fn power(&mut self) -> Result<f64, ExpressionError> {
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        self.deeper(|this| Ok(base.powf(this.signed()?)))
    }

    fn deeper(
        &mut self,
        of: impl FnOnce(&mut Self) -> Result<f64, ExpressionError>,
    ) -> Result<f64, ExpressionError> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(ExpressionError::Deep);
        }
        let value = of(self);
        self.depth -= 1;
        value
    }

    fn parenthesis(&mut self) -> Result<f64, ExpressionError> {
        if !self.take('(') {
            return Err(self.unexpected());
        }
        let value = self.deeper(Self::sum)?;
        if self.take(')') {
            Ok(value)
        } else {
            Err(self.unexpected())
        }
    }

    fn atom(&mut self) -> Result<f64, ExpressionError> {
        match self.peek() {
            Some('(') => self.parenthesis(),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => {
                let mut name = String::new();
                while let Some(c) = self.rest.next_if(|c| c.is_alphanumeric() || *c == '_') {
                    name.push(c);
                }
                let name = name.to_lowercase();
                match name.as_str() {
                    "t" => return Ok(self.time),
                    "pi" => return Ok(std::f64::consts::PI),
                    _ => {}
                }
                let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
                let Some((_, function)) = known else {
                    let name = name.chars().take(20).collect();
                    return Err(ExpressionError::Unknown { name });
                };
                Ok(function(self.parenthesis()?))
            }
            _ => Err(self.unexpected()),
        }
    }

    fn number(&mut self) -> Result<f64, ExpressionError> {
        let mut text = String::new();
        loop {
            let after_exponent = text.ends_with(['e', 'E']);
            let belongs = |c: &char| {
                c.is_ascii_digit()
                    || *c == '.'
                    || matches!(c, 'e' | 'E')
                    || after_exponent && matches!(c, '+' | '-')
            };
            match self.rest.next_if(belongs) {
                Some(c) => text.push(c),
                None => break,
            }
        }
        text.parse()
            .map_err(|_| ExpressionError::Unexpected { found: text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_have_the_values_of_algebra() {
        for (text, wanted) in [
            ("t", 2.0),
            ("-3*t + 4/2 - 1e-1", -4.1),
            ("2*(t-1)^2^3", 2.0),
            ("-t^2", -4.0),
            ("sin(pi*t/4)", 1.0),
            (" sqrt( abs(-8*T) ) ", 4.0),
            ("2^-1", 0.5),
            ("1.5E+2", 150.0),
            ("exp(ln(3))", 3.0),
        ] {
            let got = value(text, 2.0).unwrap();
            assert!((got - wanted).abs() < 1e-14, "{text}: {got}");
        }
    }

    #[test]
    fn what_is_no_expression_is_refused() {
        for text in [
            "", "2*", "(t", "t)", "x", "log(2)", "1/0*0", "3 4", "sin t", "1..2",
        ] {
            assert!(value(text, 1.0).is_err(), "{text}");
        }
        let deep = "(".repeat(100_000);
        assert_eq!(value(&deep, 1.0), Err(ExpressionError::Deep));
        let powers = "t^".repeat(100_000);
        assert_eq!(value(&powers, 1.0), Err(ExpressionError::Deep));
    }
}
