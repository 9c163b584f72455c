//! A frame as a PNG picture, drawn here: no browser, no graphics card, no window.
//!
//! ```text
//! frame ──skin──▶ triangles ──camera──▶ pixels ──raster──▶ means ──letters──▶ PNG
//!           └──fields──▶ a number per node ──colour map──┘
//! ```
//!
//! Faces are shaded flat, colours vary linearly within triangles. What has no value is grey. Fields of contact are drawn by
//! themselves in space, seen from outside the secondary side, and as thick lines on the model in the plane.

mod camera;
mod letters;
mod raster;

use crate::colour;
use crate::error::ReportError;
use crate::fields::{self, DISPLACEMENT, Field, MAIN, STATUS, Sites};
use crate::results::{Frame, Results};
use crate::skin::Skin;
use crate::text::{short, unit};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use camera::Camera;
use letters::{Sheet, Side};
use raster::{Corner, FINE, Raster};
use signorini_geometry::tensor::Vec3;
use signorini_io::fs::Fs;
use std::path::Path;

/// The least and the greatest side of a picture, in pixels.
const SIZES: [u32; 2] = [160, 4000];

/// Where the eye is in space, unless it is given: in front, on the left, above.
const ISOMETRIC: Vec3 = Vec3::new(-0.8, -1.2, 0.8);

/// Edges closer than this in the mean, in pixels, would blacken the picture.
const EDGE_LEAST: f64 = 3.5;

/// The colours of text and of edges.
const INK: [u8; 3] = [32, 36, 42];
const GREY_INK: [u8; 3] = [96, 102, 112];

/// What a picture shows.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    /// A field, or a component of one: `von_mises`, `stress.XX`, `displacement.z`. Nothing: `von_mises` where there is one,
    /// else the size of the displacement.
    pub field: Option<String>,
    /// The number of the frame; nothing: the last one.
    pub frame: Option<usize>,
    /// Pixels from left to right, 160 to 4000.
    pub width: u32,
    /// Pixels from top to bottom, 160 to 4000.
    pub height: u32,
    /// The factor on displacements.
    pub warp: f64,
    /// The direction from the model to the eye; nothing: from +z in the plane, oblique in space.
    pub view: Option<[f64; 3]>,
    /// Whether edges of elements are drawn; nothing: where they are far enough from each other.
    pub edges: Option<bool>,
    /// The ends of the colour map; nothing: the least and the greatest value of the frame.
    pub range: Option<[f64; 2]>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            field: None,
            frame: None,
            width: 1200,
            height: 800,
            warp: 1.0,
            view: None,
            edges: None,
            range: None,
        }
    }
}

/// A PNG picture of a frame of a folder of results.
///
/// # Errors
/// A folder that holds no results, no frames, no such frame or field; a frame that cannot be read; a size out of range.
///
/// # Limits
/// One picture reads one frame and takes nine times its pixels as memory, at 7 bytes each.
pub fn picture(
    fs: &dyn Fs,
    folder: &Path,
    options: &PictureOptions,
) -> Result<Vec<u8>, ReportError> {
    let results = Results::read(fs, folder)?;
    let number = options
        .frame
        .unwrap_or(results.frames.len().saturating_sub(1));
    let frame = results.frame(fs, number)?;
    let title = results.title();
    let scene = Scene::new(&frame, &title, results.units());
    if scene.skin.is_empty() {
        return Err(ReportError::NoFrames {
            folder: folder.to_path_buf(),
            why: ": the frame holds no cells".into(),
        });
    }
    scene.draw(options)
}

/// A picture of a frame as large as the view of a page, as the address of an image that holds it; nothing where it cannot be
/// drawn.
pub(crate) fn still(frame: &Frame, title: &str, units: &str) -> Option<String> {
    let scene = Scene::new(frame, title, units);
    let options = PictureOptions {
        width: 880,
        height: 560,
        ..PictureOptions::default()
    };
    let picture = match scene.skin.is_empty() {
        true => None,
        false => scene.draw(&options).ok(),
    };
    picture.map(|png| format!("data:image/png;base64,{}", STANDARD.encode(png)))
}

/// The names by which [`PictureOptions::field`] can ask for fields of a frame, in their order.
#[must_use]
pub fn names(fields: &[Field]) -> Vec<String> {
    let mut names = Vec::new();
    for field in fields {
        if field.components.len() == 1 || field.is_vector() {
            names.push(field.name.clone());
        }
        let components = field.components.iter().filter(|c| !c.is_empty());
        names.extend(components.map(|component| format!("{}.{component}", field.name)));
    }
    names
}

/// The fields that are drawn where nothing else is asked for, as far as a frame of the folder has them.
///
/// # Errors
/// A folder that holds no results, no frames or no such frame; a frame that cannot be read.
pub fn main_fields(
    fs: &dyn Fs,
    folder: &Path,
    frame: Option<usize>,
) -> Result<Vec<String>, ReportError> {
    let results = Results::read(fs, folder)?;
    let number = frame.unwrap_or(results.frames.len().saturating_sub(1));
    let names = names(&fields::fields(&results.frame(fs, number)?));
    let main = MAIN.iter().map(ToString::to_string);
    Ok(main.filter(|name| names.contains(name)).collect())
}

/// A frame that is drawn.
pub(crate) struct Scene<'a> {
    frame: &'a Frame,
    pub skin: Skin,
    sites: Sites,
    fields: Vec<Field>,
    title: &'a str,
    units: &'a str,
}

/// What the colours are taken from.
struct Chosen<'a> {
    field: &'a Field,
    name: String,
    values: Vec<f64>,
    range: [f64; 2],
}

impl Chosen<'_> {
    fn is_status(&self) -> bool {
        self.field.name == STATUS
    }

    fn colour(&self, value: f64) -> [f64; 3] {
        if !value.is_finite() {
            return colour::NONE.map(f64::from);
        }
        if self.is_status() {
            return colour::status(value);
        }
        let [low, high] = self.range;
        match high > low {
            true => colour::viridis((value - low) / (high - low)),
            false => colour::viridis(0.0),
        }
    }
}

/// Where the parts of the picture are, in pixels.
struct Layout {
    model_x: [f64; 2],
    model_y: [f64; 2],
    bar_x: i64,
    bar_y: [i64; 2],
    text: f32,
}

impl Layout {
    fn of(options: &PictureOptions) -> Self {
        let (width, height) = (f64::from(options.width), f64::from(options.height));
        let text = (height / 36.0).clamp(11.0, 40.0).min(width / 28.0).max(8.0);
        let (head, bar) = (3.6 * text, 6.2 * text);
        Self {
            model_x: [1.2 * text, width - bar - 1.5 * text],
            model_y: [head + 0.6 * text, height - 2.0 * text],
            bar_x: (width - bar) as i64,
            bar_y: [(head + 1.5 * text) as i64, (height - 3.0 * text) as i64],
            text: text as f32,
        }
    }
}

impl<'a> Scene<'a> {
    /// Prepares a frame.
    pub fn new(frame: &'a Frame, title: &'a str, units: &'a str) -> Self {
        let skin = Skin::of(&frame.volume);
        let sites = Sites::of(&skin, frame.contact.as_ref());
        Self {
            fields: fields::fields(frame),
            frame,
            skin,
            sites,
            title,
            units,
        }
    }

    /// The picture.
    pub fn draw(&self, options: &PictureOptions) -> Result<Vec<u8>, ReportError> {
        let [least, most] = SIZES;
        let fits = |side: u32| (least..=most).contains(&side);
        if !fits(options.width) || !fits(options.height) {
            return Err(ReportError::Size {
                width: options.width,
                height: options.height,
                least,
                most,
            });
        }
        let chosen = self.choose(options)?;
        let layout = Layout::of(options);
        let mut raster = Raster::new(options.width as usize, options.height as usize, [255; 3]);
        let camera = self.model(&mut raster, &layout, &chosen, options);
        let size = [options.width as usize, options.height as usize];
        let mut sheet = Sheet::new(size[0], size[1], raster.picture())?;
        self.head(&mut sheet, &layout, &chosen, options.warp);
        bar(
            &mut sheet,
            &layout,
            &chosen,
            &unit(&chosen.name, self.units),
        );
        axes(&mut sheet, &layout, &camera);
        encode(&sheet)
    }

    /// The field that is asked for.
    fn choose(&self, options: &PictureOptions) -> Result<Chosen<'_>, ReportError> {
        let has = |name: &str| self.fields.iter().any(|field| field.name == name);
        let default = match has("von_mises") {
            true => "von_mises",
            false => DISPLACEMENT,
        };
        let name = options.field.as_deref().unwrap_or(default);
        let find = |name: &str| self.fields.iter().find(|field| field.name == name);
        let whole = find(name).map(|field| (field, None));
        let split = name.rsplit_once('.').and_then(|(name, component)| {
            let field = find(name)?;
            let place = field.components.iter().position(|c| c == component)?;
            Some((field, Some(place)))
        });
        let Some((field, component)) = whole.or(split) else {
            return Err(ReportError::NoField {
                wanted: name.to_owned(),
                known: names(&self.fields).join(", "),
            });
        };
        let values = fields::values(field, &self.skin, self.frame, &self.sites);
        let values = fields::scalar(field, component, &values);
        let range = options.range.or(fields::range(&values));
        Ok(Chosen {
            field,
            name: name.to_owned(),
            values,
            range: range.unwrap_or([0.0, 0.0]),
        })
    }

    /// Draws the model and says how it is seen.
    fn model(
        &self,
        raster: &mut Raster,
        layout: &Layout,
        chosen: &Chosen<'_>,
        options: &PictureOptions,
    ) -> Camera {
        let moved = fields::displacements(&self.skin, self.frame);
        let places = self.skin.points.iter().zip(&moved);
        let points: Vec<Vec3> = places
            .map(|(&x, &u)| Vec3::from(x) + Vec3::from(u) * options.warp)
            .collect();
        let value = |node: u32| {
            chosen
                .values
                .get(node as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        let point = |node: u32| points.get(node as usize).copied().unwrap_or_default();
        let has_value = |nodes: &[u32]| nodes.iter().all(|&node| value(node).is_finite());
        // a contact in space is hidden between the bodies: it is drawn alone
        let alone = chosen.field.of_contact && !self.skin.is_plane;
        let drawn: Vec<&[u32; 3]> = (self.skin.triangles.iter())
            .filter(|triangle| !alone || has_value(*triangle))
            .collect();
        let alone = alone && !drawn.is_empty();
        let seen: Vec<Vec3> = match alone {
            true => drawn
                .iter()
                .flat_map(|t| t.iter().map(|&n| point(n)))
                .collect(),
            false => points.clone(),
        };
        let towards = options.view.map(Vec3::from).unwrap_or_else(|| {
            if self.skin.is_plane {
                return Vec3::unit(2);
            }
            if !alone {
                return ISOMETRIC;
            }
            let normals = drawn.iter().map(|t| camera::normal(t.map(point)));
            camera::unit(normals.sum()) + camera::unit(ISOMETRIC) * 0.3
        });
        let fine = |ends: [f64; 2]| ends.map(|end| end * FINE as f64);
        let camera = Camera::fit(&seen, towards, fine(layout.model_x), fine(layout.model_y));
        let corner = |node: u32, nearer: f64| {
            let [x, y, depth] = camera.project(point(node));
            Corner {
                x,
                y,
                depth: depth + nearer,
                value: value(node),
            }
        };
        for triangle in &drawn {
            let light = match self.skin.is_plane {
                true => 1.0,
                false => camera.light(camera::normal(triangle.map(point))),
            };
            let on_model = chosen.field.of_contact && self.skin.is_plane;
            let shade = |value: f64| match on_model {
                true => [226.0, 229.0, 233.0],
                false => chosen.colour(value).map(|c| c * light),
            };
            raster.triangle(triangle.map(|node| corner(node, 0.0)), &shade);
        }
        self.lines(raster, chosen, options, alone, &corner);
        camera
    }

    /// Draws edges of elements, bars, and contacts in the plane.
    fn lines(
        &self,
        raster: &mut Raster,
        chosen: &Chosen<'_>,
        options: &PictureOptions,
        alone: bool,
        corner: &dyn Fn(u32, f64) -> Corner,
    ) {
        let fine = FINE as f64;
        let long = |[a, b]: [u32; 2]| {
            let (a, b) = (corner(a, 0.0), corner(b, 0.0));
            (a.x - b.x).hypot(a.y - b.y)
        };
        let has_value = |node: &u32| {
            let value = chosen.values.get(*node as usize);
            value.is_some_and(|value| value.is_finite())
        };
        let edges: Vec<[u32; 2]> = (self.skin.edges.iter().copied())
            .filter(|edge| !alone || edge.iter().all(has_value))
            .collect();
        let mean = edges.iter().map(|edge| long(*edge)).sum::<f64>() / edges.len().max(1) as f64;
        if options.edges.unwrap_or(mean > EDGE_LEAST * fine) {
            let cover = (mean / (40.0 * fine)).clamp(0.18, 0.5);
            for edge in &edges {
                let ends = edge.map(|node| corner(node, 1.5 * fine));
                raster.line(ends, fine, cover, &|_| [20.0, 22.0, 28.0]);
            }
        }
        for line in &self.skin.lines {
            let ends = line.map(|node| corner(node, 2.0 * fine));
            raster.line(ends, 3.0 * fine, 1.0, &|value| chosen.colour(value));
        }
        if chosen.field.of_contact && self.skin.is_plane {
            let of_contact = self
                .skin
                .edges
                .iter()
                .filter(|edge| edge.iter().all(has_value));
            for edge in of_contact {
                let ends = edge.map(|node| corner(node, 3.0 * fine));
                raster.line(ends, 5.0 * fine, 1.0, &|value| chosen.colour(value));
            }
        }
    }

    /// Writes title, field, time and the factor on displacements.
    fn head(&self, sheet: &mut Sheet, layout: &Layout, chosen: &Chosen<'_>, warp: f64) {
        let text = layout.text;
        let mut title = self.title.to_owned();
        while sheet.width_of(&title, 1.35 * text) > sheet.width as f32 - 2.0 * text {
            title = title
                .chars()
                .take(title.chars().count().saturating_sub(2))
                .collect();
            if title.is_empty() {
                break;
            }
            title.push('…');
        }
        sheet.write(&title, 1.35 * text, [text, 1.7 * text], Side::Left, INK);
        let mut line = chosen.name.clone();
        let unit = unit(&chosen.name, self.units);
        if !unit.is_empty() {
            line.push_str(&format!(" in {unit}"));
        }
        line.push_str(&format!("    time {}", short(self.frame.time, 6)));
        if warp != 1.0 {
            line.push_str(&format!("    displacements × {}", short(warp, 4)));
        }
        sheet.write(&line, text, [text, 3.1 * text], Side::Left, GREY_INK);
    }
}

/// The colour bar with numbers, or the names of statuses.
fn bar(sheet: &mut Sheet, layout: &Layout, chosen: &Chosen<'_>, unit: &str) {
    let text = layout.text;
    let wide = (0.9 * text) as i64;
    let (x, [top, bottom]) = (layout.bar_x, layout.bar_y);
    let right_of_bar = (x + wide) as f32 + 0.4 * text;
    if chosen.is_status() {
        for (k, (name, colour)) in colour::STATUS_NAMES
            .iter()
            .zip(colour::STATUSES)
            .enumerate()
        {
            let y = top + (k as f32 * 1.7 * text) as i64;
            sheet.fill([x, x + wide], [y, y + wide], colour);
            let place = [right_of_bar, y as f32 + 0.8 * text];
            sheet.write(name, text, place, Side::Left, INK);
        }
        return;
    }
    let tall = (bottom - top).max(1);
    let [low, high] = chosen.range;
    for y in top..bottom {
        let part = (bottom - 1 - y) as f64 / (tall - 1).max(1) as f64;
        let colour = colour::viridis(part).map(|c| c.round() as u8);
        sheet.fill([x, x + wide], [y, y + 1], colour);
    }
    let ntick = if high > low { 5 } else { 0 };
    for tick in 0..=ntick {
        let part = f64::from(tick) / f64::from(ntick.max(1));
        let y = bottom as f64 - 1.0 - part * (tall - 1) as f64;
        sheet.fill([x + wide, x + wide + 4], [y as i64, y as i64 + 1], INK);
        let value = low + part * (high - low);
        // differences below rounding are no numbers to read
        let value = if value.abs() < 1e-9 * (high - low) {
            0.0
        } else {
            value
        };
        let place = [right_of_bar, y as f32 + 0.35 * text];
        sheet.write(&short(value, 4), text, place, Side::Left, INK);
    }
    let place = [x as f32, top as f32 - 0.6 * text];
    sheet.write(unit, text, place, Side::Left, GREY_INK);
}

/// The axes in a corner of the picture.
fn axes(sheet: &mut Sheet, layout: &Layout, camera: &Camera) {
    let text = f64::from(layout.text);
    let length = 2.2 * text;
    let origin = [
        2.0 * text + 0.5 * length,
        sheet.height as f64 - 2.0 * text - 0.3 * length,
    ];
    let colours = [[200, 40, 40], [30, 140, 60], [40, 80, 200]];
    for ((axis, name), colour) in camera.axes().into_iter().zip(["x", "y", "z"]).zip(colours) {
        if axis[0].hypot(axis[1]) < 0.05 {
            continue;
        }
        let steps = (2.0 * length) as usize;
        for step in 0..=steps {
            let t = length * step as f64 / steps.max(1) as f64;
            let (x, y) = (origin[0] + t * axis[0], origin[1] + t * axis[1]);
            sheet.fill([x as i64, x as i64 + 2], [y as i64, y as i64 + 2], colour);
        }
        let place = [0, 1].map(|k| (origin[k] + (length + 0.6 * text) * axis[k]) as f32);
        let place = [place[0], place[1] + 0.3 * layout.text];
        sheet.write(name, layout.text, place, Side::Middle, colour);
    }
}

fn encode(sheet: &Sheet) -> Result<Vec<u8>, ReportError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, sheet.width as u32, sheet.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&sheet.bytes)?;
    writer.finish()?;
    Ok(bytes)
}
