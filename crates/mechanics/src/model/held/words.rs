//! Rigid motions in words.

use super::{Motion, NCOMPONENT};
use crate::system::Idealisation;
use signorini_geometry::tensor::Vec3;

/// Components below this part of the largest are round-off.
const ROUND_OFF: f64 = 1e-5;

/// What a unit can do, as in `slide along x and turn about the axis along z through (0, 0, 1)`; none where nothing.
///
/// The motions are those about `centre`, rotations times `length`.
pub(super) fn describe(
    space: Idealisation,
    centre: Vec3,
    length: f64,
    motions: &[Motion],
) -> Option<String> {
    let (turns, slides) = reduced(motions);
    let mut clauses = Vec::new();
    clauses.extend(sliding(&slides, space.ndim()));
    clauses.extend(turning(&turns, &slides, space.ndim(), centre, length));
    (!clauses.is_empty()).then(|| clauses.join(" and to "))
}

/// A screw motion: rotation times length, and translation of the centre.
#[derive(Clone, Copy)]
struct Screw {
    turn: Vec3,
    slide: Vec3,
}

/// A basis with as many zeros as can be: rotations with a translation each, then pure translations.
fn reduced(motions: &[Motion]) -> (Vec<Screw>, Vec<Vec3>) {
    const ORDER: [usize; NCOMPONENT] = [3, 4, 5, 0, 1, 2];
    let largest = |row: &Motion| row.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut rows: Vec<Motion> = motions.to_vec();
    rows.retain(|row| largest(row) > ROUND_OFF);
    let mut done = 0;
    let mut nturn = 0;
    for (k, &column) in ORDER.iter().enumerate() {
        let rest = rows.iter().enumerate().skip(done);
        let pivot = rest.max_by(|a, b| a.1[column].abs().total_cmp(&b.1[column].abs()));
        let Some((at, row)) = pivot.filter(|(_, row)| row[column].abs() > ROUND_OFF) else {
            continue;
        };
        let row = row.map(|v| v / row[column]);
        rows.swap(done, at);
        for (i, other) in rows.iter_mut().enumerate() {
            let factor = other[column];
            if i != done {
                other
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(a, b)| *a -= factor * b);
            }
        }
        rows[done] = row;
        done += 1;
        nturn += usize::from(k < 3);
    }
    rows.truncate(done);
    let vector = |row: &Motion, at: usize| Vec3::new(row[at], row[at + 1], row[at + 2]);
    let turns = rows.iter().take(nturn).map(|row| Screw {
        turn: vector(row, 3),
        slide: vector(row, 0),
    });
    let slides = rows.iter().skip(nturn).map(|row| vector(row, 0));
    (turns.collect(), slides.collect())
}

fn sliding(slides: &[Vec3], ndim: usize) -> Option<String> {
    match slides {
        [] => None,
        all if all.len() == ndim => Some("slide in every direction".to_owned()),
        [a, b] if axis_of(*a).is_none() || axis_of(*b).is_none() => {
            Some(format!("slide across {}", direction(a.cross(*b))))
        }
        _ => {
            let along: Vec<String> = slides.iter().map(|&s| direction(s)).collect();
            Some(format!("slide along {}", along.join(" and ")))
        }
    }
}

fn turning(
    turns: &[Screw],
    slides: &[Vec3],
    ndim: usize,
    centre: Vec3,
    length: f64,
) -> Option<String> {
    if ndim == 2 && !turns.is_empty() && slides.len() == 2 {
        return Some("turn".to_owned());
    }
    if let [x, y, z] = turns {
        if slides.len() == 3 {
            return Some("turn about every axis".to_owned());
        }
        // a common point c + d of the axes: t = d × θ for each
        let d = Vec3::new(y.slide.z, -x.slide.z, x.slide.y);
        let passes = |s: &Screw| (d.cross(s.turn) - s.slide).max_abs() < ROUND_OFF;
        if slides.is_empty() && [x, y, z].into_iter().all(passes) {
            let at = place(centre + d * length, length, ndim);
            return Some(format!("turn about {at}"));
        }
    }
    match turns {
        [] => None,
        // the place of an axis means nothing to who can slide across it
        _ if slides.len() >= 2 => {
            let axes: Vec<String> = turns.iter().map(|s| direction(s.turn)).collect();
            Some(format!("turn about {}", axes.join(" and ")))
        }
        _ => {
            let turns = turns.iter();
            let clauses: Vec<String> = turns
                .map(|screw| about(screw, slides, ndim, centre, length))
                .collect();
            Some(clauses.join(" and to "))
        }
    }
}

fn about(screw: &Screw, slides: &[Vec3], ndim: usize, centre: Vec3, length: f64) -> String {
    let axis = screw.turn;
    let along = slides.first().and_then(|s| s.normalized());
    let slide = along.map_or(screw.slide, |a| screw.slide - a * screw.slide.dot(a));
    // t = θ × (c − p) gives the point p = c + θ × t / θ²
    let point = centre + axis.cross(slide) * (length / axis.norm_squared());
    let through = place(point, length, ndim);
    if ndim == 2 {
        return format!("turn about {through}");
    }
    let verb = if slide.dot(axis).abs() > ROUND_OFF * axis.norm_squared() {
        "screw along"
    } else {
        "turn about"
    };
    format!(
        "{verb} the axis along {} through {through}",
        direction(axis)
    )
}

/// The axis of coordinates that a direction lies on.
fn axis_of(v: Vec3) -> Option<usize> {
    let size = v.max_abs();
    let mut large = (0..3).filter(|&i| v[i].abs() > ROUND_OFF * size);
    let first = large.next()?;
    large.next().is_none().then_some(first)
}

fn direction(v: Vec3) -> String {
    match axis_of(v) {
        Some(axis) => ["x", "y", "z"][axis.min(2)].to_owned(),
        None => {
            let unit = v.normalized().unwrap_or(v);
            place(unit, 1.0, 3)
        }
    }
}

/// A point with as many digits as make sense for something of this size.
fn place(x: Vec3, length: f64, ndim: usize) -> String {
    let digits = (3.0 - length.log10().floor()).clamp(0.0, 12.0) as usize;
    let number = |v: f64| {
        let text = format!("{v:.digits$}");
        let text = match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.'),
            false => &text,
        };
        if text == "-0" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    };
    let numbers: Vec<String> = x.to_array().iter().take(ndim).map(|&v| number(v)).collect();
    format!("({})", numbers.join(", "))
}
