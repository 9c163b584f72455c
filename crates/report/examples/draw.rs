//! Draws a frame of a folder of results: `draw FOLDER FILE [FIELD]`.

use signorini_io::fs::RealFs;
use signorini_report::{PictureOptions, picture};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, file, rest @ ..] = words.as_slice() else {
        return Err("draw FOLDER FILE [FIELD]".into());
    };
    let options = PictureOptions {
        field: rest.first().cloned(),
        ..PictureOptions::default()
    };
    let bytes = picture(&RealFs, Path::new(folder), &options)?;
    std::fs::write(file, bytes)?;
    Ok(())
}
