//! The documentation as a site. What builds it is a program of its own, `xtask-site`, so that no other chore has to wait for
//! the libraries that it needs.

use crate::{ChoreError, Outcome, cargo};
use std::path::Path;
use std::process::Command;

/// Builds the site with these options.
pub(crate) fn build(root: &Path, options: &[String]) -> Outcome {
    let ended = Command::new(cargo())
        .args([
            "run",
            "--quiet",
            "--package",
            "xtask-site",
            "--manifest-path",
        ])
        .arg(root.join("Cargo.toml"))
        .arg("--")
        .args(options)
        .status();
    match ended {
        Ok(status) if status.success() => Ok(true),
        Ok(status) if status.code() == Some(1) => Ok(false),
        Ok(status) => Err(ChoreError::Failed {
            what: "xtask-site".to_string(),
            reason: status.to_string(),
        }),
        Err(error) => Err(ChoreError::Failed {
            what: "cargo run --package xtask-site".to_string(),
            reason: error.to_string(),
        }),
    }
}
