//! Text in a picture.

use crate::error::ReportError;
use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

/// Where a text stands relative to its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// It starts there.
    Left,
    /// Its middle is there.
    Middle,
}

/// A picture with three bytes per pixel, to be written on.
pub struct Sheet {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    /// Three bytes per pixel, row by row.
    pub bytes: Vec<u8>,
    font: FontRef<'static>,
}

impl Sheet {
    /// A picture to be written on.
    ///
    /// # Errors
    /// [`ReportError::Font`].
    pub fn new(width: usize, height: usize, bytes: Vec<u8>) -> Result<Self, ReportError> {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT);
        Ok(Self {
            width,
            height,
            bytes,
            font: font.map_err(|_| ReportError::Font)?,
        })
    }

    /// Covers a pixel with a colour, by `cover` from 0 to 1.
    pub fn cover(&mut self, x: i64, y: i64, colour: [u8; 3], cover: f64) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else {
            return;
        };
        if x >= self.width || y >= self.height {
            return;
        }
        let at = 3 * (y * self.width + x);
        let pixel = self.bytes.get_mut(at..at + 3).unwrap_or_default();
        for (byte, colour) in pixel.iter_mut().zip(colour) {
            let mixed = f64::from(*byte) * (1.0 - cover) + f64::from(colour) * cover;
            *byte = mixed.round().clamp(0.0, 255.0) as u8;
        }
    }

    /// Fills the pixels from `x0` to `x1` and from `y0` to `y1`.
    pub fn fill(&mut self, x: [i64; 2], y: [i64; 2], colour: [u8; 3]) {
        for row in y[0]..y[1] {
            (x[0]..x[1]).for_each(|column| self.cover(column, row, colour, 1.0));
        }
    }

    /// How wide a text is, in pixels.
    #[must_use]
    pub fn width_of(&self, text: &str, size: f32) -> f32 {
        let font = self.font.as_scaled(PxScale::from(size));
        let mut width = 0.0;
        let mut last = None;
        for character in text.chars() {
            let id = font.glyph_id(character);
            width += last.map_or(0.0, |last| font.kern(last, id)) + font.h_advance(id);
            last = Some(id);
        }
        width
    }

    /// Writes a text whose base line starts or is centred at `x`, `y`. What does not fit into the picture is cut.
    pub fn write(&mut self, text: &str, size: f32, [x, y]: [f32; 2], side: Side, colour: [u8; 3]) {
        let width = self.width_of(text, size);
        let mut at = match side {
            Side::Left => x,
            Side::Middle => x - width / 2.0,
        };
        let mut glyphs = Vec::new();
        {
            let font = self.font.as_scaled(PxScale::from(size));
            let mut last = None;
            for character in text.chars() {
                let id = font.glyph_id(character);
                at += last.map_or(0.0, |last| font.kern(last, id));
                let glyph = id.with_scale_and_position(size, point(at, y));
                at += font.h_advance(id);
                last = Some(id);
                glyphs.extend(self.font.outline_glyph(glyph));
            }
        }
        for glyph in glyphs {
            let corner = glyph.px_bounds().min;
            let mut dots = Vec::new();
            glyph.draw(|dx, dy, cover| dots.push((dx, dy, cover)));
            for (dx, dy, cover) in dots {
                let (x, y) = (
                    corner.x as i64 + i64::from(dx),
                    corner.y as i64 + i64::from(dy),
                );
                // a light font reads better a little darker
                let cover = f64::from(cover).clamp(0.0, 1.0).powf(0.7);
                self.cover(x, y, colour, cover);
            }
        }
    }
}
