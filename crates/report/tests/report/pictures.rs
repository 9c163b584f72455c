//! Pictures, pixel by pixel.

use crate::synthetic::{Blocks, FOLDER, complete, file, write_frames};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_report::{PictureOptions, ReportError, main_fields, picture};
use std::path::Path;

/// Width, height and the pixels.
fn pixels(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels)
}

fn drawn(fs: &MemoryFs, field: &str, frame: usize) -> Vec<u8> {
    let options = PictureOptions {
        field: Some(field.into()),
        frame: Some(frame),
        width: 480,
        height: 320,
        ..PictureOptions::default()
    };
    let (width, height, pixels) = pixels(&picture(fs, Path::new(FOLDER), &options).unwrap());
    assert_eq!((width, height), (480, 320));
    pixels
}

#[test]
fn another_field_and_another_frame_give_another_picture() {
    let fs = complete();
    let pictures = [
        drawn(&fs, "von_mises", 2),
        drawn(&fs, "von_mises", 1),
        drawn(&fs, "displacement", 2),
        drawn(&fs, "displacement.z", 2),
        drawn(&fs, "contact_pressure", 2),
        drawn(&fs, "contact_status", 2),
    ];
    for (k, one) in pictures.iter().enumerate() {
        assert!(pictures[..k].iter().all(|other| other != one), "{k}");
        let coloured = one
            .chunks_exact(3)
            .filter(|p| p.iter().max() != p.iter().min());
        assert!(coloured.count() > 480 * 320 / 20, "{k}");
    }
}

#[test]
fn the_plane_is_seen_from_above_and_one_colour_where_the_field_is_constant() {
    let fs = MemoryFs::default();
    write_frames(&fs, &Blocks { n: 2, plane: true }, 2);
    let pixels = drawn(&fs, "displacement", 1);
    let middle = 3 * (180 * 480 + 170);
    assert_eq!(pixels[middle..middle + 3], [68, 1, 84]);
}

#[test]
fn the_main_fields_are_those_that_the_frames_have() {
    let fs = complete();
    let names = main_fields(&fs, Path::new(FOLDER), None).unwrap();
    assert_eq!(
        names,
        [
            "displacement",
            "von_mises",
            "contact_pressure",
            "contact_status",
            "contact_gap"
        ]
    );
}

#[test]
fn what_cannot_be_drawn_is_named() {
    let fs = complete();
    let with = |options: PictureOptions| picture(&fs, Path::new(FOLDER), &options).unwrap_err();
    let error = with(PictureOptions {
        field: Some("stress.QQ".into()),
        ..PictureOptions::default()
    });
    assert!(error.to_string().contains("von_mises, "), "{error}");
    let error = with(PictureOptions {
        frame: Some(9),
        ..PictureOptions::default()
    });
    assert_eq!(
        error.to_string(),
        "there is no frame 9: the frames are numbered 0 to 2"
    );
    let error = with(PictureOptions {
        width: 100_000,
        ..PictureOptions::default()
    });
    assert!(matches!(error, ReportError::Size { .. }));
    fs.remove(&file("results.pvd")).unwrap();
    fs.remove(&file("contact.pvd")).unwrap();
    assert!(matches!(
        with(PictureOptions::default()),
        ReportError::NoFrames { .. }
    ));
}

#[test]
fn numbers_that_are_none_do_not_stop_a_picture() {
    let fs = complete();
    let options = PictureOptions {
        view: Some([f64::NAN; 3]),
        warp: f64::INFINITY,
        range: Some([1.0, -1.0]),
        width: 160,
        height: 160,
        ..PictureOptions::default()
    };
    assert!(picture(&fs, Path::new(FOLDER), &options).is_ok());
}
