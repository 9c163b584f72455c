//! Triangles and lines in a buffer of colours with depths.
//!
//! The buffer is finer than the picture by [`FINE`] in both directions; the picture takes the means of its pixels.

/// Pixels of the buffer per pixel of the picture, in each direction.
pub const FINE: usize = 3;

/// Colours from 0 to 255.
pub type Colour = [f64; 3];

/// A corner of a triangle: pixels of the buffer from the left and from the top, depth towards the eye, and a value.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// From the left.
    pub x: f64,
    /// From the top.
    pub y: f64,
    /// Towards the eye.
    pub depth: f64,
    /// What the colour is taken from.
    pub value: f64,
}

/// A buffer of colours with depths.
pub struct Raster {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    colours: Vec<[u8; 3]>,
    depths: Vec<f32>,
}

impl Raster {
    /// A buffer for a picture of this size, all in one colour and infinitely far.
    #[must_use]
    pub fn new(width: usize, height: usize, background: [u8; 3]) -> Self {
        let (width, height) = (width * FINE, height * FINE);
        Self {
            width,
            height,
            colours: vec![background; width * height],
            depths: vec![f32::NEG_INFINITY; width * height],
        }
    }

    /// Puts a colour where nothing nearer is; it covers what was there by `cover` from 0 to 1.
    fn put(&mut self, x: usize, y: usize, depth: f64, colour: Colour, cover: f64) {
        let at = y * self.width + x;
        let pixel = (self.depths.get_mut(at), self.colours.get_mut(at));
        let (Some(old), Some(place)) = pixel else {
            return;
        };
        if depth as f32 >= *old {
            *old = depth as f32;
            for (place, colour) in place.iter_mut().zip(colour) {
                *place = (f64::from(*place) * (1.0 - cover) + colour * cover) as u8;
            }
        }
    }

    /// Fills a triangle; `colour` gives the colour of a value.
    pub fn triangle(&mut self, corners: [Corner; 3], colour: &dyn Fn(f64) -> Colour) {
        let [a, b, c] = corners;
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if !area.is_finite() || area == 0.0 {
            return;
        }
        let ends = |of: fn(&Corner) -> f64, most: usize| {
            let all = [of(&a), of(&b), of(&c)];
            let low = all
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min)
                .floor()
                .max(0.0);
            let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil();
            (low as usize)..(high.clamp(0.0, most as f64) as usize)
        };
        let columns = ends(|corner| corner.x, self.width);
        for y in ends(|corner| corner.y, self.height) {
            for x in columns.clone() {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let u = ((b.x - px) * (c.y - py) - (c.x - px) * (b.y - py)) / area;
                let v = ((c.x - px) * (a.y - py) - (a.x - px) * (c.y - py)) / area;
                let w = 1.0 - u - v;
                if u < -1e-9 || v < -1e-9 || w < -1e-9 {
                    continue;
                }
                let depth = u * a.depth + v * b.depth + w * c.depth;
                let value = u * a.value + v * b.value + w * c.value;
                self.put(x, y, depth, colour(value), 1.0);
            }
        }
    }

    /// Draws a line `thick` pixels of the buffer wide, which covers what is under it by `cover`.
    pub fn line(
        &mut self,
        ends: [Corner; 2],
        thick: f64,
        cover: f64,
        colour: &dyn Fn(f64) -> Colour,
    ) {
        let [a, b] = ends;
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let length = dx.hypot(dy);
        if !length.is_finite() || length > 4.0 * (self.width + self.height) as f64 {
            return;
        }
        let (nx, ny) = match length > 0.0 {
            true => (-dy / length, dx / length),
            false => (0.0, 1.0),
        };
        // every step goes less than one pixel, along the line and across it
        let steps = (length * 1.5).ceil().max(1.0) as usize;
        let across = (thick * 1.5).ceil().max(1.0) as usize;
        let mut last: Vec<(usize, usize)> = Vec::new();
        for step in 0..=steps {
            let t = step as f64 / steps as f64;
            let mut now = Vec::with_capacity(across + 1);
            for k in 0..=across {
                let s = (k as f64 / across as f64 - 0.5) * (thick - 1.0).max(0.0);
                let (x, y) = (a.x + t * dx + s * nx, a.y + t * dy + s * ny);
                if x < 0.0 || y < 0.0 || x >= self.width as f64 || y >= self.height as f64 {
                    continue;
                }
                let pixel = (x as usize, y as usize);
                if last.contains(&pixel) || now.contains(&pixel) {
                    continue;
                }
                now.push(pixel);
                let depth = a.depth + t * (b.depth - a.depth);
                let value = a.value + t * (b.value - a.value);
                self.put(pixel.0, pixel.1, depth, colour(value), cover);
            }
            if !now.is_empty() {
                last = now;
            }
        }
    }

    /// The picture: means over the pixels of the buffer, three bytes each, row by row.
    #[must_use]
    pub fn picture(&self) -> Vec<u8> {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut bytes = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0_usize; 3];
                for row in y * FINE..(y + 1) * FINE {
                    let start = row * self.width + x * FINE;
                    for colour in self.colours.get(start..start + FINE).unwrap_or_default() {
                        for (sum, colour) in sum.iter_mut().zip(colour) {
                            *sum += usize::from(*colour);
                        }
                    }
                }
                bytes.extend(sum.map(|sum| (sum / (FINE * FINE)) as u8));
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64, depth: f64) -> Corner {
        Corner {
            x,
            y,
            depth,
            value: depth,
        }
    }

    #[test]
    fn two_triangles_cover_a_square_once_and_the_nearer_one_is_seen() {
        let mut raster = Raster::new(10, 10, [0; 3]);
        let n = 10.0 * FINE as f64;
        let grey = |value: f64| [value; 3];
        for depth in [200.0, 100.0] {
            let [a, b, c, d] = [
                corner(0.0, 0.0, depth),
                corner(n, 0.0, depth),
                corner(n, n, depth),
                corner(0.0, n, depth),
            ];
            raster.triangle([a, b, c], &grey);
            raster.triangle([a, d, c], &grey);
        }
        assert!(
            raster
                .picture()
                .iter()
                .all(|byte| (199..=200).contains(byte))
        );
    }

    #[test]
    fn what_lies_outside_of_the_picture_or_is_no_number_is_left_out() {
        let mut raster = Raster::new(4, 4, [9; 3]);
        let far = [
            corner(-50.0, -50.0, 0.0),
            corner(-1.0, -9.0, 0.0),
            corner(-9.0, 0.0, 0.0),
        ];
        raster.triangle(far, &|_| [1.0; 3]);
        let nan = [
            corner(f64::NAN, 0.0, 0.0),
            corner(9.0, 0.0, 0.0),
            corner(0.0, 9.0, 0.0),
        ];
        raster.triangle(nan, &|_| [1.0; 3]);
        raster.line([nan[0], nan[1]], 3.0, 1.0, &|_| [1.0; 3]);
        raster.line([far[0], corner(1e300, 1.0, 0.0)], 3.0, 1.0, &|_| [1.0; 3]);
        assert!(raster.picture().iter().all(|byte| *byte == 9));
    }
}
