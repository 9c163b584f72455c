//! What the view of a page shows: the surface, its frames and fields, within a budget of bytes.
//!
//! Above the budget the numbers get two bytes in place of four, then frames are left out, then fields, then facets. What was
//! left out is said in [`View::notes`].

use crate::error::ReportError;
use crate::fields::{self, Field, MAIN, Sites};
use crate::pack::Chunk;
use crate::results::{Frame, Results};
use crate::skin::Skin;
use crate::text::{grouped, plural, unit};
use serde_json::{Value, json};
use signorini_geometry::proximity::Aabb;
use signorini_geometry::tensor::Vec3;
use signorini_io::fs::Fs;
use signorini_io::vtk::Vtu;
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};

/// More frames than these are not shown.
const FRAMES_MOST: usize = 80;

/// More triangles than these are slow in a browser.
const TRIANGLES_MOST: usize = 260_000;

/// Bytes of base64 per byte of numbers, at worst: of reals with four bytes, and in steps of two.
const RATIO_F32: f64 = 1.25;
const RATIO_U16: f64 = 1.1;

/// The view of a page.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// What the script needs to know.
    pub description: Value,
    /// Packed numbers, by name.
    pub chunks: Vec<(String, Chunk)>,
    /// What was left out, in sentences.
    pub notes: Vec<String>,
    /// The address of a picture that is shown until the script draws the view.
    pub still: Option<String>,
}

impl View {
    /// The characters of all numbers.
    #[must_use]
    pub fn size(&self) -> usize {
        self.chunks.iter().map(|(_, chunk)| chunk.text.len()).sum()
    }
}

/// What is shown.
#[derive(Clone, Debug)]
struct Plan {
    frames: Vec<usize>,
    fields: Vec<Field>,
    steps: bool,
    triangles: usize,
}

impl Plan {
    /// The characters that the numbers take at worst.
    fn size(&self, nnode: usize) -> f64 {
        let ncomponent: usize = self.fields.iter().map(|field| field.components.len()).sum();
        let bytes = if self.steps {
            2.0 * RATIO_U16
        } else {
            4.0 * RATIO_F32
        };
        (nnode * ncomponent * self.frames.len()) as f64 * bytes
    }

    /// Shows less; false where nothing but the facets can go.
    fn shrink(&mut self) -> bool {
        if !self.steps {
            self.steps = true;
        } else if self.frames.len() > 12 {
            self.frames = thinned(&self.frames, self.frames.len() * 2 / 3);
        } else if self.fields.len() > MAIN.len() {
            self.fields
                .retain(|field| MAIN.contains(&field.name.as_str()));
        } else if self.frames.len() > 3 {
            self.frames = thinned(&self.frames, self.frames.len() * 2 / 3);
        } else {
            return false;
        }
        true
    }
}

/// So many of the numbers, at equal distances, with the first and the last.
fn thinned(numbers: &[usize], count: usize) -> Vec<usize> {
    let count = count.clamp(2, numbers.len().max(2));
    let last = numbers.len().saturating_sub(1);
    let place = |k: usize| (k * last + (count - 1) / 2) / (count - 1);
    let mut chosen: Vec<usize> = (0..count)
        .filter_map(|k| numbers.get(place(k)).copied())
        .collect();
    chosen.dedup();
    chosen
}

/// The names of the parts: their numbers, and the contacts whose secondary sides they carry. The pairs of contact frames are
/// places in `contacts`.
fn part_names(skin: &Skin, frame: Option<&Vtu>, contacts: &[String]) -> Vec<String> {
    let mut part_of = HashMap::new();
    for (triangle, &part) in skin.triangles.iter().zip(&skin.parts) {
        let labels = triangle
            .iter()
            .filter_map(|&node| skin.labels.get(node as usize));
        part_of.extend(labels.map(|&label| (label, part as usize)));
    }
    let numbers = |name: &str| frame?.point_field(name)?.numbers.to_i64();
    let ids = numbers("node_id").unwrap_or_default();
    let pairs = numbers("contact_pair").unwrap_or_default();
    let mut sides = vec![BTreeSet::new(); skin.npart];
    for (id, &pair) in ids.iter().zip(&pairs) {
        let contact = usize::try_from(pair)
            .ok()
            .and_then(|pair| contacts.get(pair));
        let side = part_of.get(id).and_then(|&part| sides.get_mut(part));
        if let (Some(side), Some(contact)) = (side, contact) {
            side.insert(contact.as_str());
        }
    }
    let name = |(part, sides): (usize, &BTreeSet<&str>)| {
        let sides: Vec<&str> = sides.iter().copied().collect();
        match sides.is_empty() {
            true => format!("part {}", part + 1),
            false => format!("part {}, secondary side of {}", part + 1, sides.join(", ")),
        }
    };
    sides.iter().enumerate().map(name).collect()
}

/// The view of all frames of a run, of which `end` is the last one; nothing where no frame can be drawn. `contacts` are the
/// names of all contacts in the order of the case.
///
/// # Errors
/// A frame that cannot be read.
pub fn of_results(
    fs: &dyn Fs,
    results: &Results,
    end: Frame,
    contacts: &[String],
    budget: usize,
) -> Result<Option<View>, ReportError> {
    let whole = Skin::of(&end.volume);
    if whole.is_empty() {
        return Ok(None);
    }
    let nframe = results.frames.len();
    let all: Vec<usize> = (0..nframe).collect();
    let mut fields = fields::fields(&end);
    let parts = part_names(&whole, end.contact.as_ref(), contacts);
    drop(end);
    fields.sort_by_key(|field| {
        MAIN.iter()
            .position(|name| *name == field.name)
            .unwrap_or(MAIN.len())
    });
    let mut plan = Plan {
        frames: thinned(&all, FRAMES_MOST),
        fields,
        steps: false,
        triangles: whole.triangles.len().min(TRIANGLES_MOST),
    };
    let nfield = plan.fields.len();
    let (skin, mut view) = loop {
        let skin = coarser(&whole, plan.triangles);
        // the surface itself
        let rest = budget as f64 - (skin.points.len() * 14 + skin.triangles.len() * 5) as f64;
        while plan.size(skin.nodes.len()) > rest && plan.shrink() {}
        let view = (plan.size(skin.nodes.len()) <= rest)
            .then(|| packed(fs, results, &skin, &plan, &parts))
            .transpose()?;
        match view {
            Some(view) if view.size() <= budget => break (skin, view),
            Some(_) if plan.shrink() => {}
            _ if plan.triangles > 1_000 => plan.triangles = plan.triangles * 3 / 5,
            Some(view) => break (skin, view),
            None => return Ok(None),
        }
    };
    if plan.frames.len() < nframe {
        view.notes.push(format!(
            "The view shows {} of {}; ParaView shows all of results.pvd.",
            grouped(plan.frames.len()),
            plural(nframe, "frame")
        ));
    }
    if plan.fields.len() < nfield {
        view.notes.push(format!(
            "The view shows {} of {}; all are in the frames.",
            plan.fields.len(),
            plural(nfield, "field")
        ));
    }
    if skin.triangles.len() < whole.triangles.len() {
        view.notes.push(format!(
            "The view draws {} triangles for the {} of the surface: nodes were left out, the others have their own values.",
            grouped(skin.triangles.len()),
            grouped(whole.triangles.len())
        ));
    }
    if plan.steps {
        view.notes.push(
            "Values in the view are rounded to 1/65534 of the range of their field; tables and plots are not.".into(),
        );
    }
    Ok(Some(view))
}

/// The view of one grid with fields over its nodes and its cells, such as the one that `check` writes; nothing where it has no
/// cells.
#[must_use]
pub fn of_grid(grid: &Vtu, units: &str) -> Option<View> {
    let skin = Skin::of(grid);
    if skin.is_empty() {
        return None;
    }
    let frame = Frame {
        time: 0.0,
        volume: grid.clone(),
        contact: None,
    };
    let mut view = View::default();
    let mut described = Vec::new();
    let sites = Sites::of(&skin, None);
    for field in fields::fields(&frame) {
        let values = fields::values(&field, &skin, &frame, &sites);
        described.push(describe(&field, std::slice::from_ref(&values), units, None));
        let name = format!("field-{}", field.name);
        view.chunks.push((
            name,
            Chunk::f32(&by_component(&values, field.components.len())),
        ));
    }
    for array in grid.cell_data.iter().filter(|array| array.ncomponent == 1) {
        let numbers = array.numbers.to_f64();
        let value = |&cell: &u32| numbers.get(cell as usize).copied().unwrap_or(f64::NAN);
        let values: Vec<f64> = skin.cells.iter().map(value).collect();
        if array.name == "element_id" || fields::range(&values).is_none() {
            continue;
        }
        let field = Field {
            name: array.name.clone(),
            components: vec![String::new()],
            of_contact: false,
        };
        let mut described_field = describe(&field, std::slice::from_ref(&values), units, None);
        described_field["cells"] = json!(true);
        described.push(described_field);
        view.chunks
            .push((format!("field-{}", array.name), Chunk::f32(&values)));
    }
    let parts = part_names(&skin, None, &[]);
    surface(&mut view, &skin, &[(0, 0.0)], described, &parts);
    Some(view)
}

/// The values component by component.
fn by_component(values: &[f64], ncomponent: usize) -> Vec<f64> {
    let component = |k: usize| values.iter().skip(k).step_by(ncomponent.max(1)).copied();
    (0..ncomponent).flat_map(component).collect()
}

/// What the script needs to know about a field. `frames` holds its values node by node, frame by frame.
fn describe(field: &Field, frames: &[Vec<f64>], units: &str, steps: Option<[f64; 2]>) -> Value {
    let ranges = |component: Option<usize>| -> Option<[f64; 2]> {
        let each = frames
            .iter()
            .filter_map(|values| fields::range(&fields::scalar(field, component, values)));
        fields::joined(each)
    };
    let whole = match field.components.len() {
        1 => ranges(Some(0)),
        _ if field.is_vector() => ranges(None),
        _ => None,
    };
    let components: Vec<Option<[f64; 2]>> = match field.components.len() {
        1 => Vec::new(),
        n => (0..n).map(|k| ranges(Some(k))).collect(),
    };
    json!({
        "name": field.name,
        "components": field.components,
        "contact": field.of_contact,
        "vector": field.is_vector(),
        "unit": unit(&field.name, units),
        "range": whole,
        "ranges": components,
        "steps": steps,
        "cells": false,
    })
}

/// Packs the surface with the planned frames and fields.
fn packed(
    fs: &dyn Fs,
    results: &Results,
    skin: &Skin,
    plan: &Plan,
    parts: &[String],
) -> Result<View, ReportError> {
    let mut values: Vec<Vec<Vec<f64>>> = vec![Vec::new(); plan.fields.len()];
    let mut shown = Vec::new();
    let mut view = View::default();
    let most = skin.nodes.iter().copied().max().unwrap_or(0) as usize;
    for &number in &plan.frames {
        let frame = results.frame(fs, number)?;
        if frame.volume.points.len() <= most {
            view.notes.push(format!(
                "Frame {number} is of another mesh and is left out."
            ));
            continue;
        }
        let sites = Sites::of(skin, frame.contact.as_ref());
        for (field, values) in plan.fields.iter().zip(&mut values) {
            values.push(fields::values(field, skin, &frame, &sites));
        }
        shown.push((number, frame.time));
    }
    let mut described = Vec::new();
    for (field, frames) in plan.fields.iter().zip(&values) {
        let ends = frames.iter().filter_map(|values| fields::range(values));
        let Some(ends) = fields::joined(ends) else {
            continue;
        };
        let ncomponent = field.components.len();
        let all: Vec<f64> = frames
            .iter()
            .flat_map(|values| by_component(values, ncomponent))
            .collect();
        let chunk = match plan.steps {
            true => Chunk::u16(&all, ends),
            false => Chunk::f32(&all),
        };
        described.push(describe(
            field,
            frames,
            results.units(),
            plan.steps.then_some(ends),
        ));
        view.chunks.push((format!("field-{}", field.name), chunk));
    }
    surface(&mut view, skin, &shown, described, parts);
    Ok(view)
}

/// Adds the surface and the description.
fn surface(
    view: &mut View,
    skin: &Skin,
    frames: &[(usize, f64)],
    described: Vec<Value>,
    parts: &[String],
) {
    let points: Vec<f64> = skin.points.iter().flatten().copied().collect();
    let flat = |pairs: &[[u32; 2]]| Chunk::u32(pairs.iter().flatten().copied());
    let edges: &[[u32; 2]] = if skin.edges.len() > 150_000 {
        &[]
    } else {
        &skin.edges
    };
    let label = |label: &i64| u32::try_from(*label).unwrap_or(0);
    let chunks = [
        ("points", Chunk::f32(&by_component(&points, 3))),
        ("labels", Chunk::u32(skin.labels.iter().map(label))),
        (
            "triangles",
            Chunk::u32(skin.triangles.iter().flatten().copied()),
        ),
        ("parts", Chunk::u32(skin.parts.iter().copied())),
        ("edges", flat(edges)),
        ("lines", flat(&skin.lines)),
    ];
    view.chunks
        .extend(chunks.map(|(name, chunk)| (name.to_owned(), chunk)));
    view.description = json!({
        "nnode": skin.nodes.len(),
        "ntriangle": skin.triangles.len(),
        "parts": parts,
        "nedge": edges.len(),
        "plane": skin.is_plane,
        "frames": frames.iter().map(|(number, time)| json!({"number": number, "time": time})).collect::<Vec<Value>>(),
        "fields": described,
    });
}

/// The surface with at most so many triangles: nodes that are close to each other become one of them.
fn coarser(skin: &Skin, most: usize) -> Cow<'_, Skin> {
    if skin.triangles.len() <= most {
        return Cow::Borrowed(skin);
    }
    let bounds = Aabb::around(skin.points.iter().map(|&point| Vec3::from(point)));
    let (low, extent) = (bounds.min.to_array(), bounds.extent());
    let longest = extent.x.max(extent.y).max(extent.z);
    let mut ncell = 2048.0;
    loop {
        let coarse = clustered(skin, low, longest.max(f64::MIN_POSITIVE) / ncell);
        if coarse.triangles.len() <= most || ncell < 2.0 {
            return Cow::Owned(coarse);
        }
        ncell *= 0.7;
    }
}

/// Takes one node for all those of a part in a cube of this side.
fn clustered(skin: &Skin, low: [f64; 3], side: f64) -> Skin {
    let mut part_of = vec![0; skin.nodes.len()];
    for (triangle, part) in skin.triangles.iter().zip(&skin.parts) {
        for node in triangle {
            if let Some(place) = part_of.get_mut(*node as usize) {
                *place = *part;
            }
        }
    }
    let mut cells: HashMap<([i64; 3], u32), u32> = HashMap::new();
    let mut new_number = Vec::with_capacity(skin.nodes.len());
    let mut coarse = Skin {
        npart: skin.npart,
        is_plane: skin.is_plane,
        nface: skin.nface,
        ..Skin::default()
    };
    let nodes = skin
        .nodes
        .iter()
        .zip(&skin.points)
        .zip(skin.labels.iter().zip(&part_of));
    for ((node, point), (label, part)) in nodes {
        let cell: [i64; 3] = std::array::from_fn(|k| ((point[k] - low[k]) / side) as i64);
        let number = *cells.entry((cell, *part)).or_insert_with(|| {
            coarse.nodes.push(*node);
            coarse.points.push(*point);
            coarse.labels.push(*label);
            (coarse.nodes.len() - 1) as u32
        });
        new_number.push(number);
    }
    let renamed = |node: u32| new_number.get(node as usize).copied().unwrap_or(0);
    for ((triangle, part), cell) in skin.triangles.iter().zip(&skin.parts).zip(&skin.cells) {
        let [a, b, c] = triangle.map(renamed);
        if a != b && b != c && c != a {
            coarse.triangles.push([a, b, c]);
            coarse.parts.push(*part);
            coarse.cells.push(*cell);
        }
    }
    coarse.lines = skin.lines.iter().map(|line| line.map(renamed)).collect();
    coarse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_numbers_keep_the_first_and_the_last() {
        let all: Vec<usize> = (0..101).collect();
        for count in 2..=101 {
            let some = thinned(&all, count);
            assert_eq!((some.first(), some.last()), (Some(&0), Some(&100)));
            assert_eq!(some.len(), count);
        }
        assert_eq!(thinned(&[4], 3), [4]);
    }

    #[test]
    fn a_coarser_surface_has_no_triangle_without_area_and_keeps_parts_apart() {
        let n = 40_u32;
        let mut skin = Skin {
            npart: 2,
            ..Skin::default()
        };
        for part in 0..2_u32 {
            let start = skin.nodes.len() as u32;
            for k in 0..(n + 1) * (n + 1) {
                skin.nodes.push(start + k);
                skin.labels.push(i64::from(start + k));
                skin.points
                    .push([f64::from(k % (n + 1)), f64::from(k / (n + 1)), 0.0]);
            }
            for k in (0..n * n).map(|k| start + k % n + (k / n) * (n + 1)) {
                for triangle in [[k, k + 1, k + n + 2], [k, k + n + 2, k + n + 1]] {
                    skin.triangles.push(triangle);
                    skin.parts.push(part);
                    skin.cells.push(0);
                }
            }
        }
        let coarse = coarser(&skin, 1_000);
        assert!((100..=1_000).contains(&coarse.triangles.len()));
        for (triangle, part) in coarse.triangles.iter().zip(&coarse.parts) {
            for node in triangle {
                let whole = coarse.nodes[*node as usize];
                assert_eq!(whole / ((n + 1) * (n + 1)), *part);
            }
        }
    }
}
