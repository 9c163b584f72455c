//! Every tutorial and how-to page is done as its reader would do it: in a fresh folder, with the files that the page shows.

use crate::repository;
use crate::script::{Commands, Step, agrees, steps};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folders of pages that are done from the first line to the last.
const FOLDERS: [&str; 2] = ["docs/tutorials", "docs/howto"];

/// What was done of a page.
#[derive(Debug, Default)]
struct Done {
    commands: usize,
    outputs: usize,
    /// Blocks that need a program that is not here.
    skipped: usize,
    faults: Vec<String>,
}

fn pages(root: &Path) -> Vec<PathBuf> {
    let in_folder = |folder: &&str| std::fs::read_dir(root.join(folder)).unwrap();
    let entries = FOLDERS.iter().flat_map(in_folder);
    let is_page = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "md");
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = paths.filter(is_page).collect();
    pages.sort();
    pages
}

/// Does what a page says.
fn follow(page: &str, root: &Path) -> Result<Done, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let programs = tempfile::tempdir().map_err(|error| error.to_string())?;
    let program = std::env::var_os("SIGNORINI_PROGRAM");
    let program = program.unwrap_or_else(|| env!("CARGO_BIN_EXE_signorini").into());
    std::os::unix::fs::symlink(program, programs.path().join("signorini"))
        .map_err(|error| error.to_string())?;
    let (mut done, mut printed) = (Done::default(), None);
    for step in steps(page)? {
        match step {
            Step::File { name, text } => write(&folder.path().join(name), text.as_bytes())?,
            Step::Copy(path) => {
                let bytes = std::fs::read(root.join(&path))
                    .map_err(|error| format!("cannot copy {path}: {error}"))?;
                let name = Path::new(&path).file_name().ok_or("no name")?;
                write(&folder.path().join(name), &bytes)?;
            }
            Step::Commands(commands) => {
                printed = run(&commands, folder.path(), programs.path(), &mut done)?;
            }
            Step::Output(text) => {
                if let Some(printed) = &printed {
                    done.outputs += 1;
                    done.faults.extend(agrees(&text, printed).err());
                }
            }
        }
    }
    Ok(done)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let folder = path.parent().ok_or("a file without a folder")?;
    std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    std::fs::write(path, bytes).map_err(|error| error.to_string())
}

/// What the commands of a block print; none where they are not run.
fn run(
    commands: &Commands,
    folder: &Path,
    programs: &Path,
    done: &mut Done,
) -> Result<Option<String>, String> {
    let tools = std::env::var_os("SIGNORINI_TOOLS").filter(|tools| !tools.is_empty());
    if commands.not_run.is_some() || commands.needs.is_some() && tools.is_none() {
        done.skipped += 1;
        return Ok(None);
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let places = [programs.to_path_buf()]
        .into_iter()
        .chain(tools.map(PathBuf::from))
        .chain(std::env::split_paths(&path));
    let path = std::env::join_paths(places).map_err(|error| error.to_string())?;
    let ended = Command::new("sh")
        .args(["-e", "-c"])
        .arg(format!("exec 2>&1\n{}", commands.text))
        .current_dir(folder)
        .env("PATH", path)
        .env("NO_COLOR", "1")
        .output()
        .map_err(|error| error.to_string())?;
    let printed = String::from_utf8_lossy(&ended.stdout).into_owned();
    done.commands += 1;
    if ended.status.code() != Some(commands.exit) {
        done.faults.push(format!(
            "line {}: exit code {:?} instead of {}\n{}{printed}",
            commands.line,
            ended.status.code(),
            commands.exit,
            commands.text
        ));
    }
    Ok(Some(printed))
}

#[test]
fn tutorials_and_how_to_pages_do_what_they_say() {
    let root = repository();
    let only = std::env::var("SIGNORINI_PAGE").unwrap_or_default();
    let (mut faults, mut commands, mut outputs, mut skipped) = (Vec::new(), 0, 0, 0);
    for path in pages(&root) {
        let name = path.strip_prefix(&root).unwrap().display().to_string();
        if !name.contains(&only) {
            continue;
        }
        match follow(&std::fs::read_to_string(&path).unwrap(), &root) {
            Ok(done) => {
                commands += done.commands;
                outputs += done.outputs;
                skipped += done.skipped;
                faults.extend(done.faults.iter().map(|fault| format!("{name}: {fault}")));
            }
            Err(error) => faults.push(format!("{name}: {error}")),
        }
    }
    println!(
        "pages: {commands} blocks of commands run, {outputs} outputs compared, {skipped} not run"
    );
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    assert!(commands > 0);
}

#[test]
fn a_page_that_ends_otherwise_than_it_says_is_a_fault() {
    let page = "```sh\nexit 2\n```\n";
    assert_eq!(follow(page, &repository()).unwrap().faults.len(), 1);
    let page = "<!-- exit: 2 -->\n```sh\nexit 2\n```\n";
    assert!(follow(page, &repository()).unwrap().faults.is_empty());
}

#[test]
fn a_page_that_shows_other_output_than_there_is_is_a_fault() {
    let page = "```sh\necho one\n```\n<!-- output -->\n```text\ntwo\n```\n";
    assert_eq!(follow(page, &repository()).unwrap().faults.len(), 1);
}

#[test]
fn commands_see_the_files_that_the_page_shows() {
    let page = "<!-- file: sub/x.txt -->\n```text\nhello\n```\n```sh\ncat sub/x.txt\n```\n\
                <!-- output -->\n```text\nhello\n```\n";
    let done = follow(page, &repository()).unwrap();
    assert!(done.faults.is_empty() && done.outputs == 1);
}

#[test]
fn the_first_command_that_fails_ends_its_block() {
    let page = "```sh\nfalse\ntrue\n```\n";
    assert_eq!(follow(page, &repository()).unwrap().faults.len(), 1);
}
