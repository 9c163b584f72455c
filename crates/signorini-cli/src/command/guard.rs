//! The last line of defence: an error of the program itself ends with exit code 70 and a text worth sending.

use super::console::Console;
use super::{exhausted, ranks, stack};
use signorini::crash::{self, Crash};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// What the standard library says where a thread has no room for its stack.
const NO_THREAD: &str = "failed to spawn thread";

/// The stack of the thread that works, in bytes, where it is one of its own.
const STACK: usize = 16 << 20;

/// What the first thread must be allowed, to work itself: about what the other threads of a run have.
const ENOUGH: u64 = 8 << 20;

/// Runs the program, in a thread of its own where the shell leaves the first one too little stack, and turns a panic into a
/// message and a file to send; `arguments` is the command line without the program.
pub fn guarded(arguments: &[String], program: impl FnOnce() -> u8 + Send + 'static) -> u8 {
    let seen: Arc<Mutex<Option<Crash>>> = Arc::default();
    let keep = Arc::clone(&seen);
    panic::set_hook(Box::new(move |info| {
        let mut first = keep.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert_with(|| Crash::record(info));
    }));
    let outcome = if stack::first_may_take(ENOUGH) {
        Ok(panic::catch_unwind(AssertUnwindSafe(program)))
    } else {
        let thread = std::thread::Builder::new()
            .name("signorini".into())
            .stack_size(STACK);
        thread.spawn(program).map(std::thread::JoinHandle::join)
    };
    match outcome {
        Ok(Ok(code)) => code,
        Ok(Err(_)) => {
            let ranks = ranks::all();
            // whatever the others do: this one says what has happened, and takes them along
            ranks.fails_alone(crash::EXIT_CODE);
            let crash = seen.lock().unwrap_or_else(PoisonError::into_inner).take();
            let code = match crash {
                Some(crash) if crash.message.contains(NO_THREAD) => {
                    exhausted::say("a thread could not be started");
                    exhausted::CODE
                }
                crash => {
                    report(crash.as_ref(), arguments);
                    crash::EXIT_CODE
                }
            };
            ranks.abort(code);
            code
        }
        Err(error) => {
            exhausted::say(&format!("a thread could not be started: {error}"));
            exhausted::CODE
        }
    }
}

fn report(crash: Option<&Crash>, arguments: &[String]) {
    let console = Console::stderr();
    console.line("internal error: this is a bug of signorini, not of your case");
    console.line(&format!(
        "  {}",
        crash.map_or("a panic", |crash| crash.message.as_str())
    ));
    console.line(&format!(
        "  signorini {} on {}-{}{}",
        signorini::VERSION,
        std::env::consts::ARCH,
        std::env::consts::OS,
        ranks::here()
    ));
    if ranks::all().rank() != 0 {
        // rank 0 alone writes files
        let trace = crash.map_or("", |crash| crash.backtrace.as_str());
        return console.text(trace);
    }
    let folders = [PathBuf::from("."), std::env::temp_dir()];
    let saved = crash.map(|crash| crash.save(&folders, arguments, &inputs(arguments)));
    console.line(&match saved {
        Some(Ok(path)) => format!(
            "  please send {} with the mesh of the case; what had converged is on disk",
            path.display()
        ),
        _ => "  please send these lines with the case and its mesh; what had converged is on disk"
            .to_owned(),
    });
}

/// The files among the arguments: a case, a deck, a mesh.
fn inputs(arguments: &[String]) -> Vec<PathBuf> {
    let files = arguments
        .iter()
        .map(Path::new)
        .filter(|path| path.is_file());
    files.map(Path::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    /// Names the test that is to panic, in a process of its own: a hook for panics belongs to the whole process.
    const INNER: &str = "SIGNORINI_TEST_OF_CRASHES";

    #[cfg(feature = "mpi")]
    #[test]
    fn a_panic_of_one_rank_ends_all_with_exit_code_70() {
        if std::env::var_os(INNER).is_some() {
            ranks::enter();
            let code = guarded(&[], || match ranks::all().rank() {
                1 => panic!("made on purpose"),
                _ => ranks::end(0),
            });
            std::process::exit(code.into());
        }
        let name = "a_panic_of_one_rank_ends_all_with_exit_code_70";
        let output = Command::new("mpirun")
            .args(["--oversubscribe", "-n", "3"])
            .arg(std::env::current_exe().unwrap())
            .args([name, "--nocapture"])
            .env(INNER, "yes")
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(70), "{said}");
        assert_eq!(said.matches("made on purpose").count(), 1, "{said}");
        assert!(said.contains("on rank 1 of 3"), "{said}");
    }

    #[test]
    fn a_panic_ends_with_exit_code_70_and_a_file_to_send() {
        if std::env::var_os(INNER).is_some() {
            let arguments = ["check".to_owned(), "case.toml".to_owned()];
            std::process::exit(guarded(&arguments, || panic!("made on purpose")).into());
        }
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("case.toml"), "format = 1\n").unwrap();
        let name = "a_panic_ends_with_exit_code_70_and_a_file_to_send";
        let output = Command::new(std::env::current_exe().unwrap())
            .args([name, "--nocapture"])
            .env(INNER, "yes")
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(70), "{said}");
        assert!(said.contains("made on purpose"), "{said}");
        let files = std::fs::read_dir(folder.path()).unwrap();
        let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
        let zips: Vec<String> = names.filter(|name| name.ends_with(".zip")).collect();
        assert_eq!(zips.len(), 1, "{zips:?}");
        assert!(said.contains(&zips[0]), "{said}");
    }
}
