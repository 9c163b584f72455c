//! Writes the page of a folder of results: `page FOLDER FILE [OTHER]`.

use signorini_io::fs::RealFs;
use signorini_report::{PageOptions, page};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, file, rest @ ..] = words.as_slice() else {
        return Err("page FOLDER FILE [OTHER]".into());
    };
    let options = PageOptions {
        compare: rest.first().map(Into::into),
        ..PageOptions::default()
    };
    let bytes = page(&RealFs, Path::new(folder), &options)?;
    std::fs::write(file, bytes)?;
    Ok(())
}
