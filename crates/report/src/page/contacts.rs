//! Section 3: every contact at the end and at its extremes.

use super::cell::{derived, node, number};
use crate::results::{Frame, Results};
use crate::skin::mesh_of;
use crate::text::{short, unit};
use maud::{Markup, html};
use signorini_geometry::mesh::Mesh;
use signorini_io::vtk::Vtu;
use signorini_io::writers::json::ContactSummary;

/// Penetrations below this part of the size of an element are rounding.
const ROUNDING: f64 = 1e-10;

/// The section; `end` is the last frame and `start` the first.
pub fn section(results: &Results, start: Option<&Frame>, end: Option<&Frame>) -> Markup {
    let names = names(results);
    let [start, end] = [start, end].map(|frame| frame.and_then(|frame| frame.contact.as_ref()));
    let start = start.map(|grid| (mesh_of(grid), pairs(grid)));
    let end = end.map(|grid| (grid, pairs(grid)));
    html! {
        section #contacts {
            h2 { "Contact" }
            @if names.is_empty() {
                p { "The results hold no contact." }
            }
            @for (place, name) in names.iter().enumerate() {
                div.contact {
                    h3 { (name) }
                    @let summary = results.summary.as_ref().and_then(|s| s.contacts.get(name));
                    @let sites = Sites::of(place, start.as_ref(), end.as_ref());
                    @if let Some(contact) = summary {
                        (at_end(results, name, contact, &sites))
                    } @else {
                        p { "The run has no summary: only what history.csv holds is shown." }
                    }
                    (extremes(results, name))
                }
            }
        }
    }
}

/// The names of all contacts: of the summary, or of the columns of the history; in the order of the case.
pub fn names(results: &Results) -> Vec<String> {
    let of_history = results.history.columns.iter().filter_map(|column| {
        let name = column.strip_suffix(".pressure_max")?;
        results.history.column(&format!("{name}.area_stick"))?;
        Some(name.to_owned())
    });
    let mut names: Vec<String> = of_history.collect();
    for name in results.summary.iter().flat_map(|s| s.contacts.keys()) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// Where things are in the contact frames.
#[derive(Default)]
struct Sites {
    /// The node of the largest pressure at the end, and its place.
    pressure: Option<(i64, [f64; 3])>,
    /// The node of the least gap at the end.
    gap: Option<(i64, [f64; 3])>,
    /// The mean length of the edges of the facets of the secondary side at the start.
    size: Option<f64>,
}

impl Sites {
    /// Of the frames at the start and at the end, each with the pairs of its points.
    fn of(pair: usize, start: Option<&(Mesh, Vec<i64>)>, end: Option<&(&Vtu, Vec<i64>)>) -> Self {
        let largest = |name: &str, sign: f64| {
            let (grid, pairs) = end?;
            extreme(grid, pairs, pair, name, sign)
        };
        Self {
            pressure: largest("contact_pressure_max", 1.0)
                .filter(|x| x.2 > 0.0)
                .map(|x| (x.0, x.1)),
            gap: largest("contact_gap", -1.0).map(|x| (x.0, x.1)),
            size: start.and_then(|(facets, pairs)| size(facets, pairs, pair)),
        }
    }
}

/// The pair of each point of a contact frame.
fn pairs(grid: &Vtu) -> Vec<i64> {
    let pairs = grid
        .point_field("contact_pair")
        .and_then(|array| array.numbers.to_i64());
    pairs.unwrap_or_else(|| vec![0; grid.points.len()])
}

/// The node of a contact where a field times a sign is largest, its present place, and the value there.
fn extreme(
    grid: &Vtu,
    pairs: &[i64],
    pair: usize,
    name: &str,
    sign: f64,
) -> Option<(i64, [f64; 3], f64)> {
    let values = grid.point_field(name)?.numbers.to_f64();
    let of_pair = values
        .iter()
        .enumerate()
        .filter(|(k, value)| value.is_finite() && pairs.get(*k).is_some_and(|p| *p == pair as i64));
    let (at, value) = of_pair.max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))?;
    let ids = grid.point_field("node_id")?.numbers.to_i64()?;
    let moved = grid
        .point_field("displacement")
        .map(|array| array.numbers.to_f64());
    let moved = moved.unwrap_or_default();
    let point = grid.points.get(at)?;
    let place = std::array::from_fn(|k| point[k] + moved.get(3 * at + k).copied().unwrap_or(0.0));
    Some((*ids.get(at)?, place, *value))
}

/// The mean length of the edges of the facets of a contact, from corner to corner.
fn size(facets: &Mesh, pairs: &[i64], pair: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for block in &facets.blocks {
        for nodes in (0..block.ncell()).map(|cell| block.cell(cell)) {
            let first = *nodes.first()? as usize;
            if pairs.get(first) != Some(&(pair as i64)) {
                continue;
            }
            for [a, b] in block.element.edges() {
                let (a, b) = (*nodes.get(*a)?, *nodes.get(*b)?);
                let (a, b) = (
                    facets.points.get(a as usize)?,
                    facets.points.get(b as usize)?,
                );
                sum += (*a - *b).norm();
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

fn place(point: &[f64; 3]) -> String {
    let [x, y, z] = point.map(|x| short(x, 4));
    format!("at ({x}, {y}, {z})")
}

fn at_end(results: &Results, name: &str, contact: &ContactSummary, sites: &Sites) -> Markup {
    let units = results.units();
    let axisymmetric = results.is_axisymmetric();
    let of = |quantity: &str| unit(quantity, units);
    let name = name.replace('/', "~1");
    let key = |rest: &str| format!("contacts/{name}/{rest}");
    let vector = |title: &str, values: &[f64; 3], quantity: &str| {
        html! {
            tr {
                th { (title) }
                @for (k, value) in values.iter().enumerate() { (number(*value, &key(&format!("{quantity}/{k}")))) }
                td { (of(quantity)) }
            }
        }
    };
    let scalar = |title: &str, value: f64, rest: &str, remark: Markup| {
        html! {
            tr {
                th { (title) }
                (number(value, &key(rest)))
                td colspan="2" { (remark) }
                td { (of(rest)) }
            }
        }
    };
    let penetration = match sites.size {
        Some(size) if contact.gap_min < 0.0 && -contact.gap_min < ROUNDING * size => {
            "no penetration but rounding".to_owned()
        }
        Some(size) if contact.gap_min < 0.0 => format!(
            "{} % of the mean element size {}",
            short(-100.0 * contact.gap_min / size, 3),
            short(size, 3)
        ),
        _ => String::new(),
    };
    html! {
        table.wide {
            caption { "At the end" }
            @if axisymmetric {
                thead { tr { th { "" } th.number { "value" } th colspan="2" { "" } th { "" } } }
            } @else {
                thead { tr { th { "" } th.number { "x" } th.number { "y" } th.number { "z" } th { "" } } }
            }
            tbody {
                @if axisymmetric {
                    (scalar("axial force of the primary on the secondary side, along y", contact.force[1], "force/1", html! {}))
                } @else {
                    (vector("force of the primary on the secondary side", &contact.force, "force"))
                    (vector("moment about the origin", &contact.moment, "moment"))
                }
                (scalar("largest pressure", contact.pressure_max, "pressure_max", html! {
                    @if let Some((id, point)) = &sites.pressure { "node " (node(*id)) " " (place(point)) }
                }))
                (scalar("smallest gap", contact.gap_min, "gap_min", html! {
                    @if let Some((id, _)) = &sites.gap { "node " (node(*id)) " " }
                    (penetration)
                }))
                (scalar("open area", contact.area_open, "area_open", html! {}))
                (scalar("sticking area", contact.area_stick, "area_stick", html! {}))
                (scalar("slipping area", contact.area_slip, "area_slip", html! { "closed area without friction counts here" }))
                (imbalance("|force on secondary + force on primary|", contact.imbalance_force, &key("imbalance_force"), "of the force"))
                @if !axisymmetric {
                    (imbalance("the same of moments", contact.imbalance_moment, &key("imbalance_moment"), "of the moment"))
                }
            }
        }
    }
}

fn imbalance(title: &str, value: f64, key: &str, of: &str) -> Markup {
    html! { tr { th { (title) } (number(value, key)) td colspan="3" { "relative, part " (of) } } }
}

/// The rows of the history where a contact is at its extremes.
fn extremes(results: &Results, name: &str) -> Markup {
    let history = &results.history;
    let times = history.numbers("time");
    let column = |quantity: &str| format!("{name}.{quantity}");
    let of = |quantity: &str| history.numbers(&column(quantity));
    let pick = |values: &[f64], sign: f64| {
        let finite = values.iter().enumerate().filter(|(_, v)| v.is_finite());
        finite
            .max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))
            .map(|(row, v)| (row, *v))
    };
    let forces: &[&str] = match results.is_axisymmetric() {
        true => &["force_y"],
        false => &["force_x", "force_y", "force_z"],
    };
    let forces: Vec<Vec<f64>> = forces.iter().map(|force| of(force)).collect();
    let size = |row: usize| -> f64 {
        let squares = forces.iter().filter_map(|f| f.get(row)).map(|f| f * f);
        squares.sum::<f64>().sqrt()
    };
    let sizes: Vec<f64> = (0..times.len()).map(size).collect();
    let single = [
        ("largest pressure", "pressure_max", 1.0),
        ("smallest gap", "gap_min", -1.0),
        ("largest slip", "slip_max", 1.0),
        ("largest slipping area", "area_slip", 1.0),
        ("largest sticking area", "area_stick", 1.0),
    ];
    let time = |row: usize| {
        let value = times.get(row).copied().unwrap_or(f64::NAN);
        number(value, &format!("history.csv:{row}:time"))
    };
    html! {
        @if !times.is_empty() {
            table.wide {
                caption { "Extremes over all increments" }
                thead { tr { th { "" } th.number { "value" } th { "" } th.number { "time" } } }
                tbody {
                    @if let Some((row, value)) = pick(&sizes, 1.0) {
                        tr { th { "largest force, its size" } (derived(value)) td { (unit("force", results.units())) } (time(row)) }
                    }
                    @for (title, quantity, sign) in single {
                        @if let Some((row, value)) = pick(&of(quantity), sign) {
                            tr {
                                th { (title) }
                                (number(value, &format!("history.csv:{row}:{}", column(quantity))))
                                td { (unit(quantity, results.units())) }
                                (time(row))
                            }
                        }
                    }
                }
            }
        }
    }
}
