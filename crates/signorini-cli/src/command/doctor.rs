//! `signorini doctor`

use super::console::Console;
use super::object;
use super::templates;
use super::threads;
use clap::Args;
use serde_json::json;
use signorini::{Diagnostics, RunOptions, build};
use signorini_linear::{LinearKind, SOLVERS};
use std::time::Instant;

/// Tell version, machine and threads, and solve something small: for reports of bugs.
#[derive(Debug, Args)]
pub struct Doctor {
    /// The answer as one object of JSON on standard output
    #[arg(long)]
    json: bool,
}

impl Doctor {
    /// Tells what there is to know about program and machine, and solves something small.
    pub fn execute(self) -> u8 {
        let (os, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
        let threads = threads::make(None, None);
        let features = features();
        // those that a case can choose
        let choices = SOLVERS.iter().filter(|s| s.kind != LinearKind::Saddle);
        let solvers: Vec<&str> = choices.map(|solver| solver.name).collect();
        let folder = std::env::temp_dir();
        let trial = trial(&folder.join(format!("signorini-doctor-{}", std::process::id())));
        let code = trial.as_ref().map_or_else(|(code, _)| *code, |_| 0);
        if self.json {
            let members = object::members(&json!({
                "version": signorini::VERSION,
                "system": os,
                "architecture": architecture,
                "features": features,
                "threads": threads,
                "linear": solvers,
                "temporary": folder,
                "trial_seconds": trial.as_ref().ok(),
                "trial_fault": trial.as_ref().err().map(|(_, why)| why),
            }));
            return object::object("doctor", code, &Diagnostics::new(), members);
        }
        let out = Console::stdout();
        out.line(&format!("signorini {}", signorini::VERSION));
        out.line(&format!(
            "system    {os} {architecture} {}",
            features.join(" ")
        ));
        out.line(&format!("threads   {threads}"));
        out.line(&format!("linear    {}", solvers.join(", ")));
        out.line(&format!("temporary {}", folder.display()));
        match trial {
            Ok(seconds) => out.line(&format!(
                "✓ a small case is solved and written in {seconds:.2} s"
            )),
            Err((code, why)) => {
                out.line(&format!("✗ a small case fails with exit code {code}"));
                out.text(&why);
            }
        }
        code
    }
}

/// Instructions of this processor that the linear algebra makes use of.
fn features() -> Vec<&'static str> {
    #[cfg(target_arch = "x86_64")]
    let all = [
        ("avx2", std::arch::is_x86_feature_detected!("avx2")),
        ("fma", std::arch::is_x86_feature_detected!("fma")),
        ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(target_arch = "aarch64")]
    let all = [("neon", std::arch::is_aarch64_feature_detected!("neon"))];
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    let all: [(&str, bool); 0] = [];
    let has = all.into_iter().filter(|(_, has)| *has);
    has.map(|(name, _)| name).collect()
}

/// Solves a small template into a folder that is removed afterwards.
fn trial(folder: &std::path::Path) -> Result<f64, (u8, String)> {
    let clock = Instant::now();
    let failed = |found: signorini::Diagnostics| (found.exit_code().unwrap_or(70), found.plain());
    let written = std::fs::create_dir_all(folder);
    written.map_err(|e| (6, format!("{}: {e}\n", folder.display())))?;
    let path = folder.join("doctor.toml");
    let text = templates::smallest().map_or("", |template| template.text);
    std::fs::write(&path, text).map_err(|e| (6, format!("{}: {e}\n", path.display())))?;
    let loaded = signorini::load(&path, &signorini::Reading::default()).map_err(failed)?;
    let mut model = build(loaded.case, loaded.mesh).map_err(failed)?;
    model.name.clone_from(&loaded.source.name);
    let finished = signorini::run(&mut model, &RunOptions::new(loaded.source), &mut ());
    // only what was just written here
    let _ = std::fs::remove_dir_all(folder);
    match finished.exit_code {
        0 => Ok(clock.elapsed().as_secs_f64()),
        code => Err((code, finished.diagnostics.plain())),
    }
}
