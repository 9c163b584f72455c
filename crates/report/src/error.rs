//! Why there is no report.

use signorini_io::fs::FsError;
use signorini_io::vtk::VtuReadError;
use std::path::PathBuf;

/// Why a page or a picture cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The folder does not hold results.
    #[error("{} holds no results: none of {} is in it", folder.display(), wanted)]
    NotResults {
        /// The folder.
        folder: PathBuf,
        /// What it would hold.
        wanted: String,
    },
    /// A file that exists cannot be read.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// There is nothing to draw.
    #[error("{} lists no frames that can be drawn{why}", folder.display())]
    NoFrames {
        /// The folder.
        folder: PathBuf,
        /// The reason, where one is known, after a colon.
        why: String,
    },
    /// The results have no frame of this number.
    #[error("there is no frame {wanted}: the frames are numbered 0 to {last}")]
    NoFrame {
        /// The number that was asked for.
        wanted: usize,
        /// The number of the last frame.
        last: usize,
    },
    /// The frames have no field of this name.
    #[error("there is no field \"{wanted}\"; the fields are {known}")]
    NoField {
        /// The name that was asked for.
        wanted: String,
        /// All names.
        known: String,
    },
    /// A frame cannot be read.
    #[error("{file}: {source}")]
    Frame {
        /// The file.
        file: String,
        /// Why.
        source: VtuReadError,
    },
    /// A picture of this size is not drawn.
    #[error(
        "a picture of {width} × {height} pixels is not drawn: each side must be {least} to {most} pixels"
    )]
    Size {
        /// The width that was asked for.
        width: u32,
        /// The height that was asked for.
        height: u32,
        /// The least side.
        least: u32,
        /// The greatest side.
        most: u32,
    },
    /// The PNG encoder failed.
    #[error("the picture cannot be encoded: {0}")]
    Png(#[from] png::EncodingError),
    /// A font of the program cannot be read.
    #[error("the font of pictures cannot be read")]
    Font,
}

impl ReportError {
    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotResults { .. } => {
                "name the folder that signorini run has written, such as case.out"
            }
            Self::Fs(_) => "check that the folder exists and may be read",
            Self::NoFrames { .. } => {
                "run the case with  [output] format = [\"vtu\"];  the page itself needs no frames"
            }
            Self::NoFrame { .. } => "choose one of the frames that signorini info lists",
            Self::NoField { .. } => "choose one of these; components follow a dot, as in stress.XX",
            Self::Frame { .. } => "run the case again; the file is damaged",
            Self::Size { .. } => "choose another size",
            Self::Png(_) | Self::Font => "report this as a bug",
        }
    }

    /// The exit code of a command that ends with this error: 3, the input is wrong.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        3
    }
}
