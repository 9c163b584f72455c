//! `signorini doctor`

use super::console::Console;
use super::templates::TEMPLATES;
use super::threads;
use signorini::{RunOptions, build};
use signorini_linear::SOLVERS;
use std::time::Instant;

/// Tells what there is to know about program and machine, and solves something small.
pub fn execute() -> u8 {
    let out = Console::stdout();
    out.line(&format!("signorini {}", signorini::VERSION));
    out.line(&format!(
        "system    {} {}",
        std::env::consts::OS,
        std::env::consts::ARCH
    ));
    out.line(&format!("threads   {}", threads::make(None, None)));
    let solvers: Vec<&str> = SOLVERS.iter().map(|solver| solver.name).collect();
    out.line(&format!("linear    {}", solvers.join(", ")));
    let folder = std::env::temp_dir();
    out.line(&format!("temporary {}", folder.display()));
    match trial(&folder.join(format!("signorini-doctor-{}", std::process::id()))) {
        Ok(seconds) => {
            out.line(&format!(
                "✓ a small case is solved and written in {seconds:.2} s"
            ));
            0
        }
        Err((code, why)) => {
            out.line(&format!("✗ a small case fails with exit code {code}"));
            out.text(&why);
            code
        }
    }
}

/// Solves the first template into a folder that is removed afterwards.
fn trial(folder: &std::path::Path) -> Result<f64, (u8, String)> {
    let clock = Instant::now();
    let failed = |found: signorini::Diagnostics| (found.exit_code().unwrap_or(70), found.plain());
    let written = std::fs::create_dir_all(folder);
    written.map_err(|e| (6, format!("{}: {e}\n", folder.display())))?;
    let path = folder.join("doctor.toml");
    let text = TEMPLATES.first().map_or("", |template| template.text);
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
