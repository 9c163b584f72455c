//! `SIGNORINI_WITHIN=DIR`: the command reads and writes nothing outside of a folder.
//!
//! For programs that run the command for somebody else, as `signorini mcp` does. Two fences, each complete by itself:
//!
//! ```text
//! signorini_io::fs::confine    everywhere: every path is resolved before use, and a message names the one refused
//! Landlock                     Linux 5.13 and newer: the kernel refuses, also where a link is replaced in between
//! ```
//!
//! Limits: without Landlock the second fence is missing, silently. The kernel lets the process read `/proc` and `/sys`, where
//! the number of processors and the memory in use are found, and `/dev`; [`signorini_io::fs`] does not.

use super::console::Console;
use super::exit::WRONG_COMMAND;
use signorini_io::fs::confine;
use std::path::Path;

/// The variable that names the folder.
pub const WITHIN: &str = "SIGNORINI_WITHIN";

/// Confines the process where the environment asks for it. To be called while there is one thread.
///
/// # Errors
/// The exit code, where the folder cannot be used; the reason is reported.
pub fn keep() -> Result<(), u8> {
    let Some(root) = std::env::var_os(WITHIN).filter(|root| !root.is_empty()) else {
        return Ok(());
    };
    match confine(Path::new(&root)) {
        Ok(root) => {
            // a kernel that cannot is no fault: the other fence stands
            let _ = fence(&root);
            Ok(())
        }
        Err(error) => {
            Console::stderr().line(&format!("error: {WITHIN}: {error}"));
            Err(WRONG_COMMAND)
        }
    }
}

/// Has the kernel refuse files outside of `root` to this thread and those that it will start; whether it does.
#[cfg(target_os = "linux")]
fn fence(root: &Path) -> bool {
    use landlock::{
        ABI, Access, AccessFs, Ruleset, RulesetAttr, RulesetCreatedAttr, RulesetError,
        RulesetStatus, path_beneath_rules,
    };
    // version 3 knows truncation; newer rights concern devices and sockets. An older kernel takes the rights that it knows.
    let abi = ABI::V3;
    let fenced = || -> Result<RulesetStatus, RulesetError> {
        let status = Ruleset::default()
            .handle_access(AccessFs::from_all(abi))?
            .create()?
            .add_rules(path_beneath_rules([root], AccessFs::from_all(abi)))?
            .add_rules(path_beneath_rules(
                ["/proc", "/sys", "/dev"],
                AccessFs::from_read(abi),
            ))?
            .add_rules(path_beneath_rules(["/dev/null"], AccessFs::WriteFile))?
            .restrict_self()?;
        Ok(status.ruleset)
    };
    fenced().is_ok_and(|status| status != RulesetStatus::NotEnforced)
}

#[cfg(not(target_os = "linux"))]
const fn fence(_: &Path) -> bool {
    false
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_kernel_refuses_what_is_outside() {
        let top = tempfile::tempdir().unwrap();
        let root = top.path().join("root");
        fs::create_dir(&root).unwrap();
        fs::write(top.path().join("secret"), "s").unwrap();
        fs::write(root.join("own"), "o").unwrap();
        // only this thread is fenced in
        let fenced = std::thread::spawn({
            let (top, root) = (top.path().to_path_buf(), root.clone());
            move || {
                if !fence(&root) {
                    return false;
                }
                assert!(fs::read(top.join("secret")).is_err());
                assert!(fs::write(top.join("new"), "n").is_err());
                assert!(fs::create_dir(top.join("folder")).is_err());
                assert!(fs::rename(root.join("own"), top.join("moved")).is_err());
                assert_eq!(fs::read(root.join("own")).unwrap(), b"o");
                fs::create_dir(root.join("folder")).unwrap();
                fs::rename(root.join("own"), root.join("folder/own")).unwrap();
                assert!(fs::read_to_string("/proc/self/status").is_ok());
                true
            }
        });
        if !fenced.join().unwrap() {
            eprintln!("skipped: this kernel has no Landlock");
        }
        assert_eq!(fs::read(top.path().join("secret")).unwrap(), b"s");
    }
}
