//! The natural frequencies that the steps of a run have found: `frequencies.csv`, the summary, and what there is to say of them.

use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_io::writers::csv::{self, Cell, FREQUENCY_COLUMNS};
use signorini_io::writers::json::{FrequencySummary, ModeSummary};
use signorini_mechanics::solve::{Step, Vibrations};
use std::f64::consts::TAU;

/// The part of the stiffness that may be left out, being not symmetric, without a word.
const ASYMMETRY: f64 = 1e-6;

/// Numbers of a step and of a mode in a checkpoint.
const OF_STEP: usize = 9;
const OF_MODE: usize = 6;

/// What all steps so far have found.
#[derive(Debug, Default)]
pub struct Frequencies {
    found: Vec<Found>,
}

#[derive(Debug)]
struct Found {
    /// Number of the step, from 0.
    step: usize,
    /// [`Vibrations::asymmetry`].
    asymmetry: f64,
    /// [`Vibrations::nunstable`].
    nunstable: usize,
    summary: FrequencySummary,
}

impl Frequencies {
    /// Takes what a step has found, and returns it in the form of the summary.
    pub fn add(
        &mut self,
        step: usize,
        name: String,
        time: f64,
        found: &Vibrations,
    ) -> &FrequencySummary {
        let modes = found.modes.iter().zip(1..);
        let modes = modes.map(|(mode, number)| ModeSummary {
            residual: mode.residual,
            converged: mode.has_converged,
            ..summary(number, mode.eigenvalue, mode.participation)
        });
        let found = Found {
            step,
            asymmetry: found.asymmetry,
            nunstable: found.nunstable(),
            summary: FrequencySummary {
                step: name,
                time,
                counted: found.is_counted,
                mass: found.mass,
                modes: modes.collect(),
            },
        };
        self.found.retain(|before| before.step != step);
        self.found.push(found);
        let last = self.found.len() - 1;
        &self.found[last].summary
    }

    /// The number of all modes.
    pub fn nmode(&self) -> usize {
        self.found.iter().map(|one| one.summary.modes.len()).sum()
    }

    /// What the summary of a run has of them.
    pub fn summary(&self) -> Vec<FrequencySummary> {
        self.found.iter().map(|one| one.summary.clone()).collect()
    }

    /// `frequencies.csv`.
    pub fn table(&self) -> String {
        let modes = self.found.iter().flat_map(|one| {
            let summary = &one.summary;
            summary.modes.iter().map(move |mode| (summary, mode))
        });
        let row = |(of, mode): (&'_ FrequencySummary, &'_ ModeSummary)| {
            let head = [
                Cell::Real(of.time),
                Cell::Count(mode.mode),
                Cell::Real(mode.frequency),
                Cell::Real(mode.omega),
                Cell::Real(mode.eigenvalue),
                Cell::Real(mode.residual),
                Cell::Count(u64::from(mode.converged)),
            ];
            let vectors = mode.participation.iter().chain(&mode.effective_mass);
            let vectors = vectors.map(|value| Cell::Real(*value));
            head.into_iter().chain(vectors).collect::<Vec<_>>()
        };
        let rows = modes.map(|(of, mode)| {
            let mut cells = vec![Cell::Text(&of.step)];
            cells.extend(row((of, mode)));
            cells
        });
        csv::text(&FREQUENCY_COLUMNS, rows)
    }

    /// What is unusual about them.
    pub fn warnings(&self) -> Diagnostics {
        let mut found = Diagnostics::new();
        for Found {
            asymmetry,
            nunstable,
            summary,
            ..
        } in &self.found
        {
            let step = &summary.step;
            if *nunstable > 0 {
                let text = format!(
                    "step \"{step}\": {nunstable} of the modes grow: the state about which they are is not stable"
                );
                found.push(Diagnostic::warning(&codes::UNSTABLE_STATE, text).note(
                    "their frequencies are written below zero: motions grow as exp(2π |f| t)",
                ));
            }
            if !summary.counted {
                let text = format!(
                    "step \"{step}\": its natural frequencies could not be counted: some may be missing"
                );
                found.push(
                    Diagnostic::warning(&codes::NOT_COUNTED, text)
                        .help("ask for a few more or fewer `modes`"),
                );
            }
            if *asymmetry > ASYMMETRY {
                let text = format!(
                    "step \"{step}\": the stiffness is not symmetric, by {asymmetry:.1e} of its largest entry: its symmetric part counts"
                );
                found.push(Diagnostic::new(Severity::Note, &codes::UNSYMMETRIC, text).note(
                    "pressures that follow surfaces, and some remedies against locking, make it so",
                ));
            }
        }
        found
    }

    /// What a checkpoint has to remember.
    pub fn save(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for one in &self.found {
            let summary = &one.summary;
            let counted = f64::from(u8::from(summary.counted));
            numbers.extend([one.step as f64, one.asymmetry, one.nunstable as f64]);
            numbers.extend([summary.time, counted]);
            numbers.extend(summary.mass);
            numbers.push(summary.modes.len() as f64);
            for mode in &summary.modes {
                let converged = f64::from(u8::from(mode.converged));
                numbers.extend([mode.eigenvalue, mode.residual, converged]);
                numbers.extend(mode.participation);
            }
        }
        numbers
    }

    /// Takes it back.
    pub fn restore(mut numbers: &[f64], steps: &[Step]) -> Self {
        let mut found = Vec::new();
        while let Some((head, rest)) = numbers.split_first_chunk::<OF_STEP>() {
            let [step, asymmetry, nunstable, time, counted, x, y, z, count] = *head;
            let count = (count as usize).min(rest.len() / OF_MODE);
            let (own, others) = rest.split_at(OF_MODE * count);
            numbers = others;
            let (modes, _) = own.as_chunks::<OF_MODE>();
            let mode =
                |([eigenvalue, residual, converged, gx, gy, gz], number): (&[f64; 6], u64)| {
                    ModeSummary {
                        residual: *residual,
                        converged: *converged > 0.0,
                        ..summary(number, *eigenvalue, [*gx, *gy, *gz])
                    }
                };
            let name = steps.get(step as usize).map(|step| step.name.clone());
            found.push(Found {
                step: step as usize,
                asymmetry,
                nunstable: nunstable as usize,
                summary: FrequencySummary {
                    step: name.unwrap_or_default(),
                    time,
                    counted: counted > 0.0,
                    mass: [x, y, z],
                    modes: modes.iter().zip(1..).map(mode).collect(),
                },
            });
        }
        Self { found }
    }
}

fn summary(mode: u64, eigenvalue: f64, participation: [f64; 3]) -> ModeSummary {
    let omega = eigenvalue.abs().sqrt().copysign(eigenvalue);
    ModeSummary {
        mode,
        frequency: omega / TAU,
        omega,
        eigenvalue,
        participation,
        effective_mass: participation.map(|gamma| gamma * gamma),
        ..ModeSummary::default()
    }
}

#[cfg(test)]
mod tests {
    use super::Frequencies;
    use signorini_mechanics::solve::{Increments, NaturalMode, Step, Vibrations};

    #[test]
    fn what_is_saved_comes_back() {
        let mode = |eigenvalue: f64| NaturalMode {
            eigenvalue,
            residual: 1e-9,
            has_converged: eigenvalue > 0.0,
            participation: [eigenvalue, 0.5, 0.25],
            shape: Vec::new(),
        };
        let found = |eigenvalues: &[f64]| Vibrations {
            modes: eigenvalues.iter().map(|value| mode(*value)).collect(),
            is_counted: eigenvalues.len() > 1,
            mass: [3.0, 2.0, 1.0],
            asymmetry: 0.125,
            effort: [9, 2],
        };
        let step = |name: &str| Step {
            name: name.into(),
            duration: 1.0,
            increments: Increments::Fixed(1),
            nonlinear: true,
            scheme: None,
            control: None,
            vibration: None,
            physics: signorini_mechanics::system::Physics::default(),
            prescriptions: Vec::new(),
        };
        let mut all = Frequencies::default();
        all.add(0, "a".into(), 0.0, &found(&[-4.0, 1.0, 9.0]));
        all.add(1, "b".into(), 2.5, &found(&[16.0]));
        let again = Frequencies::restore(&all.save(), &[step("a"), step("b")]);
        assert_eq!(again.summary(), all.summary());
        assert_eq!(again.table(), all.table());
        assert_eq!(again.warnings().plain(), all.warnings().plain());
        assert_eq!(
            (again.nmode(), again.summary()[0].modes[0].omega),
            (4, -2.0)
        );
    }
}
