//! Plausibility of material values in the units a case is labelled with.
//!
//! A label `length-force-stress` such as `mm-N-MPa` is coherent when stress = force / length². Young's modulus in
//! pascal is then E times the unit of stress, density in kg/m³ is ρ times force · s² / length⁴.

use super::parts::{Case, Material};
use crate::diagnostic::{Diagnostic, Diagnostics, Spanned, codes};

/// Young's modulus of steel (Pa).
const STEEL: f64 = 2.1e11;
/// The softest gels and, with a margin, diamond (Pa).
const STIFFNESS: (f64, f64) = (1.0e2, 2.0e12);
/// The lightest foams and, with a margin, osmium (kg/m³).
const DENSITY: (f64, f64) = (0.1, 3.0e4);

/// Warnings about values that do not fit the label.
pub(super) fn plausibility(case: &Case) -> Diagnostics {
    let mut found = Diagnostics::new();
    if case.units.is_empty() {
        return found;
    }
    let Some(units) = Units::parse(&case.units) else {
        found.push(
            Diagnostic::warning(
                &codes::STRANGE_UNITS,
                format!("units \"{}\" are not understood", case.units.value),
            )
            .at(
                &case.units.place,
                "length-force-stress, with stress = force / length²",
            )
            .note("plausibility is not checked; nothing else depends on the label")
            .help("write one of mm-N-MPa, m-N-Pa, m-MN-MPa, um-uN-MPa"),
        );
        return found;
    };
    for material in &case.materials {
        found.append(stiffness(material, &units, &case.units));
        found.append(density(material, &units, &case.units));
    }
    found
}

fn stiffness(material: &Material, units: &Units, label: &str) -> Diagnostics {
    let Some(young) = material.constants.iter().find(|one| one.name == "E") else {
        return Diagnostics::new();
    };
    let value = young.values.first().copied().unwrap_or_default();
    let pascal = value * units.stress;
    if (STIFFNESS.0..=STIFFNESS.1).contains(&pascal) {
        return Diagnostics::new();
    }
    let message = format!(
        "E = {} with units \"{label}\" is {} steel",
        short(value),
        times(pascal / STEEL)
    );
    // The same digits read as pascal, or as megapascal, are often what was meant.
    let meant = [(1.0, "Pa"), (1e6, "MPa"), (1e9, "GPa")]
        .into_iter()
        .find(|(unit, _)| (STEEL / 300.0..=STIFFNESS.1).contains(&(value * unit)));
    let remark = meant.map_or_else(String::new, |(unit, name)| {
        let pascal = value * unit;
        let (shown, shown_name) = if pascal >= 1e9 {
            (pascal / 1e9, "GPa")
        } else {
            (pascal / 1e6, "MPa")
        };
        let read = if name == "Pa" {
            format!("{shown} {shown_name}")
        } else {
            format!("{} {name}", value)
        };
        format!(
            "{read} in {} is {}",
            units.stress_name,
            engineering(pascal / units.stress)
        )
    });
    Diagnostic::warning(&codes::IMPLAUSIBLE, message)
        .at(&young.values.place, remark)
        .note("silence with  allow = [\"S0402\"]")
        .into()
}

fn density(material: &Material, units: &Units, label: &str) -> Diagnostics {
    let Some(Spanned { value, place }) = &material.density else {
        return Diagnostics::new();
    };
    let si = value * units.force / units.length.powi(4);
    if (DENSITY.0..=DENSITY.1).contains(&si) {
        return Diagnostics::new();
    }
    let steel = short(7850.0 * units.length.powi(4) / units.force);
    Diagnostic::warning(
        &codes::IMPLAUSIBLE,
        format!(
            "density = {} with units \"{label}\" is {} steel",
            short(*value),
            times(si / 7850.0)
        ),
    )
    .at(place, format!("steel has {steel} in these units"))
    .note("silence with  allow = [\"S0402\"]")
    .into()
}

struct Units {
    /// In metres.
    length: f64,
    /// In newtons.
    force: f64,
    /// In pascals.
    stress: f64,
    stress_name: String,
}

impl Units {
    fn parse(label: &str) -> Option<Self> {
        let mut parts = label.split('-').map(str::trim);
        let (length, force, stress) = (parts.next()?, parts.next()?, parts.next()?);
        if parts.next().is_some() {
            return None;
        }
        let units = Self {
            length: match length {
                "in" => 0.0254,
                "ft" => 0.3048,
                other => prefixed(other, "m")?,
            },
            force: match force {
                "lbf" => 4.448_221_615_260_5,
                other => prefixed(other, "N")?,
            },
            stress: match stress {
                "psi" => 6_894.757_293_168,
                "psf" => 47.880_258_980_336,
                other => prefixed(other, "Pa")?,
            },
            stress_name: stress.to_owned(),
        };
        let coherent = units.force / units.length.powi(2);
        ((coherent / units.stress - 1.0).abs() < 1e-6).then_some(units)
    }
}

/// The size of a unit with a prefix, as in `kN`, in its unit without.
fn prefixed(name: &str, unit: &str) -> Option<f64> {
    Some(match name.strip_suffix(unit)? {
        "" => 1.0,
        "n" => 1e-9,
        "u" | "µ" | "μ" => 1e-6,
        "m" => 1e-3,
        "c" => 1e-2,
        "d" => 1e-1,
        "k" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        _ => return None,
    })
}

/// `a million times`, `a thousandth of`.
fn times(ratio: f64) -> String {
    let power = ratio.log10().round();
    let names = [(3.0, "thousand"), (6.0, "million"), (9.0, "billion")];
    let near = (ratio.log10() - power).abs() < 0.15;
    match names
        .iter()
        .find(|(exponent, _)| near && *exponent == power.abs())
    {
        Some((_, name)) if power > 0.0 => format!("a {name} times"),
        Some((_, name)) => format!("a {name}th of"),
        None => format!("{} times", short(ratio)),
    }
}

/// A number with three digits at most, as in `2.1e11`, `210e3`.
fn short(value: f64) -> String {
    let exponent = value.abs().log10().floor();
    if (-2.0..3.0).contains(&exponent) {
        let digits = (2.0 - exponent).max(0.0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        let text = format!("{value:.2e}");
        match text.split_once('e') {
            Some((mantissa, power)) if mantissa.contains('.') => {
                format!(
                    "{}e{power}",
                    mantissa.trim_end_matches('0').trim_end_matches('.')
                )
            }
            _ => text,
        }
    }
}

/// A number with an exponent that is a multiple of three, as in `210e3`.
fn engineering(value: f64) -> String {
    let power = (value.abs().log10() / 3.0 + 1e-9).floor() * 3.0;
    let mantissa = short(value / 10f64.powf(power));
    if power == 0.0 {
        mantissa
    } else {
        format!("{mantissa}e{power}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coherent_labels_are_understood_and_others_not() {
        for label in [
            "mm-N-MPa",
            "m-N-Pa",
            "m-MN-MPa",
            "um-uN-MPa",
            "µm-µN-MPa",
            "m-kN-kPa",
            "in-lbf-psi",
            "mm-kN-GPa",
        ] {
            assert!(Units::parse(label).is_some(), "{label}");
        }
        for label in ["m-N-MPa", "mm-N", "metric", "mm-N-MPa-s", "--", "km-N-Pa"] {
            assert!(Units::parse(label).is_none(), "{label}");
        }
    }

    #[test]
    fn ratios_are_said_in_words() {
        assert_eq!(times(1e6), "a million times");
        assert_eq!(times(1e-3), "a thousandth of");
        assert_eq!(times(42.0), "42 times");
        assert_eq!(short(2.1e11), "2.1e11");
        assert_eq!(short(0.25), "0.25");
        assert_eq!(short(1.0e-9), "1e-9");
        assert_eq!(short(100.0), "100");
        assert_eq!(engineering(2.1e5), "210e3");
        assert_eq!(engineering(1000.0), "1e3");
        assert_eq!(engineering(0.5), "500e-3");
    }
}
