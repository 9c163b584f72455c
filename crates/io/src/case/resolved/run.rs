//! Solver, output, checkpoints, expectations.

use super::super::parts::*;
use super::write::{Entries, Value, list, names, tables};

pub(super) fn solver(solver: &Solver) -> Entries {
    let newton = &solver.newton;
    let line_search = match newton.line_search {
        LineSearch::Auto => "auto".into(),
        LineSearch::On => true.into(),
        LineSearch::Off => false.into(),
    };
    let stress = match newton.stress {
        GeometricStress::Auto => "auto",
        GeometricStress::Mixed => "mixed",
        GeometricStress::Current => "current",
    };
    let remedies = solver.on_trouble.iter().map(|remedy| match remedy {
        Remedy::Cut => "cut",
        Remedy::Stabilize => "stabilize",
        Remedy::Points => "points",
    });
    vec![
        (
            "newton",
            Value::Table(vec![
                ("max_iterations", newton.max_iterations.into()),
                ("force_tol", newton.force_tol.into()),
                ("gap_tol", newton.gap_tol.into()),
                ("line_search", line_search),
                ("stress", stress.into()),
            ]),
        ),
        ("linear", solver.linear.word().into()),
        (
            "stabilize",
            match solver.stabilize {
                Stabilize::Auto => "auto".into(),
                Stabilize::Off => false.into(),
            },
        ),
        (
            "free_motions",
            match solver.free_motions {
                FreeMotions::Refuse => "refuse".into(),
                FreeMotions::Hold => "hold".into(),
            },
        ),
        ("on_trouble", list(remedies)),
        (
            "threads",
            solver.threads.map_or("auto".into(), Value::Count),
        ),
    ]
}

pub(super) fn output(output: &Output) -> Entries {
    vec![
        ("format", names(&output.format)),
        ("fields", names(&output.fields)),
        (
            "contact_pressure",
            if output.smooth_pressures {
                "smoothed".into()
            } else {
                "multiplier".into()
            },
        ),
        (
            "every",
            match output.every {
                Every::Increments(count) => count.into(),
                Every::Time(time) => Value::Table(vec![("time", time.into())]),
            },
        ),
        ("names", "signorini".into()),
        ("history", tables(&output.history, history)),
    ]
}

fn history(one: &History) -> Entries {
    vec![
        ("name", (&one.name.value).into()),
        ("quantity", names(&one.quantities)),
        match &one.source {
            HistorySource::Contact(name) => ("contact", (&name.value).into()),
            HistorySource::Reference(name) => ("reference", (&name.value).into()),
            HistorySource::Node(node) => ("node", node.value.into()),
            HistorySource::Set(name) => ("set", (&name.value).into()),
        },
    ]
}

pub(super) fn checkpoint(checkpoint: &Checkpoint) -> Entries {
    let mut every: Entries = Vec::new();
    every.extend(
        checkpoint
            .increments
            .map(|count| ("increments", count.into())),
    );
    every.extend(
        checkpoint
            .wall
            .map(|wall| ("wall", Value::Text(format!("{wall} s")))),
    );
    let mut entries: Entries = Vec::new();
    if !every.is_empty() {
        entries.push(("every", Value::Table(every)));
    }
    entries.push(("keep", checkpoint.keep.into()));
    entries
}

pub(super) fn cycle(one: &Cycle) -> Entries {
    let steps = list(one.steps.iter().map(|name| &name.value));
    let mut entries = vec![("steps", steps), ("count", one.count.into())];
    if let Some(jump) = one.jump {
        let mut table = vec![("tol", jump.tol.into()), ("first", jump.first.into())];
        table.extend(jump.max_wear.map(|depth| ("max_wear", depth.into())));
        entries.push(("jump", Value::Table(table)));
    }
    entries
}

pub(super) fn expectation(one: &Expectation) -> Entries {
    let mut entries = vec![("what", (&one.what.value).into())];
    match one.at {
        Moment::End => {}
        Moment::Row(row) => entries.push(("at", row.into())),
        Moment::Time(time) => entries.push(("time", time.into())),
    }
    entries.push(("value", one.value.into()));
    entries.push((
        "tol",
        Value::Table(vec![match one.tolerance {
            Tolerance::Relative(rel) => ("rel", rel.into()),
            Tolerance::Absolute(abs) => ("abs", abs.into()),
        }]),
    ));
    entries
}
